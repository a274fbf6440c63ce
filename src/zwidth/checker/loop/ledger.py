"""Laws that keep an account of energy, in counts and rounded numbers: force bounding, and a port of waves."""

from __future__ import annotations

from fractions import Fraction
from typing import NamedTuple

from ..document.fields import Number, Read, Record, document
from ..document.number import DAMPING, FORCE, LENGTH, SECONDS, STIFFNESS
from ..document.refusal import Invalid
from .loop import DEVICE

# Force bounding: what the law credits is what the device loses, in whole counts and in rounded numbers.
#
#     w(d) = (b/T) d² + f_c |d|            lost at least, in a move d of one sample, beside f d
#     V(x) ≥ E + g (x − c), |x − c| ≤ Δ/2  what the hand has put in when it is at x, in the count around c
#
#     E' = E + g' D − κ (|g' − f| − φ)₊² − |g' − g| δ/2,  κ = 1/(4β)
#     |f'| ≤ φ + 2 √(β S) − h,             S = E' − |g'| δ/2; E' = g' = 0 where S would be < 0
#
# The law computes the last two lines with its own β, φ, δ and h, any g', and readings D apart.
# Its line is below V for ever, and V ≥ 0, if for all d, ψ and x, each of which is checked here,
#
#     w(d) ≥ ψ d − κ (|ψ| − φ)₊²           a move gives back no more than the line says
#     (g − g') (x − c) ≥ −|g' − g| δ/2     wherever in its count the hand was
#     f² ≤ (φ + 2 √(β S))²  ⇒  f d + w(d) + S ≥ 0,  the converter's half step within h
#
# Rounding, relative errors of at most u in each operation: E' is lowered by ε times the size of all that is
# summed, S and the bound by ε of theirs.  Forces, energies and readings may be any numbers.

FORCE_BOUNDING = document(
    {
        "loop": Record({**DEVICE, "force_resolution": Number(FORCE, least=0)}),
        "law": Record(
            {
                "credit": Number(STIFFNESS, above=0),  # β
                "friction": Number(FORCE, least=0),  # φ
                "count": Number(LENGTH, least=0),  # δ
                "half_step": Number(FORCE, least=0),  # h
                "hair": Number(least=0, below=1),  # ε
                "roundoff": Number(least=0, below=1),  # u
            }
        ),
    }
)


class _Device(NamedTuple):
    rate: Fraction  # b/T
    friction: Fraction  # f_c
    resolution: Fraction  # Δ
    step: Fraction  # ΔF


def force_bounding(told: Read) -> str:
    """Say what was proved."""
    device, law = _device(told.loop), told.law
    _moves_are_paid(device, law)
    _counts_are_covered(device, law)
    _bound_is_paid(device, law)
    _lines_are_rounded_down(law)
    return (
        "friction takes at least what force bounding credits, at any position within a count and for moves "
        f"of any length, rounding by {float(law.roundoff):.3g} of a number paid, contact made and broken"
    )


def _device(loop: Read) -> _Device:
    if loop.delay != 0:
        raise Invalid("the force is applied late: the credit of a move would come before its cost")
    rate = loop.damping / loop.sample_period
    return _Device(rate, loop.coulomb_friction, loop.resolution, loop.force_resolution)


def _moves_are_paid(device: _Device, law: Read) -> None:
    """w(d) − ψ d + κ (|ψ| − φ)₊² ≥ 0 for all d and ψ.

    Both signs alike, so ψ ≥ 0, and d ≥ 0 is the worse.  Up to ψ = φ (1 + u), which rounding may take for φ,
    the friction pays; beyond, with y = ψ − φ ≥ 0, it is (f_c − φ) d + [(b/T) d² − y d + κ y²], and the
    bracket is a quadratic form that is ≥ 0 exactly if its determinant is.
    """
    if law.friction * (1 + law.roundoff) > device.friction:
        raise Invalid("the law must credit less Coulomb friction than the device has, by a rounding at least")
    kappa = 1 / (4 * law.credit)
    if device.rate * kappa - Fraction(1, 4) < 0:
        raise Invalid("the law credits more than b/T for a move")


