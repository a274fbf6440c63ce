"""The search for a tissue's parameters, again for each fault that what is left over shows.

First the tissue alone.  Then whatever of offset, drift, lateness and a hole without stamps is least likely
to be there by chance is fitted too, until nothing is left at 99.9 %.  Samples at an end of the sensor's
range count nothing; which samples those are is decided by what is predicted, not by what was read, so that
noise does not choose.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from zwidth.data.tissue.findings import (
    HELD,
    LARGEST_ORDER,
    THRESHOLD,
    Faults,
    Noise,
    covariance,
    findings,
    noise_of,
    refuse_sign,
    stops_of,
    sudden,
    unlikely,
)
from zwidth.data.tissue.model import Model, Record, starting_points
from zwidth.data.tissue.result import TissueFit
from zwidth.errors import InputError
from zwidth.native.compiled import Array

DECADES = 30.0
"""How far the logarithm of a parameter may go from where it began."""

ROUNDS = 8
"""Faults that are fitted beside a tissue, at the most."""

TRIES = 50
"""Evaluations of a search with faults, at the most: it begins near where the last one ended."""

TOLD_APART = 40.0
"""Of twice the logarithm of the likelihood, beyond which a delay and a filter are told apart."""

FEW = 30.0
"""Independent samples below which the noise may be a drift."""

NOWHERE = (-np.inf, np.inf)

EXACT = 1e-7
"""Residuals below this part of the largest output are rounding."""

Mask = np.ndarray[Any, np.dtype[np.bool_]]


class Task(NamedTuple):
    """A model, a record, the samples that count, what is fitted besides, and the memory that noise may
    have."""

    model: Model
    record: Record
    used: Mask
    faults: Faults
    largest_order: int

    @property
    def own(self) -> int:
        return len(self.model.parameters)

    @property
    def size(self) -> float:
        return float(np.abs(self.record.output).max()) or 1.0


class Solved(NamedTuple):
    """θ, the residuals of the samples that count as parts of the size, their derivatives, and the noise."""

    theta: Array
    left: Array
    jacobian: Array
    noise: Noise
    cost: float


def fitted(model: Model, record: Record, offset: bool, noise: str, motion: str) -> TissueFit:
    """The fit, with all that was found in the record; with an offset, whether or not it is seen."""
    order = 0 if noise == "white" else LARGEST_ORDER
    task = Task(model, record, np.ones(record.time.size, dtype=bool), Faults(offset=offset), order)
    stops = stops_of(record.force) if record.response == "force" else NOWHERE
    inside = _within(task, stops) if np.isfinite(stops).any() else None
    task, solved, stops = inside or (*_searched(task), NOWHERE)
    refuse_sign(
        task.record, solved.left, task.size, lambda other: _searched(task._replace(record=other))[1].left
    )
    return _result(task, solved, stops, motion)


def _searched(task: Task) -> tuple[Task, Solved]:
    """The task with every fault that is seen, and its solution."""
    solved = _solve(task, starting_points(task.model, task.record))
    for _ in range(ROUNDS):
        more = _fault(task, solved)
        if more is None:
            break
        again = _solve(more, _starts(more, solved))
        if again.cost > solved.cost:
            break
        task, solved = more, again
    return task, solved


def _starts(task: Task, before: Solved) -> list[Array]:
    """Where the search went before, and where it would begin without the zero."""
    own = np.exp(before.theta[: task.own])
    zero = task.faults.zero(task.record.time)
    if not zero.size or not task.model.linear or task.record.response == "position":
        return [own]
    columns = np.column_stack([task.record.position, zero])
    found = np.linalg.lstsq(columns, task.record.force, rcond=None)[0]
    return [
        own,
        *starting_points(task.model, task.record._replace(force=task.record.force - zero @ found[1:])),
    ]


def _fault(task: Task, solved: Solved) -> Task | None:
    """The task with the fault that is least likely to be there by chance; None where none is seen."""
    if np.sqrt(np.mean(solved.left**2)) < EXACT:
        return None
    found = [(chance, other) for chance, other in _asked(task, solved) if chance < 1.0]
    if not found:
        return _hidden_drift(task, solved)
    other = min(found, key=lambda pair: pair[0])[1]
    if other.faults.late == task.faults.late:
        return other
    kinds = [task._replace(faults=task.faults._replace(late=kind)) for kind in ("delay", "filter")]
    return min(kinds, key=lambda kind: _solve(kind, _starts(kind, solved)).cost)


def _hidden_drift(task: Task, solved: Solved) -> Task | None:
    """The task with a drift, where the noise took it for its own memory and says less of it once it is
    fitted."""
    if task.faults.drift or solved.noise.samples > FEW:
        return None
    other = task._replace(faults=task.faults._replace(drift=True))
    n = solved.left.size
    before, after = (
        n * np.log(noise.variance) + noise.order * np.log(n)
        for noise in (solved.noise, _solve(other, _starts(other, solved)).noise)
    )
    return other if before - after > len(_further(other)) * np.log(n) else None


def _asked(task: Task, solved: Solved) -> Iterator[tuple[float, Task]]:
    """Each fault not yet fitted, and how likely it is by chance, beside what is believed."""
    time, faults, record = task.record.time, task.faults, task.record

    def chance(columns: Array, least: float = THRESHOLD) -> float:
        return unlikely(solved.jacobian, solved.left, columns[task.used], solved.noise) / least

    if not faults.offset and not faults.drift:
        yield chance(np.ones((time.size, 1))), task._replace(faults=faults._replace(offset=True))
    if not faults.drift:
        drift = faults._replace(drift=True)
        yield chance(drift.zero(time)), task._replace(faults=drift)
    if not faults.late and record.response == "force":
        slope = np.gradient(_predicted(task, solved.theta), time)
        yield chance(slope[:, None]), task._replace(faults=faults._replace(late="delay"))
    left = np.zeros(time.size)
    left[task.used] = solved.left
    values = _values(task, solved.theta)
    place = sudden(task.model, values, record, left)
    if place is not None and place >= 4 and all(abs(place - b) >= 4 for b in record.begins):
        holed = record._replace(begins=tuple(sorted((*record.begins, place))))
        columns = np.stack(task.model.fading(values, holed, place), axis=1)
        yield chance(columns, THRESHOLD / time.size), task._replace(record=holed)


def _within(task: Task, stops: tuple[float, float]) -> tuple[Task, Solved, tuple[float, float]] | None:
    """The solution without what the sensor cannot say; None where it could, as where a motion rests."""
    force = task.record.force
    at_low, at_high = force <= stops[0], force >= stops[1]
    at = at_low | at_high
    if not _plenty(task, ~at) and np.ptp(task.record.position[at]) <= HELD * np.ptp(task.record.position):
        return None
    task, solved = _searched(task._replace(used=_enough(task, ~at)))
    spread = 3.0 * float(np.sqrt(np.mean(solved.left**2))) * task.size
    predicted = _predicted(task, solved.theta)
    low, high = stops
    if not at_low.any() or np.median(predicted[at_low]) > low - spread:
        low = -np.inf
    if not at_high.any() or np.median(predicted[at_high]) < high + spread:
        high = np.inf
    if not np.isfinite((low, high)).any():
        return None
    inside = (predicted > low + spread) & (predicted < high - spread) & (force > low) & (force < high)
    task = task._replace(used=_enough(task, inside))
    return task, _solve(task, [np.exp(solved.theta[: task.own])]), (low, high)


def _plenty(task: Task, used: Mask) -> bool:
    return bool(np.count_nonzero(used) >= max(0.3 * used.size, 4 * task.own))


def _enough(task: Task, used: Mask) -> Mask:
    if not _plenty(task, used):
        raise InputError(
            f"in {used.size - np.count_nonzero(used)} of {used.size} samples the force is at an end of the "
            "sensor's range, and what is left shows too little: press less, or take a larger load cell"
        )
    return used


def _result(task: Task, solved: Solved, stops: tuple[float, float], motion: str) -> TissueFit:
    count, size = task.own, task.size
    zero = task.faults.zero(task.record.time).shape[1]
    own = count + (zero > 0)
    spread, condition = covariance(_alike(solved.jacobian, own), solved.noise)
    scale = np.ones(own)
    scale[count:] = size
    estimates = np.append(solved.theta[:count], solved.theta[count:own] * size)
    return TissueFit(
        model=task.model,
        estimates=estimates,
        covariance=(spread[:own, :own] + _either(task, solved, own)) * np.outer(scale, scale),
        residuals=-solved.left * size,
        output=task.record.output[task.used],
        response=task.record.response,
        condition=condition,
        noise_order=solved.noise.order,
        independent_samples=solved.noise.samples,
        motion=motion,
        further=solved.theta.size - own,
        findings=tuple(
            findings(
                task.record,
                task.faults,
                solved.theta[count : count + zero] * size,
                _late(task, solved.theta),
                stops,
                int(np.count_nonzero(~task.used)),
                motion,
            )
        ),
        position=task.record.position,
        time=task.record.time[task.used],
    )


def _either(task: Task, solved: Solved, own: int) -> Array:
    """What the tissue would be by a filter instead of a delay, or the reverse, squared, where both fit as
    well."""
    if not task.faults.late:
        return np.zeros((own, own))
    other = task._replace(
        faults=task.faults._replace(late="filter" if task.faults.late == "delay" else "delay")
    )
    found = _solve(other, _starts(other, solved))
    if solved.left.size * np.log(found.noise.variance / solved.noise.variance) > TOLD_APART:
        return np.zeros((own, own))
    apart = found.theta[:own] - solved.theta[:own]
    return np.asarray(np.outer(apart, apart))


def _alike(jacobian: Array, own: int) -> Array:
    """The derivatives by what was fitted besides, of the size of the others: their units mean nothing."""
    size = np.linalg.norm(jacobian, axis=0)
    usual = float(size[:own].max())
    scale = np.where(np.arange(size.size) < own, 1.0, usual / np.where(size > 0, size, 1.0))
    return np.asarray(jacobian * scale)


def _values(task: Task, theta: Array) -> list[float]:
    return [float(v) for v in np.exp(theta[: task.own])]


def _late(task: Task, theta: Array) -> float:
    """How late the force is [s]; the number after those of the zero, in sample periods."""
    if not task.faults.late:
        return 0.0
    place = task.own + task.faults.zero(task.record.time).shape[1]
    return float(theta[place]) * float(np.median(np.diff(task.record.time)))


def _predicted(task: Task, theta: Array) -> Array:
    """The output [N; N·m, or m; rad]: θ is the tissue, then zero, lateness and what the branches held at
    holes."""
    values, record, size = _values(task, theta), task.record, task.size
    zero = task.faults.zero(record.time)
    after = task.own + zero.shape[1]
    found = task.model.predict(values, record)
    columns = [c for begin in record.begins for c in task.model.fading(values, record, begin)]
    for held, column in zip(theta[after + bool(task.faults.late) :], columns, strict=True):
        found = found + size * held * column
    found = task.faults.delayed(found, record.time, _late(task, theta))
    return np.asarray(found + zero @ (size * theta[task.own : after]))


def _further(task: Task) -> Array:
    """Where the numbers besides the tissue's begin: a force half a sample late, nothing else."""
    zero = task.faults.zero(task.record.time).shape[1]
    late = [0.5] if task.faults.late else []
    held = len(task.record.begins) * (task.model.branches if task.model.linear else 0)
    return np.array([*[0.0] * zero, *late, *[0.0] * held])


def _solve(task: Task, starts: list[Array]) -> Solved:
    from scipy.optimize import least_squares

    output, used, size = task.record.output, task.used, task.size
    further = _further(task)

    def residuals(theta: Array) -> Array:
        found: Array = (_predicted(task, theta) - output)[used] / size
        return found

    reach = np.append(np.full(task.own, DECADES), np.full(further.size, np.inf))
    best = None
    for start in starts:
        theta = np.append(np.log(start), further)
        found = least_squares(
            residuals,
            theta,
            jac="3-point",
            bounds=(theta - reach, theta + reach),
            x_scale="jac",
            xtol=1e-12,
            ftol=1e-12,
            max_nfev=TRIES if further.size else None,
        )
        best = found if best is None or found.cost < best.cost else best
    assert best is not None
    return Solved(best.x, best.fun, best.jac, noise_of(best.fun, task.largest_order), float(best.cost))
