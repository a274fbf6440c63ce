"""A map in a zarr store, written chunk by chunk, so that it can be stopped at any moment and gone on with.

A chunk's layers are written first and its mark in `done` last.  Whatever kills the process, a marked
chunk is whole, and one that is not marked is computed again, to the same bits.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from zwidth.errors import InputError
from zwidth.maps.chunk import Layers, Place
from zwidth.maps.request import CHUNK, Request
from zwidth.writing import first_line

FORMAT = "zwidth map 1"
DIMENSIONS = ("stiffness", "virtual_damping")


def layer_types(asked: Request) -> dict[str, str]:
    """The arrays of a map and the type of their numbers."""
    stable = {f"stable_{name}": "bool" for name, _ in asked.hands}
    return {"passive": "bool", "passive_sustained": "bool", "admissible_speed": "float64"} | stable


class Store:
    """The arrays of one map on disk."""

    def __init__(self, path: Path, asked: Request) -> None:
        self._path = path
        self._group = _opened(path, asked)
        self._done: Any = self._group["done"]
        self._names = list(layer_types(asked))

    @property
    def left(self) -> list[Place]:
        """The chunks that are not yet there."""
        return [Place(int(i), int(j)) for i, j in np.argwhere(self._done[:] == 0)]

    def write(self, place: Place, layers: Layers) -> None:
        """Keep a chunk, and then say that it is there.

        Raises
        ------
        InputError
            If the disk does not take it; what was kept before is.
        """
        with _on_disk(self._path):
            for name, values in layers.items():
                array: Any = self._group[name]
                array[place.cells] = values
            self._done[place.row, place.column] = 1

    def read(self) -> Layers:
        """All layers, whole."""
        return {name: np.asarray(self._group[name]) for name in self._names}


def _opened(path: Path, asked: Request) -> Any:
    try:
        import zarr
    except ImportError:
        raise InputError(
            'a map on disk needs zarr, which is not installed: pip install "zwidth[maps]"; '
            "without a file the map is computed all the same"
        ) from None
    with _on_disk(path):
        if path.exists() and any(path.iterdir()):
            return _resumed(zarr, path, asked)
        return _created(zarr, path, asked)


@contextmanager
def _on_disk(path: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        reason = error.strerror or first_line(error)
        raise InputError(
            f"{path} cannot be written: {reason}; what is finished is kept, and the same map goes on with it"
        ) from None


def _resumed(zarr: Any, path: Path, asked: Request) -> Any:
    _refuse_links(path)
    try:
        group = zarr.open_group(path, mode="r+")
        found, begun = (group.attrs.get("format"), group.attrs.get("digest")), group.attrs.get("begun")
    except (FileNotFoundError, NotADirectoryError, ValueError, KeyError):
        raise InputError(f"{path} exists and holds no map; choose another name or remove it first") from None
    if found == (FORMAT, None) and begun == asked.digest():
        return _created(zarr, path, asked)  # stopped before all its arrays were there
    if found != (FORMAT, asked.digest()) or not _fits(group, asked):
        raise InputError(
            f"{path} holds another map, or one of another version; choose another name or remove it first"
        )
    return group


def _fits(group: Any, asked: Request) -> bool:
    """Whether the arrays are those of this map: what is read is as much as they declare."""
    layer = ((asked.stiffness.cells, asked.virtual_damping.cells), (CHUNK, CHUNK))
    arrays = {name: (*layer, kind) for name, kind in layer_types(asked).items()}
    arrays["done"] = (asked.chunks, (1, 1), "uint8")
    found = {name: group.get(name) for name in arrays}
    return all(
        hasattr(array, "shards")  # else it is a group, or not there
        and (array.shape, array.chunks, str(array.dtype), array.shards) == (*arrays[name], None)
        for name, array in found.items()
    )


def _refuse_links(path: Path) -> None:
    """A part of a map that is a link would be read, and written, wherever it leads."""
    link = next((part for part in path.rglob("*") if part.is_symlink()), None)
    if link is not None:
        raise InputError(f"{path} is not gone on with: {link.relative_to(path)} in it is a link to elsewhere")


def _created(zarr: Any, path: Path, asked: Request) -> Any:
    group = zarr.create_group(path, overwrite=True, attributes={"format": FORMAT, "begun": asked.digest()})
    shape = (asked.stiffness.cells, asked.virtual_damping.cells)
    for name, axis in zip(DIMENSIONS, (asked.stiffness, asked.virtual_damping), strict=True):
        coordinate = group.create_array(name, shape=(axis.cells,), dtype="float64", dimension_names=(name,))
        coordinate[:] = axis.values
    for name, kind in layer_types(asked).items():
        group.create_array(
            name, shape=shape, dtype=kind, chunks=(CHUNK, CHUNK), fill_value=0, dimension_names=DIMENSIONS
        )
    group.create_array(
        "done", shape=asked.chunks, dtype="uint8", chunks=(1, 1), fill_value=0,
        dimension_names=("stiffness_chunk", "virtual_damping_chunk"),
    )  # fmt: skip
    # last: a group with a digest has all its arrays
    group.attrs.update({"digest": asked.digest(), "request": asked.describe()})
    return group