def _counts_are_covered(device: _Device, law: Read) -> None:
    """(g − g') (x − c) + |g' − g| δ/2 ≥ 0: a line in x, so at both ends of the count; of either sign."""
    for end in (-device.resolution / 2, device.resolution / 2):
        for turned in (-1, 1):
            if turned * end + law.count / 2 < 0:
                raise Invalid("the count that the law reckons with is smaller than the encoder's")


def _bound_is_paid(device: _Device, law: Read) -> None:
    """f d + w(d) + S ≥ 0 for |f| ≤ φ + y, y² = 4 β S: S = κ y², and so the first inequality with ψ = −f.

    What is left is the converter: a command of 0 stays 0, and any other is rounded by ΔF/2 at most.
    """
    if law.half_step < device.step / 2:
        raise Invalid("the converter adds half a step, and the bound leaves less")


def _lines_are_rounded_down(law: Read) -> None:
    """The line that is kept is not above the one that was proved.

    Relative errors of the terms, (1 + u)ⁿ − 1: E, added to three times: n = 3.  g' D, of two readings that
    are counts times Δ, both rounded, their difference, the product, the sums: 2 + 1 + 1 + 3 = 7.  κ (…)₊²,
    with two roundings before it is squared, a product and a quotient, against |g' − f| + φ: 4 + 2 + 2 = 8.
    |g' − g| δ/2: 2 + 1 = 3.  One more as ε M is taken off: all together at most 9, of M, the sum of their
    sizes.  M itself is computed too small by 9 roundings at most, its readings by 2, ε M by 2 more.

    Neither is the bound.  In (1 − ε) (φ + 2 √(β S)) − h the product below the root, the root, the sum, the
    product with 1 − ε and the difference are rounded; then the converter's step, its quotient, the sum with ½
    and the product with the step: 9 in all, the first halved by the root.  With v = (1 + u)⁹ − 1 ≤ ε < 1 that
    is (1 − ε) (1 + u)⁹ ≤ 1 − v² at most.  In (1 − ε) E − (1 + ε) |g| δ/2 E is rounded twice, |g| δ/2 at least
    twice, and (1 + ε) (1 − u)² ≥ (1 + u)⁷ (1 − u²)² ≥ 1, as v < 1 needs u < 1/12.
    """
    u = law.roundoff
    if (1 + u) ** 9 - 1 > law.hair * (1 - u) ** 13:
        raise Invalid("what is taken off the energy does not pay for its rounding")


# A port of waves with a ledger: it credits no more than the device loses, in counts and rounded numbers.
#
#     w(d, n) = b d²/(n T) + f_c |d|        lost at least on a way d in n samples, losses of parts added
#     R ← R + e                             energy that the other end has sent and that is counted once
#     κ (|f| − φ)₊² + |f| δ + c ≤ R         for the force of a sample, κ = τ/(4β), f⁻ the one before,
#                                           c = ½ δ (|f| − |f⁻| + |f − f⁻|); held back until f has acted
#     R ← R − f N δ − c + V_k − V_{k−1} − (what is sent),   N counts read,  s = (|N| − 1)₊ δ over n samples,
#     V_k = max(V_{k−1}, V_{k−n} + β s²/(n τ) + φ s)
#
# The port computes this with its own β, φ, δ, τ.  The way is N Δ + e_{k+1} − e_k with |e| ≤ Δ/2, so that
# forces have given Σ f N Δ + Σ c at most; friction has taken V at least; and R ≥ 0, as for y = |N| Δ no
# reading costs more than |f| y − w(y − Δ, 1) ≤ (T/4b) (|f| − f_c)₊² + |f| Δ.  So the hand has put in R +
# (sent) − (counted) at least, at each end, which for both ends of a link that makes up no packets is never
# below 0, if
#
#     β ≤ b,  φ ≤ f_c,  τ ≥ T,  |δ − Δ| ≤ u Δ,  the delay is whole samples.
#
# Rounding, relative errors of at most u in each operation: every sum of energies is lowered by ε times the
# size of all that is summed, every bound on f by μ times itself.  Forces and energies may be any numbers.


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
