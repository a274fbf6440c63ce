"""The wall and the velocity filter on it: what they are given, and what they keep."""

from __future__ import annotations

import pickle
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest

import zwidth as zw
from zwidth.quantity.parameter import parameters_of


@pytest.mark.parametrize(
    "given", [300, 300.0, "300", "0.3 N/mm", "300 N*m/rad", Fraction(300), Decimal(300), np.int64(300)]
)
def test_a_number_is_one_or_a_text_with_its_unit(given) -> None:
    """All mean 300 N/m, or N·m/rad, exactly."""
    wall = zw.Wall(given)
    assert isinstance(wall.stiffness, zw.Exact)
    assert wall.stiffness.fraction == 300
    assert wall == zw.Wall(stiffness=300)


@pytest.mark.parametrize("given", [(300, 400), "300 .. 400 N/m", ["0.3 N/mm", 400], zw.Interval(300, 400)])
def test_a_number_may_be_an_interval(given) -> None:
    assert zw.Wall(given).stiffness == zw.Interval(300, 400)


def test_every_text_with_a_unit_is_read_where_a_number_is() -> None:
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
    ("make", "said"),
    [
        (lambda: zw.Wall(-1), "stiffness must be ≥ 0, got -1: a negative spring pulls the hand in and gives"),
        (lambda: zw.Wall((-1, 2)), "stiffness must be ≥ 0, got -1 … 2: a negative spring"),
        (lambda: zw.Wall("3 N"), 'stiffness is in N/m; got "3 N", a force'),
        (lambda: zw.Wall(True), "stiffness is in N/m; got true or false where a number belongs"),
        (lambda: zw.Wall(1, "2 N/m"), r'damping is in N\*s/m; got "2 N/m", a stiffness'),
        (lambda: zw.Wall(1, 2, 3), r"velocity_filter is BackwardDifference\(\), .*, got int"),
        (lambda: zw.rendering.OnePole(-1), "time_constant must be ≥ 0 s, got -1: a filter with a negative"),
        (lambda: zw.rendering.OnePole(1001), "time_constant must be at most 1000 s, got 1001"),
        (lambda: zw.rendering.VelocityFilter([1, 2, 3], [1, 2]), "cannot have more zeros"),
    ],
)
def test_a_slip_is_one_clear_message(make, said) -> None:
    with pytest.raises(zw.InputError, match=said):
        make()


def test_a_wall_is_a_value() -> None:
    wall = zw.Wall("0.3 N/mm", (1, 2), zw.rendering.Window(3), clamped=True)
    assert wall == eval(
        repr(wall), {name: getattr(zw.rendering, name) for name in zw.rendering.__all__} | vars(zw)
    )
    assert pickle.loads(pickle.dumps(wall)) == wall
    assert hash(wall) == hash(wall.replace(stiffness=300))
    assert wall.replace(damping=0).damping == 0
    with pytest.raises(AttributeError):
        wall.stiffness = 3


def test_every_parameter_says_what_it_is() -> None:
    stiffness, damping, velocity_filter, clamped = parameters_of(zw.Wall).values()
    assert (stiffness.required, damping.required) == (True, False)
    assert (stiffness.bound, stiffness.unit_for("linear"), stiffness.unit_for("rotary")) == (
        "≥ 0",
        "N/m",
        "N*m/rad",
    )
    assert damping.meaning == "virtual damping"
    assert (velocity_filter.form, clamped.form) == ("velocity filter", "flag")
