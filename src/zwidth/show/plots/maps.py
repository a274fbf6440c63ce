"""The plane of walls: what is passive, what is quiet, what is stable in which hand.

Regions are those of the map; the boundary of each is drawn and named, so that no meaning hangs on a colour.
"""

from __future__ import annotations

from math import log10
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import xarray as xr
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap, to_hex, to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from zwidth.errors import InputError
from zwidth.passivity.scope import TOLD
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.spoken import spoken, spoken_data
from zwidth.quantity.text import in_words, shown, unit_text
from zwidth.show.plots.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    LOOK,
    ORANGE,
    PURPLE,
    RED,
    SKY,
    SMALL,
    heading,
    label,
    legend,
    legend_of_all,
    new_figure,
    note,
    number,
    save_figure,
    scale,
    symbol,
    verbatim,
    with_unit,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

_SPEEDS = (0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500)
"""Whose contours are drawn, those beyond 10 m/s or 10 rad/s only in degrees."""

_SEEN = 10
"""Cells along each axis that a region needs for a close-up: fewer would show the cells and not the region."""

_APART = 3
"""Cells between a contour of the speed and what is passive, along K and along B: with fewer it breaks up."""

_HAND_COLOURS = (BLUE, RED, PURPLE, ORANGE, BLACK)
_LINES = ("-", "--", "-.", ":", (0, (1, 3)))


def save_z_width(found: xr.Dataset, path: str | Path, overwrite: bool = False) -> None:
    """Write `z_width_figure` to a file; its ending, png, svg or pdf, says how.

    Parameters
    ----------
    found
        What `zwidth.z_width` returned.
    path
        The file to write.
    overwrite
        Replace a file that is already there.

    Raises
    ------
    InputError
        If the ending is another one, the file exists or cannot be written, or `found` is no map.
    """
    save_figure(lambda: z_width_figure(found), path, overwrite)


@rc_context(LOOK)
def z_width_figure(found: xr.Dataset) -> Figure:
    """The map on axes B and K, beside a close-up of what is passive and quiet where that is small.

    Parameters
    ----------
    found
        What `zwidth.z_width` returned.

    Raises
    ------
    InputError
        If it is no map.
    """
    if "passive" not in found or "admissible_speed" not in found:
        raise InputError("this is no Z-width map: z_width makes one")
    found = _told(found)
    near = _corner(found)
    figure = new_figure(height=4.8)
    axes = figure.subplots(1, 2 if near is not None else 1, squeeze=False)[0]
    _draw(axes[0], found)
    hands = any(str(name).startswith("stable_") for name in found.data_vars)
    title = "stable with a known hand" if hands else "passive walls"
    heading(axes[0], f"{found.attrs['device']}: {title}", parse_math=False)
    note(axes[0], _free(found))
    if near is not None:
        _draw(axes[1], near)
        drawn = _speeds(axes[1], near)
        heading(
            axes[1],
            "close-up: how fast a hand may be before it gains energy"
            if drawn
            else "close-up of what is passive",
        )
    legend_of_all(figure, figure.axes[0].get_legend_handles_labels()[0])
    return figure


def draw_z_width(axes: Axes, found: xr.Dataset) -> None:
    """The same on given axes, the whole map and no close-up."""
    _draw(axes, _told(found))
    legend(axes)


