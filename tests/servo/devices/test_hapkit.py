"""A Hapkit's line, and the sketch of examples/hapkit, compiled here: frames, sensor, motor, cut force."""

import binascii
import math
import os
import struct

import pytest
from servo.drive import drive
from servo.emulators.hapkit import COMPILER, HapkitEmulator, Sketch, SketchEmulator, compiled

from zwidth.machine.servo.connection import GOOD, REFUSED
from zwidth.machine.servo.devices.hapkit import Hapkit

COUNT = 13e-6
SPAN = 980
START, ASK, FORCE = 1, 2, 3


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    if COMPILER is None and not os.environ.get("ZWIDTH_EVERY_TARGET"):
        pytest.skip("c++ is not on this machine")
    return compiled(tmp_path_factory.mktemp("sketch"))


def frame(kind, number=0, millinewtons=0):
    """To the board, as the head of the sketch has it."""
    body = struct.pack("<BBBh", 0xA5, kind, number, millinewtons)
    return body + struct.pack("<H", binascii.crc_hqx(body, 0xFFFF))


def asked(sketch, data):
    """The number, the state and the counts of its one answer."""
    sketch.hear(data)
    sketch.turn()
    answer = sketch.told()
    mark, number, state, counts, total = struct.unpack("<BBBiH", answer)
    assert (mark, total) == (0x5A, binascii.crc_hqx(answer[:7], 0xFFFF))
    return number, state, counts


@pytest.fixture
def sketch(library):
    """A board that was told to start."""
    board = Sketch(library)
    asked(board, frame(START))
    return board


def forced(sketch, millinewtons, ticks=10):
    sketch.hear(frame(FORCE, 1, millinewtons))
    sketch.turn(ticks)
    return sketch.motor


def test_the_board_is_made_ready_and_gives_no_force_before_a_start(library):
    sketch = Sketch(library)
    assert sketch.motor[0] == 0
    assert sketch.board.board_is_output(5)
    assert sketch.board.board_is_output(8)
    assert sketch.board.board_baud() == 1_000_000  # 16 MHz divides it
    assert forced(sketch, 5000)[0] == 0
    assert asked(sketch, frame(ASK, 7)) == (7, 1, 0)


def test_it_answers_a_start_and_a_question_by_number_and_no_force(library):
    sketch = Sketch(library)
    assert asked(sketch, frame(START, 200)) == (200, 0, 0)
    assert asked(sketch, frame(ASK, 201)) == (201, 0, 0)
    forced(sketch, 100)
    assert sketch.told() == b""


def test_a_start_begins_anew(sketch):
    """The position is 0 there, and the force that acted is gone."""
    sketch.hear(frame(FORCE, 1, 2000))
    sketch.sense(530)
    assert asked(sketch, frame(ASK))[2] == 30
    assert asked(sketch, frame(START))[2] == 0
    assert sketch.motor[0] == 0


def test_a_wrong_frame_is_passed_over_and_the_right_one_in_it_found(sketch):
    """Every single wrong bit is seen; what follows is not lost."""
    right = frame(FORCE, 3, 1234)
    for bit in range(8 * len(right)):
        wrong = bytearray(right)
        wrong[bit // 8] ^= 1 << bit % 8
        sketch.hear(bytes(wrong))
        sketch.turn()
        assert sketch.motor[0] == 0
    sketch.hear(b"\xa5\xa5\x02" + frame(ASK, 9))
    sketch.turn()
    assert sketch.told()[1] == 9


@pytest.mark.parametrize(("millinewtons", "level"), [(500, 1), (-500, 0), (3000, 1), (-32767, 0)])
def test_the_pulse_width_is_that_of_the_torque(sketch, millinewtons, level):
    """By hand: the motor's torque τ = F r_h r_p/r_s, width √(τ/0.03 N·m) of 255, and no more than that."""
    torque = abs(millinewtons) / 1000 * 0.07 * 0.004191 / 0.075
    assert forced(sketch, millinewtons) == (min(255, round(255 * math.sqrt(torque / 0.03))), level)


@pytest.mark.parametrize("step", [7, -7])
def test_counts_go_on_over_the_jumps_of_the_sensor(library, step):
    sketch = Sketch(library, 500)
    asked(sketch, frame(START))
    before = 500
    for k in range(1, 1000):
        position = 500 + step * k
        if position // SPAN != before // SPAN:
            sketch.sense(SPAN // 2)
            sketch.turn()
        sketch.sense(position % SPAN)
        sketch.turn()
        assert asked(sketch, frame(ASK)) == (0, 0, step * k)
        before = position


def test_force_is_cut_when_nothing_has_come_for_20_ms(sketch):
    """5000 ticks of 4 µs, whatever the timer's count is when they begin; and it stays cut until a start."""
    for _ in range(20):  # the timer has 65536: some of these rounds pass over its end
        asked(sketch, frame(START))
        assert forced(sketch, 2000, ticks=0)[0] > 0
        for _ in range(50):
            sketch.turn(100)
        assert sketch.motor[0] > 0
        sketch.turn(1)
        assert sketch.motor[0] == 0
        assert forced(sketch, 2000, ticks=0)[0] == 0
        assert asked(sketch, frame(ASK, 3))[1] == 1


def test_a_silence_without_force_cuts_nothing(sketch):
    """The host may be long in proving its law."""
    for _ in range(10):
        sketch.turn(60_000)
    assert forced(sketch, 2000, ticks=0)[0] > 0
    assert asked(sketch, frame(ASK))[1] == 0


def test_a_question_keeps_the_force(sketch):
    """Any right frame tells that the host lives."""
    forced(sketch, 2000, ticks=0)
    for _ in range(10):
        sketch.turn(4000)
        asked(sketch, frame(ASK))
    assert sketch.motor[0] > 0


def test_sketch_and_adapter_understand_each_other(library):
    """A handle that moves by 5 counts each exchange, for 2000 of them, over the jumps; force 0 at the end."""
    sketch = Sketch(library, 0)
    with SketchEmulator(sketch, lambda exchange: 5 * exchange % SPAN) as board:
        run = drive(Hapkit(board.port, 1e-5), 2000, lambda x: 1.0)
    assert run.statuses == [GOOD] * 2000
    assert run.readings == pytest.approx([5e-5 * (1 + period) for period in range(2000)])
    full = round(255 * math.sqrt(0.07 * 0.004191 / 0.075 / 0.03))
    assert {command.force for command in board.commands[5:-2]} == {full}
    assert sketch.motor[0] == 0


def test_the_adapter_hears_that_the_sketch_has_cut(library):
    sketch = Sketch(library, 0)

    def reading(exchange):
        if exchange == 30:
            sketch.turn(5001)
        return 0

    with SketchEmulator(sketch, reading) as board:
        run = drive(Hapkit(board.port, 1e-5), 100)
    assert run.statuses == [GOOD] * (len(run.statuses) - 1) + [REFUSED]
    assert 25 < len(run.statuses) < 35


def test_bytes_that_mean_nothing_before_an_answer_are_passed_over():
    class Noisy(HapkitEmulator):
        def write(self, data):
            super().write(b"\x5a\x5a\x01" + data)

    with Noisy(lambda exchange: 5 * exchange) as board:
        run = drive(Hapkit(board.port, COUNT), 300)
    assert set(run.statuses) == {GOOD}
    assert run.readings == [COUNT * (5 * (1 + period)) for period in range(300)]


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

    with Booting() as board:
        run = drive(Hapkit(board.port, COUNT), 3)
    assert run.statuses == [GOOD] * 3
