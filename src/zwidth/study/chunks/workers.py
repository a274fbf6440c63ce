"""Who computes the chunks: threads or processes here, or a Dask cluster elsewhere.  The bits are the same."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, CancelledError, ThreadPoolExecutor, wait
from itertools import islice
from queue import SimpleQueue
from typing import Any

from zwidth.errors import InputError
from zwidth.study.chunks.layout import Layers, Place
from zwidth.study.chunks.worker import Worker

Compute = Callable[[Any, Place], Layers]
"""From what was made ready once, and a chunk, to its layers."""

Finished = Iterator[tuple[Place, Layers]]

_TIMEOUT = "10 s"
"""How long a cluster may take to answer."""


def on_threads(compute: Compute, ready: Any, places: list[Place], workers: int | None) -> Finished:
    """Each chunk as it is finished, on so many threads; the kernels do not hold Python's lock."""
    count = processors() if workers is None else workers
    waiting = iter(places)
    with ThreadPoolExecutor(count) as pool:
        running = {pool.submit(compute, ready, place): place for place in islice(waiting, 2 * count)}
        while running:
            finished, _ = wait(running, return_when=FIRST_COMPLETED)
            for future in finished:
                yield running.pop(future), future.result()
                for place in islice(waiting, 1):
                    running[pool.submit(compute, ready, place)] = place


def on_processes(compute: Compute, ready: Any, places: list[Place], workers: int | None) -> Finished:
    """Each chunk as it is finished, on so many processes: what is written in Python holds its lock."""
    count = min(processors() if workers is None else workers, len(places))
    if count <= 1:
        yield from ((place, compute(ready, place)) for place in places)
        return
    idle: SimpleQueue[Worker] = SimpleQueue()
    hired = [Worker(compute, ready) for _ in range(count)]
    for worker in hired:
        idle.put(worker)

    def ask(_: Any, place: Place) -> Layers:
        worker = idle.get()
        try:
            return worker.ask(place)
        finally:
            idle.put(worker)

    try:
        yield from on_threads(ask, None, places, count)
    finally:
        for worker in hired:
            worker.dismiss()


def on_cluster(compute: Compute, ready: Any, places: list[Place], address: str) -> Finished:
    """Each chunk as it is finished, on the workers of the Dask scheduler at an address."""
    try:
        import distributed
    except ImportError:
        raise InputError(
            'a cluster needs Dask, which is not installed: pip install "zwidth[maps]"; '
            "without an address all is computed on this machine"
        ) from None
    dask: Any = distributed
    try:
        client: Any = dask.Client(address, timeout=_TIMEOUT)
    except (OSError, ValueError, ImportError) as error:
        raise InputError(
            f"no Dask scheduler answers at {address}: {str(error).splitlines()[0]}; "
            "start one with dask scheduler"
        ) from None
    with client:
        (shared,) = client.scatter([ready], broadcast=True)  # in a list: a tuple is scattered part by part
        futures = {client.submit(compute, shared, place, pure=False): place for place in places}
        try:
            for future, layers in dask.as_completed(futures, with_results=True):
                yield futures[future], layers
                future.release()
        except (CancelledError, OSError):
            raise InputError(
                f"the Dask scheduler at {address} went away; what is finished is kept where a file was named"
            ) from None


def processors() -> int:
    """How many processors there are to compute on."""
    return os.cpu_count() or 1
