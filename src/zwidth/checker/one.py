"""One certificate, violation or motion, or proofs of several corners: what the checker finds of it."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any, NamedTuple

from .document.fields import Read, Row
from .document.file import read_document
from .document.refusal import EACH, Invalid, one_document, spend
from .kinds import KINDS, Found, fields_of, kind_of
from .scope import ACTIVE, Scope, weakest

STOPPED = "the checker stopped at something that it does not foresee"
"""Nothing is accepted then; a document that brings it there shows a fault of the checker."""

NO_KIND = "verify takes an object with a kind; zwidth.checker.judge a whole answer, judge_file a file"


class Verified(NamedTuple):
    """What the checker found.

    Parameters
    ----------
    valid
        True if the document proves what its kind says.
    reason
        What was proved; or why it is refused.
    energy, gain
        Of a motion: what all of it takes out, and one more round of its cycle [J]; of a port, what comes out
        above the level.
    scope
        What an accepted document is about; None of one that is refused, and of corners that show different
        things.
    rows
        The numbers that entered the proof, as they are shown.
    surplus
        Of an arm, what its joints damp beyond what the wall takes, at the middle of the region: a symmetric
        matrix, its rows from the diagonal on, to rounding [of the joints, or of the hand].
    """

    valid: bool
    reason: str
    energy: Fraction | None = None
    gain: Fraction | None = None
    scope: Scope | None = None
    rows: tuple[Row, ...] = ()
    surplus: tuple[tuple[float, ...], ...] = ()

    def __repr__(self) -> str:
        said = f"{'proved' if self.valid else 'refused'}: {self.reason}"
        return "".join(c if c.isprintable() else "?" for c in said)


def verify(document: Mapping[str, Any]) -> Verified:
    """Check one certificate, violation or motion, given as plain JSON data; never raises for what it says."""
    try:
        with one_document():
            return _verified(document)
    except Invalid as error:
        return Verified(False, str(error))
    except MemoryError:
        return Verified(False, "the document is too large to be checked")
    except (ArithmeticError, AttributeError, LookupError, RecursionError, TypeError, ValueError) as error:
        return Verified(False, f"{STOPPED}: {type(error).__name__}: {str(error)[:200]}")


def _verified(document: Mapping[str, Any]) -> Verified:
    spend(EACH)
    if not isinstance(document, Mapping) or "kind" not in document:
        raise Invalid(NO_KIND)
    if document.get("kind") == "corners":
        found, covered, (told, motion) = corners(document)
    else:
        told, motion = read_document(fields_of(kind_of(document)), document)
        found = KINDS[told.kind].check(told)
        covered = KINDS[told.kind].scope(told) if found.valid else None
    rows = tuple(fields_of(told.kind).rows("", told, motion)) if found.valid else ()
    return Verified(found.valid, found.reason, found.energy, found.gain, covered, rows, found.surplus)


# Proofs of several loops, one for every corner of the values that parameters may have.
#
# A corner is proved by itself.  What lies between is proved with them where all are one law but for N: with
# the same D, T, delay and device the criterion 2b/T |D|² + h(N) is affine in N, or with a delay of part of a
# sample concave; ‖h‖₁ is convex and H(1) affine.  So it holds for every mix of their laws.  The conditions of
# `contact`, ½(Q + √(Q² + α(1 − α) S²)) with Q = (2d + 1 + 2α) K T/2 + |B| Σ|w| and S = K T + 2 |B| Σ|w|, and
# K + |B| ‖h_v‖₁, are convex in (K, B) for the same weights.


MOST_CORNERS = 4096
_MIXED = ("spring", "linear", "quantized", "contact")


def corners(document: Mapping[str, Any]) -> tuple[Found, Scope | None, tuple[Read, str]]:
    """Whether every corner is proved; what they cover together; the first of them, and its motion."""
    listed = document.get("corners")
    if set(document) - {"format", "kind", "corners"}:
        raise Invalid("entries that no proof of this kind has beside corners")
    if not isinstance(listed, list) or not 1 <= len(listed) <= MOST_CORNERS:
        raise Invalid(f"corners must be a list of 1 to {MOST_CORNERS} certificates")
    reasons, scopes, told, claimed = [], [], [], []
    for corner in listed:
        spend(EACH)
        if not isinstance(corner, Mapping):
            raise Invalid("a corner must be a certificate")
        kind = kind_of(corner)
        read, motion = read_document(fields_of(kind), corner)
        found, covered = KINDS[kind].check(read), KINDS[kind].scope(read)
        if found.energy is not None or covered.shows == ACTIVE:
            raise Invalid("a corner must be a proof, and is evidence against one")
        reasons.append(found.reason)
        scopes.append(covered)
        told.append((read, motion))
        shown = (name for name, field in KINDS[kind].fields.fields.items() if field.shown)
        claimed.append((kind, *(_frozen(getattr(read, name)) for name in shown)))
    if len(set(claimed)) < len(claimed):
        raise Invalid("the same corner is given twice")
    between = "and every mix of their laws" if _are_mixed([read for read, _ in told]) else _BETWEEN
    reason = f"all {len(listed)} corners: {'; or '.join(dict.fromkeys(reasons))}; {between}"
    return Found(reason), weakest(scopes), told[0]


def _frozen(value: Any) -> Any:
    """What a corner says, every digit of it, in a form that can be compared."""
    if isinstance(value, Read):
        return tuple((name, _frozen(inner)) for name, inner in vars(value).items())
    return tuple(map(_frozen, value)) if isinstance(value, list) else value


_BETWEEN = "nothing is said of what lies between them"


def _are_mixed(told: list[Read]) -> bool:
    """True where every mix of the laws is proved with them."""
    first = told[0]
    return first.kind in _MIXED and all(
        other.kind == first.kind and _is_one_device(first, other) and _is_one_denominator(first, other)
        for other in told
    )


def _is_one_device(first: Read, other: Read) -> bool:
    names = ("damping", "coulomb_friction", "resolution", "sample_period", "delay", "unilateral")
    same = all(getattr(first.loop, name) == getattr(other.loop, name) for name in names)
    weights = [getattr(getattr(read, "law", None), "weights", None) for read in (first, other)]
    return same and weights[0] == weights[1] and first.units == other.units


def _is_one_denominator(first: Read, other: Read) -> bool:
    a, b = first.loop.denominator, other.loop.denominator
    return len(a) == len(b) and all(x * b[0] == y * a[0] for x, y in zip(a, b, strict=True))
