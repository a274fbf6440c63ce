"""A served loop against time: where the device was, what force it was given, how late the samples were."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from zwidth.loop.trace import UNITS
from zwidth.show.plots.style import (
    BLUE,
    GREY,
    LOOK,
    ORANGE,
    PURPLE,
    RED,
    heading,
    new_figure,
    scale,
    verbatim,
)
from zwidth.show.plots.trace import thinned

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

_MOST_GAPS = 200
"""Samples without an answer that are marked one by one."""


@rc_context(LOOK)
def recording_figure(data: xr.Dataset) -> Figure:
    """Position, force and lateness, one above the other.

    Parameters
    ----------
    data
        Of a recording of two samples at least, `servo.recording.Recording.dataset`.
    """
    figure = new_figure(8.4, 6.2)
    above, middle, below = figure.subplots(3, 1, sharex=True, height_ratios=(1.15, 1, 0.7))
    draw_read_position(above, data)
    draw_given_force(middle, data)
    draw_recorded_lateness(below, data)
    heading(above, verbatim(str(data.attrs["title"])))
    below.set_xlabel(f"time [{_time(data)[1]}]")
    return figure


def draw_read_position(axes: Axes, data: xr.Dataset) -> None:
    """The position as it was read; grey lines where a sample had no good answer; the wall is shaded."""
    time = _time(data)[0]
    read = data["measured_position"].values
    factor, unit = scale([float(np.abs(read).max())], UNITS[str(data.attrs["motion"])][0])
    axes.plot(*thinned(time, read * factor), color=BLUE)
    low, high = axes.get_ylim()
    if high > 0:
        axes.axhspan(0, high, color=GREY, alpha=0.12, lw=0)
        axes.set_ylim(low, high)
    for at in time[data["status"].values != 0][:_MOST_GAPS]:
        axes.axvline(at, color=GREY, lw=0.6)
    axes.axhline(0, color=GREY, lw=0.8)
    axes.set_ylabel(f"position [{unit}]\n(wall shaded)")


def draw_given_force(axes: Axes, data: xr.Dataset) -> None:
    """What the law asked for and what was given, both positive out of the wall."""
    time = _time(data)[0]
    wished, given = data["wished_force"].values, data["commanded_force"].values
    largest = max(float(np.abs(wished).max()), float(np.abs(given).max()))
    factor, unit = scale([largest], UNITS[str(data.attrs["motion"])][2])
    steps: Any = {"drawstyle": "steps-post"}
    axes.plot(*thinned(time, wished * factor), color=ORANGE, lw=1, label="asked for by the law", **steps)
    axes.plot(*thinned(time, given * factor), color=PURPLE, lw=1.2, label="given", **steps)
    axes.axhline(0, color=GREY, lw=0.8)
    axes.set_ylabel(f"force [{unit}]")
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))


def draw_recorded_lateness(axes: Axes, data: xr.Dataset) -> None:
    """How late each sample was; red where samples were missed before it."""
    time = _time(data)[0]
    late, passed = data["late"].values, np.diff(data["sample"].values, prepend=data["sample"].values[0] - 1)
    factor, unit = scale([float(np.abs(late).max())], "s")
    axes.plot(*thinned(time, late * factor), color=BLUE, lw=0.8)
    missed = passed > 1
    axes.plot(
        time[missed], late[missed] * factor, color=RED, marker=".", ms=4, ls="", label="after missed ones"
    )
    axes.set_ylabel(f"late by [{unit}]")
    if missed.any():
        axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))


def _time(data: xr.Dataset) -> tuple[Array, str]:
    time = data["time"].values
    factor, unit = scale([float(time[-1])], "s")
    return time * factor, unit
