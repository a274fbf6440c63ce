"""The linear criterion of a device whose motor and hand move apart, on a cable, a belt or a gear.

A motor (m, b₁) and the hand's side (b₂; its mass plays no part) are joined by k and c; D₁ = m s² + (b₁ + c) s
+ k, Z = k + c s, λ = ω².  A hand moves its side as it likes, and of every motion with the frequencies
ω_n = (θ + 2πn)/T it pays ½ Σ |v_n|² n(λ_n)/|D₁|²,

    n(λ) = b₂ |D₁|² + b₁ |Z|² + c λ |m s + b₁|² = n₀ + n₁ λ + n₂ λ² .

The held force sees one number of all these, the sampled position, so what it gives back is a form of rank
two, and the loop is passive exactly if it is stable with the hand's side held, its static stiffness is
≥ 0 and, at every θ of (0, π], with w = (1 − z⁻¹)/T and a delay of α samples beside whole ones,

    |1 + H w C|² ≥ γ_a γ_q |H w|²
    γ_a = Σ |Z|²/(2 λ n),   γ_q = γ_a,   C = −Σ W e^{−jω_n αT}/λ,   W = v(s)/(2n)        encoder at the motor
    v = k² + 2 k b₂ s + (c² − 2 (b₁ + c)(b₂ + c)) s² + 2 m (b₂ + c) s³
    γ_q = Σ |D₁|²/(2 λ n),   v = Z D₁(−s)                                                encoder at the hand

With one mass C = −γ, and this is the criterion of Colgate & Schenkel.  Each sum is one over the roots −a² of
n and over λ = 0, hyperbolic in a T and rational in z, so that the criterion times q = Π (cosh aT − cos θ) and
|D|² is a polynomial in cos θ.  The derivation is in the documentation.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from math import cos, inf, pi

from flint import acb, arb, arb_poly, fmpz_poly

from zwidth.passivity.linear.exact_algebra import decays_in_balls, is_schur
from zwidth.passivity.linear.loop import LinearLoop
from zwidth.passivity.linear.positivity import Positivity, TooClose, prove_nonnegative
from zwidth.quantity.balls import ball, middle, precision

_BITS = 320
"""Of the balls, beside those that cosh aT takes."""

_ROOM = 90
"""Bits below its largest coefficient at which the polynomial that is proved lies under the criterion."""

_APART = 100
"""Bits below two roots by which equal ones are taken apart: what is claimed is decided by the checker."""

LARGEST_TURN = 400
"""|a| T up to which a criterion is written down: far more than any cable asks for at its rate."""


@dataclass(frozen=True)
class Elastic:
    """What stands between motor and hand, exact; `loop` has the friction of the motor's side."""

    loop: LinearLoop
    # m of the motor's side [kg; kg·m²]
    mass: Fraction
    # k [N/m; N·m/rad] and c [N·s/m; N·m·s/rad] between the two, b₂ of the hand's side
    stiffness: Fraction
    damping: Fraction
    handle_damping: Fraction
    at_handle: bool

    @cached_property
    def _forms(self) -> tuple[tuple[Fraction, ...], tuple[Fraction, ...], tuple[Fraction, ...]]:
        """n(λ), 2λnγ_q and v(s), ascending, with T = 1."""
        t, k = self.loop.period, self.stiffness
        m, b, c, h = self.mass / t**2, self.loop.damping / t, self.damping / t, self.handle_damping / t
        dissipated = (
            (b + h) * k * k,
            h * ((b + c) ** 2 - 2 * k * m) + b * c * c + c * b * b,
            (h + c) * m * m,
        )
        if self.at_handle:
            read = (k * k, (b + c) ** 2 - 2 * k * m, m * m)
            return dissipated, read, (k * k, -k * b, m * k - c * (b + c), m * c)
        moved = (k * k, 2 * k * h, c * c - 2 * (b + c) * (h + c), 2 * m * (h + c))
        return dissipated, (k * k, c * c, Fraction(0)), moved

    @property
    def _pulled(self) -> tuple[Fraction, ...]:
        """2λnγ_a = |Z|²."""
        return self.stiffness**2, (self.damping / self.loop.period) ** 2, Fraction(0)

    @property
    def turn(self) -> float:
        """The larger |a| T of the roots −a² of n."""
        n0, n1, n2 = (float(x) for x in self._forms[0])
        half, root = n1 / n2 / 2, complex(n1 * n1 / n2 / n2 / 4 - n0 / n2) ** 0.5
        return float(max(abs(half + root), abs(half - root)) ** 0.5)

    @property
    def bits(self) -> int:
        """Of a ball that holds the criterion well."""
        return _BITS + 8 * int(self.turn) + 8 * self.loop.degree

    def value(self, cosine: Fraction) -> arb:
        """The criterion times q |D|² at cos θ."""
        far, radius, scale = self._circle(cosine)
        return (far - radius) * scale

    def distance(self, cosine: Fraction) -> float:
        """|1 + H w C| over √(γ_a γ_q) |H w| at cos θ, to rounding: ≥ 1 where the criterion holds."""
        with precision(self.bits):
            far, radius, _ = self._circle(cosine)
            return float((far / radius).sqrt()) if radius > 0 else inf

    def _circle(self, cosine: Fraction) -> tuple[arb, arb, arb]:
        """|1 + H w C|² and γ_a γ_q |H w|², times |D|², and q."""
        loop = self.loop
        x, z, squared, force, scale = self.sums(cosine)
        force *= _at(loop.numerator, z) * z**loop.whole_delay * (1 - z)
        law, law_size = _at(loop.denominator, z), (1 - x) * 2 * _size(_at(loop.numerator, z))
        return _size(law + force), squared * law_size, scale

    def sums(self, cosine: Fraction) -> tuple[arb, acb, arb, acb, arb]:
        """cos θ, z⁻¹, γ_a γ_q, C and q: on no law do they depend, but for its part of a delay."""
        forms, loop = self._forms, self.loop
        x = ball(cosine)
        z = acb(x, -(1 - x * x).sqrt())
        sums = _Sums(forms[0], x, z)
        moved = [ball(f) for f in forms[2]]
        pulled, read = (
            sums.over([ball(f) for f in form], arb(0), False).real / 2 for form in (self._pulled, forms[1])
        )
        delay = ball(loop.part_delay)
        even = sums.over([moved[0], -moved[2], arb(0)], delay, False)
        odd = sums.over([moved[1], -moved[3], arb(0)], delay, True)
        return x, z, pulled * read, -(even + odd) / 2, sums.scale

    @property
    def degree(self) -> int:
        """Of the criterion as a polynomial in cos θ, at most."""
        loop = self.loop
        return max(len(loop.denominator), len(loop.numerator) + loop.whole_delay + 1) + 1

    @cached_property
    def polynomial(self) -> tuple[fmpz_poly, int]:
        """A whole polynomial p with p 2^−shift a hair below the criterion on [−1, 1].

        Without friction behind the motor it is that of one mass.
        """
        if not self.damping + self.handle_damping:
            return self.loop.criterion, 0
        return _below(self.value, self.degree, self.bits)

    @cached_property
    def held(self) -> bool | None:
        """Whether the loop is stable with the hand's side held; None where that is too close to tell."""
        loop = self.loop
        if self.at_handle:
            return is_schur(loop.denominator[::-1])
        with precision(self.bits):
            swings = self._swing()
            law = arb_poly([arb(c) for c in loop.denominator])
            force = arb_poly([arb(0)] * loop.whole_delay + [arb(c) for c in loop.numerator])
            closed = law * arb_poly(swings[0]) + force * arb_poly(swings[1])
            size = max(len(loop.denominator) + 2, len(loop.numerator) + loop.whole_delay + 3)
            return decays_in_balls(arb_poly([closed[i] for i in reversed(range(size))]))

    def _swing(self) -> tuple[list[arb], list[arb]]:
        """det(z − Φ) z⁻² and the motor's position after its held force, ascending in z⁻¹."""
        t, part = self.loop.period, self.loop.part_delay
        mass, drag = self.mass / t**2, (self.loop.damping + self.damping) / t
        m, k, half = ball(mass), ball(self.stiffness), ball(drag / mass / 2)
        root = _half_apart(drag / mass / 2, self.stiffness / mass)

        def moved(time: arb) -> tuple[arb, arb, arb, arb]:
            """φ₁₂, φ₂₂ and the position and speed after a force of 1 held so long."""
            fall, swing = (-half * time).exp(), (root * time)
            rise = (swing.sinh() / root).real * fall
            stay = swing.cosh().real * fall
            return rise, stay - half * rise, (1 - stay - half * rise) / k, rise / m

        after, whole, late = moved(ball(1 - part)), moved(arb(1)), moved(ball(part))
        rise, hold = whole[0], whole[1]
        fall = (-2 * half).exp()
        trace = 2 * (hold + half * rise)
        now = (after[2], after[3])
        first = hold_after = after[0], after[1]  # φ₁₂, φ₂₂ over what is left of the sample
        stays = hold_after[1] + 2 * half * first[0]  # φ₁₁
        before = (stays * late[2] + first[0] * late[3], -(k / m) * first[0] * late[2] + first[1] * late[3])
        return (
            [arb(1), -trace, fall],
            [arb(0), now[0], rise * now[1] - hold * now[0] + before[0], rise * before[1] - hold * before[0]],
        )


