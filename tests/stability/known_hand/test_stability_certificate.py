"""What is said of a known hand, decided once more by the checker: both sides of limits, and tampering."""

from __future__ import annotations

import copy
import json
import sys
from fractions import Fraction

import numpy as np
import pytest

import zwidth as zw
from zwidth import checker
from zwidth.cli.main import main
from zwidth.model.operator import Finger
from zwidth.passivity.stability.characteristic import decided, of_law
from zwidth.passivity.stability.known_hand import evidence, motion_of

PADDLE = zw.catalogue.device("haptic-paddle")
coupled, Hand = zw.stability.coupled_stability, zw.stability.HandImpedance
BOX = Hand(mass=(0, "0.02"), stiffness=(0, 1000), damping=(0, 3))
KINDS = ("stability", "instability")
MASS, PERIOD = Fraction("0.036"), Fraction("0.001")
BARE = zw.Device(mass=MASS, damping=0, sample_period=PERIOD)


def document(device: zw.Device, wall: object, hand: object = None) -> dict:
    certificate = coupled(device, wall, hand).certificate
    return copy.deepcopy(certificate.documents[0])


def changed(doc: dict, **loop: object) -> checker.Verification:
    return checker.verify({**doc, "loop": {**doc["loop"], **loop}})


@pytest.fixture(scope="module")
def boxed() -> dict:
    return document(PADDLE, zw.Wall(1000, 1), BOX)


@pytest.mark.parametrize("delay", ["0", "0.00037", "0.002"])
@pytest.mark.parametrize(
    "velocity",
    [zw.rendering.BackwardDifference(), zw.rendering.Window(3), zw.rendering.OnePole("0.004")],
    ids=["backward", "window", "pole"],
)
@pytest.mark.parametrize("hand", [None, Finger()], ids=["no hand", "finger"])
def test_at_the_largest_stable_stiffness_and_a_millionth_above(delay, velocity, hand) -> None:
    device = PADDLE.replace(delay=delay)
    limit = coupled(device, zw.Wall(100, 2, velocity), hand).max_stiffness
    for factor, outcome, kind in ((1, "stable", "stability"), (1.000001, "unstable", "instability")):
        found = coupled(device, zw.Wall(limit * factor, 2, velocity), hand)
        assert found.outcome == outcome
        assert found.certificate.kind == kind
        assert found.verify()


def test_the_limit_itself_is_decided_exactly_where_all_is_rational() -> None:
    """κ = 2β(2 − β)/(2 + β) without spring and damper: unstable there, stable 10⁻⁹⁰⁰ below."""
    beta = Fraction(2, 7)
    limit = 2 * beta * (2 - beta) / (2 + beta)
    doc = document(BARE, zw.Wall(1000, beta * MASS / PERIOD))
    for off, stable in ((-1, True), (0, False), (1, False)):
        k, b = (limit + off * Fraction(1, 10**900)) * MASS / PERIOD**2, beta * MASS / PERIOD
        law = {"numerator": [str(k + b / PERIOD), str(-b / PERIOD)], "denominator": ["1", "0"]}
        loop = doc["loop"] | law
        answers = [checker.verify({"kind": kind, "loop": loop}).valid for kind in KINDS]
        assert answers == [stable, not stable]


def test_a_free_device_in_a_damped_hand_drifts() -> None:
    """No wall and no spring: a root at z = 1 exactly, although e^{−δ} is not rational."""
    found = coupled(PADDLE, zw.Wall(0), Hand(damping="0.3"))
    assert found.outcome == "unstable"
    assert found.verify()


def test_slow_hands_are_decided() -> None:
    """Roots 10⁻⁶ from z = 1, on both sides: a heavy device, drawn back or pushed off softly."""
    device = zw.Device(mass=20, damping="0.002", sample_period="0.0001")
    for stiffness, outcome in (("0.001", "stable"), ("-0.001", "unstable")):
        law = zw.PulseTransferFunction([stiffness], [1])
        found = coupled(device, law, Hand(damping="0.001"))
        assert 1e-9 < abs(1 - found.spectral_radius) < 1e-5
        assert found.outcome == outcome
        assert found.verify()


@pytest.mark.parametrize(
    ("loop", "words"),
    [
        ({"mass_kg": ["0.036", "0.06"]}, ""),
        ({"mass_kg": ["0.0002", "0.056"]}, "not confirmed"),
        ({"damping_N_s_per_m": ["0.1", "3.15"]}, ""),
        ({"stiffness_N_per_m": ["70000", "90000"]}, "not confirmed"),
        ({"delay_s": "0.004"}, "could not be confirmed"),
        ({"sample_period_s": "0.01"}, "could not be confirmed"),
        ({"numerator": ["11", "-1"]}, "could not be confirmed"),
        ({"numerator": ["1", "-1"]}, "not confirmed"),
        ({"mass_kg": "0"}, "must be > 0"),
        ({"damping_N_s_per_m": "-1"}, "≥ 0"),
        ({"mass_kg": ["2", "1"]}, "smaller"),
        ({"mass_kg": ["1", "2", "3"]}, "interval"),
        ({"mass_kg_m2": "1"}, "of a rotary one"),
        ({"delay_s": ["0", "1"]}, "expected a number"),
        ({"delay_s": "9"}, "samples"),
        ({"denominator": ["0", "1"]}, "proper"),
        ({"numerator": []}, "numerator must have 1"),
        ({"mass_kg": "1e-9"}, "too far"),
        ({"mass_kg": None}, "expected a number"),
    ],
    ids=str,
)
def test_a_box_with_other_numbers(boxed: dict, loop: dict, words: str) -> None:
    assert checker.verify(boxed).valid
    found = changed(boxed, **loop)
    assert found.valid is not bool(words)
    assert words in found.reason


