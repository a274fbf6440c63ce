"""What a vibration of two arms lives on: the energy of a cycle, and which part of the coupling puts it in.

With X and X' the complex amplitudes of both arms, h the hold, s and d the lags of the arm's own reading and
of the other's, the coupling answers in each arm, at ω and its harmonics,

    F = h e^(−jωs) [ K (X − X' e^(−jωd)) + B (V − V' e^(−jωd)) + D V ] + compensation

and gives W = −π Im(F X*) in a cycle.  A spring between two arms that were read at this instant and pushed
without a hold would give nothing in all: K (X − X') gives the one arm what it takes from the other.  So

    link delay             K h (X' − X' e^(−jωd))
    sampling               K (h − 1)(X − X')
    delay                  K h (e^(−jωs) − 1)(X − X' e^(−jωd))
    damping                the whole term of B, where it drives
    local damping          the whole term of D, where it drives
    friction compensation  the force along the motion
    actuator limit         what a motor adds whose force changes no faster than some rate, in place of a delay

summed over both arms; where the springs differ, the follower's joules count K_l/K_f times.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from zwidth.data.diagnosis import drive
from zwidth.data.diagnosis.drive import STRAIGHT
from zwidth.data.diagnosis.evidence import Known, Motion
from zwidth.data.diagnosis.pairs.recording import PairRecording
from zwidth.data.diagnosis.recording import Recording
from zwidth.data.diagnosis.vibration import Vibration, find, phasors
from zwidth.model.device import Device
from zwidth.native.compiled import Array

Phasors = NDArray[np.complex128]

PAIR_CAUSES: Mapping[str, str] = {
    "link delay": "each arm is pulled to where the other one was when its reading was sent",
    "sampling": "the spring is held from sample to sample and so pushes out harder than it was pressed in",
    "delay": "the forces come late after the arms' own readings",
    "damping": "damping against the other arm's speed comes so late that it drives the motion",
    "local damping": "damping of each arm's own speed comes so late, or has such a sign, that it drives",
    "friction compensation": "more friction is compensated than there is: the compensation drives the motion",
    "actuator limit": "a motor cannot follow: its force comes late because it changes no faster",
}
"""The terms of the energy, each in words as a reason to shake."""

_MOST_ROWS = 20_000
"""Up to the end of the vibration, for the law."""

_EXPLAINED = 0.01
"""Share of a force's variance that may be left over in the whole run."""

_ALIKE = 2e-3
"""Share of a motor's force by which it may differ from the command and be the same."""

_LIMITED = 0.7
"""Of what the best delay leaves over, what a limit of rate leaves at most to be seen."""

_LONGEST_LINK = 0.6
"""Of a cycle, by how much a reading of the other may be older."""

_FEWEST_LINKS, _MOST_LINKS = 16, 60
_MOST_LAGS = 16
"""Samples."""


@dataclass(frozen=True, kw_only=True)
class PairEvidence:
    vibration: Vibration
    """Of the arm that swings further."""
    leading: int
    """Which arm that is, 0 the leader, 1 the follower."""
    loop_period: float
    """[s] T."""
    laws: tuple[ArmLaw | None, ArmLaw | None]
    """Of leader and follower; None where a force does not follow the arms."""
    amplitudes: tuple[float, float]
    """[m; rad] |X| of both."""
    counts: tuple[float, float]
    """End to end, of both, in counts of their encoders; infinite where none is seen."""
    delays: tuple[float | None, float | None]
    """[s] from an arm's reading to its force, where the file shows the motor's force; else None."""
    rates: tuple[float | None, float | None]
    """[N/s; N·m/s] no faster than which the motor's force of each arm changes; None where it follows."""
    behind: float
    """Share of the motors' forces that neither a delay nor a limit of rate accounts for, the larger of
    both; 1 where a force changes at one rate and its command is not in the file."""
    supplied: Mapping[str, float]
    """[J] that each term gives in a cycle, negative where it takes."""
    energy: float
    """[J] that the forces of the file give in a cycle in both arms."""
    rubs: tuple[float, float] | None
    """[J] that viscous and Coulomb friction take in a cycle in both arms; None without their devices."""
    rotary: bool

    @property
    def lost(self) -> float | None:
        """[J] that friction takes in a cycle."""
        return None if self.rubs is None else sum(self.rubs)


