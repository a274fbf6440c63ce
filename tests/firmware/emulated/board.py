"""A sketch on the Hapkit's board, by simavr: the handle's position in; pulse widths, the line's bytes out."""

from __future__ import annotations

import ctypes
from functools import cache
from math import floor, sin
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from firmware.emulated.built import called
from firmware.emulated.required import require

PERIOD = 16_000
"""Cycles of a sample of 1 ms."""

SPAN, START = 980, 700
"""Counts from one jump of the sensor's sawtooth to the next; its reading where the sketch begins."""

FULL_FORCE = 0.03 * 0.075 / (0.070 * 0.004191)
"""At the handle, with a pulse width of 255 [N]: the motor's torque over the sketch's radii."""


class Board:
    """Just switched on. What goes over the line is in `line` when it is closed."""

    def __init__(self, sketch: Path, line: Path) -> None:
        self._library = _library()
        self._board = self._library.board_open(str(sketch).encode(), str(line).encode())
        assert self._board
        self.at = np.zeros(2, np.uint64)
        """Where the last sample began, and where the chip is now [cycles]."""

    def __enter__(self) -> Board:
        return self

    def __exit__(self, *_: object) -> None:
        self._library.board_close(self._board)

    def run(self, counts: int, until: int) -> bool:
        """With the handle there, to the end of a sample, or to a cycle: whether there was a sample."""
        reading = (START + counts) % SPAN
        found = self._library.board_run(self._board, reading, until, self.at.ctypes.data)
        assert found >= 0, "the program ended"
        return bool(found)

    def swing(self, milliseconds: int) -> list[tuple[int, int, int]]:
        """To this time. Of each sample: the cycles it began and ended at, and the pulse width then.

        The handle goes into the wall and out, at 6 mm/s and more, over a jump of the sensor.
        """
        rows, end = [], milliseconds * PERIOD
        while self.at[1] < end:
            if self.run(floor(-400 * sin(12e-3 * self.at[1] / PERIOD)), end):
                rows.append((*map(int, self.at), self.width))
        return rows

    def deaf(self, until: int) -> None:
        """No interrupt is answered before this cycle."""
        self._library.board_deaf(self._board, until)

    def hang(self) -> None:
        self._library.board_hang(self._board)

    @property
    def width(self) -> int:
        """Of the pulses, of 255."""
        return int(self._library.board_width(self._board))

    @property
    def force(self) -> float:
        """Of the motor at the handle [N], > 0 out of the wall."""
        return FULL_FORCE * (self.width / 255) ** 2


@cache
def _library() -> Any:
    require("avr")
    with TemporaryDirectory(prefix="zwidth-board-") as folder:
        library = Path(folder) / "avr_board.so"
        strict = ("-std=gnu99", "-O2", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC")
        called(["gcc", *strict, str(Path(__file__).parent / "avr_board.c"), "-o", str(library), "-lsimavr"])
        loaded = ctypes.CDLL(str(library))
    pointer = ctypes.c_void_p
    loaded.board_open.restype = pointer
    loaded.board_open.argtypes = [ctypes.c_char_p, ctypes.c_char_p]
    loaded.board_run.argtypes = [pointer, ctypes.c_int, ctypes.c_uint64, pointer]
    loaded.board_deaf.argtypes = [pointer, ctypes.c_uint64]
    for name in ("board_close", "board_hang", "board_width"):
        getattr(loaded, name).argtypes = [pointer]
    return loaded
