"""Ports that send waves of an impedance w and keep no ledger: what they share, both kinds, how they feel."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import sqrt
from typing import ClassVar

from zwidth.errors import InputError
from zwidth.links.memory import (
    ACTING,
    COULOMB,
    DAMPING,
    ENERGY,
    FRESH,
    HEARD_WAVE,
    NUMBER,
    OWN_NUMBERS,
    OWN_STATE,
    PERIOD,
    POSITION,
    RESOLUTION,
    WAVE,
    apply,
)
from zwidth.links.port import Port
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import Exact, ends
from zwidth.quantity.parameter import CertainOrNone, parameter


@dataclass(frozen=True)
class Waves(Port):
    """A port that sends waves of impedance w."""

    impedance: CertainOrNone = parameter(
        "wave_impedance", None, kept=Exact, bound="> 0", why="a wave of no impedance carries no force"
    )

    def complete(self) -> None:
        """Where no impedance is given it is the device's damping."""
        if self.impedance is None:
            damping = ends(self.device.damping)[0]
            if damping == 0:
                raise InputError(
                    "impedance must be > 0, got none and a device without damping, whose own is the default: "
                    "a passive port needs damping in the device; give impedance where another law is tried"
                )
            self._keep(impedance=Exact(damping))

    def telling_ways(self) -> list[float]:
        """Quick enough, where w > b, that (w − b) Δx²/T is twice what Coulomb friction takes."""
        p = self.numbers
        more = p[OWN_NUMBERS] - p[DAMPING]
        quick = [2.0 * p[COULOMB] * p[PERIOD] / more] if more > 0 else []
        return [*super().telling_ways(), *quick]


# Held waves, the device's own damping as the matched damper:
#
#     f = 2 √(w/T) a,    u = √(w/T) Δx − a,    u² = a² − f Δx + (w/T) Δx²        (waves in √J)
#
# Passive whatever the link does if w ≤ b and the displacement is read exactly; else a hand takes energy out,
# whatever Coulomb friction there is (docs/theory/pairs.md).


HELD_WAVES = 2.0

_IMPEDANCE = OWN_NUMBERS


@compiled
def held_force(p: Array, s: Array) -> float:
    """The force of the newest wave, used once; of a packet that is missing none."""
    root = sqrt(p[_IMPEDANCE] / p[PERIOD])
    received = s[HEARD_WAVE] if s[FRESH] > 0.0 else 0.0
    s[FRESH] = 0.0
    return apply(p, s, 2.0 * root * received)


@compiled
def held_send(p: Array, s: Array, moved: float) -> None:
    """The wave that goes back."""
    root = sqrt(p[_IMPEDANCE] / p[PERIOD])
    wave = root * moved - s[ACTING] / (2.0 * root)
    s[WAVE] = wave
    s[ENERGY] += wave * wave
    s[POSITION] += wave / root
    s[NUMBER] += 1.0


@dataclass(frozen=True)
class HeldWaves(Waves):
    """Waves without a ledger, ``f = 2 √(w/T) a``, ``u = √(w/T) Δx − a``: each packet's wave used once.

    Parameters
    ----------
    device
        What the port drives.
    impedance
        w > 0 [N·s/m; N·m·s/rad]; None: the device's damping.
    """

    title: ClassVar[str] = "waves without a ledger"
    code: ClassVar[float] = HELD_WAVES
    steps: ClassVar = (held_force, held_send)

    @property
    def theorem(self) -> str:
        """w ≤ b, and nothing is rounded off the displacement."""
        w = self.impedance  # the damping where none was given
        if w is None or Exact(w).fraction > ends(self.device.damping)[0] or self.numbers[RESOLUTION] > 0:
            return ""
        return "w ≤ b: in every period the device's damping takes what the hold feeds"


# Textbook waves, sampled as they stand:
#
#     f = √(2w) ν − w v,    u = √(2w) v − ν,    v = (x_k − x_{k−1})/T
#
# In continuous time that is passive for every delay (Anderson and Spong 1989; Niemeyer and Slotine 1991).
# Sampled it is not: the hold gives out energy, and the computed damper w is late by half a period and more.


NAIVE_WAVES = 3.0

_MOVED, _NEXT = OWN_STATE, OWN_STATE + 1
"""The displacement of the last period, and the wave that was computed with it."""


@compiled
def naive_force(p: Array, s: Array) -> float:
    """Of the newest wave, used once, less that of the computed damper."""
    root = sqrt(p[_IMPEDANCE] / p[PERIOD])
    received = s[HEARD_WAVE] if s[FRESH] > 0.0 else 0.0
    s[FRESH] = 0.0
    s[_NEXT] = root * s[_MOVED] - received
    return apply(p, s, 2.0 * root * received - root * root * s[_MOVED])


@compiled
def naive_send(p: Array, s: Array, moved: float) -> None:
    """The wave of the sample; the displacement is for the next."""
    root = sqrt(p[_IMPEDANCE] / p[PERIOD])
    wave = s[_NEXT]
    s[_MOVED], s[WAVE] = moved, wave
    s[ENERGY] += wave * wave
    s[POSITION] += wave / root
    s[NUMBER] += 1.0


@dataclass(frozen=True)
class NaiveWaves(Waves):
    """Wave variables of the textbook, ``f = √(2w) ν − w v`` with a backward difference: not passive.

    Parameters
    ----------
    device
        What the port drives.
    impedance
        w > 0 [N·s/m; N·m·s/rad]; None: the device's damping.
    """

    title: ClassVar[str] = "textbook waves"
    code: ClassVar[float] = NAIVE_WAVES
    steps: ClassVar = (naive_force, naive_send)


# What waves of impedance w feel like where a force acts d samples after its wave was sent: mass and spring.
#
#     K = w/τ    against a follower that is clamped,        τ = (1 + d) T,
#     M = w τ    with one that is free, besides both devices; their dampings are felt as b − w each.
#
# A port that smooths its force over τ_s has τ_s more in τ.  (Niemeyer and Slotine 1991 have w/τ and w τ for a
# continuous link; docs/theory/pairs.md derives these.)


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
