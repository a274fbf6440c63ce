"""Certificates re-proved: the criterion from its definition, its sign, and the stability of H(z)."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from math import comb, gcd, lcm
from typing import Any, TypeVar

from ..document.effort import spend
from ..document.reading import MOST_COEFFICIENTS, Invalid, Loop, get, integer, number, numbers, read_loop

MOST_SPLITS = 20_000
MOST_MODES = 60
MOST_ROUTH = 20_000_000
"""Order squared times the bits of the largest coefficient of a polynomial whose roots are to be placed."""

_Exact = TypeVar("_Exact", int, Fraction)


def _spring(document: Mapping[str, Any]) -> str:
    """b² − b (KT/2)(2d+1+2α) ≥ (T²/4) α(1−α) K² and 2 f_c ≥ K Δ, with K ≥ 0.

    V = ½ K (x − Δ/2)² inside is a storage function when there is no delay; each
    held or delayed force differs from its gradient by what b and f_c absorb.
    """
    p = read_loop(document)
    if any(p.numerator[1:]) or any(p.denominator[1:]):
        raise Invalid("the law is not a spring: H(z) is not constant")
    k = p.numerator[0] / p.denominator[0]
    if k < 0:
        raise Invalid(f"the stiffness is negative: {float(k):g}")
    reach = k * p.period / 2 * (2 * p.whole + 1 + 2 * p.part)
    inside = p.period**2 / 4 * p.part * (1 - p.part) * k**2
    if p.damping < reach or p.damping * (p.damping - reach) < inside:
        raise Invalid("the damping is below what the hold and the delay of this spring need")
    if 2 * p.coulomb_friction < k * p.resolution:
        raise Invalid("the Coulomb friction is below half a count of this spring, K Δ/2")
    return "2b/T with delay and 2 f_c/Δ both admit this stiffness"


def _linear(document: Mapping[str, Any]) -> str:
    p = read_loop(document)
    if p.resolution != 0:
        raise Invalid("a linear proof covers an ideal encoder only; this one has a resolution")
    _linear_part(document, p)
    return "the criterion is nonnegative at every frequency and the environment is stable"


def _linear_part(document: Mapping[str, Any], p: Loop) -> None:
    proof = get(document, "proof")
    _positivity(get(proof, "positivity"), _criterion(p))
    _stability(get(proof, "stability"), p)
    if p.damping == 0 and p.part > 0 and any(p.numerator):
        raise Invalid("without damping a force that changes inside a sample gives energy for free")


def _quantized(document: Mapping[str, Any]) -> str:
    """The encoder's error is at most Δ/2 about its middle: it moves the force by ≤ ‖h‖₁ Δ/2 ≤ f_c."""
    p = read_loop(document)
    _linear_part(document, p)
    _friction(p, get(document, "proof"))
    return "as linear, and Coulomb friction covers the largest force error of the encoder"


def _delays(document: Mapping[str, Any]) -> str:
    """Every delay from the loop's own to `delay_high_s`, piece by piece.

    On a piece α(1−α) is at most its tangent at the middle, and with the tangent
    the criterion is affine in α: nonnegative if it is at both ends.
    """
    p = read_loop(document)
    proof, high = get(document, "proof"), number(get(document, "delay_high_s"))
    if p.damping == 0 or get(get(proof, "stability"), "kind") != "open loop":
        raise Invalid("delays within an interval need damping and a law that is stable by itself")
    _stability(get(proof, "stability"), p)
    pieces = get(proof, "pieces")
    if not isinstance(pieces, list) or high / p.period > MOST_COEFFICIENTS:
        raise Invalid("the pieces of the interval must be a list, its delays of ordinary size")
    reached = p.whole + p.part
    for piece in pieces:
        if number(get(piece, "low")) != reached:
            raise Invalid("the pieces do not follow one another")
        reached = _delay_piece(p, piece)
    if reached != high / p.period:
        raise Invalid("the pieces do not cover the interval of delays")
    if p.resolution:
        _friction(p, proof)
    return "the criterion is nonnegative at every frequency for every delay, and the environment is stable"


