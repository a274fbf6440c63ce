"""Traces in files, and back: NetCDF, Parquet, CSV, the same numbers to the last bit; and as sound.

NetCDF keeps units and names as attributes.  Parquet and CSV carry the unit in
the name of each column, `position_m`, and the attributes of the trace as JSON:
Parquet in the metadata of its schema, CSV in its first line after a `#`.
"""

from __future__ import annotations

import json
import re
import wave
from collections.abc import Callable
from io import BytesIO
from numbers import Real
from os import PathLike
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import numpy as np

from zwidth.errors import InputError
from zwidth.installing import parquet
from zwidth.loop.pair.simulate import ARMS, labelled
from zwidth.loop.pair.simulate import FORMAT as OF_A_PAIR
from zwidth.loop.trace import (
    FORMAT,
    SAMPLED,
    SOMETIMES,
    UNITS,
    VARIABLES,
    Labelled,
    Trace,
    along_time,
    attributes_of,
)
from zwidth.missing import did_you_mean
from zwidth.quantity.glossary import unit_suffix
from zwidth.reading import check_hdf5, check_parquet, shown_only
from zwidth.writing import check_target, first_line, writing_whole

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import NDArray

    from zwidth.loop.trace import AnyTrace

    Array = NDArray[np.float64]


_ATTRIBUTES: dict[str, Callable[[Any], bool]] = {
    "motion": lambda value: isinstance(value, str) and value in UNITS,
    "stops": lambda value: isinstance(value, Real),
}
"""What is computed with, and what it must be."""

_OF_BOTH: dict[str, Callable[[Any], bool]] = {
    "motion": _ATTRIBUTES["motion"],
    "power_ratio": lambda value: isinstance(value, Real),
    "stored_at_start_J": lambda value: isinstance(value, Real),
}
"""The same of a pair."""


def save_trace(trace: xr.Dataset, path: str | PathLike[str], *, force: bool = False) -> None:
    """Save a trace; the suffix says how.

    Parameters
    ----------
    trace
        As `zwidth.simulate` returns it.
    path
        Ends in .nc, .parquet or .csv.
    force
        Replace a file that exists.

    Raises
    ------
    InputError
        If the suffix is another, the file exists, or it cannot be written; then there is no file.
    """
    target = Path(path)
    write, _ = _format(target)
    _refuse_foreign(trace, "this Dataset")
    check_target(target, force)
    with writing_whole(target) as file:
        write(trace, file)


def save_netcdf(data: xr.Dataset, path: Path) -> None:
    """Save any Dataset as NetCDF 4, in the place of what was there."""
    with writing_whole(path) as file:
        _write_netcdf(data, file)


def load_trace(path: str | PathLike[str]) -> xr.Dataset:
    """The trace in a file that `save_trace` wrote, equal to the one saved.

    Raises
    ------
    InputError
        If there is no such file, or it holds no whole trace.
    """
    source = Path(path)
    _, read = _format(source)
    if not source.is_file():
        raise InputError(f"{source} cannot be read: there is no such file{did_you_mean(source)}")
    try:
        trace = shown_only(read(source), source)
    except InputError:
        raise
    except Exception as error:  # what the libraries raise on foreign bytes is not documented
        raise InputError(f"{source} holds no trace that can be read: {first_line(error)}") from None
    _refuse_foreign(trace, str(source))
    return trace


def column_name(variable: str, unit: str) -> str:
    """The name of a column with its unit: position_m."""
    return f"{variable}_{unit_suffix(unit)}"


def _format(path: Path) -> tuple[Callable[[xr.Dataset, IO[bytes]], None], Callable[[Path], xr.Dataset]]:
    formats = {
        ".nc": (_write_netcdf, _read_netcdf),
        ".parquet": (_write_parquet, _read_parquet),
        ".csv": (_write_csv, _read_csv),
    }
    if path.suffix.lower() not in formats:
        raise InputError(f"a trace is a file that ends in {', '.join(formats)}, got {str(path)!r}")
    return formats[path.suffix.lower()]


