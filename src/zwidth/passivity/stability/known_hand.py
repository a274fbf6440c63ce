"""Is a hand that is known at rest against the wall, or does the loop shake it?

Device, hand and wall in sustained contact are one linear system, sampled exactly; it decays
exactly if all roots of its characteristic polynomial lie inside the unit circle.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from math import pi
from typing import Any

import numpy as np

from zwidth.errors import InputError
from zwidth.loop.sampled_plant import Motion
from zwidth.model.device import Device, require_rigid
from zwidth.model.environment.environment import Environment, RationalFunction
from zwidth.model.environment.transfer_function import as_environment
from zwidth.model.operator.hand_impedance import HandImpedance, as_hand
from zwidth.passivity.certificate import FORMAT, Certificate
from zwidth.passivity.linear.boundary import largest_holding
from zwidth.passivity.result import Answer, share_left
from zwidth.passivity.scope import Hands, Scope, scope_of, unit_key
from zwidth.passivity.stability.characteristic import (
    PRECISIONS,
    Found,
    Outcome,
    Plain,
    as_floats,
    decided,
    family,
    last_stable,
    of_law,
    plain,
)
from zwidth.quantity.answered import answered, known
from zwidth.quantity.balls import precision
from zwidth.quantity.exact import Exact, ends
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.text import exact_text, in_words, shown

_HALVINGS = 8
"""Of the stiffness, in that search."""


@dataclass(frozen=True, repr=False)
class Stability(Answer):
    """Whether the loop with a known hand decays, and how far it is from not doing so."""

    _FORMAT = "zwidth stability 1"
    _YES = "stable"
    witness = None

    outcome: Outcome = known(
        '"stable", "unstable" or "undecided"; for intervals "stable" holds for every value in them and '
        '"unstable" for some'
    )
    claim: str = known("the same in a sentence")
    spectral_radius: float = answered(
        "the largest modulus of a pole in z, for intervals the largest at their corners; what is left of a "
        "deviation after one sample"
    )
    frequency: float = answered("of that pole, 0 … 1/(2T)", unit="Hz")
    max_stiffness: float | None = answered(
        "the largest stable K of this wall, all else as given; null where no K is or the law is no wall.  "
        "For intervals the largest that was proved for every value in them, below the true one",
        quantity="stiffness",
    )
    limit_frequency: float | None = answered(
        "with which the loop oscillates at that stiffness, for intervals at their worst corner", unit="Hz"
    )
    scope: Scope = known("what it is about: which hand, contact, what is left out")
    stiffness: float | None = known("K of the wall; None of a law that is none", quantity="stiffness")
    unstable_hand: tuple[float, float, float] | None = known(
        "mass [kg], damping [N·s/m] and stiffness [N/m] of device and hand together that do not decay",
        default=None,
    )
    certificate: Certificate | None = known(
        'what the independent checker accepted, of kind "stability" for the loop and all its intervals or '
        '"instability" for the `unstable_hand`; None where it is undecided',
        default=None,
    )

    @property
    def stable(self) -> bool:
        """True where the outcome is "stable": proved for the hand and the wall that were given."""
        return self.outcome == "stable"

    def _left(self) -> float | None:
        """Of the largest stable stiffness of a wall."""
        return share_left(self.stiffness, self.max_stiffness)

    def __repr__(self) -> str:
        limit = "" if self.max_stiffness is None else f", stiffest {self.max_stiffness:.6g}"
        return f"<Stability {self.outcome}: {self.claim}; spectral radius {self.spectral_radius:.6g}{limit}>"

    def verify(self) -> bool:
        """True when there is a certificate and the independent checker accepts it."""
        return self.certificate is not None and self.certificate.verify()

    def rows(self) -> list[tuple[str, str]]:
        """The main numbers as (name, text) for a report."""
        rows = [
            ("spectral radius", f"{self.spectral_radius:.6g}"),
            ("frequency", shown(self.frequency, "Hz", 6)),
        ]
        if self.max_stiffness is not None:
            unit = GLOSSARY["stiffness"].unit_for(self.scope.motion)
            rows.append(("largest stable stiffness", shown(self.max_stiffness, unit, 6)))
        return rows

    def __str__(self) -> str:
        return self.describe()


def coupled_stability(device: Device, wall: Environment | Any, hand: Any = None) -> Stability:
    """Whether device, known hand and wall come to rest in sustained contact.

    ``(m + m_h) ẍ + (b + c) ẋ + k x = −f``,  f = H(z) x sampled, delayed and held.  Decided exactly: in
    rational arithmetic without spring and damper, else in balls that hold the true coefficients.  What is
    said has been confirmed by the independent checker, and of intervals proved by it alone.  A passive loop
    is stable with every passive hand; this one answers for loops that are not passive.

    Parameters
    ----------
    device
        With a mass; mass and damping may be intervals. Coulomb friction and encoder are left out.
    wall
        A `Wall` or any other linear environment, certain.
    hand
        None, a `HandImpedance`, whose numbers may be intervals, or a linear operator such as `Finger()`.

    Raises
    ------
    InputError
        If the mass is unknown, another parameter is an interval, or the hand or the environment is none.
    """
    law = as_environment(wall, device=device)
    holding = as_hand(hand)
    motion = motion_of(device, holding)
    transfer = law.pulse_transfer_function(motion.period)
    found, certificate = _checked(motion, transfer, device.motion)
    worst = max((_poles(corner, transfer) for corner in motion.grid(2)), key=lambda z: abs(z))
    largest, limit = largest_stable(motion, law, device.motion)
    spring = law.damped_spring(motion.period)
    return Stability(
        outcome=found.outcome,
        claim=_claim(found),
        spectral_radius=float(abs(worst)),
        frequency=_hertz(float(abs(np.angle(worst))), motion),
        max_stiffness=largest,
        limit_frequency=None if limit is None else _hertz(limit, motion),
        scope=_scope(device, holding, law),
        stiffness=None if spring is None else float(spring.stiffness),
        unstable_hand=_unstable_hand(found),
        certificate=certificate,
    )


def _checked(motion: Motion, transfer: RationalFunction, units: str) -> tuple[Found, Certificate | None]:
    """An outcome with a certificate that the independent checker accepts; undecided without one."""
    found = decided(motion, lambda point: of_law(point, transfer))
    document = evidence(found, motion, transfer, units)
    certificate = None if document is None else Certificate((document,))
    if certificate is None or not certificate.verify():
        return Found("undecided"), None
    return found, certificate


def motion_of(device: Device, hand: HandImpedance) -> Motion:
    """Device and hand together."""
    require_rigid(device, "stability with a known hand")
    if device.mass is None:
        own = f"{in_words('mass', device.motion)} [{device.unit('mass')}]"
        raise InputError(
            f"stability with a known hand depends on the device's {own}, which is unknown: give it"
        )
    mass, damping = (
        (low + more, high + most)
        for (low, high), (more, most) in (
            (ends(device.mass), ends(hand.mass)),
            (ends(device.damping), ends(hand.damping)),
        )
    )
    return Motion(mass, damping, ends(hand.stiffness), device.exact("sample_period"), device.exact("delay"))


def _poles(corner: Motion, transfer: Any) -> complex:
    with precision(PRECISIONS[0]):
        roots = 1 + np.roots(as_floats(of_law(corner, transfer)))
    return complex(roots[np.abs(roots).argmax()])


def largest_stable(motion: Motion, law: Environment, units: str) -> tuple[float | None, float | None]:
    """The largest stable stiffness of a wall and the angle ωT of its poles there; None where there is none.

    For intervals the largest that the independent checker accepts for every value in them.
    """
    wall = law.damped_spring(motion.period)
    if wall is None:
        return None, None
    damping, velocity = wall.damping, wall.velocity
    ends_of_bands = [last_stable(plain_of(corner, velocity), float(damping)) for corner in motion.grid(2)]
    if any(end is None for end in ends_of_bands):
        return None, None
    guess = min(end for end in ends_of_bands if end is not None)

    def holds(k: Fraction) -> bool:
        return decided(motion, lambda point: family(point, velocity).at(k, damping)).outcome == "stable"

    def holds_in_the_box(k: Fraction) -> bool:
        transfer = law.replace(stiffness=Exact(k)).pulse_transfer_function(motion.period)
        return _checked(motion, transfer, units)[0].outcome == "stable"

    if motion.is_certain:
        found = largest_holding(holds, guess.stiffness)
    else:
        found = _largest_below(holds_in_the_box, guess.stiffness)
    return (found, guess.angle) if found else (None, None)


def _largest_below(holds: Callable[[Fraction], bool], limit: float) -> float:
    """The largest of 2⁻⁸, 2 · 2⁻⁸, … of a limit that holds, sought from the limit down; 0 if none does."""
    whole = 1 << _HALVINGS
    low, high = 0, whole
    step = 1
    while high - low > 1:
        tried = max(low + 1, whole - step) if not low else (low + high) // 2
        if holds(Exact(limit * tried / whole).fraction):
            low = tried
        else:
            high, step = tried, 2 * step
    return limit * low / whole


def plain_of(motion: Motion, velocity: Any) -> Plain:
    """The characteristic polynomials of a certain loop over the walls of a velocity estimate, in floats."""
    with precision(PRECISIONS[0]):
        return plain(family(motion, velocity))


def _hertz(angle: float, motion: Motion) -> float:
    return angle / (2 * pi * float(motion.period))


def _unstable_hand(found: Found) -> tuple[float, float, float] | None:
    if found.unstable_hand is None:
        return None
    mass, damping, stiffness = (float(low) for low, _ in found.unstable_hand[:3])
    return mass, damping, stiffness


def _claim(found: Found) -> str:
    if found.outcome == "stable":
        return "device and hand come to rest against this wall, after every small disturbance"
    if found.outcome == "unstable":
        return "a disturbance does not die out: the hand is shaken, or left to drift"
    return "the loop, or some values in the intervals, are so near the limit that they were not decided"


def _scope(device: Device, hand: HandImpedance, law: Environment) -> Scope:
    """One linear system: contact is kept, and neither Coulomb friction nor the encoder's steps are in it."""
    asked = scope_of(device, law)
    return asked.replace(
        hands=Hands(impedance=hand.describe(device.motion)),
        contact="kept" if law.unilateral else "both sides",
        encoder="not counted" if asked.encoder == "counted" else "ideal",
        coulomb_friction=None,
        assumed=(),
    )


def evidence(found: Found, motion: Motion, transfer: RationalFunction, units: str) -> dict[str, Any] | None:
    """A document of kind "stability", or of kind "instability" with the unstable_hand; None for undecided."""
    if found.outcome == "undecided":
        return None
    told = motion if found.unstable_hand is None else found.unstable_hand
    loop = {
        **told.told(units),
        unit_key("sample_period", units): exact_text(told.period),
        unit_key("delay", units): exact_text(told.delay),
        "numerator": [exact_text(c) for c in transfer.numerator],
        "denominator": [exact_text(c) for c in transfer.denominator],
    }
    return {
        "format": FORMAT,
        "kind": "stability" if found.outcome == "stable" else "instability",
        "loop": loop,
    }
