"""What the hand puts in, less what coupling and environment are known to keep: a form in two sequences.

With D the move of the handle, a that of the coupling, e = D − a that of the environment and f the force,

    W_h = Σ z^{−d−1}f D + (b/T) D²

is what a hand without inertia puts in.  Taking off Σ f e − ΔΦ − … ≥ 0, which the environment keeps, leaves

    slopes      f a + (z^{−d−1}f − f) D + ½ Δf e − g (Δf − μ e)(L e − Δf),    g ≥ 1/(2 (L − μ))
    excess      f a + (z^{−d−1}f − f) D + ι e²/T + ο T f²

besides (b/T) D².  In w = x − y, the length of the coupling: f = K_c w + B_c a/T, a = w(k) − w(k − 1); without
a coupling w = f and a = 0.
"""

from __future__ import annotations

from fractions import Fraction

from zwidth.passivity.coupling.loop_transformation.environment_class import PassivityExcess, SlopeBounds
from zwidth.passivity.coupling.loop_transformation.two_signals import Polynomial, Signal, Term, TwoSignalForm

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
    change: Signal = (_times(connection[0], _STEP), _NONE)
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
    late = (Fraction(-1), *[Fraction(0)] * d, Fraction(1))
    handle: Signal = (_NONE, _ONE)
    return [
        (Fraction(1), (force, _NONE), (stretch, _NONE)),
        (Fraction(1), (_times(force, late), _NONE), handle),
    ]


def _move(connection: Connection) -> Signal:
    """e = D − a."""
    return [-c for c in connection[1]], _ONE


def _times(p: Polynomial, q: Polynomial) -> list[Fraction]:
    product = [Fraction(0)] * (len(p) + len(q) - 1)
    for i, a in enumerate(p):
        for j, b in enumerate(q):
            product[i + j] += a * b
    return product
