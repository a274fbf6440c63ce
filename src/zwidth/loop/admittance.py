"""What happens when a hand pushes a display of admittance: the loop without time-step error.

The display reads the hand's force and commands a velocity, which an ideal motion source
follows at once and holds for T, whatever force that takes:

    φ_k → body, controller → u_k,     x(t) = x_k + u_k (t − kT)
    f(t) = F + k (x_a(t) − x(t)) + c (ẋ_a(t) − u_k)

x and the anchor x_a are straight between samples, so the force is too, and the energies of
an interval are exact: T u_k f̄ crosses the port, f̄ the mean of the force at both ends.

The source is what makes this exact, and what is left out: the mass of the device and of the
hand, the bandwidth of its drive.  A hand with mass would see an impulse at each sample.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np

from zwidth.errors import InputError
from zwidth.loop.setup import check_signals, whole_samples
from zwidth.loop.trace import LARGEST, UNITS, VARIABLES
from zwidth.model.environment.bodies import VirtualBody
from zwidth.model.operator.operator import LinearHand, Operator
from zwidth.model.rendering.parallel_controller import (
    ENERGY,
    STATE_SIZE,
    ParallelController,
    observer_only,
    step,
)
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import RealLike
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.parameter import one_of, read_number
from zwidth.quantity.text import shown

if TYPE_CHECKING:
    import xarray as xr

Sensor = Literal["point", "mean"]

(
    R_POSITION,
    R_VELOCITY,
    R_BODY_POSITION,
    R_BODY_VELOCITY,
    R_READING,
    R_FORCE,
    R_WORK,
    R_SOURCE,
    R_LOSS,
    R_OBSERVED,
) = range(10)

_OWN = {
    "velocity": ("u", "velocity held from this instant on", 1),
    "body_position": ("y", "position of the virtual body", 0),
    "body_velocity": ("v", "velocity of the virtual body, from this instant on", 1),
    "measured_force": ("φ", "force of the hand as the sensor read it, positive into the wall", 2),
    "hand_force": ("f", "force of the hand just after this instant, positive into the wall", 2),
    "hand_work": ("W_h", "energy from the hand into the display", 3),
    "observed_energy": ("E", "energy from the hand as the observer counted it", 3),
}
"""Variables that a trace of an impedance display does not have, or means otherwise."""


class _Loop(NamedTuple):
    """One loop as arrays, for the kernel."""

    body: Array
    controller: Array
    hand: Array
    force: Array
    anchor: Array


def simulate_admittance(
    body: VirtualBody,
    operator: Operator,
    duration: RealLike,
    *,
    sample_period: RealLike,
    sensor: Sensor = "mean",
    controller: ParallelController | None = None,
) -> xr.Dataset:
    """Simulate a hand on a display of admittance, ``u_k = v_k + β φ_k`` held for T, exactly.

    The display is at rest until t = 0, where the operator starts; its sensor has read the force of the
    hand's spring.

    Parameters
    ----------
    body
        What is rendered.
    operator
        A hand without mass, see `zwidth.operators`; it must not prescribe the motion.
    duration
        At least one sample period [s]; whole samples of it are simulated.
    sample_period
        T > 0 [s].
    sensor
        "mean": φ_k is the mean force since the sample before, as an integrating sensor reads it.
        "point": the force just before the sample.
    controller
        A `zwidth.rendering.ParallelController`; by default none, and the sampled observer counts.

    Returns
    -------
    xarray.Dataset
        Along `time`: position, velocities, forces, `hand_work` (the energy that crossed the port, exact),
        `observed_energy`, and what the hand has spent, stored and lost.  A velocity that grows
        without bound ends the record; the attribute `diverged_at_s` says so.

    Raises
    ------
    InputError
        If the hand has mass or prescribes the motion, or an argument is out of its bounds.
    """
    period = read_number(
        sample_period,
        GLOSSARY["sample_period"],
        "sample_period",
        bound="> 0",
        why="the display works by a clock",
    )
    if not isinstance(body, VirtualBody):
        raise InputError(f"body is a zwidth.simulation.VirtualBody, got {type(body).__name__}")
    if controller is not None and not isinstance(controller, ParallelController):
        raise InputError(
            f"controller is a zwidth.rendering.ParallelController, got {type(controller).__name__}"
        )
    mean = one_of("sensor", sensor, "mean", "point") == "mean"
    hand = _hand(operator)
    start, samples = operator.initial_position, whole_samples(duration, period.fraction)
    times = np.arange(samples + 1) * np.float64(period)
    signals = operator.signals(times)
    check_signals(signals, samples)
    loop = _Loop(
        body=np.array([body.mass, body.damping, body.stiffness, body.integration == "explicit"], dtype=float),
        controller=np.array(
            observer_only(period) if controller is None else controller.numbers(period, float(body.mass))
        ),
        hand=np.array([hand.stiffness, hand.damping]),
        force=np.zeros(samples) if signals.force is None else signals.force,
        anchor=np.full(samples + 1, start) if signals.anchor is None else signals.anchor,
    )
    record = np.zeros((R_OBSERVED + 1, samples + 1))
    done = _run(samples, float(period), float(mean), start, *loop, np.zeros(STATE_SIZE), record)
    attributes: dict[str, Any] = {
        "body": body.describe(),
        "operator": operator.describe(),
        "controller": "none" if controller is None else controller.describe(),
        "sensor": sensor,
        "sample_period_s": float(period),
        "stored_at_start_J": 0.5 * float(body.stiffness) * start**2,
    }
    if done <= samples:
        attributes["diverged_at_s"] = float(times[done - 1])
    return _dataset(times[:done], record[:, :done], loop, attributes)


def _hand(operator: Operator) -> LinearHand:
    if not isinstance(operator, Operator):
        raise InputError(
            f"operator is a hand, such as zwidth.operators.Finger(mass=0), got {type(operator).__name__}"
        )
    if operator.kinematic:
        raise InputError(
            "this operator prescribes the motion, and so does a display of admittance: take a hand that "
            "pushes, such as zwidth.operators.Tracking"
        )
    hand = operator.hand
    if hand.mass != 0.0:
        raise InputError(
            f"the hand has a mass of {shown(hand.mass, 'kg', 6)}, and an ideal motion source changes its "
            "velocity at once: the force would be an impulse; give mass=0, and a heavier virtual body"
        )
    return hand


@compiled
def _run(
    samples: int,
    period: float,
    mean: float,
    start: float,
    body: Array,
    controller: Array,
    hand: Array,
    force: Array,
    anchor: Array,
    memory: Array,
    record: Array,
) -> int:
    """All samples, or until the velocity is beyond any meaning; returns the number of instants recorded."""
    mass, damping, stiffness, explicit = body[0], body[1], body[2], body[3] > 0.0
    inertia = mass if explicit else mass + damping * period + stiffness * period * period
    x, y, own, held = start, start, 0.0, 0.0
    work, source, loss = 0.0, 0.0, 0.0
    reading = hand[0] * (anchor[0] - x)
    pushed = 0.0
    for k in range(samples + 1):
        later = min(k, samples - 1)  # the last instant has no interval of its own
        slope = (anchor[later + 1] - anchor[later]) / period
        if explicit:
            if k > 0:
                own += period * pushed / inertia
            pushed = reading - damping * own - stiffness * y
        else:
            own = (mass * own + period * (reading - stiffness * y)) / inertia
        held = step(controller, memory, reading, own)
        drag = hand[1] * (slope - held)
        first = hand[0] * (anchor[k] - x) + drag
        record[R_POSITION, k], record[R_VELOCITY, k] = x, held
        record[R_BODY_POSITION, k], record[R_BODY_VELOCITY, k] = y, own
        record[R_READING, k], record[R_FORCE, k] = reading, first + force[later]
        record[R_WORK, k], record[R_SOURCE, k], record[R_LOSS, k] = work, source, loss
        record[R_OBSERVED, k] = memory[ENERGY]
        if not abs(held) < LARGEST:
            return k + 1
        if k < samples:
            x += period * held
            y += period * own
            last = hand[0] * (anchor[k + 1] - x) + drag
            tied = 0.5 * (first + last)
            work += period * held * (tied + force[k])
            source += period * (slope * tied + held * force[k])
            loss += period * drag * (slope - held)
            reading = (tied if mean > 0.0 else last) + force[k]
    return samples + 1


def _dataset(times: Array, record: Array, loop: _Loop, attributes: dict[str, Any]) -> xr.Dataset:
    import xarray as xr

    anchor = loop.anchor[: times.size]
    values = {
        "position": record[R_POSITION],
        "velocity": record[R_VELOCITY],
        "body_position": record[R_BODY_POSITION],
        "body_velocity": record[R_BODY_VELOCITY],
        "measured_force": record[R_READING],
        "hand_force": record[R_FORCE],
        "hand_work": record[R_WORK],
        "observed_energy": record[R_OBSERVED],
        "hand_source_work": record[R_SOURCE],
        "hand_spring_energy": 0.5 * loop.hand[0] * (anchor - record[R_POSITION]) ** 2,
        "hand_damper_loss": record[R_LOSS],
    }
    units = (*UNITS["linear"], "J")
    labelled = {}
    for name, row in values.items():
        symbol, long_name, kind = _OWN.get(name) or VARIABLES[name]
        labelled[name] = ("time", row, {"units": units[kind], "long_name": long_name, "symbol": symbol})
    time = ("time", times, {"units": "s", "long_name": "time since sample 0", "symbol": "t"})
    return xr.Dataset(labelled, coords={"time": time}, attrs=attributes)
