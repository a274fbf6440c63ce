"""Two arms against time: both positions, both forces, and the energy that comes out."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from zwidth.loop.energy import PairLedger
from zwidth.loop.trace import UNITS
from zwidth.show.plots.style import (
    BLUE,
    GREEN,
    GREY,
    LOOK,
    ORANGE,
    PURPLE,
    RED,
    as_written,
    heading,
    new_figure,
    number,
    scale,
    verbatim,
)
from zwidth.show.plots.trace import thinned

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

_COLOURS = {"leader": BLUE, "follower": ORANGE}


@rc_context(LOOK)
def pair_trace_figure(trace: xr.Dataset) -> Figure:
    """Both positions, both hands' forces, and what the hands put in, one above the other.

    Parameters
    ----------
    trace
        What `zwidth.simulate` returned of a `zwidth.Pair`.
    """
    figure = new_figure(8.4, 6.8)
    above, middle, below = figure.subplots(3, 1, sharex=True, height_ratios=(1.15, 1, 1))
    draw_both(above, trace, "position", "position")
    draw_both(middle, trace, "hand_force", "force on the arm\nby what holds it")
    draw_pair_energies(below, trace)
    about = trace.attrs
    held = as_written(f"leader: {about['leader_holder']}\nfollower: {about['follower_holder']}")
    heading(above, verbatim(f"{about['coupling']}\n{held}"))
    below.set_xlabel(f"time [{scale([float(trace['time'].values[-1])], 's')[1]}]")
    return figure


def draw_both(axes: Axes, trace: xr.Dataset, name: str, text: str) -> None:
    """One variable of both arms."""
    time = _time(trace)
    values = trace[name].values
    unit = UNITS[str(trace.attrs["motion"])][0 if name == "position" else 2]
    factor, shown = scale([float(np.abs(values).max())], unit)
    for row, (arm, colour) in zip(values, _COLOURS.items(), strict=True):
        axes.plot(*thinned(time, row * factor), color=colour, lw=1.3, label=arm)
    axes.axhline(0, color=GREY, lw=0.8)
    axes.set_ylabel(f"{text} [{shown}]")
    _legend(axes)


def draw_pair_energies(axes: Axes, trace: xr.Dataset) -> None:
    """What both hands put in together, where it went; below 0 they have got energy out."""
    time, book = _time(trace), PairLedger(trace)
    ratio = np.array([[1.0], [book.power_ratio]])
    lost = trace["viscous_loss"].values + trace["coulomb_loss"].values
    curves: dict[str, tuple[str, Array]] = {
        "from both hands": (RED, book.hand_work),
        "into the coupling": (PURPLE, book.coupling),
        "lost in friction": (GREEN, (ratio * lost).sum(axis=0)),
        "kinetic": (BLUE, (ratio * trace["kinetic_energy"].values).sum(axis=0)),
    }
    factor, unit = scale([max(float(np.abs(c).max()) for _, c in curves.values())], "J")
    for text, (colour, curve) in curves.items():
        axes.plot(*thinned(time, curve * factor), color=colour, lw=1.3, label=text)
    axes.axhline(0, color=GREY, lw=0.8)
    axes.set_ylabel(f"energy [{unit}]")
    _legend(axes)
    if book.active:
        f, u = scale([book.extracted], "J")
        heading(
            axes,
            f"{number(book.extracted * f)} {u} came out beyond what was in it: this pair is active",
            color=RED,
        )


def _legend(axes: Axes) -> None:
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))


def _time(trace: xr.Dataset) -> Array:
    time: Array = trace["time"].values
    return time * scale([float(time[-1])], "s")[0]
