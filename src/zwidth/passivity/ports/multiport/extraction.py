"""The search for an input of several axes that takes more out of a port than a level allows.

Where Π_σ has a negative eigenvalue, a burst at that frequency with the amplitudes and phases of its
eigenvector does, if it is long enough.  Where it has none and a pole lies where it may not, energy
comes out of what grows: polynomials, or short sequences, as for one axis in `extraction`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from math import acos, pi, sin, sqrt
from typing import Literal

import numpy as np
from flint import fmpq, fmpq_poly

from zwidth.passivity.linear.elimination import negative_direction
from zwidth.passivity.ports.extraction import LONGEST_SEQUENCE, MOST_CYCLES, paces, rounded
from zwidth.passivity.ports.multiport.gaussian import Gaussian, absorbed_at, form_at, place, to_float
from zwidth.passivity.ports.multiport.motion import MatrixMotion, Signal, absorbed, polynomials, samples
from zwidth.passivity.ports.multiport.port import MatrixPort
from zwidth.passivity.ports.multiport.positive_real import prove_minors
from zwidth.passivity.ports.positive_real import places_of
from zwidth.quantity.balls import as_fmpq, as_fraction

_TERMS = 24
_LENGTHS = (2, 4, 8, 16, 32, 48)
_LARGEST_ORDER = 24

Axes = tuple[tuple[Fraction, ...], ...]


def find_matrix_motion(port: MatrixPort, level: Fraction, cosine: Fraction | None) -> MatrixMotion | None:
    """A motion with W < 0 at the level, looked for at `cosine` first; None if none is found."""
    found = prove_minors(port, level)
    for c in (cosine, found):
        if isinstance(c, Fraction) and -1 < c < 1:
            burst = _burst(port, level, c) if port.time == "continuous" else _discrete_burst(port, level, c)
            if burst is not None:
                return burst
    return _polynomial(port, level) if port.time == "continuous" else _sequence(port, level)


def _burst(port: MatrixPort, level: Fraction, cosine: Fraction) -> MatrixMotion | None:
    """As few cycles as are enough; smooth enough for u and y to be without jumps."""
    omega, power = sqrt((1 - cosine) / (1 + cosine)), port.order // 2 + 1
    for axes in _directions(port, level, Fraction(omega)):
        cycles = power + 1
        while cycles <= MOST_CYCLES:
            step = Fraction(f"{omega / cycles:.9g}")
            motion = MatrixMotion("burst", (step, Fraction(cycles), Fraction(power)), axes)
            if absorbed(port, level, motion) < 0:
                return motion
            cycles *= 2
    return None


def _discrete_burst(port: MatrixPort, level: Fraction, cosine: Fraction) -> MatrixMotion | None:
    """Windowed sinusoids in whole numbers and then rest, doubled in length until it is enough."""
    angle, tangent = acos(float(cosine)), Fraction(sqrt((1 - cosine) / (1 + cosine)))
    for axes in _directions(port, level, tangent):
        latent = np.array([complex(alpha, -beta) for alpha, beta in axes])
        length = 8
        while length * port.axes <= LONGEST_SEQUENCE:
            window = np.array([sin(pi * (i + 1) / (length + 1)) ** 2 for i in range(length)])
            turns = np.exp(1j * angle * (np.arange(length) - (length - 1) / 2))
            phi = (latent[:, None] * window * turns).real / np.abs(latent).max()
            for scale in (10, 1000, 10**6):
                whole = np.rint(scale * phi).astype(int)
                rest = (Fraction(0),) * port.order
                motion = MatrixMotion(
                    "sequence", (), tuple((*(Fraction(int(x)) for x in row), *rest) for row in whole)
                )
                if whole.any() and absorbed(port, level, motion) < 0:
                    return motion
            length *= 2
    return None


def _directions(port: MatrixPort, level: Fraction, tangent: Fraction) -> Iterator[Axes]:
    """(α_i, β_i) with aᴴ Π_σ a < 0 at this place: the eigenvector in few digits, or one by elimination."""
    at = place(port, tangent)
    form = form_at(port, level, at)
    for axes in _candidates(form):
        latent = [Gaussian(as_fmpq(alpha), -as_fmpq(beta)) for alpha, beta in axes]
        if absorbed_at(port, level, at, latent) < 0:
            yield axes
            return


def _candidates(form: list[list[Gaussian]]) -> Iterator[Axes]:
    scale = max(max(abs(x.real), abs(x.imaginary)) for row in form for x in row)
    if scale == 0:
        return
    shown = np.array(
        [[complex(to_float(x.real / scale), to_float(x.imaginary / scale)) for x in row] for row in form]
    )
    vector = np.linalg.eigh(shown)[1][:, 0]
    vector = vector / vector[np.argmax(np.abs(vector))]
    for digits in (4, 9, 15):
        yield tuple((_decimal(a.real, digits), _decimal(-a.imag, digits)) for a in vector)
    exact = negative_direction(_embedded(form))
    if exact is not None:
        size = len(form)
        values = [as_fraction(x) for x in exact]
        yield tuple((values[i], -values[size + i]) for i in range(size))


def _embedded(form: list[list[Gaussian]]) -> list[list[fmpq]]:
    """The real symmetric matrix (Re −Im; Im Re) of twice the size with the same values."""
    upper = [[x.real for x in row] + [-x.imaginary for x in row] for row in form]
    return upper + [[x.imaginary for x in row] + [x.real for x in row] for row in form]


def _polynomial(port: MatrixPort, level: Fraction) -> MatrixMotion | None:
    """Polynomials over a few durations, of the pace at which the port grows."""
    lowest, terms = port.order, max(2, _TERMS // port.axes)
    if lowest > _LARGEST_ORDER:
        return None
    poles = port.poles()
    known = port.denominator if poles is None else [int(c) for c in poles.numer().coeffs()]
    for tau in paces(places_of(known)):
        head = (tau, Fraction(lowest))
        pairs = [
            polynomials(port, _unit("polynomial", head, i, j, port.axes, terms))
            for i, j in _places(port, terms)
        ]
        in_x = [tuple([_poly(p) for p in side] for side in pair) for pair in pairs]
        form = [[_pairing(a, b, level) for b in in_x] for a in in_x]
        found = _verified(port, level, negative_direction(form), "polynomial", head)
        if found is not None:
            return found
    return None


def _sequence(port: MatrixPort, level: Fraction) -> MatrixMotion | None:
    """The first of growing lengths at which the form of φ is not ≥ 0."""
    for length in _LENGTHS:
        if length * port.axes > 2 * max(_LENGTHS):
            return None
        pairs = [
            samples(port, _unit("sequence", (), i, j, port.axes, length)) for i, j in _places(port, length)
        ]
        form = [[_dotted(a, b, level) for b in pairs] for a in pairs]
        found = _verified(port, level, negative_direction(form), "sequence", ())
        if found is not None:
            return found
    return None


def _places(port: MatrixPort, terms: int) -> list[tuple[int, int]]:
    return [(i, j) for i in range(port.axes) for j in range(terms)]


def _unit(
    kind: Literal["polynomial", "sequence"],
    head: tuple[Fraction, ...],
    axis: int,
    term: int,
    axes: int,
    terms: int,
) -> MatrixMotion:
    one = tuple(tuple(Fraction(int((i, j) == (axis, term))) for j in range(terms)) for i in range(axes))
    return MatrixMotion(kind, head, one)


def _pairing(
    first: Sequence[Sequence[fmpq_poly]], second: Sequence[Sequence[fmpq_poly]], level: Fraction
) -> fmpq:
    """½ ∫ uᵀz + vᵀy − 2σ uᵀv dx over [0, 1] of the pairs (u, y), (v, z)."""
    total = fmpq_poly([])
    for u, y, v, z in zip(*first, *second, strict=True):
        total += u * z + v * y - u * v * (2 * as_fmpq(level))
    return total.integral()(1) / 2


def _dotted(
    first: Sequence[Sequence[Signal]],
    second: Sequence[Sequence[Signal]],
    level: Fraction,
) -> fmpq:
    """The same, of samples."""
    total = Fraction(0)
    for u, y, v, z in zip(*first, *second, strict=True):
        total += sum(
            (a * d + b * c - 2 * level * a * c for a, b, c, d in zip(u, y, v, z, strict=True) if a or b),
            Fraction(0),
        )
    return as_fmpq(total / 2)


def _verified(
    port: MatrixPort,
    level: Fraction,
    direction: list[fmpq] | None,
    kind: Literal["polynomial", "sequence"],
    head: tuple[Fraction, ...],
) -> MatrixMotion | None:
    """The direction as a motion, in few digits where these are enough."""
    if direction is None:
        return None
    exact = [as_fraction(x) for x in direction]
    for digits in (3, 6, 12, 24):
        motion = MatrixMotion(kind, head, _by_axis(rounded(exact, digits), port.axes))
        if absorbed(port, level, motion) < 0:
            return motion
    return MatrixMotion(kind, head, _by_axis(exact, port.axes))


def _by_axis(values: Sequence[Fraction], axes: int) -> Axes:
    terms = len(values) // axes
    return tuple(tuple(values[i * terms : (i + 1) * terms]) for i in range(axes))


def _poly(ascending: Signal) -> fmpq_poly:
    return fmpq_poly([as_fmpq(c) for c in ascending])


def _decimal(value: float, digits: int) -> Fraction:
    return Fraction(f"{value:.{digits}f}")
