"""A Hapkit, reached over a pseudo-terminal: its frames, and what goes wrong."""

from __future__ import annotations

import random

import pytest
from servo.drive import Driven, drive, drive_into
from servo.emulators.faults import Fault
from servo.emulators.hapkit import HapkitEmulator

from zwidth.errors import InputError
from zwidth.machine.servo.connection import CLOSED, GARBLED, GOOD, REFUSED, SILENT, STALE
from zwidth.machine.servo.devices.hapkit import Hapkit

COUNT = 13e-6


def jumping(exchange: int) -> int:
    """Anywhere in 32 bits, at every exchange somewhere else."""
    return random.Random(exchange).randrange(-(2**31), 2**31)


@pytest.mark.parametrize("count", [COUNT, -COUNT])
def test_two_thousand_exchanges(count: float) -> None:
    """Each position is that of its own exchange; each force comes as it was given, in the counts' sense."""
    with HapkitEmulator(jumping) as board:
        run = drive(Hapkit(board.port, count), 2_000, lambda x: 1e-2 * x)
    assert run.statuses == [GOOD] * 2_000
    assert run.readings == [count * jumping(1 + period) for period in range(2_000)]
    assert board.wrong == 0
    assert board.starts == 1
    sense = 1 if count > 0 else -1
    expected = [max(-32.767, min(32.767, sense * force)) for force in [*run.forces, 0.0, 0.0]]
    assert [command.force for command in board.commands] == pytest.approx(expected, abs=5.01e-4)
    assert [command.exchange for command in board.commands][:-2] == [2 + period for period in range(2_000)]


@pytest.mark.parametrize(
    ("fault", "statuses"),
    [
        (Fault.CLOSED, [CLOSED]),
        (Fault.HALF_FRAME, [GARBLED, GARBLED]),
        (Fault.GARBAGE, [GARBLED, GARBLED]),
        (Fault.SILENCE, [SILENT, SILENT]),
        (Fault.WRONG_CHECKSUM, [GARBLED, GARBLED]),
        (Fault.LATE_ANSWERS, [SILENT, STALE]),
    ],
)
def test_a_fault_is_told_and_ends_in_no_force(fault: Fault, statuses: list[int]) -> None:
    """At the first bad exchange; the last force of all is 0."""

    def attempt(wait: float) -> tuple[HapkitEmulator, Driven]:
        with HapkitEmulator(jumping, fault, at=51) as board:
            return board, drive(Hapkit(board.port, COUNT), 200, wait=wait)

    board, run = drive_into([GOOD] * 50 + statuses, attempt)
    assert run.statuses == [GOOD] * 50 + statuses
    assert run.zeroed_after is not None
    assert run.zeroed_after <= 1
    if fault is not Fault.CLOSED:
        assert board.commands[-1].force == 0.0
        assert board.commands[-3].force == 0.0  # before those of leaving the loop and of closing


@pytest.mark.parametrize("fault", [Fault.DUPLICATE, Fault.SLOW])
def test_answers_that_come_twice_or_in_pieces_are_no_fault(fault: Fault) -> None:
    """No later sample is old by them."""
    with HapkitEmulator(jumping, fault, at=20) as board:
        run = drive(Hapkit(board.port, COUNT), 1000)
    assert set(run.statuses) == {GOOD}
    assert run.readings == [COUNT * jumping(1 + period) for period in range(1000)]


def test_bytes_that_mean_nothing_before_an_answer_are_passed_over() -> None:
    """Even where they begin as an answer does."""

    class Noisy(HapkitEmulator):
        def write(self, data: bytes) -> None:
            """A first byte of a frame, and others."""
            super().write(b"\x5a\x5a\x01" + data)

    with Noisy(jumping) as board:
        run = drive(Hapkit(board.port, COUNT), 300)
    assert set(run.statuses) == {GOOD}
    assert run.readings == [COUNT * jumping(1 + period) for period in range(300)]


def test_a_board_that_has_cut_its_force_ends_the_run() -> None:
    """It tells so with the next position."""
    with HapkitEmulator(jumping) as board:
        board.cut_at = 11
        run = drive(Hapkit(board.port, COUNT), 50)
    assert run.statuses == [GOOD] * 10 + [REFUSED]
    assert run.zeroed_after == 0


def test_a_board_that_starts_slowly_is_asked_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """Opening the port resets most boards: the first questions are lost."""
    monkeypatch.setattr("zwidth.machine.servo.devices.hapkit._ONE_TRY", 0.2e9)

    class Booting(HapkitEmulator):
        deaf = 1

        def hear(self, data: bytes) -> None:
            """Not at first."""
            if self.deaf:
                self.deaf -= 1
            else:
                super().hear(data)

    with Booting(jumping) as board:
        run = drive(Hapkit(board.port, COUNT), 3)
    assert run.statuses == [GOOD] * 3


def test_a_closed_line_is_refused_when_it_is_opened() -> None:
    """With the sketch and the rate to look at."""
    with (
        HapkitEmulator(fault=Fault.CLOSED) as board,
        pytest.raises(InputError, match=r"other side has closed.*examples/hapkit"),
    ):
        Hapkit(board.port, COUNT).open(1e-3)


@pytest.mark.parametrize(
    ("count", "baud", "message"),
    [(0.0, 1_000_000, "not 0"), (float("nan"), 1_000_000, "not 0"), (COUNT, 0, "baud is a whole number")],
)
def test_what_is_no_hapkit_is_refused(count: float, baud: int, message: str) -> None:
    """Before anything is opened."""
    with pytest.raises(InputError, match=message):
        Hapkit("/dev/null", count, baud=baud)


@pytest.mark.parametrize(
    ("baud", "period", "message"),
    [(115_200, 1e-3, "1.39 ms, more than half"), (1_000_000, 10e-3, "below 10 ms")],
)
def test_a_rate_that_the_line_or_the_watchdog_forbids(baud: int, period: float, message: str) -> None:
    """By arithmetic: (7 + 9) bytes of 10 bits; two periods within 20 ms."""
    with pytest.raises(InputError, match=message):
        Hapkit("/dev/null", COUNT, baud=baud).open(period)
