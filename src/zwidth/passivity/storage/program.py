"""One loop and one domain as a dynamic program: proofs by outer approximation, motions by inner.

State: position, and what the law remembers.  Move: Δx in one sample.  Reward:

    −f Δx − f_c |Δx| − (b/T) Δx²
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from math import floor
from typing import Any

from zwidth.errors import InputError
from zwidth.model.device.device import Device
from zwidth.model.device.friction import FrictionCurve
from zwidth.model.device.instead import instead_of_device
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.transfer_function import as_environment
from zwidth.model.rendering.rendered import laws_of
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.scope import Contact, Hands, Law, Scope, scope_of
from zwidth.passivity.storage.chain_program import ChainProgram, chain_program
from zwidth.passivity.storage.domain import Domain, Losses, domain_for, losses_of, states_of, too_large
from zwidth.passivity.storage.gain import Gain, gain
from zwidth.passivity.storage.grid import Approximation, Grid
from zwidth.passivity.storage.hand_bounds import HandBounds, bounds_given, hand_bounds
from zwidth.passivity.storage.law import FiniteLaw, finite_law
from zwidth.passivity.storage.relaxing_grid import RelaxingGrid
from zwidth.passivity.storage.slope_motion import slope_motion
from zwidth.passivity.storage.storage_function import CELLS, StorageFunction, has_cells, prove_on_cells
from zwidth.passivity.storage.value_iteration import Progress, Until, freely, value_iteration
from zwidth.quantity.exact import RealLike

STEPS = (8, 16, 32, 64)
"""Steps in which a count is cut, coarse to fine, when a proof is sought."""

FINE = (1024, 16384)
"""The same when a motion is sought; its nodes lie near the edges."""

_QUICK = 100_000_000  # pairs of states and moves up to which a storage function is sought at once
_CHECKED, _SLOWER = 300_000_000, 10
"""Of such pairs, in a unit of `effort`; and by how much laws that relax take longer."""

_LONG = 0.2
"""In that unit, what the checker has to do on the coarsest steps where a search takes twenty times that."""

_MOST_CHECKED = 1_500_000_000  # the same: what the checker takes on
_STEPS_PER_MOVE = 256  # steps in the longest move of a hand, at least, when a motion is sought
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
        if self.law.points and (found := slope_motion(self.law, self.losses, self.motion, self.bounds)):
            return found
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
) -> DynamicProgram | ChainProgram:
    """The dynamic program of a loop; arguments as for `available_storage`."""
    if not isinstance(device, Device):
        raise InputError(f"the first argument is a Device, {instead_of_device(device)}")
    if friction is not None and not isinstance(friction, FrictionCurve):
        raise InputError(f"friction is a FrictionCurve, got {type(friction).__name__}")
    given = as_environment(environment, device=device)
    penetration, speed = bounds_given(device, penetration, speed)
    if laws_of(given):
        return chain_program(device, given, penetration, speed, force_limit, force_resolution, friction)
    law = finite_law(device, given, force_limit=force_limit, force_resolution=force_resolution)
    losses = losses_of(device, friction)
    return DynamicProgram(law, losses, domain_for(law, losses, penetration, speed), device.motion)


def program_scope(device: Device, environment: Environment, program: DynamicProgram | ChainProgram) -> Scope:
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


# Which cells a motion is sought on: every n-th count of a fine encoder first, then every count.
#
# A hand that keeps to the first of every n counts is a hand like any other.  On cells of n counts it is
# found as quickly as behind a coarse encoder, and its motion gains behind the fine one, where it is counted.


_REACHES = (4, 12, 24)  # cells that the hand may go in one sample, about
_FEW = 24  # counts a sample up to which every count is looked at, and nothing else
_NEAR = 12  # counts a sample of a hand that stays near an edge, where there are too many for all of them
_MAX_DEPTH = 64  # cells that are looked at: for a law that is linear inside, depth by itself is of no use
_MOST_WORK = 60_000  # states of a grid times the cells in reach, up to which a motion is sought on it


def grids(law: FiniteLaw, losses: Losses, domain: Domain) -> list[tuple[int, Domain]]:
    """Counts in a cell, and the cells within the bounds; coarse to fine; none on which no hand moves."""
    within = domain.within
    far = min(domain.speed, Fraction(within.highest))
    remembered = law.memory + losses.delay
    found = []
    many = far > _FEW or _work(law, losses, within) > _MOST_WORK
    for reach in _REACHES if many else ():
        counts = _counts(far, reach)
        cells = domain.every(counts, remembered, _two_sided(law)) if counts > 1 else None
        if cells is not None:
            found.append((counts, _shallow(law, cells)))
    here = within, _shallow(law, within), _near(law, within, remembered)
    chosen = next((d for d in here if _work(law, losses, d) <= _MOST_WORK), here[-1])
    whole = [] if chosen == within or too_large(law, losses, within) else [(1, within)]  # last, as it is slow
    return [(counts, cells) for counts, cells in (*found, (1, chosen), *whole) if cells.reach > 0]


def _work(law: FiniteLaw, losses: Losses, domain: Domain) -> int:
    more = 1 if law.memory + losses.delay else 2 * domain.reach + 1
    return states_of(law, losses, domain) * more


def _counts(far: Fraction, reach: int) -> int:
    """Counts in a cell with which the longest way is about `reach` cells and hardly anything more."""
    about = far / reach
    candidates = range(max(1, floor(about * 3 / 4)), max(1, floor(about * 4 / 3)) + 1)
    return max(candidates, key=lambda n: (floor((far + 1) / n) * n / (far + 1), n))


def _two_sided(law: FiniteLaw) -> bool:
    return law.surface == "none" or (law.relaxing is not None and law.surface == "position")


def _shallow(law: FiniteLaw, domain: Domain) -> Domain:
    """Only some cells deep, where the law is linear inside."""
    if law.is_curve or law.relaxing is not None:
        return domain
    lowest = max(domain.lowest, -_MAX_DEPTH) if law.surface == "none" else domain.lowest
    return replace(domain, lowest=lowest, highest=min(domain.highest, max(_MAX_DEPTH, 3 * domain.reach)))


def _near(law: FiniteLaw, domain: Domain, remembered: int) -> Domain:
    """A hand that stays near an edge: few counts deep, few counts in a sample."""
    reach = min(domain.reach, _NEAR // (1 + remembered))
    highest = min(domain.highest, 2 * _NEAR)
    lowest = max(domain.lowest, -2 * _NEAR if _two_sided(law) else 1 - (remembered + 1) * reach)
    return replace(
        domain, lowest=lowest, highest=highest, reach=reach, max_speed=min(domain.speed, Fraction(reach))
    )
