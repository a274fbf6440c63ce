"""Sweeps in files: a zarr store, or a table of Parquet with a row for each loop.

Parquet holds the unit in the name of each column, `stiffness_N_per_m`, and all that is said of the sweep as
JSON in the metadata of its schema.  Until it is whole the sweep is in a zarr store beside it.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Mapping
from io import BytesIO
from math import prod
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from zwidth import installing
from zwidth.errors import InputError
from zwidth.installing import parquet
from zwidth.missing import did_you_mean
from zwidth.model.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.passivity.scope import scope_of
from zwidth.quantity.exact import Interval
from zwidth.quantity.glossary import unit_suffix
from zwidth.quantity.text import to_json
from zwidth.reading import check_parquet, shown_only
from zwidth.study.chunks.layout import Layers
from zwidth.study.sweeps.axes import REFUSED, Column
from zwidth.study.sweeps.loops import with_numbers
from zwidth.study.sweeps.questions import HANDS
from zwidth.study.sweeps.request import FORMAT, Request
from zwidth.writing import first_line, writing_whole

ZARR, PARQUET = ".zarr", ".parquet"


def load_sweep(path: str | PathLike[str]) -> xr.Dataset:
    """The sweep in a file that `sweep` wrote, equal to the one that it gave back.

    Parameters
    ----------
    path
        Ends in .zarr or .parquet.

    Raises
    ------
    InputError
        If there is no such file, or it holds no whole sweep.
    """
    source = Path(path)
    readers = {ZARR: _read_zarr, PARQUET: _read_parquet}
    if source.suffix not in readers:
        raise InputError(f"a sweep is a file that ends in {ZARR} or {PARQUET}, got {str(path)!r}")
    if not source.exists():
        raise InputError(f"{source} cannot be read: there is no such file{did_you_mean(source)}")
    try:
        found = shown_only(readers[source.suffix](source)[0], source)
    except InputError:
        raise
    except Exception as error:  # what the libraries raise on foreign bytes is not documented
        raise InputError(f"{source} holds no sweep that can be read: {first_line(error)}") from None
    return found


def begun(path: Path) -> Path:
    """The store in which a table is until it is whole."""
    return path.with_name(f"{path.name}.begun")


def saved_table(path: Path, asked: Request) -> xr.Dataset:
    """The sweep of a table that is whole."""
    try:
        found, digest = _read_parquet(path)
    except Exception:  # whatever it is, it is not this sweep
        digest = ""
    if digest != asked.layout.digest:
        raise InputError(f"{path} exists and holds another sweep, or none; choose another name or remove it")
    return found


def save_table(path: Path, asked: Request, found: xr.Dataset) -> None:
    """Write the table whole, and then remove the store in which it was begun."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    grids = np.meshgrid(*(found[name].values for name in found.dims), indexing="ij", copy=False)
    columns: dict[str, Any] = {
        _column(str(name), found[name]): grid.ravel() for name, grid in zip(found.dims, grids, strict=True)
    }
    for name, values in found.data_vars.items():
        flat = values.values.ravel()
        words = flat.dtype.kind == "U"
        columns[_column(str(name), values)] = pa.array(flat).dictionary_encode() if words else pa.array(flat)
    told = {
        "digest": asked.layout.digest,
        "attributes": found.attrs,
        "axes": {str(name): [str(v) for v in found[name].values.tolist()] for name in found.dims},
        "variables": {str(name): dict(found[name].attrs) for name in found.variables},
    }
    table = pa.table(columns).replace_schema_metadata({"zwidth": json.dumps(told)})
    whole = BytesIO()
    pq.write_table(table, whole)
    with writing_whole(path) as file:
        file.write(whole.getbuffer())
    shutil.rmtree(begun(path), ignore_errors=True)


def _column(name: str, values: xr.DataArray) -> str:
    """The name of a column: with its unit, if it has one."""
    unit = values.attrs.get("units", "")
    return name if unit in ("", "1") else f"{name}_{unit_suffix(unit)}"


def _read_parquet(path: Path) -> tuple[xr.Dataset, str]:
    check_parquet(path)
    table = parquet(f"{path} is not read").read_table(path)
    told = json.loads((table.schema.metadata or {}).get(b"zwidth", b"{}"))
    _refuse_foreign(path, told.get("attributes", {}).get("format"))
    axes = {name: np.array([float(value) for value in values]) for name, values in told["axes"].items()}
    shape = tuple(map(len, axes.values()))
    if prod(shape) != table.num_rows:
        raise InputError(f"{path} is not whole: {table.num_rows} rows for {prod(shape)} loops")
    variables = {}
    for name, about in told["variables"].items():
        if name not in axes:
            column = table[_column(name, xr.DataArray(attrs=about))]
            values = np.array(column.to_pylist()) if "units" not in about else column.to_numpy()
            variables[name] = (tuple(axes), values.reshape(shape), about)
    coordinates = {name: (name, values, told["variables"][name]) for name, values in axes.items()}
    return xr.Dataset(variables, coordinates, told["attributes"]), told["digest"]


