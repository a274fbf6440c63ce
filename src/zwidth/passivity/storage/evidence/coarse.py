"""A proof on cells of many counts, as data."""

from __future__ import annotations

from zwidth.passivity.certificate import FORMAT, Certificate
from zwidth.passivity.storage.domain import Domain
from zwidth.passivity.storage.evidence.storage_function import loop_document, packed
from zwidth.passivity.storage.grid.coarse import CoarseGrid, coarse_grid
from zwidth.passivity.storage.law import FiniteLaw
from zwidth.passivity.storage.losses import Integers, Losses
from zwidth.passivity.storage.solve.effort import Until
from zwidth.passivity.storage.solve.value_iteration import Progress, value_iteration
from zwidth.quantity.text import exact_text

CELLS = (16, 32, 64, 128)
"""Cells in the longest move, coarse to fine."""

MOST_STATES = 400_000

_CHECKED = 1e8
"""Pairs of states and moves that the checker takes on in a unit of `effort`."""


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
