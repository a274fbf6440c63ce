"""What a law remembers: the force as an exact function of the last few encoder readings.

    f = K u_k + Σ_j c_j u_{k−j}        u = q, or max(q, 0) for a solid that is left
    f = p(q_k) (1 + ρ (q_k − q_{k−1}))  for a contact, p(q) = K qⁿ
    f = 0 where q ≤ 0                  for laws with a surface
    f = max(0, f)                      for laws that never pull
    f = ΔF ⌊f/ΔF + ½⌋                  what a converter makes of it, where its steps are counted in
    |f| ≤ F_max                        likewise the force limit, after the converter

q is the encoder's reading, a whole number of counts.  Laws that remember a few readings are here: springs,
dampers on differenced counts, windows, filters of finite response; and one that never quite forgets, a
Maxwell branch or a one-pole filter (see `relaxing`).
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable
from dataclasses import dataclass, replace
from fractions import Fraction
from math import floor
from operator import itemgetter
from typing import Any, Literal

from zwidth.errors import InputError
from zwidth.model.device.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.nonlinear import resting_force
from zwidth.passivity.scope import unit_key
from zwidth.quantity.text import exact_text

Surface = Literal["none", "position", "penetration"]

LONGEST_MEMORY = 6
"""Readings before the last one that a law may remember, delay included."""


@dataclass(frozen=True)
class FiniteLaw:
    """A force computed from the last few readings of an encoder."""

    taps: tuple[Fraction, ...]  # c_0, c_1, …: f = Σ c_j u_{k−j} [N/m; N·m/rad]
    # "none": u = q, the law acts everywhere.  "position": u = q, but the law pushes inside only, where q >
    # 0.  "penetration": the same with u = max(q, 0).
    surface: Surface
    clamped: bool = False  # True if a negative force is replaced by 0
    # a spring given by (position [m; rad], force [N; N·m]) in place of taps
    points: tuple[tuple[Fraction, Fraction], ...] = ()
    force_limit: Fraction | None = None  # largest force of the actuator [N; N·m], or None
    # (p, g) of a part y = g (u_k − a_k), a_{k+1} = p a_k + (1 − p) u_k that never quite forgets, 0 ≤ p < 1, g
    # [N/m; N·m/rad]; or None
    relaxing: tuple[Fraction, Fraction] | None = None
    resets: bool = False  # True if a becomes 0 where the hand is outside
    # step of the converter [N; N·m], or None: the nearest whole step, the upper one of two equally
    # near.  Then comes the force limit.
    force_step: Fraction | None = None
    power: tuple[Fraction, Fraction] | None = None  # K and n of a contact K qⁿ in place of taps, or None
    # ρ = λ/T [1/m; 1/rad], by which the force of points or of a contact grows with the way since the last
    # reading
    rate: Fraction = Fraction(0)

    @property
    def memory(self) -> int:
        """Readings remembered besides the last one."""
        return max(len(self.taps) - 1, 1 if self.rate else 0)

    @property
    def static_stiffness(self) -> Fraction:
        """Σ c_j [N/m; N·m/rad]: the force per depth of a hand that waits."""
        return sum(self.taps, Fraction(0))

    @property
    def is_curve(self) -> bool:
        """True for a spring given by points and for a contact."""
        return bool(self.points) or self.power is not None

    def resting(self, x: Fraction) -> Fraction:
        """The force of a spring given by points, or of a contact, to a hand that waits at x [N; N·m]."""
        return interpolated(self.points, x) if self.power is None else resting_force(*self.power, x)

    def force(self, readings: tuple[Fraction, ...], average: Fraction = Fraction(0)) -> Fraction:
        """The force for the readings q_k, q_{k−1}, …, and the average a_k of a part that relaxes [N; N·m]."""
        if self.surface != "none" and readings[0] <= 0:
            return Fraction(0)
        u = [max(q, Fraction(0)) for q in readings] if self.surface == "penetration" else list(readings)
        f = sum((c * v for c, v in zip(self.taps, u, strict=False)), Fraction(0))
        if self.is_curve:
            f += self.resting(u[0])
        if self.relaxing is not None:
            f += self.relaxing[1] * (u[0] - average)
        if self.rate:
            f *= 1 + self.rate * (readings[0] - readings[1])
        if self.clamped:
            f = max(f, Fraction(0))
        if self.force_step is not None:
            f = self.force_step * floor(f / self.force_step + Fraction(1, 2))
        if self.force_limit is not None:
            f = min(max(f, -self.force_limit), self.force_limit)
        return f

    def averaged(self, average: Fraction, reading: Fraction) -> Fraction:
        """a_{k+1} from a_k and q_k [m; rad]."""
        if self.relaxing is None or (self.resets and reading <= 0):
            return Fraction(0)
        pole = self.relaxing[0]
        u = max(reading, Fraction(0)) if self.surface == "penetration" else reading
        return pole * average + (1 - pole) * u

    def document(self, motion: str, places: Iterable[Fraction] = ()) -> dict[str, Any]:
        """The law as exact data, a unit in each key; a contact by its forces at these places [m; rad]."""
        force = unit_key("force_limit", motion).removeprefix("force_limit_")
        document: dict[str, Any] = {
            "surface": self.surface,
            "clamped": self.clamped,
            f"taps_{unit_key('stiffness', motion).removeprefix('stiffness_')}": [
                exact_text(c) for c in self.taps
            ],
        }
        length = unit_key("position", motion).removeprefix("position_")
        points = self.points if self.power is None else [(x, self.resting(x)) for x in places]
        if points:
            document[f"points_{length}_{force}"] = [[exact_text(x), exact_text(f)] for x, f in points]
        if self.rate:
            document[f"rate_per_{length}"] = exact_text(self.rate)
        if self.force_limit is not None:
            document[f"force_limit_{force}"] = exact_text(self.force_limit)
        if self.force_step is not None:
            document[f"force_step_{force}"] = exact_text(self.force_step)
        if self.relaxing is not None:
            pole, stiffness = (exact_text(c) for c in self.relaxing)
            document["relaxing"] = {"pole": pole, unit_key("stiffness", motion): stiffness}
            document["resets"] = self.resets
        return document


def interpolated(points: tuple[tuple[Fraction, Fraction], ...], x: Fraction) -> Fraction:
    """The force of a spring given by points: linear between them, constant beyond."""
    i = bisect_right(points, x, key=itemgetter(0))
    if i in (0, len(points)):
        return points[max(i - 1, 0)][1]
    (x0, f0), (x1, f1) = points[i - 1 : i + 1]
    return f0 + (f1 - f0) * (x - x0) / (x1 - x0)


def finite_law(
    device: Device, environment: Environment, *, force_limit: bool = False, force_resolution: bool = False
) -> FiniteLaw:
    """The law of an environment in a device's loop.

    `device`, `environment`: without intervals; `force_limit`, `force_resolution`: True to count in the
    actuator's force limit, the steps of its converter.
    """
    limit = _counted(device, "force_limit", "the force limit is") if force_limit else None
    step = _counted(device, "force_resolution", "converter steps are") if force_resolution else None
    law = _unlimited(device, environment)
    if law.relaxing is not None and (limit or step):
        what = "the force limit" if limit else "converter steps"
        raise InputError(f"{what} cannot be counted in for a law that relaxes; leave it out")
    return replace(law, force_limit=limit, force_step=step)


def _counted(device: Device, key: str, what: str) -> Fraction:
    if getattr(device, key) is None:
        raise InputError(f"{what} to be counted in, but the device has no {key}")
    return device.exact(key)


def _unlimited(device: Device, environment: Environment) -> FiniteLaw:
    """The law by itself, with an actuator that gives every force."""
    if environment.points:
        points = tuple((x.fraction, f.fraction) for x, f in environment.points)
        return FiniteLaw((), environment.surface, environment.clamped, points)
    if environment.power_law is not None:
        k, n, dissipation = (number.fraction for number in environment.power_law)
        rate = dissipation / device.exact("sample_period")
        return FiniteLaw((), environment.surface, environment.clamped, power=(k, n), rate=rate)
    h = environment.pulse_transfer_function(device.exact("sample_period"))
    numerator, denominator = _trimmed(h.numerator, h.denominator)
    if any(denominator[1:]):
        return _relaxing(environment, numerator, denominator)
    taps = tuple(c / denominator[0] for c in numerator)
    while len(taps) > 1 and taps[-1] == 0:
        taps = taps[:-1]
    if len(taps) - 1 > LONGEST_MEMORY:
        raise InputError(
            f"the law remembers {len(taps) - 1} readings, more than the {LONGEST_MEMORY} for which "
            "available storage is computed: the number of states grows with the power of it"
        )
    return FiniteLaw(taps, environment.surface, environment.clamped)


def _relaxing(environment: Environment, numerator: list[Fraction], denominator: list[Fraction]) -> FiniteLaw:
    """H = K + g (1 − ζ)/(1 − p ζ): a spring and one part that relaxes."""
    n, d = ([c / denominator[0] for c in part] for part in (numerator, denominator))
    while d and d[-1] == 0 and n[-1] == 0:
        n, d = n[:-1], d[:-1]
    if len(d) != 2 or not 0 < -d[1] < 1:
        raise InputError(
            "available storage is computed for laws that remember a few readings, or have one part that "
            f"relaxes and does not swing; this one has more: {environment.describe()}; zwidth check covers "
            "it in sustained contact"
        )
    pole = -d[1]
    stiffness = (n[0] + n[1]) / (1 - pole)
    relaxing = pole, n[0] - stiffness
    return FiniteLaw((stiffness,), environment.surface, environment.clamped, (), None, relaxing)


def _trimmed(
    numerator: tuple[Fraction, ...], denominator: tuple[Fraction, ...]
) -> tuple[list[Fraction], list[Fraction]]:
    """Coefficients of H in ascending powers of 1/z, common factors z cancelled."""
    size = max(len(numerator), len(denominator))
    n = [Fraction(0)] * (size - len(numerator)) + [Fraction(c) for c in numerator]
    d = [Fraction(0)] * (size - len(denominator)) + [Fraction(c) for c in denominator]
    while d and d[0] == 0:
        n, d = n[1:], d[1:]
    return n, d
