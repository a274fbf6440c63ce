"""The main verb: is this device, rendering this environment, passive?

Nothing is claimed on the prover's word: "passive" needs a certificate that
the independent checker accepts, "active" a violation that it confirms or a
motion whose energy it recomputes.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from zwidth.device import Device
from zwidth.environment.environment import Environment
from zwidth.environment.transfer_function import as_environment
from zwidth.errors import InputError
from zwidth.passivity.certificate import Certificate, certify, certify_delays
from zwidth.passivity.claims import active_claim, assumptions, open_claim
from zwidth.passivity.corners import Loop, best_corner, corners_decide, worst_corners
from zwidth.passivity.decision import Decision, decide
from zwidth.passivity.delay_interval import prove_delays
from zwidth.passivity.game import has_gap, with_game
from zwidth.passivity.linear import LinearProof, LinearRefutation, decide_linear
from zwidth.passivity.refutation import refute_friction
from zwidth.passivity.supremum import tightest
from zwidth.passivity.verdict import Outcome, Verdict
from zwidth.passivity.violation import Violation
from zwidth.passivity.witness import Witness
from zwidth.quantity.exact import Exact, ends

Evidence = Violation | Witness


def check(device: Device, environment: Environment | Any) -> Verdict:
    """Decide whether a hand can ever take energy out of the sampled loop.

    Passive means ∫ f_h v dt + E(0) ≥ 0 for every motion, E(0) finite.  For a
    linear law of force H(z), exactly if

        b ≥ (T/2) Re{(1 − e^{−jωT}) H(e^{jωT})}/(1 − cos ωT),  0 < ω ≤ π/T,

    and H is stable (Colgate & Schenkel 1997; Fardad & Bamieh 2009); with a
    delay of any length in the form derived in the documentation; and, with an
    encoder of resolution Δ, f_c must cover its error: f_c ≥ K Δ/2 for a spring
    (Abbott & Okamura 2005).  Equality counts as passive.  A damped wall is
    covered with contact made and broken where b ≥ (2d + 1) K T/2 + |B| Σ|w_j| and
    f_c ≥ (K + |B| ‖h_v‖₁) Δ/2, clamped or not.  Where these conditions leave a gap
    the game of `worst_hand` is played, for some seconds at most.

    Parameters
    ----------
    device
        The device; where parameters are intervals the verdict holds for all values.
    environment
        An `Environment`, or a discrete python-control or scipy.signal system H(z).

    Raises
    ------
    InputError
        If the environment cannot be sampled at this rate or is not an environment.
    """
    law = _as_law(device, environment)
    verdict = check_by_closed_forms(device, law)
    return with_game(device, law, verdict) if has_gap(device, law, verdict) else verdict


def check_by_closed_forms(device: Device, environment: Environment | Any) -> Verdict:
    """`check` without the game: exact, in milliseconds, of every hand."""
    law = _as_law(device, environment)
    corners = worst_corners(device, law)
    decisions = [decide(*corner) for corner in corners]
    failing = [k for k, d in enumerate(decisions) if not d.is_provable]
    if not failing:
        proofs = _proofs(device, law, corners, decisions)
        if proofs is not None:
            return _passive(device, law, corners, decisions, proofs)
        return _between(device, law, corners[0], decisions[0])
    worst = failing[0]
    corner, decision = corners[worst], decisions[worst]
    certain = device.is_certain and len(corners) == 1
    shown = _refute(decision) if certain else _refute_best(device, law)
    if shown is not None:
        return _not_passive("active", active_claim(shown), device, law, corner, decision, shown)
    at_worst = None if certain else _refute(decision)
    claim = open_claim(decision) if at_worst is None else _DEPENDS
    return _not_passive("undecided", claim, device, law, corner, decision, at_worst)


_DEPENDS = (
    "The answer depends on where in its intervals the loop lies: energy can be taken out at the worst "
    "corner, and for other values that is not known."
)


def _as_law(device: Device, environment: Environment | Any) -> Environment:
    """The environment, once what comes first is a device."""
    if not isinstance(device, Device):
        raise InputError(f"the first argument is a Device, got {type(device).__name__}")
    return as_environment(environment)


def _proofs(
    device: Device, law: Environment, corners: list[Loop], decisions: list[Decision]
) -> list[dict[str, Any]] | None:
    """Proofs that together cover the whole box of parameters, or None."""
    if corners_decide(device, law, all(d.is_spring or d.covers_contact for d in decisions)):
        return [certify(d) for d in decisions]
    shortest, longest = ends(device.delay)
    if any(d.is_clamped for d in decisions):  # contact is covered for delays of whole samples only
        return None
    if shortest == longest or not corners_decide(device.replace(delay=Exact(shortest)), law):
        return None
    proofs = []
    for corner, decision in zip(corners, decisions, strict=True):
        if decision.is_spring:  # the longest delay decides; both ends are among the corners
            proofs.append(certify(decision))
        elif corner[0].exact("delay") == shortest:
            assert isinstance(decision.viscous, LinearProof), "provable decisions only"
            pieces = prove_delays(decision.loop, decision.viscous, longest)
            if pieces is None:
                return None
            proofs.append(certify_delays(decision, pieces, longest))
    return proofs


def _passive(
    device: Device,
    law: Environment,
    corners: list[Loop],
    decisions: list[Decision],
    proofs: list[dict[str, Any]],
) -> Verdict:
    certificate = Certificate(tuple(proofs))
    tight = _tightest(decisions)
    at, decision = corners[tight], decisions[tight]
    if not certificate.verify():  # nothing is claimed that the checker does not accept
        claim = "A proof was found, but the independent checker did not confirm it within its bounds."
        assumed = assumptions("undecided", device, law, decision)
        return Verdict("undecided", claim, assumed, *at, decision, None)
    everywhere = certificate.covers_contact or not law.unilateral
    kept = "" if everywhere else " that keeps contact"
    claim = f"No motion of the hand{kept}, however fast or skilled, can take energy out of this loop"
    if any(_at_limit(d) for d in decisions):
        claim += "; it is exactly at its limit, equality included"
    assumed = assumptions("passive", device, law, decision, certificate)
    return Verdict("passive", f"{claim}.", assumed, *at, decision, certificate)


def _between(device: Device, law: Environment, corner: tuple[Device, Environment], at: Decision) -> Verdict:
    claim = (
        "Passive at every corner of the intervals; that every value between them is too is not proved "
        "for intervals of these parameters together."
    )
    return Verdict("undecided", claim, assumptions("undecided", device, law, at), *corner, at, None)


def _at_limit(decision: Decision) -> bool:
    """True when the smallest decrease of b or f_c would lose the proof.

    Of a clamped law only the conditions for contact made and broken decide.  A
    criterion that touches zero may do so at a pole on the unit circle, whatever
    b is: so a slightly smaller b is decided too.
    """
    friction, loop = decision.sufficient_friction, decision.loop
    if friction and friction == decision.setting.coulomb_friction:
        return True
    if decision.is_clamped:
        return loop.damping == decision.contact_damping
    positivity = getattr(decision.viscous, "positivity", None)
    if positivity is None or not any(loop.numerator):
        return False
    if not (positivity.at_one or positivity.at_minus_one or len(positivity.square) != 1):
        return False
    less = loop.with_damping(loop.damping * (1 - Fraction(1, 10**12)))
    return loop.damping == 0 or isinstance(decide_linear(less), LinearRefutation)


def _tightest(decisions: list[Decision]) -> int:
    """The corner that asks for most damping."""
    return (
        max(range(len(decisions)), key=lambda k: tightest(decisions[k].loop)[0]) if len(decisions) > 1 else 0
    )


def _refute(decision: Decision) -> Evidence | None:
    """A checked violation, or a checked motion, of which either shows that the loop is active; or None."""
    if decision.is_clamped:  # what is proved of the linear law says nothing of it
        return None
    if isinstance(decision.viscous, LinearProof):
        return None if decision.friction_covers else refute_friction(decision.setting)
    violation = Violation(decision.setting, decision.viscous)
    return violation if violation.verify() else violation.witness


def _refute_best(device: Device, law: Environment) -> Evidence | None:
    """What shows that the loop is active even at the best values within the intervals, or None."""
    best = best_corner(device, law)
    if best is None:
        return None
    decision = decide(*best)
    return None if decision.is_provable else _refute(decision)


def _not_passive(
    outcome: Outcome,
    claim: str,
    device: Device,
    law: Environment,
    corner: Loop,
    decision: Decision,
    shown: Evidence | None,
) -> Verdict:
    violation, motion = (shown, None) if isinstance(shown, Violation) else (None, shown)
    assumed = assumptions(outcome, device, law, decision)
    return Verdict(outcome, claim, assumed, *corner, decision, None, violation, motion)
