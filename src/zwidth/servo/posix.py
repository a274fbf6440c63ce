"""Time, sleep and bytes, as compiled code asks the system for them: no lock of Python, nothing allocated.

The clock is monotonic and counts nanoseconds.
"""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils as typed_cgutils
from numba.extending import intrinsic as typed_intrinsic
from numpy.typing import NDArray

from zwidth.compiled import compiled
from zwidth.errors import InputError

cgutils: Any = typed_cgutils
intrinsic: Any = typed_intrinsic  # their types are not those that compiled code has

Bytes = NDArray[np.uint8]

SUPPORTED = sys.platform != "win32"

_MONOTONIC = 6 if sys.platform == "darwin" else 1
"""Its number in <time.h>."""


def _system(name: str, returns: Any, *arguments: Any) -> Any:
    """A function of the system's C library, called by its name."""
    return types.ExternalFunction(name, returns(*arguments))


if SUPPORTED:
    _read = _system("read", types.intp, types.int32, types.intp, types.intp)
    _write = _system("write", types.intp, types.int32, types.intp, types.intp)


def check_supported() -> None:
    """Refuse a system without these calls.

    Raises
    ------
    InputError
        On Windows.
    """
    if not SUPPORTED:
        raise InputError(
            "serving needs the clock and the descriptors of a POSIX system, Linux or macOS; this is Windows: "
            "use Linux in a virtual machine with the device's port handed through, or WSL 2"
        )


@intrinsic  # type: ignore[untyped-decorator]
def _monotonic(typing: Any) -> Any:
    """The clock, into a place of the stack: an array would be allocated at every call."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        word, small = ir.IntType(64), ir.IntType(32)
        at = cgutils.alloca_once(builder, word, size=2)
        kind = ir.FunctionType(small, [small, word.as_pointer()])
        ask = cgutils.get_or_insert_function(builder.module, kind, "clock_gettime")
        builder.call(ask, [small(_MONOTONIC), at])
        seconds = builder.mul(builder.load(at), word(1_000_000_000))
        return builder.add(seconds, builder.load(builder.gep(at, [small(1)])))

    return types.int64(), generate


@intrinsic  # type: ignore[untyped-decorator]
def _sleep(typing: Any, nanoseconds: Any) -> Any:
    """nanosleep, its time in a place of the stack."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        word, small = ir.IntType(64), ir.IntType(32)
        at = cgutils.alloca_once(builder, word, size=2)
        second = word(1_000_000_000)
        builder.store(builder.sdiv(arguments[0], second), at)
        builder.store(builder.srem(arguments[0], second), builder.gep(at, [small(1)]))
        kind = ir.FunctionType(small, [word.as_pointer(), word.as_pointer()])
        ask = cgutils.get_or_insert_function(builder.module, kind, "nanosleep")
        builder.call(ask, [at, word.as_pointer()(None)])
        return context.get_dummy_value()

    return types.void(types.int64), generate


@compiled
def now() -> int:
    """The monotonic clock [ns]."""
    return int(_monotonic())


@compiled
def pause(nanoseconds: int) -> None:
    """Sleep so long at least; not at all for 0 and less."""
    if nanoseconds > 0:
        _sleep(nanoseconds)


@compiled
def read_some(descriptor: int, into: Bytes, start: int) -> int:
    """Take what has come, without waiting: how many bytes; −1 if none has, −2 if the other side has closed.

    The descriptor must not block.  What is gone (an error of the descriptor) is seen as silence.
    """
    room = into.shape[0] - start
    if room <= 0:
        return 0
    count = _read(descriptor, into[start:].ctypes.data, room)
    return count if count > 0 else (-2 if count == 0 else -1)


@compiled
def write_all(descriptor: int, what: Bytes, count: int) -> bool:
    """Give the first bytes to the system, at once; False if it did not take them all."""
    return _write(descriptor, what.ctypes.data, count) == count


@compiled
def discard(descriptor: int, scratch: Bytes) -> int:
    """Throw away what has come so far; how many bytes that was, −2 if the other side has closed."""
    total = 0
    while True:
        count = read_some(descriptor, scratch, 0)
        if count == -2:
            return -2
        if count <= 0:
            return total
        total += count
