"""What waves of impedance w feel like where a force acts d samples after its wave was sent: mass and spring.

    K = w/τ    against a follower that is clamped,        τ = (1 + d) T,
    M = w τ    with one that is free, besides both devices; their dampings are felt as b − w each.

A port that smooths its force over τ_s has τ_s more in τ.  (Niemeyer and Slotine 1991 have w/τ and w τ for a
continuous link; docs/theory/links.md derives these.)
"""

from __future__ import annotations

from fractions import Fraction


def one_way(late: int, period: Fraction) -> Fraction:
    """τ = (1 + d) T [s]: the hold makes one sample of it."""
    return (1 + late) * period


def felt_stiffness(impedance: Fraction, late: int, period: Fraction) -> Fraction:
    """K = w/τ [N/m; N·m/rad].

    Parameters
    ----------
    impedance
        w [N·s/m; N·m·s/rad].
    late
        d, whole samples from sending to the force that acts.
    period
        T [s].
    """
    return impedance / one_way(late, period)


def felt_mass(impedance: Fraction, late: int, period: Fraction) -> Fraction:
    """M = w τ [kg; kg·m²]; arguments as of `felt_stiffness`."""
    return impedance * one_way(late, period)
