"""A device whose motor and hand move apart: the linear criterion, both sides joined by k and c.

With T = 1, ζ = z⁻¹ = e^{−jθ}, x = cos θ, λ = ω², D₁ = m s² + (b₁ + c) s + k, Z = k + c s
(docs/theory/transmission.md):

    n(λ) = b₂ |D₁|² + b₁ |Z|² + c λ |m s + b₁|² = n₂ (λ² + t λ + d)
    |1 + H (1 − ζ) C|² ≥ γ_a γ_q |H (1 − ζ)|²,    γ_a = Σ |Z|²/(2λn),   C = −Σ v(jω) e^{−jωα}/(2λn)

K with K² = t K − d stands for minus the roots of n, so that each sum is one of functions of K, entire ones of
its square root, over q(x) = det(cosh √K − x).  Times q |D|² the criterion is a polynomial,

    |D|² q − X h_d − Y h_{d+1} + |N|² (X² + Y² + 2xXY − G_a G_q)/(2 (1 − x) q),    C = (X + ζ Y)/(2 (1 − x) q)

of which the division leaves nothing: C and both γ are entries of one resolvent, with poles that are simple.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import acos, isqrt, perm, pi
from typing import NamedTuple

from ..document.fields import Choice, Number, OneOf, Read, Record, document, numbers
from ..document.number import DAMPING, MASS, STIFFNESS, about
from ..document.refusal import Invalid, spend
from ..exact.enclosed import Enclosed, known, quotient
from ..exact.positivity import POSITIVITY, require_nonnegative
from ..exact.roots import decay_in_powers, inside_unit_circle
from .linear import cosine_sums, require_coprime
from .loop import LOOP, Loop, in_whole_numbers, loop_of
from .violation import criterion_at

TRANSMISSION = Record(
    {
        "mass": Number(MASS, above=0),
        "stiffness": Number(STIFFNESS, above=0),
        "damping": Number(DAMPING, least=0),
        "handle_damping": Number(DAMPING, least=0),
        "encoder": Choice("motor", "handle"),
    },
    named=True,
)
ELASTIC = document(
    {
        "loop": LOOP,
        "transmission": TRANSMISSION,
        "proof": Record({"below": numbers(least=1), "positivity": POSITIVITY}, shown=False),
    }
)
ELASTIC_VIOLATION = document(
    {
        "loop": LOOP,
        "transmission": TRANSMISSION,
        "proof": OneOf(
            "kind",
            {
                "criterion": Record({"cosine": Number(least=-1, most=1)}),
                "negative static stiffness": Record({}),
                "unstable": Record({}),
            },
            shown=False,
        ),
    }
)

LARGEST_TURN = 600
"""Of √|K|."""
MOST_TERMS = 150
"""Coefficients of H(z) and samples of delay."""

Polynomial = list[Enclosed]
Pair = tuple[Enclosed, Enclosed]


class _Form(NamedTuple):
    """n(λ), 2λn γ_a, 2λn γ_q and v(s), ascending, with T = 1."""

    dissipated: tuple[Fraction, Fraction, Fraction]
    pulled: tuple[Fraction, Fraction, Fraction]
    read: tuple[Fraction, Fraction, Fraction]
    moved: tuple[Fraction, Fraction, Fraction, Fraction]


def elastic(told: Read) -> str:
    """The proof: a polynomial below the criterion that is ≥ 0, and stability."""
    p = _loop(told)
    if p.resolution or p.coulomb_friction:
        raise Invalid("a proof with a transmission is of an ideal encoder and of viscous friction alone")
    criterion = _criterion(p, told.transmission)
    below = [known(Fraction(c), criterion[0].bits) for c in told.proof.below]
    if len(below) > len(criterion):
        raise Invalid("the polynomial below the criterion has a higher degree than it")
    room = [x - y for x, y in zip(criterion, [*below, *[_zero(criterion)] * len(criterion)], strict=False)]
    if room[0].middle - room[0].reach < sum(abs(x.middle) + x.reach for x in room[1:]):
        raise Invalid("the polynomial is not below the criterion")
    require_nonnegative(told.proof.below, told.proof.positivity)
    if _held(p, told.transmission) is not True:
        raise Invalid("the loop is not shown to be stable with the hand's side held")
    if sum(p.numerator) * p.denominator[0] < 0:
        raise Invalid("the static stiffness at the hand is negative")
    return (
        "with its transmission the criterion is nonnegative at every frequency, and the loop is stable with "
        "the hand's side held"
    )


def elastic_violation(told: Read) -> str:
    """Confirm that a hand takes energy out, and say why.

    Without friction behind the motor n is b k² alone, and every sum is that of one mass with the motor's b.
    """
    given, proof = told.transmission, told.proof
    if proof.kind == "criterion" and given.encoder == "motor" and not given.damping + given.handle_damping:
        p = loop_of(told.loop)
        if not p.damping or criterion_at(p, proof.cosine) >= 0:
            raise Invalid(_NOT_VIOLATED)
        return _violated_at(p, proof.cosine)
    p = _loop(told)
    if proof.kind == "criterion":
        return _violated(p, told.transmission, proof.cosine)
    require_coprime(p)
    held = _held(p, told.transmission)
    if proof.kind == "unstable":
        if held is not False:
            raise Invalid("the loop is not shown to be unstable with the hand's side held")
        return "with the hand's side held the loop is unstable"
    if held is not True or sum(p.numerator) * p.denominator[0] >= 0:
        raise Invalid("the static stiffness is not shown to be negative")
    return "the static stiffness at the hand is negative"


def _violated(p: Loop, told: Read, cosine: Fraction) -> str:
    criterion = _criterion(p, told)
    x, total = known(cosine, criterion[0].bits), _zero(criterion)
    for c in reversed(criterion):
        total = total * x + c
    if total.sign != -1:
        raise Invalid(_NOT_VIOLATED)
    return _violated_at(p, cosine)


_NOT_VIOLATED = "the criterion is not violated at this frequency"


def _violated_at(p: Loop, cosine: Fraction) -> str:
    hertz = Fraction(acos(cosine) / (2 * pi)) / p.period
    return f"with its transmission the criterion is violated at {about(hertz)} Hz"


def _loop(told: Read) -> Loop:
    p = loop_of(told.loop)
    if len(p.denominator) + p.whole > MOST_TERMS:
        raise Invalid("too many coefficients and samples of delay")
    given = told.transmission
    if not (p.damping + given.handle_damping and given.damping + given.handle_damping):
        raise Invalid("friction on the hand's side or inside, and one that moves with both, is needed")
    return p


def _form(p: Loop, told: Read) -> _Form:
    t, k = p.period, told.stiffness
    m, b, c, h = told.mass / t**2, p.damping / t, told.damping / t, told.handle_damping / t
    drag, square = b + c, (told.damping / t) ** 2
    dissipated = ((b + h) * k * k, h * (drag * drag - 2 * k * m) + b * c * drag, (h + c) * m * m)
    pulled = (k * k, square, Fraction(0))
    if told.encoder == "handle":
        read = (k * k, drag * drag - 2 * k * m, m * m)
        return _Form(dissipated, pulled, read, (k * k, -k * b, m * k - c * drag, m * c))
    return _Form(dissipated, pulled, pulled, (k * k, 2 * k * h, square - 2 * drag * (h + c), 2 * m * (h + c)))


def _criterion(p: Loop, told: Read) -> Polynomial:
    """Times q |D|², ascending in x."""
    form = _form(p, told)
    n0, n1, n2 = form.dissipated
    trace, product = n1 / n2, n0 / n2
    sums = _Roots(trace, product, _bits(abs(trace) + Fraction(isqrt(int(product)) + 1), p))
    at, late = sums.at, p.part
    (whole, rise), *waves = sums.waves(late, 2)
    q = sums.form(whole)
    fall: Polynomial = [at(Fraction(2)), at(Fraction(-2))]

    def over(top: Sequence[Fraction]) -> Polynomial:
        """2(1 − x) q Σ top(λ)/(2λn)."""
        rest = _rest(form.dissipated, top)
        more = _product(fall, sums.rest(rest, rise, whole, 4 * n2))
        return _plus(_scaled(q, at(top[0] / n0 / 2)), more)

    v = form.moved
    even, odd = (
        _rest(form.dissipated, (v[0], -v[2], Fraction(0))),
        _rest(form.dissipated, (v[1], -v[3], Fraction(0))),
    )
    early_rest, late_rest = (
        (sums.rest(even, rise, whole, -4 * n2), sums.rest(odd, stay, whole, -4 * n2)) for stay, rise in waves
    )
    still, swing = v[0] / n0 / 2, v[1] / n0 / 2
    x = _plus(_scaled(q, at(-still * (1 - late) - swing)), _product(fall, _plus(*early_rest)))
    y = _plus(
        _scaled(q, at(-still * late + swing)),
        _product(fall, _plus(late_rest[0], _scaled(late_rest[1], at(Fraction(-1))))),
    )
    squares = _plus(
        _plus(_product(x, x), _product(y, y)), _product([at(Fraction(0)), at(Fraction(2))], _product(x, y))
    )
    lost = _scaled(_product(over(form.pulled), over(form.read)), at(Fraction(-1)))
    echo = _divided(_plus(squares, lost), _product(fall, q))
    law, now, switched = cosine_sums(p._replace(part=Fraction(0)))
    after = cosine_sums(p._replace(part=Fraction(0), whole=p.whole + 1))[1]
    loss, now_heard, late_heard, size = (
        [at(Fraction(c)) for c in one] for one in (law, now, after, switched)
    )
    heard = _plus(_product(now_heard, x), _product(late_heard, y))
    return _plus(_plus(_product(loss, q), _product(size, echo)), [-c for c in heard])


def _rest(form: Sequence[Fraction], top: Sequence[Fraction]) -> tuple[Fraction, Fraction]:
    """u of top(λ)/(λ n) = top₀/(n₀ λ) + (u₀ + u₁ λ)/n."""
    share = top[0] / form[0]
    return top[1] - share * form[1], top[2] - share * form[2]


def _bits(size: Fraction, p: Loop) -> int:
    """So many that what cosh √K and a force of whole numbers lose is made up for."""
    turn = isqrt(int(size)) + 1
    if turn > LARGEST_TURN:
        raise Invalid("the transmission is too stiff for this sample period")
    numbers = (*in_whole_numbers(p.numerator, p), *in_whole_numbers(p.denominator, p))
    longest = max(abs(c).bit_length() for c in numbers)
    bits = 256 + 6 * turn + 2 * longest + 8 * len(numbers)
    spend(60 * (len(numbers) + p.whole + 20 + turn), bits)
    return bits


class _Roots:
    """Functions of K with K² = t K − d, as a + b K; and Σ over n made of them."""

    def __init__(self, trace: Fraction, product: Fraction, bits: int) -> None:
        self.bits, self.exact = bits, (trace, product)
        self.trace, self.product = self.at(trace), self.at(product)

    def at(self, value: Fraction) -> Enclosed:
        return known(value, self.bits)

    def waves(self, part: Fraction, step: int) -> list[tuple[Pair, Pair]]:
        """Over a sample, over what is left of it after a part, and over the part."""
        times = Fraction(1), 1 - part, part
        found = {time: self._wave(time, step) for time in set(times)}
        return [found[time] for time in times]

    def _wave(self, time: Fraction, step: int) -> tuple[Pair, Pair]:
        """Σ_j K^j t^n/n! and Σ_j K^j t^(n+1)/(n+1)!, n = j step: exp and its integral; or cosh √K t and
        sinh(√K t)/√K.

        In whole numbers, as a + b K/σ, σ² near d; no sum has lost more than `off`.  Once a term is small and
        the next ones halve, all that is left is no more than it.
        """
        bits, (trace, product) = self.bits, self.exact
        sigma = Fraction(2) ** (isqrt(max(int(product), 1)).bit_length() - 1)
        down, up, on = (self.at(x * time**step).middle for x in (product / sigma, sigma, trace))
        norm = max(abs(down), abs(up) + abs(on)) + 2
        a, b, n, off, r = 1 << bits, 0, 0, 8, 0
        sums = [0, 0, 0, 0]
        while True:
            sums = [x + y for x, y in zip(sums, (a, b, a // (n + 1), b // (n + 1)), strict=True)]
            factor, off = perm(n + step, step) << bits, off + r + 1
            if max(abs(a), abs(b)) + r <= 4 and 2 * norm <= factor:
                break
            r = (norm * r + abs(a) + abs(b)) // factor + 2
            a, b, n = -down * b // factor, (up * a + on * b) // factor, n + step
        even, tilted, risen, leaning = (
            Enclosed(bits, x, (), off) * self.at(y)
            for x, y in zip(sums, (Fraction(1), 1 / sigma, time, time / sigma), strict=True)
        )
        return (even, tilted), (risen, leaning)

    def form(self, wave: Pair) -> Polynomial:
        """det(wave − x)."""
        a, b = wave
        tilt = self.trace * b
        return [a * a + a * tilt + self.product * (b * b), -(a.times(2) + tilt), self.at(Fraction(1))]

    def rest(self, top: tuple[Fraction, Fraction], wave: Pair, whole: Pair, over: Fraction) -> Polynomial:
        """q Σ (u₀ + u₁ λ)/n of the wave in the place of 2 n₂ Σ 1/(λ + K), times 2 n₂/over."""
        a, b = whole
        u, w, (f, g) = self.at(top[0] / over), self.at(top[1] / over), wave
        tilted = self.product * b + self.trace * a
        return [u * (f * b - g * a) + w * (f * a + g * tilted), u * g - w * (f + self.trace * g)]


def _held(p: Loop, told: Read) -> bool | None:
    """Whether all decays while the hand's side is held; None where that is open."""
    if told.encoder == "handle":
        return inside_unit_circle(p.denominator)
    t = p.period
    m, k, drag = told.mass / t**2, told.stiffness, (p.damping + told.damping) / t
    trace, product = -drag / m, k / m
    it = _Roots(trace, product, _bits((abs(trace) + 3 * isqrt(int(product)) + 3) ** 2, p))
    at, fall, spring = it.at, it.trace, it.product

    def forced(wave: Pair) -> Pair:
        """Position and speed after a force of 1 held so long."""
        a, b = wave
        return b * at(1 / m), (a + fall * b) * at(1 / m)

    def moved(wave: Pair, state: Pair) -> Pair:
        """A while later."""
        (a, b), (x, v) = wave, state
        return a * x + b * v, (a + fall * b) * v - spring * b * x

    (whole, _), (early, held), (_, late) = it.waves(p.part, 1)
    now, before = forced(held), moved(early, forced(late))
    swing, speeded, kept = it.form(whole)[::-1], whole[1], whole[0] + fall * whole[1]
    heard = [
        at(Fraction(0)),
        now[0],
        speeded * now[1] - kept * now[0] + before[0],
        speeded * before[1] - kept * before[0],
    ]
    n, d = (([at(Fraction(c)) for c in in_whole_numbers(part, p)]) for part in (p.numerator, p.denominator))
    closed = _plus(_product(d, swing), _product([at(Fraction(0))] * p.whole + n, heard))
    closed = closed if d[0].middle > 0 else [-c for c in closed]
    at_one = sum(closed, at(Fraction(0))).sign
    if at_one != 1:  # a root at z = 1 or beyond; or that is open
        return None if at_one is None else False
    return decay_in_powers(closed)


