"""The independent checker: re-proves a certificate, recomputes a witness.

Written from the mathematics alone, in the standard library alone, with other
algorithms than the prover's: Chebyshev sums for the criterion, Bernstein
coefficients for its sign, Routh's table for stability, a plain recursion for
the energy of a motion.  It imports nothing of zwidth, on purpose: keep it so.

Everything is exact: numbers are integers, or text such as "3/20" and "0.15".
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from decimal import Decimal, InvalidOperation
from fractions import Fraction
from math import comb, gcd, lcm
from typing import Any, NamedTuple

MOST_COEFFICIENTS = 2000
MOST_SAMPLES = 4_000_000
MOST_SPLITS = 20_000
LONGEST_NUMBER = 20_000


class Invalid(Exception):
    """The document does not prove what it claims; the message says where."""


class Verification(NamedTuple):
    """What the checker found: whether the document holds, why, and a motion's joules."""

    valid: bool
    reason: str
    energy: Fraction | None = None


def verify(document: Mapping[str, Any]) -> Verification:
    """Check one certificate or witness, given as plain JSON data."""
    try:
        kind = _get(document, "kind")
        if kind == "motion":
            return _motion(document)
        proofs = {"spring": _spring, "linear": _linear, "quantized": _quantized}
        if not isinstance(kind, str) or kind not in proofs:
            raise Invalid(f"kind must be motion, {', '.join(proofs)}; got {kind!r}")
        return Verification(True, proofs[kind](document))
    except Invalid as error:
        return Verification(False, str(error))
    except (TypeError, KeyError, ValueError, IndexError, OverflowError, ZeroDivisionError) as error:
        return Verification(False, f"the document is malformed: {error}")


# --- reading ---------------------------------------------------------------


def _get(document: Mapping[str, Any], key: str) -> Any:
    if not isinstance(document, Mapping) or key not in document:
        raise Invalid(f"{key} is missing")
    return document[key]


def _number(value: Any) -> Fraction:
    if isinstance(value, bool) or not isinstance(value, (int, str, Decimal, float, Fraction)):
        raise Invalid(f"expected a number, got {type(value).__name__}")
    if isinstance(value, (int, Fraction)):
        return Fraction(value)
    text = repr(value) if isinstance(value, float) else str(value)
    if len(text) > LONGEST_NUMBER:
        raise Invalid("a number has too many digits")
    try:
        if "/" in text:
            top, bottom = text.split("/")
            return Fraction(int(top), int(bottom))
        decimal = Decimal(text)
    except (ValueError, InvalidOperation, ZeroDivisionError):
        raise Invalid(f"expected a number, got {text[:40]!r}") from None
    if not decimal.is_finite() or (decimal and abs(decimal.adjusted()) > 5000):
        raise Invalid(f"expected a finite number of ordinary size, got {text[:40]}")
    return Fraction(decimal)


def _integer(value: Any, least: int = 0) -> int:
    number = _number(value)
    if number.denominator != 1 or number < least:
        raise Invalid(f"expected a whole number of at least {least}, got {number}")
    return int(number)


def _list(values: Any, most: int = MOST_COEFFICIENTS) -> list[Fraction]:
    if not isinstance(values, Sequence) or isinstance(values, (str, bytes)):
        raise Invalid("expected a list of numbers")
    if len(values) > most:
        raise Invalid(f"a list has {len(values)} entries, more than {most}")
    return [_number(v) for v in values]


class _Loop(NamedTuple):
    numerator: list[Fraction]  # N, D in ascending powers of 1/z
    denominator: list[Fraction]
    damping: Fraction
    coulomb_friction: Fraction
    resolution: Fraction
    period: Fraction
    whole: int
    part: Fraction
    unilateral: bool


