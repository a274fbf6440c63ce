"""Laws on the bench, a row each: what is felt, what is given out, and what happens in a touch."""

from __future__ import annotations

from math import inf, isfinite
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from zwidth.passivity.ports.index import PassivityIndex, told_place
from zwidth.passivity.ports.indices import PassivityIndices
from zwidth.quantity.text import shown
from zwidth.show.plots.style import (
    BLACK,
    BLUE,
    GREY,
    LOOK,
    OUTCOME,
    PURPLE,
    RED,
    SMALL,
    heading,
    label,
    legend,
    legend_of_all,
    new_figure,
    number,
    page_heading,
    scale,
    shown_name,
    verbatim,
    with_unit,
)
from zwidth.show.plots.traces import ARMS
from zwidth.showing import printable

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
    figure = new_figure(height=0.25 * len(names) + 1.9)
    columns = figure.subplots(1, 4, sharey=True, width_ratios=(1.0, 1.0, 1.0, 1.7))
    felt, given, worst, taps = columns
    _stiffness(felt, scores, float(comparison.environment.stiffness))
    touched = np.maximum(scores["generated_energy"].values, scores["dowel_energy"].values)
    _energy(given, scores, touched, with_unit("most energy\ngiven out in\na touch", "mJ"))
    _energy(worst, scores, scores["gain"].values, with_unit("taken out by\nthe worst hand\nin a round", "mJ"))
    _taps(taps, comparison, names)
    for axes in columns:
        axes.tick_params(axis="y", length=0, labelcolor=BLACK)
        axes.spines["left"].set_visible(False)
    felt.set_yticks(range(len(names)), [verbatim(name) for name in names])
    felt.set_ylim(len(names) - 0.4, -0.9)
    seen = set(scores["status"].values.tolist())
    handles = [
        felt.plot([], [], mark, color=OUTCOME[status], label=_LABELS.get(status, status))[0]
        for status, mark in _MARKS.items()
        if status in seen
    ]
    legend_of_all(figure, handles)
    motion = comparison.device.motion
    page_heading(figure, f"{shown_name(comparison.device)}: {comparison.environment.describe(motion)}")
    return figure


def _stiffness(axes: Axes, scores: Any, wanted: float) -> None:
    factor, unit = scale([wanted], scores["static_stiffness"].attrs["units"])
    felt, wanted = factor * scores["static_stiffness"].values, factor * wanted
    axes.axvline(wanted, color=GREY, lw=0.8, ls=":")
    axes.annotate(
        "wanted", (wanted, 1.0), xycoords=("data", "axes fraction"), ha="center", fontsize=SMALL, color=GREY
    )
    _dots(axes, scores, felt, 0.0)
    axes.set_xlim(0, 1.15 * max(wanted, np.nanmax(felt)))
    axes.locator_params(axis="x", nbins=3)
    axes.set_xlabel(with_unit("stiffness felt\nat rest", unit))


def _energy(axes: Axes, scores: Any, joules: NDArray[np.float64], label: str) -> None:
    energy = np.clip(1e3 * joules, _FOOT, _MOST)
    axes.set_xscale("log")
    _dots(axes, scores, energy, _FOOT)
    axes.set_xlim(_FOOT / 2, 3 * max(float(energy.max()), 1.0))
    axes.minorticks_off()
    ticks = 10.0 ** np.arange(-3, int(np.floor(np.log10(axes.get_xlim()[1]))) + 1, 3)
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
        near = (time >= start - 0.005) & (time <= start + _SHOWN)
        status = str(comparison.scores["status"].sel(law=name).item())
        force = trace["actuator_force"].values[near] / newton
        axes.axhline(row + 0.3, color=_GUIDE, lw=0.6)
        drawn = row + 0.3 - np.clip(force, -0.3, 0.95)
        axes.plot((time[near] - start) * 1e3, drawn, color=OUTCOME[status], lw=1.0)
        if force.size and force.max() > 0.95:
            beside = (1.04e3 * _SHOWN, row - 0.1)
            axes.annotate(shown(force.max() * newton, "N", 3), beside, fontsize=SMALL, color=GREY)
    axes.set_xlim(-10, 1.3e3 * _SHOWN)
    axes.set_xticks([0, 50, 100])
    axes.set_xlabel(with_unit("time after contact", "ms"))
    axes.annotate(
        f"force under a fast finger;\n{shown(_ROW * newton, 'N', 3)} the median of peaks", (0, 1.0),
        xycoords="axes fraction", fontsize=SMALL,
    )  # fmt: skip


