"""The models that are fitted to tissue: their parameters, all > 0, and what each predicts.

kelvin-voigt            f = K x + B ẋ
maxwell                 H(s) = μ η s/(μ + η s)
standard-linear-solid   H(s) = μ0 + μ1 η1 s/(μ1 + η1 s)
generalized-maxwell     H(s) = μ0 + Σ μᵢ ηᵢ s/(μᵢ + ηᵢ s)
hunt-crossley           f = K uⁿ (1 + λ u̇),   u = max(x, 0)
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from zwidth.errors import InputError
from zwidth.model.environment import GeneralizedMaxwell, HuntCrossley, Maxwell, StandardLinearSolid, Wall
from zwidth.model.environment.discretization import Discretization
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.modes import decaying
from zwidth.model.environment.relaxing import Elements, force_response, position_response
from zwidth.native.compiled import Array
from zwidth.quantity.exact import Interval
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.parameter import Given

Response = Literal["force", "position"]

OWN_PARAMETERS = {
    "kelvin-voigt": ("stiffness", "damping"),
    "maxwell": ("stiffness", "damping"),
    "standard-linear-solid": ("stiffness", "branch_stiffness", "branch_damping"),
    "generalized-maxwell": ("stiffness",),
    "hunt-crossley": ("stiffness", "exponent", "dissipation"),
}

MOST_BRANCHES = 6
"""Relaxation times closer than a third of a decade are not told apart in any record."""


class Record(NamedTuple):
    """What was measured: times [s], positions [m; rad], forces [N; N·m]; which of the two is predicted from
    the other; the other's value before the first sample; and the samples that come after a hole."""

    time: Array
    position: Array
    force: Array
    response: Response
    rest: float | None
    begins: tuple[int, ...] = ()

    @property
    def runs(self) -> list[slice]:
        """The stretches without a hole."""
        ends = (0, *self.begins, self.time.size)
        return [slice(a, b) for a, b in zip(ends[:-1], ends[1:], strict=True)]

    @property
    def output(self) -> Array:
        return self.force if self.response == "force" else self.position


@dataclass(frozen=True)
class Model:
    """One of the models, with as many branches as it has."""

    name: str
    branches: int

    @property
    def linear(self) -> bool:
        return self.name != "hunt-crossley"

    @property
    def parameters(self) -> tuple[str, ...]:
        own = OWN_PARAMETERS[self.name]
        if self.name != "generalized-maxwell":
            return own
        return own + tuple(
            f"branch_{what}_{i + 1}" for i in range(self.branches) for what in ("stiffness", "damping")
        )

    def elements(self, p: Sequence[float]) -> Elements:
        """Springs and dashpots of parameters."""
        if self.name == "kelvin-voigt":
            return Elements(p[0], p[1], ())
        if self.name == "maxwell":
            return Elements(0.0, 0.0, ((p[0], p[1]),))
        return Elements(p[0], 0.0, tuple(zip(p[1::2], p[2::2], strict=True)))

    def predict(self, p: Sequence[float], record: Record) -> Array:
        """The output of the record as the model has it; after a hole as if it had been at rest there."""
        if not self.linear:
            depth = np.maximum(record.position, 0.0)
            speed = np.concatenate([np.gradient(record.position[r], record.time[r]) for r in record.runs])
            return np.asarray(p[0] * depth ** p[1] * (1.0 + p[2] * speed))
        if record.response == "position":
            return position_response(self.elements(p), record.time, record.force, record.rest)
        rests = (record.rest, *(None for _ in record.begins))
        return np.concatenate(
            [
                force_response(self.elements(p), record.time[r], record.position[r], rest)
                for r, rest in zip(record.runs, rests, strict=True)
            ]
        )

    def fading(self, p: Sequence[float], record: Record, begin: int) -> list[Array]:
        """What each branch may still hold after a hole, exp(−t/τᵢ) from the sample on until the next hole."""
        if not self.linear:
            return []
        end = min((b for b in record.begins if b > begin), default=record.time.size)
        since = record.time[begin:end] - record.time[begin]
        found = []
        for mu, eta in self.elements(p).branches:
            column = np.zeros(record.time.size)
            column[begin:end] = np.exp(-since * mu / eta)
            found.append(column)
        return found

    def environment(
        self, values: Sequence[Given], discretization: Discretization, clamped: bool
    ) -> Environment:
        """What a controller renders."""
        if self.name == "kelvin-voigt":
            return Wall(values[0], values[1], clamped=clamped)
        if self.name == "hunt-crossley":
            k, n, d = (value for value in values if not isinstance(value, Interval | tuple))
            return HuntCrossley(k, n, d, clamped)
        if self.name == "maxwell":
            return Maxwell(values[0], values[1], discretization, clamped)
        if self.name == "standard-linear-solid":
            return StandardLinearSolid(values[0], values[1], values[2], discretization, clamped)
        pairs = list(zip(values[1::2], values[2::2], strict=True))
        return GeneralizedMaxwell(values[0], pairs, discretization, clamped)


