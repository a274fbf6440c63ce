"""What gives way between motor and hand: kept, bounded, in its units, and never taken for a rigid device."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import zwidth as zw

CABLE = zw.Transmission(
    stiffness="12 N/mm", damping=0.5, handle_mass=(0.03, 0.04), handle_damping="0.09 N*s/m", encoder="handle"
)
CAPSTAN = zw.Device(
    mass=0.03, damping=0.06, coulomb_friction=0.1, resolution=1e-5, rate=1000, transmission=CABLE, name="it"
)
CERTAIN = CAPSTAN.replace(transmission=CABLE.replace(handle_mass=0.03))
NUMBERS = ("stiffness", "damping", "handle_mass", "handle_damping", "handle_coulomb_friction")


def test_the_numbers_are_exact_and_in_si():
    assert (CABLE.stiffness, CABLE.handle_damping) == (12000, zw.Exact("0.09"))
    assert CABLE.handle_coulomb_friction == 0
    assert CABLE.handle_mass == zw.Interval("0.03", "0.04")
    assert zw.Transmission(stiffness="3 N*m/deg").stiffness == pytest.approx(3 * 180 / np.pi)
    assert set(CABLE.parameters()) == set(NUMBERS)
    assert set(zw.Transmission().parameters()) == {"damping", "handle_damping", "handle_coulomb_friction"}


@pytest.mark.parametrize("key", NUMBERS)
def test_bounds(key):
    """What cannot be 0 refuses it, and nothing is below 0."""
    positive = key in ("stiffness", "handle_mass")
    smallest = 0 if positive else -1e-9
    with pytest.raises(zw.InputError, match=f"{key} must be {'>' if positive else '≥'} 0"):
        zw.Transmission(**{key: smallest})
    with pytest.raises(zw.InputError, match=key):
        zw.Transmission(**{key: "1 s"})
    assert getattr(zw.Transmission(**{key: 1e-9}), key) == 1e-9


def test_what_is_no_transmission_is_refused():
    with pytest.raises(zw.InputError, match="encoder is one of 'motor', 'handle'"):
        zw.Transmission(encoder="hand")
    with pytest.raises(zw.InputError, match=r"transmission is a zwidth\.Transmission, got float"):
        zw.Device(damping=1, rate=1000, transmission=12e3)


def test_a_device_keeps_it():
    """Through changes of its own numbers, pickle and equality; alone it is the motor's side."""
    assert CAPSTAN.replace(rate=2000).transmission == CAPSTAN.replace(mass=None).transmission == CABLE
    assert pickle.loads(pickle.dumps(CAPSTAN)) == CAPSTAN == CAPSTAN.replace()
    assert CAPSTAN.replace(delay=0.001).assumed == ()
    assert CAPSTAN != CAPSTAN.motor_side != CERTAIN
    assert CAPSTAN.motor_side.transmission is None
    assert CAPSTAN.motor_side.motor_side == CAPSTAN.motor_side
    assert CAPSTAN.parameters() == CAPSTAN.motor_side.parameters()
    assert (CAPSTAN.is_certain, CERTAIN.is_certain, CAPSTAN.motor_side.is_certain) == (False, True, True)
    assert repr(CABLE) in repr(CAPSTAN)


def test_a_notebook_shows_it():
    shown = CAPSTAN._repr_html_()
    for text in ("transmission: stiffness", "12000 N/m", "0.03 … 0.04 kg", "encoder at the", "handle"):
        assert text in shown


def test_at_a_handle_it_is_seen_as_the_device_is():
    """Stiffness, damping and inertia go with 1/r², friction with 1/r."""
    wheel = {"inertia": 0.02, "damping": 0.05, "rate": 1000}
    cable = zw.Transmission(stiffness=3, damping=0.1, handle_mass=0.01, handle_coulomb_friction=0.2)
    turning, handle = (zw.rotary(**wheel, **at, transmission=cable) for at in ({}, {"handle_radius": 0.1}))
    assert turning.transmission == cable
    assert handle.transmission == zw.Transmission(
        stiffness=300, damping=10, handle_mass=1, handle_coulomb_friction=2
    )