_LINK_FOOT = 1e-6
"""Energy that is drawn at the foot of its axis, with all below it [J]."""
_LINK_MOST = 1e4
"""The same at the other end [J]."""
_LINK_LABELS = {"passive": "passive over any link", "theorem": "the same: a theorem, no certificate"}
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
    figure = new_figure(height=0.8 * comparison.scores.sizes["port"] + 1.5)
    draw_links(figure, comparison)
    return figure


def draw_links(figure: Figure, comparison: Any) -> None:
    """The same on a figure of your own."""
    names = [str(name) for name in comparison.scores["port"].values]
    grid = figure.add_gridspec(len(names), 3, width_ratios=(1.5, 1.2, 1.0))
    worst = figure.add_subplot(grid[:, 2])
    first = next(iter(comparison.traces.values()))["stroke"]["position"]
    factor, unit = scale([float(np.abs(first.values[0]).max())], first.attrs["units"])
    for row, name in enumerate(names):
        trace = comparison.traces[name]["stroke"]
        paths, energy = figure.add_subplot(grid[row, 0]), figure.add_subplot(grid[row, 1])
        _paths(paths, trace, factor)
        time, work = trace["time"].values, 1e3 * trace["hand_work"].values.sum(axis=0)
        energy.plot(time, work, color=PURPLE, lw=1.2, label="put in by both hands; below 0, taken out")
        energy.axhline(0, color=GREY, lw=0.6, zorder=0)
        paths.set_ylabel(with_unit("x", unit), fontsize=SMALL)
        energy.set_ylabel(with_unit("W", "mJ"), fontsize=SMALL)
        paths.set_title(name, fontsize=SMALL, pad=2)
        last = row == len(names) - 1
        for axes in (paths, energy):
            axes.set_xticks([0, 1, 2, 3], ["0", "1", "2", "3"] if last else [])
        if last:
            paths.set_xlabel("time t [s]")
            energy.set_xlabel("time t [s]")
        if row == 0:
            drawn = [*paths.lines[:2], energy.lines[0]]
    _worst(worst, comparison.scores, names)
    legend_of_all(figure, [*drawn, *worst.get_legend_handles_labels()[0]])
    page_heading(figure, printable(comparison.schedule.describe()))


def _paths(axes: Axes, trace: Any, factor: float) -> None:
    time = trace["time"].values
    leader, follower = trace["position"].values * factor
    most = _BEYOND * np.abs(leader).max()
    for path, (name, (colour, line)) in zip((leader, follower), ARMS.items(), strict=True):
        axes.plot(
            time, np.clip(path, -most, most), color=colour, ls=line, lw=1.2, label=f"position x of the {name}"
        )
    axes.axhline(0, color=_GUIDE, lw=0.6, zorder=0)


def _worst(axes: Axes, scores: Any, names: list[str]) -> None:
    """What the worst hands take, and by its mark what is known."""
    taken = np.clip(scores["taken"].values, _LINK_FOOT, _LINK_MOST)
    seen = []
    for row, (value, outcome) in enumerate(zip(taken, scores["outcome"].values, strict=True)):
        status = str(outcome)
        axes.plot([_LINK_FOOT, value], [row, row], color=_GUIDE, lw=1.0, zorder=1)
        text = None if status in seen else _LINK_LABELS.get(status, status)
        seen.append(status)
        axes.plot(value, row, _MARKS[status], color=OUTCOME[status], ms=7, mew=0, clip_on=False, label=text)
    axes.set_xscale("log")
    axes.set_xlim(_LINK_FOOT, _LINK_MOST)
    axes.set_xticks([1e-6, 1e-3, 1.0, 1e3], ["≤10⁻⁶", "0.001", "1", "1000"])
    axes.minorticks_off()
    axes.set_ylim(len(names) - 0.5, -0.5)
    axes.set_yticks([])
    axes.spines["left"].set_visible(False)
    axes.set_xlabel(with_unit("taken by the\nworst hands tried", "J"))


