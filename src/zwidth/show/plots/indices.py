"""The real part of a port against frequency, and the index it does not fall below.

The input index is the least of Re G, the output index the least of Re 1/G; both only
where no pole lies where it may not.  With several axes the eigenvalues of the Hermitian
parts take the place of the real parts.
"""

from __future__ import annotations

from math import inf, isfinite

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from zwidth.passivity.ports.index import PassivityIndex
from zwidth.passivity.ports.indices import PassivityIndices
from zwidth.show.plots.style import BLUE, GREY, LOOK, RED, heading, label, new_figure, number

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
    figure = new_figure(8.6, 3.6)
    left, right = figure.subplots(1, 2)
    draw_index(left, found.input)
    draw_index(right, found.output)
    return figure


def draw_index(axes: Axes, index: PassivityIndex) -> None:
    """One of them on given axes."""
    several = index.port.axes > 1
    symbol, name = _NAMES[index.name][0], _NAMES[index.name][1 + several]
    heading(axes, f"{index.name} index: {_title(index, symbol)}")
    axes.set_xlabel(label("frequency"))
    axes.set_ylabel(name)
    if index.found is None:
        return
    frequencies = _frequencies(index)
    values, *others = index.curves(list(frequencies))
    for other in others:
        axes.plot(frequencies, other, color=GREY, lw=0.9)
    axes.plot(frequencies, values, color=BLUE)
    axes.axhline(0, color=GREY, lw=0.6)
    axes.set_xscale("log" if index.port.time == "continuous" else "linear")
    axes.set_xlim(frequencies[0], frequencies[-1])
    _limit_height(axes, values, index.value)
    if isfinite(index.value):
        axes.axhline(index.value, color="black", ls="--", lw=1.2)
    at = index.frequency
    if at is not None:
        at = min(max(at, frequencies[0]), frequencies[-1])
        axes.plot([at], [index.value], "o", color=RED, ms=6, clip_on=False, zorder=5)


def _title(index: PassivityIndex, symbol: str) -> str:
    if index.found is None:
        return f"{symbol} = ∞"
    if not isfinite(index.value):
        return f"{symbol} = −∞"
    at = index.frequency
    place = "at every frequency" if at is None else "at ∞ Hz" if at == inf else f"at {number(at)} Hz"
    return f"{symbol} = {number(index.value)} {place}"


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
