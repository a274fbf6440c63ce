"""A device that turns on the bench: felt at its rim, told about its axis."""

import pytest

import zwidth as zw
from zwidth.loop.traces import measures as scores
from zwidth.model.operator import TypicalTouch
from zwidth.quantity.exact import Exact
from zwidth.study.bench.bench import at_rim, radius_of

RADIUS = Exact("0.13")
KNOB = zw.rotary(
    inertia=0.004, damping=0.03, coulomb_friction=0.04, counts_per_turn=5000, rate="1 kHz", delay="1 ms"
)
WALL = zw.Wall(14, 0.01)


def test_the_same_touch_about_the_axis():
    """Simulated there, with a finger whose numbers are turned by hand, it has the scores that are told."""
    there = at_rim(KNOB, WALL, RADIUS)
    found = zw.compare(*there, {"wall": there[1]}).about_axis(KNOB, WALL, RADIUS)
    r, touch = float(RADIUS), TypicalTouch()
    powers = {"mass": 2, "stiffness": 2, "damping": 2, "force": 1, "speed": -1, "start": -1}
    finger = zw.operators.Finger(**{name: getattr(touch, name) * r**power for name, power in powers.items()})
    trace = zw.simulate(KNOB, WALL, finger, 1.5)
    told = found.scores.sel(law="wall")
    for name, units, score in (
        ("static_stiffness", "N*m/rad", scores.static_stiffness),
        ("penetration", "rad", scores.penetration),
        ("chatter", "N*m", scores.chatter),
        ("rms_force", "N*m", scores.rms_force),
        ("settling_time", "s", scores.settling_time),
    ):
        assert told[name].attrs["units"] == units
        assert float(told[name]) == pytest.approx(score(trace), rel=1e-6)
    assert "14 N·m/rad" in "".join(map(str, found.in_short()))
    assert found.to_dict()["touched_at_radius_m"] == 0.13


def test_what_is_refused():
    """No radius, one of nothing, one where nothing turns, and laws whose numbers are not of the rim."""
    for given, part in ((None, "how far from the axis"), (0, "handle_radius must be > 0")):
        with pytest.raises(zw.InputError, match=part):
            radius_of(KNOB, given)
    with pytest.raises(zw.InputError, match="laws of your own"):
        zw.compare(KNOB, WALL, {"mine": WALL}, handle_radius=RADIUS)
    with pytest.raises(zw.InputError, match="this one is linear"):
        zw.compare(zw.catalogue.device("haptic-paddle"), zw.Wall(300), handle_radius=0.1)
