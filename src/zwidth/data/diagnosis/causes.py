"""Why it may shake: each cause with what a recording must hold to show it, and its evidence in numbers.

How likely each one is comes from the features of the recording by a multinomial logistic law,

    log p_i = c_i + Σ_f w_if (φ_f − m_f)/s_f − log Σ,

whose weights are learnt from simulated faults (`benchmarks/diagnosis_training.py`), for files with both
forces, with the command alone and with the motor's force alone.  A cause is named only where its p is large
*and* the file holds what shows it.  What lies behind a command that is recorded alone is seen in the motion:
a device of a known mass takes a force to move so, and that comes later than the command (a delay, a limit of
rate) or is larger (a damper inside the drive).  What is likely for want of anything better is no finding.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING

import numpy as np

from zwidth.data.diagnosis.drive import STRAIGHT
from zwidth.data.diagnosis.evidence import TERMS, Evidence
from zwidth.quantity.text import shown

if TYPE_CHECKING:
    from zwidth.native.compiled import Array

SURE = 0.6
"""A cause that is less likely than this is not named."""

SURER = 0.8
"""Nor one that lies behind a command which is recorded alone: the motion shows that something does, less
well what.
"""

_FURTHEST = 4.0
"""Spreads from the middle of what was simulated beyond which a feature counts no more."""


@dataclass(frozen=True)
class Cause:
    """One reason for a vibration."""

    name: str
    because: str
    """What happens, for people."""
    shown: Callable[[Evidence], bool]
    """Whether this recording can show it at all."""
    evidence: Callable[[Evidence], Iterator[str]]
    record: str
    """What to record where it is likely and not shown."""


def is_named(cause: str, p: float, seen: Evidence) -> bool:
    """Whether a cause is likely enough, and the file holds what shows it."""
    unseen = seen.recorded == "command" and cause in ("delay", "drive damping", "actuator limit")
    return p >= (SURER if unseen else SURE) and CAUSES[cause].shown(seen)


def likelihoods(seen: Evidence) -> dict[str, float]:
    """p of each cause by the features; of a command alone whose loop is known to feed itself, less what the
    energies speak against."""
    learnt = by_features(seen)
    if not _feeds_itself(seen):
        return learnt
    weighed = {name: p * (1.0 if _speaks_for(name, seen) else _LITTLE) for name, p in learnt.items()}
    whole = sum(weighed.values())
    return {name: p / whole for name, p in weighed.items()}


_LITTLE = 0.02
"""Of p that is left to a cause which the energies speak against: the features may know better, but seldom."""


def _feeds_itself(seen: Evidence) -> bool:
    """The law is known, and with the delay as it is stated it gives what friction takes."""
    known = seen.recorded == "command" and seen.known.delay > 0 and follows(seen)
    return known and seen.lost is not None and seen.energy > _ENOUGH * seen.lost


def _speaks_for(cause: str, seen: Evidence) -> bool:
    """Nothing is missing that another one would have to put in."""
    return (
        _gives(seen, cause) if cause in TERMS[:4] else cause == "encoder buzz" and CAUSES[cause].shown(seen)
    )


_ENOUGH = 0.8
"""Of what friction takes, which is known to 15 %."""


def by_features(seen: Evidence) -> dict[str, float]:
    """p of each cause, from the features alone; what the recording does not say counts as the usual."""
    names, middle, spread, weights = _learnt()[seen.recorded]
    z = (vector(features(seen), names) - middle) / spread
    z = np.clip(np.nan_to_num(z), -_FURTHEST, _FURTHEST)
    scores = weights[0] + z @ weights[1:]
    odds = np.exp(scores - scores.max())
    return dict(zip(CAUSES, map(float, odds / odds.sum()), strict=True))


@cache
def _learnt() -> dict[str, tuple[tuple[str, ...], Array, Array, Array]]:
    """For each kind of file: names of the features, middle, spread, and weights, a row of constants first."""
    lines = files("zwidth.data.diagnosis").joinpath("weights.csv").read_text(encoding="utf-8").splitlines()
    head, *rows = [line.split(",") for line in lines if line and not line.startswith("#")]
    assert head[4:] == list(CAUSES)
    learnt = {}
    for kind in dict.fromkeys(row[0] for row in rows):
        own = [row for row in rows if row[0] == kind]
        numbers = np.array([[float(cell) for cell in row[2:]] for row in own])
        learnt[kind] = tuple(row[1] for row in own[1:]), numbers[1:, 0], numbers[1:, 1], numbers[:, 2:]
    return learnt


def _force(seen: Evidence) -> str:
    return "N*m" if seen.rotary else "N"


def _given(seen: Evidence, term: str) -> float:
    """Share that a term has in what all of them give in a cycle."""
    given = sum(max(0.0, w) for w in seen.supplied.values()) or 1.0
    return max(0.0, seen.supplied[term]) / given


def _gives(seen: Evidence, term: str) -> bool:
    """Whether a term gives enough to speak for its cause, and no other one much more."""
    other = max(given for name, given in seen.supplied.items() if name != term)
    return _given(seen, term) > _SPEAKS and other <= _MUCH_MORE * seen.supplied[term]


_SPEAKS, _MUCH_MORE = 0.05, 2.0


def _share(seen: Evidence, term: str) -> str:
    return f"{shown(_given(seen, term), '%', 2)} of the energy that the law gives in a cycle"


def _has(value: float | None, unit: str, has: str = "the device has") -> str:
    """Beside what it is compared with; nothing where it is not known."""
    return "" if value is None else f", {has} {shown(value, unit, 3)}"


def _sampling(seen: Evidence) -> Iterator[str]:
    assert seen.law is not None
    demand = 0.5 * seen.law.stiffness * seen.loop_period
    unit = seen.unit("damping")
    yield f"K T/2 = {shown(demand, unit, 3)}{_has(seen.known.damping, unit)}"
    yield f"the hold of the spring gives {_share(seen, 'sampling')}"


def _delay(seen: Evidence) -> Iterator[str]:
    if seen.sees_delay or _given(seen, "delay") > _SPEAKS:
        yield (
            f"the force comes up to {shown(seen.delay, 's', 3)} after its sample, "
            f"{seen.delay / seen.loop_period:.0f} samples; the hold alone is half a sample"
        )
        yield f"it gives {_share(seen, 'delay')}"
    else:
        yield _moves(seen)
        yield (
            "the commanded force gives less than the device's friction takes: the rest is put in behind it, "
            "most likely by a delay"
        )


def _moves(seen: Evidence) -> str:
    """What the motion itself says of the force behind a command."""
    assert seen.moves_as is not None
    size, angle = abs(seen.moves_as), float(np.degrees(np.angle(seen.moves_as)))
    where = f"{abs(angle):.0f}° {'behind' if angle < 0 else 'before'} it"
    return f"to move so, the device takes {size:.2g} times the commanded force, {where}"


def _velocity(seen: Evidence) -> Iterator[str]:
    assert seen.law is not None
    window = f"a window of {seen.law.window} samples" if seen.law.window > 1 else "the last difference"
    yield (
        f"B = {shown(seen.law.damping, seen.unit('virtual_damping'), 3)} on {window}, at "
        f"{seen.vibration.frequency * seen.loop_period:.2f} of the sample rate"
    )
    if seen.pulse:
        yield f"each count of the encoder gives the mass (B Δ)²/2m = {shown(seen.pulse, 'J', 2)}"
    yield f"the damper gives {_share(seen, 'differenced velocity')}: it pushes"


def _encoder(seen: Evidence) -> Iterator[str]:
    step = seen.resolution * (seen.law.stiffness if seen.law else 0.0)
    yield f"it moves {seen.counts:.1f} counts of the encoder from end to end"
    if step:
        held = _has(seen.known.coulomb or None, _force(seen), "dry friction holds")
        yield f"half a count is worth K Δ/2 = {shown(step / 2, _force(seen), 3)}{held}"


def _drive(seen: Evidence) -> Iterator[str]:
    if (d := seen.drive) is not None:
        yield (
            f"beside the command the motor gives B = {shown(d.damping, seen.unit('virtual_damping'), 3)} "
            f"times the speed of {shown(d.damping_lag, 's', 3)} ago"
        )
        damper, delay = shown(d.by_damper, "%", 2), shown(d.by_delay, "%", 2)
        yield f"that leaves {damper} of its force unexplained, a delay {delay}"
    elif seen.by_inside is not None:
        yield (
            "the motor's force is that of a spring and of an old speed, which leaves "
            f"{shown(seen.by_inside, '%', 2)} of it unexplained"
        )
    else:
        yield _moves(seen)
        yield "so something pushes with it: a damper inside the drive that is late, or the spring of a cable"


def _compensation(seen: Evidence) -> Iterator[str]:
    assert seen.law is not None
    has, unit = _has(seen.known.coulomb, _force(seen)), _force(seen)
    yield f"the force holds {shown(seen.law.compensation, unit, 3)} along the motion{has}"
    yield f"it gives {_share(seen, 'friction compensation')}"


def _weakening(seen: Evidence) -> Iterator[str]:
    if seen.lost is not None:
        yield (
            f"in a cycle the motor gives {shown(seen.energy, 'J', 2)} and friction should take "
            f"{shown(seen.lost, 'J', 2)}"
        )
    if seen.standing > _STICKS:
        yield f"it stands still for {shown(seen.standing, '%', 2)} of the time, a sine does for 6 %"


def _limit(seen: Evidence) -> Iterator[str]:
    if (d := seen.drive) is not None:
        yield (
            f"the motor's force changes by no more than {shown(d.rate, _force(seen) + '/s', 3)}, which "
            f"leaves {shown(d.by_rate, '%', 2)} of it unexplained, a delay {shown(d.by_delay, '%', 2)}"
        )
        yield f"coming late so gives {_share(seen, 'actuator limit')}"
    elif seen.recorded == "motor":
        yield (
            f"the motor's force changes at one rate for {shown(seen.ramps or 0, '%', 2)} of the "
            f"time, a sine 37 %; its third harmonic is {seen.force_bend.real:.2f} of the first: a triangle "
            "has 0.11, a force that is cut off less than 0"
        )
    else:
        yield _moves(seen)
        yield "so the force behind the command is smaller or later, as of a motor that cannot follow"


def _structure(seen: Evidence) -> Iterator[str]:
    mass = seen.unit("mass")
    has = _has(seen.known.mass, mass)
    yield f"it moves under the motor's force as {shown(seen.apparent_mass, mass, 2)} would{has}"
    if seen.energy < 0:
        taken = shown(-seen.energy, "J", 2)
        yield f"where the sensor sits the motor takes {taken} in a cycle, and it shakes all the same"


def follows(seen: Evidence) -> bool:
    """The force is that of a law; one that is only ever off or at its limit is that of many."""
    return seen.law is not None and seen.law.unexplained < _MOST_UNEXPLAINED


_MOST_UNEXPLAINED = 0.1
"""Share of the force's variance: of a hundred simulated faults one leaves more to its own law."""


