"""The same question of every loop on a grid of parameters, with a progress bar."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Mapping
from contextlib import nullcontext
from importlib.util import find_spec
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from zwidth.errors import InputError
from zwidth.installing import imported
from zwidth.model.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.transfer_function import as_environment
from zwidth.model.pairs import Pair
from zwidth.progress import progress_bar
from zwidth.quantity.units import parse_number
from zwidth.study.chunks.layout import Finished, Layers, Place, on_cluster, on_processes
from zwidth.study.chunks.store import computed, say
from zwidth.study.sweeps.axes import REFUSED
from zwidth.study.sweeps.files import PARQUET, ZARR, begun, dataset, save_table, saved_table
from zwidth.study.sweeps.loops import Loop
from zwidth.study.sweeps.questions import Line
from zwidth.study.sweeps.request import Request, request
from zwidth.study.sweeps.springs import FEWEST, parts
from zwidth.writing import alone

SUFFIXES = (ZARR, PARQUET)


def sweep(
    device: Device | Pair,
    environment: Environment | Any = None,
    *,
    vary: Mapping[str, object],
    of: str = "check",
    operator: Any = None,
    duration: Any = None,
    path: str | PathLike[str] | None = None,
    address: str | None = None,
    workers: int | None = None,
    progress: Callable[[int, int], None] | None = None,
    **options: Any,
) -> xr.Dataset:
    """Ask the same question of every loop on a grid of parameters.

    Parameters
    ----------
    device, environment
        The loop, its numbers before they are varied; of two arms that follow each other a `Pair` alone.
    vary
        By the name of a parameter its values: a text "100:3000:50", "0:5 ms:20", "1:1000:20 log" or
        "0, 1 ms, 2 ms"; (start, stop, count); or a list. `damping` is the device's, `virtual_damping` the
        environment's, `velocity_filter.time_constant` its filter's, `law.largest_damping` that of a law in a
        chain, `law.2.largest_damping` of the second of several, `operator.force` the hand's, `leader.damping`
        that of one arm of a pair. Each value is the nearest double, and stands for the decimal that Python
        prints for it.
    of
        "check": the verdict, what binds, the largest passive stiffness; "limit": `passive_limit`; "simulate":
        one touch each, what it felt like and the energy got out; "pair": the verdict on two arms. Verdicts
        are by closed forms: values are not iterated.
    operator, duration
        Of a simulation: the hand, and how long [s].
    path
        A zarr store, or a file .parquet: written as it goes; one that was begun is gone on with.
    address
        Of a Dask scheduler whose workers compute, ``tcp://…``. Default: processes of this machine.
    workers
        How many of those. Default: one for each processor.
    progress
        Is told how many chunks are done, and of how many. Default: a bar.
    options
        Further arguments of `check` (contact), `passive_limit` (parameter, tolerance) or `simulate`; of
        "check" also `hands`, by name a hand or None for nobody: of each whether the loop comes to rest with
        it alone, as `zwidth.stability.coupled_stability` decides it.

    Returns
    -------
    xarray.Dataset
        A dimension for each parameter, its values as coordinate with their unit; of `check` and `pair`
        `outcome`, `contact` and `encoder` that it is about, `binding`, and `max_stiffness`, with hands
        `stability_NAME` and `max_stable_stiffness_NAME` of each; of `limit` `proved_passive` and
        `proved_active`; of `simulate` the measures of `compare_traces`. `refused` is True of a loop that
        cannot be. What all loops have in common, and what an answer means, stands in the attributes `scope`
        and `answers`. The bits do not depend on who computes, in which order, or how often it was stopped.

    Raises
    ------
    InputError
        If there is no such parameter or question, a value or a loop cannot be, or the file or the cluster
        cannot be used.
    """
    if workers is not None and (not isinstance(workers, int) or workers < 1):
        raise InputError(f"workers must be a whole number ≥ 1, got {workers}: someone has to compute")
    if duration is not None:
        options["duration"] = float(parse_number(duration, "s", "duration"))
    if of == "limit":
        options.setdefault("parameter", "stiffness")
    law = (
        environment
        if environment is None or isinstance(device, Pair)
        else as_environment(environment, device=device)
    )
    asked = request(of, Loop(device, law, operator, options), vary)
    file = None if path is None else _place(Path(path))

    def finished(left: list[Place]) -> Finished:
        if address is None:
            return on_processes(compute, asked, left, workers)
        return on_cluster(compute, asked, left, address)

    bar = progress_bar("chunks") if progress is None else nullcontext(progress)
    with nullcontext() if file is None else alone(file), bar as told:
        return _kept(asked, finished, file, told)


def _kept(
    asked: Request,
    finished: Callable[[list[Place]], Finished],
    file: Path | None,
    progress: Callable[[int, int], None],
) -> xr.Dataset:
    """The sweep, in its file where it has one."""
    if file is None or file.suffix == ZARR:
        layers = computed(asked.layout, finished, file, progress)
        found = dataset(asked, layers)
        if file is not None:
            say(file, asked.layout, _told(asked, found))
        return found
    if file.exists():
        return saved_table(file, asked)
    found = dataset(asked, computed(asked.layout, finished, begun(file), progress))
    save_table(file, asked, found)
    return found


def _told(asked: Request, found: xr.Dataset) -> dict[str, Any]:
    columns = {
        name: {"meaning": own.meaning, "unit": own.unit, "words": list(own.words), "several": own.several}
        for name, own in asked.columns.items()
    }
    return {"attributes": found.attrs, "columns": columns}


def _place(path: Path) -> Path:
    if path.suffix not in SUFFIXES:
        raise InputError(f"a sweep is kept in a file that ends in {' or '.join(SUFFIXES)}, got {str(path)!r}")
    if not path.parent.is_dir():
        raise InputError(f"{path} cannot be written: there is no directory {path.parent}")
    if path.suffix == PARQUET:
        # zarr holds it until it is whole
        takes, extras = ("pyarrow", "logs") if find_spec("zarr") else ("pyarrow and zarr", "logs,maps")
        imported("pyarrow.parquet", f"{path} is not written: Parquet takes {takes}, which", extras)
    return path


Cell = tuple[tuple[int, ...], tuple[int, ...]]
"""Where a loop is in its chunk, and among all."""


def compute(asked: Request, place: Place) -> Layers:
    """Every layer of one chunk, by the name of its array."""
    cells = asked.layout.cells(place)
    ranges = [range(*one.indices(len(own.values))) for one, own in zip(cells, asked.axes, strict=True)]
    shape = tuple(map(len, ranges))
    if asked.springs is None:
        layers: Layers = {name: np.zeros(shape, own.kind) for name, own in asked.columns.items()}
        left = list(np.ndindex(shape))
    else:
        decided = asked.springs.layers(cells, shape, asked.columns)
        layers, left = decided.layers, list(map(tuple, np.argwhere(~decided.sure)))
    lines: defaultdict[tuple[int, ...], list[Cell]] = defaultdict(list)
    for cell in left:
        place = tuple(own[n] for own, n in zip(ranges, cell, strict=True))
        lines[tuple(n for k, n in enumerate(place) if k != asked.stiffness_axis)].append((cell, place))
    for loops in lines.values():
        line: Line = {}
        for cell, place in _alone(asked, layers, loops, line):
            _one(asked, layers, cell, place, line)
    return layers


def _alone(asked: Request, layers: Layers, loops: list[Cell], line: Line) -> list[Cell]:
    """The loops of a line that must be asked by themselves, once what is known of walls is filled in."""
    if not asked.of_walls or len(loops) < FEWEST:
        return loops
    assert asked.stiffness_axis is not None
    values = asked.axes[asked.stiffness_axis].values
    try:
        known = parts(asked.at(loops[0][1]), np.array([values[p[asked.stiffness_axis]] for _, p in loops]))
    except InputError:
        return loops
    left = np.ones(len(loops), bool)
    for part in known:
        cell, place = loops[int(part.places.min())]
        _one(asked, layers, cell, place, line)
        told = {name: layers[name][cell] for name in asked.columns}
        if any(told[name] != asked.columns[name].kept(word) for name, word in part.about.items()):
            continue
        sure = part.binding > 0
        cells = tuple(np.array([loops[n][0] for n in part.places[sure]]).T)
        for name, value in told.items():
            layers[name][cells] = part.binding[sure] if name == "binding" else value
        left[part.places[sure]] = False
    return [loop for loop, alone in zip(loops, left, strict=True) if alone]


def _one(asked: Request, layers: Layers, cell: tuple[int, ...], place: tuple[int, ...], line: Line) -> None:
    """Ask about one loop; one that cannot be has no answer."""
    columns = asked.columns
    try:
        answer = {**asked.question.answer(asked.at(place), line), REFUSED: False}
    except InputError:
        answer = {name: () if own.several else None for name, own in columns.items()} | {REFUSED: True}
    for name, own in columns.items():
        layers[name][cell] = own.kept(answer[name])
