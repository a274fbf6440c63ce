"""How active a hand may be at low frequencies before it can drive the loop.

A hand is of activity a below f₀ if the energy that it has given out by any time t is at most

    E₀ + (a/π) ∫₀^ω₀ |v̂_t(ω)|² dω,        v̂_t the spectrum of its velocity up to t

which every linear hand is with Re Z(jω) ≥ −a below f₀ and ≥ 0 above.  People are passive above
some 10 Hz and may not be below.  In sustained contact with H(z), after whole samples of delay, such a hand
cannot gain for ever exactly if, with n(θ) the damping that the criterion asks for at θ = ωT,

    b ≥ n(θ) above f₀,    n(θ) ≤ b (b − a)/(b − a (1 − s)) below,    s = (sin ½θ/½θ)²

and with contact made and broken if the loop is passive with b − a in the place of b.
Derived in docs/theory/known-hand.md.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np
import numpy.typing as npt

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.transfer_function import as_environment
from zwidth.passivity.certificate import FORMAT, Certificate, certify, linear_proof, positivity_document
from zwidth.passivity.criterion_choice import Decision, decide
from zwidth.passivity.linear.boundary import largest_holding
from zwidth.passivity.linear.criterion import LinearProof
from zwidth.passivity.linear.loop import LinearLoop
from zwidth.passivity.result import Result
from zwidth.passivity.scope import Contact, Hands, Scope, scope_of
from zwidth.passivity.stability.shaking_hand import (
    Band,
    ShakingHand,
    band_of,
    prove_inside,
    shaking_hand,
    tolerance,
)
from zwidth.passivity.wording import if_friction_goes_on, lines
from zwidth.quantity.answered import answered, answers, known
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.glossary import GLOSSARY, unit_suffix
from zwidth.quantity.text import exact_text, shown
from zwidth.quantity.units import parse_number

Array = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, repr=False)
class ToleratedActivity(Result):
    """How much negative damping a hand may show below a frequency, proved and refuted."""

    _FORMAT = "zwidth activity 1"
    _BESIDES = (
        (
            "contact_kept, contact_broken",
            "`activity_N_s_per_m`, the largest that is proved or null, its `scope`, and its "
            "`certificate` of kind `active hand`",
        ),
    )

    claim: str = answered("in words")
    scope: Scope = known("what the first number is about")
    scope_with_contact_broken: Scope = known("and the second")
    below: float = answered("f₀: above it the hand is passive", unit="Hz")
    activity: float | None = known(
        "the largest a that is proved in sustained contact; None where not even every passive hand is",
        quantity="damping",
    )
    with_contact_broken: float | None = known(
        "the same for hands that touch and leave, at any frequency; None where no proof is known",
        quantity="damping",
    )
    hand: ShakingHand | None = answered(
        "a hand that is slightly more active, and with which the loop grows; missing where none was found",
        key="shaking_hand",
        optional=True,
    )
    certificate: Certificate | None = known("the proof of the first, accepted by the independent checker")
    certificate_with_contact_broken: Certificate | None = known("of the second, likewise")
    unit: str = known("of the activities")
    loop: LinearLoop = known("device and H(z), exact")

    @property
    @answers()
    def assumptions(self) -> tuple[str, ...]:
        """What the first number rests on, line by line."""
        return (
            *lines(self.scope),
            "what the hand gives out is bounded by its motion; what it means to do comes on top, once",
            "Coulomb friction is counted only against the encoder",
            *([] if self.hand is None else ["the hand that is too active is linear, and its loop too"]),
        )

    def at(self, frequency: npt.ArrayLike) -> Array:
        """The activity that is tolerated at single frequencies [N·s/m], contact kept, for plots.

        Parameters
        ----------
        frequency
            0 < f ≤ 1/(2T) [Hz].
        """
        if self.loop.part_delay:
            raise InputError("single frequencies are known for delays of whole samples")
        angles = 2 * np.pi * np.atleast_1d(np.asarray(frequency, dtype=np.float64)) * float(self.loop.period)
        if not ((angles > 0) & (angles <= np.pi * (1 + 1e-12))).all():
            raise InputError("frequency must be > 0 and at most half the rate")
        return tolerance(self.loop, angles)

    def rows(self) -> list[tuple[str, str]]:
        """The numbers as (name, text) for a report."""

        def said(value: float | None, otherwise: str) -> str:
            return otherwise if value is None else f"up to {shown(value, self.unit, 6)}"

        rows = [
            (f"below {shown(self.below, 'Hz', 6)}", said(self.activity, "none is proved") + ", contact kept"),
            ("at any frequency", said(self.with_contact_broken, "none is proved") + ", contact broken too"),
        ]
        if self.hand is not None:
            rows.append(("too active", self.hand.describe()))
        return rows

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain data, units in the keys."""
        unit = unit_suffix(self.unit)

        def part(activity: float | None, scope: Scope, certificate: Certificate | None) -> dict[str, Any]:
            proof = {} if certificate is None else {"certificate": certificate.to_dict()}
            return {f"activity_{unit}": activity, "scope": scope.to_dict(), **proof}

        return {
            **super().to_dict(),
            "contact_kept": part(self.activity, self.scope, self.certificate),
            "contact_broken": part(
                self.with_contact_broken, self.scope_with_contact_broken, self.certificate_with_contact_broken
            ),
        }

    def describe(self) -> str:
        """The claim."""
        return self.claim

    def __str__(self) -> str:
        return self.claim

    def __repr__(self) -> str:
        return f"<ToleratedActivity {'; '.join(f'{name}: {text}' for name, text in self.rows())}>"


