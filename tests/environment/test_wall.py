"""Walls, and what other laws share with them: units, values, the keyword `clamped`, a factor of the force."""

from __future__ import annotations

import pickle
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest

import zwidth as zw
from zwidth.quantity.exact import Interval
from zwidth.quantity.parameter import parameters_of


@pytest.mark.parametrize(
    "given", [300, 300.0, "300", "0.3 N/mm", "300 N*m/rad", Fraction(300), Decimal(300), np.int64(300)]
)
def test_a_number_is_one_or_a_text_with_its_unit(given):
    """All mean 300 N/m, or N·m/rad, exactly."""
    wall = zw.Wall(given)
    assert isinstance(wall.stiffness, zw.Exact)
    assert wall.stiffness.fraction == 300
    assert wall == zw.Wall(stiffness=300)


def test_every_text_with_a_unit_is_read_where_a_number_is():
    assert zw.Maxwell("0.7 N/mm", "5 N*s/m") == zw.Maxwell(700, 5)
    assert zw.GeneralizedMaxwell(1, [("0.7 N/mm", "5 N*s/m")]) == zw.GeneralizedMaxwell(1, [(700, 5)])
    assert zw.HuntCrossley(3, dissipation="0.2 s/m") == zw.HuntCrossley(3, dissipation="0.2")
    assert zw.NonlinearSpring(["0", "3 mm"], [0, "2 N"]) == zw.NonlinearSpring([0, "0.003"], [0, 2])
    assert zw.rendering.OnePole("3 ms") == zw.rendering.OnePole("0.003")
    wall = zw.Wall(10)
    assert zw.VirtualCoupling("1 N/mm", "2 N*s/m", wall) == zw.VirtualCoupling(1000, 2, wall)
    assert zw.simulation.VirtualBody("300 g", "2 N*s/m") == zw.simulation.VirtualBody("0.3", 2)
    assert zw.PulseTransferFunction([1], [1], "1 ms") == zw.PulseTransferFunction([1], [1], "0.001")


@pytest.mark.parametrize(
    ("law", "motion", "wanted"),
    [
        (
            zw.Wall("300 N/m"),
            "rotary",
            r"stiffness is given in N/m, and the device turns: give it in N\*m/rad",
        ),
        (zw.Wall(3, "1 N*m*s/rad"), "linear", r"damping is given in N\*m\*s/rad, and the device slides"),
        (zw.NonlinearSpring(["0 deg", "9 deg"], [0, 1]), "linear", "positions is given in rad"),
        (zw.render(zw.Wall("300 N/m"), zw.rendering.Saturation()), "rotary", "stiffness is given in N/m"),
    ],
)
def test_units_of_another_motion_are_refused_by_the_device(law, motion, wanted):
    """An environment knows no device when it reads a text: 300 N/m was 300 N·m/rad to a wheel."""
    device = zw.Device(damping=1, coulomb_friction=1, resolution=1e-4, rate=1000, motion=motion)
    for ask in (zw.check, zw.limit, lambda *loop: zw.simulate(*loop, zw.operators.HandsOff(), 0.1)):
        with pytest.raises(zw.InputError, match=wanted):
            ask(device, law)


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: zw.Wall(-1), "stiffness must be ≥ 0, got -1: a negative spring pulls the hand in and gives"),
        (lambda: zw.Wall((-1, 2)), "stiffness must be ≥ 0, got -1 … 2: a negative spring"),
        (lambda: zw.Wall("3 N"), 'stiffness is in N/m; got "3 N", a force'),
        (lambda: zw.Wall(True), "stiffness is in N/m; got true or false where a number belongs"),
        (lambda: zw.Wall(1, "2 N/m"), r'damping is in N\*s/m; got "2 N/m", a stiffness'),
        (lambda: zw.Wall(1, 2, 3), r"velocity_filter is BackwardDifference\(\), .*, got int"),
        (lambda: zw.rendering.OnePole(-1), "time_constant must be ≥ 0 s, got -1: a filter with a negative"),
        (lambda: zw.rendering.OnePole(1001), "time_constant must be ≤ 1000 s, got 1001"),
        (lambda: zw.rendering.VelocityFilter([1, 2, 3], [1, 2]), "cannot have more zeros"),
    ],
)
def test_a_slip_is_one_clear_message(make, said):
    with pytest.raises(zw.InputError, match=said):
        make()


def test_a_wall_is_a_value():
    wall = zw.Wall("0.3 N/mm", (1, 2), zw.rendering.Window(3), clamped=True)
    assert wall == eval(repr(wall), NAMES)
    assert pickle.loads(pickle.dumps(wall)) == wall
    assert hash(wall) == hash(wall.replace(stiffness=300))
    assert wall.replace(damping=0).damping == 0
    with pytest.raises(AttributeError):
        wall.stiffness = 3