def vibrates(recording: PairRecording) -> tuple[Vibration, int] | None:
    """The vibration of the arm that swings further, and which arm; None where neither vibrates."""
    found = [find(arm.position, arm.period) for arm in recording.arms]
    swings = [0.0 if one is None else one.swing for one in found]
    arm = int(np.argmax(swings))
    seen = found[arm]
    return None if seen is None else (seen, arm)


def gather(
    recording: PairRecording, vibration: Vibration, leading: int, devices: tuple[Device, Device] | None
) -> PairEvidence:
    known = [Known.of(device) for device in devices] if devices is not None else [Known(), Known()]
    rows, period = vibration.rows, recording.leader.period
    loop_period = max((k.period for k in known if k.period), default=period)
    about = vibration.angular, loop_period, vibration.frequency, period
    xs = [phasors(arm.position[rows], vibration.frequency, period) for arm in recording.arms]
    motions = [Motion(x, *about) for x in xs]
    seen = [
        _arm(arm, recording.arms[1 - k], rows, loop_period, vibration) for k, arm in enumerate(recording.arms)
    ]
    forces, laws, delays, rates, added, behind = zip(*seen, strict=True)
    ratio = _ratio(laws)
    supplied = dict.fromkeys(PAIR_CAUSES, 0.0)
    energy = 0.0
    for k, weight in ((0, 1.0), (1, ratio)):
        own, fitted = motions[k], laws[k]
        energy += weight * own.work(own.phasors(forces[k]))
        if fitted is None:
            continue
        for name, part in _terms(fitted, delays[k], own, xs[1 - k]):
            supplied[name] += weight * own.work(part)
        supplied["friction compensation"] += weight * own.work(own.phasors(fitted.helped))
        supplied["actuator limit"] += weight * own.work(own.phasors(added[k]))
    rubs = None
    if all(k.damping is not None for k in known):
        weighted = list(zip(known, motions, (1.0, ratio), strict=True))
        rubs = (
            sum(w * own.viscous(k.damping or 0.0) for k, own, w in weighted),
            sum(w * 4 * (k.coulomb or 0.0) * float(abs(own.xs[0])) for k, own, w in weighted),
        )
    steps = [k.resolution or arm.resolution for k, arm in zip(known, recording.arms, strict=True)]
    return PairEvidence(
        vibration=vibration,
        leading=leading,
        loop_period=loop_period,
        laws=(laws[0], laws[1]),
        amplitudes=(float(abs(xs[0][0])), float(abs(xs[1][0]))),
        counts=tuple(2 * abs(x[0]) / step if step else np.inf for x, step in zip(xs, steps, strict=True)),  # type: ignore[arg-type]
        delays=(delays[0], delays[1]),
        rates=(rates[0], rates[1]),
        behind=max(behind),
        supplied=supplied,
        energy=energy,
        rubs=rubs,
        rotary=recording.leader.motion == "rotary",
    )


