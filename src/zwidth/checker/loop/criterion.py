"""The linear criterion as a polynomial in c = cos θ, from its definition, and the stability of the law.

    2b²/T |D|² + b (−R + (1 + c) S) − (T/2) α(1 − α) |N|² ≥ 0,    ζᵈ (1 − α + α ζ) N D̄ = R + j sin θ S

for a delay of d + α samples; for α = 0 without the factor b and the last term.
"""

from __future__ import annotations

from fractions import Fraction

from ..document.effort import spend
from ..document.fields import Number, OneOf, Read, Record
from ..document.refusal import Invalid
from ..exact.coprime import are_coprime
from ..exact.polynomial import add, bits, in_powers, multiply, square_modulus
from ..exact.positivity import POSITIVITY, require_nonnegative
from ..exact.roots import inside_unit_circle
from .loop import Loop, in_whole_numbers

STABILITY = OneOf(
    "kind",
    {"open loop": Record({}), "closed loop": Record({"offset": Number(above=0)})},
    shown=False,
)
CRITERION = {"positivity": POSITIVITY, "stability": STABILITY}


def require_criterion(proof: Read, p: Loop) -> None:
    """Refuse a loop that the proof does not show to be passive, encoder and Coulomb friction aside."""
    require_nonnegative(criterion(p), proof.positivity)
    require_stable(proof.stability, p)


def criterion(p: Loop) -> list[Fraction]:
    """q(c) of the loop, times b where part > 0; ascending in c."""
    if p.part:
        return bounded_criterion(p, p.part * (1 - p.part))
    damped, hold, _ = _cosine_sums(p)
    gain = 2 * p.damping / p.period
    return [gain * x + y for x, y in zip(damped, hold, strict=True)]


def bounded_criterion(p: Loop, share: Fraction) -> list[Fraction]:
    """b q(c) with `share` in the place of α(1−α), α = part."""
    gain, b, loss = 2 * p.damping**2 / p.period, p.damping, p.period * share / 2
    return [gain * x + b * y - loss * z for x, y, z in zip(*_cosine_sums(p), strict=True)]


def _cosine_sums(p: Loop) -> tuple[list[int], list[Fraction], list[int]]:
    """|D|², −R + (1 + c) S and |N|², from Chebyshev sums; ascending in c."""
    alpha, n, d = p.part, in_whole_numbers(p.numerator, p), in_whole_numbers(p.denominator, p)
    size, longest = len(n) + len(d) + p.whole, bits((*n, *d))
    spend(size**2, longest)
    spend(2 * size**2, longest, size)
    m = [0] * p.whole + multiply(n, [alpha.denominator - alpha.numerator, alpha.numerator])
    degree = max(len(m), len(d), len(n)) - 1
    real, slope = [0] * (degree + 1), [0] * degree  # Σ of T_j, and of (1 + c) U_j
    for i, x in enumerate(m):
        for k, y in enumerate(d):
            j = i - k
            real[abs(j)] += x * y
            if j:
                slope[abs(j) - 1] -= x * y if j > 0 else -x * y
    part = in_powers(slope, 2)
    raised = [x + y for x, y in zip([*part, 0], [0, *part], strict=True)]
    hold = [y - x for x, y in zip(in_powers(real, 1), raised, strict=True)]
    weight = Fraction(1, alpha.denominator)
    return square_modulus(d, degree), [weight * x for x in hold], square_modulus(n, degree)


def require_stable(proof: Read, p: Loop) -> None:
    """Refuse a law that may be unstable, or pushes the hand on at rest."""
    if proof.kind == "open loop":
        require_stable_by_itself(p)
        return
    if p.part:
        raise Invalid("a closed-loop proof does not cover a delay of part of a sample")
    require_coprime(p)
    if not inside_unit_circle(positive_real_denominator(p, proof.offset)):
        raise Invalid("b + T z⁻ᵈ H/(z − 1) is not positive real")


def require_stable_by_itself(p: Loop) -> None:
    """Refuse H(z) with a pole that does not decay, or H(1) < 0."""
    if not inside_unit_circle(p.denominator):
        raise Invalid("H(z) has a pole outside or on the unit circle")
    if sum(p.numerator) * sum(p.denominator) < 0:
        raise Invalid("the static stiffness H(1) is negative")


def positive_real_denominator(p: Loop, offset: Fraction) -> list[Fraction]:
    """n + g d of b + T ζ^{d+1} N/((1 − ζ) D), with a common 1 − ζ cancelled."""
    top = [Fraction(0)] * (p.whole + 1) + [p.period * c for c in p.numerator]
    bottom = multiply(p.denominator, [Fraction(1), Fraction(-1)])
    sums = add(top, [(p.damping + offset) * c for c in bottom])
    if sum(p.numerator) == 0:
        running, out = Fraction(0), []
        for c in sums[:-1]:
            running += c
            out.append(running)
        return out
    return sums


def require_coprime(p: Loop) -> None:
    """Refuse H(z) with a factor that cancels."""
    if not are_coprime(in_whole_numbers(p.numerator, p), in_whole_numbers(p.denominator, p)):
        raise Invalid("numerator and denominator of H(z) have a common factor")
