"""A sweep in a few lines: how many loops came to what, over which values."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from typing import Any, get_args

import numpy as np
import xarray as xr

from zwidth.passivity.scope import TOLD
from zwidth.passivity.stability.characteristic import Outcome as Rests
from zwidth.quantity.glossary import unit_suffix
from zwidth.quantity.text import from_to, in_words, shown
from zwidth.showing import Lines, Part, Table


def report(found: xr.Dataset) -> Iterator[Part]:
    """The answer, then over what, then what it means."""
    loops = found["refused"].size
    if "outcome" in found:
        heads = ["outcome", "loops", "", *map(str, found.dims)]
        yield Table(heads=[heads], rows=list(_counted(found, found["outcome"], TOLD)), lefts=1)
        for name, of_one in _of_hands(found):
            heads = [f"with {in_words(name)}", *heads[1:]]
            yield Table(heads=[heads], rows=list(_counted(found, of_one, get_args(Rests))), lefts=1)
    else:
        heads = ["", "smallest", "median", "largest"]
        yield Table(heads=[heads], rows=list(_numbers(found)), lefts=1)
    axes = "; ".join(_axis(found[name]) for name in found.dims)
    yield f"{loops} loops: {axes}"
    if "first_refused" in found.attrs:
        refused = int(found["refused"].sum())
        yield f"{refused} of them cannot be; the first: {found.attrs['first_refused']}"
    yield Lines([found.attrs["answers"]], "assumptions")


def _axis(values: xr.DataArray) -> str:
    unit = values.attrs["units"]
    ends = [shown(float(end), unit) for end in (values.min(), values.max())]
    name = in_words(str(values.name))
    return f"{name} {ends[0]}" if values.size == 1 else f"{name} {ends[0]} to {ends[1]}, {values.size} values"


def _of_hands(found: xr.Dataset) -> Iterator[tuple[str, xr.DataArray]]:
    """Of each hand that is known, by its name, whether the loops come to rest."""
    of_one = "stability_"
    return ((str(n).removeprefix(of_one), v) for n, v in found.data_vars.items() if str(n).startswith(of_one))


def _counted(found: xr.Dataset, told: xr.DataArray, words: Iterable[str]) -> Iterator[tuple[str, ...]]:
    """Of each word how many loops, and the range of each parameter that they take up."""
    for word in words:
        where = told.values == word
        count = int(where.sum())
        if count:
            yield word, str(count), f"{count / where.size:.1%}", *_ranges(found, where)


def _ranges(found: xr.Dataset, where: Any) -> Iterator[str]:
    for k, name in enumerate(found.dims):
        others = tuple(j for j in range(where.ndim) if j != k)
        values = found[name].values[where.any(axis=others)]
        unit = found[name].attrs["units"]
        low, high = float(values.min()), float(values.max())
        yield shown(low, unit) if low == high else from_to(low, high, unit)


def _numbers(found: xr.Dataset) -> Iterator[tuple[str, ...]]:
    for name, values in _measured(found):
        unit = values.attrs.get("units", "1")
        known = values.values[~np.isnan(values.values)]
        numbers = (known.min(), np.median(known), known.max()) if known.size else ()
        text = [shown(float(number), unit, 4) for number in numbers] or ["none"] * 3
        yield in_words(name), *text


def _measured(found: xr.Dataset) -> Iterator[tuple[str, xr.DataArray]]:
    return ((str(name), v) for name, v in found.data_vars.items() if v.dtype.kind == "f")


def summary(found: xr.Dataset) -> dict[str, Any]:
    """The same as plain data, units in the keys."""
    axes = {_key(str(name), found[name]): found[name].values.tolist() for name in found.dims}
    told: dict[str, Any] = {
        "format": "zwidth sweep summary 1",
        "of": found.attrs["of"],
        "loops": found["refused"].size,
        "refused": int(found["refused"].sum()),
        "axes": axes,
    }
    if "outcome" in found:
        told["outcomes"] = _how_often(found["outcome"])
    hands = {name: _how_often(of_one) for name, of_one in _of_hands(found)}
    if hands:
        told["stability"] = hands
    told["numbers"] = {_key(name, values): _ends(values) for name, values in _measured(found)}
    if "scope" in found.attrs:
        told["scope"] = json.loads(found.attrs["scope"])
    return {**told, "answers": found.attrs["answers"]}


def _how_often(told: xr.DataArray) -> dict[str, int]:
    words, counts = np.unique(told.values, return_counts=True)
    return {str(w): int(n) for w, n in zip(words, counts, strict=True) if w}


def _ends(values: xr.DataArray) -> dict[str, float | None]:
    """The least and the largest of those that are known; None where none is, or without a bound."""
    known = values.values[np.isfinite(values.values)]
    return {"smallest": float(known.min()), "largest": float(known.max())} if known.size else {}


def _key(name: str, values: xr.DataArray) -> str:
    unit = values.attrs.get("units", "1")
    return name if unit in ("", "1") else f"{name}_{unit_suffix(unit)}"