def _draw(axes: Axes, found: xr.Dataset) -> None:
    motion = found.attrs["motion"]
    b, k = (_edges(found[name].values) for name in ("virtual_damping", "stiffness"))
    apart = found.attrs.get("transmission", "rigid") != "rigid"
    speed = f"{number(found['quiet'].attrs['speed'])} {unit_text(found['admissible_speed'].attrs['units'])}"
    for name, colour, alpha, text in (
        *_sustained(found),
        *([] if apart else [("quiet", SKY, 0.35, f"no hand up to {speed} gains")]),
        ("passive", GREEN, 0.55, "passive with every hand" + (", any transmission" if apart else "")),
    ):
        shown = np.ma.masked_equal(found[name].values.astype(np.uint8), 0)
        if shown.count():
            axes.imshow(
                shown, cmap=ListedColormap([colour]), alpha=alpha, extent=(b[0], b[-1], k[0], k[-1]),
                origin="lower", aspect="auto", interpolation="nearest",
            )  # fmt: skip
            axes.fill_between([], [], color=colour, alpha=alpha, lw=0, label=text)
    if found.attrs.get("not_covered") and not found["passive"].values.any():
        axes.plot([], [], ls="none", label="passive with every hand: not covered")
    hands = [str(name).removeprefix("stable_") for name in found.data_vars if str(name).startswith("stable_")]
    for place, name in enumerate(hands):
        _outline(axes, found, name, place)
    axes.set_xlim(b[0], b[-1])
    axes.set_ylim(k[0], k[-1])
    axes.set_xlabel(label("virtual_damping", motion))
    axes.set_ylabel(label("stiffness", motion))


def _told(found: xr.Dataset) -> xr.Dataset:
    """Angles in the unit that was typed; told once, it is as it is."""
    told = spoken_data(found)
    before, after = (each["admissible_speed"].attrs["units"] for each in (found, told))
    if before != after:
        told["quiet"].attrs = {
            **found["quiet"].attrs,
            "speed": spoken(before)[0] * found["quiet"].attrs["speed"],
        }
    return told


def _sustained(found: xr.Dataset) -> tuple[tuple[str, str, float, str], ...]:
    """What is passive as long as contact lasts, where that is more than what is passive anyway."""
    if not (found["passive_sustained"] & ~found["passive"]).values.any():
        return ()
    this = ", with this transmission" if found.attrs.get("transmission") == "as given" else ""
    return (("passive_sustained", GREEN, 0.25, f"passive while contact lasts{this}"),)


def _edges(middles: Array) -> Array:
    half = (middles[1] - middles[0]) / 2 if len(middles) > 1 else 0.5
    return np.append(middles - half, middles[-1] + half)


def _outline(axes: Axes, found: xr.Dataset, name: str, place: int) -> None:
    """The stiffest walls that are stable in one hand."""
    values = found[f"stable_{name}"].values
    text = "no hand" if name == "none" else verbatim(name)
    colour, style = _HAND_COLOURS[place % 5], _LINES[place % 5]
    if values.all() or not values.any():
        everywhere = "everywhere" if values.any() else "nowhere"
        axes.plot([], [], color=GREY, ls=style, label=f"{text}: stable {everywhere} here")
        return
    axes.plot(
        found["virtual_damping"], found[f"limit_{name}"], color=colour, ls=style, lw=1.6,
        label=f"{text}: stable below",
    )  # fmt: skip


def _speeds(axes: Axes, found: xr.Dataset) -> bool:
    """Contours of the admissible speed, each with its value; False where there is none to draw."""
    values = found["admissible_speed"].values
    shown = np.log10(np.where(np.isfinite(values) & (values > 0), values, np.nan))
    fastest = 10.0 if found["admissible_speed"].attrs["units"] in ("m/s", "rad/s") else _SPEEDS[-1]
    inside = [
        level
        for level in (speed for speed in _SPEEDS if speed <= fastest)
        if np.nanmin(shown, initial=9) < log10(level)
        and min((shown > log10(level)).sum(axis=along).max() for along in (0, 1)) >= _APART
    ]
    if not inside or min(shown.shape) < 2:
        return False
    drawn = axes.contour(
        found["virtual_damping"], found["stiffness"], shown, levels=[log10(level) for level in inside],
        colors=[GREY], linewidths=0.7, linestyles="-",
    )  # fmt: skip
    unit = unit_text(found["admissible_speed"].attrs["units"])
    axes.clabel(drawn, fontsize=SMALL, fmt=lambda level: f"{number(10**level)} {unit}")
    return True


