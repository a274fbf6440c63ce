"""What a motion of several axes takes out of a port above a level, summed from u = D φ and y = N φ."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import lcm

from ..document.fields import List, OneOf, Read, Record, document, numbers
from ..document.number import common_scale
from ..document.refusal import Invalid
from ..exact.polynomial import add, multiply, value
from .index import CLAIM, part_of
from .matrix import MATRIX_SYSTEM, MOST_AXES, MOST_WORK, Polynomial, Ports, ports_of
from .motion import (
    BURST,
    LONGEST_POLYNOMIAL,
    MOST_SAMPLES,
    POLYNOMIAL,
    integral,
    latent_polynomial,
    operated,
    require_burst,
    require_in_time,
    require_polynomial,
    taken_out,
    weight_of_line,
)


def _for_each_axis(most: int) -> List:
    return List(numbers(most=most), least=1, most=MOST_AXES)


MATRIX_EXTRACTION = document(
    {
        "system": MATRIX_SYSTEM,
        **CLAIM,
        "motion": OneOf(
            "kind",
            {
                "burst": Record({**BURST, **dict.fromkeys(("cosine", "sine"), numbers(most=MOST_AXES))}),
                "polynomial": Record({**POLYNOMIAL, "coefficients": _for_each_axis(LONGEST_POLYNOMIAL)}),
                "sequence": Record({"latent": _for_each_axis(MOST_SAMPLES)}),
            },
        ),
    }
)


def matrix_extraction(told: Read) -> tuple[str, Fraction]:
    """What a motion from rest takes out above the level; it must be more than nothing."""
    p, motion = ports_of(told), told.motion
    sums = {"burst": _burst, "polynomial": _polynomial, "sequence": _sequence}
    require_in_time(motion, p.continuous)
    return taken_out(told, -sums[motion.kind](p, motion))


def _axes(p: Ports, told: Sequence[list[Fraction]]) -> list[list[Fraction]]:
    if len(told) != p.axes or len({len(axis) for axis in told}) != 1:
        raise Invalid("the motion must have one list for every axis, all of one length")
    return list(told)


def _burst(p: Ports, motion: Read) -> Fraction:
    """W/π of φ_i = (1 − cos Ωt)ᵏ (α_i cos mΩt + β_i sin mΩt) over one period, by its lines at (m + j)Ω."""
    if not len(motion.cosine) == len(motion.sine) == p.axes:
        raise Invalid("a burst needs two numbers for every axis")
    require_burst(motion, p.order, p.axes**2)
    total = Fraction(0)
    for j in range(-motion.power, motion.power + 1):
        omega = (motion.cycles + j) * motion.step
        u, y = (_line(side, omega, motion.cosine, motion.sine) for side in (p.inputs, p.outputs))
        line = sum(
            (a * c + b * d - p.level * (a * a + b * b) for (a, b), (c, d) in zip(u, y, strict=True)),
            Fraction(0),
        )
        total += weight_of_line(motion, j) * line
    return total / Fraction(motion.step)


def _line(
    side: list[list[Polynomial]], omega: Fraction, alpha: Sequence[Fraction], beta: Sequence[Fraction]
) -> list[tuple[Fraction, Fraction]]:
    """A row's answer at jω to α_i − jβ_i."""
    answers = []
    for row in side:
        real = imaginary = Fraction(0)
        for q, a, b in zip(row, alpha, beta, strict=True):
            even, odd = value(part_of(q, 0), omega**2), omega * value(part_of(q, 1), omega**2)
            real += even * a + odd * b
            imaginary += odd * a - even * b
        answers.append((real, imaginary))
    return answers


def _polynomial(p: Ports, motion: Read) -> Fraction:
    """∫ uᵀy − σ uᵀu over 0 … τ, every φ_i a polynomial of t/τ that begins with power ≥ n."""
    axes = _axes(p, motion.coefficients)
    require_polynomial(motion, p.order, len(axes[0]), p.axes**2)
    latent = [latent_polynomial(motion, axis) for axis in axes]
    total = Fraction(0)
    for first, second in zip(p.inputs, p.outputs, strict=True):
        u, y = (
            _added([operated(q, phi) for q, phi in zip(row, latent, strict=True)]) for row in (first, second)
        )
        total += integral(multiply(u, add(y, [-p.level * c for c in u])), motion.duration)
    return total


def _added(signals: Sequence[list[Fraction]]) -> list[Fraction]:
    total = [Fraction(0)]
    for signal in signals:
        total = add(total, signal)
    return total


def _sequence(p: Ports, motion: Read) -> Fraction:
    """Σ uᵀy − σ uᵀu with u = D φ, y = N φ, shifted so that no sample is ahead of its time."""
    latent = _axes(p, motion.latent)
    length, large = len(latent[0]), common_scale(x for phi in latent for x in phi)
    sides = (p.inputs, p.outputs)
    scale = lcm(*(c.denominator for side in sides for row in side for q in row for c in q))
    whole = [[int(x * large) for x in phi] for phi in latent]
    if length * (p.order + 1) * p.axes**2 * (1 + large.bit_length() / 1000) > MOST_WORK:
        raise Invalid("the sequence is too long")
    taken = spent = 0
    for first, second in zip(*sides, strict=True):
        taps = [
            [
                (whole[axis], p.order - i, int(c * scale))
                for axis, q in enumerate(row)
                for i, c in enumerate(q)
                if c
            ]
            for row in (first, second)
        ]
        for k in range(length):
            u, y = (sum(c * phi[k - lag] for phi, lag, c in side if lag <= k) for side in taps)
            taken, spent = taken + u * y, spent + u * u
    return (taken - p.level * spent) / Fraction(scale * large) ** 2
