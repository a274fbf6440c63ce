"""What a recording of a tissue adds to the tissue: a zero that is off or drifts, a late force, holes in time.

    f(t) = (h * f̂)(t − τ) + z(t),     z straight in each ten seconds

f̂ the force of the model, τ a delay, or h a filter of the first order with the time constant τ.  After a hole
nobody knows what the branches hold: each begins with a force of its own, and it fades as the branch does.

Each is looked for in what the fit leaves over.  With r the residuals, J the derivatives by what was fitted, G
those by what is asked about, and A e = ε the noise,

    u = G⊥ᵀ r,   G⊥ = G − J J⁺ G,   V = σ² G⊥ᵀ A⁻¹ A⁻ᵀ G⊥,   uᵀ V⁻¹ u ~ χ²

if nothing is there (the score test of Rao, 1948, with the covariance of `uncertainty`).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from zwidth.data.identification.device.choice import SURE
from zwidth.data.logs.stops import Stops
from zwidth.data.tissue.model import Model, Record
from zwidth.data.tissue.uncertainty import Noise, by_chance, coloured
from zwidth.errors import InputError
from zwidth.model.environment.modes import decaying
from zwidth.native.compiled import Array

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
    """What is fitted beside the tissue.

    Parameters
    ----------
    offset, drift
        A constant; and that it wanders.
    late
        "", "delay" or "filter".
    """

    offset: bool = False
    drift: bool = False
    late: str = ""

    def zero(self, time: Array) -> Array:
        """The columns that a zero may be made of, each from 0 to 1."""
        columns = [np.ones(time.size)] if self.offset or self.drift else []
        return (
            np.stack([*columns, *(_wandering(time) if self.drift else [])], axis=1)
            if columns
            else _none(time)
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


def _none(time: Array) -> Array:
    return np.empty((time.size, 0))


def _wandering(time: Array) -> list[Array]:
    """Straight between knots some ten seconds apart, 0 at the first of them."""
    span = float(time[-1] - time[0])
    knots = np.linspace(0.0, span, max(round(span / DRIFT), 1) + 1)
    return [np.interp(time - time[0], knots, row) for row in np.eye(knots.size)[1:]]


def hole_places(time: Array, position: Array, source: str = "the record") -> tuple[int, ...]:
    """The samples that come after a hole in time across which the position moved."""
    steps = np.diff(time)
    padded = np.concatenate([[np.inf], steps, [np.inf]])
    beside = np.minimum(np.maximum(padded[:-2], padded[2:]), np.minimum(padded[:-2], padded[2:]) * 4)
    holes = np.flatnonzero((steps > HOLE * beside) & (np.diff(position) != 0)) + 1
    holes = holes[(holes > 1) & (holes < time.size - 1)]
    if holes.size > MOST_HOLES:
        raise InputError(
            f"{source} has {holes.size} holes in time, the first after t = {time[holes[0] - 1]:.6g} s: what "
            "a tissue holds after each is not known; record without losing samples, or give a part with fewer"
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
    """The sample at which a branch most likely changed unseen; None where it has no memory.

    By correlating what is left with exp(−t/τ) from each sample on.
    """
    if not model.linear or record.response == "position" or not model.elements(p).branches:
        return None
    mu, eta = max(model.elements(p).branches, key=lambda pair: pair[1])
    keep = float(np.exp(-np.median(np.diff(record.time)) * mu / eta))
    ahead = coloured(np.array([1.0, -keep]), left[::-1, None])[::-1, 0]
    weight = coloured(np.array([1.0, -keep * keep]), np.ones((left.size, 1)))[::-1, 0]
    score = np.abs(ahead) / np.sqrt(weight)
    score[:2] = score[-8:] = 0.0
    return int(np.argmax(score))
