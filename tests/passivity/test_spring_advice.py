"""What is advised of a nonlinear spring is enough, and hardly more than enough."""

from __future__ import annotations

import pytest

import zwidth as zw
from zwidth.passivity.advice import Advice
from zwidth.passivity.formulas.nonlinear_spring import certify_spring
from zwidth.passivity.loop_advice import advise_on_spring

STOP = zw.NonlinearSpring(positions=["0.01", "0.013"], forces=[0, 3])
"""A bump stop of 1000 N/m, 10 mm away."""

DETENTS = zw.NonlinearSpring.detents(3, "0.01", "0.5")
"""±200 N/m."""

PADDLE = zw.Device(mass="0.05", damping="0.05", coulomb_friction="0.1", resolution="1e-5", rate=1000)
"""For which both are too stiff."""


def is_proved(advice: Advice, at: zw.Device, spring: zw.NonlinearSpring, share: float) -> bool:
    """Whether the checker accepts the loop with an advised value, times a share."""
    value = advice.to * share
    if advice.parameter == "stiffness":
        forces = [round(float(f) * value / advice.current, 12) for f in spring.forces]
        spring = zw.NonlinearSpring(positions=spring.positions, forces=forces)
    else:
        at = at.replace(**{advice.parameter: value})
    return certify_spring(at, spring).covered() is not None


@pytest.mark.parametrize("spring", [STOP, DETENTS], ids=["stop", "detents"])
@pytest.mark.parametrize("delay", [0, "0.00003"])
def test_each_change_is_proved_and_a_hundredth_less_is_not(
    spring: zw.NonlinearSpring, delay: str | int
) -> None:
    """Each of rate, damping and slope alone; no change of the encoder or of Coulomb friction would do."""
    given = PADDLE.replace(delay=delay)
    advice = advise_on_spring(given, spring, passive=False)
    assert {one.parameter for one in advice} == {"rate", "damping", "stiffness"}
    for one in advice:
        assert is_proved(one, given, spring, 1.0), one.text
        less = 1.01 if one.parameter == "stiffness" else 0.99
        assert not is_proved(one, given, spring, less), one.text


def test_the_slack_of_a_spring_that_is_proved() -> None:
    """How far each number may go, 2b/T = 2000 N/m for the slope; the encoder, with f_c, up to 2 f_c/s."""
    verdict = zw.check(PADDLE.replace(damping=1), STOP)
    assert verdict.outcome == "passive"
    assert dict(verdict.rows())["limit"] == "sampling against viscous damping"
    slack = {one.parameter: one.to for one in verdict.advice}
    assert slack == pytest.approx(
        {"stiffness": 2000, "damping": 0.5, "rate": 500, "resolution": 2e-4, "coulomb_friction": 0.005},
        rel=1e-3,
    )


def test_where_no_condition_is_known_nothing_is_advised() -> None:
    """Of a spring that pulls away for ever."""
    pulling = zw.NonlinearSpring(positions=[0, "0.01"], forces=[0, -3])
    assert zw.check(PADDLE, pulling).advice == ()
