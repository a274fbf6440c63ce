"""What a verdict says in words: the claim, and what it takes for granted."""

from __future__ import annotations

from zwidth.device import Device
from zwidth.environment.environment import Environment
from zwidth.environment.viscoelastic import GeneralizedMaxwell, Maxwell, StandardLinearSolid
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.decision import Decision
from zwidth.passivity.linear import LinearRefutation
from zwidth.passivity.verdict import Outcome
from zwidth.passivity.violation import Violation
from zwidth.passivity.witness import Witness
from zwidth.quantity.exact import Interval, ends

NOT_COVERED = "; making and breaking contact is not covered"
"""How the first assumption of a proof in sustained contact ends."""


def active_claim(shown: Violation | Witness) -> str:
    """What makes a loop active."""
    if isinstance(shown, Violation):
        return f"The hand can take any amount of energy out of this loop: {shown.describe()}."
    return f"A motion of the hand takes energy out of this loop: {shown.describe()}."


def open_claim(decision: Decision) -> str:
    """What is proved on both sides where the loop itself is neither proved nor refuted."""
    if decision.is_clamped:
        return _clamped_claim(decision)
    if isinstance(decision.viscous, LinearRefutation):
        return (
            f"Passivity cannot be proved ({decision.viscous.reason}); that energy comes out was not "
            "confirmed by the independent checker within its bounds."
        )
    if not decision.loop.hidden_modes_decay:
        return (
            "Numerator and denominator of H(z) share a root on or outside the unit circle. The port does not "
            "see it, but the controller as written carries a mode that never dies out: cancel it and check "
            "again."
        )
    need, least = decision.sufficient_friction, decision.necessary_friction
    has = float(decision.setting.coulomb_friction)
    enough = "no amount is proved enough" if need is None else f"{float(need):.6g} is enough"
    below = (
        f"straddling an encoder edge should gain below {least:.6g}, yet no such motion was found short enough"
        if has < least
        else f"straddling an encoder edge gains only below {least:.6g}"
    )
    return (
        "Viscous damping is enough, but for an encoder with this law no exact condition on Coulomb friction "
        f"is proved: {enough}, {below}, and the device has {has:.6g}."
    )


def _clamped_claim(decision: Decision) -> str:
    """What is known of a clamped law that is not proved."""
    damping, friction = decision.contact_damping, decision.contact_friction
    if damping is None or friction is None:
        known = "and no other condition is known for this law and delay."
    else:
        loop, has = decision.loop, float(decision.setting.coulomb_friction)
        known = (
            f"and what is proved enough is not there: damping of {float(damping):.6g}, the device has "
            f"{float(loop.damping):.6g}; Coulomb friction of {float(friction):.6g}, it has {has:.6g}."
        )
    return f"The linear criterion does not cover a law whose force is clamped, {known}"


def assumptions(
    outcome: Outcome,
    device: Device,
    law: Environment,
    decision: Decision,
    certificate: Certificate | None = None,
) -> tuple[str, ...]:
    """What the claim covers and takes for granted; `certificate` is its proof, if there is one."""
    unit = {"N": "N", "b": "N·s/m"} if device.motion == "linear" else {"N": "N·m", "b": "N·m·s/rad"}
    loop = decision.loop
    lines = [
        _surface(outcome, device, law, decision, certificate),
        f"the device takes out at least b = {float(loop.damping):.6g} {unit['b']} of viscous and "
        f"f_c = {float(decision.setting.coulomb_friction):.6g} {unit['N']} of Coulomb friction",
        "a hand without limits on speed and force; the mass of the device plays no part",
        "ideal actuator: force limit, converter steps, current rise and added filters are not in the claim",
        "a constant sample period and delay, no missed samples",
    ]
    if decision.setting.resolution:
        lines.append("encoder counts of one size, their phase against the surface unknown")
    else:
        lines.append("ideal position sensor: no quantization")
    lines.extend(f"{key.replace('_', ' ')} was not given and taken as 0" for key in device.assumed)
    if law.coefficients_rounded:
        lines.append("H(z) has the coefficients of its discretization rounded to double precision")
    intervals = [k for k, v in device.parameters().items() if isinstance(v, Interval)]
    if intervals or not law.is_certain:
        named = ", ".join(intervals) or "the environment's intervals"
        holds = "" if outcome == "undecided" else f"holds for every value within {named}; "
        lines.append(holds + "numbers are given for the worst corner of the intervals")
    return tuple(lines)


def _surface(
    outcome: Outcome,
    device: Device,
    law: Environment,
    decision: Decision,
    certificate: Certificate | None,
) -> str:
    """Whether the hand may leave the law and come back."""
    anywhere = "contact made and broken at any instant"
    covered = decision.is_spring if certificate is None else certificate.covers_contact
    if not covered and decision.is_clamped:
        return f"{anywhere}; the law never pulls: a force below 0 is given as 0"
    if not covered:
        inside = "sustained contact: the law is linear while the hand stays inside"
        if outcome == "passive" and _only_relaxes(law) and ends(device.delay)[1] == 0:
            return f"{inside}; contact made and broken is covered by a proof on paper, without a certificate"
        return f"{inside}{NOT_COVERED}"
    if certificate is not None and not certificate.is_of_springs:
        return f"{anywhere}; also for a wall that is clamped so that it never pulls"
    more = "; the same holds for every spring law of slope 0 to K" if outcome == "passive" else ""
    return f"{anywhere}{more}"


def _only_relaxes(law: Environment) -> bool:
    """True for solids that are fed with the penetration and have h_j ≤ 0 for all j ≥ 1 (theory/contact)."""
    solids = (Maxwell, StandardLinearSolid, GeneralizedMaxwell)
    return isinstance(law, solids) and law.discretization == "backward" and not law.clamped
