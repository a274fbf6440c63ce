"""What the page plays is what the simulator simulates, to the last bit."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from explorer.play.engines import Array, Job, moved, played, simulated

import zwidth as zw
from zwidth.loop.kernel import run
from zwidth.loop.plant import ACTUATOR_WORK, HAND_WORK, POSITION, VELOCITY
from zwidth.loop.setup import empty_record, prepare
from zwidth.model.operator import LinearHand, Tracking
from zwidth.show.explorer.play import Played, play_page, presets
from zwidth.show.explorer.play import played as play
from zwidth.show.explorer.play import played_pair as play_pair

HAND = LinearHand(mass=0.005, stiffness=300.0, damping=0.7)


def _device(**changes: object) -> zw.Device:
    given = {"mass": 0.04, "damping": 0.2, "coulomb_friction": 0.03, "resolution": 2e-5, "rate": 1000}
    return zw.Device(**{**given, **changes})  # type: ignore[arg-type]


def _loops() -> dict[str, Played]:
    """Loops of every kind of timing: the verdict is of no interest here."""
    wall = zw.check(_device(), zw.Wall(100))
    quick, slow = _device(), _device(rate=500, mass=0.07, damping=0.4)
    loops = {
        "delay of part of a sample": play(_device(delay=0.00027), zw.Wall(500, 0.3), wall),
        "delay of some samples and a part": play(_device(delay=0.0037, force_limit=3), zw.Wall(900), wall),
        "whole delay, no encoder, stiction": play(
            _device(resolution=0, stiction=0.05, delay=0.002), zw.Wall(700, 0.2), wall, hand=HAND
        ),
        "converter steps, a solid": play(
            _device(force_resolution=0.01), zw.StandardLinearSolid(80, 200, 3), wall, start=-0.003
        ),
        "wheel": play(
            zw.rotary(inertia=0.03, damping=0.1, coulomb_friction=0.02, resolution=1e-3, rate=2000),
            zw.PulseTransferFunction([8], [1]),
            wall,
        ),
    }
    cable = zw.Transmission(
        stiffness=2132, damping=0.02, handle_mass=0.03, handle_damping=0.09, handle_coulomb_friction=0.01
    )
    stiff = cable.replace(stiffness=28657, handle_coulomb_friction=0, encoder="handle")
    for name, changes in {
        "motor on a cable": {"transmission": cable, "delay": 0.0004},
        "encoder at the handle": {"transmission": stiff, "resolution": 0, "coulomb_friction": 0},
    }.items():
        loops[name] = play(_device(**changes), zw.Wall(200), wall, hand=HAND)
    for name, changes in {
        "arms at two rates": {"delay": (0.004, 0.011)},
        "drives of their own": {"follower": _device(), "drive_rate": 4000, "delay": 0.003},
        "reflection": {"reflection": 0.5, "follower_stiffness": 90, "delay": 0.0023},
    }.items():
        pair = zw.Pair(quick, slow, stiffness=120, damping=0.2, local_damping=0.1).replace(**changes)
        held = None if "reflection" in changes else HAND
        loops[name] = play_pair(pair, wall, hand=HAND, follower=held)
    return loops


def _same(one: Array, other: Array) -> bool:
    return one.shape == other.shape and bool((one == other).all())


def _near(one: Array, other: Array) -> bool:
    """Of two masses the page takes series where the simulator takes products: the same but for rounding."""
    return one.shape == other.shape and bool(np.allclose(one, other, 0.0, 1e-9 * np.abs(other).max(axis=0)))


def test_the_engine_moves_as_the_simulator_does(tmp_path: Path) -> None:
    loops = _loops()
    jobs = [Job(loop, moved(loop, 2.0, seed)) for seed, loop in enumerate(loops.values())]
    for name, job, rows in zip(loops, jobs, played(jobs, tmp_path), strict=True):
        assert np.unique(rows[:, 3]).size > 0.5 * len(rows), name
        alike = _same if getattr(job.loop.loop[0], "transmission", None) is None else _near
        assert alike(rows[:, 3:], simulated(job.loop, job.pointer)), name


def test_every_preset_moves_as_the_simulator_does(tmp_path: Path) -> None:
    loops = presets()
    jobs = [Job(loop, moved(loop, 3.0, 1)) for loop in loops]
    for job, rows in zip(jobs, played(jobs, tmp_path), strict=True):
        assert _same(rows[:, 3:], simulated(job.loop, job.pointer)), job.loop.name
        assert np.abs(rows[:, 5]).max() > 0.0, job.loop.name


def test_a_hand_that_lets_go(tmp_path: Path) -> None:
    """The hand's spring, damper and mass go while it does not hold: as the kernel, run in three parts."""
    loop = play(_device(delay=0.001), zw.Wall(800), zw.check(_device(), zw.Wall(100)), hand=HAND)
    pointer = moved(loop, 1.5, 5)
    held = np.ones(len(pointer))
    held[600:900] = 0.0
    (first,) = played([Job(loop, pointer, held)], tmp_path)
    taken = first[:, 1]  # where the handle was when the hand came back
    device, environment = loop.loop
    hand = Tracking(taken, stiffness=HAND.stiffness, damping=HAND.damping, mass=HAND.mass)
    setup = prepare(device, environment, hand, (len(pointer) - 1) * 0.001)
    commands, record, work = empty_record(setup.frame)
    state, memory = setup.state.copy(), setup.memory.copy()
    nobody = np.array(setup.frame.plant._replace(hand_mass=0.0, stiffness=0.0, hand_damping=0.0))
    force, anchor, target, switch = setup.frame.optional()
    frame = setup.frame
    for begin, end, numbers, path in (
        (0, 600, setup.plant_numbers, anchor),
        (600, 900, nobody, np.empty(0)),
        (900, len(pointer), setup.plant_numbers, anchor),
    ):
        run(
            begin, end, 1, state, numbers, setup.law, memory, work, frame.late, frame.offset, frame.lengths,
            frame.arrivals, frame.missed, force, path, target, switch, commands, record,
        )  # fmt: skip
    assert _same(first[:, 3:5].T, record[:2])
    last = first[-1]
    assert (last[3], last[4]) == (state[POSITION], state[VELOCITY])
    assert (last[6], last[7]) == (state[HAND_WORK], state[ACTUATOR_WORK])