def _brakes_late(seen: Evidence) -> bool:
    """A damper accounts for what lies between the two forces, better than a delay; it feeds the motion, as
    far as that is known."""
    d = seen.drive
    feeds = seen.law is None or seen.supplied["drive damping"] > 0
    return d is not None and d.damping > 0 and d.by_damper < d.by_delay and feeds


def _missing(seen: Evidence) -> bool:
    """Less comes in by the forces in the file than the device's friction takes."""
    return seen.lost is not None and seen.energy < seen.lost


def _behind(seen: Evidence) -> bool:
    """The command alone, and the device moves as under a force that comes later than that."""
    late = seen.moves_as is not None and np.angle(seen.moves_as) < 0
    return seen.recorded == "command" and bool(late) and _missing(seen)


def _adds(seen: Evidence) -> bool:
    """The command alone, and the device moves as under a larger force."""
    return seen.recorded == "command" and seen.moves_as is not None and abs(seen.moves_as) > _LARGER


_LARGER = 1.3
"""A stated mass may be wrong by 15 %."""


def _climbs_straight(seen: Evidence) -> bool:
    """The motor's force alone, and it changes at one rate, or has the corners of a triangle."""
    straight = (seen.ramps or 0.0) > STRAIGHT or seen.force_bend.real > _POINTED
    return seen.recorded == "motor" and straight