def _delay_piece(p: Loop, piece: Mapping[str, Any]) -> Fraction:
    low, high = number(get(piece, "low")), number(get(piece, "high"))
    whole = low // 1
    if not low < high <= whole + 1:
        raise Invalid("a piece must lie within one sample")
    middle = (low + high) / 2 - whole
    for end, name in ((low, "at_low"), (high, "at_high")):
        part = end - whole
        tangent = middle * (1 - middle) + (1 - 2 * middle) * (part - middle)
        _positivity(get(piece, name), _bounded_criterion(p._replace(whole=whole, part=part), tangent))
    return high


def _friction(p: Loop, proof: Mapping[str, Any]) -> None:
    if _one_norm_bound(p, get(proof, "norm")) * p.resolution > 2 * p.coulomb_friction:
        raise Invalid("the Coulomb friction is below ‖h‖₁ Δ/2")


def _one_norm_bound(p: Loop, norm: Mapping[str, Any]) -> Fraction:
    """‖H‖₁ ≤ Σ|r|/(1 − |p|) + ‖R E‖₁/(|e₀| − ‖S E − e₀‖₁) where H = Σ r/(1 − p ζ) + R/S, any polynomial E."""
    top, bottom, inverse = (
        numbers(get(norm, k)) or [Fraction(0)] for k in ("rest_numerator", "rest_denominator", "inverse")
    )
    modes = get(norm, "modes")
    if not isinstance(modes, list) or len(modes) > MOST_MODES:
        raise Invalid("the modes must be a short list")
    product = _multiply(bottom, inverse)
    slack = abs(product[0]) - sum(abs(c) for c in product[1:])
    if slack <= 0:
        raise Invalid("the inverse does not bound the impulse response")
    bound = sum(abs(c) for c in _multiply(top, inverse)) / slack
    for mode in modes:
        pole, residue = number(get(mode, "pole")), number(get(mode, "residue"))
        if abs(pole) >= 1:
            raise Invalid("a mode does not decay")
        bound += abs(residue) / (1 - abs(pole))
        line = [Fraction(1), -pole]
        top, bottom = _sum(_multiply(top, line), [residue * c for c in bottom]), _multiply(bottom, line)
    left, right = _multiply(top, p.denominator), _multiply(p.numerator, bottom)
    if any(_sum(left, [-c for c in right])):
        raise Invalid("the modes and the rest do not sum to H(z)")
    return bound


def _sum(a: Sequence[Fraction], b: Sequence[Fraction]) -> list[Fraction]:
    size = max(len(a), len(b))
    return [(a[i] if i < len(a) else Fraction(0)) + (b[i] if i < len(b) else 0) for i in range(size)]


def _criterion(p: Loop) -> list[Fraction]:
    """q(c) of the loop, times b where part > 0; ascending in c."""
    if p.part:
        return _bounded_criterion(p, p.part * (1 - p.part))
    damped, hold, _ = _cosine_sums(p)
    gain = 2 * p.damping / p.period
    return [gain * x + y for x, y in zip(damped, hold, strict=True)]


def _bounded_criterion(p: Loop, share: Fraction) -> list[Fraction]:
    """b q(c) with `share` in the place of α(1−α), α = part."""
    gain, b, loss = 2 * p.damping**2 / p.period, p.damping, p.period * share / 2
    return [gain * x + b * y - loss * z for x, y, z in zip(*_cosine_sums(p), strict=True)]


