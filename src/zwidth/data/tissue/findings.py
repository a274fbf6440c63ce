"""What was odd in a recording of a tissue, in sentences; and what is of no tissue, refused."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import log, sqrt
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from zwidth.data.identification.device.choice import SURE
from zwidth.data.logs import Finding
from zwidth.data.logs.sensors import Stops, at_ends, beyond, grid_of
from zwidth.data.tissue.model import Model, Record
from zwidth.errors import InputError
from zwidth.model.environment.modes import decaying, samples
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.text import from_to, quantity_unit, shown

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

SOFTEST, STIFFEST = 5.0, 5e4
"""Between them lies what a probe feels of soft tissue, phantoms included [N/m]."""

DEEPEST, SHALLOWEST = 0.5, 2e-5
"""Between them lies how deep a probe goes [m]."""

SHARE = 0.5
"""Of what is left, which the steps of the position may make before it is said."""

POOR, GOOD = 0.5, 0.8
"""Of the variance, explained below which a sign is doubted, and above which the other one is believed."""


def unlikely_units(stiffness: float, depth: float) -> Iterator[str]:
    """Why a stiffness at once, or a depth, is hardly that of a tissue."""
    if not SOFTEST <= stiffness <= STIFFEST:
        yield (
            f"a stiffness at once of {shown(stiffness, 'N/m', 3)} is hardly soft tissue under a probe, "
            f"{from_to(SOFTEST, STIFFEST, 'N/m')}: most likely a unit is off by 1000"
        )
    if depth > DEEPEST or 0 < depth < SHALLOWEST:
        yield (
            f"positions up to {depth:.3g} are hardly metres inside a tissue: most likely their unit is "
            "another"
        )


def coarse(position: Array, stiffness: float, rms: float, unit: str) -> Iterator[str]:
    """Why intervals are too narrow: most of what the fit leaves [N; N·m] may be steps of the position."""
    grid, moves = grid_of(position), np.diff(position)
    if grid is None:
        return
    alike = np.abs(np.diff(moves)) < 0.5 * grid.step
    steady = (moves[1:-1] != 0) & alike[1:] & alike[:-1]  # on a ramp of one speed, sample by sample
    is_ramp = 2 * np.count_nonzero(steady) > np.count_nonzero(moves)
    if not is_ramp and stiffness * grid.step / sqrt(12.0) > SHARE * rms > 0:
        yield (
            f"the position is read in steps of {shown(grid.step, unit, 3)}, and most of what the fit leaves "
            "may come from them: the intervals take the position for exact and are too narrow; move further, "
            "or read it more finely"
        )


def refuse_sign(record: Record, left: Array, size: float, again: Callable[[Record], Array]) -> None:
    """Refuse a record that is of a tissue only with the other sign, by what a fit of each leaves."""
    spread = float(np.var(record.output)) / size**2
    if spread == 0 or float(np.mean(left**2)) < (1 - POOR) * spread:
        return
    if float(np.mean(again(record._replace(force=-record.force)) ** 2)) < (1 - GOOD) * spread:
        raise InputError(
            "no tissue pulls the probe in: with the sign of the force turned round, or that of the position, "
            "the record is of one; give positions that are positive inside the tissue and forces that are "
            "positive out of it"
        )


def findings(
    record: Record,
    faults: Faults,
    zero: Array,
    late: float,
    stops: tuple[float, float],
    left_out: int,
    motion: str,
) -> Iterator[Finding]:
    """What was found, and what was done about it. `zero` is that at the start, then further on [N; N·m]; the
    force is `late` [s]; `left_out` samples at the ends of the sensor's range do not count."""
    unit = quantity_unit(record.response, motion)
    ends = at_ends(stops, unit)
    if ends:
        text = (
            f"the force stays at {ends}: the sensor is at an end of its range; {left_out} samples do "
            "not count"
        )
        yield Finding(kind="saturated", text=text, samples=left_out)
    if record.begins:
        places = ", ".join(shown(record.time[b], "s") for b in record.begins[:3])
        text = (
            f"{len(record.begins)} holes, before t = {places}{' …' if len(record.begins) > 3 else ''}: what "
            "the branches held after each was fitted"
        )
        yield Finding(kind="hole", text=text)
    if faults.drift:
        text = (
            f"the zero drifts: from {shown(zero[0], unit, 3)} at the start by "
            f"{shown(zero[-1], unit, 3)}; fitted besides"
        )
        yield Finding(kind="drift", text=text)
    elif faults.offset:
        text = f"the zero is off by {shown(zero[0], unit, 3)}; fitted besides"
        yield Finding(kind="offset", text=text)
    if faults.late:
        yield _lateness(faults.late, late)


