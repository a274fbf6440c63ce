"""What was recorded, simulated again: does the law give the forces that were given?

The readings are prescribed, ``x(kT) = x_k``; the law is computed from them as `zwidth.simulate` computes it,
and its force compared with the one in the file, bit by bit.  A sample that the loop missed, or that had no
good answer, is missed in the simulation too: the law and the force stay as they were.

The law is at rest at the first reading of its own, as it is where a served loop takes it up.  Its force does
not depend on how late a sample was; what the actuator's energy is counted from does.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from zwidth.data.logs.contents import COLUMNS, ROWS_LOST
from zwidth.errors import InputError
from zwidth.loop.simulate import simulate, simulated
from zwidth.loop.timing import Timing
from zwidth.machine.servo.proving import least_friction
from zwidth.machine.servo.recording.recording import Recording
from zwidth.machine.servo.ring import SERVING
from zwidth.model.device import Device
from zwidth.model.device.amplifier import Amplifier
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.transfer_function import as_environment
from zwidth.model.operator.operator import Operator
from zwidth.model.operator.prescribed_motion import PrescribedMotion
from zwidth.model.rendering.rendered import laws_of
from zwidth.model.rendering.rendering_law import LoopContext, RenderingLaw
from zwidth.native.compiled import Array
from zwidth.quantity.text import shown, told_quantity
from zwidth.showing import Part, Shown

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import NDArray

    from zwidth.loop.trace import Trace

_MIDDLE = 0.5
"""Phase at which a reading of whole counts lies in the middle of its count, far from an edge."""


class Touch(NamedTuple):
    """What `zwidth.simulate` takes so that its law reads what was recorded.

    Parameters
    ----------
    device
        Without an encoder where the readings are not whole multiples of its step.
    environment
        The law.
    operator
        Goes to every reading.
    timing
        How late the samples were, and which were missed.
    duration
        [s].
    encoder_phase
        See `zwidth.simulate`.
    rows
        Those of the recording that are simulated.
    """

    device: Device
    environment: Environment
    operator: PrescribedMotion
    timing: Timing
    duration: Fraction
    encoder_phase: float
    rows: slice


@dataclass(frozen=True, kw_only=True, repr=False)
class Replay(Shown):
    """Forces of a simulation beside those that were given.

    Parameters
    ----------
    simulated
        What the simulation gives.
    samples
        Compared: those whose force the law gave, uncut.
    different
        Samples whose force has other bits.
    largest
        Largest difference [N; N·m].
    motion
        "linear" or "rotary".
    """

    simulated: Trace
    samples: int
    different: int
    largest: float
    motion: str

    @cached_property
    def trace(self) -> xr.Dataset:
        """What the simulation gives, as `zwidth.simulate` has it."""
        return self.simulated.dataset()

    @property
    def unit_key(self) -> str:
        """The unit of `largest` as it stands in keys."""
        return "N_m" if self.motion == "rotary" else "N"

    def report(self) -> Iterable[Part]:
        """In a line."""
        yield self.describe()

    def describe(self) -> str:
        """In a line."""
        if not self.different:
            return f"the simulation gives the same force in all {self.samples:,} samples, to the last bit"
        return (
            f"the simulation gives another force in {self.different:,} of {self.samples:,} samples, "
            f"by {told_quantity(self.largest, 'force', self.motion, 3)} at most"
        )


def touch_of(
    recording: Recording, device: Device | None = None, environment: object = None, *, law: int = 0
) -> Touch:
    """The motion and the clock of a recording, as `zwidth.simulate` takes them.

    Parameters
    ----------
    recording
        Of a served loop.
    device, environment
        As they were served; by default as the recording says.
    law
        Which one, counted from 0, where the law was changed while it ran.

    Raises
    ------
    InputError
        If that law never ran, rows were lost while it did, the recording does not say what was served, or
        a law in the chain computes with the encoder's step and the readings are no whole multiples of it.
    """
    rows = _rows_of(recording, law)
    device, met = _loop(recording, device, environment, law)
    numbers = recording.columns["sample"][rows].astype(np.int64)
    read = recording.columns["status"][rows] == 0
    readings = recording.columns[COLUMNS[recording.motion][0]][rows][read]
    samples, period = int(numbers[-1] - numbers[0]), device.exact("sample_period")
    if samples < 1 or abs(float(period) / recording.period - 1) > 1e-9:
        raise InputError(
            f"{recording.path} has {samples + 1} samples of this law, one every "
            f"{shown(recording.period, 's', 6)}, and the device has one every {shown(period, 's', 6)}: give "
            "the device that was served, and two samples"
        )
    at = numbers[read] - numbers[0]
    missed, late = np.ones(samples + 1), np.zeros(samples + 1)
    missed[at] = 0.0
    late[at] = _since_first(recording.columns["late_s"][rows][read], float(period))
    device, phase = _encoder(recording, device, met, readings)
    return Touch(
        device=device,
        environment=met,
        operator=PrescribedMotion(np.interp(np.arange(samples + 1), at, readings)),
        timing=Timing(lateness=late.tolist(), missed=(missed != 0).tolist()),
        duration=samples * period,
        encoder_phase=phase,
        rows=rows,
    )


def replay(
    recording: Recording,
    device: Device | None = None,
    environment: object = None,
    *,
    law: int = 0,
    amplifier: Amplifier | None = None,
) -> Replay:
    """Simulate what was recorded, and compare the forces.

    Samples whose force the safety cut are not compared; nor is what comes after them where laws stand in a
    chain, since those remember the force that was given.

    Parameters
    ----------
    recording, device, environment, law
        As of `touch_of`.
    amplifier
        See `zwidth.simulate`.

    Raises
    ------
    InputError
        As `touch_of` and `zwidth.simulate` do.
    """
    touch = touch_of(recording, device, environment, law=law)
    trace = simulated(
        touch.device,
        touch.environment,
        touch.operator,
        touch.duration,
        encoder_phase=touch.encoder_phase,
        amplifier=amplifier,
        timing=touch.timing,
    )
    compared = _compared(recording, touch)
    numbers = recording.columns["sample"][touch.rows].astype(np.int64)
    given = recording.columns[COLUMNS[recording.motion][1]][touch.rows][compared]
    found = trace["commanded_force"].values[numbers - numbers[0]][compared]
    return Replay(
        simulated=trace,
        samples=int(given.size),
        different=int((given != found).sum()),
        largest=float(np.abs(given - found).max(initial=0.0)),
        motion=recording.motion,
    )


def _rows_of(recording: Recording, law: int) -> slice:
    """The rows from the first good answer on while this law was served, in one piece."""
    column = recording.columns
    served = (column["law"] == law) & (column["phase"] == SERVING)
    starts = np.flatnonzero(served & (column["status"] == 0))
    if not starts.size:
        raise InputError(f"{recording.path}: law {law} was not served while it was recorded")
    first = int(starts[0])
    behind = np.flatnonzero(~served[first:])
    end = first + int(behind[0]) if behind.size else served.size
    low, high = (float(column["sample"][k]) for k in (first, end - 1))
    for event in recording.events:
        if event.get("event") == ROWS_LOST and _touches(event, low, high):
            raise InputError(
                f"{recording.path}: {event.get('rows')} rows were lost while the law ran, after sample "
                f"{event.get('after_sample')}; what it read there, and so what it remembered, is not known"
            )
    return slice(first, end)


def _touches(event: dict[str, object], low: float, high: float) -> bool:
    """Whether the loss may be among these samples, or just before them; an end may not be known."""
    after, before = event.get("after_sample"), event.get("before_sample")
    begins = after if isinstance(after, int | float) else -np.inf
    ends_at = before if isinstance(before, int | float) else np.inf
    return bool(ends_at >= low and begins < high)


def _loop(
    recording: Recording, device: Device | None, environment: object, law: int
) -> tuple[Device, Environment]:
    """What was served, as it is given or as the recording says; of its friction the least.

    Behind a transmission the law is that of one mass, where the encoder is.
    """
    if device is None or environment is None:
        said = recording.specification(law)
        device = said.device if device is None else device
        environment = said.environment if environment is None else environment
    return least_friction(device), as_environment(environment)


def _since_first(late: Array, period: float) -> Array:
    """Lateness counted from that of the first sample, from 0 up to just below T."""
    return np.clip(late - late[0], 0.0, np.nextafter(period, 0.0))


def _encoder(recording: Recording, device: Device, met: Environment, readings: Array) -> tuple[Device, float]:
    """The device, and the encoder's phase, with which every reading is read as it was."""
    step = float(device.exact("resolution"))
    if step == 0.0:
        return device, 0.0
    if np.array_equal(step * np.floor(readings / step + _MIDDLE), readings):
        return device, _MIDDLE
    without = device.replace(resolution=0)
    for link in laws_of(met):
        if _numbers(link, device, met) != _numbers(link, without, met):
            raise InputError(
                f"{recording.path}: the readings are no whole multiples of the encoder's {step:g}, since the "
                f"wall's surface lies between two of them, and {link.describe(device.motion)} computes with "
                "that step: put the surface at a whole count to replay such a law"
            )
    return without, 0.0


