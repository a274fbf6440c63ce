"""What suits a force to amplifier and converter: its size, its rate, its steps.

A force that is never larger than a limit: before laws that remember it, or below the motor's own.

    f ← clamp(f, −F … F)

The amplifier limits the force anyway, after all laws; a law that comes before it and remembers
what it gave, such as `SlewLimit`, then remembers a force that never was.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from zwidth.errors import InputError
from zwidth.model.device.amplifier import VoltageLimited
from zwidth.model.rendering.reading import given_or_known
from zwidth.model.rendering.rendering_law import LoopContext, RenderingLaw
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import Exact
from zwidth.quantity.glossary import Quantity
from zwidth.quantity.parameter import PLAIN, CertainOrNone, Count, exact, parameter, word

SATURATION = 16.0


@dataclass(frozen=True)
class Saturation(RenderingLaw):
    """``f ← clamp(f, ±F)``.

    Parameters
    ----------
    limit
        F > 0 [N; N·m]; None: the device's force limit.

    Raises
    ------
    InputError
        If F is not positive; later, if it is not given and the device has no force limit.
    """

    code: ClassVar[float] = SATURATION
    state_size: ClassVar[int] = 0

    limit: CertainOrNone = exact(
        "force", None, "> 0", "without force nothing is rendered", "F, by default the force limit"
    )

    def numbers(self, at: LoopContext) -> list[float]:
        return [given_or_known(self.limit, at, "force_limit", "limit")]

    def initial_state(self, reading: float) -> list[float]:
        return []

    def describe(self, motion: str = "linear") -> str:
        return f"saturation at {self.with_unit('limit', motion) or 'the force limit'}"


@compiled
def saturation_step(p: Array, i: int, s: Array, j: int, x: float, force: float, applied: float) -> float:
    """One sample; p from i on is this law's."""
    return min(max(force, -p[i]), p[i])


# A force that changes no faster than a motor's current can.
#
#     f_k ← clamp(f_k, f_{k−1} − R T … f_{k−1} + R T)
#
# f_{k−1} is what this law gave, not what converter and limit made of it: a step of R T below half
# a converter step still adds up.  Where the wall asks for more than the motor gives, put
# `Saturation()` before it; it would else first come down from a force that never was.

SLEW_LIMIT = 14.0

_STEP = 0
_BEGUN, _LAST = range(2)


@dataclass(frozen=True)
class SlewLimit(RenderingLaw):
    """The force changes by R T a sample at most.

    Parameters
    ----------
    rate
        R > 0 [N/s; N·m/s]; None: what the device's winding allows, (F_max/I_max) U/L.

    Raises
    ------
    InputError
        If R is not positive; later, if it is not given and the device's motor is not known.
    """

    code: ClassVar[float] = SLEW_LIMIT
    state_size: ClassVar[int] = 2

    rate: CertainOrNone = exact(
        Quantity("rate", "R", "N/s", "N*m/s", "R, by default what the device's winding allows"),
        None,
        "> 0",
        "a force that never changes renders nothing",
    )

    def numbers(self, at: LoopContext) -> list[float]:
        return [self._rate(at) * at.period]

    def _rate(self, at: LoopContext) -> float:
        if self.rate is not None:
            return float(self.rate)
        try:
            return VoltageLimited().actuation(at.device).slew
        except InputError as error:
            raise InputError(f"rate was not given and is otherwise the motor's: {error}") from None

    def initial_state(self, reading: float) -> list[float]:
        """The first force is taken as it is: it has been there for ever."""
        return [0.0, 0.0]

    def describe(self, motion: str = "linear") -> str:
        return f"slew limit of {self.with_unit('rate', motion) or 'the motor'}"


@compiled
def slew_limit_step(p: Array, i: int, s: Array, j: int, x: float, force: float, applied: float) -> float:
    """One sample; p from i and s from j on are this law's."""
    if s[j + _BEGUN] > 0.0:
        last, most = s[j + _LAST], p[i + _STEP]
        force = min(max(force, last - most), last + most)
    s[j + _BEGUN], s[j + _LAST] = 1.0, force
    return force


# A small force to and fro, so that the steps of the converter average out.
#
#     alternating   f ← f + a (−1)ᵏ
#     random        f ← f + a (2 r_k/M − 1),   r_k = 16807 r_{k−1} mod M,   M = 2³¹ − 1
#
# With a = ΔF/4 the mean of two alternating samples has steps of ΔF/2; random numbers, uniform
# over one step, a = ΔF/2, make the mean error 0 at any force (Schuchman 1964).  The generator is
# that of Park & Miller (1988), exact in doubles: the same seed gives the same forces everywhere.
# It acts inside only, and runs on outside.

DITHER = 15.0

_AMPLITUDE, _RANDOM, _SURFACE = range(3)

MODULUS, _FACTOR = 2147483647.0, 16807.0


def _seed(seed: Exact) -> int:
    if seed.fraction.denominator != 1 or seed >= int(MODULUS):
        raise InputError(f"seed is a whole number from 1 to {int(MODULUS) - 1}, got {seed:g}")
    return int(seed)


@dataclass(frozen=True)
class Dither(RenderingLaw):
    """A force of amplitude a that changes from sample to sample, where the environment acts.

    Parameters
    ----------
    amplitude
        a > 0 [N; N·m]; None: ΔF/4 of the device's converter for "alternating", ΔF/2 for "random".
    kind
        "alternating" or "random".
    seed
        Of "random", a whole number from 1 to 2³¹ − 2.

    Raises
    ------
    InputError
        If one of them is not such a number or word; later, if the amplitude is not given and the
        device's converter is not known.
    """

    code: ClassVar[float] = DITHER
    state_size: ClassVar[int] = 1

    amplitude: CertainOrNone = exact(
        "force", None, "> 0", "without one there is no dither", "a, by default a part of a converter step"
    )
    kind: Literal["alternating", "random"] = word("alternating", "random")
    seed: Count = parameter(
        PLAIN,
        1,
        kept=_seed,
        bound="> 0",
        why="0 would stay 0 for ever",
        meaning="of the random one, a whole number",
    )

    def numbers(self, at: LoopContext) -> list[float]:
        """a, whether it is random, whether there is a surface."""
        share = 1.0 if self.amplitude is not None else 0.5 if self.kind == "random" else 0.25
        amplitude = share * given_or_known(self.amplitude, at, "force_resolution", "amplitude")
        return [amplitude, float(self.kind == "random"), float(at.environment.unilateral)]

    def initial_state(self, reading: float) -> list[float]:
        """+1, or the seed."""
        return [float(self.seed) if self.kind == "random" else 1.0]

    def describe(self, motion: str = "linear") -> str:
        return f"{self.kind} dither of {self.with_unit('amplitude', motion) or 'part of a converter step'}"


@compiled
def dither_step(p: Array, i: int, s: Array, j: int, x: float, force: float, applied: float) -> float:
    """One sample; p from i and s from j on are this law's."""
    state = s[j]
    if p[i + _RANDOM] > 0.0:
        state = (_FACTOR * state) % MODULUS
        part = 2.0 * state / MODULUS - 1.0
        s[j] = state
    else:
        part = state
        s[j] = -state
    if p[i + _SURFACE] > 0.0 and x <= 0.0:
        return force
    return force + p[i + _AMPLITUDE] * part
