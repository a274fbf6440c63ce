"""How late the steps of a loop were: of how many steps how late, both by powers of ten."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from zwidth.show.plots.style import BLACK, BLUE, GREY, LOOK, ORANGE, new_figure

_LEAST = 1e-8
"""What is less late is drawn as so late [s]."""

_BINS = 20
"""For each power of ten."""


@rc_context(LOOK)
def plot_lateness(checkup: Any) -> Figure:
    """Histogram of the lateness, of ordinary and of real-time turns, against the sample period.

    Parameters
    ----------
    checkup
        A `zwidth.servo.Checkup`, what `zwidth.servo.doctor` gives.
    """
    figure = new_figure(6.4, 3.6)
    draw_lateness(figure.add_subplot(), checkup)
    return figure


def draw_lateness(axes: Axes, checkup: Any) -> None:
    """The same on axes of your own."""
    period = float(checkup.sample_period)
    kinds = [(checkup.ordinary, GREY, "ordinary thread", "--")]
    if checkup.real_time is not None:
        kinds.append((checkup.real_time, BLUE, "real-time priority", "-"))
    most = max(2 * period, *(2 * lateness.worst for lateness, *_ in kinds))
    decades = np.log10(most / _LEAST)
    edges = np.geomspace(_LEAST, most, int(np.ceil(_BINS * decades)) + 1)
    for lateness, colour, name, line in kinds:
        late = np.maximum(lateness.late, _LEAST)
        axes.hist(late, list(edges), histtype="step", color=colour, ls=line, lw=1.4, label=name)
        axes.plot([lateness.quantile(0.999)], [1.0], "v", color=colour, ms=6, mew=0)
    axes.axvline(period, color=ORANGE, lw=1.0, label="sample period")
    axes.plot([], [], "v", color=BLACK, ms=6, mew=0, label="99.9 % are earlier")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_ylim(0.7, None)
    axes.set_xlabel("late by [s]")
    axes.set_ylabel("steps")
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=4)
