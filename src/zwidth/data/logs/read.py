"""A log from a file, whatever its format: the first bytes say which it is."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from os import PathLike
from pathlib import Path
from typing import Any

from zwidth.data.logs.columns import QUANTITIES, recognise
from zwidth.data.logs.log import Log, contents, stated_period
from zwidth.data.logs.meaning import meaning_of
from zwidth.data.logs.table import Motion, Table, listed, readable, understood_sheets, with_whole_stamps
from zwidth.errors import InputError
from zwidth.installing import parquet
from zwidth.missing import did_you_mean


def read_log(
    path: str | PathLike[str],
    *,
    columns: Mapping[str, str | None] | None = None,
    units: Mapping[str, str] | None = None,
    scale: Mapping[str, object] | None = None,
    sample_rate: object = None,
    sample_period: object = None,
    resolution: object = None,
    counts_per_turn: object = None,
    motion: Motion | None = None,
    sheet: str | None = None,
) -> Log:
    """A log from a file: text, workbook, Parquet, NetCDF, HDF5, MATLAB, NumPy, MCAP, ROS bags, telemetry,
    what zwidth wrote.

    Parameters
    ----------
    path
        The file, or the folder of a rosbag2 or of a LeRobot dataset.
    columns
        The column of each of time, position, hand_force and actuator_force, where its name is not recognised:
        {"position": "enc_left"}; None leaves one out: {"hand_force": None}.
    units
        The unit of each, where neither the file nor the name states it: {"position": "mm"}.
    scale
        What a number in a column stands for: {"hand_force": "2 N/V"}, {"position": -1}.
    sample_rate, sample_period
        [Hz], [s] as stated; needed where there is no time, else compared with the stamps.
    resolution
        [m; rad] step of the encoder as stated; what a count is where the position is in counts.
    counts_per_turn
        Of a rotary encoder, instead of the resolution.
    motion
        "linear" or "rotary", where the unit of the position does not say it.
    sheet
        The name of the sheet of a workbook, where several hold a recording; the number of an episode of a
        LeRobot dataset, where one alone is to be read.

    Raises
    ------
    InputError
        If the file cannot be read, a column or its unit is not known, or nothing can be learnt from it.
    """
    reading: dict[str, Any] = {"columns": columns, "units": units, "scale": scale, "motion": motion}
    reading |= {"sample_rate": sample_rate, "sample_period": sample_period}
    reading |= {"resolution": resolution, "counts_per_turn": counts_per_turn}
    with opened(path, sheet, columns) as table:
        return log_of(table, **reading)


_LOOKED_AT = 2**24
"""[bytes] Of a locked workbook, among which it says that it is locked."""


@contextmanager
def opened(
    path: str | PathLike[str], sheet: str | None = None, columns: Mapping[str, str | None] | None = None
) -> Iterator[Table]:
    """The table of a file, from which several logs may be made; what cannot be read inside is refused. Of a
    workbook it is that of the sheet, or of the one sheet that has these columns and a position."""
    with readable(str(path)):
        table = _one_sheet(table_of_file(Path(path), sheet), columns or {})
        yield with_whole_stamps(table, (columns or {}).values())


def _one_sheet(table: Table, columns: Mapping[str, str | None]) -> Table:
    """The sheet that holds a recording; the longest where none is known to."""
    chosen = {quantity: name for quantity, name in columns.items() if quantity in QUANTITIES}

    def holds(each: Table) -> None:
        recognise(each.units, chosen, each.source)

    found = understood_sheets(table, holds)
    if len(found) > 1:
        names = [each.sheet for each in found]
        raise InputError(
            f"{table.source}: the sheets {listed(names)} each hold a recording; say which with "
            f'sheet="{names[0]}"'
        )
    return found[0]


def log_of(
    table: Table,
    *,
    columns: Mapping[str, str | None] | None = None,
    sample_rate: object = None,
    sample_period: object = None,
    **meant: Any,
) -> Log:
    """The log of some columns of a table; arguments as of `read_log`."""
    period = stated_period(sample_rate, sample_period)
    names = recognise(table.units, {**table.means, **(columns or {})}, table.source)
    return Log(**contents(table, meaning_of(table, names, **meant), period))


def table_of_file(path: Path, sheet: str | None = None) -> Table:
    """The table of a file, by its first bytes: the libraries take their time to load."""
    files = [path]
    if path.is_dir() and not (path / "metadata.yaml").is_file():
        files = _of_dataset(path)
    first = files[0]
    if not path.exists():
        raise InputError(f"{path} cannot be read: there is no such file{did_you_mean(path)}")
    start = b""
    if not first.is_dir():
        with open(first, "rb") as file:
            start = file.read(520)
    if start.startswith(b"version https://git-lfs"):
        raise InputError(f"{first} is a pointer of Git LFS and holds no data: git lfs pull fetches the file")
    if start[:4] == b"PK\x03\x04":
        return _in_archive(path, sheet)
    if start[:8] == b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1":
        raise InputError(f"{path} is {_old_office(path)}")
    if start[:4] == b"PAR1" or first != path:
        parquet(f"{path} is not read")
        from zwidth.data.logs.parquet import parquet_table

        return parquet_table(path, files, sheet)
    if sheet is not None:
        raise InputError(f'{path} is no workbook and has no sheets: leave sheet="{sheet}" out')
    is_hdf5 = b"\x89HDF\r\n\x1a\n" in (start[:8], start[512:520])
    if is_hdf5 or start.startswith((b"\x93NUMPY", b"MATLAB")) or path.suffix.lower() == ".mat":
        from zwidth.data.logs.scientific import hdf5_table, matlab_table, numpy_table

        if is_hdf5:
            return hdf5_table(path)
        return numpy_table(path) if start.startswith(b"\x93NUMPY") else matlab_table(path)
    if start.startswith(b"\x89MCAP"):
        from zwidth.data.logs.served import mcap_head, served_table

        if (head := mcap_head(path)) is not None:  # of a served loop
            return served_table(path, head)
    if path.is_dir() or start.startswith((b"\x89MCAP", b"#ROSBAG V", b"SQLite format")):
        from zwidth.data.logs.bags import bag_table

        return bag_table(path)
    if start[:3] == b"CDF":
        raise InputError(f"{path} is NetCDF 3; write it as NetCDF 4, for example with nccopy -k nc4")
    if b"zW" in start:
        from zwidth.data.logs.telemetry import is_telemetry, telemetry_table

        if is_telemetry(start):
            return telemetry_table(path)
    from zwidth.data.logs.text import text_table

    return text_table(path)


def _of_dataset(path: Path) -> list[Path]:
    """The files of the one dataset that a folder is, is in, or holds."""
    infos = (info for depth in ("", "*/", "*/*/", "*/*/*/") for info in path.glob(f"{depth}meta/info.json"))
    found = sorted(str(info.parent.parent) for info in infos)
    if len(found) > 1 and str(path) not in found:
        raise InputError(f"{path} holds {len(found)} LeRobot datasets, {listed(found)}: name one of them")
    root = Path(found[0]) / "data" if found else path
    files = sorted([*root.glob("*.parquet"), *root.glob("*/*.parquet")])
    if not files:
        what = f"nothing is in {root}" if found else "no rosbag2: there is no metadata.yaml in it"
        raise InputError(f"{path} is a directory, and {what}; name a file")
    return files


def _in_archive(path: Path, sheet: str | None) -> Table:
    from zwidth.data.logs.workbook import kind_of_archive, workbook_table

    kind = kind_of_archive(path)
    if kind == "workbook":
        return workbook_table(path, sheet)
    if kind == "arrays":
        from zwidth.data.logs.scientific import numpy_table

        return numpy_table(path)
    said = {
        "binary": "a binary workbook; save it as an ordinary .xlsx, or the sheet as CSV",
        "open document": "an OpenDocument spreadsheet; save it as .xlsx, or the sheet as CSV",
    }
    raise InputError(f"{path} is {said.get(kind, 'a zip archive and no workbook; unpack it')}")


def _old_office(path: Path) -> str:
    """What a file of an old office program is, and what to do: it locks the new workbooks too."""
    with open(path, "rb") as file:
        locked = "EncryptedPackage".encode("utf-16-le") in file.read(_LOOKED_AT)
    return (
        "a workbook locked by a password; open it and save it without one, or save the sheet as CSV"
        if locked
        else "a spreadsheet of an old office program; save it as .xlsx, or the sheet as CSV"
    )