class _Sums:
    """Σ over n of what is rational in λ, at one θ, T = 1."""

    def __init__(self, form: Sequence[Fraction], x: arb, z: acb) -> None:
        self.form, self.x, self.z = [ball(f) for f in form], x, z
        half = form[1] / form[2] / 2
        root = _half_apart(half, form[0] / form[2])
        self.squares = ball(half) + root, ball(half) - root
        self.roots = [square.sqrt() for square in self.squares]
        self.falls = [a.cosh() - x for a in self.roots]
        top = self.falls[0] * self.falls[1]
        self.scale = top.real

    def over(self, top: list[arb], delay: arb, odd: bool) -> acb:
        """Σ (jω)^odd top(λ)/(λ n(λ)) e^{−jω delay}."""
        n0, n1, n2 = self.form
        x, z = self.x, self.z
        rest = top[1] - top[0] * n1 / n0, top[2] - top[0] * n2 / n0
        still = (1 - z if odd else (1 - delay) + delay * z) / (2 * (1 - x))
        total = top[0] / n0 * still
        for a, square, other, fall in zip(
            self.roots, self.squares, self.squares[::-1], self.falls, strict=True
        ):
            share = (rest[0] - rest[1] * square) / (n2 * (other - square))
            early, late = a * (1 - delay), a * delay
            wave = early.cosh() - z * late.cosh() if odd else (early.sinh() + z * late.sinh()) / a
            total += share * wave / (2 * fall)
        return total


