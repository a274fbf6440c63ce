"""Documents that are false by little, each where one term or one condition of the checker decides."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest

import zwidth as zw
from zwidth import checker

K, T, STEP = Fraction(100), Fraction(1, 1000), Fraction(1, 10**4)
TINY = Fraction(1, 10**9)


def loop(numerator: Fraction, *, unilateral: bool, **numbers: Fraction) -> dict[str, Any]:
    """A spring, with what is given of its device."""
    units = {"damping": "N_s_per_m", "coulomb_friction": "N", "resolution": "m", "delay": "s"}
    return {
        **{f"{name}_{unit}": str(numbers.get(name, 0)) for name, unit in units.items()},
        "sample_period_s": str(T),
        "numerator": [str(numerator)],
        "denominator": ["1"],
        "unilateral": unilateral,
    }


def spring(damping: Fraction, delay: Fraction) -> bool:
    """Whether the checker accepts so much damping for a spring behind a delay."""
    told = loop(K, unilateral=True, damping=damping, delay=delay)
    return checker.verify({"kind": "spring", "loop": told}).valid


@pytest.mark.parametrize("share", ["1/7", "1/2", "0.9"])
@pytest.mark.parametrize("whole", [0, 1, 3])
def test_a_spring_behind_part_of_a_sample(share: str, whole: int) -> None:
    """b ≥ ½ (r + √(r² + T² α (1 − α) K²)) with r = (KT/2)(2d + 1 + 2α), to a part in 10⁹."""
    part = Fraction(share)
    reach = K * T / 2 * (2 * whole + 1 + 2 * part)
    root = Fraction(float(reach**2 + T**2 * part * (1 - part) * K**2) ** 0.5)
    needed = (reach + root) / 2
    delay = (whole + part) * T
    assert spring(needed * (1 + TINY), delay)
    assert not spring(needed * (1 - TINY), delay)
    late = zw.Device(damping=needed * (1 - TINY), sample_period=T, delay=delay)
    assert zw.check(late, zw.Wall(K)).outcome == "active"


def test_a_spring_that_pushes_the_hand_on() -> None:
    """H(z) = −K meets the criterion at every frequency; what it gives out is not bounded."""
    constant = {"at_one": 0, "at_minus_one": 0, "square": ["1"], "factor": ["1"]}
    proof = {"positivity": constant, "stability": {"kind": "open loop"}}
    for sign in (1, -1):
        told = loop(sign * K, unilateral=False, damping=Fraction(1))
        found = checker.verify({"kind": "linear", "loop": told, "proof": proof})
        assert found.valid is (sign > 0), found.reason
    assert found.reason == "the static stiffness H(1) is negative"


@pytest.mark.parametrize(("unilateral", "start"), [(True, "0.001"), (False, "0.001"), (False, "-0.001")])
def test_a_motion_that_begins_in_a_loaded_spring(unilateral: bool, start: str) -> None:
    """It gets back what somebody else put in."""
    damping = K * T / 2
    told = loop(K, unilateral=unilateral, damping=damping)
    positions = [start, *(str(Fraction(start) * (9 - k) / 10) for k in range(10))]
    motion = {"kind": "motion", "loop": told, "positions_m": positions, "energy_J": "1"}
    found = checker.verify(motion)
    assert not found.valid
    assert "must start at rest" in found.reason


def test_a_motion_that_gets_back_half_a_count() -> None:
    """K Δ²/8 is in the spring when a hand rests at an edge: a passive loop gives nearly all of it back."""
    edge = STEP / 10**6
    device = {"damping": K * T / 2, "coulomb_friction": K * STEP / 2, "resolution": STEP}
    told = loop(K, unilateral=False, **device)
    positions = ["0", str(-edge), str(STEP / 2 - edge)]
    energy = K * STEP**2 / 8 - K * STEP * edge / 2 - K * edge**2 / 2
    motion = {"kind": "motion", "loop": told, "positions_m": positions, "energy_J": str(energy)}
    found = checker.verify(motion)
    assert found.energy == energy
    assert not found.valid
    assert "no more than the" in found.reason
    assert (
        zw.check(zw.Device(sample_period=T, **device), zw.PulseTransferFunction([K], [1])).outcome
        == "passive"
    )
    less = {**told, "coulomb_friction_N": str(device["coulomb_friction"] * Fraction(9, 10))}
    gained = energy + (edge + STEP / 2) * device["coulomb_friction"] / 10
    assert checker.verify({**motion, "loop": less, "energy_J": str(gained)}).valid


def test_an_interval_of_delays_that_has_no_length() -> None:
    """Pieces that are none cover it, and nothing is shown of the one delay."""
    told = loop(K, unilateral=True, damping=K * T / 2 / 1000)
    proof: dict[str, Any] = {"stability": {"kind": "open loop"}, "pieces": []}
    document = {"kind": "delays", "loop": told, "delay_high_s": "0", "proof": proof}
    assert "pieces must have 1" in checker.verify(document).reason


@pytest.mark.parametrize(("out", "up"), [(["1.02", "0"], ["0", "1"]), (["1", "0"], ["0.001", "1"])])
def test_legs_in_a_plane_that_is_stretched(out: list[str], up: list[str]) -> None:
    """Longer axes, or askew ones, would bear a stiffer wall with the same damping."""
    legs = [
        {
            "base_m": [x, "0"],
            "out": out,
            "up": up,
            "link_m": "0.1",
            "rod_m": "0.12",
            "offset_m": "0",
            "bend": bend,
            "damping_N_m_s_per_rad": "0.01",
        }
        for x, bend in (("-0.02", 1), ("0.02", -1))
    ]
    arm = {"geometry": "legs", "legs": legs, "low_m": ["0", "0.1"], "high_m": ["0.001", "0.101"]}
    clock = {"sample_period_s": "0.001", "delay_samples": 0, "encoder": "ideal", "torque": "follows the arm"}
    nothing = [["0", "0"], ["0", "0"]]
    wall = {
        "stiffness_N_per_m": [["1", "0"], ["0", "1"]],
        "virtual_damping_N_s_per_m": nothing,
        "damping_bound_N_s_per_m": nothing,
    }
    found = checker.verify({"kind": "arm", "arm": arm, "wall": wall, "loop": clock})
    assert "out and up must be of length 1, at right angles" in found.reason
    right = {**arm, "legs": [{**leg, "out": ["1", "0"], "up": ["0", "1"]} for leg in legs]}
    assert checker.verify({"kind": "arm", "arm": right, "wall": wall, "loop": clock}).valid


@pytest.mark.parametrize("key", ["resolution_m", "delay_s"])
def test_an_endless_pull_of_an_impossible_device(key: str) -> None:
    """Numbers that its inequality does not read must make sense all the same: they are shown."""
    device = {k: v for k, v in loop(K, unilateral=True).items() if k.endswith(("_m", "_N", "_s"))}
    law = {"points_m_N": [["-1", "1"], ["0", "0"]]}
    document: dict[str, Any] = {
        "kind": "endless pull",
        "loop": {**device, "damping_N_s_per_m": "0"},
        "law": law,
    }
    assert checker.verify(document).valid, checker.verify(document).reason
    wrong = {**document, "loop": {**document["loop"], key: "-1"}}
    assert f"{key} must be ≥ 0" in checker.verify(wrong).reason


def test_lists_in_lists() -> None:
    """Deeper than any document is: an answer, not an exception."""
    deep: Any = "1"
    for _ in range(5000):
        deep = [deep]
    told = {**loop(K, unilateral=True), "numerator": deep}
    assert "at most 12 levels" in checker.verify({"kind": "spring", "loop": told}).reason
