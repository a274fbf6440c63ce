"""A law that is linear: the criterion at every frequency, for one delay or for every one of an interval."""

from __future__ import annotations

from fractions import Fraction

from ..document.fields import List, Number, OneOf, Read, Record, document, numbers
from ..document.number import SECONDS
from ..document.refusal import Invalid, only_if, spend
from ..exact.polynomial import add, are_coprime, bits, cleared, in_powers, multiply, square_modulus
from ..exact.positivity import POSITIVITY, require_nonnegative
from ..exact.roots import inside_unit_circle
from .loop import LOOP, MOST_DELAY, Loop, in_whole_numbers, loop_of, require_law

# The linear criterion as a polynomial in c = cos θ, from its definition, and the stability of the law.
#
#     2b²/T |D|² + b (−R + (1 + c) S) − (T/2) α(1 − α) |N|² ≥ 0,    ζᵈ (1 − α + α ζ) N D̄ = R + j sin θ S
#
# for a delay of d + α samples; for α = 0 without the factor b and the last term.

STABILITY = OneOf(
    "kind", {"open loop": Record({}), "closed loop": Record({"offset": Number(above=0)})}, shown=False
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
    damped, hold, _ = cosine_sums(p)
    gain = 2 * p.damping / p.period
    return [gain * x + y for x, y in zip(damped, hold, strict=True)]


def bounded_criterion(p: Loop, share: Fraction) -> list[Fraction]:
    """b q(c) with `share` in the place of α(1−α), α = part."""
    gain, b, loss = 2 * p.damping**2 / p.period, p.damping, p.period * share / 2
    return [gain * x + b * y - loss * z for x, y, z in zip(*cosine_sums(p), strict=True)]


def cosine_sums(p: Loop) -> tuple[list[int], list[Fraction], list[int]]:
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


# The encoder's error is at most Δ/2 about its middle: it moves the force by ‖h‖₁ Δ/2, which f_c must cover.
#
# ‖H‖₁ ≤ Σ|r|/(1 − |p|) + ‖R E‖₁/(|e₀| − ‖S E − e₀‖₁),    H = Σ r/(1 − p ζ) + R/S, any polynomial E


MOST_MODES = 60
NORM = Record(
    {
        "modes": List(Record({"pole": Number(above=-1, below=1), "residue": Number()}), most=MOST_MODES),
        "rest_numerator": numbers(),
        "rest_denominator": numbers(least=1),
        "inverse": numbers(least=1),
    },
    default=None,
    shown=False,
)


def require_friction(p: Loop, norm: Read) -> None:
    """Refuse a loop whose Coulomb friction does not cover its encoder."""
    if one_norm_bound(p, norm) * p.resolution > 2 * p.coulomb_friction:
        raise Invalid("the Coulomb friction is below ‖h‖₁ Δ/2")


def one_norm_bound(p: Loop, norm: Read) -> Fraction:
    """The bound that the document gives, of a sum that is shown to be H(z)."""
    top, bottom = norm.rest_numerator or [Fraction(0)], norm.rest_denominator
    bound = _of_the_rest(top, bottom, norm.inverse)
    for mode in norm.modes:
        bound += abs(mode.residue) / (1 - abs(mode.pole))
        line = [Fraction(1), -mode.pole]
        top, bottom = add(multiply(top, line), [mode.residue * c for c in bottom]), multiply(bottom, line)
    require_law(p, top, bottom, "the modes and the rest do not sum to H(z)")
    return bound


def _of_the_rest(top: list[Fraction], bottom: list[Fraction], inverse: list[Fraction]) -> Fraction:
    longest = sum(bits(cleared(part)) for part in (top, bottom, inverse))
    spend(len(inverse) * (len(top) + len(bottom)), longest)
    product = multiply(bottom, inverse)
    slack = abs(product[0]) - sum(abs(c) for c in product[1:])
    if slack <= 0:
        raise Invalid("the inverse does not bound the impulse response")
    return sum((abs(c) for c in multiply(top, inverse)), Fraction(0)) / slack


LINEAR = document({"loop": LOOP, "proof": Record(CRITERION, shown=False)})
QUANTIZED = document({"loop": LOOP, "proof": Record({**CRITERION, "norm": NORM}, shown=False)})
_PIECE = Record({"low": Number(least=0), "high": Number(), "at_low": POSITIVITY, "at_high": POSITIVITY})
DELAYS = document(
    {
        "loop": LOOP,
        "delay_high": Number(SECONDS),
        "proof": Record({"stability": STABILITY, "pieces": List(_PIECE, least=1), "norm": NORM}, shown=False),
    }
)


def linear(told: Read) -> str:
    """An ideal encoder."""
    p = loop_of(told.loop)
    if p.resolution != 0:
        raise Invalid("a linear proof covers an ideal encoder only; this one has a resolution")
    require_criterion(told.proof, p)
    return "the criterion is nonnegative at every frequency and the environment is stable"


def quantized(told: Read) -> str:
    """With the encoder's steps, which Coulomb friction covers."""
    p = loop_of(told.loop)
    require_criterion(told.proof, p)
    require_friction(p, only_if(True, told.proof.norm, "norm"))
    return "as linear, and Coulomb friction covers the largest force error of the encoder"


def delays(told: Read) -> str:
    """Every delay from the loop's own to `delay_high`, piece by piece.

    On a piece α(1−α) is at most its tangent at the middle, and with the tangent
    the criterion is affine in α: nonnegative if it is at both ends.
    """
    p, proof = loop_of(told.loop), told.proof
    if p.damping == 0 or proof.stability.kind != "open loop":
        raise Invalid("delays within an interval need damping and a law that is stable by itself")
    require_stable(proof.stability, p)
    if told.delay_high / p.period > MOST_DELAY:
        raise Invalid(f"the delay is more than {MOST_DELAY} samples")
    reached = p.whole + p.part
    for piece in proof.pieces:
        if piece.low != reached:
            raise Invalid("the pieces do not follow one another")
        reached = _piece(p, piece)
    if reached != told.delay_high / p.period:
        raise Invalid("the pieces do not cover the interval of delays")
    if only_if(p.resolution, proof.norm, "norm"):
        require_friction(p, proof.norm)
    return "the criterion is nonnegative at every frequency for every delay, and the environment is stable"


def _piece(p: Loop, piece: Read) -> Fraction:
    """How far a piece that is proved reaches [samples]."""
    high: Fraction = piece.high
    whole = piece.low // 1
    if not piece.low < high <= whole + 1:
        raise Invalid("a piece must lie within one sample")
    middle = (piece.low + high) / 2 - whole
    for end, sign in ((piece.low, piece.at_low), (high, piece.at_high)):
        part = end - whole
        tangent = middle * (1 - middle) + (1 - 2 * middle) * (part - middle)
        require_nonnegative(bounded_criterion(p._replace(whole=whole, part=part), tangent), sign)
    return high
