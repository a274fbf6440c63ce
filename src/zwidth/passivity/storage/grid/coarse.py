"""A grid for encoders that are finer than what is looked at: cells of any length, V at their ends.

y = x − Δ; the law acts inside where y ≥ 0.  A reading is y + Δ/2 but for Δ/2, which Coulomb friction pays for
(‖c‖₁ Δ/2); the force of y + Δ/2 is linear within the cells.  By the rules of this grid

    a move over D cells costs  φ D,  φ − κ,  φ D + β D² − (β + κ)/4     for D = 0, D = 1, D ≥ 2

κ = max(Σ c⁺, Σ c⁻): a hand that gains nothing at the cells' ends gains nothing in between (see the
documentation).  At y = 0 there are two ends, the outer and the inner one.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from math import ceil, floor

import numpy as np

from zwidth.passivity.storage.domain import Domain
from zwidth.passivity.storage.grid.grid import Grid
from zwidth.passivity.storage.law import FiniteLaw
from zwidth.passivity.storage.losses import Integers, Losses


@dataclass(frozen=True, kw_only=True)
class CoarseGrid(Grid):
    """Ends of cells in a row; domain and losses are in cells, the ends counted from the lowest.

    Parameters
    ----------
    count
        Δ, the encoder's own [m; rad].
    """

    count: Fraction

    @property
    def sheets(self) -> int:
        """1 where the surface is two ends."""
        return int(self.law.surface != "none")

    @cached_property
    def nodes(self) -> Integers:
        """One for each end."""
        return np.zeros(1, np.int64)

    @cached_property
    def places(self) -> Integers:
        """Where each end is, in cells."""
        ends = np.arange(self.domain.lowest, self.domain.highest + 1, dtype=np.int64)
        return ends - self.sheets * (ends > 0)

    @property
    def hull_steps(self) -> int:
        """0: the ends are not all as far apart."""
        return 0

    @property
    def rounding(self) -> int:
        """Units by which a force may be off."""
        return len(self.law.taps) * (int(np.abs(self.places).max()) + 1)

    def _costs(self, part: Fraction) -> Integers:
        taps, unit, cell = self.law.taps, self.force_unit, self.losses.resolution
        far = np.arange(ceil(self.domain.speed * part) + 1, dtype=np.int64)
        friction = self.losses.coulomb_friction - sum(map(abs, taps), Fraction(0)) * self.count / 2
        drag = floor(self.losses.damping / (part * self.losses.period) * cell / unit)
        rising, falling = (sum((max(s * c, Fraction(0)) for c in taps), Fraction(0)) for s in (1, -1))
        lost = ceil(max(rising, falling) * cell / unit)
        curved = np.where(far > 1, drag * far**2 - (drag + lost + 3) // 4, np.where(far > 0, -lost, 0))
        out: Integers = (floor(friction / unit) - self.rounding) * far + curved
        return out

    def _force(self, readings: list[Integers]) -> Integers:
        """Of ends in place of readings."""
        sheets, law, unit = self.sheets, self.law, self.force_unit
        force = np.zeros(np.broadcast_shapes(*(r.shape for r in readings)), dtype=np.int64)
        for tap, end in zip(law.taps, readings, strict=True):
            place = end - sheets * (end > 0)
            fed = floor(tap * self.losses.resolution / unit) * place + floor(tap * self.count / 2 / unit)
            force = force + (np.where(end > 0, fed, 0) if law.surface == "penetration" else fed)
        return np.where(np.broadcast_to(readings[0], force.shape) > 0, force, 0) if sheets else force

    @cached_property
    def first_guess(self) -> Integers:
        """The energy of the spring."""
        stiffness = self.law.static_stiffness * self.losses.resolution / self.force_unit
        depth = np.maximum(self.places, 0) if self.sheets else self.places
        energy = np.ceil(np.maximum(float(stiffness) * depth.astype(float) ** 2 / 2, 0)).astype(np.int64)
        shape = (len(self.places), self.histories, 1)
        out: Integers = np.broadcast_to(energy[:, None, None], shape).copy()
        return out


def coarse_grid(law: FiniteLaw, losses: Losses, domain: Domain, cells: int) -> CoarseGrid | None:
    """The grid on which the longest move is so many cells; None for a law that is not linear inside."""
    bent = law.is_curve or law.clamped or law.relaxing is not None or law.rate
    if bent or law.force_limit is not None or law.force_step is not None or losses.curve is not None:
        return None
    counts = domain.speed / cells
    if counts <= 1 or not law.taps:
        return None
    sheets = law.surface != "none"
    highest = ceil((domain.highest + 1) / counts)
    memory = law.memory + losses.delay
    lowest = -(memory + 1) * cells if sheets else -highest - 1
    within = Domain(lowest, highest + sheets, cells + sheets, None, Fraction(cells))
    cell = replace(losses, resolution=losses.resolution * counts)
    return CoarseGrid(law, cell, within, 1, "outer", count=losses.resolution)
