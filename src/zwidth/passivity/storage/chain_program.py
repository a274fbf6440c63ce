"""Laws in a chain and one domain as a dynamic program: which domain, which table, both approximations."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from math import ceil, floor
from typing import Any, ClassVar

import numpy as np

from zwidth.checker import verify
from zwidth.loop.kernel import R_HAND_WORK
from zwidth.loop.setup import empty_record, prepare
from zwidth.loop.simulate import run_setup
from zwidth.model.device.device import Device
from zwidth.model.device.friction import FrictionCurve
from zwidth.model.environment.environment import Environment
from zwidth.model.operator import PrescribedMotion
from zwidth.passivity.scope import Contact, Hands, Law
from zwidth.passivity.storage.chain_document import MOTION, ChainStorage, Run, columns, law_document, same_law
from zwidth.passivity.storage.chain_table import (
    MOST_STATES,
    NO_LAW,
    ChainGrid,
    ChainLaw,
    DoesNotClose,
    Table,
    chain_law,
    tabulate,
)
from zwidth.passivity.storage.domain import Domain, Losses, counts_of, losses_of
from zwidth.passivity.storage.gain import Gain, motion_document, straight
from zwidth.passivity.storage.hand_bounds import HandBounds, hand_bounds
from zwidth.passivity.storage.value_iteration import Progress, Until, ValueIteration, value_iteration
from zwidth.passivity.witness.motion import Motion, Repeat
from zwidth.quantity.exact import RealLike

COUNTS = ((32, 16), (16, 8), (8, 4), (4, 2))
"""Counts on either side and counts a sample that are tried by default, until the law closes."""

USUAL_STATES = 20_000
"""States within which it has to close on one of them."""


@dataclass(frozen=True, eq=False)
class ChainProgram:
    """Laws in a chain and one domain, on tables of either approximation; as `DynamicProgram`."""

    too_large: ClassVar[None] = None  # a domain that is too large has no table, and no dynamic program
    has_cells: ClassVar[bool] = False  # a table has the states of single counts
    is_large: ClassVar[bool] = False  # no closed form stands in for it
    takes_long: ClassVar[bool] = False  # how large its table is shows only as it is made

    device: Device
    environment: Environment
    law: ChainLaw
    losses: Losses
    domain: Domain
    counts: tuple[int, int]
    most: int

    @property
    def motion(self) -> str:
        """Linear or rotary."""
        return self.device.motion

    def checking(self, steps: int) -> float:
        """What the checker may have to do over a storage function, in the unit of `effort`."""
        moves = self.table.successors.size * (steps + 1) ** 2
        return 0.02 + moves / 300_000_000

    @property
    def bounds(self) -> HandBounds:
        """Bounds on the hand, exact."""
        return hand_bounds(NO_LAW, self.losses, self.domain)

    @property
    def hands(self) -> Hands:
        """The hands that a proof covers: they begin at rest outside, or at the first count."""
        far = float(self.bounds.penetration)
        return replace(self.bounds.hands(False), outside=far)

    @property
    def contact(self) -> Contact:
        """What is covered of contact."""
        return "made and broken" if self.law.unilateral else "both sides"

    @property
    def actuator(self) -> tuple[bool, bool]:
        """Whether force limit and converter steps are counted in."""
        return self.law.limited, self.law.stepped

    @property
    def inexact(self) -> tuple[Law, ...]:
        """What of the law is not exact."""
        return ("table",)

    @cached_property
    def table(self) -> Table:
        """All states of the law."""
        return tabulate(self.law, self.domain, self.most)

    def prove(
        self, steps: int, until: Until | None = None, progress: Progress | None = None
    ) -> ChainStorage | None:
        """A storage function on so many steps per count, or None."""
        grid = ChainGrid(NO_LAW, self.losses, self.domain, steps, "outer", table=self.table)
        iteration = value_iteration(grid, until, progress)
        return None if iteration.value is None else ChainStorage(iteration, self.motion, self.law)

    def prove_on_cells(
        self, cells: int, until: Until | None = None, progress: Progress | None = None
    ) -> None:
        """Nothing: a table has the states of every count."""

    def refute(self, steps: int, until: Until | None = None, progress: Progress | None = None) -> Gain | None:
        """A motion that gains, replayed by the simulator, or None."""
        within = self.domain.within
        if within.highest < 1:  # no reading inside lies within the bounds
            return None
        same = (within.lowest, within.highest) == (self.domain.lowest, self.domain.highest)
        table = self.table if same else tabulate(self.law, within, self.most)
        grid = ChainGrid(NO_LAW, self.losses, within, steps, "inner", table=table)
        iteration = value_iteration(grid, until, progress)
        return row_gain(iteration, self.law, self.device, self.environment) if iteration.cycle else None


def chain_program(
    device: Device,
    environment: Environment,
    penetration: RealLike | None = None,
    speed: RealLike | None = None,
    force_limit: bool = False,
    force_resolution: bool = False,
    friction: FrictionCurve | None = None,
    domains: Sequence[tuple[int, int]] = COUNTS,
    most: int = MOST_STATES,
) -> ChainProgram:
    """The dynamic program of laws in a chain; arguments as for `available_storage`.

    `domains` are tried for what is not given: counts on either side, and counts a sample.  On the last
    of them the law may have so many states as `most`.
    """
    losses = losses_of(device, friction)
    max_depth = counts_of("penetration", penetration, losses.resolution)
    max_speed = counts_of("speed", speed, losses.resolution / losses.period)
    tried = domains if not (max_depth and max_speed) else domains[:1]
    for far, reach in tried:
        depth = max_depth or Fraction(far)
        highest = max(1, ceil(depth) - 1)
        longest = ceil(max_speed) if max_speed else min(reach, 2 * highest + 1)
        domain = Domain(-highest - 1, highest, longest, depth, max_speed or None)
        law = chain_law(
            device, environment, domain.lowest, force_limit=force_limit, force_resolution=force_resolution
        )
        last = (far, reach) == tried[-1]
        most_states = most if last else USUAL_STATES
        program = ChainProgram(device, environment, law, losses, domain, (far, reach), most_states)
        try:
            _ = program.table
        except DoesNotClose:
            if last:
                raise
            continue
        return program
    raise AssertionError("the last domain that is tried returns or raises")


# From a cycle that gains against laws in a chain to a witness: replayed by the law, counted exactly.
#
# The cycle is one of states, so that the law does the same in each round, to the bit.


_NEAREST = 40  # halvings of a count by which a hand at an edge may have to stay inside its cell
_SLOWEST, _SETTLING = 50_000, 40  # samples of a slow way in, and rounds within which a law settles, at most
_LONGEST = 2_000_000  # samples that are simulated at most; of a longer motion the first rounds


def row_gain(
    iteration: ValueIteration[ChainGrid], law: ChainLaw, device: Device, environment: Environment
) -> Gain | None:
    """The cycle of a value iteration as a witness, or None if, run again, it gains nothing.

    It is accepted only if exact arithmetic finds a gain with the forces that the law gives, and
    the simulator finds energy coming out.
    """
    grid = iteration.grid
    for halvings in range(grid.count_steps.bit_length(), _NEAREST, 4):
        found_motion = _document(grid, iteration.cycle, law, halvings, device.motion)
        if found_motion is None:
            return None
        document, path = found_motion
        counted = verify(document)
        if counted.energy is None or counted.gain is None or counted.gain <= 0:  # it would leave the bounds
            continue
        energy, per_round = counted.energy, counted.gain
        times = 1 if energy > 0 else ceil(-energy / per_round) + 2
        document["repeats"]["times"] = times
        energy += (times - 1) * per_round
        path = path.repeated(times)
        found = Gain(
            {**document, "energy_J": energy},
            path,
            energy,
            per_round,
            NO_LAW,
            grid.losses,
            device.unit("position"),
        )
        if same_law(found.document, device, environment) and _simulated(path, law, device, environment):
            return found
    return None


def _document(
    grid: ChainGrid, cycle: tuple[tuple[int, int], ...], law: ChainLaw, halvings: int, motion: str
) -> tuple[dict[str, Any], Motion] | None:
    """Way in, one round, and the forces that the law gives; None if no way in is found."""
    resolution, counts = grid.losses.resolution, grid.table.counts
    round_ = [_place(grid, node, int(counts[state]), halvings) for node, state in cycle]
    way = _way_in(grid, cycle[0][1], round_[0], halvings) or _slow_way_in(grid, law, round_)
    if way is None:
        return None
    x = [*way, *round_[1:], round_[0]]
    part = Repeat(len(way) - 1, len(x) - 1, 1)
    run = Run(law, int(x[0] // resolution))
    forces = [Fraction(run.force(int(p // resolution))) for p in x[:-1]]
    path = Motion(tuple(x), (), (part,))
    bounds = hand_bounds(NO_LAW, grid.losses, grid.domain)
    document = motion_document(MOTION, grid.losses, law_document(law), bounds, path, motion)
    return {**document, columns(motion)[1]: forces}, path


def _way_in(grid: ChainGrid, goal: int, end: Fraction, halvings: int) -> list[Fraction] | None:
    """Positions on the shortest way to a state, within each count as near to the next as may be."""
    way = grid.table.way(goal, floor(grid.domain.speed))
    if way is None:
        return None
    near = Fraction(1, 2**halvings)
    x = [end / grid.losses.resolution]
    for state in reversed(way[:-1]):
        count = int(grid.table.counts[state])
        x.append(min(max(x[-1], count + near / 2**8), count + 1 - near))
    return [p * grid.losses.resolution for p in reversed(x)]


def _slow_way_in(grid: ChainGrid, law: ChainLaw, round_: list[Fraction]) -> list[Fraction] | None:
    """Straight in as fast as may be, then round until the law remembers after a round what it did before."""
    resolution = grid.losses.resolution
    end = round_[0] // resolution
    begin = min(law.resting, key=lambda n: abs(n - end))
    start = round_[0] if begin == end else (begin + Fraction(1, 2)) * resolution
    way = straight(start, round_[0], grid.domain.speed * resolution)
    if len(way) > _SLOWEST + 1:
        return None
    run, before = Run(law, begin), b""
    for p in way:
        run.force(int(p // resolution))
    for _ in range(_SETTLING):
        if run.memory == before:
            return way
        before = run.memory
        for p in (*round_[1:], round_[0]):
            run.force(int(p // resolution))
        way += [*round_[1:], round_[0]]
    return None


def _place(grid: ChainGrid, node: int, cell: int, halvings: int) -> Fraction:
    """Where the hand stands: near an edge a little inside its cell, where no rounding moves the reading."""
    near = Fraction(1, 2**halvings)
    x = Fraction(node, grid.steps)
    return min(max(x, cell + near / 2**8), cell + 1 - near) * grid.losses.resolution


def _simulated(path: Motion, law: ChainLaw, device: Device, environment: Environment) -> bool:
    """True if the simulator finds energy coming out: of all of it, or of the last of some rounds."""
    part = path.repeats[0]
    samples = part.last - part.first
    rounds = min(part.times, max(2, _LONGEST // samples))
    x = np.array([float(v) for v in path.positions])
    around = np.tile(x[part.first + 1 : part.last + 1], rounds)  # a round ends where it began
    x = np.concatenate((x[: part.first + 1], around, x[part.last + 1 :], x[-1:]))  # the mass at rest again
    period = device.exact("sample_period")
    setup = prepare(device, environment, PrescribedMotion(x), (len(x) - 1) * period)
    commands, record, work = empty_record(setup.frame)
    setup = replace(setup, law=law.packed)
    run_setup(setup, setup.state.copy(), setup.memory.copy(), work, commands, record, None)
    taken = -record[R_HAND_WORK]
    last, begun = (-1, 0) if rounds == part.times else (len(x) - 2, len(x) - 2 - samples)
    return bool(taken[last] > taken[begun])