def test_what_cannot_be_played_is_refused() -> None:
    with pytest.raises(zw.InputError, match="single value, the one that you take"):
        play(_device(damping=(0.1, 0.2)), zw.Wall(100))
    with pytest.raises(zw.InputError, match="mass"):
        play(zw.Device(damping=0.1, rate=1000), zw.Wall(100))
    with pytest.raises(zw.InputError, match="at most 10 s"):
        play(_device(delay=100), zw.Wall(100))
    with pytest.raises(zw.InputError, match="at least"):
        play_page([])
    law = zw.FrictionCompensation(coulomb=0.01, viscous=0.1, speed=0.01)
    with pytest.raises(zw.InputError, match="compensation"):
        play_pair(zw.Pair(_device(), _device(), stiffness=50, compensation=law))


def test_a_page_has_what_moves_two_masses_where_a_loop_has_them() -> None:
    cable = zw.Transmission(stiffness=2132, handle_mass=0.03)
    two = play(_device(transmission=cable), zw.Wall(90))
    assert two.facts()["arms"][0]["two"]["at_handle"] is False
    assert "plant.two = (() =>" in play_page([two])
    assert "plant.two = null;" in play_page([play(_device(), zw.Wall(90))])
    with pytest.raises(zw.InputError, match=r"transmission\.stiffness is unknown, and two masses"):
        play(_device(transmission=cable.replace(stiffness=None)), zw.Wall(90))


def test_a_motor_hums_on_its_cable_under_finger_tips_and_not_under_a_finger(tmp_path: Path) -> None:
    """Pressed and held still into 1000 N/m, where the motor alone pays for 120."""
    cable = zw.Transmission(stiffness=2132, handle_mass=0.03, handle_damping=0.09)
    device = zw.Device(mass=0.03, damping=0.06, rate=1000, transmission=cable)
    loops = [play(device, zw.Wall(1000), hand=hand) for hand in (LinearHand(0.006, 200, 0.2), None)]
    pointer = np.concatenate([np.linspace(loops[0].start, 0.01, 400), np.full(1200, 0.01)])
    tips, finger = played([Job(loop, pointer) for loop in loops], tmp_path)
    assert np.ptp(tips[-200:, 5]) > 0.5
    assert np.ptp(finger[-200:, 5]) < 1e-3
