"""Mass, damping and Coulomb friction of a device from a log of its motion.

    m ẍ + b ẋ + f_c sgn ẋ = f_h − f_a

in means over smooth pulses inside strokes (`pulses`), by least squares with the two halves of
the samples as each other's instruments (`moments`), with the scatter of the strokes as the
measure of uncertainty (`regression`).  Abbott & Okamura (2005, section IV-B) fit the same
equation to smoothed and differentiated positions; see `published`.

The length of the pulses is chosen where the intervals are shortest: short pulses are many, but
the encoder's counts show in them; long ones do not fit into a stroke.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Literal, NamedTuple

import numpy as np

from zwidth.compiled import Array
from zwidth.errors import InputError
from zwidth.identification.device.identified import Estimate, Identified
from zwidth.identification.device.moments import Moments
from zwidth.identification.device.pieces import Piece, pieces
from zwidth.identification.device.points import Points
from zwidth.identification.device.pulses import PIECES, Pulse, pulse
from zwidth.identification.device.regression import Regression, regress
from zwidth.identification.logs import Finding, Log

LENGTHS = (4, 6, 8, 10, 12, 16, 20, 24, 32, 40, 48, 64, 96, 128, 192, 256)
"""Samples h of a piece of a pulse that are tried."""

LONGER = 2
"""Times the length of the other pulses, which show what the length matters."""

SAFETY = 4 / 3
"""Times that change which is taken for the error of the method: an error that falls as h⁻² needs
1/(1 − 2⁻²); those of counts and curves fall faster."""

SHARE = 0.5
"""Part of the strokes that the longer pulses must still fit into."""

PILOT = 300_000
"""Samples of the beginning on which the length is chosen."""

SURE = 0.999
"""Confidence above which a further term is believed to be there."""

NUISANCES = ("spring", "force_lag")
"""Terms that are fitted where they are seen: they are not friction."""

Zero = Literal["drifts", "constant", "exact"]


class Found(NamedTuple):
    """What one way through the log leaves."""

    moments: Moments
    longer: Moments
    points: Points


def identify(
    log: Log,
    *,
    mass: float | None = None,
    delay: float = 0.0,
    zero: Zero | None = None,
    model: Literal["Coulomb and viscous", "viscous"] = "Coulomb and viscous",
    progress: Callable[[int, int], None] | None = None,
) -> Identified:
    """Identify a device: ``m ẍ + b ẋ + f_c sgn ẋ = f_h − f_a``.

    Parameters
    ----------
    log
        What was recorded, see `read_log`: the position and the force of the hand, or of the actuator, or both.
        Without any force mass must be given: a free motion shows b/m and f_c/m only.
    mass
        m > 0 where it is known [kg; kg·m²].
    delay
        From a sample to the actuator force computed from it, ≥ 0 [s].
    zero
        Of the force: "drifts" along straight lines of some seconds (a load cell; the default where there is
        a hand force), "constant" (gravity; the default otherwise), or "exact".
    model
        "viscous" fits a mass and a damper; where Coulomb friction is seen, it says so.
    progress
        Told (samples done, samples in all).

    Raises
    ------
    InputError
        If the log shows too little: too few strokes, or no force and no mass.
    """
    zero = _checked(log, mass, delay, zero)
    shape = _choose(log, delay / log.sample_period, mass, zero)
    other = pulse(LONGER * shape.piece, delay / log.sample_period)
    found = Found(Moments(), Moments(), Points())
    done = 0
    for piece in pieces(log):
        rows = piece.pulses(shape, log.sample_period)
        found.moments.add(rows, zero)
        found.points.add(rows, zero)
        found.longer.add(piece.pulses(other, log.sample_period), zero)
        done += piece.position.size
        if progress is not None:
            progress(done, log.samples)
    return _identified(log, found, shape, mass, model)


def _checked(log: Log, mass: float | None, delay: float, zero: Zero | None) -> Zero:
    if not log.channels and mass is None:
        raise InputError(
            f"{log.source} has no force: a free motion shows b/m and f_c/m only; give the mass "
            "(a kitchen scale will do), or log the force of the hand or of the actuator"
        )
    if mass is not None and not 0 < mass < np.inf:
        raise InputError(f"mass must be > 0 and finite, got {mass!r}: it is what the force accelerates")
    if not 0 <= delay < np.inf:
        raise InputError(f"delay must be ≥ 0 s, got {delay!r}: the force follows the sample it came from")
    if zero is None:
        return "drifts" if "hand_force" in log.channels else "constant"
    if zero not in ("drifts", "constant", "exact"):
        raise InputError(f'zero is "drifts", "constant" or "exact", got {zero!r}')
    return zero


def _choose(log: Log, delay: float, mass: float | None, zero: Zero) -> Pulse:
    """The pulse with the shortest intervals on the first samples."""
    pilot = list(_first(pieces(log)))
    names = _names(mass, "Coulomb and viscous")
    sums: dict[int, Moments] = {}
    halves: dict[int, Array] = {}
    for piece in LENGTHS:
        for h in (piece, LONGER * piece):
            if h not in sums:
                sums[h] = Moments()
                for stretch in pilot:
                    sums[h].add(stretch.pulses(pulse(h, delay), log.sample_period), zero)
        fit, longer = regress(sums[piece], names, mass), regress(sums[LONGER * piece], names, mass)
        if fit is None or longer is None or sums[LONGER * piece].strokes < SHARE * sums[piece].strokes:
            break
        halves[piece] = fit.reach(0.95) * np.sqrt(np.diag(fit.covariance)) + _shifts(fit, longer)
    if not halves:
        raise InputError(_too_little(log, pilot))
    best = np.min(list(halves.values()), axis=0)
    return pulse(min(halves, key=lambda h: float((halves[h] / best).sum())), delay)


def _shifts(fit: Regression, longer: Regression) -> Array:
    """What the method may be off, by the change with longer pulses."""
    change: Array = np.abs(fit.values - longer.values)
    return SAFETY * change


def _first(stream: Iterable[Piece]) -> Iterable[Piece]:
    held = 0
    for piece in stream:
        yield piece
        held += piece.position.size
        if held >= PILOT:
            return


def _too_little(log: Log, pilot: list[Piece]) -> str:
    strokes = sum(p.strokes.first.size for p in pilot)
    seconds = sum(p.position.size for p in pilot) * log.sample_period
    return (
        f"{log.source}: the motion shows too little to tell mass, damping and friction apart: {strokes} strokes "
        f"in {seconds:.3g} s, of which too few are long enough or they are too much alike; move to and fro for a "
        "minute, over most of the workspace, slowly and quickly, and do not rest"
    )


def _names(mass: float | None, model: str) -> tuple[str, ...]:
    names = ("damping", "coulomb_friction") if model == "Coulomb and viscous" else ("damping",)
    return names if mass is not None else ("mass", *names)


def _identified(log: Log, found: Found, shape: Pulse, mass: float | None, model: str) -> Identified:
    moments = found.moments
    names = _names(mass, model)
    nuisances = NUISANCES if log.channels else NUISANCES[:1]
    names = (*names, *(term for term in nuisances if _is_seen(found, names, term, mass)))
    fit, longer = regress(moments, names, mass), regress(found.longer, names, mass)
    if fit is None or longer is None:
        raise InputError(_too_little(log, list(_first(pieces(log)))))
    units = _units(log.motion)
    estimates = _shown(fit, longer, units)
    viscous = regress(moments, tuple(n for n in names if n != "coulomb_friction"), mass)
    assert viscous is not None  # fewer parameters than the fit above
    findings = [*log.findings, *_findings(found, names, mass, viscous, estimates, log)]
    return Identified(
        estimates=estimates,
        mass=mass,
        sample_period=log.sample_period,
        resolution=log.resolution,
        motion=log.motion,
        source=log.source,
        explained=fit.explained,
        force_noise=float(np.sqrt(fit.residual / np.sum((shape.value / shape.piece) ** 2))),
        offset=moments.offset(fit, mass),
        viscous_alone=viscous.value("damping"),
        pulse_length=PIECES * shape.piece * log.sample_period,
        strokes=moments.strokes,
        pulses=moments.pulses,
        findings=tuple(findings),
        points=found.points.dataset(fit, mass, log.motion),
    )


def _shown(fit: Regression, longer: Regression, units: Mapping[str, str]) -> dict[str, Estimate]:
    return {
        name: Estimate(fit.value(name), fit.error(name), float(shift), fit.degrees, units[name])
        for name, shift in zip(fit.names, _shifts(fit, longer), strict=True)
    }


def _is_seen(found: Found, names: tuple[str, ...], term: str, mass: float | None) -> bool:
    """True where a term is larger than its uncertainty, that of the method included."""
    fit, longer = (regress(sums, (*names, term), mass) for sums in (found.moments, found.longer))
    if fit is None or longer is None:
        return False
    return _shown(fit, longer, _units("linear"))[term].beyond(SURE)


def _findings(
    found: Found,
    names: tuple[str, ...],
    mass: float | None,
    viscous: Regression,
    estimates: dict[str, Estimate],
    log: Log,
) -> Iterable[Finding]:
    period, units = log.sample_period, _units(log.motion)
    stiffness = units["spring"]
    if "coulomb_friction" not in names:
        if _is_seen(found, names, "coulomb_friction", mass):
            full = regress(found.moments, (*names, "coulomb_friction"), mass)
            assert full is not None
            yield Finding(
                kind="wrong model",
                text=f"a mass and a damper are the wrong model: Coulomb friction of {full.value('coulomb_friction'):.3g} "
                f"{units['coulomb_friction']} is seen; without it 2b/T reads {2 * viscous.value('damping') / period:.4g} "
                f"{stiffness} instead of {2 * full.value('damping') / period:.4g} {stiffness}, and a wall between the two "
                "would be called passive and is not",
            )
    elif estimates["coulomb_friction"].beyond(SURE):
        yield Finding(
            kind="Coulomb friction",
            text=f"Coulomb friction is seen; a mass–damper model of the same data would say "
            f"b = {viscous.value('damping'):.3g} {units['damping']}, 2b/T = {2 * viscous.value('damping') / period:.4g} "
            f"{stiffness} instead of {2 * estimates['damping'].value / period:.4g} {stiffness}",
        )
    for name in ("damping", "coulomb_friction"):
        if name in estimates and estimates[name].interval(0.95)[0] <= 0:
            yield Finding(
                kind=f"no {name.replace('_', ' ')}",
                text=f"the data do not rule out that {name.replace('_', ' ')} is 0: {estimates[name]}",
            )
    for name, what in (("spring", "a spring, or gravity on an arc"), ("force_lag", "a force recorded late")):
        if name in estimates:
            yield Finding(kind=name.replace("_", " "), text=f"{what}, is seen and fitted: {estimates[name]}")
    if _is_seen(found, names, "quadratic", mass):
        bent = regress(found.moments, (*names, "quadratic"), mass)
        assert bent is not None
        yield Finding(
            kind="bent friction",
            text=f"friction is not f_c + b |v|: a term c v |v| with c = {bent.value('quadratic'):.3g} "
            f"{units['quadratic']} is seen; look at the friction curve and take a model below it",
        )


def _units(motion: str) -> dict[str, str]:
    turn = motion == "rotary"
    return {
        "mass": "kg m²" if turn else "kg",
        "damping": "N m s/rad" if turn else "N s/m",
        "coulomb_friction": "N m" if turn else "N",
        "spring": "N m/rad" if turn else "N/m",
        "quadratic": "N m s²/rad²" if turn else "N s²/m²",
        "force_lag": "s",
    }
