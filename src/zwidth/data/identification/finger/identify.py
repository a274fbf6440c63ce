"""Mass, damping and stiffness of the finger that holds a device while a perturbation shakes it.

    m_h ẍ + c ẋ + k (x − x_a(t)) = −f_h                           force of the hand measured
    (m + m_h) ẍ + (b + c) ẋ + f_c sgn ẋ + k (x − x_a(t)) = −f_a        device known

in means over smooth pulses, as `identify` has them for the device.  What the finger wants, x_a, is slow:
within a short piece it is a cubic of time, and so is the zero of a load cell; both are taken out.  A finger
may be taken for a mass on a spring and a damper for some 30 ms (Gillespie & Cutkosky 1996, as told by
others); later it answers on purpose.  So pieces are short, and what is slower than they are does not count.

The finger also pushes on its own account, it trembles, and this moves x: least squares would take
it for an answer.  The perturbation does not know of it: it is sent through the fitted model, and
the motion that comes out is the instrument (refined instrumental variables, Young 1976),

    Σ ẑ (y − aᵀ θ) = 0,   a = (ẍ, ẋ, x),   ẑ = a of the motion that f_a alone makes

Where f_a was not recorded the even and the odd samples are each other's instruments: free
of the bias of the counts, not of that of tremor.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Literal, NamedTuple

import numpy as np

from zwidth.data.identification.device.choice import LENGTHS, LONGER, SAFETY
from zwidth.data.identification.device.estimate import Estimate, perhaps_none, unit_of
from zwidth.data.identification.device.findings import refuse_impossible
from zwidth.data.identification.device.pulses import PIECES
from zwidth.data.identification.finger.fit import TERMS, Fit, fitted, lag_of, lag_without_actuator
from zwidth.data.identification.finger.identified import (
    BY_ACTUATOR,
    FINGER,
    IdentifiedFinger,
    LoadCellError,
    apart,
    at_the_stop,
    late,
    refuse_disagreement,
    refuse_scale,
    unseen_lag,
    widened,
)
from zwidth.data.identification.finger.means import (
    Means,
    Pieces,
    Weights,
    means,
    pieces_of,
    response,
    weights,
)
from zwidth.data.logs import Finding, Log
from zwidth.errors import InputError
from zwidth.model.device.device import Device, require_rigid
from zwidth.native.compiled import Array
from zwidth.quantity.exact import RealLike, ends
from zwidth.quantity.parameter import read_number
from zwidth.quantity.text import shown

ROUNDS = 4
"""Of the model that makes the instrument."""

Instrument = Literal["perturbation", "position"]


class Ways(NamedTuple):
    """The same fit with the pulses that were chosen and with pulses twice as long."""

    fit: Fit
    longer: Fit
    shape: Weights


def identify_finger(
    log: Log,
    device: Device | None = None,
    *,
    piece: RealLike = 0.25,
    delay: RealLike = 0.0,
    instrument: Instrument | None = None,
) -> IdentifiedFinger:
    """Identify the finger: ``m_h ẍ + c ẋ + k (x − x_a(t)) = −f_h``, x_a slow.

    All samples are held in memory.

    Parameters
    ----------
    log
        The position, and the force of the hand, or of the actuator, or both.
    device
        With mass, damping and Coulomb friction, perhaps intervals; needed where the force of the hand was
        not measured. Where both forces were, the load cell is held against it, and the actuator's force
        answers alone where the load cell is late or at the end of its range.
    piece
        Time over which what the finger wants is a cubic, > 0 [s].
    delay
        From a sample to the actuator force computed from it, ≥ 0 [s].
    instrument
        "perturbation": f_a, which must not depend on the position, so no wall while it acts; the default
        where f_a was recorded. "position": the even and odd samples.

    Raises
    ------
    InputError
        If the log shows too little, or a number is outside its bound; or if it is of no finger: a force that
        is late, at the end of its range, or of another sign or unit than was said.
    """
    length = float(read_number(piece, "sample_period", "piece"))
    late = float(read_number(delay, "delay", "delay"))
    instrument = _checked(log, device, length, late, instrument)
    task = _Task(log, device, length, late, instrument, "hand_force" in log.channels)
    try:
        return _identified(task)
    except LoadCellError as error:
        if "actuator_force" not in log.channels or device is None or device.mass is None:
            raise
        found = _identified(task._replace(by_hand=False))
        said = Finding(
            kind="load cell not used",
            text=f"the numbers are by the actuator's force and the device, without the load cell: {error}",
        )
        return replace(found, findings=(*found.findings, said))


class _Task(NamedTuple):
    log: Log
    device: Device | None
    piece: float
    delay: float
    instrument: Instrument
    by_hand: bool

    @property
    def late(self) -> float:
        """The actuator's delay [samples]."""
        return self.delay / self.log.sample_period

    @property
    def known(self) -> dict[str, tuple[float, float]]:
        """The ends of what the device takes of the actuator's force; nothing where no mass is known."""
        if self.device is None or self.device.mass is None:
            return {}
        names = ("mass", "damping", "coulomb_friction")
        pairs = {name: ends(getattr(self.device, name)) for name in names}
        return {name: (float(low), float(high)) for name, (low, high) in pairs.items()}

    @property
    def friction(self) -> float:
        """f_c of the device [N; N·m], 0 where it is not known."""
        return sum(self.known.get("coulomb_friction", (0.0, 0.0))) / 2


