"""A motion of a port from rest, and what it takes out above a level of its index.

burst        φ = (1 − cos Ωt)ᵏ cos mΩt over one period; its lines at (m + j)Ω
polynomial   φ a polynomial of t/τ that begins with a power ≥ the order, from 0 to τ
sequence     φ, sample by sample

u = D φ and y = N φ; energy in is ∫ u y, above the level ∫ u y − σ u².
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import comb, pi
from typing import NamedTuple

from ..document.fields import Field, Number, OneOf, Read, Record, Whole, document, numbers
from ..document.number import about, up
from ..document.refusal import Invalid
from ..document.unit import SECONDS, always
from ..exact.polynomial import add, multiply, value
from .index import CLAIM, SYSTEM, Port, part_of, port_of

MOST_POWER = 400
MOST_CYCLES = 10**9
MOST_SAMPLES = 4_000_000
LONGEST_POLYNOMIAL = 200
HIGHEST_POWER = 2000
MOST_WORK = 40_000_000
MOST_LINES = 2_000_000_000
MOST_TERMS = 1_000_000_000
MOST_BITS_OF_TIME = 400
"""High powers of frequencies and durations are taken."""

BURST: dict[str, Field] = {
    "step": Number(always("rad_per_s"), above=0),
    "cycles": Whole(least=1, most=MOST_CYCLES),
    "power": Whole(least=0, most=MOST_POWER),
}
POLYNOMIAL: dict[str, Field] = {
    "duration": Number(SECONDS, above=0),
    "lowest_power": Whole(least=0, most=HIGHEST_POWER),
}

EXTRACTION = document(
    {
        "system": SYSTEM,
        **CLAIM,
        "motion": OneOf(
            "kind",
            {
                "burst": Record(BURST),
                "polynomial": Record({**POLYNOMIAL, "coefficients": numbers(most=LONGEST_POLYNOMIAL)}),
                "sequence": Record({"latent": numbers(most=MOST_SAMPLES)}),
            },
        ),
    }
)


class Taken(NamedTuple):
    """What comes out above the level: so much, times π of a burst."""

    share: Fraction
    of_a_burst: bool

    @property
    def energy(self) -> Fraction:
        """To rounding; its sign is that of the exact factor of π."""
        return self.share * (Fraction(pi) if self.of_a_burst else 1)


def extraction(told: Read) -> tuple[str, Fraction]:
    """What a motion from rest takes out above the level; it must be more than nothing."""
    p, motion = port_of(told), told.motion
    sums = {"burst": _burst, "polynomial": _polynomial, "sequence": _sequence}
    require_in_time(motion, p.continuous)
    return taken_out(told, -sums[motion.kind](p, motion))


def require_in_time(motion: Read, continuous: bool) -> None:
    """Refuse a sequence of a continuous port, and what is no sequence of a discrete one."""
    if continuous == (motion.kind == "sequence"):
        raise Invalid(f"no {motion.kind!r} motion in this time")


def taken_out(told: Read, share: Fraction) -> tuple[str, Fraction]:
    """The claim, and the energy."""
    energy = Taken(share, told.motion.kind == "burst").energy
    if energy <= 0:
        raise Invalid(f"the motion takes out {about(energy)}: none comes out")
    return f"the {told.index} index is less than {up(told.level)}", energy


def require_burst(motion: Read, order: int, entries: int = 1) -> None:
    """Refuse a burst that does not begin and end at rest, or has too many lines for the port.

    It has 2k + 1 lines; powers of the frequency of each are taken, for every entry of a matrix.
    """
    if motion.cycles <= motion.power or 2 * motion.power < order:
        raise Invalid("a burst that begins and ends at rest has more cycles than its power, and power enough")
    highest = (motion.cycles + motion.power) * short(motion.step)
    if entries * (2 * motion.power + 1) * (order + 1) ** 2 * (16 + _bits(highest)) > MOST_LINES:
        raise Invalid("the burst has too many lines for so large a port")


def require_polynomial(motion: Read, order: int, length: int, entries: int = 1) -> None:
    """Refuse a polynomial that does not begin at rest, or is too long for the port.

    Powers of τ in each term, it is differentiated for every entry of a matrix.
    """
    if motion.lowest_power < order:
        raise Invalid("the polynomial must begin at rest")
    terms = motion.lowest_power + length
    if entries * (order + 1) * terms**2 * _bits(short(motion.duration)) > MOST_TERMS:
        raise Invalid("the polynomial has too many terms for so large a port")


def weight_of_line(motion: Read, j: int) -> Fraction:
    """The square of the line at (m + j)Ω."""
    return Fraction(comb(2 * motion.power, motion.power + j), 2**motion.power) ** 2


def _burst(p: Port, motion: Read) -> Fraction:
    """W/π."""
    require_burst(motion, p.order)
    total = Fraction(0)
    for j in range(-motion.power, motion.power + 1):
        omega = (motion.cycles + j) * motion.step
        (a, b), (c, d) = (
            (value(part_of(side, 0), omega**2), omega * value(part_of(side, 1), omega**2))
            for side in (p.numerator, p.denominator)
        )
        total += weight_of_line(motion, j) * (a * c + b * d - p.level * (c * c + d * d))
    return total / Fraction(motion.step)


def short(x: Fraction) -> Fraction:
    """A frequency or a duration, refused if it has too many digits."""
    if max(x.numerator.bit_length(), x.denominator.bit_length()) > MOST_BITS_OF_TIME:
        raise Invalid("a frequency or a duration has too many digits")
    return x


def _bits(x: Fraction) -> int:
    return x.numerator.bit_length() + x.denominator.bit_length()


def _polynomial(p: Port, motion: Read) -> Fraction:
    """∫ u y − σ u² over 0 … τ."""
    require_polynomial(motion, p.order, len(motion.coefficients))
    phi = latent_polynomial(motion, motion.coefficients)
    u, y = (operated(side, phi) for side in (p.denominator, p.numerator))
    return integral(multiply(u, add(y, [-p.level * c for c in u])), motion.duration)


def latent_polynomial(motion: Read, coefficients: Sequence[Fraction]) -> list[Fraction]:
    """φ in powers of t."""
    told = [*[Fraction(0)] * motion.lowest_power, *coefficients]
    return [c / motion.duration**k for k, c in enumerate(told)]


def integral(integrand: Sequence[Fraction], tau: Fraction) -> Fraction:
    """Of a polynomial of t, from 0 to τ."""
    return sum((c * tau ** (k + 1) / (k + 1) for k, c in enumerate(integrand)), Fraction(0))


def operated(side: Sequence[Fraction], phi: list[Fraction]) -> list[Fraction]:
    """Σ c_i dⁱφ/dtⁱ, by Horner's rule in d/dt."""
    total = [Fraction(0)]
    for c in reversed(side):
        total = add([k * t for k, t in enumerate(total)][1:] or [Fraction(0)], [c * x for x in phi])
    return total


def _sequence(p: Port, motion: Read) -> Fraction:
    """Σ u y − σ u², shifted so that no sample is ahead of its time."""
    phi = motion.latent
    if len(phi) * (p.order + 1) > MOST_WORK:
        raise Invalid("the sequence is too long")
    total = Fraction(0)
    taps = [[(p.order - i, c) for i, c in enumerate(side) if c] for side in (p.denominator, p.numerator)]
    for k in range(len(phi)):
        u, y = (sum((c * phi[k - lag] for lag, c in side if lag <= k), Fraction(0)) for side in taps)
        total += u * y - p.level * u * u
    return total
