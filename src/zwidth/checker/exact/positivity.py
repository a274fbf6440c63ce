"""The sign of a polynomial on [−1, 1], from factors that a document gives.

q = (positive) (1 − c)ⁱ (1 + c)ʲ s(c)² g(c),    g > 0 on [−1, 1]
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import comb, lcm

from ..document.fields import Read, Record, Whole, numbers
from ..document.refusal import Invalid, spend
from .polynomial import bits, cleared, multiply

MOST_ROOTS = 2000
MOST_SPLITS = 20_000

POSITIVITY = Record(
    {
        "at_one": Whole(least=0, most=MOST_ROOTS),
        "at_minus_one": Whole(least=0, most=MOST_ROOTS),
        "square": numbers(),
        "factor": numbers(least=1),
    },
    shown=False,
)


def require_nonnegative(q: Sequence[Fraction], proof: Read) -> None:
    """Refuse a polynomial, ascending in c, that the factors do not show to be ≥ 0 on [−1, 1]."""
    at_ends = proof.at_one + proof.at_minus_one
    if proof.square and at_ends + 2 * (len(proof.square) - 1) + len(proof.factor) > len(q):
        raise Invalid("the factors have a higher degree than the criterion")
    root, rest = cleared(proof.square), cleared(proof.factor)
    spend(len(q) ** 2, 2 * bits(root), max(bits(root), bits(rest)))
    spend(len(q) * at_ends, 2 * bits(root) + bits(rest), 1)
    _require_proportional(cleared(q), product(proof) or [0])
    require_positive(proof.factor)


def product(proof: Read) -> list[int]:
    """(1 − c)ⁱ (1 + c)ʲ s² g times a positive number; empty where s is."""
    root, rest = cleared(proof.square), cleared(proof.factor)
    found = multiply(multiply(root, root), rest)
    for times, constant in ((proof.at_one, -1), (proof.at_minus_one, 1)):
        for _ in range(times if found else 0):
            found = multiply(found, [1, constant])
    return found


def _require_proportional(a: list[int], b: list[int]) -> None:
    """a = κ b with κ > 0, b not the longer one."""
    size = len(a)
    b = b + [0] * (size - len(b))
    pivot = next((i for i in range(size) if a[i] or b[i]), None)
    if pivot is None:
        return
    x, y = a[pivot], b[pivot]
    spend(size, bits(a), bits(b))
    if x * y <= 0 or any(u * y != v * x for u, v in zip(a, b, strict=True)):
        raise Invalid("the factors do not multiply to the criterion")


def require_positive(g: Sequence[Fraction]) -> None:
    """Refuse g that is not > 0 on [−1, 1]: Bernstein coefficients on halved intervals."""
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


def _bernstein(g: Sequence[Fraction]) -> list[int]:
    """Bernstein coefficients of g(2t − 1) on [0, 1], times a positive integer."""
    n, whole = len(g) - 1, cleared(g)
    spend(2 * n**2, bits(whole) + 3 * n, n)
    in_t = [0]
    for c in reversed(whole):
        in_t = multiply(in_t, [-1, 2])
        in_t[0] += c
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
    spend(n**2, bits(b) + n, 1)
    row, left, right = list(b), [b[0] << n], [b[-1] << n]
    for level in range(1, n + 1):
        row = [x + y for x, y in zip(row, row[1:], strict=False)]
        left.append(row[0] << (n - level))
        right.append(row[-1] << (n - level))
    return left, right[::-1]
