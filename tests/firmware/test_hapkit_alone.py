"""The sketch of a Hapkit without a computer, compiled here: its registers are variables of the test."""

from __future__ import annotations

import ctypes
import math
import shutil
from pathlib import Path

import pytest
from firmware.emulated.required import tool
from firmware.tools import DATA, MAINS, NEWTONS, STUBS, WARNINGS, run
from firmware.written_packets import unpacked

WAITING, SERVING, ENDED = range(3)
LATE, WATCHDOG = 5, 6


class Board:
    """Just switched on; its handle stands where the sensor reads 500."""

    def __init__(self, library: Path, marked: bool = False) -> None:
        copy = library.with_name(f"{library.stem}-{len(list(library.parent.iterdir()))}.so")
        shutil.copy(library, copy)  # loaded anew: its variables are as at the start
        self.board = ctypes.CDLL(str(copy))
        self.reading = 500
        self.board.board_sense(500)
        if marked:
            self.board.board_mark()
        self.board.board_begin()

    def sample(self, change: int = 0, late: bool = False) -> None:
        self.reading = (self.reading + change) % 980
        self.board.board_sense(self.reading)
        self.board.board_sample(late)

    def go(self, *ways: int) -> None:
        """So many counts in steps that the handle can go, and so many more."""
        for counts in ways:
            for _ in range(abs(counts) // 50):
                self.sample(50 if counts > 0 else -50)
            self.sample(int(math.copysign(abs(counts) % 50, counts)))

    @property
    def motor(self) -> tuple[int, int]:
        return self.board.board_width(), self.board.board_level()

    @property
    def phase(self) -> int:
        return self.board.board_phase()

    def sent(self) -> bytes:
        found = bytearray()
        while (byte := self.board.board_idle()) >= 0:
            found.append(byte)
        return bytes(found)


@pytest.fixture(scope="module", params=list(NEWTONS))
def kind(request: pytest.FixtureRequest) -> int:
    return int(request.param)


@pytest.fixture(scope="module")
def library(kind: int, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("board") / "hapkit.so"
    include = ["-I", STUBS / "board", "-I", DATA, "-I", MAINS / "shared"]
    options = [f"-DLAW_KIND={kind}", "-DF_CPU=16000000UL", "-O1", "-shared", "-fPIC"]
    sketch, board = MAINS / "arduino" / "hapkit.ino", STUBS / "board" / "board.cpp"
    files = ["-x", "c++", "-include", "Arduino.h", sketch, board]
    run(tool("c++"), "-std=gnu++11", *WARNINGS, *options, *include, *files, "-o", path)
    return path


@pytest.fixture
def board(library: Path) -> Board:
    return Board(library)


def test_without_a_wall_there_is_no_pulse(board: Board) -> None:
    """Outside nothing acts, and the timer's output is off: at width 0 it would still give a short one."""
    board.go(-300)
    assert board.phase == SERVING
    assert board.motor[0] == 0


@pytest.mark.parametrize("counts", [8, 40, 160, 300])
def test_the_pulse_width_is_that_of_the_torque(board: Board, kind: int, counts: int) -> None:
    """By hand: τ = F r_h r_p/r_s, width √(τ/0.03 N·m) of 255; towards smaller counts."""
    board.go(-50, 50 + counts)
    for _ in range(3):
        board.sample()
    torque = NEWTONS[kind] * counts * 0.07 * 0.004191 / 0.075
    width, level = board.motor
    assert level == 0
    assert width == pytest.approx(255 * math.sqrt(torque / 0.03), abs=0.51)


def test_positions_go_on_where_the_sensor_jumps(board: Board) -> None:
    board.go(-50, -2000, 2050)
    for _ in range(2):
        board.sample()
    assert board.motor[0] == 0
    assert board.phase == SERVING
    assert board.board.board_counts() == 0


def test_one_wild_reading_is_passed_over(board: Board) -> None:
    board.go(-10, 100)
    before = board.motor
    board.sample(-300)
    assert board.motor == before
    board.sample(300)
    assert board.phase == SERVING


def test_a_sample_that_takes_longer_than_its_period_ends_the_force(board: Board) -> None:
    board.go(100, -150, 150)
    assert board.motor[0] > 0
    board.sample(late=True)
    assert board.motor[0] == 0
    board.sample()
    assert (board.phase, board.board.board_reason()) == (ENDED, LATE)
    assert board.motor[0] == 0


def test_after_a_start_by_the_watchdog_there_is_no_force(library: Path) -> None:
    """The mark that outlives it says that a force acted; the start after that one begins anew."""
    board = Board(library, marked=True)
    board.go(-50, 150)
    assert (board.phase, board.board.board_reason()) == (ENDED, WATCHDOG)
    assert board.motor[0] == 0
    assert board.board.board_marked() == 0
    fresh = Board(library)
    fresh.sample()
    assert fresh.board.board_marked() == 1


def test_the_timer_and_the_line_are_set_for_the_law(board: Board) -> None:
    """16 000 clocks of 16 MHz in a period of 1 ms; 115 200 Bd to 2.1 %; the watchdog runs."""
    assert board.board.board_period() == 16_000 - 1
    assert 16e6 / (8 * (board.board.board_baud_divisor() + 1)) == pytest.approx(115_200, rel=0.0213)
    assert board.board.board_watchdog() == 1


def test_every_sample_is_told(board: Board) -> None:
    data = b""
    for _ in range(100):
        board.sample(-1)
        data += board.sent()
    texts, found = unpacked(data)
    assert len(texts) == 1
    assert [row[1] for row in found] == [1000 * k for k in range(96)]
    assert [row[2] for row in found] == [-k - 1 for k in range(96)]