def _lateness(kind: str, late: float) -> Finding:
    if late < 0:
        text = (
            f"the force looks {shown(-late, 's', 3)} early: the position is recorded late, or the model has "
            "too few elements; fitted as a delay"
        )
        return Finding(kind="force early", text=text)
    how = "a delay" if kind == "delay" else "a filter of the first order with this time constant"
    by = shown(late, "s", 3)
    text = f"the force is recorded {by} late, or the model has too few elements; fitted as {how}"
    return Finding(kind="force late", text=text)


# What a recording of a tissue adds to the tissue: a zero that is off or drifts, a late force, holes in time.
#
#     f(t) = (h * f̂)(t − τ) + z(t),     z straight in each ten seconds
#
# f̂ the force of the model, τ a delay, or h a filter of the first order with the time constant τ.  After a
# hole nobody knows what the branches hold: each begins with a force of its own, and it fades as the branch
# does.
#
# Each is looked for in what the fit leaves over.  With r the residuals, J the derivatives by what was fitted,
# G those by what is asked about, and A e = ε the noise,
#
#     u = G⊥ᵀ r,   G⊥ = G − J J⁺ G,   V = σ² G⊥ᵀ A⁻¹ A⁻ᵀ G⊥,   uᵀ V⁻¹ u ~ χ²
#
# if nothing is there (the score test of Rao, 1948, with the covariance below).

DRIFT = 10.0
"""Time over which the zero of a force may drift along a straight line [s]."""

HOLE = 2.5
"""Times the intervals before and after it by which a longer one is a hole."""

MOST_HOLES = 50
"""Beyond, what is left between them says little."""

HELD = 0.02
"""Part of the position's range within which a probe is held, and the force may stay as it is."""

THRESHOLD = 1.0 - SURE
"""Chance below which a fault is believed to be there."""

FINER = 4
"""Instants in each interval at which a filter is reckoned."""

LEAST = 1e-9
"""A filter that is quicker is a delay [s]."""


class Faults(NamedTuple):
    """What is fitted beside the tissue."""

    offset: bool = False
    drift: bool = False
    """A constant; and that it wanders."""
    late: str = ""
    """"", "delay" or "filter"."""

    def zero(self, time: Array) -> Array:
        """The columns that a zero may be made of, each from 0 to 1."""
        columns = [np.ones(time.size)] if self.offset or self.drift else []
        return (
            np.stack([*columns, *(_wandering(time) if self.drift else [])], axis=1)
            if columns
            else np.empty((time.size, 0))
        )

    def delayed(self, predicted: Array, time: Array, late: float) -> Array:
        """A prediction as it is recorded late by so much [s]; smooth between its samples."""
        if not self.late:
            return predicted
        from scipy.interpolate import CubicHermiteSpline  # scipy takes its time

        smooth = CubicHermiteSpline(time, predicted, np.gradient(predicted, time))
        if self.late == "delay" or late < LEAST:
            return np.asarray(smooth(time - late))
        fine = np.interp(np.arange(FINER * (time.size - 1) + 1) / FINER, np.arange(time.size), time)
        values = smooth(fine)
        return np.asarray((values - decaying(np.diff(fine), np.diff(values), 1.0 / late))[::FINER])


def _wandering(time: Array) -> list[Array]:
    """Straight between knots some ten seconds apart, 0 at the first of them."""
    span = float(time[-1] - time[0])
    knots = np.linspace(0.0, span, max(round(span / DRIFT), 1) + 1)
    return [np.interp(time - time[0], knots, row) for row in np.eye(knots.size)[1:]]


def hole_places(time: Array, position: Array) -> tuple[int, ...]:
    """The samples that come after a hole in time across which the position moved."""
    steps = np.diff(time)
    padded = np.concatenate([[np.inf], steps, [np.inf]])
    beside = np.minimum(np.maximum(padded[:-2], padded[2:]), np.minimum(padded[:-2], padded[2:]) * 4)
    holes = np.flatnonzero((steps > HOLE * beside) & (np.diff(position) != 0)) + 1
    holes = holes[(holes > 1) & (holes < time.size - 1)]
    if holes.size > MOST_HOLES:
        raise InputError(
            f"the record has {holes.size} holes in time, the first after t = "
            f"{shown(time[holes[0] - 1], 's', 6)}: what a tissue holds after each is not known; lose no "
            "samples, or give a part with fewer"
        )
    return tuple(holes.tolist())


