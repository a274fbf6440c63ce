"""Documents that would keep the checker busy for minutes: refused for their size, before any work is done."""

from __future__ import annotations

import base64
import zlib
from fractions import Fraction
from random import Random
from typing import Any

import pytest

from zwidth import checker
from zwidth.checker.document import refusal as effort
from zwidth.checker.document.refusal import MOST
from zwidth.checker.known_hand import rest

HAND = {
    "mass_kg": "0.05", "damping_N_s_per_m": "0.7", "stiffness_N_per_m": "350", "sample_period_s": "0.001",
    "delay_s": "0",
}  # fmt: skip
LOOP = {
    "damping_N_s_per_m": "0.15", "coulomb_friction_N": "0.12", "resolution_m": "0",
    "sample_period_s": "0.001", "delay_s": "0", "unilateral": True,
}  # fmt: skip


def ratios(count: int, seed: int) -> list[str]:
    """Numbers p/q of 4000 digits above and below, no two alike."""
    random = Random(seed)
    return ["/".join(str(random.randrange(10**3999, 10**4000)) for _ in range(2)) for _ in range(count)]


LAW = {"numerator": ratios(30, 1), "denominator": ratios(31, 2)}
PORT = {"index": "input", "level": "0"}
ONES = ["1"] * 150


def motion(system: dict[str, Any], **moved: Any) -> dict[str, Any]:
    """What is taken out of a port, of one axis or of two."""
    kind = "matrix extraction" if "numerators" in system else "extraction"
    return {"kind": kind, "system": {"time": "continuous", **system}, "motion": moved, **PORT}


def violation(coefficients: list[str], **proof: str) -> dict[str, Any]:
    law = {"numerator": ["1"], "denominator": coefficients}
    return {"format": "zwidth violation 1", "kind": "violation", "loop": {**LOOP, **law}, "proof": proof}


def linear(numerator: list[str], denominator: list[str], at_both: int = 0, factor: Any = ("1",)) -> Any:
    """A line proved by a square that is 1."""
    positivity = {"at_one": at_both, "at_minus_one": at_both, "square": ["1"], "factor": list(factor)}
    proof = {"positivity": positivity, "stability": {"kind": "open loop"}}
    law = {"numerator": numerator, "denominator": denominator}
    return {"kind": "linear", "loop": {**LOOP, **law}, "proof": proof}


BURST = {"kind": "burst", "cycles": 10**9, "power": 400}
ACROSS = {"cosine": ["1", "1"], "sine": ["1", "1"]}
LONG = {"numerator": ONES, "denominator": ONES}
LONG_MATRIX = {"numerators": [[ONES, ONES], [ONES, ONES]], "denominator": ONES}
SPREAD = {"kind": "polynomial", "duration_s": "1.3", "lowest_power": 2000}
DOCUMENTS: dict[str, Any] = {
    "rest": {"kind": "stability", "loop": {**HAND, **LAW}},
    "no rest": {"kind": "instability", "loop": {**HAND, **LAW}},
    "slope": {
        "kind": "absolute stability", "nonlinearity": "monotone", "plant": LAW, "slope": "1", "center": "1",
        "taps": [], "convexity": "0", "smoothness": "0",
    },
    "violation of many digits": violation(ONES, kind="criterion", cosine="0." + "123456789" * 500),
    "violation of many coefficients": violation(
        ["1"] * 2000, kind="criterion", cosine="0.1234567890123456789012345678901234567890"
    ),
    "violation of many poles": violation(["1"] * 2000, kind="unstable environment", offset="1"),
    "port": motion(LAW, **SPREAD, coefficients=ONES),
    "ports": motion(
        {"numerators": [[LAW["numerator"]]], "denominator": LAW["denominator"]}, **SPREAD, coefficients=[ONES]
    ),
    "line": linear(ratios(31, 3), ratios(31, 4)),
    "burst of many digits": motion(LONG, **BURST, step_rad_per_s="1." + "3" * 130),
    "bursts of many digits": motion(LONG_MATRIX, **BURST, **ACROSS, step_rad_per_s="1." + "3" * 130),
    "burst of many lines": motion(LONG, **BURST, step_rad_per_s="1." + "3" * 110),
    "bursts of many lines": motion(LONG_MATRIX, **BURST, **ACROSS, step_rad_per_s="1.3333333333"),
    "many powers": motion(LONG, **SPREAD, coefficients=ONES),
    "many powers of two axes": motion(LONG_MATRIX, **SPREAD, coefficients=[ONES, ONES]),
    "long motion": {
        "kind": "vibration", "plant": {"numerator": ["1"] * 40, "denominator": ["1", *["0.001"] * 40]},
        "slope": "1", "gap": "1", "inside": [True, False] * 500,
    },
}  # fmt: skip


