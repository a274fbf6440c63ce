"""A port of waves with a ledger: it credits no more than the device loses, in counts and rounded numbers.

    w(d, n) = b d²/(n T) + f_c |d|        lost at least on a way d in n samples, losses of parts added
    R ← R + e                             energy that the other end has sent and that is counted once
    κ (|f| − φ)₊² + |f| δ + c ≤ R         for the force of a sample, κ = τ/(4β), f⁻ the one before,
                                          c = ½ δ (|f| − |f⁻| + |f − f⁻|); held back until f has acted
    R ← R − f N δ − c + V_k − V_{k−1} − (what is sent),   N counts read,  s = (|N| − 1)₊ δ over n samples,
    V_k = max(V_{k−1}, V_{k−n} + β s²/(n τ) + φ s)

The port computes this with its own β, φ, δ, τ.  The way is N Δ + e_{k+1} − e_k with |e| ≤ Δ/2, so that
forces have given Σ f N Δ + Σ c at most; friction has taken V at least; and R ≥ 0, as for y = |N| Δ no reading
costs more than |f| y − w(y − Δ, 1) ≤ (T/4b) (|f| − f_c)₊² + |f| Δ.  So the hand has put in R + (sent) −
(counted) at least, at each end, which for both ends of a link that makes up no packets is never below 0, if

    β ≤ b,  φ ≤ f_c,  τ ≥ T,  |δ − Δ| ≤ u Δ,  the delay is whole samples.

Rounding, relative errors of at most u in each operation: every sum of energies is lowered by ε times the size
of all that is summed, every bound on f by μ times itself.  Forces and energies may be any numbers.
"""

from __future__ import annotations

from ..document.fields import Number, Read, Record, document
from ..document.refusal import Invalid
from ..document.unit import DAMPING, FORCE, LENGTH, SECONDS
from .loop import DEVICE

WAVE_PORT = document(
    {
        "loop": Record(DEVICE),
        "law": Record(
            {
                "damping": Number(DAMPING, least=0),  # β
                "friction": Number(FORCE, least=0),  # φ
                "count": Number(LENGTH, least=0),  # δ
                "period": Number(SECONDS, above=0),  # τ
                "hair": Number(least=0, below=1),  # ε
                "margin": Number(least=0, below=1),  # μ
                "roundoff": Number(least=0, below=1),  # u
            }
        ),
    }
)

MOST_ROUNDINGS = 24
"""Of one term, from the numbers of the port to the sum that it ends in."""


def wave_port(told: Read) -> str:
    """Say what was proved."""
    loop, law = told.loop, told.law
    if loop.delay % loop.sample_period != 0:
        raise Invalid("two forces share a sample: the port is proved for delays of whole samples")
    if law.damping > loop.damping or law.period < loop.sample_period:
        raise Invalid("the port credits more damping than the device has")
    if law.friction > loop.coulomb_friction:
        raise Invalid("the port credits more Coulomb friction than the device has")
    if abs(law.count - loop.resolution) > law.roundoff * loop.resolution:
        raise Invalid("the count that the port reckons with is not the encoder's")
    _energies_are_rounded_down(law)
    _forces_are_rounded_down(law)
    return (
        "friction takes at least what the ledger credits, and no force gives more than it holds: over every "
        "link that makes up no packets two such ports give out no energy"
    )


def _energies_are_rounded_down(law: Read) -> None:
    """The ledger that is kept is not above the one that was proved.

    Relative errors of the terms, (1 + u)ⁿ − 1.  β s²/(n τ) + φ s: s = (|N| − 1) δ is rounded in δ and in a
    product; a product with β, the quotients, the sum, a product with s and its own two again, 9, and 3 for V
    and its lowering; the difference of two V, and its sum with R, 2 more: 14.  f N δ: δ, two products: 3, c:
    8.  The three sums of them: 3, the product with ε and the sums in it: 5.  None above 24; and what is taken
    off is computed too small by 24 at most.
    """
    u = law.roundoff
    if (1 + u) ** MOST_ROUNDINGS - 1 > law.hair * (1 - u) ** MOST_ROUNDINGS:
        raise Invalid("what is taken off the energy does not pay for its rounding")


def _forces_are_rounded_down(law: Read) -> None:
    """κ (|f| − φ)₊² + |f| δ + c is convex in |f| and 0 at 0: a part μ less of |f| costs that much less.

    |f| = φ + 2 S/(σ + √(σ² + 4 κ S)) with S = R + δ |f⁻| − σ φ, σ = δ or 2 δ: rounded at most 24 times, as
    is what it costs.
    """
    if (1 - law.margin) * (1 + law.roundoff) ** MOST_ROUNDINGS > 1:
        raise Invalid("what is taken off the force does not pay for its rounding")
