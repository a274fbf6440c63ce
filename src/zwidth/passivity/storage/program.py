"""One loop and one domain as a dynamic program: proofs by outer approximation, motions by inner.

State: position, and what the law remembers.  Move: Δx in one sample.  Reward:

    −f Δx − f_c |Δx| − (b/T) Δx²
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from zwidth.errors import InputError
from zwidth.model.device.device import Device
from zwidth.model.device.friction import FrictionCurve
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.transfer_function import as_environment
from zwidth.model.rendering.rendered import laws_of
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.scope import Contact, Hands, Law, Scope, scope_of
from zwidth.passivity.storage.domain import Domain, domain_for, losses_of, states_of, too_large
from zwidth.passivity.storage.evidence.coarse import CELLS, has_cells, prove_on_cells
from zwidth.passivity.storage.evidence.gain import Gain, gain
from zwidth.passivity.storage.evidence.storage_function import StorageFunction
from zwidth.passivity.storage.grid.choice import grids
from zwidth.passivity.storage.grid.grid import Approximation, Grid
from zwidth.passivity.storage.grid.relaxing import RelaxingGrid
from zwidth.passivity.storage.hand_bounds import HandBounds, hand_bounds
from zwidth.passivity.storage.law import FiniteLaw, finite_law
from zwidth.passivity.storage.losses import Losses
from zwidth.passivity.storage.row.program import RowProgram, row_program
from zwidth.passivity.storage.solve.effort import Until, freely
from zwidth.passivity.storage.solve.value_iteration import Progress, value_iteration
from zwidth.quantity.exact import RealLike

STEPS = (8, 16, 32, 64)
"""Steps in which a count is cut, coarse to fine, when a proof is sought."""

FINE = (1024, 16384)
"""The same when a motion is sought; its nodes lie near the edges."""

_QUICK = 100_000_000
"""Pairs of states and moves up to which a storage function is sought at once."""

_CHECKED, _SLOWER = 300_000_000, 10
"""Of such pairs, in a unit of `effort`; and by how much laws that relax take longer."""

_LONG = 0.2
"""In that unit, what the checker has to do on the coarsest steps where a search takes twenty times that."""

_MOST_CHECKED = 1_500_000_000
"""The same: what the checker takes on."""

_STEPS_PER_MOVE = 256
"""Steps in the longest move of a hand, at least, when a motion is sought."""

_MOST_STEPS = 2**20

_STEPS_OF_MANY = 4
"""Steps per count at least, where a cell is many counts: what a move costs is not to be rounded much."""


@dataclass(frozen=True)
class DynamicProgram:
    """One loop and one domain, on grids of either approximation."""

    law: FiniteLaw
    losses: Losses
    domain: Domain
    motion: str

    @property
    def hands(self) -> Hands:
        """The hands that a proof covers."""
        return self.bounds.hands(self.losses.part != 1)

    @property
    def bounds(self) -> HandBounds:
        """The same, exact."""
        return hand_bounds(self.law, self.losses, self.domain)

    @property
    def too_large(self) -> str | None:
        """Why no storage function is sought on this grid, in words; None where one is."""
        return too_large(self.law, self.losses, self.domain)

    @property
    def is_large(self) -> bool:
        """True where a storage function takes its time."""
        return self._moves(STEPS[0]) > _QUICK or self.too_large is not None

    @property
    def takes_long(self) -> bool:
        """True where a search for a limit goes on for more than some seconds: it decides many loops."""
        return self.checking(STEPS[0]) > _LONG or self.too_large is not None

    def checking(self, steps: int) -> float:
        """What the checker may have to do over a storage function, in the unit of `effort`."""
        return 0.02 + self._moves(steps) / _CHECKED

    def _moves(self, steps: int) -> int:
        """Pairs of states and moves on the grid, by the outer approximation."""
        moves = states_of(self.law, self.losses, self.domain) * (2 * self.domain.reach + 1) * (steps + 1) ** 2
        if self.law.relaxing is not None:
            return moves * max(1, steps // 8) * _SLOWER
        return moves if self.losses.part == 1 else moves * 2

    @property
    def contact(self) -> Contact:
        """What is covered of contact."""
        return "both sides" if self.law.surface == "none" else "made and broken"

    @property
    def actuator(self) -> tuple[bool, bool]:
        """Whether force limit and converter steps are counted in."""
        return self.law.force_limit is not None, self.law.force_step is not None

    @property
    def inexact(self) -> tuple[Law, ...]:
        """What of the law is not exact."""
        if self.law.power is None or self.law.power[1].denominator == 1:
            return ()
        return ("rounded power",)

    def prove(
        self, steps: int, until: Until | None = None, progress: Progress | None = None
    ) -> StorageFunction | None:
        """A storage function on so many steps per count that the checker accepts, or None."""
        if self.too_large is not None or self._moves(steps) > _MOST_CHECKED:
            return None
        grid = self._grid(self.losses, self.domain, steps, "outer")
        iteration = value_iteration(grid, until, progress)
        return None if iteration.value is None else StorageFunction(iteration, self.motion)

    @property
    def has_cells(self) -> bool:
        """True where a proof may be sought on cells of many counts."""
        return any(has_cells(self.law, self.losses, self.domain, cells) for cells in CELLS)

    def prove_on_cells(
        self, cells: int, until: Until | None = None, progress: Progress | None = None
    ) -> Certificate | None:
        """A proof that the checker accepts, on cells of which the longest move has so many, or None."""
        limit = freely() if until is None else until
        return prove_on_cells(self.law, self.losses, self.domain, self.motion, cells, limit, progress)

    def refute(self, steps: int, until: Until | None = None, progress: Progress | None = None) -> Gain | None:
        """A motion that gains, recomputed exactly, or None."""
        if self.domain.within.highest < 1:  # no reading inside lies within the bounds
            return None
        for every, domain in grids(self.law, self.losses, self.domain):
            if until is not None and until.is_over:
                break
            cells = replace(self.losses, resolution=self.losses.resolution * every)
            fine = max(self._fine_enough(steps) // every, _STEPS_OF_MANY) * every
            grid = self._grid(cells, domain, fine, "inner", every)
            iteration = value_iteration(grid, until, progress)
            motion = gain(iteration, self.motion, self.bounds) if iteration.cycle else None
            if motion is not None:
                return motion
        return None

    def _fine_enough(self, steps: int) -> int:
        """Steps per count, more of them for a hand that goes less than a count in each part of a sample."""
        shortest = self.domain.speed * (min(self.losses.part, 1 - self.losses.part) or 1)
        while steps * shortest < _STEPS_PER_MOVE and steps < _MOST_STEPS:
            steps *= 2
        return steps

    def _grid(
        self, losses: Losses, domain: Domain, steps: int, approximation: Approximation, every: int = 1
    ) -> Grid:
        if self.law.relaxing is None:
            return Grid(self.law, losses, domain, steps, approximation, every)
        levels = max(1, steps // 8) if approximation == "outer" else 2
        return RelaxingGrid(self.law, losses, domain, steps, approximation, every, levels)


def program_of(
    device: Device,
    environment: Environment | Any,
    penetration: RealLike | None = None,
    speed: RealLike | None = None,
    force_limit: bool = False,
    force_resolution: bool = False,
    friction: FrictionCurve | None = None,
) -> DynamicProgram | RowProgram:
    """The dynamic program of a loop; arguments as for `available_storage`."""
    if not isinstance(device, Device):
        raise InputError(f"the first argument is a Device, got {type(device).__name__}")
    if friction is not None and not isinstance(friction, FrictionCurve):
        raise InputError(f"friction is a FrictionCurve, got {type(friction).__name__}")
    given = as_environment(environment)
    if laws_of(given):
        return row_program(device, given, penetration, speed, force_limit, force_resolution, friction)
    law = finite_law(device, given, force_limit=force_limit, force_resolution=force_resolution)
    losses = losses_of(device, friction)
    return DynamicProgram(law, losses, domain_for(law, losses, penetration, speed), device.motion)


def program_scope(device: Device, environment: Environment, program: DynamicProgram | RowProgram) -> Scope:
    """What a proof from a dynamic program is about."""
    losses, (limited, stepped) = program.losses, program.actuator
    curved = losses.curve is not None
    return scope_of(device, environment).replace(
        hands=program.hands,
        contact=program.contact,
        damping=None if curved else float(losses.damping),
        coulomb_friction=None if curved else float(losses.coulomb_friction),
        friction=losses.curve,
        force_limit=limited,
        force_steps=stepped,
        law=program.inexact,
    )
