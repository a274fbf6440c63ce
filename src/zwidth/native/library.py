"""The step functions as they run: called by their names in the library that is built with the package.

A call hands over one row of words: numbers as they are, of an array its address and its shape.  The lock of
Python is not held meanwhile.
"""

from __future__ import annotations

import ctypes
import struct
from collections.abc import Callable
from functools import cache
from importlib import import_module
from typing import Any

import numpy as np

from zwidth.native.build import library
from zwidth.native.names import c_name

_CODES = {"float64": "<f8", "int64": "<i8", "uint8": "|u1"}
_SCALARS = {"f": "d", "i": "q", "b": "q"}


def bound(function: Callable[..., Any]) -> Callable[..., Any] | None:
    """A step function of the library, called with the same arguments; None where there is no library."""
    found = library()
    if found is None:
        return None
    name = c_name(function.__module__, function.__name__)
    if name not in found.table:
        return None
    entry = found.opened[f"zwx_{name}"]
    entry.restype = None
    return _caller(entry, **found.table[name])


def _caller(entry: Any, takes: list[Any], returns: Any) -> Callable[..., Any]:
    """Python that puts the arguments in their row: written out, since the call of a step must cost little."""
    codes, given = "", list[str]()
    space: dict[str, Any] = {
        "pack": struct.pack, "unpack_from": struct.unpack_from, "entry": entry, "array": _array,
        "address": _address, "Spread": _Spread, "gathered": _gathered,
    }  # fmt: skip
    for name, of in takes:
        more, text = _row(of, name)
        codes, given = codes + more, [*given, text]
    back, result = _back(returns, space)
    size = max(len(codes), len(back), 1)
    space["Row"] = ctypes.c_char * (8 * size)
    room = f"{codes}{8 * (size - len(codes))}x"
    lines = [
        f"def call({', '.join(name for name, _ in takes)}):",
        "    try:",
        f"        row = bytearray(pack({', '.join([repr(room), *given])}))",
        "    except Spread:",
        f"        return gathered(call, ({''.join(f'{name}, ' for name, _ in takes)}))",
        "    entry(Row.from_buffer(row))",
    ]
    if back:
        lines += [f"    r = unpack_from({back!r}, row)", f"    return {result}"]
    exec("\n".join(lines), space)
    call: Callable[..., Any] = space["call"]
    return call


def _row(of: Any, name: str) -> tuple[str, str]:
    """Codes of `struct` for an argument, and the Python that gives the words."""
    if isinstance(of, str):
        return _SCALARS[of], f"int({name})" if of == "b" else name
    if "cells" in of:
        return "qqqqq", f"*array({name}, {_CODES[of['cells']]!r})"
    if "asked" in of:
        return "q", f"address({name})"
    parts = [_row(part, f"{name}[{n}]") for n, part in enumerate(of["several"])]
    return "".join(codes for codes, _ in parts), ", ".join(text for _, text in parts)


def _back(of: Any, space: dict[str, Any]) -> tuple[str, str]:
    """The same for what is returned; words of the row from 0 on."""
    codes = ""

    def built(part: Any) -> str:
        nonlocal codes
        if isinstance(part, str):
            codes += _SCALARS[part]
            at = f"r[{len(codes) - 1}]"
            return f"{at} != 0" if part == "b" else at
        inner = ", ".join(built(p) for p in part["several"])
        if not part["class"]:
            return f"({inner},)"
        module, name = part["class"].split(":")
        space[name] = getattr(import_module(module), name)
        return f"{name}({inner})"

    return ("", "") if of == "n" else (codes, text) if (text := built(of)) else ("", "")


class _Spread(Exception):
    """An array whose numbers do not lie one behind the other."""


def _array(given: Any, code: str) -> tuple[int, int, int, int, int]:
    """Address and shape."""
    told = given.__array_interface__
    if told["typestr"] != code:
        raise TypeError(f"a step function takes an array of {code} here, not of {told['typestr']}")
    if told["strides"] is not None:
        raise _Spread
    words = (told["data"][0], *told["shape"], 1, 1, 1)
    return words[:5]


def _gathered(call: Callable[..., Any], given: tuple[Any, ...]) -> Any:
    """The same with copies of such arrays, which are written back."""
    close = [np.ascontiguousarray(g) if isinstance(g, np.ndarray) else g for g in given]
    found = call(*close)
    for own, copy in zip(given, close, strict=True):
        if copy is not own and own.flags.writeable:
            own[...] = copy
    return found


class _Numbers(ctypes.Structure):
    """An array, as C hands it over."""

    _fields_ = (("p", ctypes.c_void_p), ("n", ctypes.c_int64 * 4))


_EXCHANGED = ctypes.CFUNCTYPE(ctypes.c_int64, *[ctypes.POINTER(_Numbers)] * 3)


@cache
def _address(function: Any) -> int:
    """Where a function begins that is handed over: one of the library, or else one that runs in Python."""
    found, plain = library(), function.py_func
    name = c_name(plain.__module__, plain.__name__)
    if found is not None and name in found.table:
        return int(ctypes.c_void_p.in_dll(found.opened, f"zwp_{name}").value or 0)

    def called(*given: Any) -> int:
        return int(plain(*(_seen(g.contents, np.uint8 if n else np.float64) for n, g in enumerate(given))))

    _KEPT.append(_EXCHANGED(called))
    return int(ctypes.cast(_KEPT[-1], ctypes.c_void_p).value or 0)


_KEPT: list[Any] = []
"""Functions in Python that C may call: as long as the process."""


def _seen(given: _Numbers, of: Any) -> Any:
    item = ctypes.c_uint8 if of is np.uint8 else ctypes.c_double
    return np.ctypeslib.as_array((item * given.n[0]).from_address(given.p)) if given.n[0] else np.empty(0, of)
