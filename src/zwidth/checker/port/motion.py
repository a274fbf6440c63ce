"""What a motion of a port from rest takes out above a level of its index, summed from u = D φ and y = N φ.

burst        φ_i = (1 − cos Ωt)ᵏ (α_i cos mΩt + β_i sin mΩt) over one period; its lines at (m + j)Ω
polynomial   φ_i a polynomial of t/τ that begins with a power ≥ the order, from 0 to τ
sequence     φ_i, sample by sample

One signal φ_i for each axis; of a single axis α = 1 and β = 0.  Energy in is ∫ uᵀy, above the level
∫ uᵀy − σ uᵀu.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from math import comb, lcm, pi
from typing import Any

from ..document.fields import Field, List, Number, OneOf, Read, Record, Whole, document, numbers
from ..document.number import SECONDS, about, always, common_scale, up
from ..document.refusal import Invalid, spend
from ..exact.polynomial import add, multiply, value
from .system import CLAIM, MATRIX_SYSTEM, MOST_AXES, SYSTEM, Polynomial, Port, part_of, port_of

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

_BURST: dict[str, Field] = {
    "step": Number(always("rad_per_s"), above=0),
    "cycles": Whole(least=1, most=MOST_CYCLES),
    "power": Whole(least=0, most=MOST_POWER),
}
_POLYNOMIAL: dict[str, Field] = {
    "duration": Number(SECONDS, above=0),
    "lowest_power": Whole(least=0, most=HIGHEST_POWER),
}


def _motions(burst: Mapping[str, Field], coefficients: List, latent: List) -> OneOf:
    kinds = {
        "burst": Record({**_BURST, **burst}),
        "polynomial": Record({**_POLYNOMIAL, "coefficients": coefficients}),
        "sequence": Record({"latent": latent}),
    }
    return OneOf("kind", kinds)


def _for_each_axis(most: int) -> List:
    return List(numbers(most=most), least=1, most=MOST_AXES)


EXTRACTION = document(
    {
        "system": SYSTEM,
        **CLAIM,
        "motion": _motions({}, numbers(most=LONGEST_POLYNOMIAL), numbers(most=MOST_SAMPLES)),
    }
)
MATRIX_EXTRACTION = document(
    {
        "system": MATRIX_SYSTEM,
        **CLAIM,
        "motion": _motions(
            dict.fromkeys(("cosine", "sine"), numbers(most=MOST_AXES)),
            _for_each_axis(LONGEST_POLYNOMIAL),
            _for_each_axis(MOST_SAMPLES),
        ),
    }
)


def extraction(told: Read) -> tuple[str, Fraction]:
    """The claim, and what a motion from rest takes out above the level; it must be more than nothing.

    Of a burst it is known to rounding, for π is; its sign is that of the exact factor of π.
    """
    p, motion = port_of(told), told.motion
    if p.continuous == (motion.kind == "sequence"):
        raise Invalid("a continuous port is moved by a burst or a polynomial, a discrete one by a sequence")
    sums = {"burst": _burst, "polynomial": _polynomial, "sequence": _sequence}
    energy = -sums[motion.kind](p, motion) * (Fraction(pi) if motion.kind == "burst" else 1)
    if energy <= 0:
        raise Invalid(f"the motion takes out {about(energy)}: none comes out")
    return f"the {told.index} index is less than {up(told.level)}", energy


def _axes(p: Port, told: Sequence[Any]) -> list[Polynomial]:
    """One list for each axis; of a single axis it may be listed by itself."""
    axes = list(told) if told and isinstance(told[0], list) else [list(told)]
    if len(axes) != p.axes or len({len(axis) for axis in axes}) != 1:
        raise Invalid("the motion must have one list for every axis, all of one length")
    return axes


def _burst(p: Port, motion: Read) -> Fraction:
    """W/π, by the lines."""
    alpha = getattr(motion, "cosine", [Fraction(1)])
    beta = getattr(motion, "sine", [Fraction(0)])
    if not len(alpha) == len(beta) == p.axes:
        raise Invalid("a burst needs two numbers for every axis")
    _require_few_lines(p, motion)
    sides = [
        [[(part_of(q, 0), part_of(q, 1)) for q in row] for row in side] for side in (p.inputs, p.outputs)
    ]
    total = Fraction(0)
    for j in range(-motion.power, motion.power + 1):
        omega = (motion.cycles + j) * motion.step
        u, y = (_line(side, omega, alpha, beta) for side in sides)
        line = sum(
            (a * c + b * d - p.level * (a * a + b * b) for (a, b), (c, d) in zip(u, y, strict=True)),
            Fraction(0),
        )
        total += Fraction(comb(2 * motion.power, motion.power + j), 2**motion.power) ** 2 * line
    return total / Fraction(motion.step)


def _require_few_lines(p: Port, motion: Read) -> None:
    """Refuse a burst that does not begin and end at rest, or has too many lines for the port.

    It has 2k + 1 lines; powers of the frequency of each are taken, for every entry of a matrix.
    """
    if motion.cycles <= motion.power or 2 * motion.power < p.order:
        raise Invalid("a burst must have more cycles than its power, and a power of half the order or more")
    lines = p.axes**2 * (2 * motion.power + 1) * (p.order + 1) ** 2
    bits = _bits((motion.cycles + motion.power) * _short(motion.step))
    spend(lines / (p.order + 1) * 6, bits * (p.order + 1), each=2)
    if lines * (16 + bits) > MOST_LINES:
        raise Invalid("the burst has too many lines for so large a port")


def _line(
    side: list[list[tuple[Polynomial, Polynomial]]],
    omega: Fraction,
    alpha: Sequence[Fraction],
    beta: Sequence[Fraction],
) -> list[tuple[Fraction, Fraction]]:
    """A row's answer at jω to α_i − jβ_i, from even and odd parts."""
    answers, square = [], omega * omega
    for row in side:
        real = imaginary = Fraction(0)
        for (even, odd), a, b in zip(row, alpha, beta, strict=True):
            e, o = value(even, square), omega * value(odd, square)
            real, imaginary = real + e * a, imaginary + o * a
            if b:
                real, imaginary = real + o * b, imaginary - e * b
        answers.append((real, imaginary))
    return answers


