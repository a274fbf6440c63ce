"""The available storage: the most that a hand can take out, against where it is.

It is bounded by 0 below and finite, and no move takes out more than it falls: that is the proof.  The line is
for a hand that waits; what the law remembers of a hand that moved spreads it into the band.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator

from zwidth.errors import InputError
from zwidth.passivity.ports.sample_table import SampleTable
from zwidth.show.plots.style import (
    BLACK,
    BLUE,
    GREY,
    LOOK,
    ORANGE,
    OUTCOME,
    RED,
    SKY,
    heading,
    label,
    legend,
    new_figure,
    number,
    scale,
    symbol,
    with_unit,
)

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
    words = f"position {symbol('position')}{', a tick for each count' if len(edges) <= _EDGES else ''}"
    axes.set_xlabel(with_unit(words, length_unit))
    axes.set_ylabel(with_unit("can be taken out, at most V", energy_unit))
    most = f"{number(float(joules * high.max()))} {energy_unit}"
    legend(axes)
    heading(axes, f"never more than {most} can be taken out", color=OUTCOME["passive"])


# What was measured of a port against frequency, with its error, beside what no passive system has.


_LOGARITHMIC = 30
"""Above so many times the lowest frequency the axis is logarithmic."""

_ROOM = 0.1


@rc_context(LOOK)
def sample_table_figure(found: SampleTable) -> Figure:
    """The samples with their errors, those that break the bound, and the bands they make.

    Parameters
    ----------
    found
        What `zwidth.ports.response_table` or `scattering_table` returned.
    """
    figure = new_figure(height=4.4)
    draw_sample_table(figure.subplots(), found)
    return figure


def draw_sample_table(axes: Axes, found: SampleTable) -> None:
    """The same on given axes."""
    f, values, errors = (np.array(row) for row in (found.frequencies, found.values, found.errors))
    broken, possible = np.array(found.violated), np.array(found.possible)
    low, high = _height(found, values, errors)
    edge = low if found._BEYOND < 0 else high
    axes.axhspan(found._BOUND, edge, color=RED, alpha=0.12, lw=0, label="of no passive system")
    axes.axhline(found._BOUND, color=BLACK, lw=0.8, label="the bound")
    _draw_bands(axes, found)
    for these, colour, mark, name in (
        (~possible, BLUE, "o", "no violation shown"),
        (possible & ~broken, ORANGE, "D", "may violate, within its error"),
        (broken, RED, "X", "violates, whatever its error" if errors.any() else "violates"),
    ):
        if these.any():
            bars = errors[these] if errors.any() else None
            axes.errorbar(
                f[these], values[these], bars, fmt=mark, color=colour, ms=4.5, elinewidth=0.9, label=name
            )
    axes.set_xscale("log" if f[0] > 0 and f[-1] > _LOGARITHMIC * f[0] else "linear")
    axes.set_ylim(low, high)
    axes.set_xlabel(label("frequency"))
    axes.set_ylabel(with_unit(found._NAMES[found.ports > 1], found._UNIT))
    legend(axes)
    count = int(broken.sum())
    heading(
        axes, f"{count} of {len(f)} samples violate" if count else f"no violation shown at {len(f)} samples"
    )


def _draw_bands(axes: Axes, found: SampleTable) -> None:
    """From sample to sample that violates; lighter up to the neighbours, between which the edge lies."""
    for n, band in enumerate(found.bands):
        outer = (
            band.low if band.before is None else band.before,
            band.high if band.after is None else band.after,
        )
        axes.axvspan(*outer, color=GREY, alpha=0.12, lw=0)
        axes.axvspan(
            band.low, band.high, color=GREY, alpha=0.2, lw=0, label=None if n else "band of violation"
        )


def _height(found: SampleTable, values: np.ndarray, errors: np.ndarray) -> tuple[float, float]:
    """All samples with their errors, the bound, and some room beyond it."""
    low = min(float((values - errors).min()), found._BOUND)
    high = max(float((values + errors).max()), found._BOUND)
    room = _ROOM * ((high - low) or 1.0)
    return low - room, high + room
