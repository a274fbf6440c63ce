"""The same question of every loop on a grid of parameters, with a progress bar."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import nullcontext
from os import PathLike
from pathlib import Path
from typing import Any

import xarray as xr

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.transfer_function import as_environment
from zwidth.model.pairs import Pair
from zwidth.progress import progress_bar
from zwidth.quantity.units import parse_number
from zwidth.study.chunks.layout import Place
from zwidth.study.chunks.store import computed, say
from zwidth.study.chunks.workers import Finished, on_cluster, on_processes
from zwidth.study.sweeps.compute import compute
from zwidth.study.sweeps.dataset import dataset
from zwidth.study.sweeps.files import PARQUET, ZARR, begun, save_table, saved_table
from zwidth.study.sweeps.loops import Loop
from zwidth.study.sweeps.request import Request, request
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
    law = environment if environment is None or isinstance(device, Pair) else as_environment(environment)
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
    """What a store says of itself once it is whole."""
    columns = {
        name: {"meaning": own.meaning, "unit": own.unit, "words": list(own.words), "several": own.several}
        for name, own in asked.columns.items()
    }
    return {"attributes": found.attrs, "columns": columns}


def _place(path: Path) -> Path:
    """Where a sweep is kept."""
    if path.suffix not in SUFFIXES:
        raise InputError(f"a sweep is kept in a file that ends in {' or '.join(SUFFIXES)}, got {str(path)!r}")
    if not path.parent.is_dir():
        raise InputError(f"{path} cannot be written: there is no directory {path.parent}")
    return path
