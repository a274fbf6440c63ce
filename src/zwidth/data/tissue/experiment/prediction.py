"""What a model says of a test, and its derivatives by what is fitted.

Between samples the history is a curve, looked at `FINER` times as finely: a quick ramp of few samples is
neither a step nor a chain of straight lines.  Velocities are its slopes.  Where the motion is smooth the
curve is a cubic spline, at rest before the first sample or not, where it has corners a monotone cubic
(Fritsch & Carlson, 1980).  Samples of the motion alone do not tell which; the response does (`choice`).

    f = K u + B u̇ + Σ μᵢ y(1/τᵢ),     ẏ = u̇ − r y,   u = max(x − surface, 0)
    f = K uⁿ (1 + λ u̇)                                                    Hunt–Crossley
    x = J * f                                                              creep

What is fitted besides: the zero of the response, the depth of the surface, what each branch holds after a
hole.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from zwidth.data.tissue.experiment.history import History
from zwidth.data.tissue.model import Model, Record
from zwidth.model.environment.modes import decaying
from zwidth.model.environment.relaxing import position_response
from zwidth.native.compiled import Array

FINER = 4
STEP = 1e-4
"""Of a logarithm, for differences."""

LARGEST = 80.0
"""Of a logarithm: beyond it nothing changes, and a float still holds it."""


class Fine(NamedTuple):
    """The history between the samples too: times, depth or force, and its slope."""

    time: Array
    values: Array
    slope: Array


def fines_of(test: History) -> list[Fine]:
    """The given quantity of a test, `FINER` times as finely as it was sampled, by each of the curves."""
    from scipy.interpolate import CubicSpline, PchipInterpolator

    at, given = test.time, test.force if test.kind == "creep" else test.depth
    fine = np.interp(np.arange(FINER * (at.size - 1) + 1) / FINER, np.arange(at.size), at)
    curves = (
        CubicSpline(at, given),
        CubicSpline(at, given, bc_type=((1, 0.0), "not-a-knot")),
        PchipInterpolator(at, given),
    )
    return [Fine(fine, curve(fine), curve(fine, 1)) for curve in curves]


class Task(NamedTuple):
    """A model, a test, its history between samples, and whether the zero is fitted."""

    model: Model
    test: History
    fine: Fine
    zero: bool

    @property
    def own(self) -> int:
        return len(self.model.parameters)

    @property
    def surface(self) -> bool:
        """True where its depth is fitted; a creep test is predicted from the force, which has none."""
        return self.test.surface is not None and self.test.kind != "creep"

    @property
    def held(self) -> int:
        """Numbers for what branches hold after holes."""
        return len(self.test.begins) * (self.model.branches if self.model.linear else 0)

    @property
    def size(self) -> float:
        return float(np.abs(self.output).max()) or 1.0

    @property
    def way(self) -> float:
        """How far the probe goes [m]."""
        return float(np.abs(self.test.depth).max()) or 1.0

    @property
    def output(self) -> Array:
        """What is predicted, and carries the noise."""
        return self.test.depth if self.test.kind == "creep" else self.test.force

    def record(self, surface: float) -> Record:
        test = self.test
        depth = np.maximum(test.depth - surface, 0.0) if self.surface else test.depth
        rest = 0.0 if test.starts_loaded or test.kind == "creep" else None
        return Record(
            test.time, depth, test.force, "position" if test.kind == "creep" else "force", rest, test.begins
        )


def predicted(task: Task, point: Array) -> Array:
    """The output at a point, in parts of its size."""
    values = _values(task, point)
    found = _output(task, values, _surface(task, point)) / task.size
    if task.zero:
        found = found + point[task.own]
    if task.held:
        found = found + _fading(task, values) @ point[point.size - task.held :]
    return np.asarray(found)


def derivatives(task: Task, point: Array) -> Array:
    """Of the output by the point: of branches in closed form but for their rate, else by differences."""
    table = np.empty((task.test.time.size, point.size))
    quick = task.model.linear and task.test.kind != "creep"
    if quick:
        table[:, : task.own] = _of_branches(task, point) / task.size
    for k in range(task.own if quick else 0, point.size):
        if k == task.own and task.zero:
            table[:, k] = 1.0
            continue
        up, down = _beside(point, k)
        table[:, k] = (predicted(task, up) - predicted(task, down)) / (2 * STEP)
    if quick and task.held:  # what fades, fades with the branch
        for k in range(task.own):
            up, down = (_fading(task, _values(task, at)) @ point[-task.held :] for at in _beside(point, k))
            table[:, k] += (up - down) / (2 * STEP)
    return table


def _beside(point: Array, k: int) -> tuple[Array, Array]:
    """A step up and a step down along one of its numbers."""
    up, down = point.copy(), point.copy()
    up[k] += STEP
    down[k] -= STEP
    return up, down


def _values(task: Task, point: Array) -> list[float]:
    return [float(v) for v in np.exp(np.clip(point[: task.own], -LARGEST, LARGEST))]


def _surface(task: Task, point: Array) -> float:
    return float(point[task.own + task.zero]) * task.way if task.surface else 0.0


def _output(task: Task, values: list[float], surface: float) -> Array:
    """[N], or [m] in creep."""
    if task.test.kind == "creep":
        try:
            found = position_response(task.model.elements(values), task.fine.time, task.fine.values, 0.0)
        except ZeroDivisionError:  # a branch so small that it relaxes and creeps at one rate, as floats go
            return np.zeros(task.test.time.size)
        return found[::FINER]
    depth, speed = _depth(task, surface)
    if not task.model.linear:
        u, v = depth[::FINER], speed[::FINER]
        return np.asarray(values[0] * np.maximum(u, 0.0) ** values[1] * (1.0 + values[2] * v))
    parts = task.model.elements(values)
    found = parts.spring * depth[::FINER]
    if parts.dashpot:
        found = found + parts.dashpot * speed[::FINER]
    for mu, eta in parts.branches:
        found = found + mu * _branch(task, depth, mu / eta)
    return np.asarray(found)


def _of_branches(task: Task, point: Array) -> Array:
    """The derivatives of a linear force by the logarithms of its springs and dashpots [N]."""
    values = _values(task, point)
    depth, speed = _depth(task, _surface(task, point))
    columns = [] if task.model.name == "maxwell" else [values[0] * depth[::FINER]]
    if task.model.name == "kelvin-voigt":
        columns.append(values[1] * speed[::FINER])
    for mu, eta in task.model.elements(values).branches:
        rate = mu / eta
        slower, faster = (_branch(task, depth, rate * np.exp(way * STEP)) for way in (-1, 1))
        bent = mu * (faster - slower) / (2 * STEP)
        columns += [mu * (faster + slower) / 2 + bent, -bent]
    return np.stack(columns, axis=1)


def _depth(task: Task, surface: float) -> tuple[Array, Array]:
    """u and its speed, between the samples too."""
    if not task.surface:
        return task.fine.values, task.fine.slope
    depth = task.fine.values - surface
    return np.maximum(depth, 0.0), np.where(depth > 0.0, task.fine.slope, 0.0)


def _branch(task: Task, depth: Array, rate: float) -> Array:
    """y at the samples; a run after a hole begins at rest."""
    ends = (0, *(FINER * b for b in task.test.begins), depth.size)
    start = float(depth[0]) if task.test.starts_loaded else 0.0
    found = np.empty(depth.size)
    for k, (a, b) in enumerate(zip(ends[:-1], ends[1:], strict=True)):
        steps, moved = np.diff(task.fine.time[a:b]), np.diff(depth[a:b])
        found[a:b] = decaying(steps, moved, rate, 0.0 if k else start)
    return found[::FINER]


def _fading(task: Task, values: list[float]) -> Array:
    """What each branch may still hold after each hole, in parts of what it held then."""
    record = task.record(0.0)
    return np.stack([c for b in record.begins for c in task.model.fading(values, record, b)], axis=1)
