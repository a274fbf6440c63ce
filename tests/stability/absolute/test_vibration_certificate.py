"""Periodic motions solved once more by the checker: exact by hand, from both sides of a limit, tampered."""

from __future__ import annotations

import copy
from fractions import Fraction

import pytest

import zwidth as zw
from zwidth import checker
from zwidth.model.operator.operator import LinearHand
from zwidth.passivity.stability.absolute import periodic_motion, touched_plant

SIX = {"numerator": ["2", "0.92"], "denominator": ["1", "-0.5", "0"]}
LIMIT = Fraction(175, 192)
"""Above it plant 6 vibrates with three samples: the third position leaves the wall at 0.96 K = 7/8."""


def six(**changes: object) -> dict:
    """Plant 6 with a wall just beyond its limit, two samples of three off it."""
    base = {"kind": "vibration", "plant": SIX, "slope": "0.92", "gap": "-1", "inside": [True, False, False]}
    return {**base, **changes}


DEVICE = zw.Device(
    mass="0.04", damping="0.8", sample_period="0.001", coulomb_friction=0, resolution=0, delay="0.0005"
)


@pytest.fixture(scope="module")
def touched() -> dict:
    """A pressing hand of 400 N/m that vibrates against 1200 N/m, the force half a sample late."""
    plant = touched_plant(DEVICE, LinearHand(stiffness=400, mass=0.001))
    motion = periodic_motion(plant, 1250.0, -1.0)
    return copy.deepcopy(motion.certificate.documents[0])


@pytest.mark.parametrize(
    ("off", "valid"), [(Fraction(1, 10**60), True), (-Fraction(1, 10**60), False), (0, False)]
)
def test_the_slope_at_which_a_motion_of_three_samples_appears(off: Fraction, valid: bool) -> None:
    for second in (False, True):
        doc = six(slope=str(LIMIT + off), inside=[True, second, False])
        assert checker.verify(doc).valid == valid


@pytest.mark.parametrize(
    ("change", "valid"),
    [
        ({"inside": [False, False, True]}, True),
        ({"inside": [False, True, False]}, True),
        ({"inside": [True, False, False] * 2}, True),
        ({"gap": "-0.0371"}, True),
        ({"gap": "0.0371"}, False),
    ],
)
def test_where_the_pattern_begins_and_the_size_do_not_matter(change: dict, valid: bool) -> None:
    """The same motion from another sample on, twice round, for any gap < 0; a hand off the wall has none."""
    assert checker.verify(six(**change)).valid == valid


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"inside": [True, False]}, "not one of the wall"),
        ({"inside": [True, False, False, False]}, "not one of the wall"),
        ({"inside": [True, True, True]}, "samples inside"),
        ({"inside": [1, 0, 0]}, "true or false"),
        ({"inside": [True]}, "2 to 1000 entries"),
        ({"inside": "100"}, "a list"),
        ({"slope": "0"}, "> 0"),
        ({"slope": "0.9"}, "not one of the wall"),
        ({"plant": {"numerator": ["1", "2", "3"], "denominator": ["1", "0", "0"]}}, "proper"),
        ({"plant": {"numerator": ["0.5", "0.92"], "denominator": ["1", "-0.5", "0"]}}, "not one of the wall"),
        ({"plant": {"numerator": ["1"], "denominator": ["1", *["0"] * 80]}}, "too high"),
    ],
    ids=str,
)
def test_refuses_what_is_no_motion(change: dict, words: str) -> None:
    found = checker.verify(six(**change))
    assert not found.valid
    assert words in found.reason


@pytest.mark.parametrize(
    ("key", "value"),
    [
        *(("mass_kg", value) for value in ("0.02", ["0.03", "0.05"])),
        *(("hand_mass_kg", value) for value in ("0.03", "-0.01")),
        *(("damping_N_s_per_m", "1.5"), ("hand_damping_N_s_per_m", "0.9")),
        *(("hand_stiffness_N_per_m", "2000"), ("sample_period_s", "0.0005")),
        *(("delay_s", value) for value in ("0", "0.003")),
    ],
)
def test_a_touched_device_with_another_number(touched: dict, key: str, value: object) -> None:
    assert checker.verify(touched).valid
    assert not checker.verify({**touched, "loop": {**touched["loop"], key: value}}).valid


def test_a_touched_device_with_another_wall(touched: dict) -> None:
    flipped = list(touched["inside"])
    edge = next(i for i in range(len(flipped)) if flipped[i] != flipped[i - 1])
    flipped[edge] = not flipped[edge]
    assert not checker.verify({**touched, "inside": flipped}).valid
    assert not checker.verify({**touched, "slope": "804"}).valid
