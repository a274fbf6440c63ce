"""Laws on the bench: what they keep against what they give, and what happens when they are touched."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from zwidth.plots.style import BLACK, BLUE, GREY, LOOK, OUTCOME, new_figure

_SHOWN = 0.12
"""Time of a tap that is drawn [s]."""

_MARKS = {"passive": "o", "theorem": "s", "active": "X", "undecided": "D"}
_COLOURS = {**OUTCOME, "theorem": BLUE}


@rc_context(LOOK)
def laws_figure(comparison: Any) -> Figure:
    """Stability against fidelity, and the force of each law under a fast finger.

    Parameters
    ----------
    comparison
        A `zwidth.LawComparison`, what `zwidth.compare` gives.
    """
    names = [str(name) for name in comparison.scores["law"].values]
    figure = new_figure(9.0, max(4.2, 0.55 * len(names) + 1.2))
    left, right = figure.subplots(1, 2, width_ratios=(1.1, 1.0))
    _trade_off(left, comparison, names)
    _taps(right, comparison, names)
    return figure


def _trade_off(axes: Axes, comparison: Any, names: list[str]) -> None:
    scores = comparison.scores
    wanted = float(comparison.environment.stiffness)
    felt = scores["static_stiffness"].values
    given = np.maximum(scores["generated_energy"].values, scores["dowel_energy"].values) * 1e3
    floor = 1e-3
    for number, (name, x, y) in enumerate(zip(names, felt, np.maximum(given, floor), strict=True), 1):
        status = str(scores["status"].sel(law=name).item())
        axes.plot(x, y, _MARKS[status], color=_COLOURS[status], ms=8, alpha=0.8, clip_on=False)
        axes.annotate(str(number), (x, y), (6, 4 + 7 * (number % 2)), textcoords="offset points", fontsize=8)
    axes.axvline(wanted, color=GREY, lw=0.8, ls=":")
    axes.set_yscale("log")
    axes.set_ylim(bottom=floor / 2)
    axes.set_xlim(0, 1.15 * max(wanted, np.nanmax(felt)))
    axes.set_xlabel("stiffness felt at rest [N/m]")
    axes.set_ylabel(f"most energy given out in a touch [mJ], {floor:g} or less at the foot")
    axes.set_title("what is felt, and what it costs")
    handles = [
        axes.plot([], [], mark, color=_COLOURS[status], label=status)[0] for status, mark in _MARKS.items()
    ]
    axes.legend(handles=handles, loc="upper left")


def _taps(axes: Axes, comparison: Any, names: list[str]) -> None:
    peak = float(comparison.scores["peak_force"].max()) or 1.0
    for number, name in enumerate(names, 1):
        trace = comparison.traces[name]["tap"]
        time, inside = trace["time"].values, np.flatnonzero(trace["position"].values > 0)
        start = time[inside[0]] if inside.size else 0.0
        shown = (time >= start - 0.005) & (time <= start + _SHOWN)
        status = str(comparison.scores["status"].sel(law=name).item())
        force = trace["actuator_force"].values[shown] / peak * 0.85
        axes.plot((time[shown] - start) * 1e3, force - number, color=_COLOURS[status], lw=1.1)
        axes.axhline(-number, color=GREY, lw=0.4)
    axes.set_yticks(
        [-n for n in range(1, len(names) + 1)], [f"{n}  {name}" for n, name in enumerate(names, 1)]
    )
    axes.tick_params(axis="y", length=0, labelcolor=BLACK)
    axes.yaxis.tick_right()
    axes.spines["left"].set_visible(False)
    axes.set_xlabel("time after contact [ms]")
    axes.set_title(f"force under a fast finger, up to {peak:.3g} N")
