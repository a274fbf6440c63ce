"""The table of arrays in SI units, or of an xarray.Dataset such as a trace of `zwidth.simulate`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth.data.logs.names import recognise
from zwidth.data.logs.table import Table, Values
from zwidth.errors import InputError
from zwidth.quantity.glossary import GLOSSARY

if TYPE_CHECKING:
    import xarray as xr


def table_of(
    data: xr.Dataset | None,
    arrays: Mapping[str, Any],
    columns: Mapping[str, str | None] | None,
    units: Mapping[str, str] | None,
    motion: str,
) -> tuple[Table, dict[str, str]]:
    """The table of a Dataset, or of the arrays of each quantity; and the column of each quantity."""
    if data is not None:
        if arrays:
            raise InputError("give a Dataset or arrays, not both")
        table = _of_dataset(data)
        return table, recognise(table.units, columns, table.source)
    if columns is not None or units is not None:
        raise InputError(
            "columns and units are for a Dataset; arrays are in SI units, scale={…} changes them"
        )
    if "position" not in arrays:
        raise InputError("a log needs positions; give position=…")
    length, force = (GLOSSARY[name].unit_for(motion) for name in ("position", "force"))
    si = {"time": "s", "position": length, "hand_force": force, "actuator_force": force}
    return _table({name: _vector(name, values) for name, values in arrays.items()}, si, {}), {
        name: name for name in arrays
    }


def _vector(name: str, values: Any) -> Values:
    array = np.asarray(values)
    if array.ndim != 1 or array.dtype.kind not in "fiuM":
        raise InputError(
            f"{name} is a list of numbers, got an array of {array.ndim} dimensions of {array.dtype}"
        )
    return array


def _table(
    arrays: dict[str, Values], units: Mapping[str, str | None], attributes: Mapping[str, Any]
) -> Table:
    sizes = {name: values.size for name, values in arrays.items()}
    if len(set(sizes.values())) > 1:
        said = ", ".join(f"{name} {size}" for name, size in sizes.items())
        raise InputError(f"every column needs as many samples, got {said}")

    def read(names: tuple[str, ...]) -> Iterator[tuple[Values, ...]]:
        yield tuple(arrays[name] for name in names)

    stated = {name: units.get(name) for name in arrays}
    return Table(source="arrays", units=stated, read=read, attributes=attributes)


def _of_dataset(data: xr.Dataset) -> Table:
    dimension = next(iter(data.dims), None)
    variables = {
        str(name): variable
        for name, variable in data.variables.items()
        if variable.dims == (dimension,) and variable.dtype.kind in "fiubM"
    }
    if not variables:
        raise InputError("the Dataset has no variable of numbers along one dimension")
    units = {n: "ns" if v.dtype.kind == "M" else v.attrs.get("units") for n, v in variables.items()}
    arrays = {name: np.asarray(variable.values) for name, variable in variables.items()}
    return _table(arrays, units, dict(data.attrs))
