"""Ports over one link, a row each: how the follower follows, what both hands put in, what the worst take."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from zwidth.show.plots.style import (
    BLACK,
    BLUE,
    GREY,
    LOOK,
    ORANGE,
    OUTCOME,
    RED,
    new_figure,
    page_heading,
    scale,
)
from zwidth.showing import printable

_FOOT = 1e-6
"""Energy that is drawn at the foot of its axis, with all below it [J]."""
_MOST = 1e4
"""The same at the other end [J]."""
_MARKS = {"passive": "o", "theorem": "s", "active": "X", "undecided": "D"}
_LABELS = {"passive": "passive over any link", "theorem": "the same: a theorem, no certificate"}
_GUIDE = "#dddddd"
_BEYOND = 1.6
"""How far a position is drawn, in those of the leader."""


@rc_context(LOOK)
def plot_links(comparison: Any) -> Figure:
    """Positions in a stroke, the energy that both hands have put in, and what the worst hands take.

    Parameters
    ----------
    comparison
        A `zwidth.links.LinkComparison`, what `zwidth.links.compare` gives.
    """
    figure = new_figure(9.6, 0.75 * comparison.scores.sizes["port"] + 1.5)
    draw_links(figure, comparison)
    return figure


def draw_links(figure: Figure, comparison: Any) -> None:
    """The same on a figure of your own."""
    names = [str(name) for name in comparison.scores["port"].values]
    grid = figure.add_gridspec(len(names), 3, width_ratios=(1.5, 1.2, 1.0))
    worst = figure.add_subplot(grid[:, 2])
    factor, unit = _length(comparison)
    for row, name in enumerate(names):
        trace = comparison.traces[name]["stroke"]
        paths, energy = figure.add_subplot(grid[row, 0]), figure.add_subplot(grid[row, 1])
        _paths(paths, trace, factor)
        _energy(energy, trace)
        paths.set_title(name, fontsize=8.5, pad=2)
        last = row == len(names) - 1
        for axes in (paths, energy):
            axes.set_xticks([0, 1, 2, 3], ["0", "1", "2", "3"] if last else [])
        if last:
            paths.set_xlabel(f"time [s]; positions [{unit}],\nleader black, follower blue")
            energy.set_xlabel("time [s]; put in by both\nhands [mJ], below 0 red")
    _worst(worst, comparison.scores, names)
    page_heading(figure, printable(comparison.schedule.describe()), 10)


def _length(comparison: Any) -> tuple[float, str]:
    first = next(iter(comparison.traces.values()))["stroke"]["position"]
    return scale([float(np.abs(first.values[0]).max())], first.attrs["units"])


def _paths(axes: Axes, trace: Any, factor: float) -> None:
    time = trace["time"].values
    leader, follower = trace["position"].values * factor
    most = _BEYOND * np.abs(leader).max()
    axes.plot(time, leader, color=BLACK, lw=1.0)
    axes.plot(time, np.clip(follower, -most, most), color=BLUE, lw=1.2)
    axes.axhline(0, color=_GUIDE, lw=0.6, zorder=0)


def _energy(axes: Axes, trace: Any) -> None:
    time, work = trace["time"].values, 1e3 * trace["hand_work"].values.sum(axis=0)
    axes.plot(time, work, color=ORANGE, lw=1.2)
    axes.plot(time, np.where(work < 0, work, np.nan), color=RED, lw=1.2)
    axes.axhline(0, color=GREY, lw=0.6, zorder=0)


def _worst(axes: Axes, scores: Any, names: list[str]) -> None:
    """What the worst hands take, and by its mark what is known."""
    taken = np.clip(scores["taken"].values, _FOOT, _MOST)
    seen = []
    for row, (value, outcome) in enumerate(zip(taken, scores["outcome"].values, strict=True)):
        status = str(outcome)
        axes.plot([_FOOT, value], [row, row], color=_GUIDE, lw=1.0, zorder=1)
        text = None if status in seen else _LABELS.get(status, status)
        seen.append(status)
        axes.plot(value, row, _MARKS[status], color=OUTCOME[status], ms=7, mew=0, clip_on=False, label=text)
    axes.set_xscale("log")
    axes.set_xlim(_FOOT, _MOST)
    axes.set_xticks([1e-6, 1e-3, 1.0, 1e3], ["≤1e−6", "1e−3", "1", "1000"])
    axes.minorticks_off()
    axes.set_ylim(len(names) - 0.5, -0.5)
    axes.set_yticks([])
    axes.spines["left"].set_visible(False)
    axes.set_xlabel("taken by the worst hands tried [J]")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.12))