def _zero(like: Polynomial) -> Enclosed:
    return Enclosed(like[0].bits, 0)


def _plus(a: Polynomial, b: Polynomial) -> Polynomial:
    size = max(len(a), len(b))
    a, b = ([*p, *[_zero(p)] * (size - len(p))] for p in (a, b))
    return [x + y for x, y in zip(a, b, strict=True)]


def _scaled(a: Polynomial, by: Enclosed) -> Polynomial:
    return [x * by for x in a]


def _product(a: Polynomial, b: Polynomial) -> Polynomial:
    out = [_zero(a)] * (len(a) + len(b) - 1)
    for i, x in enumerate(a):
        for j, y in enumerate(b):
            out[i + j] = out[i + j] + x * y
    return out


def _divided(top: Polynomial, bottom: Polynomial) -> Polynomial:
    """top/bottom, from the lowest power on; refused where it certainly leaves something."""
    found: Polynomial = []
    for i, rest in enumerate(top):
        for j, x in enumerate(found):
            if i - j < len(bottom):
                rest = rest - x * bottom[i - j]
        if i <= len(top) - len(bottom):
            found.append(_quotient(rest, bottom[0]))
        elif rest.sign:
            raise Invalid("the criterion is no polynomial")
    return found


def _quotient(x: Enclosed, y: Enclosed) -> Enclosed:
    """x/y of y that is certainly not 0."""
    least = abs(y.middle) - y.reach
    if least <= 0:
        raise Invalid("the transmission is too soft for this sample period")
    value = quotient(x.middle, y.middle, x.bits)
    off = x.reach + (abs(value.middle) + 1) * y.reach // (1 << x.bits) + 1
    return Enclosed(x.bits, value.middle, (), value.radius + (off << x.bits) // least + 1)
