"""From device, environment, operator and clock to the arrays that the kernel runs on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import ceil, isfinite, sqrt
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from zwidth.errors import InputError
from zwidth.loop import law as laws
from zwidth.loop import two_bodies, two_masses, two_strides
from zwidth.loop.kernel import RECORDED
from zwidth.loop.plant import DIRECTION, POSITION, STATE_SIZE, VELOCITY, WORK, Plant
from zwidth.loop.start import rest_position
from zwidth.loop.timing import Timing
from zwidth.model.device.amplifier import Actuation, Amplifier, CurrentAmplifier
from zwidth.model.device.device import Device, require_rigid
from zwidth.model.device.instead import instead_of_device
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.transfer_function import as_environment
from zwidth.model.operator.operator import Operator, Signals
from zwidth.model.rendering.rendered import laws_of
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.parameter import read_number
from zwidth.quantity.text import in_words, shown

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

MOST_PIECES = 1000
"""Into how many parts a sample may have to be cut for a stiff hand or a quick amplifier."""

MOST_BYTES = 4 << 30
"""A longer record would not fit into the memory of many machines."""

_NONE = np.empty(0)


@dataclass(frozen=True, kw_only=True, eq=False)
class Setup:
    """One loop, ready to run: descriptions for people, arrays for the kernel."""

    device: Device
    environment: Environment
    operator: Operator
    timing: Timing | None
    encoder_phase: float
    law: Array
    memory: Array
    state: Array
    frame: Frame
    plain: bool
    two: Array | None = None  # of `two_bodies`, with a transmission

    @property
    def plant_numbers(self) -> Array:
        """The plant as the kernel reads it."""
        return np.array(self.frame.plant)


def prepare(
    device: Device,
    environment: object,
    operator: Operator,
    duration: RealLike,
    *,
    initial_position: RealLike | None = None,
    initial_velocity: RealLike = 0.0,
    encoder_phase: float = 0.0,
    amplifier: Amplifier | None = None,
    timing: Timing | None = None,
    points_per_sample: int = 1,
    single: bool = False,
    flexible: bool = False,
) -> Setup:
    """Check everything and lay it out; arguments as of `simulate`.

    `single` is of the `LoopContext`; `flexible` allows a transmission.
    """
    law, placed = as_environment(environment, device=device), initial_position is not None
    laid = laid_out(
        device, law, operator, duration, {}, placed=placed, amplifier=amplifier, timing=timing,
        points_per_sample=points_per_sample, single=single, flexible=flexible,
    )  # fmt: skip
    start = laid.starts(initial_position, initial_velocity, encoder_phase)
    states, numbers, memories = started([laid], np.array([start]))
    two = two_bodies.numbers_of(device, laid.operator, laid.frame.plant, MOST_PIECES) if flexible else None
    return Setup(
        device=device,
        environment=law,
        operator=laid.operator,
        timing=timing,
        encoder_phase=start[2],
        law=numbers[0],
        memory=memories[0],
        state=states[0] if two is None else two_bodies.state_of(states[0]),
        frame=laid.frame,
        plain=laid.plain,
        two=two,
    )


class Laid(NamedTuple):
    """A loop but for where it starts."""

    operator: Operator
    rest: float
    frame: Frame
    packed: laws.Packed

    @property
    def plain(self) -> bool:
        """True where `runs.run_plain` runs it: free mass, spring, regular clock, one force an interval."""
        f, p, law = self.frame, self.frame.plant, self.packed.numbers
        free = p.stiffness == 0.0 and p.hand_damping == 0.0 and p.lag == 0.0 and p.slew == 0.0
        memoryless = law[laws.SECTIONS] == 1 and law[laws.HEADER] == 0 and law[laws.CHAIN] == 0
        linear = law[laws.CLAMPED] == 0
        clock = f.offset == 0.0 and f.points == 1 and not f.arrivals.size and not f.missed.size
        return bool(free and memoryless and linear and clock and f.signals.position is None)

    def starts(
        self, position: RealLike | None, velocity: RealLike, phase: float
    ) -> tuple[float, float, float]:
        """The same, checked; without a position the one where it rests.

        Raises
        ------
        InputError
            If it cannot start so.
        """
        part = _number(phase, "encoder_phase")
        if not 0 <= part < 1:
            raise InputError(f"encoder_phase is a part of one count, 0 ≤ phase < 1, got {part:g}")
        if self.operator.kinematic and (position is not None or velocity != 0.0):
            raise InputError(
                "a prescribed motion says itself where it starts: leave initial_position and "
                "initial_velocity out"
            )
        place = self.rest if position is None else read_number(position, "position", "initial_position")
        return float(place), float(read_number(velocity, "velocity", "initial_velocity")), part


def laid_out(
    device: Device,
    law: Environment,
    operator: Operator,
    duration: RealLike,
    known: dict[Any, Any],
    *,
    placed: bool,
    amplifier: Amplifier | None = None,
    timing: Timing | None = None,
    points_per_sample: int = 1,
    single: bool = False,
    flexible: bool = False,
) -> Laid:
    """Everything but the start checked and laid out; `placed` where somebody chose it.

    `known` keeps what belongs to a device and a hand, or to a law, so that many loops with the same two, and
    the same options and duration, compute it once. They must live as long as it.

    Raises
    ------
    InputError
        If anything cannot be simulated.
    """
    rest, operator = _at_rest(device, law, operator, placed, known)
    moved = device.motor_side if flexible and isinstance(device, Device) else device
    frame = frame_of(moved, operator, duration, amplifier, timing, points_per_sample, known)
    if moved is device and frame.pieces > 1:
        raise InputError(
            f"the motion has {frame.pieces} pieces in a sample, and was found for a device with a "
            "transmission: take the device that was checked"
        )
    if operator.kinematic:
        assert frame.signals.position is not None
        rest = float(frame.signals.position[0])
    numbers = frame.period, frame.resolution, frame.actuation
    return Laid(operator, rest, frame, laws.packed(law, device, *numbers, single, known))


def started(laid: Sequence[Laid], starts: Array) -> tuple[Array, Array, Array]:
    """States, laws and memories, a row for each loop: laws equally long, `starts` as of `Laid`."""
    states = np.zeros((len(laid), STATE_SIZE))
    positions, velocities, phases = starts.T
    states[:, POSITION], states[:, VELOCITY] = positions, velocities
    states[:, DIRECTION] = np.sign(velocities)
    numbers = np.array([loop.packed.numbers for loop in laid])
    numbers[:, laws.PHASE] = phases
    memories = [
        laws.remembered(law, packed.row, packed.unit, laws.measured(position, frame.resolution, phase))
        for (_, _, frame, packed), law, (position, _, phase) in zip(laid, numbers, starts, strict=True)
    ]
    return states, numbers, np.array(memories)


def _at_rest(
    device: Device, law: Environment, operator: Operator, placed: bool, known: dict[Any, Any]
) -> tuple[float, Operator]:
    """Where the touch starts and the hand that starts there: where the law rests, unless somebody chose."""
    if not (isinstance(device, Device) and isinstance(operator, Operator)):
        return 0.0, operator  # refused further on
    given = operator.initial_position
    if placed or operator.kinematic or operator.start_is_chosen:
        return given, operator
    place = rest_position(law, device.exact("sample_period"), given)
    if place == given:
        return given, operator
    if (moved := ("at rest", id(operator), place)) not in known:
        known[moved] = operator.starting_at(place)
    return place, known[moved]


class Frame(NamedTuple):
    """What of a loop depends neither on its law nor on how it starts."""

    samples: int
    points: int
    period: Fraction
    resolution: float
    amplifier: Amplifier
    actuation: Actuation
    plant: Plant
    late: int
    offset: float
    times: Array
    lengths: Array
    arrivals: Array
    missed: Array
    signals: Signals

    @property
    def columns(self) -> int:
        """Instants in the record."""
        return self.samples * self.points + 1

    @property
    def pieces(self) -> int:
        """Straight pieces of a prescribed motion in an interval."""
        position = self.signals.position
        return 1 if position is None else (position.size - 1) // self.samples

    def optional(self) -> tuple[Array, Array, Array, Array]:
        """Force, anchor, target and switch as arrays, empty where there is none."""
        s = self.signals
        given = (s.force, s.anchor, s.position, s.switch_position)
        force, anchor, target, switch = (_NONE if v is None else v for v in given)
        return force, anchor, target, switch


def frame_of(
    device: Device,
    operator: Operator,
    duration: RealLike,
    amplifier: Amplifier | None,
    timing: Timing | None,
    points_per_sample: int,
    known: dict[Any, Any] | None = None,
) -> Frame:
    """Device, hand and clock checked and laid out, whatever the law; arguments as of `prepare`."""
    known = {} if known is None else known
    key = (id(device), id(operator))
    if key in known:
        found: Frame = known[key]
        return found
    if not isinstance(device, Device):
        raise InputError(f"the device is a zwidth.Device, {instead_of_device(device)}")
    require_rigid(device, "this loop")
    if not isinstance(operator, Operator):
        raise InputError(
            f"operator is a hand, such as zwidth.operators.Finger(), got {type(operator).__name__}"
        )
    drive = CurrentAmplifier() if amplifier is None else amplifier
    if not isinstance(drive, Amplifier):
        raise InputError(f"amplifier is one of zwidth.amplifiers, got {type(drive).__name__}")
    period = device.exact("sample_period")
    samples = whole_samples(duration, period)
    points = _points(points_per_sample, samples)
    actuation = drive.actuation(device)
    plant = _plant(device, operator, actuation)
    _check_pieces(plant, float(period), operator.kinematic)
    delay = device.exact("delay")
    if (clock := (id(operator), samples, period, delay)) not in known:
        times, *others = _clock(timing, samples, period, delay)
        signals = operator.signals(times)
        check_signals(signals, samples)
        known[clock] = times, *others, signals
    times, lengths, arrivals, missed, signals = known[clock]
    if signals.switch_position is not None and timing is not None:
        raise InputError("a motion with switch positions needs a regular clock: leave timing out")
    ratio = delay / period
    if signals.switch_position is not None and ratio.denominator == 1:
        raise InputError(
            "a motion with switch positions is of a force that changes between samples, and with a delay of "
            f"{shown(device.exact('delay'), 's', 6)} it changes at them: take the device of the motion"
        )
    offset = float(ratio % 1 * period)
    late = min(ratio.numerator // ratio.denominator, samples + 1)  # later than all is late enough
    known[key] = frame = Frame(
        samples=samples,
        points=points,
        period=period,
        resolution=float(device.exact("resolution")),
        amplifier=drive,
        actuation=actuation,
        plant=plant,
        late=late,
        offset=offset,
        times=times,
        lengths=lengths,
        arrivals=arrivals,
        missed=missed,
        signals=signals,
    )
    return frame


def _plant(device: Device, operator: Operator, actuation: Actuation) -> Plant:
    hand = operator.hand
    return Plant(
        mass=_mass(device, operator),
        hand_mass=hand.mass,
        damping=float(device.exact("damping")),
        coulomb=float(device.exact("coulomb_friction")),
        stiction=float(device.exact("coulomb_friction" if device.stiction is None else "stiction")),
        stiffness=hand.stiffness,
        hand_damping=hand.damping,
        lag=actuation.lag,
        slew=actuation.slew,
    )


def resting_memory(setup: Setup, reading: float) -> Array:
    """What the law of a setup remembers after the hand has been at a reading for ever."""
    return laws.remembered(setup.law, laws_of(setup.environment), laws.at_one(setup.law), reading)


def resting_lines(setup: Setup) -> Array:
    """The same for every reading x, to the last bit: a + s x outside, where x ≤ 0, and another inside.

    Outside and inside, a and s, place by place: 2 × 2 × n.

    What sees the penetration remembers nothing outside; who has entered long ago is told by a step.
    """
    lower, surface, one, two = (resting_memory(setup, x) for x in (-1.0, 0.0, 1.0, 2.0))
    return np.array([[surface, surface - lower], [one - (two - one), two - one]])


def whole_samples(duration: RealLike, period: Fraction) -> int:
    length: Exact = read_number(duration, "sample_period", "duration", bound="> 0", why="no time, no motion")
    samples = length.fraction / period
    whole = samples.numerator // samples.denominator
    if whole < 1:
        least, given = shown(period, "s", 6), shown(length, "s", 6)
        raise InputError(f"duration must be one sample period, {least}, at least; got {given}")
    return whole


def _points(given: int, samples: int) -> int:
    points = _number(given, "points_per_sample")
    if points != int(points) or points < 1:
        raise InputError(f"points_per_sample is a whole number ≥ 1, got {given}")
    size = samples * int(points) * (RECORDED + 6) * 8
    if size > MOST_BYTES:
        raise InputError(
            f"{samples:,} samples with {int(points)} points each take {size / 2**30:.1f} GiB, more than "
            f"{MOST_BYTES / 2**30:.0f} GiB: shorten the duration or record fewer points"
        )
    return int(points)


_MASS = {"linear": 'mass [kg], --mass "36 g"', "rotary": 'inertia [kg*m^2], --inertia "60 g*cm^2"'}


def _mass(device: Device, operator: Operator) -> float:
    if device.mass is None:
        if operator.kinematic:
            return 0.0
        mass = in_words("mass", device.motion)
        raise InputError(
            f"{mass} is needed to simulate a motion and the device has none: no criterion depends on it, "
            f"what a hand feels does; give {_MASS[device.motion]}, or prescribe the motion"
        )
    return float(device.exact("mass"))


def _check_pieces(plant: Plant, period: float, kinematic: bool) -> None:
    if kinematic:
        return
    mass = plant.mass + plant.hand_mass
    drag = plant.damping + plant.hand_damping
    rates = {
        "the damping of device and hand over their mass": drag / mass,
        "the frequency of the hand's spring with the mass": sqrt(plant.stiffness / mass),
        "the amplifier": 1 / plant.lag if plant.lag else 0.0,
    }
    name, rate = max(rates.items(), key=lambda item: item[1])
    tied = plant.stiffness > 0 or plant.lag > 0 or plant.slew > 0
    if tied and ceil(rate * period) > MOST_PIECES:
        raise InputError(
            f"{name} gives a time constant of {shown(1 / rate, 's', 3)}, over {MOST_PIECES} times below the "
            f"sample period {shown(period, 's', 6)}: it is rigid; prescribe the motion, or leave it out"
        )


def _clock(
    timing: Timing | None, samples: int, period: Fraction, delay: Fraction
) -> tuple[Array, Array, Array, Array]:
    step = float(period)
    regular: Array = np.arange(samples + 1) * np.float64(step)
    if timing is None:
        return regular, np.array([step]), np.empty((2, 0)), _NONE
    if not isinstance(timing, Timing):
        raise InputError(f"timing is a zwidth.simulation.Timing, got {type(timing).__name__}")
    late, missed = timing.late(samples, step), timing.skipped(samples)
    if not late.any():
        return regular, np.array([step]), np.empty((2, 0)), missed
    times = regular + late
    lengths = np.diff(times)
    applied = times + float(delay)
    interval = np.searchsorted(times, applied, side="right") - 1
    into = applied - times[interval]
    over = (interval < samples) & (into >= np.append(lengths, np.inf)[interval])
    interval[over], into[over] = interval[over] + 1, 0.0
    return times, lengths, np.stack([interval.astype(np.float64), into]), missed


def check_signals(signals: Signals, samples: int) -> None:
    wanted = {"force": samples, "anchor": samples + 1, "position": samples + 1, "switch_position": samples}
    for name, length in wanted.items():
        values = getattr(signals, name)
        if values is None:
            continue
        if name == "position" and values.ndim == 1 and values.size > length:
            length += (values.size - length) // samples * samples  # of pieces of the intervals
        if values.dtype != np.float64 or values.shape != (length,):
            raise InputError(
                f"the operator's {name} has shape {values.shape}; {samples} samples need ({length},) numbers"
            )
        bad = np.flatnonzero(~np.isfinite(values))
        if bad.size:
            raise InputError(f"the operator's {name} at sample {bad[0]} is {values[bad[0]]}, not a number")


def _number(value: object, what: str) -> float:
    try:
        number = float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        raise InputError(f"{what} is a number, got {value!r}") from None
    if not isfinite(number):
        raise InputError(f"{what} must be finite, got {number}")
    return number


def empty_record(frame: Frame, two: bool = False) -> tuple[Array, Array, Array]:
    """(commands, record, work) to run into, those of two masses with all that they need."""
    rows, work = (two_masses.RECORDED_OF_TWO, two_strides.WORK_OF_TWO) if two else (RECORDED, WORK)
    return np.zeros(frame.samples + 1), np.empty((rows, frame.columns)), np.zeros(work)