def _loop(document: Mapping[str, Any]) -> _Loop:
    loop = _get(document, "loop")

    def quantity(name: str) -> Fraction:
        keys = [k for k in loop if k == name or k.startswith(name + "_")]
        if len(keys) != 1:
            raise Invalid(f"the loop must give {name} once")
        return _number(loop[keys[0]])

    b, friction, resolution = (quantity(n) for n in ("damping", "coulomb_friction", "resolution"))
    period, delay = quantity("sample_period"), quantity("delay")
    if period <= 0 or min(b, friction, resolution, delay) < 0:
        raise Invalid("T must be > 0 and b, f_c, Δ and the delay ≥ 0")
    numerator, denominator = _list(_get(loop, "numerator")), _list(_get(loop, "denominator"))
    numerator = [Fraction(0)] * (len(denominator) - len(numerator)) + numerator
    if not denominator or denominator[0] == 0 or len(numerator) != len(denominator):
        raise Invalid("H(z) must be proper, with a denominator that does not begin with 0")
    whole = delay // period
    unilateral = _get(loop, "unilateral")
    if not isinstance(unilateral, bool):
        raise Invalid("unilateral must be true or false")
    return _Loop(
        numerator, denominator, b, friction, resolution, period, int(whole), delay / period - whole, unilateral
    )


# --- certificates ----------------------------------------------------------


def _spring(document: Mapping[str, Any]) -> str:
    """b² − b (KT/2)(2d+1+2α) ≥ (T²/4) α(1−α) K² and 2 f_c ≥ K Δ, with K ≥ 0.

    V = ½ K (x − Δ/2)² inside is a storage function when there is no delay; each
    held or delayed force differs from its gradient by what b and f_c absorb.
    """
    p = _loop(document)
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
    p = _loop(document)
    if p.resolution != 0:
        raise Invalid("a linear proof covers an ideal encoder only; this one has a resolution")
    _linear_part(document, p)
    return "the criterion is nonnegative at every frequency and the environment is stable"


def _linear_part(document: Mapping[str, Any], p: _Loop) -> None:
    proof = _get(document, "proof")
    _positivity(_get(proof, "positivity"), _criterion(p))
    _stability(_get(proof, "stability"), p)
    if p.damping == 0 and p.part > 0 and any(p.numerator):
        raise Invalid("without damping a force that changes inside a sample gives energy for free")


def _quantized(document: Mapping[str, Any]) -> str:
    """The encoder's error is at most Δ/2 about its middle: it moves the force by ≤ ‖h‖₁ Δ/2 ≤ f_c."""
    p = _loop(document)
    _linear_part(document, p)
    inverse = _list(_get(_get(document, "proof"), "inverse"))
    norm = _one_norm_bound(p, inverse)
    if norm * p.resolution > 2 * p.coulomb_friction:
        raise Invalid("the Coulomb friction is below ‖h‖₁ Δ/2")
    return "as linear, and Coulomb friction covers the largest force error of the encoder"


def _one_norm_bound(p: _Loop, inverse: list[Fraction]) -> Fraction:
    """‖N/D‖₁ ≤ ‖N E‖₁/(e − ‖D E − e‖₁), e the first coefficient of D E, for any polynomial E."""
    if not inverse:
        raise Invalid("the inverse has no coefficients")
    product = _multiply(p.denominator, inverse)
    slack = abs(product[0]) - sum(abs(c) for c in product[1:])
    if slack <= 0:
        raise Invalid("the inverse does not bound the impulse response")
    return sum(abs(c) for c in _multiply(p.numerator, inverse)) / slack


def _criterion(p: _Loop) -> list[Fraction]:
    """q(c) of the loop, times b where part > 0, from Chebyshev sums; ascending in c."""
    alpha, n, d = p.part, p.numerator, p.denominator
    m = [Fraction(0)] * p.whole + _multiply(n, [1 - alpha, alpha])
    real: dict[int, Fraction] = {}
    slope: dict[int, Fraction] = {}  # coefficients of (1 + c) U_{j−1}
    for i, x in enumerate(m):
        for k, y in enumerate(d):
            j = i - k
            real[abs(j)] = real.get(abs(j), Fraction(0)) + x * y
            if j:
                sign = -1 if j > 0 else 1
                slope[abs(j) - 1] = slope.get(abs(j) - 1, Fraction(0)) + sign * x * y
    degree = max([*real, *(j + 1 for j in slope), len(d) - 1, len(n) - 1])
    first, second = _chebyshev(degree)
    q = [Fraction(0)] * (degree + 1)
    weight, factor = (p.damping, 2 * p.damping**2) if alpha else (Fraction(1), 2 * p.damping)
    _add(q, _square_modulus(d, first), factor / p.period)
    for j, x in real.items():
        _add(q, first[j], -weight * x)
    for j, x in slope.items():
        _add(q, second[j], weight * x)
        _add(q, [0, *second[j]], weight * x)
    if alpha:
        _add(q, _square_modulus(n, first), -p.period * alpha * (1 - alpha) / 2)
    return q