def _read_zarr(path: Path) -> tuple[xr.Dataset, str]:
    group = installing.imported("zarr", f"zarr, which reads {path},", "maps").open_group(path, mode="r")
    _refuse_foreign(path, group.attrs.get("format"))
    told = group.attrs.get("told")
    if told is None:
        raise InputError(f"{path} is not whole: the command that began it goes on with it")
    coordinates: dict[str, Any] = {}
    variables: dict[str, Any] = {}
    dims = tuple(group.attrs["request"]["axes"])
    for name in dims:
        coordinates[name] = (name, np.asarray(group[name]), dict(group[name].attrs))
    for name, own in told["columns"].items():
        kept = np.asarray(group[name])
        variables[name] = (dims, *_shown(kept, own))
    return xr.Dataset(variables, coordinates, told["attributes"]), str(group.attrs.get("digest"))


def _shown(kept: Any, own: Mapping[str, Any]) -> tuple[Any, dict[str, Any]]:
    column = Column(own["meaning"], own["unit"], tuple(own["words"]), own["several"])
    return column.shown(kept), column.told()


def _refuse_foreign(path: Path, kind: object) -> None:
    if kind != FORMAT:
        raise InputError(f"{path} holds no sweep of this version")


_OF_EACH = ("contact", "encoder", "fed_with", "law", "damping", "coulomb_friction", "clamped")
"""Entries of a scope that may be another at every loop: they are variables, or the loop's own numbers."""


def dataset(asked: Request, layers: Layers) -> xr.Dataset:
    """The sweep with words in the place of numbers."""
    dims = tuple(own.name for own in asked.axes)
    coordinates = {own.name: (own.name, own.array, {"units": own.unit}) for own in asked.axes}
    variables: dict[str, Any] = {}
    for name, own in asked.columns.items():
        variables[name] = (dims, own.shown(layers[name]), own.told())
    return xr.Dataset(variables, coordinates, attributes(asked, layers))


def attributes(asked: Request, layers: Layers) -> dict[str, str]:
    """What is the same of every loop, and what an answer means."""
    loop = asked.loop
    told = {
        "format": FORMAT,
        "of": asked.of,
        "motion": loop.motion,
        "loop": _in_words(asked),
        "answers": _MEANING[asked.of] + (OF_HANDS if HANDS in loop.options else ""),
    }
    if asked.of in ("check", "limit"):
        assert isinstance(loop.subject, Device)
        assert loop.environment is not None
        common = scope_of(loop.subject.motor_side, loop.environment).to_dict()
        of_each = (*_OF_EACH, *asked.columns)  # of which transmission an answer is, has a column of its own
        told["scope"] = to_json({k: v for k, v in common.items() if not k.startswith(of_each)}, indent=None)
    refused = layers[REFUSED]
    if refused.any():
        told["first_refused"] = _why(asked, tuple(int(n[0]) for n in refused.nonzero()))
    return told


def _in_words(asked: Request) -> str:
    loop = asked.loop
    if not isinstance(loop.subject, Device):
        return loop.subject.describe()
    law = "" if loop.environment is None else f"; {_ranges(asked).describe(loop.motion)}"
    hand = "" if loop.operator is None else f"; {loop.operator.describe(loop.motion)}"
    return f"{loop.subject.name}{law}{hand}"


def _ranges(asked: Request) -> Environment:
    """The environment with the ranges of its numbers, where it can have intervals."""
    law = asked.loop.environment
    assert law is not None
    varied = {
        own.key: Interval(min(axis.values), max(axis.values))
        for own, axis in zip(asked.parameters, asked.axes, strict=True)
        if own.part == "law" and "." not in own.key
    }
    try:
        return law.around(with_numbers(law.met, varied))
    except InputError:
        return law


def _why(asked: Request, place: tuple[int, ...]) -> str:
    values = ", ".join(own.told(own.values[n]) for own, n in zip(asked.axes, place, strict=True))
    try:
        asked.question.answer(asked.at(place), {})
    except InputError as error:
        return f"{values}: {error}"
    return values


_MEANING = {
    "check": "what zwidth check says of each loop by closed forms, of every hand, for the contact and the "
    "encoder beside it; what is undecided, or passive in contact alone, zwidth check may decide by value "
    "iteration. No proof and no motion is kept: zwidth check -o writes that of a loop, checked",
    "limit": "what zwidth limit finds by closed forms, of every hand; NaN where they find nothing",
    "simulate": "measures of one simulated touch: what this hand did, and nothing about another",
    "pair": "what zwidth pair says of each pair: two hands, one on each arm. zwidth pair -o writes the "
    "evidence of a pair",
}
"""What is claimed, by the question."""

OF_HANDS = (
    ". Stability is of each hand alone, as long as it keeps contact, dry friction and encoder steps left "
    "out: what zwidth check --hands says"
)
