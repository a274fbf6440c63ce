"""What the hand puts in, less what coupling and environment keep: a form, decided, and its least damping.

With D the move of the handle, a that of the coupling, e = D − a that of the environment and f the force,

    W_h = Σ z^{−d−1}f D + (b/T) D²

is what a hand without inertia puts in.  Taking off Σ f e − ΔΦ − … ≥ 0, which the environment keeps, leaves

    slopes      f a + (z^{−d−1}f − f) D + ½ Δf e − g (Δf − μ e)(L e − Δf),    g ≥ 1/(2 (L − μ))
    excess      f a + (z^{−d−1}f − f) D + ι e²/T + ο T f²

besides (b/T) D².  In w = x − y, the length of the coupling: f = K_c w + B_c a/T, a = w(k) − w(k − 1); without
a coupling w = f and a = 0.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import accumulate
from math import inf, isfinite, pi

import numpy as np
from flint import fmpq_poly
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from zwidth.loop.sampled_plant import times
from zwidth.passivity.coupling.environment_class import PassivityExcess, SlopeBounds
from zwidth.passivity.linear.exact_algebra import from_cosines
from zwidth.passivity.linear.positivity import Positivity, prove_nonnegative
from zwidth.quantity.balls import as_fmpq

# A quadratic form of two sequences, decided exactly: is it ≥ 0 for all of them?
#
#     Q = Σ_k Σ_i cᵢ pᵢ(k) qᵢ(k),    each of pᵢ, qᵢ = (polynomial in z⁻¹) w + (polynomial in z⁻¹) D
#
# By Parseval it is the mean over θ of a Hermitian 2 × 2 form, whose entries are polynomials in cos θ, and
# |N₁₂|² too.  It is ≥ 0 for all finite sequences exactly if
#
#     N₁₁ ≥ 0,    N₂₂ ≥ 0,    N₁₁ N₂₂ − |N₁₂|² ≥ 0    for −1 ≤ cos θ ≤ 1.


Polynomial = Sequence[Fraction]
Signal = tuple[Polynomial, Polynomial]
"""What multiplies w and what multiplies D, in ascending powers of z⁻¹."""

Term = tuple[Fraction, Signal, Signal]
"""c, p and q of c p(k) q(k)."""

Cosines = tuple[Fraction, ...]


@dataclass(frozen=True)
class TwoSignalForm:
    """N₁₁, N₂₂ and |N₁₂|² as coefficients a_n of Σ a_n cos nθ."""

    first: Cosines
    second: Cosines
    cross: Cosines

    @classmethod
    def of(cls, terms: Iterable[Term]) -> TwoSignalForm:
        """The form of Σ c p q."""
        first: dict[int, Fraction] = {}
        second: dict[int, Fraction] = {}
        mixed: dict[int, Fraction] = {}
        for c, (p1, p2), (q1, q2) in terms:
            _add(first, c, p1, q1)
            _add(second, c, p2, q2)
            _add(mixed, c / 2, p2, q1)
            _add(mixed, c / 2, q2, p1)
        square: dict[int, Fraction] = {}
        for i, a in mixed.items():
            for j, b in mixed.items():
                square[i - j] = square.get(i - j, Fraction(0)) + a * b
        return cls(_real(first), _real(second), _real(square))

    def is_nonnegative(self, more: Fraction = Fraction(0)) -> bool:
        """True when Q + `more` Σ D² ≥ 0 for all sequences: decided exactly."""
        first, second, cross = (_polynomial(a) for a in (self.first, self.second, self.cross))
        second += as_fmpq(more)
        return all(_holds(p) for p in (first, second, first * second - cross))

    def first_is_nonnegative(self) -> bool:
        """True when Q ≥ 0 for D = 0: what no multiple of D² can mend."""
        return _holds(_polynomial(self.first))

    def need(self, cosines: NDArray[np.float64]) -> NDArray[np.float64]:
        """At each cos θ the least `more`: |N₁₂|²/N₁₁ − N₂₂, infinite where N₁₁ ≤ 0 < |N₁₂|²."""
        first, cross = self.first, self.cross
        while (
            any(first) and sum(first) == 0 and sum(cross) == 0
        ):  # a form of differences: 1 − cos θ is in both
            first, cross = _reduced(first), _reduced(cross)
        below, above = _evaluate(first, cosines), _evaluate(cross, cosines)
        ratio = np.where(above > 0, np.inf, 0.0)
        np.divide(above, below, out=ratio, where=below > 0)
        return np.asarray(ratio - _evaluate(self.second, cosines))


def _add(total: dict[int, Fraction], c: Fraction, p: Polynomial, q: Polynomial) -> None:
    """Adds c p conj(q), by powers of z⁻¹."""
    for i, a in enumerate(p):
        for j, b in enumerate(q):
            total[i - j] = total.get(i - j, Fraction(0)) + c * a * b


def _real(powers: Mapping[int, Fraction]) -> Cosines:
    """The real part of Σ a_n z⁻ⁿ."""
    top = max((abs(n) for n in powers), default=0)
    return tuple(sum((powers.get(m, Fraction(0)) for m in {n, -n}), Fraction(0)) for n in range(top + 1))


def _reduced(cosines: Cosines) -> Cosines:
    """The quotient by 1 − cos θ = −½ z⁻¹ (z − 1)²: two running sums of the powers of z."""
    powers = [*(a / 2 for a in cosines[:0:-1]), cosines[0], *(a / 2 for a in cosines[1:])]
    twice = [2 * a for a in accumulate(accumulate(-a for a in powers))]
    middle = len(cosines) - 2  # of the quotient, whose highest power is one lower
    half = twice[middle : 2 * middle + 1] if middle >= 0 else []
    return (half[0], *(2 * a for a in half[1:])) if half else (Fraction(0),)


def _polynomial(cosines: Cosines) -> fmpq_poly:
    """Σ a_n cos nθ as a polynomial in cos θ."""
    return from_cosines([as_fmpq(a) for a in cosines])


def _holds(p: fmpq_poly) -> bool:
    return isinstance(prove_nonnegative(p.numer()), Positivity)


def _evaluate(cosines: Cosines, x: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(np.polynomial.chebyshev.chebval(x, [float(a) for a in cosines]))


_NONE: Polynomial = (Fraction(0),)
_ONE: Polynomial = (Fraction(1),)
_STEP: Polynomial = (Fraction(1), Fraction(-1))
"""1 − z⁻¹."""

Connection = tuple[Polynomial, Polynomial]
"""What f and a are of w."""

DIRECT: Connection = (_ONE, _NONE)
"""Without a coupling."""


def coupled(stiffness: Fraction, damping: Fraction, period: Fraction) -> Connection:
    """f and a behind a spring and a damper."""
    return (stiffness + damping / period, -damping / period), _STEP


def slopes_form(slopes: SlopeBounds, g: Fraction, connection: Connection, d: int) -> TwoSignalForm:
    """Of static springs between two slopes."""
    low, high = slopes.least.fraction, slopes.greatest.fraction
    change: Signal = (times(list(connection[0]), list(_STEP)), _NONE)
    move = _move(connection)
    half = Fraction(1, 2)
    return TwoSignalForm.of(
        [
            *_supply(connection, d),
            (half - g * (low + high), change, move),
            (g, change, change),
            (g * low * high, move, move),
        ]
    )


def excess_form(excess: PassivityExcess, connection: Connection, d: int, period: Fraction) -> TwoSignalForm:
    """Of environments with excess or shortage."""
    force: Signal = (connection[0], _NONE)
    move = _move(connection)
    return TwoSignalForm.of(
        [
            *_supply(connection, d),
            (excess.input.fraction / period, move, move),
            (excess.output.fraction * period, force, force),
        ]
    )


def least_multiplier(slopes: SlopeBounds) -> Fraction:
    """1/(2 (L − μ)); 0 for a linear spring, where the chord is the curve."""
    width = slopes.greatest.fraction - slopes.least.fraction
    return 1 / (2 * width) if width else Fraction(0)


def _supply(connection: Connection, d: int) -> list[Term]:
    """f a + (z^{−d−1}f − f) D."""
    force, stretch = connection
    late = [Fraction(-1), *[Fraction(0)] * d, Fraction(1)]
    handle: Signal = (_NONE, _ONE)
    return [
        (Fraction(1), (force, _NONE), (stretch, _NONE)),
        (Fraction(1), (times(list(force), late), _NONE), handle),
    ]


def _move(connection: Connection) -> Signal:
    return [-c for c in connection[1]], _ONE


_ANGLES = np.linspace(0, pi, 2001)

_DECADES = np.linspace(-5, 4, 46)
"""Of g above its least value, in units of 1/(the greatest stiffness that occurs)."""


def best_form(slopes: SlopeBounds, connection: Connection, d: int) -> TwoSignalForm:
    """The form of `slopes_form` with the multiplier g that asks for the least damping.

    The need is convex in g: b and g enter the Hermitian form linearly.
    """
    least = least_multiplier(slopes)
    stiffness = [slopes.least.fraction, slopes.greatest.fraction, *connection[0]]
    scale = max(abs(c) for c in stiffness) or Fraction(1)
    cosines = np.cos(_ANGLES[::10])

    def form(more: float) -> TwoSignalForm:
        return slopes_form(slopes, least + Fraction(more) / scale, connection, d)

    def need(decade: float) -> float:
        return float(np.max(form(10.0**decade).need(cosines)))

    at = _DECADES[int(np.argmin([need(p) for p in _DECADES]))]
    found = minimize_scalar(need, bounds=(at - 0.2, at + 0.2), method="bounded", options={"xatol": 1e-7})
    bare = form(0.0)
    return bare if np.max(bare.need(cosines)) <= found.fun else form(10.0 ** float(found.x))


def largest_need(form: TwoSignalForm, period: Fraction) -> tuple[float, float]:
    """b that is enough [N·s/m], infinite if none is, and the frequency that asks for it [Hz].

    The need over frequency is found by floats, and raised until it is proved, by 10⁻¹² of itself or so.
    """
    needs = form.need(np.cos(_ANGLES))
    top = int(np.argmax(needs))
    angle, need = float(_ANGLES[top]), float(needs[top])
    if not form.first_is_nonnegative() or not isfinite(need):
        return inf, angle / (2 * pi * float(period))
    bounds = _ANGLES[max(top - 1, 0)], _ANGLES[min(top + 1, len(_ANGLES) - 1)]
    found = minimize_scalar(lambda a: -form.need(np.cos([a]))[0], bounds=bounds, method="bounded")
    if -found.fun > need:
        angle, need = float(found.x), -float(found.fun)
    return _proved(form, max(need, 0.0), period), angle / (2 * pi * float(period))


def _proved(form: TwoSignalForm, need: float, period: Fraction) -> float:
    """The first of need (1 + 10⁻¹⁵ 4ⁿ) that is proved; infinite if the floats were wrong by a millionth."""
    more = 1e-15
    while more < 1e-6:
        enough = float(period) * need * (1 + more)
        if form.is_nonnegative(Fraction(enough) / period):
            return enough
        more *= 4
    return inf