def _chebyshev(degree: int) -> tuple[list[list[int]], list[list[int]]]:
    first, second = [[1], [0, 1]], [[1], [0, 2]]
    for table in (first, second):
        while len(table) <= degree:
            last, before = table[-1], table[-2]
            twice = [0, *(2 * c for c in last)]
            table.append([a - b for a, b in zip(twice, [*before, 0, 0], strict=True)])
    return first, second


def _square_modulus(a: list[Fraction], first: list[list[int]]) -> list[Fraction]:
    total = [Fraction(0)] * len(a)
    for j in range(len(a)):
        lag = sum((a[i] * a[i + j] for i in range(len(a) - j)), Fraction(0))
        _add(total, first[j], lag if j == 0 else 2 * lag)
    return total


def _add(total: list[Fraction], terms: Sequence[int | Fraction], weight: Fraction) -> None:
    for i, c in enumerate(terms):
        if c:
            total[i] += weight * c


def _multiply(a: Sequence[Fraction], b: Sequence[Fraction]) -> list[Fraction]:
    out = [Fraction(0)] * (len(a) + len(b) - 1)
    for i, x in enumerate(a):
        if x:
            for j, y in enumerate(b):
                out[i + j] += x * y
    return out


def _positivity(proof: Mapping[str, Any], q: list[Fraction]) -> None:
    """q = (positive) (1 − c)ⁱ (1 + c)ʲ s² g, and g > 0 on [−1, 1]."""
    at_one, at_minus_one = _integer(_get(proof, "at_one")), _integer(_get(proof, "at_minus_one"))
    square, g = _list(_get(proof, "square")), _list(_get(proof, "factor"))
    if not g or at_one + at_minus_one > MOST_COEFFICIENTS:
        raise Invalid("the factors of the criterion are missing")
    product = _multiply(_multiply(square, square), g) if square else [Fraction(0)]
    for times, root in ((at_one, [1, -1]), (at_minus_one, [1, 1])):
        for _ in range(times):
            product = _multiply(product, [Fraction(c) for c in root])
    _proportional(q, product)
    _strictly_positive(g)


def _proportional(a: list[Fraction], b: list[Fraction]) -> None:
    size = max(len(a), len(b))
    a, b = a + [Fraction(0)] * (size - len(a)), b + [Fraction(0)] * (size - len(b))
    pivot = next((i for i in range(size) if a[i] or b[i]), None)
    if pivot is None:
        return
    if a[pivot] * b[pivot] <= 0:
        raise Invalid("the factors do not multiply to the criterion")
    ratio = a[pivot] / b[pivot]
    if any(x != ratio * y for x, y in zip(a, b, strict=True)):
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
    in_t = [Fraction(0)]
    for c in reversed(g):
        shifted = _multiply(in_t, [Fraction(-1), Fraction(2)])
        shifted[0] += c
        in_t = shifted
    in_t = (in_t + [Fraction(0)] * (n + 1))[: n + 1]
    b = [sum((Fraction(comb(i, k), comb(n, k)) * in_t[k] for k in range(i + 1)), Fraction(0)) for i in range(n + 1)]
    scale = lcm(*(c.denominator for c in b))
    return [int(c * scale) for c in b]


