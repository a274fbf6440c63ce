"""Intervals on the side of the handle: its damping by either end, its mass and dry friction not at all."""

import json
from itertools import product

import pytest

import zwidth as zw
from zwidth.checker import judge
from zwidth.passivity.transmission import elastic_of

CABLE = zw.Transmission(stiffness=28657, handle_damping=("0.05", "0.2"), handle_mass=("0.01", "0.05"))
IDEAL = {"coulomb_friction": 0, "resolution": 0, "delay": 0}
DEVICE = zw.Device(mass="30 g", damping="0.06", rate="1 kHz", transmission=CABLE, **IDEAL)


def of(**changes):
    return DEVICE.replace(transmission=CABLE.replace(**changes))


@pytest.mark.parametrize(
    ("encoder", "stiffness", "outcome"),
    [
        ("motor", "129.8", "passive in contact"),
        ("motor", "129.9", "undecided"),
        ("motor", 131, "active"),
        ("handle", 188, "passive in contact"),
        ("handle", 189, "undecided"),
        ("handle", 420, "active"),
    ],
)
@pytest.mark.parametrize("more", [{}, {"handle_mass": None, "handle_coulomb_friction": (0, "0.1")}])
def test_the_lower_end_proves_and_the_upper_one_refutes(encoder, stiffness, outcome, more):
    """And what is claimed of the interval is accepted as it is saved."""
    verdict = zw.check(of(encoder=encoder, **more), zw.Wall(stiffness))
    assert verdict.outcome == outcome
    ends = [
        zw.check(of(encoder=encoder, handle_damping=b, **more), zw.Wall(stiffness)).outcome
        for b in ("0.05", "0.2")
    ]
    expected = {"undecided": ["active", "passive in contact"]}.get(outcome, [outcome, outcome])
    assert ends == expected
    if outcome == "undecided":
        assert "give a smaller interval" in verdict.claim
    else:
        saved = judge(json.loads(json.dumps(verdict.to_dict())))
        assert saved.faults == ()
        assert all(part.verification.valid for part in saved.parts)


@pytest.mark.parametrize("encoder", ["motor", "handle"])
def test_more_damping_at_the_handle_takes_more_at_each_angle(encoder):
    """γ_a, γ_q: the criterion of walls, over the sum that scales it, grows with b₂ where it is decided."""
    for k, c, wall in product((2132, 28657, 500000), (0, "0.02"), (100, 300)):
        held = [
            zw.check(of(encoder=encoder, stiffness=k, damping=c, handle_damping=b), zw.Wall(wall)).outcome
            for b in ("0.01", "0.05", "0.3", 2)
        ]
        order = [("active", "passive in contact", "passive").index(outcome) for outcome in held]
        assert order == sorted(order)


@pytest.mark.parametrize(
    ("device", "wall", "name"),
    [
        (of(stiffness=(20000, 30000)), zw.Wall(125), "transmission.stiffness"),
        (of(damping=(0, "0.001")), zw.Wall(125), "transmission.damping"),
        (DEVICE.replace(damping=("0.06", "0.1")), zw.Wall(125), "damping"),
        (DEVICE, zw.Wall((100, 125)), "the environment"),
    ],
)
def test_of_what_no_interval_is_decided_is_named(device, wall, name):
    """2b₁/T is proved of it all the same."""
    verdict = zw.check(device, wall)
    assert verdict.outcome == "undecided"
    assert f"an interval of {name}: give single values" in verdict.claim
    assert zw.check(device, zw.Wall(120)).outcome == "passive"
    assert elastic_of(device, wall) is None