def test_every_parameter_says_what_it_is():
    stiffness, damping, velocity_filter, clamped = parameters_of(zw.Wall).values()
    assert (stiffness.required, damping.required) == (True, False)
    assert (stiffness.bound, stiffness.unit_for("linear"), stiffness.unit_for("rotary")) == (
        "≥ 0",
        "N/m",
        "N*m/rad",
    )
    assert damping.meaning == "virtual damping"
    assert (velocity_filter.form, clamped.form) == ("velocity filter", "flag")


CLAMPABLE = [
    zw.Wall(300, 0.5),
    zw.StandardLinearSolid(290, 731, 40),
    zw.Maxwell(731, 40),
    zw.GeneralizedMaxwell(290, [(731, 40), (5, 2)]),
]
NAMES = {name: getattr(zw.rendering, name) for name in zw.rendering.__all__} | vars(zw)
NAMES["Interval"] = zw.Interval


@pytest.mark.parametrize("law", CLAMPABLE)
def test_a_clamped_law_is_another_law_with_the_same_pulse_transfer_function(law):
    clamped = law.replace(clamped=True)
    period = Fraction(1, 1000)
    assert (law.clamped, clamped.clamped) == (False, True)
    assert clamped != law
    assert clamped.pulse_transfer_function(period) == law.pulse_transfer_function(period)
    assert clamped.describe() == law.describe() + ", never pulls"
    assert clamped.describe("rotary") == law.describe("rotary") + ", never pulls"
    assert pickle.loads(pickle.dumps(clamped)) == clamped
    assert eval(repr(clamped), NAMES) == clamped


@pytest.mark.parametrize("law", CLAMPABLE)
@pytest.mark.parametrize("value", [1, 0, None, "true", 1.0])
def test_only_a_bool_says_whether_a_law_is_clamped(law, value):
    """1 or "true" could be a slip for another argument."""
    with pytest.raises(zw.InputError, match="clamped is True for a law that never pulls, or False; got"):
        law.replace(clamped=value)


def test_laws_without_the_keyword_may_pull():
    assert not zw.PulseTransferFunction([1], [1]).clamped


def test_no_clamped_law_stands_behind_a_coupling():
    """The joint of the two would come loose: their H(z) does not say how."""
    with pytest.raises(zw.InputError, match=r"must be linear, .* never pulls"):
        zw.VirtualCoupling(100, 1, zw.Wall(300, clamped=True))


FACTOR, PERIOD = Fraction(7, 3), Fraction(1, 1300)
SCALABLE = {
    "wall": zw.Wall("310.7", "0.41"),
    "clamped wall": zw.Wall("310.7", "0.41", clamped=True),
    "Maxwell": zw.Maxwell("145.1", "11.3"),
    "standard linear solid": zw.StandardLinearSolid("310.7", "145.1", "11.3", "tustin"),
    "generalized Maxwell": zw.GeneralizedMaxwell("310.7", [("145.1", "11.3"), ("90.2", "1.7")]),
}


@pytest.mark.parametrize("name", SCALABLE)
def test_the_pulse_transfer_function_is_times_the_factor(name):
    law = SCALABLE[name]
    scaled = law.scaled(FACTOR)
    assert scaled.clamped == law.clamped
    z = Fraction(-3, 5)

    def value(of: zw.Environment) -> Fraction:
        top, bottom = of.pulse_transfer_function(PERIOD)
        at = [sum(c * z**k for k, c in enumerate(reversed(side))) for side in (top, bottom)]
        return Fraction(at[0] / at[1])

    assert value(scaled) == FACTOR * value(law)


def test_a_contact_gives_the_force_times_the_factor():
    contact = zw.HuntCrossley("5000", "1.5", "3")
    there = ("0.004", "0.02")
    assert float(contact.scaled(FACTOR).force(*there)) == pytest.approx(
        float(FACTOR) * float(contact.force(*there)), rel=1e-15
    )


def test_both_ends_of_an_interval_are_scaled():
    scaled = zw.StandardLinearSolid((300, 320), 145, (10, 12)).scaled(Fraction(2))
    assert scaled.stiffness == Interval(600, 640)
    assert scaled.branch_damping == Interval(20, 24)


def test_the_largest_gain_of_a_solid_is_that_of_its_closed_form():
    """b/(μ0 T/2 + μ1 η1 T/(2 η1 + μ1 T)), bracketed within 1 %."""
    solid, device = zw.StandardLinearSolid(310, 145, 11), zw.Device(damping=0.3, sample_period="1 ms")
    bracket = zw.limit(device, solid, "gain")
    need = 310 * 0.0005 + 145 * 11 * 0.001 / (22 + 0.145)
    assert bracket.proved_passive <= 0.3 / need <= bracket.proved_active
    assert bracket.proved_active / bracket.proved_passive < 1.01