@pytest.mark.parametrize(
    ("side", "far", "beyond"),
    [("mass_kg", 0.04, 1e-4), ("damping_N_s_per_m", 1.5, 0), ("stiffness_N_per_m", 400, 1e5)],
)
def test_a_box_up_to_the_limit_and_past_it(side: str, far: float, beyond: float) -> None:
    """From a stable end a box is certified up to a hundredth before an unstable end, and not past it."""
    doc = document(PADDLE, zw.Wall(1000, 1))
    base = {"mass_kg": "0.036", "damping_N_s_per_m": "0.15", "stiffness_N_per_m": "500"}
    if side == "damping_N_s_per_m":
        doc["loop"]["numerator"] = ["4", "-1"]

    def stable(*values: float) -> bool:
        ends = [str(Fraction(value)) for value in sorted(values)]
        return changed(doc, **{**base, side: ends}).valid

    good, bad = far, beyond
    for _ in range(30):
        middle = (good + bad) / 2
        good, bad = (middle, bad) if stable(middle, middle) else (good, middle)
    assert stable(far, good + (far - good) / 100)
    assert not stable(far, bad)


def test_intervals_are_covered_where_random_hands_say_so() -> None:
    rng = np.random.default_rng(3)
    seen = set()
    for _ in range(25):
        device = PADDLE.replace(delay=str(rng.choice(["0", "0.0004", "0.0021"])))
        wall = zw.Wall(round(10 ** rng.uniform(2, 3.5), 2), round(10 ** rng.uniform(-1, 1), 3))
        ends = [sorted(np.round(10 ** rng.uniform(a, b, 2), 4)) for a, b in ((-3, 0), (1, 3), (-1, 1))]
        hand = Hand(mass=tuple(ends[0]), stiffness=tuple(ends[1]), damping=tuple(ends[2]))
        motion, law = motion_of(device, hand), wall.pulse_transfer_function(PERIOD)
        found = decided(motion, lambda box, law=law: of_law(box, law))
        seen.add(found.outcome)
        proof = evidence(found, motion, law, "linear")
        assert proof is None or checker.verify(proof).valid
        if found.outcome != "stable":
            continue
        for m, k, c in rng.uniform([e[0] for e in ends], [e[1] for e in ends], (20, 3)):
            one = motion_of(device, Hand(mass=m, stiffness=k, damping=c))
            assert decided(one, lambda box, law=law: of_law(box, law)).outcome == "stable"
    assert {"stable", "unstable"} <= seen


def test_a_kind_cannot_be_exchanged() -> None:
    stable, unstable = document(PADDLE, zw.Wall(1000, 1)), document(PADDLE, zw.Wall(99000, 1))
    assert not checker.verify({**stable, "kind": "instability"}).valid
    assert not checker.verify({**unstable, "kind": "stability"}).valid
    found = changed(unstable, mass_kg=["0.036", "0.037"])
    assert not found.valid
    assert "single values" in found.reason


def test_what_the_checker_refuses_is_undecided(monkeypatch: pytest.MonkeyPatch) -> None:
    module = sys.modules["zwidth.passivity.stability.known_hand"]
    monkeypatch.setattr(module, "evidence", lambda *rest: {**evidence(*rest), "kind": "stability"})
    assert coupled(PADDLE, zw.Wall(100, 1)).outcome == "stable"
    found = coupled(PADDLE, zw.Wall(99000, 1))
    assert found.outcome == "undecided"
    assert found.certificate is None
    assert not found.verify()
    assert "not decided" in found.claim


def test_saved_and_read_by_the_command_line(tmp_path, capsys) -> None:
    path = tmp_path / "known.json"
    hands = Hand(stiffness=(0, 100), damping=(1, 2))
    coupled(PADDLE.replace(motion="rotary"), zw.Wall(1000, 1), hands).certificate.save(path)
    assert main(["verify", str(path)]) == 0
    told = " ".join(capsys.readouterr().out.split())
    assert "come to rest" in told
    assert "passive" not in told
    doc = json.loads(path.read_text(encoding="utf-8"))
    path.write_text(json.dumps({"outcome": "passive", "certificate": doc}))
    assert main(["verify", str(path)]) == 1
    doc["loop"]["delay_s"] = "0.01"
    path.write_text(json.dumps(doc))
    assert main(["verify", str(path)]) == 1