def stops_of(force: Array) -> tuple[float, float]:
    """The readings at which a load cell seems to be at an end of its range; infinite where it is not."""
    stops = Stops()
    stops.take(force)
    return stops.found()[0]


def unlikely(jacobian: Array, left: Array, columns: Array, noise: Noise) -> float:
    """How seldom what is left would be so much like the columns by chance: p of the score test."""
    if not columns.size:
        return 1.0
    basis = np.linalg.qr(jacobian)[0]
    beside = columns - basis @ (basis.T @ columns)
    if not (np.linalg.norm(beside, axis=0) > 1e-6 * np.linalg.norm(columns, axis=0)).all():
        return 1.0
    back = coloured(noise.coefficients, beside[::-1])
    score = beside.T @ left
    spread = noise.variance * back.T @ back
    value = float(score @ np.linalg.lstsq(spread, score, rcond=None)[0])
    return by_chance(value, columns.shape[1])


def sudden(model: Model, p: list[float], record: Record, left: Array) -> int | None:
    """The sample at which a branch most likely changed unseen; None where it has no memory. By correlating
    what is left with exp(−t/τ) from each sample on."""
    if not model.linear or record.response == "position" or not model.elements(p).branches:
        return None
    mu, eta = max(model.elements(p).branches, key=lambda pair: pair[1])
    keep = float(np.exp(-np.median(np.diff(record.time)) * mu / eta))
    ahead = coloured(np.array([1.0, -keep]), left[::-1, None])[::-1, 0]
    weight = coloured(np.array([1.0, -keep * keep]), np.ones((left.size, 1)))[::-1, 0]
    score = np.abs(ahead) / np.sqrt(weight)
    score[:2] = score[-8:] = 0.0
    return int(np.argmax(score))


# How well the parameters are known: their covariance where the noise has a memory.
#
# The residuals e are taken as an autoregressive process, A e = ε with ε white of variance σ², of the order
# that BIC prefers; 0 is white noise.  The estimate is that of ordinary least squares, whose covariance then
# is
#
#     (JᵀJ)⁻¹ Jᵀ Ω J (JᵀJ)⁻¹,     Ω = σ² A⁻¹ A⁻ᵀ
#
# J the derivatives of the prediction by the logarithms of the parameters.  White noise gives the usual σ²
# (JᵀJ)⁻¹.  A memory leaves fewer independent samples than there are, N_e = N γ0 A(1)²/σ² ≤ N with γ0 the
# variance of e: the fit has taken k of them, so that Ω is multiplied by N_e/(N_e − k) and Student's t has N_e
# − k degrees of freedom. Assumed: the model is right, the noise of zero mean, stationary and as likely in
# every sample, small enough for the linear J, and the input free of it.

LARGEST_ORDER = 12
"""Of the noise; a memory longer than so many samples is cut."""

_SMALLEST = 1e-12
"""Singular values below this share of the largest are rounding."""


class Noise(NamedTuple):
    """A e = ε: 1, a1 … ap; the variance of ε; and how many samples would say as much without memory, N_e."""

    coefficients: Array
    variance: float
    samples: float

    @property
    def order(self) -> int:
        return self.coefficients.size - 1