def _split(b: list[int]) -> tuple[list[int], list[int]]:
    """De Casteljau at the middle, times 2ⁿ."""
    n = len(b) - 1
    row, left, right = list(b), [b[0] << n], [b[-1] << n]
    for level in range(1, n + 1):
        row = [x + y for x, y in zip(row, row[1:], strict=False)]
        left.append(row[0] << (n - level))
        right.append(row[-1] << (n - level))
    return left, right[::-1]


def _stability(proof: Mapping[str, Any], p: _Loop) -> None:
    kind = _get(proof, "kind")
    if kind == "open loop":
        if not _inside_unit_circle(p.denominator):
            raise Invalid("H(z) has a pole outside or on the unit circle")
        if sum(p.numerator) * sum(p.denominator) < 0:
            raise Invalid("the static stiffness H(1) is negative")
    elif kind == "closed loop":
        if p.part:
            raise Invalid("a closed-loop proof does not cover a delay of part of a sample")
        offset = _number(_get(proof, "offset"))
        if offset <= 0:
            raise Invalid("the offset must be positive")
        _require_coprime(p)
        if not _inside_unit_circle(_positive_real_denominator(p, offset)):
            raise Invalid("b + T z⁻ᵈ H/(z − 1) is not positive real")
    else:
        raise Invalid(f"unknown kind of stability proof: {kind!r}")


def _positive_real_denominator(p: _Loop, offset: Fraction) -> list[Fraction]:
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


def _require_coprime(p: _Loop) -> None:
    a, b = _trim(p.numerator), _trim(p.denominator)
    while b:
        a, b = b, _remainder(a, b)
    if len(a) > 1:
        raise Invalid("numerator and denominator of H(z) have a common factor")


def _trim(a: Sequence[Fraction]) -> list[Fraction]:
    out = list(a)
    while out and out[-1] == 0:
        out.pop()
    return out


def _remainder(a: list[Fraction], b: list[Fraction]) -> list[Fraction]:
    a = list(a)
    while len(a) >= len(b):
        ratio, shift = a[-1] / b[-1], len(a) - len(b)
        a = [x - ratio * b[i - shift] if i >= shift else x for i, x in enumerate(a)]
        a.pop()
        a = _trim(a)
    return a


def _inside_unit_circle(descending: Sequence[Fraction]) -> bool:
    """All roots of Σ a_i z^{n−i} inside |z| = 1, by z = (1 + s)/(1 − s) and Routh's table."""
    n = len(descending) - 1
    scale = lcm(*(c.denominator for c in descending))
    p = [0] * (n + 1)
    for i, c in enumerate(descending):
        plus, minus = n - i, i
        row = [int(c * scale)]
        for _ in range(plus):
            row = [a + b for a, b in zip([*row, 0], [0, *row], strict=True)]
        for _ in range(minus):
            row = [a - b for a, b in zip([*row, 0], [0, *row], strict=True)]
        p = [a + b for a, b in zip(p, row, strict=True)]
    return _hurwitz(p[::-1])


def _hurwitz(descending: list[int]) -> bool:
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


# --- motions ---------------------------------------------------------------


class _State(NamedTuple):
    """What a sampled loop remembers: the filter's past and the forces on their way.

    `ahead` is how far repeated parts have carried the hand beyond the list.
    """

    memory: tuple[int | Fraction, ...]
    forces: tuple[int | Fraction, ...]
    ahead: int


def _motion(document: Mapping[str, Any]) -> Verification:
    """Net energy the hand takes out of the device over a motion from rest to rest [J]."""
    p = _loop(document)
    positions = _list(_get(document, _key(document, "positions")), MOST_SAMPLES)
    if len(positions) < 2:
        raise Invalid("a motion has at least two positions")
    if p.unilateral and positions[0] > 0:
        raise Invalid("the motion must start at rest outside the wall or on its surface")
    start = positions[0] // p.resolution if p.resolution else positions[0]
    if not p.unilateral and start != 0:
        raise Invalid("the motion must start at rest at x = 0")
    switches = _switch_positions(document, p, positions)
    repeats = _repeats(document, len(positions))
    energy = _energy_of(p, positions, switches, repeats)
    claimed = _number(_get(document, "energy_J"))
    if energy <= 0:
        return Verification(False, f"the motion extracts no energy: {float(energy):g} J", energy)
    if abs(claimed - energy) > abs(energy) / 10**9:
        return Verification(False, f"the energy is {float(energy):g} J, not {float(claimed):g} J", energy)
    return Verification(True, f"the motion extracts {float(energy):g} J", energy)


