"""Mass, damping and stiffness of the finger that holds a device while a perturbation shakes it.

    m_h ẍ + c ẋ + k (x − x_a(t)) = −f_h                           force of the hand measured
    (m + m_h) ẍ + (b + c) ẋ + f_c sgn ẋ + k (x − x_a(t)) = −f_a        device known

in means over smooth pulses, as `identify` has them for the device.  What the finger wants, x_a, is
slow: within a short piece it is a cubic of time, and so is the zero of a load cell; both are
taken out.  A finger may be taken for a mass on a spring and a damper for some 30 ms (Gillespie &
Cutkosky 1996, as told by others); later it answers on purpose.  So pieces are short, and what is slower
than they are does not count.

The finger also pushes on its own account, it trembles, and this moves x: least squares would take
it for an answer.  The perturbation does not know of it: it is sent through the fitted model, and
the motion that comes out is the instrument (refined instrumental variables, Young 1976),

    Σ ẑ (y − aᵀ θ) = 0,   a = (ẍ, ẋ, x),   ẑ = a of the motion that f_a alone makes

Where f_a was not recorded the even and the odd samples are each other's instruments: free
of the bias of the counts, not of that of tremor.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal, NamedTuple

import numpy as np

from zwidth.compiled import Array
from zwidth.device.device import Device
from zwidth.errors import InputError
from zwidth.identification.device.choice import LENGTHS, LONGER, SAFETY
from zwidth.identification.device.identified import Estimate
from zwidth.identification.device.pulses import PIECES
from zwidth.identification.finger.fit import TERMS, Fit, fitted
from zwidth.identification.finger.identified import IdentifiedFinger
from zwidth.identification.finger.means import Means, Pieces, means, pieces_of, response
from zwidth.identification.finger.weights import Weights, weights
from zwidth.identification.logs import Finding, Log
from zwidth.quantity.exact import ends

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
    piece: float = 0.25,
    delay: float = 0.0,
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
        not measured, else not looked at.
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
        If the log shows too little, or a number is outside its bound.
    """
    instrument = _checked(log, device, piece, delay, instrument)
    by_hand = "hand_force" in log.channels
    pieces = pieces_of(log, piece)
    known = {} if by_hand else _known(device)
    least, most = known.get("coulomb_friction", (0.0, 0.0))
    friction = (least + most) / 2
    ways = _chosen(pieces, log, delay / log.sample_period, by_hand, friction)
    if instrument == "perturbation":
        pieces = _perturbed(pieces, log, ways.shape, delay, friction)
        ways = _again(pieces, log, ways.shape, delay / log.sample_period, by_hand, friction)
    shift = SAFETY * np.abs(ways.fit.values - ways.longer.values)
    if most > 0:
        shift = shift + _doubt(ways, means(pieces, ways.shape, log.sample_period), friction, most)
    if "actuator_force" not in log.channels:
        shift = shift + _half_a_sample(ways.fit.values, log.sample_period)
    estimates = _estimates(ways.fit, shift, known, log.motion)
    return IdentifiedFinger(
        estimates=estimates,
        instrument=instrument,
        explained=ways.fit.explained,
        pulse_length=PIECES * ways.shape.piece * log.sample_period,
        pieces=ways.fit.pieces,
        pulses=ways.fit.pulses,
        motion=log.motion,
        source=log.source,
        findings=(*log.findings, *_findings(estimates, by_hand, instrument)),
    )


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


def _known(device: Device | None) -> dict[str, tuple[float, float]]:
    """The ends of what the device takes of the actuator's force."""
    assert device is not None  # checked
    found = {}
    for name in ("mass", "damping", "coulomb_friction"):
        low, high = ends(getattr(device, name))
        found[name] = (float(low), float(high))
    return found


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
    """What it matters when within a sample the force steps, which only the actuator's force tells.

    c v + k x at t + τ are c (v + τ a) + k (x + τ v): τ early reads c τ more mass and k τ more damping.
    """
    _, damping, stiffness = np.abs(values)
    return np.array([damping, stiffness, 0.0]) * period / 2


def _too_little(log: Log) -> str:
    return (
        f"{log.source}: {log.duration:.3g} s show too little to tell mass, damping and stiffness apart: "
        "shake the finger for a minute with steps in random order, some 10 ms each and a newton strong, so "
        "that it moves by many counts; hold still; take longer pieces if the sample period is long"
    )


def _estimates(
    fit: Fit, shift: Array, known: dict[str, tuple[float, float]], motion: str
) -> dict[str, Estimate]:
    turn = motion == "rotary"
    units = ("kg m²", "N m s/rad", "N m/rad") if turn else ("kg", "N s/m", "N/m")
    found = {}
    for k, name in enumerate(TERMS):
        low, high = known.get(name, (0.0, 0.0))
        found[name] = Estimate(
            float(fit.values[k]) - (low + high) / 2,
            float(fit.errors[k]),
            float(shift[k]) + (high - low) / 2,
            fit.pieces - len(TERMS),
            units[k],
        )
    return found


def _findings(estimates: dict[str, Estimate], by_hand: bool, instrument: Instrument) -> Iterable[Finding]:
    for name, estimate in estimates.items():
        if estimate.interval(0.95)[0] <= 0:
            yield Finding(kind=f"no {name}", text=f"the data do not rule out that {name} is 0: {estimate}")
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