def _refuse_foreign(trace: xr.Dataset, what: str) -> None:
    both = trace.attrs.get("format") == OF_A_PAIR and "arm" in trace.dims
    if not (both or trace.attrs.get("format") == FORMAT) or "time" not in trace.coords:
        raise InputError(f"{what} is no zwidth trace: its attribute format is not {FORMAT!r}")
    needed = _OF_BOTH if both else _ATTRIBUTES
    wrong = [key for key, fits in needed.items() if not fits(trace.attrs.get(key))]
    if wrong:
        raise InputError(f"{what} is no whole zwidth trace: its attribute {wrong[0]} is missing or wrong")
    missing = [name for name in VARIABLES if name not in trace and name not in SOMETIMES]
    if missing:
        raise InputError(f"{what} is no whole zwidth trace: it lacks {', '.join(missing)}")


def _write_netcdf(data: xr.Dataset, file: IO[bytes]) -> None:
    import h5netcdf
    from xarray.backends import H5NetCDFStore

    whole = BytesIO()  # HDF5 ends the process on a disk that becomes full
    with h5netcdf.File(whole, "w") as store:
        data.dump_to_store(H5NetCDFStore(store))
    file.write(whole.getbuffer())


def _read_netcdf(path: Path) -> xr.Dataset:
    import xarray as xr

    check_hdf5(path)
    with xr.open_dataset(path, engine="h5netcdf", decode_times=False) as file:
        trace: xr.Dataset = file.load()
    for name in trace.variables:
        trace[name].encoding.clear()
    trace.encoding.clear()
    plain = {k: v.item() if isinstance(v, np.generic) else v for k, v in trace.attrs.items()}
    return trace.assign_attrs(plain)


def _columns(trace: xr.Dataset) -> dict[str, NDArray[Any]]:
    columns: dict[str, NDArray[Any]] = {"time_s": trace["time"].values}
    parts = {f"{arm}_": trace.sel(arm=arm) for arm in ARMS} if "arm" in trace.dims else {"": trace}
    for before, part in parts.items():
        for name in VARIABLES:
            if name in part:
                columns[before + column_name(name, part[name].attrs["units"])] = part[name].values
    columns["sampled"] = trace["sampled"].values
    return columns


def _from_columns(columns: dict[str, Any], attributes: dict[str, Any], source: Path) -> xr.Dataset:
    motion, kind = attributes.get("motion"), attributes.get("format")
    if kind not in (FORMAT, OF_A_PAIR) or motion not in UNITS:
        raise InputError(f"{source} holds no zwidth trace: its attributes are not there")
    units = (*UNITS[motion], "J")
    time, sampled = np.asarray(columns["time_s"], dtype=np.float64), np.asarray(columns["sampled"]) != 0
    if kind == OF_A_PAIR:
        parts = [
            {
                name: np.asarray(columns[key], dtype=np.float64)
                for name, variable in VARIABLES.items()
                if (key := f"{arm}_{column_name(name, units[variable.kind])}") in columns
            }
            for arm in ARMS
        ]
        return labelled(parts, time, sampled, attributes).dataset()
    variables = {}
    for name, variable in VARIABLES.items():
        unit = units[variable.kind]
        key = column_name(name, unit)
        if key in columns:
            labels = attributes_of(variable, units)
            variables[name] = Labelled(("time",), np.asarray(columns[key], dtype=np.float64), labels)
    return Trace(variables, along_time(time, sampled, SAMPLED), attributes).dataset()


def _write_parquet(trace: xr.Dataset, file: IO[bytes]) -> None:
    import pyarrow as pa
    import pyarrow.parquet as pq

    table = pa.table(_columns(trace)).replace_schema_metadata({"zwidth": json.dumps(trace.attrs)})
    whole = BytesIO()
    pq.write_table(table, whole)
    file.write(whole.getbuffer())


def _read_parquet(path: Path) -> xr.Dataset:
    check_parquet(path)
    table = parquet(f"{path} is not read").read_table(path)
    attributes = json.loads((table.schema.metadata or {}).get(b"zwidth", b"{}"))
    return _from_columns({name: table[name].to_numpy() for name in table.column_names}, attributes, path)


