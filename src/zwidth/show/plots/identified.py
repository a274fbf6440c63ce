"""A device that was identified from a log: friction against speed, data against model, what is left over."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from zwidth.data.identification.device.curve import DIRECTIONS, friction_bins, lower_bounds
from zwidth.data.identification.device.estimate import Estimate
from zwidth.data.identification.device.numbers import BINS, IdentifiedNumbers
from zwidth.data.identification.device.pulses import PIECES, pulse
from zwidth.data.identification.device.table import percent, rows, title
from zwidth.data.tissue.experiment.history import History
from zwidth.errors import InputError
from zwidth.native.compiled import Array
from zwidth.quantity.exact import ends
from zwidth.quantity.text import quantity_unit, shown, told_quantity
from zwidth.show.plots.style import (
    BLACK,
    BLUE,
    GREY,
    LOOK,
    ORANGE,
    RED,
    SMALL,
    WIDEST,
    broken,
    heading,
    legend,
    low_index,
    new_figure,
    page_heading,
    scale,
    with_unit,
)

if TYPE_CHECKING:
    import xarray as xr

    from zwidth.data.tissue.result import TissueFit


_BEYOND = 1.15
"""Times the largest speed, to which the axis goes."""

_CONFIDENCE = 0.95
"""Of the bands, the error bars and the curve below the data."""

_LINE = 15
"""Between two of the numbers [point]."""

_MOST = 6000
"""Pulses that are drawn as points."""

_SECONDS = 3.0
"""Of the log, that are drawn as they went [s]."""


@rc_context(LOOK)
def identification_figure(identified: IdentifiedNumbers) -> Figure:
    """Friction against speed, the numbers below it; then some seconds of the log and what is left over."""
    told = (_LINE * len(rows(identified, _CONFIDENCE)), 1.4 * SMALL * len(_found(identified)))
    heights = (4.2, 0.2 + max(told) / 72, 2.9)
    figure = new_figure(height=sum(heights))
    grid = figure.add_gridspec(3, 1, height_ratios=heights)
    draw_friction_points(figure.add_subplot(grid[0]), identified)
    _numbers(figure.add_subplot(grid[1]), identified)
    lower = grid[2].subgridspec(1, 3, width_ratios=(1.4, 1.1, 0.6))
    _data(figure.add_subplot(lower[0]), identified)
    left = figure.add_subplot(lower[1])
    _left(left, identified)
    _histogram(figure.add_subplot(lower[2], sharey=left), identified)
    page_heading(figure, title(identified))
    return figure


def draw_friction_points(axes: Axes, identified: IdentifiedNumbers) -> None:
    """Friction against velocity, out of the wall on the left: pulses, means, the fit, and the line promised.

    Speeds that few strokes reached are hatched: what is promised ends there.
    """
    points = _thinned(identified)
    velocity = points["speed"].values
    friction = points["friction"].values * np.sign(velocity)
    axes.plot([], [], ".", color=GREY, label="means over pulses")
    axes.plot(velocity, friction, ".", ms=2.5, color=GREY, alpha=0.4, mew=0, rasterized=True)
    end = _BEYOND * float(np.abs(velocity).max())
    along = np.linspace(0.0, end, 50)
    for side, estimate in _damping_by_side(identified):
        fit, reach = _fitted(identified, estimate, along)
        axes.fill_between(side * along, fit - reach, fit + reach, color=BLUE, alpha=0.2, lw=0)
        axes.plot(
            side * along, fit, color=BLUE, label=f"fit, {percent(_CONFIDENCE)} band" if side > 0 else None
        )
    if "coulomb_friction" in identified.estimates:
        alone = identified.viscous_alone
        label = f"mass–damper model: {alone:.3g} |v|"
        axes.plot([-end, 0.0, end], [alone * end, 0.0, alone * end], ":", color=ORANGE, lw=1.6, label=label)
        _promised(axes, identified)
    _unseen(axes, identified, end)
    low, high = np.quantile(friction, [0.01, 0.99])
    axes.set_ylim(min(low, 0.0), 1.25 * high)
    axes.set_xlim(-end, end)
    axes.set_xlabel(with_unit("velocity v, into the wall on the right", _speed(identified)))
    axes.set_ylabel(with_unit("friction", _force(identified)))
    legend(axes)
    heading(axes, "friction against the motion")


def _damping_by_side(identified: IdentifiedNumbers) -> list[tuple[float, Estimate]]:
    """+1 into the wall and −1 out of it, with the damping that was fitted for it."""
    both = identified.directions
    if identified.shows("damping by direction"):
        return [(1.0, both.inward), (-1.0, both.outward)]
    return [(side, identified.estimates["damping"]) for side in (1.0, -1.0)]


def _promised(axes: Axes, identified: IdentifiedNumbers) -> None:
    """Means with bars in which all hold together, and below them the line on which a promise rests."""
    bins = friction_bins(identified.points, BINS)
    bounds = lower_bounds(identified.points, _CONFIDENCE, BINS)
    for side, way, (_, low) in zip((1.0, -1.0), DIRECTIONS, bounds, strict=True):
        here = bins.sel(direction=way)
        middle = here["friction"].values
        axes.errorbar(
            side * here["speed"].values,
            middle,
            (np.maximum(middle - low[1:], 0.0), np.zeros(middle.size)),
            fmt="o",
            ms=4,
            color=BLACK,
            capsize=3,
            lw=1.2,
            label="means, and what they are at least, all together" if side > 0 else None,
            zorder=5,
        )
    device = identified.device(_CONFIDENCE)
    b, f_c = (float(ends(value)[0]) for value in (device.damping, device.coulomb_friction))
    speed = identified.speed
    up_to = told_quantity(speed, "friction_speed", identified.motion, 3)
    label = f"promised, up to {up_to}: {f_c:.3g} + {b:.3g} |v|"
    height = f_c + b * speed
    axes.plot([-speed, 0.0, speed], [height, f_c, height], color=RED, ls="--", lw=1.6, label=label, zorder=6)


def _unseen(axes: Axes, identified: IdentifiedNumbers, end: float) -> None:
    """Hatch the velocities of which the data say nothing."""
    inward, outward = identified.fastest
    for k, (near, far) in enumerate(((inward, end), (-end, -outward))):
        label = "seen too seldom, or never: nothing is promised" if k == 0 else None
        axes.axvspan(near, far, facecolor="none", edgecolor=GREY, hatch="///", lw=0, alpha=0.6, label=label)


def _fitted(identified: IdentifiedNumbers, damping: Estimate, speed: Array) -> tuple[Array, Array]:
    """f_c + b |v|, and the half width of a band that holds with each parameter at its worst."""
    terms = [(damping, speed)]
    if "coulomb_friction" in identified.estimates:
        terms.append((identified.estimates["coulomb_friction"], np.ones_like(speed)))
    fit = sum((estimate.value * factor for estimate, factor in terms), np.zeros_like(speed))
    reach = sum(
        ((estimate.interval(_CONFIDENCE)[1] - estimate.value) * factor for estimate, factor in terms),
        np.zeros_like(speed),
    )
    return fit, reach


def _data(axes: Axes, identified: IdentifiedNumbers) -> None:
    """Some seconds from the middle of the log: the force of the pulses, and what the model makes of it."""
    points = identified.points
    piece = points["piece"].values
    time = points["time"].values
    inside = piece == piece[piece.size // 2]
    start = max(float(time[inside].mean()) - _SECONDS / 2, float(time[inside].min()))
    inside &= (time >= start) & (time < start + _SECONDS)
    name, what = ("force", "force") if identified.mass is None else ("friction", "force less m a")
    measured = points[name].values[inside]
    model = measured - points["residual"].values[inside]
    moment, stroke = time[inside] - start, points["stroke"].values[inside]
    breaks = np.flatnonzero(np.diff(stroke)) + 1
    axes.plot(moment, measured, ".", ms=3.5, color=GREY, mew=0, label="means over pulses")
    axes.plot(
        np.insert(moment, breaks, np.nan), np.insert(model, breaks, np.nan), color=BLUE, lw=1.2, label="model"
    )
    axes.set_xlabel("time t [s]")
    axes.set_ylabel(with_unit(what, _force(identified)))
    legend(axes)
    heading(axes, "some seconds of the log")


def _left(axes: Axes, identified: IdentifiedNumbers) -> None:
    """What is left over against velocity; a bend of the means would be friction of another form."""
    points = _thinned(identified)
    axes.plot(points["speed"], points["residual"], ".", ms=2.5, color=GREY, alpha=0.4, mew=0, rasterized=True)
    velocity, left = identified.points["speed"].values, identified.points["residual"].values
    order = np.argsort(velocity, kind="stable")
    parts = [part for part in np.array_split(order, 2 * BINS) if part.size]
    axes.axhline(0.0, color=BLACK, lw=0.8)
    middle = [float(velocity[part].mean()) for part in parts]
    axes.plot(middle, [float(left[part].mean()) for part in parts], "o", ms=4, color=ORANGE, label="means")
    reach = 4.0 * float(left.std())
    axes.set_ylim(-reach, reach)
    axes.set_xlabel(with_unit("velocity v", _speed(identified)))
    axes.set_ylabel(with_unit("left over", _force(identified)))
    legend(axes)
    heading(axes, "left over")


def _histogram(axes: Axes, identified: IdentifiedNumbers) -> None:
    """Left over, and what encoder and noise of the force alone would leave."""
    left = identified.points["residual"].values
    reach = 4.0 * float(left.std())
    axes.hist(
        left,
        bins=np.linspace(-reach, reach, 61).tolist(),
        density=True,
        orientation="horizontal",
        color=GREY,
        alpha=0.5,
        label="seen",
    )
    at = np.linspace(-reach, reach, 201)
    counts, force = expected_scatter(identified)
    both = float(np.hypot(counts, force))
    if both > 0:
        bell = np.exp(-((at / both) ** 2) / 2) / (both * np.sqrt(2 * np.pi))
        axes.plot(bell, at, color=BLUE, lw=1.2, label="expected")
    axes.tick_params(labelleft=False)
    axes.set_xticks([])
    axes.spines["bottom"].set_visible(False)
    legend(axes)


def expected_scatter(identified: IdentifiedNumbers) -> tuple[float, float]:
    """Deviation of a pulse's force by the encoder's counts, and by the noise of the force [N; N·m].

    Counts are taken as random within a step, Δ²/12 each; the acceleration of a pulse is
    Σ φ″ x/(h w²), so that they come in with m Δ/√12 · √(Σ φ″²)/(h w²).
    """
    piece = round(identified.pulse_length / identified.sample_period / PIECES)
    shape = pulse(piece)
    mass = identified.estimates["mass"].value if "mass" in identified.estimates else identified.mass or 0.0
    width = piece * identified.sample_period
    step = identified.resolution / np.sqrt(12.0)
    counts = mass * step * float(np.sqrt(np.sum(shape.bend**2))) / (piece * width**2)
    noise = identified.force_noise * float(np.sqrt(np.sum((shape.value / piece) ** 2)))
    return float(counts), noise


def _found(identified: IdentifiedNumbers) -> list[str]:
    """What is said of the numbers, on lines that fill half of the width."""
    unit, (counts, force) = _force(identified), expected_scatter(identified)
    left = float(identified.points["residual"].values.std())
    text = [
        f"{percent(_CONFIDENCE)} intervals; r² = {identified.explained:.4f}",
        f"{identified.strokes} strokes, {identified.pulses} means "
        f"over {shown(identified.pulse_length, 's', 3)}",
        f"left over: deviation {shown(left, unit, 3)}, expected {shown(np.hypot(counts, force), unit, 3)} "
        f"(noise {shown(force, unit, 2)}, encoder {shown(counts, unit, 2)})",
        *identified.findings,
    ]
    broad = (broken(f"· {line}", 0.48 * WIDEST, SMALL).replace("\n", "\n  ") for line in text)
    return "\n".join(broad).splitlines()


def _numbers(axes: Axes, identified: IdentifiedNumbers) -> None:
    axes.set_axis_off()
    place: Any = {"xycoords": "axes fraction", "textcoords": "offset points", "va": "top", "color": BLACK}
    for k, row in enumerate(rows(identified, _CONFIDENCE)):
        way = row.name.strip() if row.name.startswith(" ") else ""
        axes.annotate(f"{low_index(row.symbol)} {way}", (0.0, 1.0), (0, -_LINE * k), **place)
        axes.annotate(f"{row.value} {row.unit}", (0.1, 1.0), (0, -_LINE * k), **place, fontweight="bold")
        axes.annotate(row.interval, (0.29, 1.0), (0, -_LINE * k), **{**place, "color": GREY})
    lines = "\n".join(_found(identified))
    axes.annotate(lines, (0.5, 1.0), (0, 0), **place, fontsize=SMALL, parse_math=False)


def _thinned(identified: IdentifiedNumbers) -> xr.Dataset:
    points = identified.points
    stride = max(1, points.sizes["pulse"] // _MOST)
    return points.isel(pulse=slice(None, None, stride))


def _force(identified: IdentifiedNumbers) -> str:
    return quantity_unit("force", identified.motion)


def _speed(identified: IdentifiedNumbers) -> str:
    return quantity_unit("friction_speed", identified.motion)


MOST_DOTS = 4000


@rc_context(LOOK)
def fit_figure(fit: TissueFit) -> Figure:
    """Measured and fitted against the time; below, what is left over.

    Raises
    ------
    InputError
        If the times are not known.
    """
    if fit.time is None:
        raise InputError("this fit does not hold the times of its samples: there is nothing to draw")
    figure = new_figure(height=5.2)
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(2.2, 1.0))
    draw_fit(above, fit, fit.time)
    draw_left(below, fit, fit.time)
    below.set_xlabel("time t [s]")
    page_heading(figure, fit_title(fit))
    return figure


def fit_title(fit: TissueFit) -> str:
    """The model and its numbers, on a line."""
    rows = fit.table()[1 : 1 + len(fit.model.parameters)]
    numbers = ", ".join(f"{row[0].replace('_', ' ')} {float(row[1]):.4g} {row[3]}" for row in rows)
    return f"{fit.model.name}: {numbers}"


def draw_fit(axes: Axes, fit: TissueFit, time: Array) -> None:
    factor, unit = scale(fit.output, quantity_unit(fit.response, fit.motion))
    every = slice(None, None, max(1, time.size // MOST_DOTS))
    axes.plot(time[every], factor * fit.output[every], ".", ms=5, color=GREY, mew=0, label="measured")
    axes.plot(
        time, factor * (fit.output - fit.residuals), color=BLUE, lw=1.4, label=f"{fit.model.name}, fitted"
    )
    axes.set_ylabel(with_unit("force" if fit.response == "force" else "depth", unit))
    legend(axes)


def draw_left(axes: Axes, fit: TissueFit, time: Array) -> None:
    """Measured less fitted: noise, if the model is right."""
    factor, unit = scale(fit.residuals, quantity_unit(fit.response, fit.motion))
    every = slice(None, None, max(1, time.size // MOST_DOTS))
    axes.axhline(0.0, color=GREY, lw=0.8)
    axes.plot(time[every], factor * fit.residuals[every], ".", ms=2.5, color=RED, mew=0)
    axes.set_ylabel(with_unit("left over", unit))
    heading(axes, "measured less fitted: noise, where the model is right")


@rc_context(LOOK)
def test_figure(test: History, best: TissueFit) -> Figure:
    """The response with the fit, what is left over, and the history that it answers."""
    figure = new_figure(height=6.8)
    above, below, history = figure.subplots(3, 1, sharex=True, height_ratios=(2.2, 1.0, 1.0))
    time = test.time
    draw_fit(above, best, time)
    draw_left(below, best, time)
    given, unit, name = (test.force, "N", "force") if test.kind == "creep" else (test.depth, "m", "depth")
    factor, shown_unit = scale(given, unit)
    history.plot(time, factor * given, color=BLACK, lw=1.2)
    history.set_ylabel(with_unit(name, shown_unit))
    history.set_xlabel("time t [s]")
    page_heading(figure, f"{test.kind} test, {fit_title(best)}")
    return figure