def _half_apart(half: Fraction, product: Fraction) -> acb:
    """√(half² − product) of two roots; of equal ones so little that nothing changes by it."""
    found, least = acb(ball(half**2 - product)).sqrt(), abs(ball(half)) * arb(2) ** -_APART
    return found if found.abs_lower() > least else acb(least)


def _at(coefficients: tuple[int, ...], z: acb) -> acb:
    total = acb(0)
    for c in reversed(coefficients):
        total = total * z + c
    return total


def _size(value: acb) -> arb:
    return value.real * value.real + value.imag * value.imag


def _times_power(value: Fraction, shift: int) -> int:
    return round(value * (1 << shift)) if shift >= 0 else round(value / (1 << -shift))


def _below(value: Callable[[Fraction], arb], degree: int, bits: int) -> tuple[fmpz_poly, int]:
    """The polynomial in cos θ with these values, a hair lower, its coefficients whole times 2^−shift."""
    count = degree + 1
    places = [Fraction(round(2**40 * cos(pi * (i + 0.5) / count)), 2**40) for i in range(count)]
    with precision(bits):
        values = [value(place) for place in places]
        found = arb_poly.interpolate([ball(place) for place in places], values)
        coefficients = [middle(found[i]) for i in range(count)]
        largest = max(map(abs, coefficients))
        if not largest:
            return fmpz_poly([0]), 0
        shift = 2 * _ROOM - (abs(largest.numerator).bit_length() - largest.denominator.bit_length())
        whole = [_times_power(c, shift) for c in coefficients]
    whole[0] -= 1 << _ROOM
    return fmpz_poly(whole), shift


def holds_between(low: Elastic, half: Elastic, high: Elastic) -> bool:
    """Whether what is proved of two walls is proved of all between; they differ in K alone, `half` is midway.

    The criterion q is quadratic in K, and ≥ 0 between if 2 q(half) − (q(low) + q(high))/2, its middle
    coefficient in Bernstein's form, is ≥ 0 too.  Then no pole gets to the unit circle, where q < 0.
    """
    three = low, half, high
    if len({tuple(Fraction(c, e.loop.denominator[0]) for c in e.loop.denominator) for e in three}) > 1:
        return False

    def value(cosine: Fraction) -> arb:
        first, midway, last = (e.value(cosine) / e.loop.denominator[0] ** 2 for e in three)
        return 2 * midway - (first + last) / 2

    degree, bits = (max(getattr(e, name) for e in three) for name in ("degree", "bits"))
    try:
        return not isinstance(prove_nonnegative(_below(value, degree, bits)[0]), Fraction)
    except TooClose:
        return False


@dataclass(frozen=True)
class ElasticProof:
    """The polynomial that lies below the criterion, ascending in cos θ, and that it is ≥ 0."""

    below: tuple[Fraction, ...]
    positivity: Positivity


@dataclass(frozen=True)
class ElasticRefutation:
    """Why there is none.

    "criterion": it is < 0 at this cosine; "unstable": while the hand's side is held; "negative static
    stiffness"; or "too close to zero" to tell.
    """

    reason: str
    cosine: Fraction | None = None


@lru_cache(maxsize=256)
def decide_elastic(elastic: Elastic) -> ElasticProof | ElasticRefutation:
    """Decide the criterion, stability and static stiffness."""
    loop = elastic.loop
    polynomial, shift = elastic.polynomial
    try:
        sign = prove_nonnegative(polynomial)
    except TooClose:
        return ElasticRefutation("too close to zero")
    if isinstance(sign, Fraction):
        with precision(elastic.bits):
            below = elastic.value(sign) < 0
        return ElasticRefutation("criterion", sign) if below else ElasticRefutation("too close to zero")
    if not elastic.held:
        return ElasticRefutation("too close to zero" if elastic.held is None else "unstable")
    # k H/(k + H) at rest: what is stable has k D(1) + N(1) of the sign of D's first coefficient
    if sum(loop.numerator) * loop.denominator[0] < 0:
        return ElasticRefutation("negative static stiffness")
    scale = Fraction(2) ** -shift
    return ElasticProof(tuple(Fraction(int(c)) * scale for c in polynomial.coeffs()), sign)
