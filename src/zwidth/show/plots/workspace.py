"""The map of an arm's workspace: the margin, where it ends, and in which direction it is smallest."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.colors import TwoSlopeNorm
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FormatStrFormatter, MaxNLocator, NullLocator, ScalarFormatter

from zwidth.errors import InputError
from zwidth.model.arms.null_space import Loop, Shape, gain, shapes
from zwidth.passivity.workspace import Workspace
from zwidth.quantity.spoken import spoken, spoken_data
from zwidth.quantity.text import shown
from zwidth.show.plots.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    LOOK,
    ORANGE,
    OUTCOME,
    RED,
    SMALL,
    WIDEST,
    heading,
    legend,
    new_figure,
    note,
    number,
    page_heading,
    verbatim,
    with_unit,
)

if TYPE_CHECKING:
    import xarray as xr

    from zwidth.passivity.workspace import NullSpace, PostureMap


_ARROWS = 14
"""Marks of the worst direction along each side."""
_LEAST_SPREAD = 1e-3
"""Of the largest value: what varies less is drawn as one colour."""


@rc_context(LOOK)
def workspace_figure(space: Workspace, variable: str | None = None) -> Figure:
    """One variable of the map, in colours; red where there is too little of it.

    Parameters
    ----------
    space
        What `zwidth.workspace` returned.
    variable
        A name in `space.data`. Default "margin", of a wall in pose "margin_in_joints".
    """
    figure = new_figure(height=4.4)
    draw_workspace(figure.add_subplot(), space, variable)
    _fit(figure)
    title = f"{space.arm.name}: {space.outcome}. {space.claim}"
    page_heading(figure, title, color=OUTCOME[space.outcome])
    return figure


def _fit(figure: Figure) -> None:
    """As wide and as high as a map takes that has one scale along both axes."""
    axes = figure.axes[0]
    if axes.get_aspect() != "auto":
        wide, high = np.ptp(axes.get_xlim()), np.ptp(axes.get_ylim())
        largest = min((WIDEST - 2.2) / wide, 4.5 / high)
        figure.set_size_inches(max(4.8, 2.2 + largest * wide), 1.9 + largest * high)


def draw_workspace(axes: Axes, space: Workspace, variable: str | None = None) -> None:
    """The same on axes of your own."""
    least = "margin" if "margin" in space.data else "margin_in_joints"
    variable = least if variable is None else variable
    if variable not in space.data:
        raise InputError(f"the map has no {variable!r}; it has {', '.join(map(str, space.data))}")
    data = spoken_data(space.data)
    drawn = data[variable]
    label = with_unit(variable.replace("_", " "), drawn.attrs["units"])
    if drawn.ndim == 1:
        _line(axes, data, drawn, label)
        return
    if drawn.ndim > 2:
        raise InputError("a map of more than two joints cannot be drawn; take a slice of `data`")
    across, up, names = _coordinates(data)
    values = np.asarray(drawn.values, dtype=np.float64)
    # The cells of a chain are bent: their colours run from middle to middle.
    shading: Any = "nearest" if "x" in space.data.coords or names != ("x", "y") else "gouraud"
    colours = axes.pcolormesh(across, up, values, shading=shading, rasterized=True, **_colours(values))
    beyond = float(np.nanmax(values)) > colours.get_clim()[1] * (1 + 1e-9)
    bar = axes.figure.colorbar(colours, ax=axes, label=label, extend="max" if beyond else "neither")
    bar.formatter = ScalarFormatter(useOffset=False)
    low, high = colours.get_clim()
    if low < 0 < high:  # the two sides of 0 have scales of their own, and numbers of their own
        sides = [MaxNLocator(4).tick_values(*side) for side in ((low, 0.0), (0.0, high))]
        bar.set_ticks([v for v in np.unique(np.concatenate(sides)) if low <= v <= high])
    margin, notes = space.data[least].values, []
    if np.nanmin(margin) < 0 < np.nanmax(margin):
        axes.contour(across, up, margin, levels=[0.0], colors=[BLACK], linewidths=1.5)
        notes.append("black line: margin 0")
    if names == ("x", "y"):
        axes.set_aspect("equal")
        if least == "margin":
            _directions(axes, data, across, up)
            notes.append("strokes: the direction in which the margin is smallest")
    if notes:
        note(axes, "; ".join(notes))
    axes.set_xlabel(_axis(data, names[0]))
    axes.set_ylabel(_axis(data, names[1]))


def _line(axes: Axes, data: xr.Dataset, drawn: xr.DataArray, label: str) -> None:
    name = str(drawn.dims[0])
    axes.plot(data[name], drawn.values, color=OUTCOME["passive"] if drawn.min() >= 0 else RED)
    axes.axhline(0, color=GREY, linewidth=0.8)
    axes.set_xlabel(_axis(data, name))
    axes.set_ylabel(label)


def _coordinates(data: xr.Dataset) -> tuple[Any, Any, tuple[str, str]]:
    """The plane of the hand where there is one, else that of the two joints."""
    if "x" in data.coords:
        return (*np.meshgrid(data["x"], data["y"], indexing="ij"), ("x", "y"))
    if "hand_x" in data.coords and "hand_z" not in data.coords:
        return data["hand_x"].values, data["hand_y"].values, ("x", "y")
    first, second = (str(name) for name in data["margin_in_joints"].dims)
    return (*np.meshgrid(data[first], data[second], indexing="ij"), (first, second))


def _colours(values: Any) -> dict[str, Any]:
    known = values[np.isfinite(values)]
    low, high = (float(known.min()), float(np.percentile(known, 95))) if known.size else (0.0, 0.0)
    if low < 0:
        return {"cmap": "RdBu", "norm": TwoSlopeNorm(0.0, low, max(high, -low / 2))}
    return {"cmap": "viridis", "vmin": low, "vmax": max(high, low + max(_LEAST_SPREAD * high, 1e-300))}


def _directions(axes: Axes, data: xr.Dataset, across: Any, up: Any) -> None:
    step = tuple(slice(n // (2 * _ARROWS), None, max(1, n // _ARROWS)) for n in across.shape)
    u, v = data["direction_x"].values[step], data["direction_y"].values[step]
    axes.quiver(
        across[step], up[step], u, v, color=BLACK, alpha=0.5, pivot="mid", headwidth=0, headlength=0,
        headaxislength=0, scale=2.2 * _ARROWS, width=0.0025,
    )  # fmt: skip


def _axis(data: xr.Dataset, name: str) -> str:
    if name in ("x", "y"):
        return with_unit(name, "m")
    return with_unit(f"joint {verbatim(name)}", data[name].attrs["units"])


Array = npt.NDArray[np.float64]

_SIZES = 24
_SPAN = 1.8
"""How much farther than the loop, or the distance asked about, the joules are drawn."""
_FIRST = 0.02
"""The smallest size that is drawn [rad]."""
_ROUND = 200
_TICKS = [step * 10.0**power for power in range(-3, 3) for step in (1, 2, 5)]


@rc_context(LOOK)
def null_space_figure(found: NullSpace) -> Figure:
    """The loop in the two joints that move most, and joules per turn over the size of the region.

    Parameters
    ----------
    found
        What `zwidth.null_space` returned.
    """
    figure = new_figure(height=4.8)
    shape = _shape(found)
    *left, right = figure.subplots(1, 2 if shape else 1, squeeze=False)[0]
    if shape is not None:
        _draw_loop(left[0], found, shape)
    _draw_joules(right, found, shape)
    spring = shown(found.spring.stiffness, "N*m/rad")
    title = f"{found.question.arm.name}: null-space spring of {spring}, {found.outcome}. {found.claim}"
    page_heading(figure, title, color=OUTCOME[found.outcome])
    return figure


def _shape(found: NullSpace) -> Shape | None:
    """Of the loop that was replayed, else of the one that would begin to gain soonest."""
    arm, spring = found.question.arm, found.spring
    if found.loop is not None:
        reach = found.loop.reach(spring.rest)
        centre = found.loop.centre - np.asarray(spring.rest)
        return Shape(centre / reach, found.loop.cosine / reach, found.loop.sine / reach)
    if not spring.stiffness:
        return None
    return next(iter(shapes(arm, spring)), None)  # type: ignore[arg-type]  # a chain or a description


def _draw_loop(axes: Axes, found: NullSpace, shape: Shape) -> None:
    rest = np.asarray(found.spring.rest)
    factor, unit = spoken("rad")
    size = found.loop.reach(found.spring.rest) if found.loop is not None else _largest(found)
    swing = np.hypot(shape.cosine, shape.sine)
    first, second = sorted(np.argsort(swing)[-2:].tolist())
    joints = Loop(rest + size * shape.centre, size * shape.cosine, size * shape.sine, _ROUND).joints()
    joints, rest = factor * np.vstack([joints, joints[:1]]), factor * rest
    colour, line = (RED, "-") if found.loop is not None else (GREY, ":")
    axes.plot(joints[:, first], joints[:, second], line, color=colour)
    if found.loop is not None:
        start = _ROUND // 8
        axes.annotate(
            "",
            xy=_pair(joints[start + 4], first, second),
            xytext=_pair(joints[start], first, second),
            arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 1.4},
        )
    axes.plot(rest[first], rest[second], "+", color=BLACK, ms=9)
    axes.annotate(
        "rest", _pair(rest, first, second), xytext=(4, 4), textcoords="offset points", fontsize=SMALL
    )
    names = [verbatim(name) for name in found.question.arm.joint_names]
    axes.set_xlabel(with_unit(f"joint {names[first]}", unit))
    axes.set_ylabel(with_unit(f"joint {names[second]}", unit))
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.15)
    axes.locator_params(nbins=5)
    told = "the loop, replayed" if found.loop is not None else "a loop that is first to gain, if larger"
    others = [i for i in np.argsort(-np.abs(shape.centre)) if i not in (first, second)]
    away = [f"{names[i]} {number(float(f'{factor * size * shape.centre[i]:.2g}'))}" for i in others[:2]]
    heading(axes, f"{told}; off its rest by {', '.join(away)} {unit}")


def _pair(joints: Array, first: int, second: int) -> tuple[float, float]:
    return float(joints[first]), float(joints[second])


def _largest(found: NullSpace) -> float:
    """The size up to which something is known or was asked [rad]."""
    reach = 0.0 if found.loop is None else found.loop.reach(found.spring.rest)
    return max(reach, found.within or 0.0, found.covered, 5 * _FIRST)


def _draw_joules(axes: Axes, found: NullSpace, shape: Shape | None) -> None:
    most = _SPAN * _largest(found)
    least = min(_FIRST, most / 10)
    sizes = np.geomspace(least, most, _SIZES)
    factor, unit = spoken("rad")
    if shape is None:
        axes.set_yticks([])
    else:
        axes.set_yscale("log")
        axes.set_ylabel(with_unit("energy of one turn", "J"))
        joules = [gain(found.question.arm, found.spring, shape, float(size)) for size in sizes]
        given, lost = np.abs([one[0] for one in joules]), np.array([one[1] for one in joules])
        axes.plot(factor * sizes, given, color=RED, label="the spring gives, slowly round")
        if lost.any():
            axes.plot(factor * sizes, lost, "--", color=BLUE, label="Coulomb friction takes")
    if found.covered:
        axes.axvspan(factor * least, factor * found.covered, color=GREEN, alpha=0.15, lw=0)
        text = f"proved up to {shown(found.covered, 'rad', 3)}"
        axes.axvline(factor * found.covered, color=GREEN, ls="-.", lw=1.2, label=text)
    if found.loop is not None and found.slow is not None:
        reach = found.loop.reach(found.spring.rest)
        axes.axvspan(factor * reach, factor * most, color=ORANGE, alpha=0.15, lw=0)
        axes.plot(
            [factor * reach], [-found.slow.energy], "o", color=BLACK, ms=5,
            label=f"replayed: {shown(-found.slow.energy, 'J')} out at {shown(reach, 'rad', 3)}",
        )  # fmt: skip
    if found.within is not None:
        text = f"asked: {shown(found.within, 'rad', 3)}"
        axes.axvline(factor * found.within, color=GREY, lw=1.0, ls=":", label=text)
    axes.set_xscale("log")
    axes.set_xlim(factor * least, factor * most)
    ticks = [tick for tick in _TICKS if factor * least <= tick <= factor * most]
    axes.xaxis.set_major_locator(FixedLocator(ticks))
    axes.xaxis.set_major_formatter(FormatStrFormatter("%g"))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xlabel(with_unit("distance from the rest", unit))
    legend(axes)
    known = (found.covered, found.loop.reach(found.spring.rest) if found.loop is not None else most)
    edges = (least, max(least, known[0]), known[1], most)
    for word, (start, end) in zip(("proved", "not known", "active"), pairwise(edges), strict=True):
        if end > 1.5 * start:
            axes.text(
                factor * float(np.sqrt(start * end)), 0.02, word, ha="center", fontsize=SMALL, color=GREY,
                transform=axes.get_xaxis_transform(),
            )  # fmt: skip
    axes.set_ylim(axes.get_ylim()[0] / 3, None)  # room for the words


@rc_context(LOOK)
def postures_figure(found: PostureMap) -> Figure:
    """By distance from the first axis and height: the least of the postures in each cell.

    Parameters
    ----------
    found
        What `zwidth.stiffness_over_postures` returned.
    """
    name = "largest_stiffness" if "largest_stiffness" in found.data else "stiffness_factor"
    data = found.data[name]
    values = np.asarray(data.values, dtype=np.float64)
    known = values[np.isfinite(values)]
    figure = new_figure()
    axes = figure.add_subplot()
    colours = axes.pcolormesh(
        found.data["radius"],
        found.data["height"],
        values.T,
        cmap="viridis",
        vmin=float(known.min()),
        vmax=float(np.percentile(known, 95)),
        shading="nearest",
        rasterized=True,
    )
    label = with_unit(name.replace("_", " "), data.attrs["units"])
    figure.colorbar(colours, ax=axes, label=label, extend="max")
    axes.set_aspect("equal")
    axes.set_xlabel(with_unit("distance from the first axis", "m"))
    axes.set_ylabel(with_unit("height", "m"))
    note(axes, "the least of the postures tried in each cell")
    _fit(figure)
    title = f"{found.question.arm.name}: {found.outcome}. {found.claim}"
    page_heading(figure, title, color=OUTCOME[found.outcome])
    return figure
