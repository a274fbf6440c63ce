"""Laws in a chain and one domain as a dynamic program: which domain, which table, both approximations."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from math import ceil

from zwidth.model.device.device import Device
from zwidth.model.device.friction import FrictionCurve
from zwidth.model.environment.environment import Environment
from zwidth.passivity.scope import Contact, Hands, Law
from zwidth.passivity.storage.domain import Domain, counts_of, losses_of
from zwidth.passivity.storage.evidence.gain import Gain
from zwidth.passivity.storage.hand_bounds import HandBounds, hand_bounds
from zwidth.passivity.storage.losses import Losses
from zwidth.passivity.storage.row.gain import row_gain
from zwidth.passivity.storage.row.grid import NO_LAW, RowGrid
from zwidth.passivity.storage.row.law import RowLaw, row_law
from zwidth.passivity.storage.row.storage_function import RowStorage
from zwidth.passivity.storage.row.table import MOST_STATES, DoesNotClose, Table, tabulate
from zwidth.passivity.storage.solve.effort import Until
from zwidth.passivity.storage.solve.value_iteration import Progress, value_iteration
from zwidth.quantity.exact import RealLike

COUNTS = ((32, 16), (16, 8), (8, 4), (4, 2))
"""Counts on either side and counts a sample that are tried by default, until the law closes."""

USUAL_STATES = 20_000
"""States within which it has to close on one of them."""


@dataclass(frozen=True, eq=False)
class RowProgram:
    """Laws in a chain and one domain, on tables of either approximation; as `DynamicProgram`."""

    device: Device
    environment: Environment
    law: RowLaw
    losses: Losses
    domain: Domain
    counts: tuple[int, int]
    most: int

    @property
    def motion(self) -> str:
        """Linear or rotary."""
        return self.device.motion

    @property
    def too_large(self) -> None:
        """Nothing: a domain that is too large has no table, and no dynamic program."""
        return

    @property
    def has_cells(self) -> bool:
        """False: a table has the states of single counts."""
        return False

    @property
    def is_large(self) -> bool:
        """True where a storage function takes its time: no closed form stands in for it."""
        return False

    @property
    def takes_long(self) -> bool:
        """False: how large its table is shows only as it is made."""
        return False

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
    ) -> RowStorage | None:
        """A storage function on so many steps per count, or None."""
        grid = RowGrid(NO_LAW, self.losses, self.domain, steps, "outer", table=self.table)
        iteration = value_iteration(grid, until, progress)
        return None if iteration.value is None else RowStorage(iteration, self.motion, self.law)

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
        grid = RowGrid(NO_LAW, self.losses, within, steps, "inner", table=table)
        iteration = value_iteration(grid, until, progress)
        return row_gain(iteration, self.law, self.device, self.environment) if iteration.cycle else None


def row_program(
    device: Device,
    environment: Environment,
    penetration: RealLike | None = None,
    speed: RealLike | None = None,
    force_limit: bool = False,
    force_resolution: bool = False,
    friction: FrictionCurve | None = None,
    domains: Sequence[tuple[int, int]] = COUNTS,
    most: int = MOST_STATES,
) -> RowProgram:
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
        law = row_law(
            device, environment, domain.lowest, force_limit=force_limit, force_resolution=force_resolution
        )
        last = (far, reach) == tried[-1]
        most_states = most if last else USUAL_STATES
        program = RowProgram(device, environment, law, losses, domain, (far, reach), most_states)
        try:
            _ = program.table
        except DoesNotClose:
            if last:
                raise
            continue
        return program
    raise AssertionError("the last domain that is tried returns or raises")
