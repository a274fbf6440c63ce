"""Batches on a graphics card: one loop per thread, the step functions of the processor.

CUDA compiles the very functions that the processor runs, but fuses products into
sums, so that results agree to rounding and not to the bit; where a reading lies
on an encoder edge, the two then part, as two devices would.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth.errors import InputError
from zwidth.loop.series import WORK
from zwidth.loop.summary import SUMMARY

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from zwidth.loop.setup import Setup

    Array = NDArray[np.float64]

_THREADS = 128


def run_on_gpu(setups: list[Setup], states: Array, summaries: Array) -> None:
    """Run all loops on the graphics card; states and summaries, a row each, are filled in.

    Raises
    ------
    InputError
        If there is no card or no CUDA, or a loop is not of the kind that runs there.
    """
    cuda = _cuda()
    from zwidth.loop.cuda_kernel import kernel

    first = setups[0]
    for setup in setups:
        if setup.frame.arrivals.size or setup.frame.missed.size:
            raise InputError("late and missed samples are for the processor: leave out backend='gpu'")
        if setup.frame.points != 1:
            raise InputError("a batch records no points between samples: leave points_per_sample out")
        if setup.frame.samples != first.frame.samples:
            raise InputError("on the graphics card all loops of a batch have equally many samples")
    arrays = packed(setups, states, summaries)
    on_card = [cuda.to_device(array) for array in arrays]
    blocks = -(-len(setups) // _THREADS)
    kernel[blocks, _THREADS](first.frame.samples, *on_card)
    states[:], summaries[:] = on_card[0].copy_to_host(), on_card[-1].copy_to_host()


def packed(setups: list[Setup], states: Array, summaries: Array) -> list[Array]:
    """What the card's kernel takes after the number of samples, a row per loop."""
    count, samples = len(setups), setups[0].frame.samples
    laws = _padded([setup.law for setup in setups])
    memories = _padded([setup.memory for setup in setups])
    columns = list(zip(*(setup.optional() for setup in setups), strict=True))
    which, signals = zip(*(_distinct(column) for column in columns), strict=True)
    clocks = np.array([[setup.frame.late, setup.frame.offset, setup.frame.lengths[0]] for setup in setups])
    return [
        states.copy(),
        np.array([setup.frame.plant for setup in setups]),
        laws,
        memories,
        np.zeros((count, WORK)),
        clocks,
        np.array(which, dtype=np.float64),
        *signals,
        np.empty((2, 0)),
        np.zeros((count, samples + 1)),
        summaries.copy() if summaries.shape[1] == SUMMARY else np.zeros((count, SUMMARY)),
    ]


def _cuda() -> Any:
    try:
        from numba import cuda
    except ImportError as error:
        raise InputError(f"CUDA cannot be used ({error}): pip install 'zwidth[gpu]'") from None
    if not cuda.is_available():  # type: ignore[no-untyped-call]
        raise InputError(
            "no graphics card with CUDA was found: leave out backend='gpu', or pip install 'zwidth[gpu]' on "
            "a machine that has one"
        )
    return cuda


def _padded(rows: list[Array]) -> Array:
    result = np.zeros((len(rows), max(row.size for row in rows)))
    for row, values in zip(result, rows, strict=True):
        row[: values.size] = values
    return result


def _distinct(values: tuple[Array, ...]) -> tuple[list[int], Array]:
    """(which row each loop has, the rows): a signal that many loops share is kept once."""
    rows: dict[int, int] = {}
    kept: list[Array] = []
    for value in values:
        if id(value) not in rows:
            rows[id(value)] = len(kept)
            kept.append(value)
    if len({row.size for row in kept}) > 1:
        raise InputError("on the graphics card the loops of a batch have the same kind of hand")
    return [rows[id(value)] for value in values], np.array(kept)