def noise_of(residuals: Array, largest_order: int = LARGEST_ORDER) -> Noise:
    """The autoregressive process of the order that BIC prefers, by Levinson's recursion."""
    n = residuals.size
    largest = min(largest_order, n // 20)
    covariances = [float(residuals[k:] @ residuals[: n - k]) / n for k in range(largest + 1)]
    floor = np.finfo(float).tiny
    a, variance = np.ones(1), max(covariances[0], floor)
    best, score = Noise(a, variance, n), n * log(variance)
    for p in range(1, largest + 1):
        reflection = -sum(a[i] * covariances[p - i] for i in range(p)) / variance
        a = np.append(a, 0.0) + reflection * np.append(a, 0.0)[::-1]
        variance = max(variance * (1.0 - reflection**2), floor)
        if n * log(variance) + p * log(n) < score:
            fewer = n * min(covariances[0] * float(a.sum()) ** 2 / variance, 1.0)
            best, score = Noise(a, variance, fewer), n * log(variance) + p * log(n)
    return best


def coloured(coefficients: Array, white: Array) -> Array:
    """Noise of white noise, column by column: y(k) = w(k) − Σ a_i y(k − i)."""
    found = np.empty(white.shape)
    _colour(coefficients, np.ascontiguousarray(white), found)
    return found


@compiled
def _colour(coefficients: Array, white: Array, found: Array) -> None:
    for k in range(white.shape[0]):
        for column in range(white.shape[1]):
            before = 0.0
            for i in range(min(k, coefficients.shape[0] - 1), 0, -1):
                before -= coefficients[i] * found[k - i, column]
            found[k, column] = before + white[k, column]


def by_chance(value: float, degrees: int) -> float:
    """How seldom a sum of so many squares of white noise, each of variance 1, is larger."""
    from scipy.special import chdtrc  # scipy.stats, which has it too, takes four times as long to load

    return float(chdtrc(degrees, max(value, 0.0))) if degrees > 0 else float("nan")


def covariance(jacobian: Array, noise: Noise) -> tuple[Array, float]:
    """The covariance of the parameters, and the condition number of the Jacobian."""
    u, s, vt = np.linalg.svd(jacobian, full_matrices=False)
    largest = s[0] if s.size and s[0] > 0.0 else 1.0
    kept = np.maximum(s, _SMALLEST * largest)
    back = coloured(noise.coefficients, u[::-1])
    k = jacobian.shape[1]
    scale = noise.variance * noise.samples / max(noise.samples - k, 1.0)
    half = back / kept @ vt
    return scale * half.T @ half, float(largest / s[-1]) if s[-1] > 0.0 else float("inf")


AGAINST = -0.5
"""Correlation of depth and force, inside, below which a record is of no tissue: a solid resists."""

FAR = 100.0
"""Times by which a start may be wrong before its units are doubted."""

FEWEST = 30
"""Samples inside below which nothing is said of the sign."""


def passed_over(
    position: Array, force: Array, time: ArrayLike | None, period: float, stiffness: float
) -> tuple[NDArray[np.bool_], tuple[Finding, ...]]:
    """Which samples of a record are passed over, and why: at an end of the sensor's range, and after a hole.
    `stiffness` is that at once, of the solid that the tracker starts from [N/m; N·m/rad]."""
    _check_sign(position, force)
    passed, findings = np.zeros(force.size, dtype=bool), [*_units(position, force, stiffness)]
    stopped = _stopped(position, force)
    if stopped.any():
        passed |= stopped
        text = f"the sensor is at an end of its range in {stopped.sum()} samples, which are passed over"
        findings.append(Finding(kind="saturated", text=text, samples=int(stopped.sum())))
    if time is not None and force.size > 1:
        after = np.append(False, np.diff(samples(time, force, "force")[0]) > 1.5 * period)
        if after.any():
            passed |= after
            text = f"{after.sum()} holes in time; after each the tracker begins anew with what it knows"
            findings.append(Finding(kind="hole", text=text, samples=int(after.sum())))
    return passed, tuple(findings)


def _stopped(position: Array, force: Array) -> NDArray[np.bool_]:
    """At a stop while the probe moves; a force that stays where the probe is held is no stop."""
    found = np.zeros(force.size, dtype=bool)
    low, high = stops_of(force)
    for at in (beyond(force, (low, np.inf)), beyond(force, (-np.inf, high))):
        if at.any() and np.ptp(position[at]) > HELD * np.ptp(position):
            found |= at
    return found


def _units(position: Array, force: Array, stiffness: float) -> Iterator[Finding]:
    inside = position > 0
    moved = float(np.ptp(position[inside])) if inside.any() else 0.0
    if position.size >= FEWEST and not inside.any():
        text = (
            "the position is never inside the tissue, x > 0: nothing is learnt; does it count the other way?"
        )
        yield Finding(kind="outside", text=text)
    if not moved:
        return
    times = float(np.ptp(force[inside])) / moved / stiffness
    if not 1 / FAR <= times <= FAR:
        text = (
            f"the force goes about {times:.3g} times as much as that of the solid at the start: most likely "
            "a unit is off by 1000, mm for m or mN for N"
        )
        yield Finding(kind="units", text=text)


def _check_sign(position: Array, force: Array) -> None:
    inside = position > 0
    if np.count_nonzero(inside) < FEWEST:
        return
    depth, push = position[inside], force[inside]
    if np.std(depth) == 0 or np.std(push) == 0 or np.corrcoef(depth, push)[0, 1] > AGAINST:
        return
    raise InputError(
        "the force falls where the probe goes deeper, and no tissue pulls it in: give positions that "
        "are positive "
        "inside the tissue and forces that are positive out of it; one of the two counts the other way"
    )
