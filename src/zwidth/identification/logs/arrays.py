"""A log from arrays, or from an xarray.Dataset such as a trace of `zwidth.simulate`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth.errors import InputError
from zwidth.identification.logs.build import log_from, stated_period
from zwidth.identification.logs.log import Log, Motion
from zwidth.identification.logs.names import recognise
from zwidth.identification.logs.scales import meaning_of
from zwidth.identification.logs.table import Table, Values

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import ArrayLike


def log_of(
    data: xr.Dataset | None = None,
    /,
    *,
    time: ArrayLike | None = None,
    position: ArrayLike | None = None,
    hand_force: ArrayLike | None = None,
    actuator_force: ArrayLike | None = None,
    columns: Mapping[str, str | None] | None = None,
    units: Mapping[str, str] | None = None,
    scale: Mapping[str, object] | None = None,
    sample_rate: object = None,
    sample_period: object = None,
    resolution: object = None,
    counts_per_turn: object = None,
    motion: Motion | None = None,
) -> Log:
    """A log from arrays in SI units, or from the variables of a Dataset with their units.

    Parameters
    ----------
    data
        A Dataset whose variables have the attribute `units`, such as a trace; instead of the arrays.
    time
        [s] stamp of each sample; or leave it out and state the rate.
    position
        [m; rad] positive into the wall.
    hand_force
        [N; N·m] of the hand on the device, positive into the wall.
    actuator_force
        [N; N·m] of the actuator, positive out of the wall.
    columns, units, scale, sample_rate, sample_period, resolution, counts_per_turn
        As for `zwidth.read_log`.
    motion
        "linear", where nothing else is said, or "rotary".

    Raises
    ------
    InputError
        If the arrays are of different lengths, or nothing can be learnt from them.
    """
    given = {"time": time, "position": position, "hand_force": hand_force, "actuator_force": actuator_force}
    arrays = {name: values for name, values in given.items() if values is not None}
    period = stated_period(sample_rate, sample_period)
    if data is None:
        if columns is not None or units is not None:
            raise InputError(
                "columns and units are for a Dataset; arrays are in SI units, scale={…} changes them"
            )
        if motion is None:
            motion = "rotary" if counts_per_turn is not None else "linear"
        table = _table({name: _vector(name, values) for name, values in arrays.items()}, _si(motion), {})
        names = {name: name for name in arrays}
    else:
        if arrays:
            raise InputError("give a Dataset or arrays, not both")
        table = _of_dataset(data)
        names = recognise(table.units, columns, table.source)
    if "position" not in names:
        raise InputError("a log needs positions; give position=…")
    meaning = meaning_of(
        table,
        names,
        units=units,
        scale=scale,
        resolution=resolution if resolution is not None else stated_resolution(table),
        counts_per_turn=counts_per_turn,
        motion=motion,
    )
    return log_from(table, meaning, period)


def stated_resolution(table: Table) -> object:
    """The resolution that a trace of ours says it has, or None."""
    values = (table.attributes.get(key) for key in ("resolution_m", "resolution_rad"))
    return next((float(v) for v in values if v is not None), None)


def _si(motion: str) -> dict[str, str]:
    length, force = ("rad", "N*m") if motion == "rotary" else ("m", "N")
    return {"time": "s", "position": length, "hand_force": force, "actuator_force": force}


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