def _numbers(link: RenderingLaw, device: Device, met: Environment) -> list[float] | None:
    """What a law computes with; None where it cannot."""
    try:
        return link.numbers(LoopContext(device, met))
    except InputError:
        return None


def _compared(recording: Recording, touch: Touch) -> NDArray[np.bool_]:
    """Of the rows that are simulated, those whose force is the law's own."""
    compared: NDArray[np.bool_] = recording.columns["status"][touch.rows] == 0
    if "limited" not in recording.columns:
        return compared
    cut = recording.columns["limited"][touch.rows] != 0
    if cut.any() and laws_of(touch.environment):
        compared[int(np.argmax(cut)) :] = False
    return compared & ~cut


# The whole trace of a touch that was served on a simulated device, which is moved on by the lateness that
# the loop really had.  So `zwidth.simulate`, given that lateness, computes the same touch, and with it what
# no column has: the forces of the hand, the energy that it holds, and what `plots`, `energy` and `traces`
# make of a trace.


def trace_of(
    recording: Recording,
    hand: Operator,
    device: Device | None = None,
    environment: object = None,
    *,
    encoder_phase: float = 0.0,
    amplifier: Amplifier | None = None,
) -> xr.Dataset:
    """The trace of the touch, equal to the recording in every sample, to the last bit.

    Parameters
    ----------
    recording
        Of a simulated device, whose first law was served from sample 0 on.
    hand
        That held it.
    device, environment
        As they were served; by default as the recording says.
    encoder_phase, amplifier
        Of the simulated device.

    Raises
    ------
    InputError
        If it is no such recording, or the simulation gives another position or force: then it was another
        hand, or the safety cut the force.
    """
    position, force = COLUMNS[recording.motion]
    if f"true_{position}" not in recording.columns:
        raise InputError(
            f"{recording.path} is of a real device: nobody knows where it was between two counts, and what "
            "its hand did; its columns are in dataset()"
        )
    touch = touch_of(recording, device, environment)
    numbers = recording.columns["sample"][touch.rows].astype(np.int64)
    if numbers[0] != 0:
        raise InputError(
            f"{recording.path}: the law was served from sample {numbers[0]} on, and the hand had moved the "
            "device before; a trace begins with law and hand together"
        )
    trace = simulate(
        recording.specification().device if device is None else device,
        touch.environment,
        hand,
        touch.duration,
        encoder_phase=encoder_phase,
        amplifier=amplifier,
        timing=touch.timing,
    )
    for name, column in (("position", f"true_{position}"), ("commanded_force", force)):
        other = trace[name].values[numbers] != recording.columns[column][touch.rows]
        if other.any():
            raise InputError(
                f"{recording.path}: with this hand the {name.replace('_', ' ')} is another one from sample "
                f"{numbers[int(np.argmax(other))]} on: give the hand, device and amplifier that were served; "
                "a force that the safety cut is not simulated"
            )
    return trace