class _Road(NamedTuple):
    """The pieces, the fits by the force that answers, and those of device and finger by the actuator's
    beside."""

    pieces: Pieces
    ways: Ways
    total: Ways | None


def _identified(task: _Task) -> IdentifiedFinger:
    log = task.log
    road = _begun(task)
    refuse_impossible(log, _stiffnesses(task, road), lambda other: _turned(task, other), FINGER)
    road = _finished(task, road)
    shift, said = _against_the_other_force(task, road)
    estimates = _estimates(
        road.ways.fit, _shift(task, road) + shift, {} if task.by_hand else task.known, log.motion
    )
    refuse_scale(log, road.pieces, estimates["stiffness"])
    refuse_impossible(log, estimates, lambda _: None, FINGER)
    fit = road.ways.fit
    return IdentifiedFinger(
        estimates=estimates,
        instrument=task.instrument,
        explained=fit.explained,
        pulse_length=PIECES * road.ways.shape.piece * log.sample_period,
        pieces=fit.pieces,
        pulses=fit.pulses,
        motion=log.motion,
        source=log.source,
        findings=(*log.findings, *said, *_findings(estimates, task.by_hand, task.instrument)),
    )


def _begun(task: _Task) -> _Road:
    """The fits by the even and the odd samples, which take the motion as it was, whatever the signs."""
    pieces = pieces_of(task.log, task.piece, task.by_hand)
    try:
        ways = _chosen(pieces, task.log, task.late, task.by_hand, task.friction)
    except InputError as error:
        raise (at_the_stop(task.log) if task.by_hand else None) or error from None
    return _Road(pieces, ways, _total(task, pieces, ways.shape))


def _finished(task: _Task, road: _Road) -> _Road:
    if task.instrument != "perturbation":
        return road
    shape = road.ways.shape
    pieces = _perturbed(road.pieces, task.log, shape, task.delay, task.friction)
    ways = _again(pieces, task.log, shape, task.late, task.by_hand, task.friction)
    return _Road(pieces, ways, _total(task, pieces, shape))


def _total(task: _Task, pieces: Pieces, shape: Weights) -> Ways | None:
    """Of device and finger by the actuator's force, where the hand's answers and both are logged."""
    if not task.by_hand or "actuator_force" not in task.log.channels:
        return None
    return _again(pieces, task.log, shape, task.late, False, task.friction)


def _turned(task: _Task, other: Log) -> dict[str, Estimate] | None:
    turned = task._replace(log=other)
    return _stiffnesses(turned, _begun(turned))