def taken_out(denominator: list[str], positions: list[str], **more: Any) -> dict[str, Any]:
    law = {"numerator": ["1"], "denominator": denominator, "unilateral": False}
    return {"kind": "motion", "loop": {**LOOP, **law}, "energy_J": "1", "positions_m": positions, **more}


FOREVER = {"repeats": [{"first": 1, "last": 3, "times": 10**4000}]}
DOCUMENTS |= {
    "motion that never settles": taken_out(["1", "-0.5"], ["0", "0.1", "0.3", "0.1"], **FOREVER),
    "motion of many coefficients": taken_out(ratios(100, 5), ["0", "0.1"] * 5000),
    "law of high order and many digits": linear(["1"] * 1999, ["1", *["0." + "1" * 400] * 1998]),
}


COUNTED = {**{k: v for k, v in LOOP.items() if k != "unilateral"}, "resolution_m": "0.0001"}
SURFACE = {"surface": "penetration", "clamped": False}


def stored(taps: int) -> dict[str, Any]:
    """Values of a law of so many taps, all of them 0."""
    domain = {"lowest_count": -taps, "highest_count": 1, "largest_move_counts": 1, "steps_per_count": 1}
    law = {**SURFACE, "taps_N_per_m": ["1"] * taps}
    packed = base64.b64encode(zlib.compress(bytes(1000))).decode()
    parts = {"loop": COUNTED, "law": law, "domain": domain, "force_unit": "1e-9", "storage": packed}
    return {"kind": "storage", **parts}


RELAXING = {"pole": "0.999999999", "stiffness_N_per_m": "500"}
SLOW = {**SURFACE, "resets": False, "taps_N_per_m": ["1000"], "relaxing": RELAXING}
DOCUMENTS |= {
    "storage of 14 taps": stored(14),
    "storage of 16 taps": stored(16),
    "motion of a law that relaxes slowly": {
        "kind": "contact motion", "loop": COUNTED, "law": SLOW, "energy_J": "1",
        "positions_m": ["-0.0001", "0.0003", "0.00015", "0.0003"],
        "repeats": {"first": 1, "last": 3, "times": 10**12},
    },
}  # fmt: skip


@pytest.mark.parametrize("name", DOCUMENTS)
def test_refused_for_its_size(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The reason is its effort or the number of digits, terms or samples, not what a computation found."""
    monkeypatch.setattr(effort, "MOST", MOST / 20)  # what is refused on the way is refused sooner
    found = checker.verify(DOCUMENTS[name])
    assert not found.valid
    said = ("more effort", "too many", "too long", "larger than can be checked")
    assert any(words in found.reason for words in said)


def test_factors_of_a_higher_degree_than_the_criterion() -> None:
    """They are not multiplied: their degrees say enough."""
    found = checker.verify(linear(["300"], ["1"], 1000, ["1e-5000", "1"]))
    assert (found.valid, found.reason) == (False, "the factors have a higher degree than the criterion")


def test_the_effort_on_boxes_counts_the_series() -> None:
    """A hand that swings many times within a sample has long series: its boxes are more than are tried."""
    hand = {"stiffness_N_per_m": "24000000", "damping_N_s_per_m": ["10", "11"], "mass_kg": ["0.05", "0.0501"]}
    law = {"numerator": ["1200", "-400"], "denominator": ["1", "0"]}
    found = checker.verify({"kind": "stability", "loop": {**HAND, **hand, **law}})
    assert not found.valid
    assert "more effort" in found.reason


def test_the_limit_is_decided_exactly_while_it_is_short(monkeypatch: pytest.MonkeyPatch) -> None:
    """A root at z = −1 without spring and damper is seen; where that would cost too much neither side is."""
    # (z + 1) (z − 0.9) (z − 0.8) = (z − 1)² (z + 1) + (T²/2M) (z + 1) N
    unit = Fraction(1, 10**6) / Fraction("1.2") / 2
    numerator = [str(Fraction(c) / unit) for c in ("0.3", "-0.28")]
    free = {**HAND, "stiffness_N_per_m": "0", "damping_N_s_per_m": "0", "mass_kg": "1.2"}
    loop = {**free, "numerator": numerator, "denominator": ["1", "1"]}
    stable, unstable = ({"kind": kind, "loop": loop} for kind in ("stability", "instability"))
    assert not checker.verify(stable).valid
    assert checker.verify(unstable).valid
    monkeypatch.setattr(rest, "MOST_EXACT", 10)
    assert not checker.verify(stable).valid
    assert not checker.verify(unstable).valid
