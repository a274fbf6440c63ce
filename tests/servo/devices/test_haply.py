"""A Haply board, reached over a pseudo-terminal: its frames, its kinematics, and what goes wrong."""

import math
import random

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from servo.drive import drive, drive_into
from servo.emulators.faults import Fault
from servo.emulators.haply import BASE, INNER, OUTER, HaplyEmulator, angles_of

from zwidth.errors import InputError
from zwidth.machine.servo.connection import CLOSED, GARBLED, GOOD, SILENT
from zwidth.machine.servo.devices.haply import HaplyJoint, HaplyMotor, HaplyPantograph, locate

ARMS = np.array([INNER, OUTER, BASE])

COUNT = 2e-4
"""No count of an encoder is more at the tip, where these tests have it [m]."""

places = st.tuples(st.floats(-0.03, 0.07), st.floats(0.06, 0.12))


def jumping(exchange):
    """Somewhere else at every exchange: an answer to another question is seen at once."""
    draw = random.Random(exchange)
    return draw.uniform(-0.02, 0.06), draw.uniform(0.07, 0.11)


@given(place=places)
def test_the_tip_is_where_the_angles_of_the_other_road_put_it(place):
    """The law of cosines gives the angles of a place; they give the place again."""
    first, second = map(math.radians, angles_of(*place))
    found = np.zeros(6)
    assert locate(first, second, ARMS, found)
    assert found[:2] == pytest.approx(place, abs=1e-12)


@given(place=places)
def test_the_change_with_the_angles_is_that_of_differences(place):
    angles = np.radians(angles_of(*place))
    found, ahead, back = np.zeros(6), np.zeros(6), np.zeros(6)
    locate(*angles, ARMS, found)
    for joint in range(2):
        step = np.eye(2)[joint] * 1e-6
        locate(*(angles + step), ARMS, ahead)
        locate(*(angles - step), ARMS, back)
        expected = (ahead[:2] - back[:2]) / 2e-6
        assert found[2 + 2 * joint : 4 + 2 * joint] == pytest.approx(expected, rel=1e-5, abs=1e-8)


@pytest.mark.parametrize("angles", [(math.pi, 0.0), (0.0, math.pi / 2), (math.nan, 1.0), (math.inf, 1.0)])
def test_arms_that_cannot_meet_are_told(angles):
    far = np.array([0.07, 0.03, 0.038])
    assert not locate(*angles, far, np.zeros(6))


def test_the_setup_is_what_the_firmware_reads():
    with HaplyEmulator() as board:
        drive(HaplyPantograph(board.port), 1, lambda x: 0.0)
    assert board.resets == 1
    assert (board.motors, board.encoders) == (b"\1\1", b"\1\1")
    assert board.setup == (12.0, 4880.0, 168.0, 4880.0)
    assert {command.force for command in board.commands} == {0.0}


@pytest.mark.parametrize(("axis", "periods"), [("x", 1000), ("y", 500)])
def test_two_thousand_exchanges(axis, periods):
    """Each position is that of its own exchange; two exchanges a period, since to give a force is one too."""
    with HaplyEmulator(jumping) as board:
        run = drive(HaplyPantograph(board.port, axis), periods, lambda x: 0.0)
    assert run.statuses == [GOOD] * periods
    assert board.exchange == 2 * periods + 3
    expected = [jumping(1 + 2 * period)["xy".index(axis)] for period in range(periods)]
    assert run.readings == pytest.approx(expected, abs=COUNT)


@pytest.mark.parametrize("of", ["x", "y"])
@pytest.mark.parametrize("axis", ["x", "y"])
@pytest.mark.parametrize(("place", "force"), [((0.01, 0.08), 1.5), ((0.04, 0.1), -0.7)])
def test_the_torques_are_those_of_a_force_along_the_axis(place, force, axis, of):
    """As the board's side finds it from its own kinematics; along the other axis there is none."""
    with HaplyEmulator(lambda exchange: place, axis=of) as board:
        drive(HaplyPantograph(board.port, axis), 3, lambda x: force)
    given = [command.force for command in board.commands]
    if of != axis:
        assert given == pytest.approx([0.0] * len(given), abs=1e-2)
        return
    assert given[:2] == [0.0, 0.0]  # of opening, and of the first question
    assert given[2] == pytest.approx(force, rel=5e-3)  # the angles are in whole counts
    assert given[-1] == 0.0


def test_a_question_repeats_the_force():
    """To read is to give torques as well: those that act already."""
    forces = iter([1.0, 2.0, 3.0, 4.0])
    with HaplyEmulator() as board:
        drive(HaplyPantograph(board.port), 4, lambda x: next(forces))
    given = [round(command.force, 1) for command in board.commands]
    assert given == [0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 0.0, 0.0]


TOLD = {Fault.CLOSED: CLOSED, Fault.HALF_FRAME: GARBLED, Fault.GARBAGE: GARBLED}
TOLD |= {Fault.SILENCE: SILENT, Fault.LATE_ANSWERS: SILENT}


@pytest.mark.parametrize(("fault", "status"), TOLD.items())
@pytest.mark.parametrize("of_force", [False, True])
def test_a_fault_is_told_and_ends_in_no_force(fault, status, of_force):
    """Whether it begins with the answer to a question, or with that to a force."""
    period = 50
    expected = [GOOD] * (period + of_force) + [status]

    def attempt(wait):
        with HaplyEmulator(jumping, fault, at=1 + 2 * period + of_force) as board:
            return board, drive(HaplyPantograph(board.port), 200, wait=wait)

    board, run = drive_into(expected, attempt)
    assert run.statuses[: len(expected)] == expected
    assert run.zeroed_after in (0, 1)
    if fault is not Fault.CLOSED:
        assert board.commands[-1].force == 0.0


def test_one_motor_has_its_angle_and_its_torque():
    with HaplyEmulator(lambda exchange: (0.02, 0.1)) as board:
        motor = HaplyMotor(board.port, 36000.0, offset=math.pi / 2, rotation="cw", motor="ccw")
        run = drive(motor, 5, lambda angle: 0.25)
    assert run.readings == pytest.approx([math.radians(angles_of(0.02, 0.1)[0])] * 5, abs=2 * math.pi / 36000)
    assert (board.motors, board.encoders, board.setup) == (b"\1", b"\0", (90.0, 36000.0))
    assert board.commands[-3].force == 0.25
    assert motor.motion == "rotary"


@pytest.mark.parametrize(
    "arguments",
    [(3, "ccw", 0.0, 4880.0), (1, "left", 0.0, 4880.0), (1, "cw", 0.0, 0.0), (1, "cw", math.nan, 1.0)],
)
def test_what_is_no_joint_is_refused(arguments):
    with pytest.raises(InputError):
        HaplyJoint(*arguments)