def _key(document: Mapping[str, Any], name: str) -> str:
    for unit in ("m", "rad"):
        if f"{name}_{unit}" in document:
            return f"{name}_{unit}"
    raise Invalid(f"{name}_m is missing")


def _switch_positions(document: Mapping[str, Any], p: _Loop, x: list[Fraction]) -> list[Fraction]:
    """Positions at the instant inside each interval when the delayed force changes."""
    if not p.part:
        return x[:-1]
    y = _list(_get(document, _key(document, "switch_positions")), MOST_SAMPLES)
    if len(y) != len(x) - 1:
        raise Invalid("there must be one switch position in each interval")
    return y


class _Repeat(NamedTuple):
    first: int
    last: int
    times: int


def _repeats(document: Mapping[str, Any], size: int) -> list[_Repeat]:
    """Parts of the motion that are done more than once.

    The positions list each of them once; where one ends ahead of its start,
    every round and all that follows is that much further on.
    """
    entries = document.get("repeats", [])
    if not isinstance(entries, list) or len(entries) > size:
        raise Invalid("repeats must be a list")
    parts = [
        _Repeat(_integer(_get(e, "first")), _integer(_get(e, "last")), _integer(_get(e, "times"), 1))
        for e in entries
    ]
    before = 0
    for part in parts:
        if not before <= part.first < part.last < size:
            raise Invalid("repeated parts must lie in the motion, one after the other")
        before = part.last
    return parts


class _Counts(NamedTuple):
    """The motion and the law in whole numbers of one small length, so that long motions stay fast."""

    x: list[int]
    y: list[int]
    count: int  # the encoder's resolution, 0 if ideal
    numerator: list[int]
    denominator: list[int]


class _Sums(NamedTuple):
    """What an energy is made of, in counts: Σ f Δx, Σ |Δx| and Σ Δx² before and after the switch."""

    work: int | Fraction
    path: int
    early: int
    late: int

    def plus(self, other: _Sums) -> _Sums:
        return _Sums(*(a + b for a, b in zip(self, other, strict=True)))


def _energy_of(p: _Loop, x: list[Fraction], y: list[Fraction], repeats: list[_Repeat]) -> Fraction:
    """Energy the hand takes out over the whole motion [J]."""
    per_unit = lcm(p.resolution.denominator, *(v.denominator for v in x), *(v.denominator for v in y))
    scale = lcm(*(c.denominator for c in (*p.numerator, *p.denominator)))
    counts = _Counts(
        [int(v * per_unit) for v in x],
        [int(v * per_unit) for v in y],
        int(p.resolution * per_unit),
        [int(c * scale) for c in p.numerator],
        [int(c * scale) for c in p.denominator],
    )
    state = _State((0,) * (len(p.denominator) - 1), (0,) * (p.whole + 2), 0)
    sums = _Sums(0, 0, 0, 0)
    before = 0
    for part in [*repeats, _Repeat(len(x) - 1, len(x) - 1, 1)]:
        gained, state = _run(p, counts, before, part.first, state)
        sums = sums.plus(gained)
        gained, state = _rounds(p, counts, part, state)
        sums = sums.plus(gained)
        before = part.last
    squares = sums.early / p.part + sums.late / (1 - p.part) if p.part else sums.late
    unit = Fraction(1, per_unit)
    force_work = sums.work + p.damping / p.period * squares
    return -(unit**2) * force_work - p.coulomb_friction * unit * sums.path