def _corner(found: xr.Dataset) -> xr.Dataset | None:
    """The part with passive and quiet walls, if it is a small part of the map and has cells enough to see."""
    held = (found["passive"] | found["passive_sustained"] | found["quiet"]).values
    if not held.any():
        return None
    rows, columns = (int(np.flatnonzero(held.any(axis=along))[-1]) for along in (1, 0))
    if 2 * rows > held.shape[0] and 2 * columns > held.shape[1]:
        return None
    if min(rows, columns) < _SEEN:
        return None
    return found.isel(
        stiffness=slice(0, max(4, int(rows * 1.25) + 2)),
        virtual_damping=slice(0, max(4, int(columns * 1.25) + 2)),
    )


def _free(found: xr.Dataset) -> str:
    parts = [
        f"{number(float(found[name]))} {unit_text(found[name].attrs['units'])}"
        for name in ("free_mass", "free_damping", "free_friction")
        if found[name].notnull()  # the mass of a handle may be unknown
    ]
    return f"Felt in free air: {', '.join(parts)}."


_PANELS = 4
"""Maps beside each other: more are too small to read."""


_DRAWN = ("max_stiffness", "proved_passive", "energy_extracted")
"""Of numbers the one that is drawn: the first that there is."""


def save_sweep(found: xr.Dataset, path: str | Path, overwrite: bool = False) -> None:
    """Write `sweep_figure` of what `zwidth.sweep` returned, as `save_z_width` writes a map."""
    save_figure(lambda: sweep_figure(found), path, overwrite)


@rc_context(LOOK)
def sweep_figure(found: xr.Dataset, variable: str | None = None) -> Figure:
    """The outcomes of a sweep, or one of its numbers, over its first two parameters.

    Parameters
    ----------
    found
        What `zwidth.sweep` returned: of up to three parameters that take more than one value.
    variable
        What to draw. Default over two parameters: the outcomes, where there are any; else the largest
        stiffness, the limit, or the energy got out.

    Raises
    ------
    InputError
        If it is no sweep, has no such variable, or more parameters: choose values of some, found.isel(…).
    """
    if "refused" not in found or "answers" not in found.attrs:
        raise InputError("this is no sweep: zwidth.sweep makes one")
    found = found.squeeze()
    if not 1 <= len(found.dims) <= 3:
        raise InputError(
            f"a picture is of one to three parameters, and this sweep varies {len(found.dims)}: choose "
            "values of some, such as found.isel(delay=0)"
        )
    name = variable or _drawn(found)
    if name not in found.data_vars:
        raise InputError(f"there is no {name} in this sweep; it has {', '.join(map(str, found.data_vars))}")
    if len(found.dims) == 1:
        figure = new_figure()
        _curve(figure.add_subplot(), found, name)
        return figure
    return _maps(found, name)


def _drawn(found: xr.Dataset) -> str:
    if "outcome" in found and len(found.dims) > 1:
        return "outcome"
    return next((name for name in _DRAWN if name in found), str(next(iter(found.data_vars))))


def _maps(found: xr.Dataset, name: str) -> Figure:
    across = list(found.dims)[2:]
    places = np.unique(np.linspace(0, found.sizes[across[0]] - 1, _PANELS).astype(int)) if across else [None]
    rows, columns = (len(places) + 1) // 2, min(len(places), 2)
    figure = new_figure(height=0.8 + 3.4 * rows)
    axes = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False).ravel()
    for spare in axes[len(places) :]:
        spare.remove()
    axes = axes[: len(places)]
    for one, place in zip(axes, places, strict=True):
        one.tick_params(labelbottom=True)
        part = found if place is None else found.isel({across[0]: int(place)})
        drawn = _map(one, part, name)
        if place is not None:
            at = part[across[0]]
            heading(
                one, f"{in_words(str(across[0]))} {shown(float(at), at.attrs['units'], 4)}", parse_math=False
            )
        else:
            heading(one, str(found.attrs["loop"]), parse_math=False)
    if name == "outcome":
        there = set(np.unique(found["outcome"].values).tolist())
        legend_of_all(figure, [Patch(facecolor=_shade(word), label=word) for word in TOLD if word in there])
    else:
        bar = figure.colorbar(drawn, ax=list(axes))
        bar.set_label(_label(found[name], found[name].attrs.get("units", "")))
    return figure