_SEPARATED = re.compile("[,;](?=[=+@＝＋－＠-])")
"""Within a text of JSON, whose own commas have a space behind them: a spreadsheet would see a formula."""


def _write_csv(trace: xr.Dataset, file: IO[bytes]) -> None:
    columns = _columns(trace)
    columns["sampled"] = columns["sampled"].astype(np.int64)
    told = json.dumps(trace.attrs, ensure_ascii=False)
    told = _SEPARATED.sub(lambda found: f"\\u{ord(found[0]):04x}", told)
    file.write(f"# {told}\n".encode())
    file.write(f"{','.join(columns)}\n".encode())
    for row in zip(*(values.tolist() for values in columns.values()), strict=True):
        file.write(f"{','.join(map(repr, row))}\n".encode())  # repr: the shortest text with the same bits


def _read_csv(path: Path) -> xr.Dataset:
    with open(path, encoding="utf-8") as file:
        first, header = file.readline(), file.readline().strip().split(",")
        if not first.startswith("# {"):
            raise InputError(
                f"{path} holds no zwidth trace: its first line is not '# {{…}}' with the attributes"
            )
        attributes = json.loads(first[2:])
        if len(set(header)) < len(header):
            raise InputError(f"{path} holds no trace that can be read: a column is there twice")
        rows = np.loadtxt(file, delimiter=",", ndmin=2)
    if rows.shape[1] != len(header):
        raise InputError(f"{path} is not whole: {len(header)} names for {rows.shape[1]} columns")
    return _from_columns(dict(zip(header, rows.T, strict=True)), attributes, path)


# The actuator force as sound: a buzz is heard at once.
#
# The staircase of the force is held at 44.1 kHz as the actuator holds it; the mean
# over 50 ms around each instant is taken away, so that pressing is silent and
# only what changes is heard.  Full scale is the largest of what is left.


RATE = 44_100
"""Sound samples per second."""

_MEAN = 0.05
_QUIETEST = 1e-9


def save_sound(trace: AnyTrace, path: str | PathLike[str], *, force: bool = False) -> None:
    """Write the actuator force as a WAV file, 16 bits, one channel.

    Parameters
    ----------
    trace
        As `zwidth.simulate` returns it.
    path
        Ends in .wav.
    force
        Replace a file that exists.

    Raises
    ------
    InputError
        If the suffix is another, the file exists, or it cannot be written.
    """
    target = Path(path)
    if target.suffix.lower() != ".wav":
        raise InputError(f"sound is a file that ends in .wav, got {str(target)!r}")
    check_target(target, force)
    samples = waveform(trace)
    with writing_whole(target) as file:
        file.write(_as_wav(samples))


def _as_wav(samples: NDArray[np.int16]) -> bytes:
    sound = BytesIO()
    with wave.open(sound, "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(RATE)
        file.writeframes(samples.astype("<i2").tobytes())
    return sound.getvalue()


def waveform(trace: AnyTrace) -> NDArray[np.int16]:
    """The sound, −32767 … 32767; all 0 for a force that never changes."""
    time, force = trace["time"].values, trace["actuator_force"].values
    count = int((time[-1] - time[0]) * RATE)
    instants = time[0] + np.arange(count) / RATE
    held = force[np.searchsorted(time, instants, side="right") - 1]
    left = held - _moving_mean(held, int(_MEAN * RATE))
    peak = np.abs(left).max(initial=0.0)
    if peak <= _QUIETEST * np.abs(force).max(initial=0.0) or peak == 0.0:
        return np.zeros(count, dtype=np.int16)
    loud: NDArray[np.int16] = np.round(left / peak * 32767).astype(np.int16)
    return loud


def _moving_mean(values: Array, width: int) -> Array:
    """The mean over `width` around each value, over what there is of it at the ends."""
    sums = np.concatenate(([0.0], np.cumsum(values)))
    place = np.arange(values.size)
    low, high = np.maximum(0, place - width // 2), np.minimum(values.size, place + width // 2 + 1)
    means: Array = (sums[high] - sums[low]) / (high - low)
    return means
