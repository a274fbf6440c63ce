"""A one-port F = N/D with Re F ≥ σ in the right half plane or outside the circle: proved or refuted.

Continuous ports are taken as they are: even and odd parts at s = jω for the sign, Routh's
table for the roots.  A motion is run from rest and what it takes out is summed.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from math import comb, lcm, pi
from typing import Any, NamedTuple

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
from ..loop.proofs import _hurwitz, _inside_unit_circle, _multiply, _positivity, _square_modulus, _sum

MOST_ORDER = 400
MOST_POWER = 400
MOST_WORK = 40_000_000
MOST_LINES = 2_000_000_000
MOST_TERMS = 1_000_000_000
MOST_BITS_OF_TIME = 400  # high powers of frequencies and durations are taken


class _Port(NamedTuple):
    numerator: list[Fraction]  # of F, ascending in s or z
    denominator: list[Fraction]
    continuous: bool
    level: Fraction
    order: int


def _read(document: Mapping[str, Any]) -> _Port:
    """F is G for the input index and 1/G for the output index."""
    system, time, which = system_of(document)
    n, d = (_trimmed(numbers(get(system, key))) for key in ("numerator", "denominator"))
    if not d:
        raise Invalid("the denominator is zero")
    if time == "discrete" and len(n) > len(d):
        raise Invalid("G(z) has more zeros than poles")
    if which == "output":
        n, d = d, n
    if not d:
        raise Invalid("G is zero and has no inverse")
    common_scale((*n, *d))
    order = max(len(n), len(d)) - 1
    if order > MOST_ORDER:
        raise Invalid(f"the order is {order}, more than {MOST_ORDER}")
    return _Port(n, d, time == "continuous", number(get(document, "level")), order)


def system_of(document: Mapping[str, Any]) -> tuple[Any, str, str]:
    """The system, its time and which index is meant."""
    system = get(document, "system")
    time, which = get(system, "time"), get(document, "index")
    if time not in ("continuous", "discrete") or which not in ("input", "output"):
        raise Invalid("the time must be continuous or discrete, the index input or output")
    return system, time, which


def _trimmed(descending: list[Fraction]) -> list[Fraction]:
    """In ascending powers, without zeros in front."""
    start = next((i for i, c in enumerate(descending) if c), len(descending))
    return descending[start:][::-1]


def positive_real(document: Mapping[str, Any]) -> str:
    """Re(N D̄) ≥ σ |D|² on the boundary, and N + (g − σ) D has its roots inside, g > 0."""
    p, proof = _read(document), get(document, "proof")
    offset = number(get(proof, "offset"))
    if offset <= 0:
        raise Invalid("the offset must be positive")
    excess = _combined(p, -p.level)
    _positivity(get(proof, "positivity"), _on_axis(excess, p) if p.continuous else _on_circle(excess, p))
    total = _combined(p, offset - p.level)
    descending = [*[Fraction(0)] * (p.order + 1 - len(total)), *total[::-1]]
    inside = _in_left_half_plane(descending) if p.continuous else _inside(descending)
    if not inside:
        raise Invalid("the port is not positive real: a root lies outside")
    return f"the {get(document, 'index')} index is at least {float(p.level):g}"


def _combined(p: _Port, share: Fraction) -> list[Fraction]:
    return (
        _sum(p.numerator, [share * c for c in p.denominator])
        if p.numerator
        else [share * c for c in p.denominator]
    )


def _inside(descending: list[Fraction]) -> bool:
    return descending[0] != 0 and _inside_unit_circle(descending)


def _in_left_half_plane(descending: list[Fraction]) -> bool:
    scale = lcm(*(c.denominator for c in descending))
    return _hurwitz([int(c * scale) for c in descending])


def _on_circle(m: list[Fraction], p: _Port) -> list[Fraction]:
    """Re(M D̄) = ¼ (|M + D|² − |M − D|²), in c = cos θ."""
    scale = lcm(*(c.denominator for c in (*m, *p.denominator)))
    plus, minus = ([int(c * scale) for c in _sum(m, [sign * c for c in p.denominator])] for sign in (1, -1))
    sums = (_square_modulus(side, p.order) for side in (plus, minus))
    return [Fraction(a - b) for a, b in zip(*sums, strict=True)]


def _on_axis(m: list[Fraction], p: _Port) -> list[Fraction]:
    """Re(M D̄) in x = ω², and x = (1 − c)/(1 + c), times (1 + c)ⁿ."""
    parts = [(_part(side, 0), _part(side, 1)) for side in (m, p.denominator)]
    even = _multiply(parts[0][0], parts[1][0])
    odd = [Fraction(0), *_multiply(parts[0][1], parts[1][1])]
    total = [Fraction(0)] * (p.order + 1)
    for power, c in enumerate(_sum(even, odd)):
        if c:
            factor = _multiply(_binomial(power, -1), _binomial(p.order - power, 1))
            total = _sum(total, [c * f for f in factor])
    return total


def _part(ascending: Sequence[Fraction], parity: int) -> list[Fraction]:
    """The even or odd part at s = jω, over (jω)^parity, in x = ω²."""
    return [c if i % 2 == 0 else -c for i, c in enumerate(ascending[parity::2])] or [Fraction(0)]


def _binomial(power: int, sign: int) -> list[Fraction]:
    """(1 ± c)ⁿ."""
    return [Fraction(sign**k * comb(power, k)) for k in range(power + 1)]


def extraction(document: Mapping[str, Any]) -> tuple[str, Fraction]:
    """What a motion from rest takes out above the level; it must be more than nothing."""
    p, motion = _read(document), get(document, "motion")
    weights = {
        "burst": lambda: _burst(p, motion) * Fraction(pi),  # the sign is that of the exact factor of π
        "polynomial": lambda: _polynomial(p, motion),
        "sequence": lambda: _sequence(p, numbers(get(motion, "latent"), MOST_SAMPLES)),
    }
    return taken_out(document, weights, p.continuous, p.level)


def taken_out(
    document: Mapping[str, Any],
    weights: Mapping[str, Callable[[], Fraction]],
    continuous: bool,
    level: Fraction,
) -> tuple[str, Fraction]:
    """What the motion of a document takes out; `weights` says of each kind of motion what it puts in."""
    kind = get(get(document, "motion"), "kind")
    if kind not in (("burst", "polynomial") if continuous else ("sequence",)):
        raise Invalid(f"no {str(kind)[:20]!r} motion in this time")
    absorbed = weights[kind]()
    if absorbed >= 0:
        raise Invalid(f"the motion takes out {float(-absorbed):g}: none comes out")
    return f"the {get(document, 'index')} index is less than {float(level):g}", -absorbed


def _burst(p: _Port, motion: Mapping[str, Any]) -> Fraction:
    """W/π of φ = (1 − cos Ωt)ᵏ cos mΩt over one period, by its lines at (m + j)Ω."""
    step = _short(number(get(motion, "step_rad_per_s")))
    cycles, power = integer(get(motion, "cycles")), integer(get(motion, "power"))
    if step <= 0 or cycles <= power or power > MOST_POWER:
        raise Invalid("a burst needs Ω > 0 and more cycles than its power")
    if 2 * power < p.order:
        raise Invalid("the burst is not smooth enough to begin and end at rest")
    bounded_lines(p.order, (cycles + power) * step, power)
    total = Fraction(0)
    for j in range(-power, power + 1):
        omega = (cycles + j) * step
        values = [
            (_horner(_part(side, 0), omega**2), omega * _horner(_part(side, 1), omega**2))
            for side in (p.numerator, p.denominator)
        ]
        (a, b), (c, d) = values
        total += Fraction(comb(2 * power, power + j), 2**power) ** 2 * (
            a * c + b * d - p.level * (c * c + d * d)
        )
    return total / step


def bounded_lines(order: int, highest: Fraction, power: int, entries: int = 1) -> None:
    """A burst has 2k + 1 lines; powers of the frequency of each are taken, for every entry of a matrix."""
    bits = 16 + _bits(_short(highest))
    if entries * (2 * power + 1) * (order + 1) ** 2 * bits > MOST_LINES:
        raise Invalid("the burst has too many lines for so large a port")


def bounded_terms(order: int, tau: Fraction, terms: int, entries: int = 1) -> None:
    """A polynomial of so many terms, powers of τ in each, is differentiated for every entry of a matrix."""
    if entries * (order + 1) * terms**2 * _bits(tau) > MOST_TERMS:
        raise Invalid("the polynomial has too many terms for so large a port")


def _bits(value: Fraction) -> int:
    return value.numerator.bit_length() + value.denominator.bit_length()


def _short(value: Fraction) -> Fraction:
    if max(value.numerator.bit_length(), value.denominator.bit_length()) > MOST_BITS_OF_TIME:
        raise Invalid("a frequency or a duration has too many digits")
    return value


def _horner(ascending: Sequence[Fraction | int], x: Fraction) -> Fraction:
    total = Fraction(0)
    for c in reversed(ascending):
        total = total * x + c
    return total


def _polynomial(p: _Port, motion: Mapping[str, Any]) -> Fraction:
    """∫ u y − σ u² over 0 … τ with u = D φ, y = N φ, φ a polynomial of t/τ that begins with power ≥ n."""
    tau, lowest = _short(number(get(motion, "duration_s"))), integer(get(motion, "lowest_power"))
    if tau <= 0 or lowest < p.order or lowest > MOST_COEFFICIENTS:
        raise Invalid("the polynomial must last and begin at rest")
    a = numbers(get(motion, "coefficients"), 200)
    bounded_terms(p.order, tau, lowest + len(a))
    phi = [c / tau**k for k, c in enumerate([*[Fraction(0)] * lowest, *a])]
    u, y = (_operated(side, phi) for side in (p.denominator, p.numerator))
    integrand = _multiply(u, _sum(y, [-p.level * c for c in u]))
    return sum((c * tau ** (k + 1) / (k + 1) for k, c in enumerate(integrand)), Fraction(0))


def _operated(side: Sequence[Fraction], phi: list[Fraction]) -> list[Fraction]:
    """Σ c_i dⁱφ/dtⁱ, by Horner's rule in d/dt."""
    total = [Fraction(0)]
    for c in reversed(side):
        total = _sum([k * t for k, t in enumerate(total)][1:] or [Fraction(0)], [c * x for x in phi])
    return total


def _sequence(p: _Port, phi: list[Fraction]) -> Fraction:
    """Σ u y − σ u² with u = D φ, y = N φ, shifted so that no sample is ahead of its time."""
    if len(phi) * (p.order + 1) > MOST_WORK:
        raise Invalid("the sequence is too long")
    total = Fraction(0)
    taps = [[(p.order - i, c) for i, c in enumerate(side) if c] for side in (p.denominator, p.numerator)]
    for k in range(len(phi)):
        u, y = (sum((c * phi[k - lag] for lag, c in side if lag <= k), Fraction(0)) for side in taps)
        total += u * y - p.level * u * u
    return total