def _cosine_sums(p: Loop) -> tuple[list[int], list[Fraction], list[int]]:
    """|D|², −R + (1 + c) S and |N|², from Chebyshev sums; ascending in c."""
    alpha, n, d = p.part, _whole(p.numerator, p), _whole(p.denominator, p)
    size, bits = len(n) + len(d) + p.whole, _bits((*n, *d))
    spend(size**2, bits)
    spend(2 * size**2, bits, size)
    m = [0] * p.whole + _multiply(n, [alpha.denominator - alpha.numerator, alpha.numerator])
    degree = max(len(m), len(d), len(n)) - 1
    real, slope = [0] * (degree + 1), [0] * degree  # Σ of T_j, and of (1 + c) U_j
    for i, x in enumerate(m):
        for k, y in enumerate(d):
            j = i - k
            real[abs(j)] += x * y
            if j:
                slope[abs(j) - 1] -= x * y if j > 0 else -x * y
    part = _in_powers(slope, 2)
    raised = [x + y for x, y in zip([*part, 0], [0, *part], strict=True)]
    hold = [y - x for x, y in zip(_in_powers(real, 1), raised, strict=True)]
    weight = Fraction(1, alpha.denominator)
    return _square_modulus(d, degree), [weight * x for x in hold], _square_modulus(n, degree)