WALL = zw.Wall(100)
REFUSED = {
    "check": lambda d: zw.check(d, WALL),
    "check without grid": lambda d: zw.check(d, WALL, iterate=False),
    "check of a chain": lambda d: zw.check(d, zw.render(WALL, zw.rendering.ForceBounding())),
    "check of a spring": lambda d: zw.check(d, zw.HuntCrossley(100, 1)),
    "limit": lambda d: zw.limit(d, WALL),
    "limit without grid": lambda d: zw.limit(d, WALL, iterate=False),
    "available storage": lambda d: zw.available_storage(d, WALL, penetration=0.001, speed=0.1),
    "simulate": lambda d: zw.simulate(d, WALL, zw.operators.Finger(), 0.1),
    "batch": lambda d: zw.simulation.simulate_batch(
        d, WALL, zw.operators.Finger(), 0.1, vary={"environment.stiffness": [100, 200]}
    ),
    "simulated device": lambda d: zw.simulation.SimulatedDevice(d, zw.operators.Finger(), 0.1),
    "pair": lambda d: zw.Pair(d.motor_side, d, stiffness=10),
    "map": lambda d: zw.z_width(d, (0, 100), (0, 1), (3, 3)),
    "robust boundary": lambda d: zw.maps.robust_boundary(d, zw.operators.Finger(), (0, 1), points=3),
    "stability boundary": lambda d: zw.maps.stability_boundary(d),
    "compare": lambda d: zw.compare(d, WALL),
    "sweep": lambda d: zw.sweep(d, WALL, vary={"stiffness": [100, 200]}),
    "emit": lambda d: zw.emit(d, WALL),
    "emit anyway": lambda d: zw.emit(d, WALL, anyway=True),
    "serve": lambda d: zw.serve(d, WALL, hand=zw.operators.Finger(), duration=0.1),
    "port": lambda d: zw.links.NaiveWaves(d),
    "links": lambda d: zw.links.compare(d),
    "plan": lambda d: zw.plan(d, force_noise=0.01),
    "stability": lambda d: zw.stability.coupled_stability(d, WALL, zw.operators.Finger()),
    "absolute": lambda d: zw.stability.absolute_stability(d, zw.operators.Finger()),
    "activity": lambda d: zw.stability.tolerated_activity(d, WALL),
    "coupling": lambda d: zw.coupling.coupling_condition(d, 100),
    "design": lambda d: zw.coupling.design_coupling(d),
    "indices": lambda d: zw.ports.passivity_indices(WALL, d),
    "plane": lambda d: zw.formulas.plane_point(d, 100),
    "speed": lambda d: zw.formulas.admissible_speed(d, 100),
    "press": lambda d: zw.formulas.fast_press(d, 100),
    "edge": lambda d: zw.formulas.edge_crossing(d, 100),
    "worst": lambda d: zw.formulas.worst_case(d, 100, 0.001),
    "masses": lambda d: zw.coupling.passive_masses(d, zw.coupling.CoupledBody(100, 0, 0.1)),
    "heavy body": lambda d: zw.coupling.heavy_body_damping(d, 100),
    "picture": lambda d: zw.plots.plane(d, 100),
    "curve": lambda d: zw.plots.worst_case(d, 100),
    "doctor": lambda d: zw.servo.doctor(d, duration=60, progress=lambda *_: None),
    "tissue": lambda d: zw.tissue.AdaptiveSolid(d, (100, 100, 1)),
    "bounding": lambda d: zw.formulas.check_bounding(d, zw.render(WALL, zw.rendering.ForceBounding())),
}


@pytest.mark.parametrize("asked", REFUSED)
def test_it_is_never_taken_for_rigid(asked):
    """Whatever does not know a transmission says so, and what to give."""
    for device in (CERTAIN, CAPSTAN)[: 1 if asked in ("map", "absolute") else 2]:  # those take no interval
        with pytest.raises(zw.InputError, match=r"counts motor, encoder and hand as one.*\.motor_side"):
            REFUSED[asked](device)
