"""Rationals as flint has them, and balls: numbers known within a radius that every operation keeps true.

This is the arithmetic of the prover wherever it is not exact.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from fractions import Fraction

from flint import arb, ctx, fmpq


def as_fmpq(value: Fraction | int) -> fmpq:
    """A rational for flint."""
    return fmpq(value.numerator, value.denominator)


def as_fraction(value: fmpq) -> Fraction:
    """A rational of flint."""
    return Fraction(int(value.p), int(value.q))


def ball(value: Fraction) -> arb:
    """A ball that holds a rational, at the precision of the moment."""
    return arb(as_fmpq(value))


def middle(value: arb) -> Fraction:
    """The midpoint of a ball, exactly."""
    return as_fraction(value.mid().fmpq())


@contextmanager
def precision(bits: int) -> Iterator[None]:
    """Balls of so many bits inside."""
    saved = ctx.prec
    ctx.prec = bits
    try:
        yield
    finally:
        ctx.prec = saved
