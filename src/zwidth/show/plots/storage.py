"""The available storage: the most that a hand can take out, against where it is.

It is bounded by 0 below and finite, and no move takes out more than it falls:
that is the proof.  The line is for a hand that waits; what the law remembers of
a hand that moved spreads it into the band.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator

from zwidth.errors import InputError
from zwidth.show.plots.style import BLUE, LOOK, OUTCOME, SKY, heading, label, new_figure, number, scale

if TYPE_CHECKING:
    from zwidth.passivity.storage import AvailableStorage
    from zwidth.passivity.storage.storage_function import StorageFunction

_EDGES = 400
"""Encoder edges up to which each has a tick."""

_OUTSIDE = 1.0
"""How far outside is shown, as a part of how deep: farther out V is the same."""


@rc_context(LOOK)
def storage(found: AvailableStorage) -> Figure:
    """V against position, for a hand that waits and over all that the law can remember.

    Parameters
    ----------
    found
        What `zwidth.available_storage` returned.

    Raises
    ------
    InputError
        If it is not passive: there is no such function.
    """
    if found.storage is None:
        why = "by a closed form" if found.outcome == "passive" else ""
        raise InputError(
            f"the loop is {found.outcome} {why}".rstrip() + ": there is no storage function to draw"
        )
    figure = new_figure()
    draw_storage(figure.add_subplot(), found.storage)
    return figure


def draw_storage(axes: Axes, found: StorageFunction) -> None:
    """The same on given axes."""
    energy = found.to_xarray()
    before, position = (energy[d].values for d in energy.dims)
    resolution = float(found.grid.losses.resolution)
    points = len(position) // found.grid.domain.cells
    cells = np.arange(len(position)) // points + found.grid.domain.lowest
    low, high = np.nanmin(energy.values, axis=0), np.nanmax(energy.values, axis=0)
    joules, energy_unit = scale([float(high.max())], "J")
    metres, length_unit = scale([float(np.abs(position).max())], str(energy["position"].attrs["units"]))
    x = metres * position
    axes.fill_between(x, joules * low, joules * high, color=SKY, alpha=0.35, lw=0, label="after any move")
    if before.dtype.kind in "if":
        waits = np.abs(before[:, None] - cells[None, :]).argmin(axis=0)
        waiting = energy.values[waits, np.arange(len(position))]
        axes.plot(x, joules * waiting, color=BLUE, label="the hand waits", gid="waiting")
    else:  # of laws in a chain only the extremes are known
        axes.plot(x, joules * high, color=BLUE, label="at most", gid="most")
    edges = np.arange(cells[0], cells[-1] + 2)
    if len(edges) <= _EDGES:
        axes.xaxis.set_minor_locator(FixedLocator((metres * resolution * edges).tolist()))
    axes.set_xlim(max(x[0], -_OUTSIDE * x[-1]), x[-1])
    axes.set_ylim(0, None)
    axes.set_xlabel(f"{label('position', found.motion, unit=length_unit)}, a tick for each count")
    axes.set_ylabel(f"can be taken out, at most V [{energy_unit}]")
    most = f"{number(float(joules * high.max()))} {energy_unit}"
    heading(axes, f"never more than {most} can be taken out", color=OUTCOME["passive"])
    axes.legend(loc="upper left")
