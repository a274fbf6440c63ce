"""The storage function as a certificate, on counts or on longer cells, and as a labelled array to look at.

V(s) is the most energy that a hand can ever take out from state s, or a little
more.  It is the proof: no move takes out more than V falls.
"""

from __future__ import annotations

import base64
import zlib
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from math import ceil, floor
from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth.passivity.certificate import FORMAT, Certificate
from zwidth.passivity.scope import unit_key
from zwidth.passivity.storage.domain import Domain, Integers, Losses
from zwidth.passivity.storage.grid import Grid
from zwidth.passivity.storage.law import FiniteLaw
from zwidth.passivity.storage.value_iteration import Progress, Until, ValueIteration, value_iteration
from zwidth.quantity.glossary import GLOSSARY, unit_suffix
from zwidth.quantity.text import exact_text

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class StorageFunction:
    """The available storage of a loop, from above."""

    iteration: ValueIteration[Any]  # a value iteration that no motion ended
    motion: str  # "linear" or "rotary"

    @property
    def grid(self) -> Grid:
        """On which V is given."""
        grid: Grid = self.iteration.grid
        return grid

    @property
    def value(self) -> Integers:
        """V of each state, in energy units."""
        assert self.iteration.value is not None, "only where no motion gains is there a storage function"
        return self.iteration.value

    def certificate(self) -> Certificate:
        """The proof as data: the law, the losses, the grid, V."""
        return Certificate((self._document("storage", self.grid.law_document(self.motion)),))

    def _document(self, kind: str, law: dict[str, Any], **tables: Any) -> dict[str, Any]:
        return {
            "format": FORMAT,
            "kind": kind,
            "loop": loop_document(self.grid.losses, self.motion),
            "law": law,
            "domain": self.grid.domain_document(),
            "force_unit": exact_text(self.grid.force_unit),
            **tables,
            "storage": packed(self.value),
        }

    def to_xarray(self) -> xr.DataArray:
        """V along the position, by what the law remembers [J].

        Dims `reading_before` [counts], of a law that relaxes `average_reading` [counts], of laws in a chain
        `remembered` (the least and the most over all), and `position` [m; rad]; each edge between two
        counts is there twice, from below and from above.
        """
        import xarray as xr

        grid = self.grid
        name, remembered, value = grid.remembered(self.value)
        cells = np.arange(grid.domain.lowest, grid.domain.highest + 1)
        x = (cells[:, None] + grid.nodes[None, :] / grid.steps) * float(grid.losses.resolution)
        counted = {} if isinstance(remembered, list) else {"units": "counts"}
        unit = GLOSSARY["position"].unit_for(self.motion)
        return xr.DataArray(
            value.reshape(len(remembered), -1) * float(grid.energy_unit),
            dims=(name, "position"),
            coords={name: (name, remembered, counted), "position": ("position", x.ravel(), {"units": unit})},
            attrs={"units": "J", "long_name": "available storage, at most"},
            name="available_storage",
        )


def packed(values: Any, kind: str = "<i8") -> str:
    """Numbers as text: little-endian, compressed."""
    raw = np.ascontiguousarray(values).astype(kind).tobytes()
    return base64.b64encode(zlib.compress(raw, 6)).decode("ascii")


def loop_document(losses: Losses, motion: str) -> dict[str, Any]:
    """The losses and the clock of a loop as exact data."""
    quantities = {"resolution": losses.resolution, "sample_period": losses.period, "delay": losses.lag}
    if losses.curve is None:
        quantities = {"damping": losses.damping, "coulomb_friction": losses.coulomb_friction} | quantities
    document: dict[str, Any] = {
        unit_key(name, motion): exact_text(value) for name, value in quantities.items()
    }
    if losses.curve is not None:
        speed, force = (unit_suffix(GLOSSARY[name].unit_for(motion)) for name in ("velocity", "force"))
        drag = unit_key("damping", motion).removeprefix("damping_")
        points = zip(losses.curve.speeds, losses.curve.forces, strict=True)
        document[f"friction_curve_{speed}_{force}"] = [
            [exact_text(v.fraction), exact_text(f.fraction)] for v, f in points
        ]
        document[f"friction_models_{force}_{drag}"] = [
            [exact_text(f), exact_text(b)] for f, b in losses.models
        ]
    return document


# A grid for encoders that are finer than what is looked at: cells of any length, V at their ends.
#
# y = x − Δ; the law acts inside where y ≥ 0.  A reading is y + Δ/2 but for Δ/2, which Coulomb friction pays
# for (‖c‖₁ Δ/2); the force of y + Δ/2 is linear within the cells.  By the rules of this grid
#
#     a move over D cells costs  φ D,  φ − κ,  φ D + β D² − (β + κ)/4     for D = 0, D = 1, D ≥ 2
#
# κ = max(Σ c⁺, Σ c⁻): a hand that gains nothing at the cells' ends gains nothing in between (see the
# documentation).  At y = 0 there are two ends, the outer and the inner one.


@dataclass(frozen=True, kw_only=True)
class CoarseGrid(Grid):
    """Ends of cells in a row; domain and losses are in cells, the ends counted from the lowest."""

    count: Fraction  # Δ, the encoder's own [m; rad]

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


CELLS = (16, 32, 64, 128)
"""Cells in the longest move, coarse to fine."""

MOST_STATES = 400_000

_CHECKED = 1e8  # pairs of states and moves that the checker takes on in a unit of `effort`


def prove_on_cells(
    law: FiniteLaw,
    losses: Losses,
    domain: Domain,
    motion: str,
    cells: int,
    until: Until,
    progress: Progress | None,
) -> Certificate | None:
    """A storage function that the checker accepts, or None."""
    grid = coarse_grid(law, losses, domain, cells)
    if grid is None or not has_cells(law, losses, domain, cells):
        return None
    value = value_iteration(grid, until, progress).value
    if value is None:
        return None
    certificate = Certificate((_document(grid, losses, motion, value),))
    until.effort.spend(value.size * grid.width / _CHECKED)
    return certificate if certificate.verify() else None


def has_cells(law: FiniteLaw, losses: Losses, domain: Domain, cells: int) -> bool:
    """True for a law that can be proved on such cells, of which there are not too many."""
    grid = coarse_grid(law, losses, domain, cells)
    return grid is not None and len(grid.places) * grid.histories <= MOST_STATES


def _document(grid: CoarseGrid, losses: Losses, motion: str, value: Integers) -> dict[str, object]:
    domain = grid.domain
    return {
        "format": FORMAT,
        "kind": "coarse storage",
        "loop": loop_document(losses, motion),
        "law": grid.law.document(motion),
        "domain": {
            "lowest_cell": domain.lowest,
            "highest_cell": domain.highest - grid.sheets,
            "counts_per_cell": exact_text(grid.losses.resolution / losses.resolution),
            "largest_move_cells": int(domain.speed),
            "remembered": grid.memory,
        },
        "force_unit": exact_text(grid.force_unit),
        "storage": packed(value),
    }
