"""Laws on the bench, a row each: what is felt, what is given out, and what happens in a touch."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from zwidth.show.plots.style import BLACK, GREY, LOOK, OUTCOME, new_figure, scale, verbatim

_SHOWN = 0.12
"""Time of a tap that is drawn [s]."""

_FOOT = 1e-3
"""Energy that is drawn at the foot of its axis, with all below it [mJ]."""

_MOST = 1e3
"""The same at the other end: a loop that diverges would leave no room to the others [mJ]."""

_ROW = 0.62
"""Part of a row that the median of the largest forces fills."""

_MARKS = {"passive": "o", "theorem": "s", "active": "X", "undecided": "D"}
_LABELS = {"theorem": "theorem, on paper: no certificate"}
_GUIDE = "#dddddd"


@rc_context(LOOK)
def laws_figure(comparison: Any) -> Figure:
    """Fidelity, stability against three hands, and the force of each law under a fast finger.

    Parameters
    ----------
    comparison
        A `zwidth.study.bench.LawComparison`, what `zwidth.compare` gives.
    """
    scores = comparison.scores
    names = [str(name) for name in scores["law"].values]
    figure = new_figure(10.5, 0.29 * len(names) + 1.7)
    columns = figure.subplots(1, 4, sharey=True, width_ratios=(1.0, 1.0, 1.0, 1.7))
    felt, given, worst, taps = columns
    _stiffness(felt, scores, float(comparison.environment.stiffness))
    touched = np.maximum(scores["generated_energy"].values, scores["dowel_energy"].values)
    _energy(given, scores, touched, "most energy given out\nin a touch [mJ]")
    _energy(worst, scores, scores["gain"].values, "taken out by the worst\nhand in a round [mJ]")
    _taps(taps, comparison, names)
    for axes in columns:
        axes.tick_params(axis="y", length=0, labelcolor=BLACK)
        axes.spines["left"].set_visible(False)
    felt.set_yticks(range(len(names)), [verbatim(name) for name in names])
    felt.set_ylim(len(names) - 0.4, -0.9)
    handles = [
        felt.plot([], [], mark, color=OUTCOME[status], label=_LABELS.get(status, status))[0]
        for status, mark in _MARKS.items()
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=3)
    return figure


def _stiffness(axes: Axes, scores: Any, wanted: float) -> None:
    factor, unit = scale([wanted], scores["static_stiffness"].attrs["units"])
    felt, wanted = factor * scores["static_stiffness"].values, factor * wanted
    axes.axvline(wanted, color=GREY, lw=0.8, ls=":")
    axes.annotate("wanted", (wanted, 1.0), xycoords=("data", "axes fraction"), ha="center", fontsize=7.5)
    _dots(axes, scores, felt, 0.0)
    axes.set_xlim(0, 1.15 * max(wanted, np.nanmax(felt)))
    axes.set_xlabel(f"stiffness felt\nat rest [{unit}]")


def _energy(axes: Axes, scores: Any, joules: NDArray[np.float64], label: str) -> None:
    energy = np.clip(1e3 * joules, _FOOT, _MOST)
    axes.set_xscale("log")
    _dots(axes, scores, energy, _FOOT)
    axes.set_xlim(_FOOT / 2, 3 * max(float(energy.max()), 1.0))
    axes.minorticks_off()
    ticks = 10.0 ** np.arange(-3, int(np.floor(np.log10(axes.get_xlim()[1]))) + 1, 2)
    axes.set_xticks(ticks, [_tick(tick) for tick in ticks])
    axes.set_xlabel(label)


def _tick(energy: float) -> str:
    sign = "≤" if energy < 1.1 * _FOOT else "≥" if energy > 0.9 * _MOST else ""
    return f"{sign}{energy:g}"


def _dots(axes: Axes, scores: Any, values: NDArray[np.float64], start: float) -> None:
    """A dot in each row, by what is known of the law, on a line that leads there."""
    for row, (value, status) in enumerate(zip(values, scores["status"].values, strict=True)):
        axes.plot([start, value], [row, row], color=_GUIDE, lw=1.0, zorder=1)
        axes.plot(value, row, _MARKS[str(status)], color=OUTCOME[str(status)], ms=7, mew=0, clip_on=False)


def _taps(axes: Axes, comparison: Any, names: list[str]) -> None:
    """Forces one below the other; what leaves its row is cut off, and its largest value written."""
    peaks = comparison.scores["peak_force"].values / (comparison.radius or 1.0)  # at the rim, as the traces
    newton = float(np.median(peaks)) / _ROW or 1.0
    for row, name in enumerate(names):
        trace = comparison.traces[name]["tap"]
        time, inside = trace["time"].values, np.flatnonzero(trace["position"].values > 0)
        start = time[inside[0]] if inside.size else 0.0
        shown = (time >= start - 0.005) & (time <= start + _SHOWN)
        status = str(comparison.scores["status"].sel(law=name).item())
        force = trace["actuator_force"].values[shown] / newton
        axes.axhline(row + 0.3, color=_GUIDE, lw=0.6)
        drawn = row + 0.3 - np.clip(force, -0.3, 0.95)
        axes.plot((time[shown] - start) * 1e3, drawn, color=OUTCOME[status], lw=1.0)
        if force.size and force.max() > 0.95:
            axes.annotate(
                f"{force.max() * newton:.3g} N",
                (_SHOWN * 1e3, row - 0.1),
                ha="right",
                fontsize=7.5,
                color=GREY,
            )
    axes.set_xlabel(f"time after contact [ms];\nforces, {_ROW * newton:.3g} N the median of peaks")
    axes.annotate("under a fast finger", (0, 1.0), xycoords="axes fraction", fontsize=7.5)
