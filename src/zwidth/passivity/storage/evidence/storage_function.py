"""The storage function as a certificate, and as a labelled array to look at.

V(s) is the most energy that a hand can ever take out from state s, or a little
more.  It is the proof: no move takes out more than V falls.
"""

from __future__ import annotations

import base64
import zlib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth.passivity.certificate import FORMAT, Certificate
from zwidth.passivity.document import unit_key
from zwidth.passivity.storage.grid.grid import Grid
from zwidth.passivity.storage.losses import Integers, Losses
from zwidth.passivity.storage.solve.value_iteration import ValueIteration
from zwidth.quantity.glossary import GLOSSARY, unit_suffix
from zwidth.quantity.text import exact_text

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class StorageFunction:
    """The available storage of a loop, from above.

    Parameters
    ----------
    iteration
        A value iteration that no motion ended.
    motion
        "linear" or "rotary".
    """

    iteration: ValueIteration[Any]
    motion: str

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
        """What every such proof states."""
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
            coords={
                name: (name, remembered, counted),
                "position": ("position", x.ravel(), {"units": unit}),
            },
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