def _stiffnesses(task: _Task, road: _Road) -> dict[str, Estimate]:
    """By the hand's force, and by the actuator's."""
    own = _estimates(road.ways.fit, _apart(road.ways), {}, task.log.motion)["stiffness"]
    if not task.by_hand:
        return {BY_ACTUATOR: own}
    if road.total is None:
        return {"stiffness": own}
    other = _estimates(road.total.fit, _apart(road.total), {}, task.log.motion)["stiffness"]
    return {"stiffness": own, BY_ACTUATOR: other}


def _shift(task: _Task, road: _Road) -> Array:
    """What the method may be off."""
    shift = _apart(road.ways)
    least, most = task.known.get("coulomb_friction", (0.0, 0.0))
    if most > 0 and not task.by_hand:
        rows = means(road.pieces, road.ways.shape, task.log.sample_period)
        shift = shift + _doubt(road.ways, rows, (least + most) / 2, most)
    if "actuator_force" not in task.log.channels:
        shift = shift + _half_a_sample(road.ways.fit.values, task.log.sample_period)
    return shift


def _apart(ways: Ways) -> Array:
    """What pulses twice as long change, and more, since they are not endless."""
    return np.asarray(SAFETY * np.abs(ways.fit.values - ways.longer.values))


def _against_the_other_force(task: _Task, road: _Road) -> tuple[Array, list[Finding]]:
    """What the hand's force may be off beside the actuator's: in its scale and in time."""
    nothing, log, ways = np.zeros(len(TERMS)), task.log, road.ways
    if not task.by_hand:
        return nothing, []
    stiffness = _stiffnesses(task, road)
    if road.total is not None:
        refuse_disagreement(log, stiffness["stiffness"], stiffness[BY_ACTUATOR], False)
    period = log.sample_period
    lag = (
        lag_without_actuator(road.pieces, period)
        if road.total is None
        else lag_of(road.pieces, ways.shape, road.total.fit, task.late, period)
    )
    if lag is not None and lag.seen and (lag.sure or (task.known and road.total is not None)):
        raise late(log, lag)
    said = [unseen_lag(lag)] if lag is not None and lag.seen else []
    shift = widened(ways.fit, lag)
    if road.total is None or not task.known:
        return shift, said
    refuse_disagreement(log, stiffness["stiffness"], stiffness[BY_ACTUATOR], True)
    hand = _estimates(ways.fit, _shift(task, road), {}, log.motion)["damping"]
    by_actuator = task._replace(by_hand=False)
    other = _estimates(
        road.total.fit, _shift(by_actuator, road._replace(ways=road.total)), task.known, log.motion
    )
    found = apart(hand, other["damping"])
    if found is not None:
        shift, said = shift + np.array([0.0, found[0], 0.0]), [*said, found[1]]
    return shift, said


def _checked(
    log: Log, device: Device | None, piece: float, delay: float, instrument: Instrument | None
) -> Instrument:
    if not log.channels:
        raise InputError(
            f"{log.source} has no force: a finger is what it answers; log the hand's or the actuator's"
        )
    if "hand_force" not in log.channels and (device is None or device.mass is None):
        raise InputError(
            f"{log.source} has no force of the hand: device and finger move together, and only a device with "
            "a mass tells them apart; identify it first, and give it as device"
        )
    if device is not None:
        require_rigid(device, "what a finger is told apart from")
    if device is not None and device.motion != log.motion:
        raise InputError(
            f"{log.source} is {log.motion} and the device {device.motion}: units do not match; "
            "state both at the handle, or both at the axis"
        )
    if not 8 * log.sample_period < piece < np.inf:
        raise InputError(f"piece must be longer than 8 samples and finite, got {piece!r} s; 0.25 is usual")
    if not 0 <= delay < piece:
        raise InputError(
            f"delay must be ≥ 0 s and < piece, got {delay!r}: the force follows the sample it came from"
        )
    if instrument not in (None, "perturbation", "position"):
        raise InputError(f'instrument is "perturbation" or "position", got {instrument!r}')
    recorded = "actuator_force" in log.channels
    if instrument == "perturbation" and not recorded:
        raise InputError(f'{log.source} has no force of the actuator to serve as instrument; take "position"')
    return instrument or ("perturbation" if recorded else "position")


