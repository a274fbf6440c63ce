"""A sweep: over one parameter a curve, over two a map, over three a map for some values of the third."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from zwidth.errors import InputError
from zwidth.passivity.scope import TOLD
from zwidth.quantity.text import in_words, shown, unit_text
from zwidth.show.plots.files import save_figure
from zwidth.show.plots.style import BLUE, LOOK, heading, new_figure, scale

_PANELS = 4
"""Maps beside each other: more are too small to read."""


_DRAWN = ("max_stiffness", "proved_passive", "energy_extracted")
"""Of numbers the one that is drawn: the first that there is."""


def save_sweep(found: xr.Dataset, path: str | Path, overwrite: bool = False) -> None:
    """Write `sweep_figure` to a file; its ending, png, svg or pdf, says how.

    Parameters
    ----------
    found
        What `zwidth.sweep` returned.
    path
        The file to write.
    overwrite
        Replace a file that is already there.

    Raises
    ------
    InputError
        If the ending is another one, the file exists or cannot be written, or `found` is no sweep.
    """
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
        figure = new_figure(6.4, 4.0)
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
    figure = new_figure(3.6 * len(places) + 2.4, 4.2)
    axes = figure.subplots(1, len(places), sharey=True, squeeze=False)[0]
    for one, place in zip(axes, places, strict=True):
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
        figure.legend(handles=_patches(found), loc="outside right upper", frameon=False)
    else:
        bar = figure.colorbar(drawn, ax=list(axes))
        bar.set_label(_label(found[name], unit_text(found[name].attrs.get("units", ""))))
    return figure


def _map(axes: Axes, part: xr.Dataset, name: str) -> Any:
    """One variable over two parameters, the second along x."""
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
    colours = ListedColormap(["#ffffff", *(TOLD[word].colour for word in known)])
    norm = BoundaryNorm(np.arange(len(known) + 2) - 0.5, colours.N)
    return axes.pcolormesh(x, y, places, cmap=colours, norm=norm, shading="nearest", alpha=0.85)


def _patches(found: xr.Dataset) -> list[Patch]:
    there = set(np.unique(found["outcome"].values).tolist())
    return [Patch(facecolor=told.colour, label=word) for word, told in TOLD.items() if word in there]


def _curve(axes: Axes, found: xr.Dataset, name: str) -> None:
    dim = str(next(iter(found.dims)))
    along = _scaled(found[dim])
    x, values = along.values, found[name].values
    if values.dtype.kind == "U":
        axes.plot(x, values, "o", color=BLUE)
    else:
        axes.plot(x, np.where(np.isfinite(values), values, np.nan), "-o", ms=3, color=BLUE)
    if "outcome" in found and values.dtype.kind != "U":
        _mark(axes, x, found["outcome"].values)
    if _is_log(x):
        axes.set_xscale("log")
    axes.set_xlabel(along.label)
    axes.set_ylabel(_label(found[name], unit_text(found[name].attrs.get("units", ""))))
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
    axes.legend(frameon=False)


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
    name = in_words(str(values.name)).replace("max stiffness", "largest passive stiffness")
    return name if unit in ("", "1") else f"{name} [{unit}]"
