"""The independent checker: re-proves a certificate or a violation, recomputes a witness.

Written from the mathematics alone, with other algorithms than the prover's: Chebyshev sums for the criterion,
Bernstein coefficients for its sign, Routh's table for stability, Schur and Cohn's recursion where a hand is
known, a plain recursion for the energy of a motion, every move one by one for a storage function.  The
standard library does for all but the last, whose many moves need numpy and numba.  It imports nothing else of
zwidth, on purpose: keep it so.

Everything is exact, or enclosed where e^A comes in: numbers are integers, or text such as "3/20" and "0.15".
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from itertools import islice
from typing import Any, NamedTuple

from .arm.region import arm
from .contact.damped_wall import contact
from .contact.motion import contact_motion_energy
from .contact.multiplier import multiplier_contact
from .contact.relaxing import relaxing_contact
from .contact.row_motion import row_motion_energy
from .contact.touching_motion import touching_motion_energy
from .document.effort import one_document
from .document.reading import Invalid, get, number, quantity
from .document.watched import watched
from .known_hand.absolute import absolute
from .known_hand.rest import instability, stability
from .known_hand.vibration import vibration
from .loop.active_hand import active_hand
from .loop.force_bounding import force_bounding
from .loop.motion import motion_energy, stored_at_start
from .loop.nonlinear_spring import endless_pull, nonlinear_spring
from .loop.proofs import PROOFS
from .loop.slow_hands import slow_hands
from .loop.violation import violation
from .port.index import extraction, positive_real
from .port.matrix import positive_real_matrix
from .port.matrix_motion import matrix_extraction
from .scope import Scope, scope_of
from .storage.board import storage
from .storage.coarse import coarse_storage
from .storage.row import storage_of_row

__all__ = ["Scope", "Verification", "verify"]

_KINDS = {
    **PROOFS,
    "absolute stability": absolute,
    "active hand": active_hand,
    "arm": arm,
    "coarse storage": coarse_storage,
    "contact": contact,
    "relaxing contact": relaxing_contact,
    "endless pull": endless_pull,
    "force bounding": force_bounding,
    "instability": instability,
    "multiplier contact": multiplier_contact,
    "nonlinear spring": nonlinear_spring,
    "positive real": positive_real,
    "positive real matrix": positive_real_matrix,
    "slow hands": slow_hands,
    "stability": stability,
    "storage": storage,
    "row storage": storage_of_row,
    "vibration": vibration,
    "violation": violation,
}


class Verification(NamedTuple):
    """What the checker found: whether the document holds, why, a motion's joules, and what it is about."""

    valid: bool
    reason: str
    energy: Fraction | None = None
    scope: Scope | None = None


def verify(document: Mapping[str, Any]) -> Verification:
    """Check one certificate, violation or witness, given as plain JSON data."""
    try:
        read = watched(document)
        with one_document():
            found = _verified(read)
        if found.valid:
            _require_read(read)
        return found._replace(scope=scope_of(document)) if found.valid else found
    except Invalid as error:
        return Verification(False, str(error))
    except (TypeError, KeyError, ValueError, IndexError, OverflowError, ZeroDivisionError) as error:
        return Verification(False, f"the document is malformed: {str(error)[:200]}")


def _require_read(document: Any) -> None:
    """What nobody read would be taken for a part of what is proved."""
    unread = [path[:60] for path in islice(document.unread(), 4)]
    if unread:
        raise Invalid(f"entries that no proof of this kind has: {', '.join(unread)}")


def _verified(document: Mapping[str, Any]) -> Verification:
    kind = get(document, "kind")
    if kind == "motion":
        return _motion(document, motion_energy(document), stored_at_start(document))
    if kind == "touching motion":
        return _motion(document, touching_motion_energy(document), Fraction(0))
    if kind == "contact motion":
        return _round_again(document, contact_motion_energy(document))
    if kind == "row motion":
        return _round_again(document, row_motion_energy(document))
    if kind == "extraction":
        return Verification(True, *extraction(document))
    if kind == "matrix extraction":
        return Verification(True, *matrix_extraction(document))
    if not isinstance(kind, str) or kind not in _KINDS:
        raise Invalid(f"kind must be motion, extraction, {', '.join(_KINDS)}; got {str(kind)[:40]!r}")
    return Verification(True, _KINDS[kind](document))


def _motion(document: Mapping[str, Any], energy: Fraction, stored: Fraction) -> Verification:
    """A motion is a witness if more energy comes out than was in, and as much as it says."""
    if energy <= stored:
        reason = (
            f"the motion extracts {float(energy):g} J, no more than the {float(stored):g} J stored before"
        )
        return Verification(False, reason, energy)
    return _as_told(document, energy) or Verification(
        True, f"the motion extracts {float(energy):g} J", energy
    )


def _as_told(document: Mapping[str, Any], energy: Fraction) -> Verification | None:
    """Why the energy, or the sample period beside the motion, is not the one that is told; None if it is."""
    claimed = number(get(document, "energy_J"))
    if abs(claimed - energy) > abs(energy) / 10**9:
        return Verification(False, f"the energy is {float(energy):g} J, not {float(claimed):g} J", energy)
    if "sample_period_s" in document:
        told, period = (quantity(table, "sample_period") for table in (document, get(document, "loop")))
        if told != period:
            return Verification(False, f"T is {float(period):g} s, not {float(told):g} s", energy)
    return None


def _round_again(document: Mapping[str, Any], found: tuple[Fraction, Fraction]) -> Verification:
    """A motion that gains in all, and gains again with every further round."""
    energy, gain = found
    if energy <= 0 or gain <= 0:
        less = min(energy, gain)
        return Verification(False, f"the motion extracts {float(less):g} J: none comes out", energy)
    reason = f"the motion extracts {float(energy):g} J, and {float(gain):g} J more with each round"
    return _as_told(document, energy) or Verification(True, reason, energy)
