"""The storage function of laws in a row: as a certificate, and against the position."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from zwidth.passivity.certificate import FORMAT, Certificate
from zwidth.passivity.storage.row_board import RowBoard
from zwidth.passivity.storage.row_document import STORAGE, law_document, packed, table_document
from zwidth.passivity.storage.row_law import RowLaw
from zwidth.passivity.storage.storage import Storage, domain_document, loop_document
from zwidth.quantity.text import exact_text

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class RowStorage(Storage):
    """The available storage of laws in a row, from above.

    Parameters
    ----------
    law
        What was played.
    """

    law: RowLaw

    def certificate(self) -> Certificate:
        """The proof as data: the table of the law, the losses, the board, V."""
        board = self.played.board
        assert isinstance(board, RowBoard)
        assert self.played.value is not None
        return Certificate(
            (
                {
                    "format": FORMAT,
                    "kind": STORAGE,
                    "loop": loop_document(board.losses, self.motion),
                    "law": law_document(self.law),
                    "domain": domain_document(board),
                    "force_unit": exact_text(board.force_unit),
                    "table": table_document(board.table),
                    "storage": packed(self.played.value),
                },
            )
        )

    def to_xarray(self) -> xr.DataArray:
        """V along the position, the least and the most over all that the law may remember [J].

        Dims `remembered` and `position` [m; rad]; each edge between two counts is there twice,
        from below and from above.
        """
        import xarray as xr

        board = self.played.board
        assert isinstance(board, RowBoard)
        assert self.played.value is not None
        energy = self.played.value * float(board.energy_unit)
        cells = np.arange(board.domain.lowest, board.domain.highest + 1)
        x = (cells[:, None] + board.knots[None, :] / board.steps) * float(board.losses.resolution)
        found = np.full((2, len(cells), board.knots.size), np.nan)
        for i, cell in enumerate(cells):
            here = energy[board.table.counts == cell]
            if len(here):
                found[:, i] = here.min(axis=0), here.max(axis=0)
        unit = "rad" if self.motion == "rotary" else "m"
        return xr.DataArray(
            found.reshape(2, -1),
            dims=("remembered", "position"),
            coords={"remembered": ["least", "most"], "position": ("position", x.ravel(), {"units": unit})},
            attrs={"units": "J", "long_name": "available storage, at most"},
            name="available_storage",
        )
