"""Arrays over the same axes, computed and kept in blocks of cells: chunks."""

from __future__ import annotations

import hashlib
import json
import os
import pickle
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, CancelledError, ThreadPoolExecutor, wait
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cached_property
from itertools import islice, product
from queue import SimpleQueue
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zwidth import installing
from zwidth.errors import InputError

Place = tuple[int, ...]
"""Which chunk, counted along each axis."""

Layers = dict[str, NDArray[Any]]
"""Numbers of one chunk, or of all cells, by the name of their array."""


@dataclass(frozen=True)
class Layout:
    """What arrays there are, over which axes, and what they are of.

    `what`, `format`: what the arrays are together, in a word for messages; the name and version of how they
        are kept.
    `request`: what was asked, as JSON holds it; another for whatever has other numbers.
    `axes`: the values along each axis, by its name.
    `chunk`: cells along each axis that are computed and kept at a time.
    `types`: the arrays and the type of their numbers.
    `about`: what is said of an array or an axis beside its numbers, such as its unit.
    """

    what: str
    format: str
    request: Mapping[str, Any]
    axes: Mapping[str, NDArray[np.float64]]
    chunk: tuple[int, ...]
    types: Mapping[str, str]
    about: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)

    @cached_property
    def digest(self) -> str:
        """A name for the request: another one has another."""
        return hashlib.sha256(json.dumps(self.request, sort_keys=True).encode()).hexdigest()

    @property
    def shape(self) -> tuple[int, ...]:
        """Cells along each axis."""
        return tuple(len(values) for values in self.axes.values())

    @property
    def chunks(self) -> tuple[int, ...]:
        """How many chunks there are along each axis."""
        return tuple(-(-cells // size) for cells, size in zip(self.shape, self.chunk, strict=True))

    @property
    def places(self) -> list[Place]:
        """Every chunk."""
        return list(product(*map(range, self.chunks)))

    def cells(self, place: Place) -> tuple[slice, ...]:
        """The cells of one chunk among all."""
        return cells(place, self.chunk)


def cells(place: Place, chunk: tuple[int, ...]) -> tuple[slice, ...]:
    """The cells of one chunk among all."""
    return tuple(slice(n * size, (n + 1) * size) for n, size in zip(place, chunk, strict=True))


# A process that computes chunks for another: it reads places from its input and writes layers to its output.


class Worker:
    """The process, as it is seen from the one that asks.

    `compute`: a function of a module: from what was made ready, and a place, to layers.
    `ready`: what was made ready.
    """

    def __init__(self, compute: Callable[[Any, Place], Layers], ready: Any) -> None:
        command = [sys.executable, "-c", "from zwidth.study.chunks.layout import serve; serve()"]
        path = os.pathsep.join(filter(None, sys.path))
        self.process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env={**os.environ, "PYTHONPATH": path}
        )
        self._say((compute, ready))

    def ask(self, place: Place) -> Layers:
        """The layers of one chunk."""
        try:
            self._say(place)
            failed, answer = pickle.load(self.process.stdout)  # type: ignore[arg-type]  # it is a pipe
        except (EOFError, OSError, pickle.UnpicklingError):
            raise InputError(
                "a process that computed for this one ended before its time, for want of memory or because "
                "somebody ended it; the same command goes on, with fewer --workers if memory is short"
            ) from None
        if failed:
            raise answer
        return answer  # type: ignore[no-any-return]

    def dismiss(self) -> None:
        """End it; what it is at is lost."""
        self.process.kill()
        self.process.wait()
        for stream in (self.process.stdin, self.process.stdout):
            with suppress(OSError):  # what was still to be said to it
                stream.close()  # type: ignore[union-attr]  # both are pipes

    def _say(self, message: Any) -> None:
        stream = self.process.stdin
        assert stream is not None
        pickle.dump(message, stream)
        stream.flush()


def serve() -> None:
    """Answer until there is nobody who asks."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the one that asks, who then ends this one
    asked, answers = sys.stdin.buffer, os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())  # what is printed is no answer
    try:
        compute, ready = pickle.load(asked)
        while True:
            place = pickle.load(asked)
            try:
                answer: tuple[bool, Any] = False, compute(ready, place)
            except Exception as error:
                answer = True, error
            pickle.dump(answer, answers)
            answers.flush()
    except (EOFError, BrokenPipeError):
        return


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
    needs = "Dask, which a cluster needs,"
    dask = installing.imported("distributed", needs, "maps", "give no address")
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