def tolerated_activity(
    device: Device, environment: Environment | Any, below: RealLike = 10
) -> ToleratedActivity:
    """How active a hand may be below a frequency, and be passive above, without driving the loop.

    Parameters
    ----------
    device
        Every number certain.
    environment
        An `Environment`, or a system of python-control, scipy.signal or harold.
    below
        f₀, 0 < f₀ ≤ 1/(2T) [Hz], or a text such as "10 Hz", the default: people are passive above some 10 Hz.

    Raises
    ------
    InputError
        If a parameter is an interval, f₀ is outside its bound, or the environment cannot be sampled.
    """
    law = as_environment(environment, device=device)
    band = band_of(parse_number(below, "Hz", "below").fraction, device.exact("sample_period"))
    decision = decide(device, law)
    kept, broken = _kept(device, law, decision, band), _throughout(device, law, contact=True)
    if broken is not None and (kept is None or broken[0] > kept[0]):
        kept = broken  # what may leave the wall may stay
    hand = None
    if kept is not None and device.mass is not None and not decision.loop.part_delay:
        hand = shaking_hand(decision.loop, float(device.exact("mass")), band, device.motion)
    unit = device.unit("damping")
    scope = _scope(device, law, kept, float(band.below))
    return ToleratedActivity(
        claim=_claim(kept, scope, unit),
        scope=scope,
        scope_with_contact_broken=_scope(device, law, broken, None),
        below=float(band.below),
        activity=None if kept is None else kept[0],
        with_contact_broken=None if broken is None else broken[0],
        hand=hand,
        certificate=None if kept is None else kept[1],
        certificate_with_contact_broken=None if broken is None else broken[1],
        unit=unit,
        loop=decision.loop,
    )


_Proved = tuple[float, Certificate]


def _kept(device: Device, law: Environment, decision: Decision, band: Band) -> _Proved | None:
    """The largest activity below f₀ that is proved in sustained contact, and the proof."""
    loop, proof = decision.loop, decision.viscous
    if decision.is_clamped or not isinstance(proof, LinearProof) or not decision.is_provable:
        return None
    if proof.stability != "open loop" or loop.part_delay or not _encoder_is_paid(decision):
        return _throughout(device, law, contact=False)
    found = largest_holding(lambda a: prove_inside(loop, a, band) is not None, float(loop.damping) or 1.0)
    if found is None:
        return None
    inside = prove_inside(loop, Exact(found).fraction, band)
    assert inside is not None, "it was proved a moment ago"
    proofs = {
        **linear_proof(decision),
        "angle": exact_text(band.angle),
        "cosine": exact_text(band.cosine),
        "in_band": positivity_document(inside),
    }
    document = {**_document(decision, found), "below_Hz": exact_text(band.below), "proof": proofs}
    return _accepted(found, document)


def _accepted(activity: float, document: dict[str, Any]) -> _Proved | None:
    """Nothing is claimed that the checker does not accept."""
    certificate = Certificate((document,))
    return (activity, certificate) if certificate.verify() else None


def _encoder_is_paid(decision: Decision) -> bool:
    """f_c ≥ ‖h‖₁ Δ/2, by the bound that goes into the proof."""
    setting = decision.setting
    if not setting.resolution:
        return True
    return (
        decision.norm is not None and decision.norm.bound * setting.resolution <= 2 * setting.coulomb_friction
    )


def _throughout(device: Device, law: Environment, contact: bool) -> _Proved | None:
    """The largest activity at any frequency: what may be taken from b; `contact`, made and broken."""
    own = device.exact("damping")

    def reduced(activity: Fraction) -> Decision:
        return decide(device.replace(damping=Exact(own - activity)), law)

    def holds(activity: Fraction) -> bool:
        if activity > own:
            return False
        found = reduced(activity)
        return found.is_provable and (not contact or found.is_spring or found.covers_contact)

    found = largest_holding(holds, float(own) or 1.0)
    if found is None:
        return None
    proof = {"reduced": certify(reduced(Exact(found).fraction))}
    return _accepted(found, {**_document(decide(device, law), found), "proof": proof})


def _document(decision: Decision, activity: float) -> dict[str, Any]:
    setting = decision.setting
    loop = setting.loop_document()
    unit = unit_suffix(GLOSSARY["damping"].unit_for(setting.motion))
    return {
        "format": FORMAT,
        "kind": "active hand",
        "loop": loop,
        f"activity_{unit}": exact_text(Exact(activity).fraction),
    }


def _claim(kept: _Proved | None, scope: Scope, unit: str) -> str:
    if kept is None:
        return "Not even every passive hand is proved not to drive this loop; zwidth.check says why."
    return (
        f"A hand that is passive above {shown(scope.hands.below, 'Hz')} and gives back at most "
        f"{shown(kept[0], unit, 6)} below cannot go on gaining energy from this loop while it keeps contact"
        f"{if_friction_goes_on(scope)}."
    )


def _scope(device: Device, law: Environment, proved: _Proved | None, below: float | None) -> Scope:
    """Contact as the checker found it in the proof; kept, where there is none."""
    activity, covered = (None, None) if proved is None else (proved[0], proved[1].covered())
    contact: Contact = "kept" if covered is None else covered.contact
    return scope_of(device, law).replace(contact=contact, hands=Hands(activity=activity, below=below))