def _map(axes: Axes, part: xr.Dataset, name: str) -> Any:
    along_y, along_x = (str(dim) for dim in part.dims)
    values = part[name].transpose(along_y, along_x).values
    x, y = _scaled(part[along_x]), _scaled(part[along_y])
    draw = _outcomes if values.dtype.kind == "U" else _numbers
    drawn = draw(axes, x.values, y.values, values)
    axes.set_xscale("log" if _is_log(x.values) else "linear")
    axes.set_yscale("log" if _is_log(y.values) else "linear")
    axes.set_xlabel(x.label)
    axes.set_ylabel(y.label)
    return drawn


def _numbers(axes: Axes, x: Any, y: Any, values: Any) -> Any:
    return axes.pcolormesh(x, y, np.where(np.isfinite(values), values, np.nan), shading="nearest")


def _outcomes(axes: Axes, x: Any, y: Any, words: Any) -> Any:
    known = list(TOLD)
    places = np.zeros(words.shape)
    for place, word in enumerate(known, start=1):
        places[words == word] = place
    colours = ListedColormap(["#ffffff", *map(_shade, known)])
    norm = BoundaryNorm(np.arange(len(known) + 2) - 0.5, colours.N)
    return axes.pcolormesh(x, y, places, cmap=colours, norm=norm, shading="nearest")


def _shade(outcome: str) -> str:
    """Its colour; what is passive in a light one, so that it differs in grey too."""
    strong = {"passive": 0.45, "active": 1.0}.get(outcome, 0.7)
    red, green, blue = (1 - strong * (1 - part) for part in to_rgb(TOLD[outcome].colour))
    return to_hex((red, green, blue))


def _curve(axes: Axes, found: xr.Dataset, name: str) -> None:
    dim = str(next(iter(found.dims)))
    along = _scaled(found[dim])
    x, values = along.values, found[name].values
    if values.dtype.kind == "U":
        axes.plot(x, values, "o", color=BLUE)
    else:
        axes.plot(
            x,
            np.where(np.isfinite(values), values, np.nan),
            "-o",
            ms=3,
            color=BLUE,
            label=_label(found[name], ""),
        )
    if "outcome" in found and values.dtype.kind != "U":
        _mark(axes, x, found["outcome"].values)
    if _is_log(x):
        axes.set_xscale("log")
    axes.set_xlabel(along.label)
    axes.set_ylabel(_label(found[name], found[name].attrs.get("units", "")))
    legend(axes)
    heading(axes, str(found.attrs["loop"]), parse_math=False)


def _mark(axes: Axes, x: Any, words: Any) -> None:
    """The outcome of each loop as a mark at the foot of the picture."""
    marks = {"passive": "o", "active": "x", "undecided": "s"}
    for word, told in TOLD.items():
        where = words == word
        if where.any():
            foot = np.full(int(where.sum()), 0.02)
            axes.plot(
                x[where], foot, marks.get(word, "d"), ms=4, color=told.colour, label=word,
                transform=axes.get_xaxis_transform(), clip_on=False,
            )  # fmt: skip


def _is_log(values: Any) -> bool:
    """Whether the steps grow so much that equal ratios show them better."""
    steps = np.diff(values)
    return bool(values.size > 2 and values.min() > 0 and (steps > 0).all() and steps[-1] > 5 * steps[0])


class _Scaled(NamedTuple):
    """Values as an axis shows them, and what is written beside it."""

    values: Any
    label: str


def _scaled(values: xr.DataArray) -> _Scaled:
    factor, unit = scale(values.values.tolist(), values.attrs["units"])
    return _Scaled(values.values * factor, _label(values, unit))


def _label(values: xr.DataArray, unit: str) -> str:
    key = str(values.name)
    name = "largest passive stiffness" if key == "max_stiffness" else in_words(key)
    name += f" {symbol(key)}" if key in GLOSSARY else ""
    return name if unit in ("", "1") else with_unit(name, unit)
