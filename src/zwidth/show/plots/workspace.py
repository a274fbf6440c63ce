"""The map of an arm's workspace: the margin, where it ends, and in which direction it is smallest."""

from __future__ import annotations

from itertools import pairwise
from textwrap import shorten
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.colors import TwoSlopeNorm
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FormatStrFormatter, MaxNLocator, NullLocator, ScalarFormatter

from zwidth.errors import InputError
from zwidth.model.arms import DescribedArm
from zwidth.model.arms.encoders import in_words
from zwidth.model.arms.null_space import Loop, Shape, gain, shapes
from zwidth.passivity.workspace import Workspace
from zwidth.quantity.text import shown, unit_text
from zwidth.show.plots.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    LOOK,
    ORANGE,
    OUTCOME,
    RED,
    heading,
    new_figure,
    note,
    number,
    page_heading,
    verbatim,
)

if TYPE_CHECKING:
    from zwidth.passivity.workspace import NullSpace, PostureMap


_ARROWS = 14
"""Marks of the worst direction along each side."""
_LONGEST = 110
"""Characters of the line below the map."""
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
    figure = new_figure(6.4, 5.0)
    axes = figure.add_subplot()
    draw_workspace(axes, space, variable)
    page_heading(figure, f"{space.arm.name}: {space.outcome}", color=OUTCOME[space.outcome])
    figure.supxlabel(
        shorten(_covers(space), _LONGEST, placeholder=" …"), x=0.01, ha="left", fontsize=8, color=GREY,
        parse_math=False,
    )  # fmt: skip
    return figure


def _covers(space: Workspace) -> str:
    """How the arm is read and what the torque does, in a line."""
    forces = f", wall forces up to {in_words(space.largest_forces)}" if space.largest_forces else ""
    read = "read without steps" if space.encoder == "ideal" else "encoder steps counted"
    follows = "follows the arm" if space.encoder == "ideal" else "follows the readings"
    return f"{read}; torque {follows if space.torque == 'follows' else 'held over a period'}{forces}"


def draw_workspace(axes: Axes, space: Workspace, variable: str | None = None) -> None:
    """Draw one variable of the map on axes of your own.

    Parameters
    ----------
    axes
        Where to draw.
    space
        What `zwidth.workspace` returned.
    variable
        A name in `space.data`. Default "margin", of a wall in pose "margin_in_joints".
    """
    least = "margin" if "margin" in space.data else "margin_in_joints"
    variable = least if variable is None else variable
    if variable not in space.data:
        raise InputError(f"the map has no {variable!r}; it has {', '.join(map(str, space.data))}")
    data = space.data[variable]
    label = f"{variable.replace('_', ' ')} [{unit_text(data.attrs['units']) or '1'}]"
    if data.ndim == 1:
        _line(axes, space, data, label)
        return
    if data.ndim > 2:
        raise InputError("a map of more than two joints cannot be drawn; take a slice of `data`")
    across, up, names = _coordinates(space)
    values = np.asarray(data.values, dtype=np.float64)
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
            _directions(axes, space, across, up)
            notes.append("strokes: the direction in which the margin is smallest")
    if notes:
        note(axes, "; ".join(notes))
    axes.set_xlabel(_axis(space, names[0]))
    axes.set_ylabel(_axis(space, names[1]))


def _line(axes: Axes, space: Workspace, data: Any, label: str) -> None:
    name = str(data.dims[0])
    axes.plot(data[name], data.values, color=OUTCOME["passive"] if data.min() >= 0 else RED)
    axes.axhline(0, color=GREY, linewidth=0.8)
    axes.set_xlabel(_axis(space, name))
    axes.set_ylabel(label)


def _coordinates(space: Workspace) -> tuple[Any, Any, tuple[str, str]]:
    """The plane of the hand where there is one, else that of the two joints."""
    data = space.data
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