def _chosen(pieces: Pieces, log: Log, delay: float, by_hand: bool, friction: float) -> Ways:
    """The pulses with the shortest intervals."""
    ways = []
    for length in LENGTHS:
        try:
            ways.append(_again(pieces, log, weights(length, delay), delay, by_hand, friction))
        except InputError:
            break
    if not ways:
        raise InputError(_too_little(log))
    halves = np.stack([2 * w.fit.errors + np.abs(w.fit.values - w.longer.values) for w in ways])
    return ways[int(np.argmin((halves / halves.min(axis=0)).sum(axis=1)))]


def _again(pieces: Pieces, log: Log, shape: Weights, delay: float, by_hand: bool, friction: float) -> Ways:
    fits = [
        fitted(means(pieces, s, log.sample_period), by_hand, friction)
        for s in (shape, weights(LONGER * shape.piece, delay))
    ]
    if fits[0] is None or fits[1] is None:
        raise InputError(_too_little(log))
    return Ways(fits[0], fits[1], shape)


def _perturbed(pieces: Pieces, log: Log, shape: Weights, delay: float, friction: float) -> Pieces:
    """The pieces with the motion that the perturbation alone makes, in the model that it gives itself."""
    for _ in range(ROUNDS):
        total = fitted(means(pieces, shape, log.sample_period), False, friction)
        if total is None:
            raise InputError(_too_little(log))
        pieces = pieces._replace(expected=response(log, pieces, total.values, delay))
    return pieces


def _doubt(ways: Ways, rows: Means | None, friction: float, most: float) -> Array:
    """What it matters that friction may be as large as it can be, and that the device may rest in turns."""
    shift = np.zeros(len(TERMS))
    for f_c, resting in ((most, False), (friction, True)):
        other = fitted(rows, False, f_c, resting)
        if other is not None:
            shift += np.abs(other.values - ways.fit.values)
    return shift


def _half_a_sample(values: Array, period: float) -> Array:
    """What it matters when within a sample the force steps, which only the actuator's force tells. c v + k x
    at t + τ are c (v + τ a) + k (x + τ v): τ early reads c τ more mass and k τ more damping."""
    _, damping, stiffness = np.abs(values)
    return np.array([damping, stiffness, 0.0]) * period / 2


def _too_little(log: Log) -> str:
    return (
        f"{log.source}: {shown(log.duration, 's', 3)} show too little to tell mass, damping and stiffness "
        "apart: hold still, and shake the finger for a minute with steps in random order, some 10 ms each "
        "and 1 N, so that it moves by many counts; take longer pieces if the sample period is long"
    )


def _estimates(
    fit: Fit, shift: Array, known: dict[str, tuple[float, float]], motion: str
) -> dict[str, Estimate]:
    found = {}
    for k, name in enumerate(TERMS):
        low, high = known.get(name, (0.0, 0.0))
        found[name] = Estimate(
            float(fit.values[k]) - (low + high) / 2,
            float(fit.errors[k]),
            float(shift[k]) + (high - low) / 2,
            fit.pieces - len(TERMS),
            unit_of(name, motion),
        )
    return found


def _findings(estimates: dict[str, Estimate], by_hand: bool, instrument: Instrument) -> Iterable[Finding]:
    yield from perhaps_none(estimates, TERMS)
    if instrument == "position":
        yield Finding(
            kind="tremor",
            text="the numbers hold if the finger does not push on its own account quicker than its slow "
            "motion; record the perturbation, and it may",
        )
    if by_hand:
        yield Finding(
            kind="beyond the load cell",
            text="the mass is that of all beyond the load cell, the handle's part included",
        )
