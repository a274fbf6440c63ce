"""Who computes the chunks: threads here, or a Dask cluster elsewhere.  The bits are the same."""

from __future__ import annotations

import os
from collections.abc import Iterator
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait
from itertools import islice
from typing import Any

from zwidth.errors import InputError
from zwidth.maps.chunk import Layers, Place, compute
from zwidth.maps.plan import Plan

Finished = Iterator[tuple[Place, Layers]]

_TIMEOUT = "10 s"
"""How long a cluster may take to answer."""


def on_threads(ready: Plan, places: list[Place], workers: int | None) -> Finished:
    """Each chunk as it is finished, on so many threads; the kernels do not hold Python's lock."""
    count = (os.cpu_count() or 1) if workers is None else workers
    waiting = iter(places)
    with ThreadPoolExecutor(count) as pool:
        running = {pool.submit(compute, ready, place): place for place in islice(waiting, 2 * count)}
        while running:
            finished, _ = wait(running, return_when=FIRST_COMPLETED)
            for future in finished:
                yield running.pop(future), future.result()
                for place in islice(waiting, 1):
                    running[pool.submit(compute, ready, place)] = place


def on_cluster(ready: Plan, places: list[Place], address: str) -> Finished:
    """Each chunk as it is finished, on the workers of the Dask scheduler at an address."""
    try:
        import distributed
    except ImportError:
        raise InputError(
            'a cluster needs Dask, which is not installed: pip install "zwidth[maps]"; '
            "without an address the map is computed on this machine"
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
        for future, layers in dask.as_completed(futures, with_results=True):
            yield futures[future], layers
            future.release()
