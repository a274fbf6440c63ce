"""The plane of walls: what is passive, what is quiet, what is stable in which hand.

Regions are those of the map; the boundary of each is drawn and named, so that no meaning
hangs on a colour.
"""

from __future__ import annotations

from math import log10
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from zwidth.errors import InputError
from zwidth.quantity.spoken import spoken, spoken_data
from zwidth.quantity.text import unit_text
from zwidth.show.plots.files import save_figure
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
    heading,
    label,
    new_figure,
    note,
    number,
    verbatim,
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
    figure = new_figure(12.4 if near is not None else 8.0, 4.6)
    axes = figure.subplots(1, 2 if near is not None else 1, squeeze=False)[0]
    draw_z_width(axes[0], found)
    heading(axes[0], f"{found.attrs['device']}: stable with a known hand", parse_math=False)
    note(axes[0], _free(found))
    if near is not None:
        draw_z_width(axes[1], near)
        drawn = _speeds(axes[1], near)
        heading(
            axes[1],
            "close-up: how fast a hand may be before it gains energy"
            if drawn
            else "close-up of what is passive",
        )
    _legend_beside(figure)
    return figure


def _legend_beside(figure: Figure) -> None:
    """The legend of the whole map to the right of the picture, where no curve runs, for the close-up too."""
    handles, words = figure.axes[0].get_legend_handles_labels()
    for axes in figure.axes:
        legend = axes.get_legend()
        if legend is not None:
            legend.remove()
    figure.legend(handles, words, loc="outside right upper")


def draw_z_width(axes: Axes, found: xr.Dataset) -> None:
    """The same on given axes, the whole map and no close-up.

    Parameters
    ----------
    axes
        Where to draw.
    found
        What `zwidth.z_width` returned.
    """
    found = _told(found)
    motion = found.attrs["motion"]
    b, k = (_edges(found[name].values) for name in ("virtual_damping", "stiffness"))
    speed = f"{number(found['quiet'].attrs['speed'])} {unit_text(found['admissible_speed'].attrs['units'])}"
    for name, colour, alpha, text in (
        *_sustained(found),
        ("quiet", SKY, 0.35, f"no hand up to {speed} gains"),
        ("passive", GREEN, 0.55, "passive with every hand"),
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
    axes.legend(loc="upper right", frameon=True, framealpha=0.85, edgecolor="none")


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
    return (("passive_sustained", GREEN, 0.25, "passive while contact lasts"),)


def _edges(middles: Array) -> Array:
    """The edges of equal cells from their middles."""
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
    axes.clabel(drawn, fontsize=7.5, fmt=lambda level: f"{number(10**level)} {unit}")
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
    ]
    return f"Felt in free air: {', '.join(parts)}."
