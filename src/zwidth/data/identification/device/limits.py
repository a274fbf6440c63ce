"""What identified numbers allow a spring wall: K ≤ 2 b/T, and at rest K ≤ 2 f_c/Δ.

Abbott & Okamura (2005), equations 21 and 25.  Both are linear in what was identified, so that
their intervals are those of b and f_c, times 2/T and 2/Δ.
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.spoken import spoken
from zwidth.quantity.text import told_quantity

if TYPE_CHECKING:
    from zwidth.data.identification.device.estimate import Estimate
    from zwidth.data.identification.device.numbers import IdentifiedNumbers

NARROW = 3.0
"""Ratio of quick to slow speeds (upper to lower tenth) below which b and f_c are hard to tell apart."""


class Limit(NamedTuple):
    """A bound of the stiffness, from one parameter.

    Parameters
    ----------
    parameter
        "damping" or "coulomb_friction".
    symbol
        2b/T or 2f_c/Δ.
    factor
        By which the parameter becomes a stiffness; inf where Δ is 0.
    estimate
        Of the parameter.
    best
        The best guess of what counts of it [N·s/m, N; N·m·s/rad, N·m].
    least
        What it is at least, with a confidence.
    """

    parameter: str
    symbol: str
    factor: float
    estimate: Estimate
    best: float
    least: Callable[[float], float]

    @property
    def value(self) -> float:
        """The best guess [N/m; N·m/rad]."""
        return self.factor * self.best

    def interval(self, confidence: float) -> tuple[float, float]:
        """Where the truth is, this often; what is negative allows no stiffness [N/m; N·m/rad]."""
        low, high = self.least(confidence), self.estimate.interval(confidence)[1]
        return self.factor * low, self.factor * max(high, low)


def limits(identified: IdentifiedNumbers) -> tuple[Limit, ...]:
    """Both bounds, where the parameters were identified and the encoder has a step."""
    found = []
    if "damping" in identified.estimates:
        factor = 2 / identified.sample_period
        estimate, best = identified.estimates["damping"], identified.best_damping()
        found.append(Limit("damping", "2b/T", factor, estimate, best, identified.least_damping))
    if "coulomb_friction" in identified.estimates and identified.resolution > 0:
        factor = 2 / identified.resolution
        estimate, least = identified.estimates["coulomb_friction"], identified.least_coulomb_friction
        found.append(Limit("coulomb_friction", "2f_c/Δ", factor, estimate, estimate.value, least))
    return tuple(found)


def advice(identified: IdentifiedNumbers, confidence: float) -> tuple[str, ...]:
    """Which number limits the stiffest wall, and how to know it better."""
    if identified.shows("wrong model"):
        return ("fit Coulomb friction too: these numbers are of another model than the device",)
    found = limits(identified)
    binding = min(found, key=lambda limit: limit.interval(confidence)[0])
    name = {"damping": "damping", "coulomb_friction": "Coulomb friction"}[binding.parameter]
    least = told_quantity(binding.interval(confidence)[0], "stiffness", identified.motion, 4)
    lines = [f"{name} limits the wall: {binding.symbol} ≥ {least} at {percent(confidence)}"]
    longer = _times_longer(binding.estimate, confidence)
    if longer < inf:
        lines.append(
            f"a log {longer:.2g} times as long would halve the interval of {name}, "
            "which narrows as 1/√duration"
        )
    else:
        lines.append(
            f"a longer log would not halve the interval of {name}: half of it and more is what means over "
            f"{1e3 * identified.pulse_length:.3g} ms may be off; smoother, longer strokes allow longer ones"
        )
    factor, speed = spoken(GLOSSARY["friction_speed"].unit_for(identified.motion))
    inward, outward = (factor * fast for fast in identified.fastest)
    lines.append(
        f"friction was seen up to {inward:.3g} {speed} into the wall and {outward:.3g} out of it; at "
        "higher speeds it is not known: "
        "log quicker strokes, zwidth plan --speed says which"
    )
    slow, quick = np.quantile(np.abs(identified.seen["speed"].values), [0.1, 0.9])
    if quick < NARROW * slow:
        lines.append(
            f"most of the motion is between {factor * slow:.2g} and {factor * quick:.2g} {speed}: slower and "
            "quicker strokes "
            "tell damping and Coulomb friction apart"
        )
    return tuple(lines)


def percent(confidence: float) -> str:
    """0.99 as "99 %", never more than it is."""
    return f"{int(confidence * 1e6 + 1e-6) / 1e4:.6g} %"


def _times_longer(estimate: Estimate, confidence: float) -> float:
    """n for which reach/√n + shift is half of what reach + shift is."""
    _, high = estimate.interval(confidence)
    whole = high - estimate.value
    rest = whole / 2 - estimate.shift
    return float(((whole - estimate.shift) / rest) ** 2) if rest > 0 else inf
