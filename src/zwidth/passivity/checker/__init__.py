"""The independent checker: re-proves a certificate, recomputes a witness.

Written from the mathematics alone, in the standard library alone, with other
algorithms than the prover's: Chebyshev sums for the criterion, Bernstein
coefficients for its sign, Routh's table for stability, a plain recursion for
the energy of a motion.  It imports nothing else of zwidth, on purpose: keep it so.

Everything is exact: numbers are integers, or text such as "3/20" and "0.15".
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any, NamedTuple

from .contact_proof import contact
from .motions import motion_energy, stored_at_start
from .proofs import PROOFS
from .reading import Invalid, get, number

__all__ = ["Verification", "verify"]

_KINDS = {**PROOFS, "contact": contact}


class Verification(NamedTuple):
    """What the checker found: whether the document holds, why, and a motion's joules."""

    valid: bool
    reason: str
    energy: Fraction | None = None


def verify(document: Mapping[str, Any]) -> Verification:
    """Check one certificate or witness, given as plain JSON data."""
    try:
        kind = get(document, "kind")
        if kind == "motion":
            return _motion(document)
        if not isinstance(kind, str) or kind not in _KINDS:
            raise Invalid(f"kind must be motion, {', '.join(_KINDS)}; got {str(kind)[:40]!r}")
        return Verification(True, _KINDS[kind](document))
    except Invalid as error:
        return Verification(False, str(error))
    except (TypeError, KeyError, ValueError, IndexError, OverflowError, ZeroDivisionError) as error:
        return Verification(False, f"the document is malformed: {str(error)[:200]}")


def _motion(document: Mapping[str, Any]) -> Verification:
    """A motion is a witness if more energy comes out than was in, and as much as it says."""
    energy, stored = motion_energy(document), stored_at_start(document)
    claimed = number(get(document, "energy_J"))
    if energy <= stored:
        reason = (
            f"the motion extracts {float(energy):g} J, no more than the {float(stored):g} J stored before"
        )
        return Verification(False, reason, energy)
    if abs(claimed - energy) > abs(energy) / 10**9:
        return Verification(False, f"the energy is {float(energy):g} J, not {float(claimed):g} J", energy)
    return Verification(True, f"the motion extracts {float(energy):g} J", energy)