def _short(x: Fraction) -> Fraction:
    """A frequency or a duration, refused if it has too many digits."""
    if max(x.numerator.bit_length(), x.denominator.bit_length()) > MOST_BITS_OF_TIME:
        raise Invalid("a frequency or a duration has too many digits")
    return x


def _bits(x: Fraction) -> int:
    return x.numerator.bit_length() + x.denominator.bit_length()


def _polynomial(p: Port, motion: Read) -> Fraction:
    """∫ uᵀy − σ uᵀu over 0 … τ, every φ_i a polynomial of t/τ that begins with power ≥ n."""
    axes = _axes(p, motion.coefficients)
    _require_few_terms(p, motion, len(axes[0]))
    latent = [
        [c / motion.duration**k for k, c in enumerate([*[Fraction(0)] * motion.lowest_power, *axis])]
        for axis in axes
    ]
    total = Fraction(0)
    for first, second in zip(p.inputs, p.outputs, strict=True):
        u, y = (
            _added([_operated(q, phi) for q, phi in zip(row, latent, strict=True)]) for row in (first, second)
        )
        total += _integral(multiply(u, add(y, [-p.level * c for c in u])), motion.duration)
    return total


def _require_few_terms(p: Port, motion: Read, length: int) -> None:
    """Refuse a polynomial that does not begin at rest, or is too long for the port.

    Powers of τ in each term, it is differentiated for every entry of a matrix.
    """
    if motion.lowest_power < p.order:
        raise Invalid("the polynomial must begin at rest")
    terms = motion.lowest_power + length
    spend(4 * p.axes**2 * (p.order + 1) * terms, terms * _bits(_short(motion.duration)), each=2)
    if p.axes**2 * (p.order + 1) * terms**2 * _bits(_short(motion.duration)) > MOST_TERMS:
        raise Invalid("the polynomial has too many terms for so large a port")


def _operated(side: Sequence[Fraction], phi: Polynomial) -> Polynomial:
    """Σ c_i dⁱφ/dtⁱ, by Horner's rule in d/dt."""
    total = [Fraction(0)]
    for c in reversed(side):
        total = add([k * t for k, t in enumerate(total)][1:] or [Fraction(0)], [c * x for x in phi])
    return total


def _added(signals: Sequence[Polynomial]) -> Polynomial:
    total = [Fraction(0)]
    for signal in signals:
        total = add(total, signal)
    return total


def _integral(integrand: Sequence[Fraction], tau: Fraction) -> Fraction:
    """Of a polynomial of t, from 0 to τ."""
    return sum((c * tau ** (k + 1) / (k + 1) for k, c in enumerate(integrand)), Fraction(0))


def _sequence(p: Port, motion: Read) -> Fraction:
    """Σ uᵀy − σ uᵀu, shifted so that no sample is ahead of its time; in whole numbers."""
    latent = _axes(p, motion.latent)
    length, large = len(latent[0]), common_scale(x for phi in latent for x in phi)
    if length * (p.order + 1) * p.axes**2 * (1 + large.bit_length() // 1000) > MOST_WORK:
        raise Invalid("the sequence is too long")
    sides = (p.inputs, p.outputs)
    scale = lcm(*(c.denominator for side in sides for row in side for q in row for c in q))
    spend(2 * length * (p.order + 2) * p.axes**2, large.bit_length(), scale.bit_length(), each=0.4)
    whole = [[int(x * large) for x in phi] for phi in latent]
    taken = spent = 0
    for rows in zip(*sides, strict=True):
        taps = [
            [
                (phi, p.order - i, int(c * scale))
                for phi, q in zip(whole, row, strict=True)
                for i, c in enumerate(q)
                if c
            ]
            for row in rows
        ]
        for k in range(length):
            u, y = (sum(c * phi[k - lag] for phi, lag, c in side if lag <= k) for side in taps)
            taken, spent = taken + u * y, spent + u * u
    return (taken - p.level * spent) / Fraction(scale * large) ** 2
