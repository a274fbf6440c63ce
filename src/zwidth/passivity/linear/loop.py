"""The sampled loop as exact polynomials.

With ζ = z⁻¹ = e^{−jθ}, θ = ωT, c = cos θ, H = N(ζ)/D(ζ) and the delay
(d + α)T, 0 ≤ α < 1, the energy a hand puts in over any motion is, at the least,

    W = ½ ∫ |v|² q(cos θ) dθ/2π        (x = D w, v = w(k+1) − w(k))
    q(c) = (2b/T) |D|² − R + (1 + c) S − (T α(1−α)/2b) |N|²
    M D̄ = R(c) + j sin θ S(c),          M = ζᵈ (1 − α + α ζ) N

so the loop cannot give out energy exactly if q ≥ 0 on [−1, 1] (and H is
stable).  α = 0 is the criterion of Colgate & Schenkel (1997),
b ≥ (T/2) Re{(1 − z⁻¹) H}/(1 − cos ωT); the last term is what the hand gains by
moving in the instant at which a delayed force changes inside a sample.
Everything is rational: N, D, b, T, α are the decimals that were typed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from fractions import Fraction
from functools import cached_property
from math import floor, gcd, inf, isfinite, lcm, log10

from flint import arb, arb_poly, fmpq, fmpq_poly, fmpz_poly

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment.environment import Environment, RationalFunction
from zwidth.passivity.linear.exact_algebra import from_cosines, is_schur, real_product
from zwidth.quantity.balls import as_fmpq, as_fraction, precision

LARGEST_DEGREE = 120
"""The order of H plus the delay in samples that is still decided."""

HIGH_DEGREE = 40
"""Order and delay beyond which limits and advice are looked for in coarser steps."""

LARGEST_DIGITS = 1000
"""Digits of N and D as whole numbers that are still decided: a proof has more than twice as many."""

_PRECISIONS = (256, 1024, 4096)  # bits of the balls in which a need is evaluated, one after the other


@dataclass(frozen=True)
class LinearLoop:
    """A device and H(z), exact: what the linear criterion needs and no more."""

    # coprime integer coefficients of N and D in ascending powers of ζ = z⁻¹
    numerator: tuple[int, ...]
    denominator: tuple[int, ...]
    # b [N·s/m] and T [s]
    damping: Fraction
    period: Fraction
    # d and α of delay = (d + α) T
    whole_delay: int
    part_delay: Fraction
    # False when a factor that N and D had in common has a root on or outside the unit circle: the port does
    # not see that mode, the controller carries it
    hidden_modes_decay: bool = True

    def __getstate__(self) -> dict[str, object]:
        """What was given: polynomials worked out from it cannot be pickled, and are worked out again."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    @property
    def order(self) -> int:
        """Order of H(z)."""
        return len(self.denominator) - 1

    @property
    def degree(self) -> int:
        """Order of H(z) and delay in whole samples together."""
        return max(len(self.numerator), len(self.denominator)) - 1 + self.whole_delay

    @cached_property
    def follower(self) -> tuple[int, ...]:
        """D without its integer content: x = follower · w keeps x small for small whole w."""
        content = gcd(*self.denominator)
        return tuple(c // content for c in self.denominator)

    @property
    def static_stiffness(self) -> Fraction | None:
        """H(1) [N/m]; None with a pole there."""
        at_one = sum(self.denominator)
        return Fraction(sum(self.numerator), at_one) if at_one else None

    def with_damping(self, damping: Fraction) -> LinearLoop:
        """The same loop on a device with another b."""
        return replace(self, damping=damping)

    @cached_property
    def dissipation(self) -> fmpq_poly:
        """|D|² as a polynomial in c."""
        return real_product(self.denominator, self.denominator)

    @cached_property
    def switching(self) -> fmpq_poly:
        """|N|² as a polynomial in c."""
        return real_product(self.numerator, self.numerator)

    @cached_property
    def hold(self) -> fmpq_poly:
        """−R + (1 + c) S as a polynomial in c."""
        alpha = self.part_delay
        n = fmpq_poly(list(self.numerator))
        shift = fmpq_poly([as_fmpq(1 - alpha), as_fmpq(alpha)])
        m = (n * shift).left_shift(self.whole_delay)
        lag = len(self.denominator) - 1
        r = (m * fmpq_poly(list(self.denominator[::-1]))).coeffs()
        return from_cosines(_dirichlet(r, lag))

    @cached_property
    def criterion(self) -> fmpz_poly:
        """q(c), times b where α > 0, times a positive integer: ≥ 0 on [−1, 1] if passive."""
        b, t, alpha = self.damping, self.period, self.part_delay
        if alpha == 0:
            return (as_fmpq(2 * b / t) * self.dissipation + self.hold).numer()
        return self.bounded_criterion(alpha * (1 - alpha))

    def bounded_criterion(self, share: Fraction) -> fmpz_poly:
        """b q(c), times a positive integer, with `share` in the place of α(1−α)."""
        b, t = self.damping, self.period
        damped = as_fmpq(2 * b * b / t) * self.dissipation + as_fmpq(b) * self.hold
        return (damped - as_fmpq(t * share / 2) * self.switching).numer()

    def required_damping_at(self, c: Fraction) -> float:
        """The damping that the criterion asks for at cos ωT = c, to rounding [N·s/m].

        ½ [A + √(A² + T² α(1−α) |H|²)],  A = (T/2) (R − (1 + c) S)/|D|².
        """
        values = self._values_at(c)
        return inf if values is None else self._required(*values)

    def required_dampings_at(self, cosines: Sequence[float]) -> list[float]:
        """`required_damping_at` each of many cosines, in a tenth of the time."""
        with precision(_PRECISIONS[0]):
            places = [arb(c) for c in cosines]
            scale = _over(self.dissipation, places)
            holds = _divided(_over(self.hold, places), scale)
            switchings: list[float | None] = [0.0] * len(places)
            if self.part_delay:
                switchings = _divided(_over(self.switching, places), scale)
        return [self._need(*found) for found in zip(cosines, holds, switchings, strict=True)]

    def _need(self, cosine: float, hold: float | None, switching: float | None) -> float:
        """From balls of few bits; where those were too wide, from more."""
        if hold is None or switching is None:
            return self.required_damping_at(Fraction(cosine))
        return self._required(hold, switching)

    def _required(self, hold: float, switching: float) -> float:
        """Of (−R + (1 + c) S)/|D|² and |N|²/|D|²."""
        base = -float(self.period) / 2 * hold
        alpha = float(self.part_delay)
        extra = float(self.period) ** 2 * alpha * (1 - alpha) * switching
        if extra == 0:
            return base
        root = (base * base + extra) ** 0.5
        return float((base + root) / 2 if base > 0 else extra / 2 / (root - base))

    def _values_at(self, c: Fraction) -> tuple[float, float] | None:
        """(−R + (1 + c) S)/|D|² and |N|²/|D|², to rounding; None where they are beyond doubles."""
        point = as_fmpq(c)
        parts = (self.hold, self.switching) if self.part_delay else (self.hold, fmpq_poly())
        for bits in _PRECISIONS:
            with precision(bits):
                scale = _in_balls(self.dissipation, point)
                values = [_in_balls(part, point) / scale for part in parts]
                if all(value.rel_accuracy_bits() > 60 for value in values):
                    return _finite(*(float(value) for value in values))
        below = self.dissipation(point)
        if below == 0:
            return None
        return _finite(*(_float(part(point) / below) for part in parts))


def _over(p: fmpq_poly, places: list[arb]) -> list[arb]:
    scale = arb(p.denom())
    return [value / scale for value in arb_poly(p.numer()).evaluate(places, algorithm="iter")]


def _divided(values: list[arb], scale: list[arb]) -> list[float | None]:
    """Value by value; None where the balls are too wide, or it is beyond doubles."""
    found = (value / by for value, by in zip(values, scale, strict=True))
    return [_finite_or_none(ball) for ball in found]


def _finite_or_none(ball: arb) -> float | None:
    value = float(ball) if ball.rel_accuracy_bits() > 60 else inf
    return value if isfinite(value) else None


def _in_balls(p: fmpq_poly, point: fmpq) -> arb:
    return p.numer()(arb(point)) / p.denom()


def _finite(hold: float, switching: float) -> tuple[float, float] | None:
    return (hold, switching) if isfinite(hold) and isfinite(switching) else None


def _float(value: fmpq) -> float:
    """The nearest double, infinite beyond the largest."""
    try:
        return float(as_fraction(value))
    except OverflowError:
        return inf


def linear_loop(device: Device, environment: Environment) -> LinearLoop:
    """The exact loop of a certain device and environment."""
    period = device.exact("sample_period")
    h = environment.pulse_transfer_function(period)
    return loop_from(h, device.exact("damping"), period, device.exact("delay"))


def loop_from(h: RationalFunction, damping: Fraction, period: Fraction, delay: Fraction) -> LinearLoop:
    """The exact loop of H(z), b [N·s/m], T [s] and a delay [s]."""
    numerator, denominator, decay = _coprime(h)
    whole = delay // period
    loop = LinearLoop(numerator, denominator, damping, period, int(whole), delay / period - whole, decay)
    if loop.degree > LARGEST_DEGREE:
        raise InputError(
            f"the order of the environment plus the delay in samples is {loop.degree}; at most "
            f"{LARGEST_DEGREE} can be certified: shorten the delay or lower the rate"
        )
    return loop


def _coprime(h: RationalFunction) -> tuple[tuple[int, ...], tuple[int, ...], bool]:
    """N and D as coprime integer polynomials in ζ, D(1) ≥ 0, and whether what was cancelled decays."""
    scale = _common_denominator(h)
    n = fmpz_poly([c.numerator * (scale // c.denominator) for c in reversed(h.numerator)])
    d = fmpz_poly([c.numerator * (scale // c.denominator) for c in reversed(h.denominator)])
    if d.degree() < 0:
        raise InputError("the denominator of H(z) is zero")
    if n.degree() > d.degree():
        raise InputError("H(z) has more zeros than poles: it would need samples that are still to come")
    common = n.gcd(d)
    decay = n.degree() < 0 or is_schur([int(c) for c in common.coeffs()])
    n, d = n // common, d // common
    size = d.degree() + 1
    top_down_n = [int(n[size - 1 - i]) for i in range(size)]
    top_down_d = [int(d[size - 1 - i]) for i in range(size)]
    sign = sum(top_down_d) or top_down_d[0]
    if sign < 0:
        top_down_n, top_down_d = [-c for c in top_down_n], [-c for c in top_down_d]
    while len(top_down_n) > 1 and top_down_n[-1] == 0:
        top_down_n.pop()
    while len(top_down_d) > 1 and top_down_d[-1] == 0:
        top_down_d.pop()
    return tuple(top_down_n), tuple(top_down_d), decay


def _common_denominator(h: RationalFunction) -> int:
    """What makes all coefficients whole, if none is too long then."""
    scale, longest, most = 1, 0, floor(LARGEST_DIGITS / log10(2))
    for c in (*h.numerator, *h.denominator):
        longest = max(longest, c.numerator.bit_length() - c.denominator.bit_length())
        scale = lcm(scale, c.denominator)
        if scale.bit_length() + max(longest, 0) > most:
            raise InputError(
                f"over a common denominator the coefficients of H(z) have more than {LARGEST_DIGITS} digits, "
                "and no more can be certified: give them with fewer digits"
            )
    return scale


def _dirichlet(r: list[fmpq], lag: int) -> list[fmpq]:
    """Cosine coefficients of Σ_{m≥1} r₋ₘ D_{m−1} − Σ_{j≥0} r_j D_j, D_j = 1 + 2 Σ_{i≤j} cos iθ.

    Since cot(θ/2) sin jθ + cos jθ = D_j for j ≥ 0 and −D_{|j|−1} for j < 0,
    this is −R + (1 + c) S without a division by sin θ.
    """
    ahead = max(len(r) - lag, 0)
    weights = [fmpq(0)] * (max(ahead, lag) + 1)
    for j in range(ahead):
        weights[j] -= r[lag + j]
    for m in range(1, lag + 1):
        if lag - m < len(r):
            weights[m - 1] += r[lag - m]
    total = fmpq(0)
    cosines = [fmpq(0)] * len(weights)
    for i in range(len(weights) - 1, -1, -1):
        total += weights[i]
        cosines[i] = 2 * total if i else total
    return cosines
