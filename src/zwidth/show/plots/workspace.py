"""The map of an arm's workspace: the margin, where it ends, and in which direction it is smallest."""

from __future__ import annotations

from textwrap import shorten
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.colors import TwoSlopeNorm
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator, ScalarFormatter

from zwidth.errors import InputError
from zwidth.model.arms.encoders import in_words
from zwidth.passivity.workspace import Workspace
from zwidth.quantity.text import unit_text
from zwidth.show.plots.style import BLACK, GREY, LOOK, OUTCOME, RED, new_figure, note, page_heading, verbatim

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
