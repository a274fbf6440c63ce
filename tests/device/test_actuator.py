"""The actuator checks of Abbott & Okamura 2005, section IV-B."""

from fractions import Fraction

import pytest

import zwidth as zw
from zwidth.model.device import actuator_checks

PADDLE = zw.catalogue.device("haptic-paddle")


def test_the_paddle_s_numbers():
    """13 times finer at 300 N/m, and a rise of 0.15 ms, 15 % of a sample."""
    resolution, rise = actuator_checks(PADDLE, 300)
    assert resolution.ratio.fraction == 300 * Fraction("22.4e-6") / (Fraction(20, 65536) * Fraction("1.65"))
    assert int(resolution.ratio) == 13
    assert rise.value == pytest.approx(0.15e-3, rel=0.01)
    assert rise.ratio.fraction == Fraction("0.15125")
    assert resolution.ok
    assert rise.ok
    assert "13.3 to 1" in resolution.text
    knob = zw.rotary(damping=0.01, rate=1000, counts_per_turn=4096, force_resolution=1e-4)
    assert actuator_checks(knob, 1)[0].unit == "N*m"


def test_both_sides_of_the_bounds():
    """Fine from 10 to 1 on, quick up to a fifth of a sample."""
    step = PADDLE.exact("force_resolution")
    stiffness = 10 * step / PADDLE.exact("resolution")
    assert actuator_checks(PADDLE, stiffness)[0].ok is True
    assert actuator_checks(PADDLE, stiffness * (1 - Fraction(1, 10**9)))[0].ok is False
    period = 5 * Fraction("0.15125e-3")
    assert actuator_checks(PADDLE.replace(sample_period=period), 300)[1].ok is True
    assert actuator_checks(PADDLE.replace(sample_period=period - Fraction(1, 10**12)), 300)[1].ok is False


@pytest.mark.parametrize(
    ("device", "stiffness", "part"),
    [
        (PADDLE.replace(motor_inductance=None), 300, "motor_inductance"),
        (zw.catalogue.device("phantom"), 300, "the encoder's resolution"),
        (PADDLE.replace(force_resolution=None), 300, "force_resolution"),
        (PADDLE, None, "a stiffness"),
        (PADDLE, 0, "a stiffness"),
        (PADDLE.replace(resolution=0), 300, "an ideal encoder"),
    ],
)
def test_what_is_unknown_is_said(device, stiffness, part):
    check = actuator_checks(device, stiffness)[part == "motor_inductance"]
    assert check.ok is None
    assert check.ratio is None
    assert part in check.text
    assert "supply_voltage" not in check.text


def test_intervals_take_their_worst_ends():
    wide = PADDLE.replace(supply_voltage=(6, 12), resolution=("11.2e-6", "22.4e-6"))
    fine, quick = actuator_checks(wide, (300, 600)), actuator_checks(PADDLE, 300)
    assert fine[0].ratio is not None
    assert quick[0].ratio is not None
    assert fine[0].ratio.fraction * 2 == quick[0].ratio.fraction
    assert fine[1].value == 2 * quick[1].value
    assert fine[1].ok is False