def as_model(name: object, branches: int | None, response: Response) -> Model:
    if name not in OWN_PARAMETERS:
        choices = ", ".join(f'"{choice}"' for choice in OWN_PARAMETERS)
        raise InputError(f"model is one of {choices}; got {name!r}")
    if name == "hunt-crossley" and response != "force":
        raise InputError(
            "a Hunt–Crossley contact is fitted to the force under a measured position; "
            'give response="force", or one of the linear models'
        )
    if name != "generalized-maxwell":
        if branches is not None:
            raise InputError(f'branches is for "generalized-maxwell"; that of {name!r} is fixed')
        return Model(str(name), 1 if name in ("maxwell", "standard-linear-solid") else 0)
    number = 2 if branches is None else branches
    if isinstance(number, bool) or not isinstance(number, int) or not 1 <= number <= MOST_BRANCHES:
        raise InputError(
            f"branches is a whole number from 1 to {MOST_BRANCHES}, got {branches!r}: more relaxation "
            "times are not told apart in any record"
        )
    return Model(str(name), number)


def unit_of(parameter: str, motion: str, exponent: float = 1.0) -> str:
    name = parameter.rstrip("_0123456789")
    power = "" if exponent == 1 else f"^{exponent:.3g}"
    return GLOSSARY[name].unit_for(motion) + power


# Where a fit begins: the best of many relaxation times, the springs by least squares.
#
# With the rates 1/τᵢ given, the force is linear in K, B and the μᵢ, all ≥ 0.  So a grid of rates is tried,
# one branch after the other, each the one that leaves the least; that needs no guess from a person.

RATES = 25
"""In the grid, from a third of one per record to the fastest that samples show."""

MOST_ROWS = 4000
STARTS = 3

_LEAST_SHARE = 1e-3


def starting_points(model: Model, record: Record) -> list[Array]:
    """Parameters > 0 from which the fit may begin, the best first."""
    if not model.linear:
        return [_contact(record)]
    rows = slice(None, None, max(1, record.time.size // MOST_ROWS))
    h, moved = np.diff(record.time), np.diff(record.position)
    target = record.force[rows]
    fixed = _fixed_columns(model, record, h, moved, rows)
    if not model.branches:
        return [_positive(_nonnegative(fixed, target)[0], record)]
    step = _step(record)
    grid = np.geomspace(0.3 / (record.time[-1] - record.time[0]), 1.0 / float(np.median(h)), RATES)
    columns = [decaying(h, moved, float(rate), step)[rows] for rate in grid]
    found = []
    for first in _ranked(fixed, columns, [], target)[:STARTS]:
        chosen = [first]
        while len(chosen) < model.branches:
            chosen.append(_ranked(fixed, columns, chosen, target)[0])
        springs, _ = _nonnegative(fixed + [columns[i] for i in chosen], target)
        found.append(_as_parameters(_positive(springs, record), grid[chosen], len(fixed)))
    return found


def _fixed_columns(model: Model, record: Record, h: Array, moved: Array, rows: slice) -> list[Array]:
    if model.name == "maxwell":
        return []
    columns = [record.position[rows]]
    if model.name == "kelvin-voigt":
        columns.append(np.append(0.0, moved / h)[rows])
    return columns


def _step(record: Record) -> float:
    """The jump of position at the first sample, as far as it is known."""
    if record.response == "force":
        return 0.0 if record.rest is None else float(record.position[0] - record.rest)
    return float(record.position[0]) if not record.rest else 0.0


def _ranked(fixed: list[Array], columns: list[Array], chosen: list[int], target: Array) -> list[int]:
    """The branches not yet chosen, that which leaves the least first."""
    before = fixed + [columns[i] for i in chosen]
    left = [i for i in range(len(columns)) if i not in chosen]
    return sorted(left, key=lambda i: _nonnegative([*before, columns[i]], target)[1])


def _nonnegative(columns: list[Array], target: Array) -> tuple[Array, float]:
    from scipy.optimize import nnls

    matrix = np.stack(columns, axis=1)
    size = np.linalg.norm(matrix, axis=0)
    size[size == 0.0] = 1.0
    square: Array = np.linalg.qr(np.column_stack([matrix / size, target]), mode="r")  # type: ignore[assignment]
    solution, left = nnls(square[:, :-1], square[:, -1])
    return solution / size, float(left)


def _positive(springs: Array, record: Record) -> Array:
    """Zeros replaced by a small share of the others: a logarithm needs a number."""
    largest = float(springs.max())
    if largest <= 0.0:
        largest = float(np.abs(record.force).max() / np.abs(record.position).max())
    return np.maximum(springs, _LEAST_SHARE * largest)


def _as_parameters(springs: Array, rates: Array, fixed: int) -> Array:
    branches = springs[fixed:]
    pairs = np.stack([branches, branches / rates], axis=1)[np.argsort(-rates)]
    return np.concatenate([springs[:fixed], pairs.ravel()])


def _contact(record: Record) -> Array:
    """ln f = ln K + n ln u + λ u̇, where the contact pushes."""
    depth, force = record.position, record.force
    pushes = (depth > 0.02 * depth.max()) & (force > 0.02 * force.max())
    if np.count_nonzero(pushes) < 4:
        raise InputError(
            "a Hunt–Crossley contact is fitted where x > 0 and f > 0: fewer than 4 samples are there; "
            "give positions that are positive inside the tissue, forces that are positive out of it"
        )
    speed = np.gradient(depth, record.time)[pushes]
    matrix = np.stack([np.ones(speed.size), np.log(depth[pushes]), speed], axis=1)
    solution, *_ = np.linalg.lstsq(matrix, np.log(force[pushes]), rcond=None)
    size = float(np.abs(speed).max())
    return np.array(
        [np.exp(solution[0]), min(max(solution[1], 1.0), 5.0), max(solution[2], 1e-2 / size if size else 1.0)]
    )
