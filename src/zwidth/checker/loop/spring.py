"""A spring: the closed condition, with contact made and broken.

    b² − b (KT/2)(2d + 1 + 2α) ≥ (T²/4) α(1 − α) K²    and    2 f_c ≥ K Δ,    K ≥ 0

V = ½ K (x − Δ/2)² inside is a storage function when there is no delay; each held or delayed force differs
from its gradient by what b and f_c absorb.
"""

from __future__ import annotations

from ..document.fields import Read, document
from ..document.number import about
from ..document.refusal import Invalid
from .loop import LOOP, loop_of

SPRING = document({"loop": LOOP})


def spring(told: Read) -> str:
    """Say what was proved."""
    p = loop_of(told.loop)
    if any(p.numerator[1:]) or any(p.denominator[1:]):
        raise Invalid("the law is not a spring: H(z) is not constant")
    k = p.numerator[0] / p.denominator[0]
    if k < 0:
        raise Invalid(f"the stiffness is negative: {about(k)}")
    reach = k * p.period / 2 * (2 * p.whole + 1 + 2 * p.part)
    inside = p.period**2 / 4 * p.part * (1 - p.part) * k**2
    if p.damping < reach or p.damping * (p.damping - reach) < inside:
        raise Invalid("the damping is below what the hold and the delay of this spring need")
    if 2 * p.coulomb_friction < k * p.resolution:
        raise Invalid("the Coulomb friction is below half a count of this spring, K Δ/2")
    return "2b/T with delay and 2 f_c/Δ both admit this stiffness"
