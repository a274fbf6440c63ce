"""A map or a sweep in a zarr store, written chunk by chunk: it can be stopped at any moment and gone on with.

A chunk's layers are written first and its mark in `done` last.  Whatever kills the process, a marked
chunk is whole, and one that is not marked is computed again, to the same bits.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from zwidth import installing
from zwidth.errors import InputError
from zwidth.study.chunks.layout import Layers, Layout, Place
from zwidth.writing import first_line


class Memory:
    """The arrays of one layout without a file."""

    def __init__(self, layout: Layout) -> None:
        self._layout = layout
        self._layers: Layers = {
            name: np.zeros(layout.shape, dtype=kind) for name, kind in layout.types.items()
        }
        self.left = layout.places

    def write(self, place: Place, layers: Layers) -> None:
        """Keep a chunk."""
        for name, values in layers.items():
            self._layers[name][self._layout.cells(place)] = values

    def read(self) -> Layers:
        """All layers, whole."""
        return self._layers


class Store:
    """The arrays of one layout on disk."""

    def __init__(self, path: Path, layout: Layout) -> None:
        self._path, self._layout = path, layout
        self._group = _opened(path, layout)
        self._done: Any = self._group["done"]

    @property
    def left(self) -> list[Place]:
        """The chunks that are not yet there."""
        return [tuple(map(int, place)) for place in np.argwhere(self._done[:] == 0)]

    def write(self, place: Place, layers: Layers) -> None:
        """Keep a chunk, and then say that it is there."""
        with _on_disk(self._path, self._layout):
            for name, values in layers.items():
                array: Any = self._group[name]
                array[self._layout.cells(place)] = values
            self._done[place] = 1

    def read(self) -> Layers:
        """All layers, whole."""
        return {name: np.asarray(self._group[name]) for name in self._layout.types}


def computed(
    layout: Layout,
    finished: Callable[[list[Place]], Iterator[tuple[Place, Layers]]],
    path: Path | None,
    progress: Callable[[int, int], None],
) -> Layers:
    """Every layer, whole; what is not yet on disk is computed.

    `layout`: what is to be had.
    `finished`: gives each of these chunks as it is finished.
    `path`: of a zarr store; None to keep nothing.
    `progress`: is told how many chunks are done, and of how many.
    """
    keep: Any = Memory(layout) if path is None else Store(path, layout)
    left = keep.left
    total = len(layout.places)
    for count, (place, layers) in enumerate(finished(left), start=total - len(left) + 1):
        keep.write(place, layers)
        progress(count, total)
    whole: Layers = keep.read()
    return whole


def say(path: Path, layout: Layout, told: Mapping[str, Any]) -> None:
    """Write into a store that is whole what is to be said of it."""
    import zarr  # it was there to compute the store

    with _on_disk(path, layout):
        zarr.open_group(path, mode="r+").attrs["told"] = dict(told)


def _opened(path: Path, layout: Layout) -> Any:
    what = f"zarr, which a {layout.what} on disk needs,"
    zarr = installing.imported("zarr", what, "maps", "give no file")
    with _on_disk(path, layout):
        if path.exists() and any(path.iterdir()):
            return _resumed(zarr, path, layout)
        return _created(zarr, path, layout)


@contextmanager
def _on_disk(path: Path, layout: Layout) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        reason = error.strerror or first_line(error)
        raise InputError(
            f"{path} cannot be written: {reason}; what is finished is kept, and the same {layout.what} goes "
            "on with it"
        ) from None


def _resumed(zarr: Any, path: Path, layout: Layout) -> Any:
    # a part that is a link would be read, and written, wherever it leads
    if (link := next((part for part in path.rglob("*") if part.is_symlink()), None)) is not None:
        raise InputError(f"{path} is not gone on with: {link.relative_to(path)} in it is a link to elsewhere")
    try:
        group = zarr.open_group(path, mode="r+")
        found, begun = (group.attrs.get("format"), group.attrs.get("digest")), group.attrs.get("begun")
    except (FileNotFoundError, NotADirectoryError, ValueError, KeyError):
        raise InputError(
            f"{path} exists and holds no {layout.what}; choose another name or remove it first"
        ) from None
    if found == (layout.format, None) and begun == layout.digest:
        return _created(zarr, path, layout)  # stopped before all its arrays were there
    if found != (layout.format, layout.digest) or not _fits(group, layout):
        raise InputError(
            f"{path} holds another {layout.what}, or one of another version; choose another name or remove "
            "it first"
        )
    return group


def _fits(group: Any, layout: Layout) -> bool:
    """Whether the arrays are those of this layout: what is read is as much as they declare."""
    arrays = {name: (layout.shape, layout.chunk, kind) for name, kind in layout.types.items()}
    arrays["done"] = (layout.chunks, (1,) * len(layout.chunks), "uint8")
    found = {name: group.get(name) for name in arrays}
    return all(
        hasattr(array, "shards")  # else it is a group, or not there
        and (array.shape, array.chunks, str(array.dtype), array.shards) == (*arrays[name], None)
        for name, array in found.items()
    )


def _created(zarr: Any, path: Path, layout: Layout) -> Any:
    group = zarr.create_group(
        path, overwrite=True, attributes={"format": layout.format, "begun": layout.digest}
    )
    dimensions = tuple(layout.axes)
    for name, values in layout.axes.items():
        coordinate = group.create_array(
            name,
            shape=values.shape,
            dtype="float64",
            dimension_names=(name,),
            attributes=_about(layout, name),
        )
        coordinate[:] = values
    for name, kind in layout.types.items():
        group.create_array(
            name, shape=layout.shape, dtype=kind, chunks=layout.chunk, fill_value=0,
            dimension_names=dimensions, attributes=_about(layout, name),
        )  # fmt: skip
    group.create_array(
        "done", shape=layout.chunks, dtype="uint8", chunks=(1,) * len(dimensions), fill_value=0,
        dimension_names=tuple(f"{name}_chunk" for name in dimensions),
    )  # fmt: skip
    # last: a group with a digest has all its arrays
    group.attrs.update({"digest": layout.digest, "request": dict(layout.request)})
    return group


def _about(layout: Layout, name: str) -> dict[str, Any]:
    return dict(layout.about.get(name, {}))
