"""The storage function as a certificate, and as a labelled array to look at.

V(s) is the most energy that a hand can ever take out from state s, or a little
more.  It is the proof: no move takes out more than V falls.
"""

from __future__ import annotations

import base64
import zlib
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth.passivity.certificate import FORMAT, Certificate
from zwidth.passivity.document import unit_key
from zwidth.passivity.storage.board import Board
from zwidth.passivity.storage.losses import Losses
from zwidth.passivity.storage.relaxing import RelaxingBoard
from zwidth.passivity.storage.solve import Played
from zwidth.quantity.text import exact_text

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class Storage:
    """The available storage of a loop, from above.

    Parameters
    ----------
    played
        A game that no motion wins.
    motion
        "linear" or "rotary".
    """

    played: Played
    motion: str

    def certificate(self) -> Certificate:
        """The proof as data: the law, the losses, the board, V."""
        board = self.played.board
        assert self.played.value is not None, "only a game that nobody wins leaves a storage function"
        packed = zlib.compress(self.played.value.astype("<i8").tobytes(), 6)
        document: dict[str, Any] = {
            "format": FORMAT,
            "kind": "storage",
            "loop": loop_document(board.losses, self.motion),
            "law": board.law_document(self.motion),
            "domain": domain_document(board),
            "force_unit": exact_text(board.force_unit),
            "storage": base64.b64encode(packed).decode("ascii"),
        }
        if isinstance(board, RelaxingBoard):
            document["domain"]["levels_per_count"] = board.levels
        return Certificate((document,))

    def to_xarray(self) -> xr.DataArray:
        """V along the position, for each reading before [J].

        Dims `reading_before` [counts] and `position` [m; rad]; each edge between two
        counts is there twice, from below and from above.
        """
        import xarray as xr

        board = self.played.board
        assert self.played.value is not None
        if isinstance(board, RelaxingBoard):
            return self._relaxing_array(board)
        resolution = float(board.losses.resolution)
        cells = np.arange(board.domain.lowest, board.domain.highest + 1)
        x = (cells[:, None] + board.knots[None, :] / board.steps) * resolution
        energy = self.played.value * float(board.energy_unit)
        reach = board.domain.reach if board.memory else 0
        middle = board.histories // 2
        stride = board.histories // board.width if board.memory else 1
        newest = [middle + e * stride for e in range(-reach, reach + 1)]
        values = np.full((len(cells), len(cells), energy.shape[2]), np.nan)
        for i in range(len(cells)):
            for e, column in zip(range(-reach, reach + 1), newest, strict=True):
                if 0 <= i + e < len(cells):
                    values[i + e, i] = energy[i, column]
        unit = "rad" if self.motion == "rotary" else "m"
        return xr.DataArray(
            values.reshape(len(cells), -1),
            dims=("reading_before", "position"),
            coords={
                "reading_before": ("reading_before", cells, {"units": "counts"}),
                "position": ("position", x.ravel(), {"units": unit}),
            },
            attrs={"units": "J", "long_name": "available storage, at most"},
            name="available_storage",
        )

    def _relaxing_array(self, board: RelaxingBoard) -> xr.DataArray:
        """V along the position, for each level of the average reading, the hand at rest before."""
        import xarray as xr

        assert self.played.value is not None
        cells = np.arange(board.domain.lowest, board.domain.highest + 1)
        x = (cells[:, None] + board.knots[None, :] / board.steps) * float(board.losses.resolution)
        energy = self.played.value[:, board.histories // 2] * float(board.energy_unit)
        levels = board.readings[0] + np.arange(board.averages) / board.levels
        unit = "rad" if self.motion == "rotary" else "m"
        return xr.DataArray(
            energy.transpose(1, 0, 2).reshape(len(levels), -1),
            dims=("average_reading", "position"),
            coords={
                "average_reading": ("average_reading", levels, {"units": "counts"}),
                "position": ("position", x.ravel(), {"units": unit}),
            },
            attrs={"units": "J", "long_name": "available storage, at most"},
            name="available_storage",
        )


def _plainly(counts: Fraction) -> int | str:
    """A whole number as one."""
    return int(counts) if counts.denominator == 1 else exact_text(counts)


def domain_document(board: Board) -> dict[str, Any]:
    """Where the hand may be and how far it may go, as data."""
    return {
        "lowest_count": board.domain.lowest,
        "highest_count": board.domain.highest,
        "largest_move_counts": _plainly(board.domain.speed),
        "steps_per_count": board.steps,
    }


def loop_document(losses: Losses, motion: str) -> dict[str, Any]:
    """The losses and the clock of a loop as exact data."""
    quantities = {"resolution": losses.resolution, "sample_period": losses.period, "delay": losses.lag}
    if losses.curve is None:
        quantities = {"damping": losses.damping, "coulomb_friction": losses.coulomb_friction} | quantities
    document: dict[str, Any] = {
        unit_key(name, motion): exact_text(value) for name, value in quantities.items()
    }
    if losses.curve is not None:
        speed, force = ("rad_per_s", "N_m") if motion == "rotary" else ("m_per_s", "N")
        drag = unit_key("damping", motion).removeprefix("damping_")
        points = zip(losses.curve.speeds, losses.curve.forces, strict=True)
        document[f"friction_curve_{speed}_{force}"] = [
            [exact_text(v.fraction), exact_text(f.fraction)] for v, f in points
        ]
        document[f"friction_models_{force}_{drag}"] = [
            [exact_text(f), exact_text(b)] for f, b in losses.models
        ]
    return document
