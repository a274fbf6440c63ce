"""Passivity observer and controller in parallel: for a display that reads a force and commands a velocity.

Observer, in the energy that the hand has put in, φ_k the force that was read and u_k the velocity that was
held from sample k on (sampled: exact where φ_k is the mean force of the interval before k):

    E_k = E_{k−1} + T φ_k u_{k−1}

Controller, φ_k taken for the force to come, v_k the velocity of the body that is rendered:

    lack = −(E_k + T φ_k v_k)
    u_k = v_k + β φ_k,   β = lack/(T φ_k²)    where lack > 0,  β ≤ β_max and β |φ_k| ≤ V

Published by Hannaford & Ryu (2002), with the observer that pairs φ_{k−1} with u_{k−1}.
It is the series controller with force and velocity exchanged.

Without β_max a hand takes out what it likes: the velocity that a small force asks for is held against
a large one.  With it, it takes out of the controller β_max T Σ |φ_k φ_{k+1}| at most.  By default
β_max = T/(2M), M the mass of the body: as much as sampling the body itself leaks, (T/2M) T Σ φ².
Derived: docs, "Displays of admittance".
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from zwidth.model.rendering.passivity_controller import NO_LIMIT, UNLIMITED, WHY_A_LIMIT, Limit, said
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.glossary import Quantity
from zwidth.quantity.parameter import Certain, CertainOrNone, Parametric, Reads, exact, flag, parameter, word

_PERIOD, _MOBILITY, _VELOCITY, _FLOOR, _PUBLISHED, _RESETS, _CEILING = range(7)
ENERGY, HELD, BEFORE = range(3)

STATE_SIZE = 3
"""Numbers that it remembers."""


@dataclass(frozen=True, kw_only=True)
class ParallelController(Parametric):
    """Passivity observer and controller in parallel, ``v ← v − (E + T φ v)/(T φ)`` where that dissipates.

    Parameters
    ----------
    observer
        "sampled": the held velocity is paired with the reading at its end, exact behind a sensor that
        reads the mean force.  "published": with the reading at its beginning (Hannaford & Ryu 2002),
        which takes the leak of the hold for dissipation.
    largest_mobility
        β_max, the mobility that the controller adds at most [m/(N·s)]; None: T/(2M) of the body.
        "unlimited": no limit, as published; a hand can then take out any energy.
    largest_velocity
        V, what it adds at most [m/s]; None: no limit but β_max.  What it cannot pay is carried over.
    weakest
        Force up to which it does nothing [N]: there it would take a large velocity to pay.
    resets
        True to set the energy to 0 where the force is `weakest` or less: the hand then begins each
        touch without credit from the one before, and without debts.
    ceiling
        Energy above which no credit is kept [J], ≥ 0; None: all is kept.

    Raises
    ------
    InputError
        If a number is not positive, or a word is not one of these.
    """

    observer: Literal["sampled", "published"] = word("sampled", "published")
    largest_mobility: Reads[Limit, RealLike | None] = parameter(
        Quantity("mobility", "β", "m/N/s", "rad/N/m/s", "β_max, what it adds at most"),
        None,
        kept=Exact,
        bound="> 0",
        why=WHY_A_LIMIT,
        words=(UNLIMITED,),
    )
    largest_velocity: CertainOrNone = exact(
        "speed", None, "> 0", "it limits what the controller adds; None: none"
    )
    weakest: Certain = exact("force", 0, "≥ 0", "it is a force up to which nothing is added")
    resets: bool = flag("to count anew in each touch", False)
    ceiling: CertainOrNone = exact("energy", None, "≥ 0", "it is the energy that is kept at most")

    def numbers(self, period: float, mass: float) -> list[float]:
        """As the step reads them; the period in s, the mass of the body in kg."""
        return [
            period,
            self._mobility(period, mass),
            _or_none(self.largest_velocity),
            float(self.weakest),
            float(self.observer == "published"),
            float(self.resets),
            _or_none(self.ceiling),
        ]

    def _mobility(self, period: float, mass: float) -> float:
        if self.largest_mobility == UNLIMITED:
            return NO_LIMIT
        return period / (2 * mass) if self.largest_mobility is None else float(self.largest_mobility)

    def describe(self) -> str:
        """The law with its numbers, in a few words."""
        parts = [f"{self.observer} observer", said(self, "largest_mobility", "T/(2M) of the body")]
        if self.largest_velocity is not None:
            parts.append(f"at most {self.with_unit('largest_velocity')}")
        parts += ["resets"] if self.resets else []
        return f"parallel passivity controller ({', '.join(parts)})"


def observer_only(period: float) -> list[float]:
    """The numbers of a controller that counts as "sampled" does, and adds nothing."""
    return [period, 0.0, 0.0, NO_LIMIT, 0.0, 0.0, NO_LIMIT]


def _or_none(value: Exact | None) -> float:
    return NO_LIMIT if value is None else float(value)


@compiled
def step(p: Array, s: Array, reading: float, velocity: float) -> float:
    """One sample: the velocity to be held."""
    energy = s[ENERGY] + p[_PERIOD] * (s[BEFORE] if p[_PUBLISHED] > 0.0 else reading) * s[HELD]
    size = abs(reading)
    if p[_RESETS] > 0.0 and size <= p[_FLOOR]:
        energy = 0.0
    energy = min(energy, p[_CEILING])
    lack = -(energy + p[_PERIOD] * reading * velocity)
    held = velocity
    if lack > 0.0 and size > p[_FLOOR]:
        added = min(lack / (p[_PERIOD] * size), p[_MOBILITY] * size, p[_VELOCITY])
        held += added if reading > 0.0 else -added
    s[ENERGY], s[HELD], s[BEFORE] = energy, held, reading
    return held
