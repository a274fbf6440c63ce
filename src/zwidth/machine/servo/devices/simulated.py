"""A simulated device in a scripted hand, moved on exactly, at the times at which the loop really ran.

What `zwidth.simulate` computes in one go is computed here sample by sample: where sample k was taken ε_k late
the plant has moved for so long, and a sample that was missed is one.  So a served touch, simulated again with
the lateness that was recorded, gives the same numbers, to the last bit.

The script of the hand goes by the samples: its force in interval k, where its anchor is at sample k.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from zwidth.errors import InputError
from zwidth.loop.kernel import Hand, apply_due, in_interval, packed_plant, travel
from zwidth.loop.law import measured
from zwidth.loop.plant import (
    ACTUATOR_WORK,
    COULOMB,
    HAND_LOSS,
    HAND_WORK,
    POSITION,
    SOURCE_WORK,
    STATE_SIZE,
    VELOCITY,
    VISCOUS,
    WORK,
)
from zwidth.loop.setup import Setup, prepare
from zwidth.loop.two_bodies import INSIDE_LOSS, MOTOR, MOTOR_VELOCITY, SERIES_OF_TWO, STATE_OF_TWO, packed_two
from zwidth.loop.two_masses_run import travel_two
from zwidth.machine.servo.connection import (
    CLOSED,
    FORCE,
    GOOD,
    INDEX,
    OWN,
    READING,
    TIME,
    TOLD,
    CompiledConnection,
    Opened,
    blank,
    exchanged,
    seconds_of,
)
from zwidth.machine.servo.posix import Bytes
from zwidth.model.device.amplifier import Amplifier
from zwidth.model.device.device import Device
from zwidth.model.environment import Wall
from zwidth.model.operator.operator import LinearHand, Operator, Signals
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import RealLike
from zwidth.quantity.text import shown

if TYPE_CHECKING:
    from zwidth.model.operator.operator import Signal

_PLANT, _TWO = 9, 22
"""Numbers of a `loop.plant.Plant`, and of `loop.two_masses.TwoMasses`."""

# What it remembers, from OWN on: the samples of its script, T, delay, resolution and phase of the encoder;
# the sample and time that the plant has been moved to, how many commands are on the way, room for how many;
# how long the force, the anchor and the prescribed position of the script are; 1 where they are two masses.
(
    SAMPLES, STEP, DELAY, COUNT, SHIFT, LAST, CLOCK, WAITING, ROOM, FORCES, ANCHORS, TARGETS, TWO,
) = range(OWN, OWN + 13)  # fmt: skip
ARRAYS = OWN + 13
"""Behind them: plant, state, scratch; commands and the times at which they are applied; the script."""


@compiled
def _send(s: Array, commands: Array, times: Array, t: float, command: float) -> None:
    waiting = int(s[WAITING])
    if waiting < commands.shape[0]:  # when nobody measures any more the last forces go nowhere
        commands[waiting], times[waiting] = command, t + s[DELAY]
        s[WAITING] = waiting + 1


@compiled
def _missed(s: Array, commands: Array, times: Array, j: int) -> None:
    """At a missed sample the command is the one before."""
    _send(s, commands, times, j * s[STEP], -s[FORCE])


@compiled
def _through(
    s: Array,
    state: Array,
    numbers: Array,
    hand: Hand,
    end: float,
    commands: Array,
    times: Array,
    arrivals: Array,
    work: Array,
) -> None:
    """One interval, from the time that the plant is at to `end`, with the commands that fall into it."""
    start = s[CLOCK]
    h, waiting = end - start, int(s[WAITING])
    room = arrivals[: 2 * waiting].reshape((2, waiting))
    for i in range(waiting):
        inside, into = times[i] < end, times[i] - start
        late = inside and into >= h  # by rounding only: it is applied when the next interval begins
        room[0, i] = 0.0 if inside and not late else 1.0
        room[1, i] = into
        if late:
            times[i] = end
    due = apply_due(state, packed_plant(numbers[:_PLANT]), 0, 0, 0.0, 0, 0.0, room, commands)
    if s[TWO] > 0.0:
        two = packed_two(numbers)
        due = travel_two(state, two, hand, 0.0, h, 0.0, h, False, due, 0, 0, 0.0, room, commands, work)
    else:
        plant = packed_plant(numbers)
        due = travel(state, plant, hand, 0.0, h, h, due, 0, 0, 0.0, room, commands, work)
    for i in range(due, waiting):
        commands[i - due], times[i - due] = commands[i], times[i]
    s[WAITING] = waiting - due
    s[CLOCK] = end


@compiled
def _bodies(s: Array) -> tuple[int, int, int]:
    """Where the numbers of the bodies, their state and the scratch end."""
    if s[TWO] > 0.0:
        return ARRAYS + _TWO, ARRAYS + _TWO + STATE_OF_TWO, ARRAYS + _TWO + STATE_OF_TWO + SERIES_OF_TWO
    return ARRAYS + _PLANT, ARRAYS + _PLANT + STATE_SIZE, ARRAYS + _PLANT + STATE_SIZE + WORK


@exchanged
def _measure(s: Array, inbox: Bytes, outbox: Bytes) -> int:
    """Move the plant to the time of this sample and read the encoder."""
    body, own, at = _bodies(s)
    numbers, state, work = s[ARRAYS:body], s[body:own], s[own:at]
    room = int(s[ROOM])
    commands, times, arrivals = (
        s[at : at + room],
        s[at + room : at + 2 * room],
        s[at + 2 * room : at + 4 * room],
    )
    at += 4 * room
    force = s[at : at + int(s[FORCES])]
    at += int(s[FORCES])
    anchor = s[at : at + int(s[ANCHORS])]
    at += int(s[ANCHORS])
    target = s[at : at + int(s[TARGETS])]
    switch = s[0:0]
    k = int(s[INDEX])
    if k > s[SAMPLES]:
        return CLOSED
    for j in range(int(s[LAST]), k):
        end = s[TIME] if j + 1 == k else (j + 1) * s[STEP]
        if j > s[LAST]:
            _missed(s, commands, times, j)
        hand = in_interval(j, end - s[CLOCK], False, state[POSITION], force, anchor, target, switch)
        _through(s, state, numbers, hand, end, commands, times, arrivals, work)
    s[LAST] = k
    place = state[POSITION]
    if s[TWO] > 0.0:
        two, twist = packed_two(numbers), state[MOTOR] - state[POSITION]
        place = place if two.sensed > 0.0 else state[MOTOR]
        s[TOLD + 8], s[TOLD + 9] = state[MOTOR], state[MOTOR_VELOCITY]
        s[TOLD + 10], s[TOLD + 11] = 0.5 * two.spring * twist * twist, state[INSIDE_LOSS]
    s[READING] = measured(place, s[COUNT], s[SHIFT])
    s[TOLD], s[TOLD + 1] = state[POSITION], state[VELOCITY]
    s[TOLD + 2], s[TOLD + 3] = state[HAND_WORK], state[ACTUATOR_WORK]
    s[TOLD + 4], s[TOLD + 5] = state[VISCOUS], state[COULOMB]
    s[TOLD + 6], s[TOLD + 7] = state[SOURCE_WORK], state[HAND_LOSS]
    return GOOD


@exchanged
def _apply(s: Array, inbox: Bytes, outbox: Bytes) -> int:
    """Give the force to the amplifier: it comes after the delay."""
    at, room = _bodies(s)[2], int(s[ROOM])
    _send(s, s[at : at + room], s[at + room : at + 2 * room], s[TIME], -s[FORCE])
    return GOOD


@dataclass(frozen=True, kw_only=True)
class Scripted(Operator):
    """A hand that does at sample k what another does at kT [s], whenever the sample is taken."""

    operator: Operator
    period: float

    @property
    def hand(self) -> LinearHand:
        return self.operator.hand

    @property
    def kinematic(self) -> bool:
        return self.operator.kinematic

    @property
    def initial_position(self) -> float:
        return self.operator.initial_position

    @property
    def start_is_chosen(self) -> bool:
        return self.operator.start_is_chosen

    def starting_at(self, position: float) -> Operator:
        return replace(self, operator=self.operator.starting_at(position))

    def signals(self, times: Signal) -> Signals:
        return self.operator.signals(np.arange(len(times)) * np.float64(self.period))

    def describe(self, motion: str = "linear") -> str:
        return self.operator.describe(motion)


@dataclass(frozen=True, kw_only=True, eq=False)
class Simulated(CompiledConnection):
    """The device itself, simulated, held by a hand.

    Parameters
    ----------
    device
        With a mass; every number certain.
    hand
        What holds it, see `zwidth.operators`.
    duration
        How long its script is [s]; after it the connection closes.
    encoder_phase
        φ in Δ floor(x/Δ + φ), 0 ≤ φ < 1 [counts].
    amplifier
        See `zwidth.amplifiers`; by default as of `zwidth.simulate`.

    Raises
    ------
    InputError
        If device or hand cannot be simulated.
    """

    device: Device
    hand: Operator
    duration: RealLike
    encoder_phase: float = 0.0
    amplifier: Amplifier | None = None

    measure: ClassVar[Any] = _measure
    apply: ClassVar[Any] = _apply
    met_hardware: ClassVar[bool] = False

    def __post_init__(self) -> None:
        if not isinstance(self.device, Device):
            raise InputError(f"the device is a zwidth.Device, got {type(self.device).__name__}")
        object.__setattr__(self, "motion", self.device.motion)
        x = "rad" if self.device.motion == "rotary" else "m"
        energies = ("hand_work", "actuator_work", "viscous_loss", "coulomb_loss", "hand_source_work")
        told = [f"{name}_J" for name in (*energies, "hand_damper_loss")]
        if self.device.transmission is not None:
            told += [f"motor_position_{x}", f"motor_velocity_{x}_per_s", "transmission_energy_J"]
            told.append("transmission_loss_J")
        object.__setattr__(self, "tells", (f"true_position_{x}", f"true_velocity_{x}_per_s", *told))
        object.__setattr__(self, "duration", seconds_of(self.duration))
        self.setup()

    def setup(self) -> Setup:
        """The loop without a law, laid out as by `zwidth.simulate`."""
        return prepare(
            self.device,
            Wall(stiffness=0),
            self.hand,
            self.duration,
            encoder_phase=self.encoder_phase,
            amplifier=self.amplifier,
            flexible=True,
        )

    @property
    def scripted(self) -> Scripted:
        """The hand as it is served, for `zwidth.simulate`: it goes by the samples, however late they are."""
        return Scripted(operator=self.hand, period=float(self.device.exact("sample_period")))

    @property
    def samples(self) -> int:
        """N, of its script: samples 0 … N are taken."""
        return self.setup().frame.samples

    @property
    def on_silence(self) -> str:
        """It is asked by the loop that it is in."""
        return "it goes on with the force it has: it is simulated in the loop itself"

    def open(self, sample_period: float) -> Opened:
        """The device at the start of the script.

        Raises
        ------
        InputError
            If it is served at another period than its own.
        """
        setup = self.setup()
        frame, (force, anchor, target, switch) = setup.frame, setup.frame.optional()
        if sample_period != float(frame.period):
            raise InputError(
                f"the simulated device has a sample period of {shown(frame.period, 's', 6)} and is served at "
                f"{shown(sample_period, 's', 6)}: delay and hand are of its own period; change the device"
            )
        if switch.size:
            raise InputError(
                "a motion with switch positions needs a regular clock, and a served loop has the one of this "
                "machine: replay it by zwidth.simulate"
            )
        room = frame.late + 4
        numbers, work = (setup.plant_numbers, WORK) if setup.two is None else (setup.two, SERIES_OF_TWO)
        parts = (numbers, setup.state, np.zeros(work + 4 * room), force, anchor, target)
        opened = blank(ARRAYS - OWN + sum(part.size for part in parts), 1, 1)
        s = opened.memory
        s[SAMPLES], s[STEP], s[DELAY] = frame.samples, float(frame.period), float(self.device.exact("delay"))
        s[COUNT], s[SHIFT], s[ROOM] = frame.resolution, setup.encoder_phase, room
        s[FORCES], s[ANCHORS], s[TARGETS] = force.size, anchor.size, target.size
        s[TWO] = float(setup.two is not None)
        s[ARRAYS:] = np.concatenate(parts)
        return opened

    def close(self) -> None:
        """Nothing was taken."""

    def describe(self) -> str:
        """The device and its hand."""
        kind = self.hand.describe(self.device.motion).partition(",")[0]
        return f"the simulated {self.device.name} (hand: {kind})"