_POINTED = 0.02
"""Third harmonic of a force against its first: 1/9 of a triangle, below 0 of a force that is cut off."""

_STICKS = 0.15
"""Share of the time that it stands still; a sine does so for 0.06.  Behind a command alone
anything may put in what is missing, so there it must be seen to stick."""

_BOTH = "the motor's own force, from its current, beside the force that the law asks for"
_EVERY = "every sample of the loop, not every second or third"
_DEVICE = "nothing more: give the device's numbers (mass, damping, Coulomb friction) beside the file"

CAUSES: Mapping[str, Cause] = {
    cause.name: cause
    for cause in (
        Cause(
            "sampling",
            "the spring is held from sample to sample and so pushes out harder than it was pressed in",
            lambda s: _gives(s, "sampling") and follows(s),
            _sampling,
            _DEVICE,
        ),
        Cause(
            "delay",
            "the force comes late: it still pushes out where a spring would have let go",
            lambda s: (s.delay > 0 and _given(s, "delay") > _SPEAKS) or (not s.sees_delay and _behind(s)),
            _delay,
            _BOTH,
        ),
        Cause(
            "differenced velocity",
            "virtual damping from differenced positions comes so late that it drives the motion",
            lambda s: s.law is not None and s.law.damping > 0 and _gives(s, "differenced velocity"),
            _velocity,
            _EVERY,
        ),
        Cause(
            "encoder buzz",
            "the loop plays with the last counts of the encoder, and dry friction is too small to stop it",
            lambda s: s.counts < 50,
            _encoder,
            "the position in the encoder's own counts, at every sample of the loop",
        ),
        Cause(
            "drive damping",
            "the drive damps by itself, from a speed that is old, and so drives the motion",
            lambda s: _brakes_late(s) if s.drive is not None else s.recorded == "motor" or _adds(s),
            _drive,
            _BOTH,
        ),
        Cause(
            "friction compensation",
            "more friction is compensated than there is: the compensation drives the motion",
            lambda s: s.law is not None and _gives(s, "friction compensation") and follows(s),
            _compensation,
            _EVERY,
        ),
        Cause(
            "velocity-weakening friction",
            "the device sticks and slips: its friction is larger at rest than in motion",
            lambda s: (
                (_missing(s) or s.energy <= 0)
                and (s.sees_delay or s.standing > _STICKS)
                and (s.lost is not None or s.standing > _STICKS)
            ),
            _weakening,
            "the same motion with the motor off, moved by hand: does it still stick and slip?",
        ),
        Cause(
            "actuator limit",
            "the motor cannot follow: its force comes late because it changes no faster",
            lambda s: (
                _gives(s, "actuator limit") if s.drive is not None else _climbs_straight(s) or _behind(s)
            ),
            _limit,
            _BOTH,
        ),
        Cause(
            "structural resonance",
            "something springy between motor, sensor and handle swings: it is no rigid device",
            lambda s: s.known.mass is not None or s.apparent_mass < 0 or s.energy < 0,
            _structure,
            "a tap on the handle with the motor off: does it ring at this frequency? Then a cable, a belt or "
            "a gear may give way: shake the motor, nobody at the handle, and identify both sides from that",
        ),
    )
}