def _directions(axes: Axes, space: Workspace, across: Any, up: Any) -> None:
    step = tuple(slice(n // (2 * _ARROWS), None, max(1, n // _ARROWS)) for n in across.shape)
    u, v = space.data["direction_x"].values[step], space.data["direction_y"].values[step]
    axes.quiver(
        across[step], up[step], u, v, color=BLACK, alpha=0.5, pivot="mid", headwidth=0, headlength=0,
        headaxislength=0, scale=2.2 * _ARROWS, width=0.0025,
    )  # fmt: skip


def _axis(space: Workspace, name: str) -> str:
    if name in ("x", "y"):
        return f"{name} [m]"
    return f"joint {verbatim(name)} [{unit_text(space.data[name].attrs['units'])}]"


Array = npt.NDArray[np.float64]

_SIZES = 24
_SPAN = 1.8
"""How much farther than the loop, or the distance asked about, the joules are drawn."""
_FIRST = 0.02
"""The smallest size that is drawn [rad]."""
_ROUND = 200
_TICKS = (0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0)


@rc_context(LOOK)
def null_space_figure(found: NullSpace) -> Figure:
    """The loop in the two joints that move most, and joules per turn over the size of the region.

    Parameters
    ----------
    found
        What `zwidth.null_space` returned.
    """
    figure = new_figure(8.0, 3.9)
    left, right = figure.subplots(1, 2, width_ratios=(4, 5))
    shape = _shape(found)
    _draw_loop(left, found, shape)
    _draw_joules(right, found, shape)
    arm = verbatim(found.question.arm.name)
    spring = shown(found.spring.stiffness, "N*m/rad")
    page_heading(
        figure, f"{arm}: null-space spring of {spring}, {found.outcome}", color=OUTCOME[found.outcome]
    )
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


def _draw_loop(axes: Axes, found: NullSpace, shape: Shape | None) -> None:
    rest = np.asarray(found.spring.rest)
    if shape is None:
        axes.set_axis_off()
        return
    size = found.loop.reach(found.spring.rest) if found.loop is not None else _largest(found)
    swing = np.hypot(shape.cosine, shape.sine)
    first, second = sorted(np.argsort(swing)[-2:].tolist())
    joints = Loop(rest + size * shape.centre, size * shape.cosine, size * shape.sine, _ROUND).joints()
    joints = np.vstack([joints, joints[:1]])
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
    axes.annotate("rest", _pair(rest, first, second), xytext=(4, 4), textcoords="offset points", fontsize=8)
    names = [verbatim(name) for name in _names(found)]
    axes.set_xlabel(f"{names[first]} [rad]")
    axes.set_ylabel(f"{names[second]} [rad]")
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.15)
    axes.locator_params(nbins=5)
    told = "the loop, replayed" if found.loop is not None else "a loop that is first to gain, if larger"
    others = [i for i in np.argsort(-np.abs(shape.centre)) if i not in (first, second)]
    away = [f"{names[i]} {number(round(size * shape.centre[i], 2))}" for i in others[:2]]
    heading(axes, f"{told}; off its rest by {', '.join(away)} rad", size=8.5)


def _pair(joints: Array, first: int, second: int) -> tuple[float, float]:
    return float(joints[first]), float(joints[second])


def _names(found: NullSpace) -> list[str]:
    arm = found.question.arm
    if isinstance(arm, DescribedArm):
        return list(arm.joint_names)
    return [f"q{i + 1}" for i in range(arm.joint_count)]


def _largest(found: NullSpace) -> float:
    """The size up to which something is known or was asked [rad]."""
    reach = 0.0 if found.loop is None else found.loop.reach(found.spring.rest)
    return max(reach, found.within or 0.0, found.covered, 5 * _FIRST)


def _draw_joules(axes: Axes, found: NullSpace, shape: Shape | None) -> None:
    most = _SPAN * _largest(found)
    least = min(_FIRST, most / 10)
    sizes = np.geomspace(least, most, _SIZES)
    axes.set_yscale("log")
    if shape is not None:
        joules = [gain(found.question.arm, found.spring, shape, float(size)) for size in sizes]
        given, lost = np.abs([one[0] for one in joules]), np.array([one[1] for one in joules])
        axes.plot(sizes, given, color=RED, label="the spring gives, slowly round")
        if lost.any():
            axes.plot(sizes, lost, "--", color=BLUE, label="Coulomb friction takes")
    if found.covered:
        axes.axvspan(least, found.covered, color=GREEN, alpha=0.15, lw=0)
        axes.axvline(found.covered, color=GREEN, lw=1.2, label=f"proved up to {found.covered:.3g} rad")
    if found.loop is not None and found.slow is not None:
        reach = found.loop.reach(found.spring.rest)
        axes.axvspan(reach, most, color=ORANGE, alpha=0.15, lw=0)
        axes.plot(
            [reach], [-found.slow.energy], "o", color=BLACK, ms=5,
            label=f"replayed: {shown(-found.slow.energy, 'J')} out at {reach:.3g} rad",
        )  # fmt: skip
    if found.within is not None:
        axes.axvline(found.within, color=GREY, lw=1.0, ls=":", label=f"asked: {found.within:.3g} rad")
    axes.set_xscale("log")
    axes.set_xlim(least, most)
    axes.xaxis.set_major_locator(FixedLocator([tick for tick in _TICKS if least <= tick <= most]))
    axes.xaxis.set_major_formatter(FormatStrFormatter("%g"))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xlabel("distance from the rest [rad]")
    axes.set_ylabel("energy of one turn [J]")
    axes.legend(loc="upper left", fontsize=7.5, frameon=True, framealpha=0.9, edgecolor="none")
    known = (found.covered, found.loop.reach(found.spring.rest) if found.loop is not None else most)
    edges = (least, max(least, known[0]), known[1], most)
    for word, (start, end) in zip(("proved", "not known", "active"), pairwise(edges), strict=True):
        if end > 1.5 * start:
            middle = float(np.sqrt(start * end))
            axes.text(
                middle, 0.02, word, ha="center", fontsize=8, color=GREY, transform=axes.get_xaxis_transform()
            )
    low, high = axes.get_ylim()
    axes.set_ylim(low, high * (high / low) ** 0.45)  # room for the legend


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
    figure = new_figure(5.4, 5.0)
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
    label = f"{name.replace('_', ' ')} [{unit_text(data.attrs['units']) or '1'}]"
    figure.colorbar(colours, ax=axes, label=label, extend="max")
    axes.set_aspect("equal")
    axes.set_xlabel("distance from the first axis [m]")
    axes.set_ylabel("height [m]")
    note(axes, "the least of the postures tried in each cell; between them nothing is proved")
    page_heading(figure, f"{found.question.arm.name}: {found.tried} postures", color=OUTCOME[found.outcome])
    return figure
