"""A law that is linear: the criterion at every frequency, for one delay or for every one of an interval."""

from __future__ import annotations

from fractions import Fraction

from ..document.fields import List, Number, Read, Record, document, only_if
from ..document.refusal import Invalid
from ..document.unit import SECONDS
from ..exact.positivity import POSITIVITY, require_nonnegative
from .criterion import CRITERION, STABILITY, bounded_criterion, require_criterion, require_stable
from .loop import LOOP, MOST_DELAY, Loop, loop_of
from .one_norm import NORM, require_friction

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