def features(seen: Evidence) -> dict[str, float]:
    """Every number on which a cause may be weighed, as far as the recording says them."""
    v, k, T = seen.vibration, seen.known, seen.loop_period
    found = seen.law
    supply = sum(max(0.0, w) for w in seen.supplied.values())
    lost = seen.lost or 0.0
    scale = max(supply, lost, abs(seen.total)) or 1.0
    numbers: dict[str, float] = {f"{term} share": max(0.0, seen.supplied[term]) / scale for term in TERMS}
    numbers["net"] = seen.total / scale
    numbers["law takes"] = min(0.0, sum(seen.supplied.values())) / scale
    if np.isfinite(seen.counts):
        numbers["log counts"] = np.clip(np.log10(max(seen.counts, 0.1)), -1, 3)
        numbers["few counts"] = 1.0 / (1.0 + (seen.counts / 6.0) ** 2)
    numbers["has mass"] = float(bool(k.mass))
    numbers["pushes wrong way"] = float(seen.apparent_mass < 0)
    if k.mass:
        ratio = seen.apparent_mass / k.mass
        numbers["light"] = max(0.0, 1 - ratio)
        numbers["heavy"] = np.clip(np.log(max(ratio, 1e-2)), 0, 3)
    if seen.moves_as is not None:
        numbers["moves as size"] = np.clip(np.log(abs(seen.moves_as) + 1e-6), -3, 3)
        numbers["moves as angle"] = np.angle(seen.moves_as) / np.pi
    for name, bend in (("bend", seen.bend), ("force bend", seen.force_bend)):
        numbers[f"{name} even"] = np.clip(bend.real, -0.5, 0.5)
        numbers[f"{name} odd"] = np.clip(bend.imag, -0.5, 0.5)
    numbers["standing"] = seen.standing
    numbers["distortion"] = min(seen.distortion, 1.0)
    numbers["irregular"] = 1 - v.regular
    numbers["frequency"] = v.frequency * T
    if seen.drive is not None:
        d = seen.drive
        for name, left in (("delay", d.by_delay), ("damper", d.by_damper), ("rate", d.by_rate)):
            numbers[f"by {name}"] = -np.log10(max(left, 1e-4)) / 4
        numbers["as commanded"] = -np.log10(max(d.by_nothing, 1e-4)) / 4
        numbers["delay samples"] = min(d.delay / T, 10.0) / 10
    if seen.ramps is not None:
        numbers["ramps"] = seen.ramps
    if seen.by_inside is not None:
        numbers["by inside"] = -np.log10(max(seen.by_inside, 1e-6)) / 6
    numbers["no law"] = float(found is None)
    if found is not None:
        numbers["law unexplained"] = np.log10(max(found.unexplained, 1e-6)) / 6
        numbers["lag samples"] = min(found.lag / T, 10.0) / 10
        numbers["limited"] = found.limited
        if k.damping:
            demand = 0.5 * abs(found.stiffness) * T
            numbers["log spring demand"] = np.clip(np.log10((demand + 1e-12) / k.damping), -2, 2)
            numbers["log damper demand"] = np.clip(np.log10((abs(found.damping) + 1e-12) / k.damping), -3, 3)
        if k.coulomb and seen.resolution:
            step = 0.5 * abs(found.stiffness) * seen.resolution
            numbers["log encoder demand"] = np.clip(np.log10((step + 1e-12) / k.coulomb), -2, 2)
            numbers["log compensation"] = np.clip(
                np.log10((max(found.compensation, 0) + 1e-12) / k.coulomb), -2, 2
            )
    if seen.lost:
        numbers["missing"] = np.clip((seen.lost - seen.total) / scale, -1, 2)
    return {name: float(value) for name, value in numbers.items()}


def vector(numbers: Mapping[str, float], names: tuple[str, ...]) -> np.ndarray:
    """In the order of names; not a number where the recording does not say."""
    return np.array([numbers.get(name, np.nan) for name in names])
