"""What was measured of a port against frequency, with its error, beside what no passive system has.

Of a frequency response the real part and 0, of scattering parameters the largest singular value and 1; with
several axes the least eigenvalue of the Hermitian part.
"""

from __future__ import annotations

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from zwidth.passivity.ports.sample_table import SampleTable
from zwidth.show.plots.style import BLACK, BLUE, GREY, LOOK, ORANGE, RED, heading, label, new_figure

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
    figure = new_figure(6.8, 4.4)
    draw_sample_table(figure.subplots(), found)
    return figure


def draw_sample_table(axes: Axes, found: SampleTable) -> None:
    """The same on given axes."""
    f, values, errors = (np.array(row) for row in (found.frequencies, found.values, found.errors))
    broken, possible = np.array(found.violated), np.array(found.possible)
    low, high = _height(found, values, errors)
    edge = low if found.BEYOND < 0 else high
    axes.axhspan(found.BOUND, edge, color=RED, alpha=0.12, lw=0, label="of no passive system")
    axes.axhline(found.BOUND, color=BLACK, lw=0.8)
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
    axes.set_ylabel(f"{found.NAMES[found.ports > 1]} [{found.UNIT}]")
    count = int(broken.sum())
    heading(
        axes, f"{count} of {len(f)} samples violate" if count else f"no violation shown at {len(f)} samples"
    )
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=3)


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
    low = min(float((values - errors).min()), found.BOUND)
    high = max(float((values + errors).max()), found.BOUND)
    room = _ROOM * ((high - low) or 1.0)
    return low - room, high + room
