"""A hand that is as active as it may be, or slightly more, and makes the loop grow.

    Z(s) = m_h s + k_h/s + r − (a' + r) · 2ζω₁ s/(s² + 2ζω₁ s + ω₁²)

Between 0 and f₀ its real part is at least −a', above f₀ it is ≥ 0, and at f₁ = ω₁/2π
it is −a'.  The spring is chosen so that device, hand and wall swing at f₁, where the
criterion is tightest; there the narrow resonance pays in what the loop does not take.
That the loop then grows is decided in balls, not by an eigenvalue in doubles.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from math import cos, floor, log, pi, sin
from typing import NamedTuple

import flint
import numpy as np
from flint import fmpq_poly, fmpz_poly

from zwidth.errors import InputError
from zwidth.loop.sampled_plant import ball
from zwidth.passivity.linear.loop import LinearLoop
from zwidth.passivity.linear.positivity import Positivity, prove_nonnegative
from zwidth.passivity.stability.characteristic import as_floats, decays
from zwidth.quantity.answered import answered, known
from zwidth.quantity.balls import as_fmpq, as_fraction, precision
from zwidth.quantity.documented import Documented
from zwidth.quantity.text import shown, told_quantity

EXCESS = 1e-3
"""By how much more than its limit the hand is active."""
_SHARPNESS = 0.005
"""ζ: the resonance is so narrow that hardly anything of it is left outside the band."""
_HIGHEST = 0.8
"""Of f₀: where in the band the hand drives, at most."""
_EQUAL = 1e-3
"""Frequencies that are tight to this part are taken for equally tight."""
_BITS = 512
_ALIASES = 2000


@dataclass(frozen=True, kw_only=True)
class ShakingHand(Documented):
    """One hand of bounded activity with which device and wall swing up, contact kept."""

    mass: float = answered("m_h", quantity="mass")
    stiffness: float = answered("k_h", quantity="stiffness")
    activity: float = answered("a', the largest −Re Z", quantity="damping")
    frequency: float = answered("f₁, at which it drives", unit="Hz")
    damping: float = answered("r, what it dissipates away from f₁", quantity="damping")
    sharpness: float = answered("ζ of its resonance")
    doubling_time: float = answered("in which the swing grows to twice its size", unit="s")
    motion: str = known('"linear" or "rotary"', default="linear")

    def describe(self) -> str:
        """The hand in a line."""
        activity, mass, stiffness = (
            told_quantity(value, name, self.motion, digits)
            for value, name, digits in (
                (self.activity, "damping", 6),
                (self.mass, "mass", 4),
                (self.stiffness, "stiffness", 6),
            )
        )
        return (
            f"{activity} at {shown(self.frequency, 'Hz')}, {mass} on {stiffness}: the swing doubles every "
            f"{_spoken(self.doubling_time)}"
        )


def _spoken(seconds: float) -> str:
    """A time as it is said: in hours and minutes where there are many seconds."""
    size, unit = next(((s, u) for s, u in ((3600, "h"), (60, "min")) if seconds >= 2 * s), (1, "s"))
    return f"{seconds / size:.3g} {unit}"


def tolerance(loop: LinearLoop, angles: np.ndarray) -> np.ndarray:
    """The largest activity at each θ alone, in doubles [N·s/m]: b (b − n)/(b − n (1 − s))."""
    b = float(loop.damping)
    need = np.array([loop.required_damping_at(Fraction(float(np.cos(t)))) for t in angles])
    s = np.sinc(angles / (2 * np.pi)) ** 2
    return np.asarray(b * (b - need) / (b - need * (1 - s)))


def shaking_hand(loop: LinearLoop, mass: float, band: Band, motion: str = "linear") -> ShakingHand | None:
    """A hand near the limit with which a device of this mass [kg; kg·m²] swings up; None: none was found."""
    top = 2 * pi * float(band.below * loop.period)
    angles = top * np.linspace(0.02, _HIGHEST, 40)
    room = tolerance(loop, angles)
    theta = float(angles[room <= room.min() + _EQUAL * abs(room.min())][-1])
    omega = theta / float(loop.period)
    line = complex(1 - np.exp(-1j * theta)) * _law(loop, theta) / float(loop.period)
    whole = mass + max(mass, 2 * abs(line) / omega**3, 2 * abs(_law(loop, theta)) / omega**2)
    activity, spring = _at_the_limit(loop, line, omega, whole)
    if not activity > 0 or not spring >= 0:
        return None
    found = _grown(loop, mass, band, activity * (1 + EXCESS), omega, whole - mass, spring)
    return None if found is None else replace(found, motion=motion)


def _law(loop: LinearLoop, theta: float) -> complex:
    """z⁻ᵈ H at e^{jθ}."""
    zeta = complex(cos(theta), -sin(theta))
    top, below = (np.polyval([float(c) for c in p[::-1]], zeta) for p in (loop.numerator, loop.denominator))
    return complex(zeta**loop.whole_delay * top / below)


def _at_the_limit(loop: LinearLoop, line: complex, omega: float, mass: float) -> tuple[float, float]:
    """The activity and the spring of the hand with which the loop neither grows nor decays at ω."""
    k = np.arange(1, _ALIASES + 1)
    turn = 2 * np.pi / float(loop.period)
    others = omega + turn * np.concatenate([-k[::-1], k])
    b, spring = float(loop.damping), 0.0
    for _ in range(30):  # the aliases hardly know the spring
        rest = (1 / (others**2 * (b + 1j * (mass * others - spring / others)))).sum()
        impedance = 1 / (omega**2 * (1 / line - rest))
        spring = float(omega * (mass * omega - impedance.imag))
    return float(b - impedance.real), spring


class _Hand(NamedTuple):
    mass: Fraction
    spring: Fraction
    omega: Fraction
    sharpness: Fraction


def _grown(
    loop: LinearLoop, device: float, band: Band, activity: float, omega: float, mass: float, spring: float
) -> ShakingHand | None:
    hand = _Hand(*(Fraction(v) for v in (mass, spring, omega, _SHARPNESS)))
    damping = _outside(Fraction(activity), hand, band)
    with precision(_BITS):
        polynomial = _characteristic(loop, Fraction(device), hand, damping, Fraction(activity))
        grows = decays(polynomial) is False
        size = float(np.abs(1 + np.roots(as_floats(polynomial))).max())
    if not grows or size <= 1:
        return None
    return ShakingHand(
        mass=mass,
        stiffness=spring,
        activity=activity,
        frequency=omega / (2 * pi),
        damping=float(damping),
        sharpness=_SHARPNESS,
        doubling_time=log(2) * float(loop.period) / log(size),
    )


def _outside(activity: Fraction, hand: _Hand, band: Band) -> Fraction:
    """r ≥ (a' + r) β: β is the resonance's real part at f₀, from where it falls."""
    edge = 2 * (PI - Fraction(1, 10**18)) * band.below
    wide = (2 * hand.sharpness * hand.omega * edge) ** 2
    beta = wide / ((edge**2 - hand.omega**2) ** 2 + wide)
    return activity * beta / (1 - beta)


def _characteristic(
    loop: LinearLoop, device: Fraction, hand: _Hand, damping: Fraction, activity: Fraction
) -> list[flint.arb]:
    """det((1 + ζ) I − A) of the loop, descending powers of ζ = z − 1.

    The state is x, v, the resonance's y and e, and the past positions and forces that the law knows.
    """
    flow = _flow(loop, device, hand, damping, activity)
    force, positions = _force(loop)
    size = len(force)
    matrix = [[flint.arb(0) for _ in range(size)] for _ in range(size)]
    for i in range(4):
        for j in range(size):
            matrix[i][j] = flow[i, 4] * ball(force[j]) + (flow[i, j] if j < 4 else 0)
    for k in range(4, size):  # each past value is the one before it, a sample later
        matrix[k][0 if k == 4 else k - 1] = flint.arb(1)
    if size > 4 + positions:
        matrix[4 + positions] = [ball(c) for c in force]
    for k in range(size):
        matrix[k][k] -= 1
    polynomial: list[flint.arb] = flint.arb_mat(matrix).charpoly().coeffs()
    return polynomial[::-1]


def _flow(
    loop: LinearLoop, device: Fraction, hand: _Hand, damping: Fraction, activity: Fraction
) -> flint.arb_mat:
    """x, v, y, e and the held force over a period: ẏ = 2ζω₁ (v − y) − ω₁ e, ė = ω₁ y, y/v the resonance."""
    whole, wide = device + hand.mass, 2 * hand.sharpness * hand.omega
    drag = loop.damping + damping
    rows: list[list[Fraction | int]] = [
        [0, 1, 0, 0, 0],
        [-hand.spring / whole, -drag / whole, (activity + damping) / whole, 0, -1 / whole],
        [0, wide, -wide, -hand.omega, 0],
        [0, 0, hand.omega, 0, 0],
        [0, 0, 0, 0, 0],
    ]
    return flint.arb_mat([[ball(Fraction(v) * loop.period) for v in row] for row in rows]).exp()


def _force(loop: LinearLoop) -> tuple[list[Fraction], int]:
    """The force of a sample from the state, D f = z⁻ᵈ N x, and how many past positions are in the state."""
    positions = len(loop.numerator) - 1 + loop.whole_delay
    first = loop.denominator[0]
    force = [Fraction(0)] * (4 + positions + len(loop.denominator) - 1)
    for j, c in enumerate(loop.numerator, loop.whole_delay):
        force[3 + j if j else 0] = Fraction(c, first)
    for j, c in enumerate(loop.denominator[1:]):
        force[4 + positions + j] = -Fraction(c, first)
    return force, positions


# The criterion inside the band in which the hand may be active.
#
# Above f₀ the device counts with its damping b, below with b_in: then the loop gives nothing to
# a hand of activity a,
#
#     b_in = b − a                               for a ≤ b
#     b_in = b (b − a)/(b − a (1 − s₀))          for a > b,  where b > a (1 − s₀)
#
# s₀ = 1 − θ₀²/12 ≤ (sin ½θ/½θ)² for all θ ≤ θ₀ = 2π f₀ T.  Both are b_in of docs/theory/known-hand.md
# at its smallest in the band: exact for θ → 0, and too small by a part of less than θ₀²/12 elsewhere.


PI = Fraction(3141592653589793239, 10**18)
"""Above π, by less than 1e-18."""


class Band(NamedTuple):
    """0 … f₀, in the loop's clock.

    Parameters
    ----------
    below
        f₀ [Hz].
    angle
        Not below θ₀ = 2π f₀ T.
    cosine
        Not above cos θ₀.
    """

    below: Fraction
    angle: Fraction
    cosine: Fraction


def band_of(below: Fraction, period: Fraction) -> Band:
    """The band up to f₀."""
    if not 0 < below <= 1 / (2 * period):
        raise InputError(
            f"below must be > 0 and at most half the rate, {shown(1 / (2 * period), 'Hz', 6)}, got "
            f"{shown(below, 'Hz', 6)}: a hand that is active above has no limit in a sampled loop"
        )
    angle = 2 * PI * below * period
    with precision(_BITS):
        below_it = as_fraction(ball(angle).cos().lower().fmpq()) if angle < PI else Fraction(-1)
    return Band(below, angle, Fraction(floor(below_it * 10**15), 10**15))


def damping_inside(damping: Fraction, activity: Fraction, band: Band) -> Fraction | None:
    """b_in [N·s/m]; None where no wall is damped enough for such a hand."""
    if activity <= damping:
        return damping - activity
    rest = damping - activity * band.angle**2 / 12
    return damping * (damping - activity) / rest if rest > 0 else None


def prove_inside(loop: LinearLoop, activity: Fraction, band: Band) -> Positivity | None:
    """A proof that the criterion with b_in holds in the band, in t with 2c = 1 + cos θ₀ + (1 − cos θ₀) t."""
    inside = damping_inside(loop.damping, activity, band)
    if inside is None:
        return None
    half = (1 - band.cosine) / 2
    shift = fmpq_poly([as_fmpq(1 - half), as_fmpq(half)])
    criterion: fmpz_poly = fmpq_poly(loop.with_damping(inside).criterion)(shift).numer()
    found = prove_nonnegative(criterion)
    return found if isinstance(found, Positivity) else None
