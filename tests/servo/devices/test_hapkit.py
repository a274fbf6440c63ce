"""A Hapkit, reached over a pseudo-terminal: its frames, and what goes wrong."""

import random

import pytest
from servo.drive import drive
from servo.emulators.hapkit import HapkitEmulator

from zwidth.machine.servo.connection import GOOD, REFUSED
from zwidth.machine.servo.devices.hapkit import Hapkit

COUNT = 13e-6


def jumping(exchange):
    """Anywhere in 32 bits, at every exchange somewhere else."""
    return random.Random(exchange).randrange(-(2**31), 2**31)


@pytest.mark.parametrize("count", [COUNT, -COUNT])
def test_two_thousand_exchanges(count):
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


def test_bytes_that_mean_nothing_before_an_answer_are_passed_over():
    class Noisy(HapkitEmulator):
        def write(self, data):
            super().write(b"\x5a\x5a\x01" + data)

    with Noisy(jumping) as board:
        run = drive(Hapkit(board.port, COUNT), 300)
    assert set(run.statuses) == {GOOD}
    assert run.readings == [COUNT * jumping(1 + period) for period in range(300)]


def test_a_board_that_has_cut_its_force_ends_the_run():
    with HapkitEmulator(jumping) as board:
        board.cut_at = 11
        run = drive(Hapkit(board.port, COUNT), 50)
    assert run.statuses == [GOOD] * 10 + [REFUSED]
    assert run.zeroed_after == 0


def test_a_board_that_starts_slowly_is_asked_again(monkeypatch):
    """Opening the port resets most boards: the first questions are lost."""
    monkeypatch.setattr("zwidth.machine.servo.devices.hapkit._ONE_TRY", 0.2e9)

    class Booting(HapkitEmulator):
        deaf = 1

        def hear(self, data):
            if self.deaf:
                self.deaf -= 1
            else:
                super().hear(data)

    with Booting(jumping) as board:
        run = drive(Hapkit(board.port, COUNT), 3)
    assert run.statuses == [GOOD] * 3
