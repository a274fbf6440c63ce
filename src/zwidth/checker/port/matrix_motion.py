"""What a motion of several axes takes out of a port above a level, summed from u = D φ and y = N φ."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from math import comb, lcm, pi
from typing import Any

from ..document.reading import (
    MOST_COEFFICIENTS,
    MOST_SAMPLES,
    Invalid,
    common_scale,
    get,
    integer,
    number,
    numbers,
)
from ..loop.proofs import _multiply, _sum
from .index import (
    MOST_POWER,
    MOST_WORK,
    _horner,
    _operated,
    _part,
    _short,
    bounded_lines,
    bounded_terms,
    taken_out,
)
from .matrix import Polynomial, _Ports, read_ports


def matrix_extraction(document: Mapping[str, Any]) -> tuple[str, Fraction]:
    """What a motion from rest takes out above the level; it must be more than nothing."""
    p, motion = read_ports(document), get(document, "motion")
    weights = {
        "burst": lambda: _burst(p, motion) * Fraction(pi),  # the sign is that of the exact factor of π
        "polynomial": lambda: _polynomial(p, motion),
        "sequence": lambda: _sequence(p, _axes(p, get(motion, "latent"), MOST_SAMPLES)),
    }
    return taken_out(document, weights, p.continuous, p.level)


def _axes(p: _Ports, values: Any, most: int) -> list[list[Fraction]]:
    if not isinstance(values, Sequence) or len(values) != p.axes:
        raise Invalid("the motion must have one list for every axis")
    axes = [numbers(axis, most) for axis in values]
    if len({len(axis) for axis in axes}) != 1:
        raise Invalid("the axes of the motion must be of one length")
    return axes


def _burst(p: _Ports, motion: Mapping[str, Any]) -> Fraction:
    """W/π of φ_i = (1 − cos Ωt)ᵏ (α_i cos mΩt + β_i sin mΩt) over one period, by its lines at (m + j)Ω."""
    step = _short(number(get(motion, "step_rad_per_s")))
    cycles, power = integer(get(motion, "cycles")), integer(get(motion, "power"))
    alpha, beta = (numbers(get(motion, key)) for key in ("cosine", "sine"))
    if step <= 0 or cycles <= power or power > MOST_POWER or not len(alpha) == len(beta) == p.axes:
        raise Invalid("a burst needs Ω > 0, more cycles than its power, and two numbers for every axis")
    if 2 * power < p.order:
        raise Invalid("the burst is not smooth enough to begin and end at rest")
    bounded_lines(p.order, (cycles + power) * step, power, p.axes**2)
    total = Fraction(0)
    for j in range(-power, power + 1):
        u, y = (_line(side, (cycles + j) * step, alpha, beta) for side in (p.inputs, p.outputs))
        line = sum(
            (a * c + b * d - p.level * (a * a + b * b) for (a, b), (c, d) in zip(u, y, strict=True)),
            Fraction(0),
        )
        total += Fraction(comb(2 * power, power + j), 2**power) ** 2 * line
    return total / step


def _line(
    side: list[list[Polynomial]], omega: Fraction, alpha: Sequence[Fraction], beta: Sequence[Fraction]
) -> list[tuple[Fraction, Fraction]]:
    """A row's answer at jω to α_i − jβ_i."""
    answers = []
    for row in side:
        real = imaginary = Fraction(0)
        for q, a, b in zip(row, alpha, beta, strict=True):
            even, odd = _horner(_part(q, 0), omega**2), omega * _horner(_part(q, 1), omega**2)
            real += even * a + odd * b
            imaginary += odd * a - even * b
        answers.append((real, imaginary))
    return answers


def _polynomial(p: _Ports, motion: Mapping[str, Any]) -> Fraction:
    """∫ uᵀy − σ uᵀu over 0 … τ, every φ_i a polynomial of t/τ that begins with power ≥ n."""
    tau, lowest = _short(number(get(motion, "duration_s"))), integer(get(motion, "lowest_power"))
    if tau <= 0 or lowest < p.order or lowest > MOST_COEFFICIENTS:
        raise Invalid("the polynomial must last and begin at rest")
    axes = _axes(p, get(motion, "coefficients"), 200)
    bounded_terms(p.order, tau, lowest + len(axes[0]), p.axes**2)
    latent = [[c / tau**k for k, c in enumerate([*[Fraction(0)] * lowest, *a])] for a in axes]
    total = Fraction(0)
    for first, second in zip(p.inputs, p.outputs, strict=True):
        u, y = (
            _added([_operated(q, phi) for q, phi in zip(row, latent, strict=True)]) for row in (first, second)
        )
        integrand = _multiply(u, _sum(y, [-p.level * c for c in u]))
        total += sum((c * tau ** (k + 1) / (k + 1) for k, c in enumerate(integrand)), Fraction(0))
    return total


def _added(signals: Sequence[list[Fraction]]) -> list[Fraction]:
    total = [Fraction(0)]
    for signal in signals:
        total = _sum(total, signal)
    return total


def _sequence(p: _Ports, latent: list[list[Fraction]]) -> Fraction:
    """Σ uᵀy − σ uᵀu with u = D φ, y = N φ, shifted so that no sample is ahead of its time."""
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
