"""From a pair and what is on both sides of it to the arrays that the kernel runs on."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import ceil
from typing import TYPE_CHECKING

import numpy as np

from zwidth.errors import InputError
from zwidth.loop.kernel import RECORDED
from zwidth.loop.law import measured, rounded
from zwidth.loop.pair.kernel import COULOMB_PART, Arm, Law
from zwidth.loop.plant import FORCE, GOAL, POSITION, STATE_SIZE, Plant
from zwidth.loop.setup import Frame, frame_of
from zwidth.model.device import FrictionCurve
from zwidth.model.device.amplifier import Amplifier
from zwidth.model.environment import Wall
from zwidth.model.environment.environment import certain
from zwidth.model.environment.velocity import BackwardDifference
from zwidth.model.operator.operator import Operator, Signals
from zwidth.model.pairs import Pair
from zwidth.quantity.exact import Exact, Interval, RealLike

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


class Nobody(Operator):
    """No hand: the arm moves as the actuator drives it."""

    def signals(self, times: Array) -> Signals:
        """Nothing."""
        return Signals()

    def describe(self, motion: str = "linear") -> str:
        """In words."""
        return "nobody"


NOBODY = Nobody()

Holder = Operator | Wall | None
"""What is on one side: a hand, a real wall at x = 0, or nothing."""


@dataclass(frozen=True, kw_only=True, eq=False)
class PairSetup:
    """A pair ready to run: descriptions for people, arrays for the kernel; leader first."""

    pair: Pair
    holders: tuple[Holder, Holder]
    frames: tuple[Frame, Frame]
    arms: tuple[Arm, Arm]

    @property
    def often(self) -> int:
        """Ticks in T."""
        return self.pair.own_readings

    @property
    def ticks(self) -> int:
        """Of the whole simulation."""
        return self.frames[0].samples

    @property
    def points(self) -> int:
        """Instants recorded in a tick."""
        return self.frames[0].points

    @property
    def columns(self) -> int:
        """Instants in the record."""
        return self.ticks * self.points + 1

    @property
    def tick(self) -> float:
        """How long one is [s]."""
        return float(self.frames[0].period)


def prepare_pair(
    pair: Pair,
    leader: Holder,
    follower: Holder,
    duration: RealLike,
    *,
    encoder_phase: tuple[float, float] = (0.0, 0.0),
    amplifier: Amplifier | None = None,
    points_per_sample: int = 1,
    friction: tuple[FrictionCurve | None, FrictionCurve | None] = (None, None),
) -> PairSetup:
    """Check everything and lay it out; arguments as of `simulate_pair`."""
    holders = (leader, follower)
    walls = [_wall(name, holder) for name, holder in zip(("leader", "follower"), holders, strict=True)]
    if all(not isinstance(holder, Operator) for holder in holders):
        raise InputError(
            "no hand is on either arm, so nothing moves: give one as leader or follower, such as "
            "zwidth.operators.Finger()"
        )
    rate = Exact(pair.own_readings / pair.sample_period)
    devices = [device.replace(rate=rate) for device in (pair.leader, pair.follower)]
    hands = [one if isinstance(one, Operator) else NOBODY for one in holders]
    frames = [
        frame_of(device, hand, duration, amplifier, None, points_per_sample)
        for device, hand in zip(devices, hands, strict=True)
    ]
    starts = _starts(frames, holders)
    arms = [
        _arm(pair, here, frame, wall, starts[here], phase, curve)
        for here, (frame, wall, phase, curve) in enumerate(
            zip(frames, walls, encoder_phase, friction, strict=True)
        )
    ]
    for arm, other in zip(arms, arms[::-1], strict=True):
        _settle(arm, other)
    return PairSetup(pair=pair, holders=holders, frames=(frames[0], frames[1]), arms=(arms[0], arms[1]))


def _wall(name: str, holder: object) -> Wall | None:
    """The real wall that stands there, if one does."""
    if holder is None or isinstance(holder, Operator):
        return None
    if not isinstance(holder, Wall):
        raise InputError(
            f"{name} is a hand of zwidth.operators, a zwidth.Wall that stands there, or None for nobody; "
            f"got {type(holder).__name__}"
        )
    if holder.clamped or not isinstance(holder.velocity_filter, BackwardDifference):
        raise InputError(
            f"{name}: a real wall is a spring and a damper that act without computing; leave out clamped and "
            "velocity_filter"
        )
    for key, value in (("stiffness", holder.stiffness), ("damping", holder.damping)):
        if isinstance(value, Interval):
            raise InputError(f"{name}: the {key} of a real wall is one number, got the interval {value}")
    if certain(holder.damping, "damping") < 0:
        raise InputError(f"{name}: a real wall has no damping below 0: it would give out energy itself")
    return holder


def _starts(frames: list[Frame], holders: tuple[Holder, Holder]) -> list[float]:
    """Where each begins: where its hand does; the other with it."""
    given: list[float | None] = []
    for frame, holder in zip(frames, holders, strict=True):
        if frame.signals.position is not None:
            given.append(float(frame.signals.position[0]))
        else:
            given.append(float(holder.initial_position) if isinstance(holder, Operator) else None)
    there = next(start for start in given if start is not None)
    return [there if start is None else start for start in given]


def _arm(
    pair: Pair,
    here: int,
    frame: Frame,
    wall: Wall | None,
    start: float,
    phase: float,
    friction: FrictionCurve | None,
) -> Arm:
    if not 0 <= phase < 1:
        raise InputError(f"encoder_phase is a part of one count, 0 ≤ phase < 1, got {phase:g}")
    state = np.zeros(STATE_SIZE)
    state[POSITION] = start
    curve = lines_of(friction)
    free = frame.plant if friction is None else frame.plant._replace(stiction=float(curve[0, COULOMB_PART]))
    samples, often = frame.samples, pair.own_readings
    force, anchor, target, switch = frame.optional()
    return Arm(
        plant=free,
        inside=free if wall is None else _inside(free, wall),
        wall=int(wall is not None),
        curve=curve,
        law=_law(pair, here, frame, phase),
        late=frame.late,
        offset=frame.offset,
        state=state,
        readings=np.zeros(samples + 1),
        sent=np.zeros(samples // often + 1),
        told=np.zeros(1),
        commands=np.zeros(samples + 1),
        record=np.empty((RECORDED, samples * frame.points + 1)),
        force=force,
        anchor=anchor,
        target=target,
        switch=switch,
    )


def lines_of(friction: FrictionCurve | None) -> Array:
    """From where, f_i and b_i of the lines of a curve, as far as it says anything; none without one."""
    if friction is None:
        return np.empty((0, 3))
    points = [(float(v), float(f)) for v, f in zip(friction.speeds, friction.forces, strict=True)]
    rows = [(0.0, points[0][1], 0.0)] if points[0][0] > 0 else []
    for (v, f), (w, g) in pairwise(points):
        slope = (g - f) / (w - v)
        rows.append((v, f - slope * v, slope))
    if rows[-1][2] < 0:  # a last chord that falls is not continued
        rows.append((*points[-1], 0.0))
    return np.array(rows)


def _inside(free: Plant, wall: Wall) -> Plant:
    stiffness, damping = (float(certain(value, "wall")) for value in (wall.stiffness, wall.damping))
    return free._replace(stiffness=stiffness, hand_damping=damping)


def _law(pair: Pair, here: int, frame: Frame, phase: float) -> Law:
    side = pair.sides[here]
    period = pair.sample_period
    past = pair.readings[here] * (side.virtual_damping + side.local_damping) / period
    back = side.echo_damping / period
    heard = side.virtual_damping / period + back
    return Law(
        own=float(side.stiffness + past),
        own_before=-float(past),
        every=pair.own_readings // pair.readings[here],
        heard=-float(side.felt_stiffness + heard),
        heard_before=float(heard),
        age=ceil(side.link_delay / period),
        echo=float(side.echo_stiffness + back),
        echo_before=-float(back),
        echo_age=ceil(side.link_delay / period) + ceil(side.return_delay / period),
        coulomb=float(side.compensation.coulomb),
        viscous=float(side.compensation.viscous),
        speed=float(side.compensation.speed),
        period=float(period),
        resolution=frame.resolution,
        phase=phase,
        step=frame.actuation.step,
        limit=frame.actuation.limit,
    )


def _settle(arm: Arm, other: Arm) -> None:
    """The force as it was before the start: both arms had always been where they are."""
    law = arm.law
    mine, heard = (measured(a.state[POSITION], a.law.resolution, a.law.phase) for a in (arm, other))
    f = (law.own + law.own_before + law.echo + law.echo_before) * mine
    f += (law.heard + law.heard_before) * heard
    f = rounded(f, law.step)
    if law.limit:
        f = min(max(f, -law.limit), law.limit)
    arm.state[FORCE] = arm.state[GOAL] = f