def _rounds(p: _Loop, c: _Counts, part: _Repeat, state: _State) -> tuple[_Sums, _State]:
    """All rounds of a repeated part: one by one until the loop has settled, then in closed form.

    A law linear in x that has gone a constant distance on, all of it, does the
    same again with every force larger by the same amount.
    """
    advance = c.x[part.last] - c.x[part.first]
    sums, done = _Sums(0, 0, 0, 0), 0
    while done < part.times and part.first < part.last:
        gained, following = _run(p, c, part.first, part.last, state)
        push = _uniform_push(p, c, part, state, following, part.times - done)
        left = part.times - done if push is not None else 1
        if push is not None:
            growth = push * advance * (left * (left - 1) // 2)
            gained = _Sums(left * gained.work + growth, *(left * s for s in gained[1:]))
            following = _State(
                tuple(w + (left - 1) * (w - v) for v, w in zip(state.memory, following.memory, strict=True)),
                tuple(f + (left - 1) * push for f in following.forces),
                state.ahead + left * advance,
            )
        else:
            following = following._replace(ahead=state.ahead + advance)
        sums, state, done = sums.plus(gained), following, done + left
        if done > 1000 + len(c.x) and done < part.times:
            raise Invalid("a repeated part does not settle into a cycle")
    # x in the list after the part stands one advance ahead already
    return sums, state._replace(ahead=state.ahead - advance)


def _uniform_push(
    p: _Loop, c: _Counts, part: _Repeat, state: _State, following: _State, left: int
) -> int | Fraction | None:
    """By how much every force grows from this round to each later one; None if not yet settled."""
    advance = c.x[part.last] - c.x[part.first]
    if advance == 0:
        same = following.memory == state.memory and following.forces == state.forces
        return 0 if same else None
    lowest = min(c.x[part.first : part.last + 1]) + state.ahead + min(0, advance * (left - 1))
    if (p.unilateral and lowest <= 0) or (c.count and advance % c.count):
        return None
    shift = Fraction(advance, sum(c.denominator)) if sum(c.denominator) else None
    if shift is None or any(w - v != shift for v, w in zip(state.memory, following.memory, strict=True)):
        return None
    push = sum(c.numerator) * shift
    if any(g - f != push for f, g in zip(state.forces, following.forces, strict=True)):
        return None
    return push


def _run(p: _Loop, c: _Counts, start: int, stop: int, state: _State) -> tuple[_Sums, _State]:
    """The sums of one stretch of the motion, and the state after it.

    The filter runs in its direct form II: D w = x, f = N w, so that motions
    made as x = D w keep short numbers however long they are.
    """
    memory, forces = list(state.memory), list(state.forces)
    work: int | Fraction = 0
    path = early_squares = late_squares = 0
    inside_sample = p.part != 0
    for k in range(start, stop):
        here = c.x[k] + state.ahead
        measured = c.count * (here // c.count) if c.count else here
        forces = [_force(p, c, measured, memory), *forces[:-1]]
        early, late = (c.y[k] - c.x[k], c.x[k + 1] - c.y[k]) if inside_sample else (0, c.x[k + 1] - c.x[k])
        work += forces[p.whole] * late
        path += abs(early) + abs(late)
        late_squares += late * late
        if early:
            work += forces[p.whole + 1] * early
            early_squares += early * early
    sums = _Sums(work, path, early_squares, late_squares)
    return sums, _State(tuple(memory), tuple(forces), state.ahead)


def _force(p: _Loop, c: _Counts, x: int, memory: list[int | Fraction]) -> int | Fraction:
    """f(k) from the measured position; updates the memory in place."""
    if p.unilateral and x <= 0:
        if any(memory):
            raise Invalid("the motion leaves the wall, where a law with memory is not defined")
        x = 0
    w: int | Fraction = x
    for a, past in zip(c.denominator[1:], memory, strict=True):
        if past:
            w -= a * past
    w = _divide(w, c.denominator[0])
    force = c.numerator[0] * w
    for b, past in zip(c.numerator[1:], memory, strict=True):
        if past:
            force += b * past
    if memory:
        memory.insert(0, w)
        memory.pop()
    return force


def _divide(a: int | Fraction, b: int) -> int | Fraction:
    if isinstance(a, int):
        quotient, rest = divmod(a, b)
        return quotient if rest == 0 else Fraction(a, b)
    return a / b