def _whole(coefficients: list[Fraction], p: Loop) -> list[int]:
    """N or D times the integer that makes both whole."""
    scale = lcm(*(c.denominator for c in (*p.numerator, *p.denominator)))
    return [c.numerator * (scale // c.denominator) for c in coefficients]


def _in_powers(sums: Sequence[_Exact], kind: int) -> list[_Exact]:
    """Σ sums_j T_j (kind 1) or Σ sums_j U_j (kind 2) in ascending powers, by Clenshaw's recursion."""
    later: list[_Exact] = []
    last: list[_Exact] = []
    for c in reversed(sums[1:]):
        later, last = _recurred(c, later, last, 2), later
    return _recurred(sums[0], later, last, kind) if sums else []


def _recurred(c: _Exact, later: list[_Exact], last: list[_Exact], times: int) -> list[_Exact]:
    """c + times x later − last."""
    out: list[Any] = [c, *(times * v for v in later)]
    for i, v in enumerate(last):
        out[i] -= v
    return out


def _square_modulus(a: list[int], degree: int) -> list[int]:
    lags = [sum(a[i] * a[i + j] for i in range(len(a) - j)) for j in range(len(a))]
    found = _in_powers([lags[0], *(2 * lag for lag in lags[1:])], 1)
    return found + [0] * (degree + 1 - len(found))


def _multiply(a: Sequence[_Exact], b: Sequence[_Exact]) -> list[_Exact]:
    out: list[Any] = [0] * (len(a) + len(b) - 1)
    for i, x in enumerate(a):
        if x:
            for j, y in enumerate(b):
                out[i + j] += x * y
    return out


def _positivity(proof: Mapping[str, Any], q: list[Fraction]) -> None:
    """q = (positive) (1 − c)ⁱ (1 + c)ʲ s² g, and g > 0 on [−1, 1]."""
    at_one, at_minus_one = integer(get(proof, "at_one")), integer(get(proof, "at_minus_one"))
    square, g = numbers(get(proof, "square")), numbers(get(proof, "factor"))
    if not g or at_one + at_minus_one > MOST_COEFFICIENTS:
        raise Invalid("the factors of the criterion are missing")
    if square and at_one + at_minus_one + 2 * (len(square) - 1) + len(g) > len(q):
        raise Invalid("the factors have a higher degree than the criterion")
    root, rest = _cleared(square), _cleared(g)
    spend(len(q) ** 2, 2 * _bits(root), max(_bits(root), _bits(rest)))
    spend(len(q) * (at_one + at_minus_one), 2 * _bits(root) + _bits(rest), 1)
    product = _multiply(_multiply(root, root), rest) if square else [0]
    for times, constant in ((at_one, -1), (at_minus_one, 1)):
        for _ in range(times):
            product = _multiply(product, [1, constant])
    _proportional(_cleared(q), product)
    _strictly_positive(g)


def _bits(a: Sequence[int]) -> int:
    """Of the largest."""
    return max((c.bit_length() for c in a), default=0)


def _cleared(a: Sequence[Fraction]) -> list[int]:
    """A polynomial times the positive integer that makes it whole."""
    scale = lcm(*(c.denominator for c in a))
    return [c.numerator * (scale // c.denominator) for c in a]


def _proportional(a: list[int], b: list[int]) -> None:
    size = max(len(a), len(b))
    a, b = a + [0] * (size - len(a)), b + [0] * (size - len(b))
    pivot = next((i for i in range(size) if a[i] or b[i]), None)
    if pivot is None:
        return
    x, y = a[pivot], b[pivot]
    spend(size, _bits(a), _bits(b))
    if x * y <= 0 or any(u * y != v * x for u, v in zip(a, b, strict=True)):
        raise Invalid("the factors do not multiply to the criterion")


def _strictly_positive(g: list[Fraction]) -> None:
    """g > 0 on [−1, 1], by Bernstein coefficients on halved intervals."""
    work = [_bernstein(g)]
    splits = 0
    while work:
        b = work.pop()
        if b[0] <= 0 or b[-1] <= 0:
            raise Invalid("the criterion is not positive where the proof says it is")
        if all(c >= 0 for c in b):
            continue
        splits += 1
        if splits > MOST_SPLITS:
            raise Invalid("the sign of the criterion could not be confirmed")
        work.extend(_split(b))


def _bernstein(g: list[Fraction]) -> list[int]:
    """Bernstein coefficients of g(2t − 1) on [0, 1], times a positive integer."""
    n = len(g) - 1
    scale = lcm(*(c.denominator for c in g))
    spend(2 * n**2, _bits(_cleared(g)) + 3 * n, n)
    in_t = [0]
    for c in reversed(g):
        in_t = _multiply(in_t, [-1, 2])
        in_t[0] += int(c * scale)
    common = lcm(*(comb(n, k) for k in range(n + 1)))
    row = [in_t[k] * (common // comb(n, k)) for k in range(n + 1)]
    out = []
    while row:  # Σ_k C(i, k) row_k, by Pascal's triangle
        out.append(row[0])
        row = [x + y for x, y in zip(row, row[1:], strict=False)]
    return out


def _split(b: list[int]) -> tuple[list[int], list[int]]:
    """De Casteljau at the middle, times 2ⁿ."""
    n = len(b) - 1
    spend(n**2, _bits(b) + n, 1)
    row, left, right = list(b), [b[0] << n], [b[-1] << n]
    for level in range(1, n + 1):
        row = [x + y for x, y in zip(row, row[1:], strict=False)]
        left.append(row[0] << (n - level))
        right.append(row[-1] << (n - level))
    return left, right[::-1]


def _stability(proof: Mapping[str, Any], p: Loop) -> None:
    kind = get(proof, "kind")
    if kind == "open loop":
        if not _inside_unit_circle(p.denominator):
            raise Invalid("H(z) has a pole outside or on the unit circle")
        if sum(p.numerator) * sum(p.denominator) < 0:
            raise Invalid("the static stiffness H(1) is negative")
    elif kind == "closed loop":
        if p.part:
            raise Invalid("a closed-loop proof does not cover a delay of part of a sample")
        offset = number(get(proof, "offset"))
        if offset <= 0:
            raise Invalid("the offset must be positive")
        _require_coprime(p)
        if not _inside_unit_circle(_positive_real_denominator(p, offset)):
            raise Invalid("b + T z⁻ᵈ H/(z − 1) is not positive real")
    else:
        raise Invalid(f"unknown kind of stability proof: {kind!r}")


def _positive_real_denominator(p: Loop, offset: Fraction) -> list[Fraction]:
    """n + g d of b + T ζ^{d+1} N/((1 − ζ) D), with a common 1 − ζ cancelled."""
    top = [Fraction(0)] * (p.whole + 1) + [p.period * c for c in p.numerator]
    bottom = _multiply(p.denominator, [Fraction(1), Fraction(-1)])
    size = max(len(top), len(bottom))
    total = p.damping + offset
    sums = [
        (top[i] if i < len(top) else 0) + total * (bottom[i] if i < len(bottom) else 0) for i in range(size)
    ]
    if sum(p.numerator) == 0:
        running, out = Fraction(0), []
        for c in sums[:-1]:
            running += c
            out.append(running)
        return out
    return [Fraction(c) for c in sums]


def _require_coprime(p: Loop) -> None:
    """Coprime modulo a prime that does not divide the highest coefficient of D: then coprime."""
    n, d = _trim(_whole(p.numerator, p)), _trim(_whole(p.denominator, p))
    if not any(d[-1] % prime and _coprime_modulo(prime, n, d) for prime in _PRIMES):
        raise Invalid("numerator and denominator of H(z) have a common factor")


_PRIMES = (2**61 - 1, 2**89 - 1, 2**127 - 1)


def _coprime_modulo(prime: int, n: list[int], d: list[int]) -> bool:
    a, b = (_trim([c % prime for c in part]) for part in (d, n))
    while b:
        a, b = b, _remainder(a, b, prime)
    return len(a) == 1


def _trim(a: list[int]) -> list[int]:
    while a and a[-1] == 0:
        a.pop()
    return a


def _remainder(a: list[int], b: list[int], prime: int) -> list[int]:
    inverse = pow(b[-1], -1, prime)
    while len(a) >= len(b):
        ratio, shift = a[-1] * inverse % prime, len(a) - len(b)
        a = a[:shift] + [(x - ratio * y) % prime for x, y in zip(a[shift:], b, strict=True)]
        a = _trim(a)
    return a


def _inside_unit_circle(descending: Sequence[Fraction]) -> bool:
    """All roots of Σ a_i z^{n−i} inside |z| = 1, by z = (1 + s)/(1 − s) and Routh's table."""
    whole = _cleared(descending)
    spend(2 * len(whole) ** 2, _bits(whole) + len(whole), 1)
    # a(z) with z = w − 1 and w = 2/(1 − s): Σ b_k 2^k (1 − s)^(n−k), a polynomial in t = 1 − s, then in s
    shifted = _shifted(whole[::-1], -1)
    in_t = [b << k for k, b in enumerate(shifted)][::-1]
    in_s = [-c if k % 2 else c for k, c in enumerate(_shifted(in_t, 1))]
    return _hurwitz(in_s[::-1])


def _shifted(ascending: Sequence[int], by: int) -> list[int]:
    """The coefficients of a(x + by), `by` = ±1, by Horner's rule over and over."""
    a = list(ascending)
    for first in range(len(a) - 1):
        for k in range(len(a) - 2, first - 1, -1):
            a[k] += by * a[k + 1]
    return a


def _hurwitz(descending: list[int]) -> bool:
    if len(descending) ** 2 * max(c.bit_length() for c in descending) > MOST_ROUTH:
        raise Invalid("the stability of so high an order, with so many digits, is not decided")
    if descending[0] == 0:
        return False
    if descending[0] < 0:
        descending = [-c for c in descending]
    upper, lower = descending[0::2], descending[1::2]
    while lower:
        if lower[0] <= 0:
            return False
        padded = lower + [0] * (len(upper) - len(lower))
        following = [lower[0] * upper[i + 1] - upper[0] * padded[i + 1] for i in range(len(upper) - 1)]
        common = gcd(*following) if following else 1
        upper, lower = lower, [c // common for c in following] if common > 1 else following
    return upper[0] > 0


PROOFS: dict[str, Callable[[Mapping[str, Any]], str]] = {
    "spring": _spring,
    "linear": _linear,
    "quantized": _quantized,
    "delays": _delays,
}