# The real part of a port against frequency, and the index it does not fall below.


_POINTS = 800
_NAMES = {
    "input": ("ν", "Re $G$", "eigenvalues of ½($G$ + $G^H$)"),
    "output": ("ρ", "Re $1/G$", "eigenvalues of ½($G^{-1}$ + $G^{-H}$)"),
}


@rc_context(LOOK)
def indices(found: PassivityIndices) -> Figure:
    """Re G and Re 1/G against frequency with the two indices; of several axes the eigenvalues.

    Parameters
    ----------
    found
        What `zwidth.ports.passivity_indices` returned.
    """
    figure = new_figure(height=3.8)
    left, right = figure.subplots(1, 2)
    draw_index(left, found.input)
    draw_index(right, found.output)
    return figure


def draw_index(axes: Axes, index: PassivityIndex) -> None:
    """One of them on given axes."""
    several = index.port.axes > 1
    symbol, name = _NAMES[index.name][0], _NAMES[index.name][1 + several]
    title = f"{index.name} index: {_title(index, symbol)}"
    axes.set_xlabel(label("frequency"))
    axes.set_ylabel(name)
    if index.found is None:
        heading(axes, title)
        return
    frequencies = _frequencies(index)
    values, *others = index.curves(list(frequencies))
    for n, other in enumerate(others):
        axes.plot(frequencies, other, color=GREY, lw=0.9, label=None if n else "the others")
    axes.plot(frequencies, values, color=BLUE, label="the least" if others else "real part")
    axes.axhline(0, color=GREY, lw=0.6)
    axes.set_xscale("log" if index.port.time == "continuous" else "linear")
    axes.set_xlim(frequencies[0], frequencies[-1])
    _limit_height(axes, values, index.value)
    if isfinite(index.value):
        axes.axhline(index.value, color="black", ls="--", lw=1.2, label=f"index {symbol}")
    at = index.frequency
    if at is not None:
        at = min(max(at, frequencies[0]), frequencies[-1])
        axes.plot([at], [index.value], "o", color=RED, ms=6, clip_on=False, zorder=5, label="where it is")
    legend(axes)
    heading(axes, title)


def _title(index: PassivityIndex, symbol: str) -> str:
    if index.found is None:
        return f"{symbol} = ∞"
    if not isfinite(index.value):
        return f"{symbol} = −∞"
    return f"{symbol} = {number(index.value)} {told_place(index.frequency)}"


def _frequencies(index: PassivityIndex) -> np.ndarray:
    """Two decades about the poles and zeros; of a discrete port up to half the rate."""
    port, at = index.port, index.frequency
    if port.time == "discrete":
        nyquist = 0.5 / float(port.period)
        grid = np.linspace(nyquist / _POINTS, nyquist, _POINTS)
        return np.unique(np.append(grid, at)) if at else grid
    places = [abs(p) / (2 * np.pi) for p in index.places() if p]
    known = [*places, *([at] if at and at < inf else [])] or [1.0]
    grid = np.geomspace(min(known) / 100, max(known) * 100, _POINTS)
    return np.unique(np.concatenate([grid, known]))


def _limit_height(axes: Axes, values: list[float], value: float) -> None:
    """Zero, the index and all but the sharpest peaks of the curve."""
    finite = [v for v in values if isfinite(v)] or [0.0]
    shown = [0.0, *np.percentile(finite, [1, 99]), *([value] if isfinite(value) else [])]
    span = (max(shown) - min(shown)) or 1.0
    axes.set_ylim(min(shown) - 0.1 * span, max(shown) + 0.1 * span)