def _arm(
    arm: Recording, other: Recording, rows: slice, loop_period: float, vibration: Vibration
) -> tuple[Array, ArmLaw | None, float | None, float | None, Array, float]:
    """The force that acts, the law of an arm, how late its force is; the rate that limits it, what that adds
    to the command, and the share of the force that is left over.

    The law is looked for in the whole run, where it does what the force did: of a motion that repeats itself
    to the last count many laws give the same force.
    """
    seen = arm.commanded if arm.commanded is not None else arm.applied
    assert seen is not None
    cycle = 1 / vibration.frequency
    sign = 1.0 if float(np.cov((arm.position - other.position)[rows], seen[rows])[0, 1]) >= 0 else -1.0
    links = _lags(_LONGEST_LINK * cycle, loop_period, _FEWEST_LINKS, _MOST_LINKS)
    lags = [0.0, loop_period] if arm.commanded is not None else _lags(0.3 * cycle, loop_period, 2, _MOST_LAGS)
    whole = slice(max(0, rows.stop - _MOST_ROWS), rows.stop)
    fits = []
    for part in (whole, rows):
        told = arm.position[part], other.position[part], sign * seen[part]
        fitted = arm_law(*told, arm.period, loop_period, lags, links)
        if fitted is not None:
            fits.append(replace(fitted, helped=fitted.helped[rows.start - part.start :]))
            if fitted.unexplained < _EXPLAINED:
                break
    best = min(fits, key=lambda one: one.unexplained, default=None)
    delay: float | None = None if arm.applied is None or best is None else best.lag
    acts = sign * (arm.applied if arm.applied is not None else seen)[rows]
    rate, added, behind = None, np.zeros_like(acts), 0.0
    if arm.commanded is not None and arm.applied is not None:
        asked = sign * arm.commanded[rows]
        between = drive.account(asked, acts, arm.position[rows], arm.period, loop_period, cycle)
        delay, behind = between.delay_to_a_sample, min(between.by_delay, between.by_rate)
        if between.by_nothing > _ALIKE and between.by_rate < _LIMITED * between.by_delay:
            delay, rate, added = 0.0, between.rate, acts - asked
    elif arm.applied is not None and drive.ramps(acts) > STRAIGHT:
        behind = 1.0  # something does not follow, and the command that would tell is not there
    return acts, best, delay, rate, added, behind


def _lags(longest: float, step: float, fewest: int, most: int) -> list[float]:
    return [k * step for k in range(min(max(fewest, int(longest / step)), most) + 1)]


def _ratio(laws: Sequence[ArmLaw | None]) -> float:
    """K_l/K_f, 1 where they are the same within what a file shows."""
    leader, follower = laws
    if leader is None or follower is None or not leader.stiffness or not follower.stiffness:
        return 1.0
    ratio = leader.stiffness / follower.stiffness
    return 1.0 if abs(np.log(ratio)) < 0.02 else ratio


def _terms(fitted: ArmLaw, delay: float | None, own: Motion, other: Phasors) -> list[tuple[str, Phasors]]:
    spring, old = fitted.stiffness * (own.xs - other), other * own.late(fitted.link_delay)
    late = own.late(fitted.lag if delay is None else delay)
    speed = late * (1 - own.late(own.loop_period)) / own.loop_period
    return [
        ("link delay", own.held(fitted.stiffness * (other - old))),
        ("sampling", own.held(spring) - spring),
        ("delay", own.held(fitted.stiffness * (late - 1) * (own.xs - old))),
        ("damping", own.held(fitted.damping * speed * (own.xs - old))),
        ("local damping", own.held(fitted.local_damping * speed * own.xs)),
    ]


# Which law an arm of a pair was moved by: stiffness, damping, how old its own reading was and the other's.
#
#     f(t) = a + K (x(t − s) − x'(t − s − d)) + B (v(t − s) − v'(t − s − d)) + D v(t − s) − F sgn v(t − s)
#
# x is the arm's own position, x' the other's, v the difference of the last two readings.  Every pair of lags
# of a list is tried, the terms are fitted by least squares, and the law is the one of least BIC.

_MOST_FITTED = 2000
_FEWEST_ROWS = 30
_EXACT = 1e-9
_FREE = 0.8
"""Of the largest force: what is larger may have been cut off."""

_MODELS = ((0,), (0, 1), (0, 2), (0, 3), (0, 1, 2), (0, 1, 3), (0, 2, 3), (0, 1, 2, 3))
"""Terms that are tried together: K, B, D, F."""


@dataclass(frozen=True, kw_only=True)
class ArmLaw:
    """What an arm's force was computed from."""

    stiffness: float
    damping: float
    local_damping: float
    """K [N/m; N·m/rad], B and D [N·s/m; N·m·s/rad]."""
    compensation: float
    """F [N; N·m] along the motion; 0 for none."""
    lag: float
    """[s] s, from the arm's own position to its force."""
    link_delay: float
    """[s] d, by how much the other's reading is older."""
    unexplained: float
    """Share of the force's variance that is left over."""
    helped: Array = field(repr=False)
    """[N; N·m] the force of F in each row."""


def arm_law(
    own: Array,
    other: Array,
    force: Array,
    row_period: float,
    loop_period: float,
    lags: Sequence[float],
    links: Sequence[float],
) -> ArmLaw | None:
    """The law of one arm in a stretch; None where its force does not follow the arms."""
    times = np.arange(own.size, dtype=np.float64) * row_period
    first = int(np.ceil((max(lags) + max(links) + loop_period) / row_period)) + 1
    rows = np.flatnonzero(np.abs(force) < _FREE * np.abs(force).max())
    rows = rows[rows >= min(first, own.size // 2)]
    if rows.size < _FEWEST_ROWS or not np.ptp(force[rows]):
        return None
    rows = rows[:: max(1, rows.size // _MOST_FITTED)]
    y = force[rows]
    best: tuple[float, tuple[int, ...], Array, float, float] | None = None
    for lag in lags:
        x, v = _read(own, times, times[rows] - lag, loop_period)
        for link in links:
            there, going = _read(other, times, times[rows] - lag - link, loop_period)
            table = np.stack([x - there, v - going, v, -np.sign(v)], axis=1)
            for model, terms, left in _fitted(table, y):
                bic = y.size * np.log(left + _EXACT) + len(model) * np.log(y.size)
                if best is None or bic < best[0] - 1e-9:
                    best = (bic, model, terms, lag, link)
    if best is None:
        return None
    _, model, terms, lag, link = best
    gains = dict(zip(model, map(float, terms), strict=True))
    _, moved = _read(own, times, times - lag, loop_period)
    left = float(np.exp((best[0] - len(model) * np.log(y.size)) / y.size) - _EXACT)
    return ArmLaw(
        stiffness=gains[0], damping=gains.get(1, 0.0), local_damping=gains.get(2, 0.0),
        compensation=gains.get(3, 0.0), lag=lag, link_delay=link, unexplained=max(left, 0.0),
        helped=-gains.get(3, 0.0) * np.sign(moved),
    )  # fmt: skip


def _read(position: Array, times: Array, at: Array, loop_period: float) -> tuple[Array, Array]:
    """x and the difference of the last two readings, at some instants."""
    x = np.interp(at, times, position)
    return x, (x - np.interp(at - loop_period, times, position)) / loop_period


def _fitted(table: Array, y: Array) -> list[tuple[tuple[int, ...], Array, float]]:
    """Each model with K, B and F > 0: its terms, and what they leave over."""
    centred, wanted = table - table.mean(axis=0), y - y.mean()
    size = float(wanted @ wanted)
    norm = np.sqrt((centred**2).sum(axis=0))
    norm[norm == 0] = 1.0
    unit = centred / norm
    gram, answer = unit.T @ unit, unit.T @ wanted
    found: list[tuple[tuple[int, ...], Array, float]] = []
    for model in _MODELS:
        index = list(model)
        system = gram[np.ix_(index, index)] + 1e-12 * np.eye(len(index))
        terms = np.linalg.solve(system, answer[index])
        if all(value > 0 for term, value in zip(model, terms, strict=True) if term != 2):
            left = max(size - float(terms @ answer[index]), 0.0) / size
            found.append((model, terms / norm[index], left))
    return found
