"""The main verb: is this device, rendering this environment, passive?

Nothing is claimed on the prover's word: "passive" needs a certificate that
the independent checker accepts, "active" a motion whose energy it recomputes.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any

from zwidth.device import Device
from zwidth.environment.environment import Environment
from zwidth.environment.transfer_function import as_environment
from zwidth.errors import InputError
from zwidth.passivity.certificate import Certificate, certify, certify_delays
from zwidth.passivity.claims import ANYWHERE, assumptions, beyond_the_actuator, open_claim
from zwidth.passivity.corners import Loop, best_corner, corners_decide, worst_corners
from zwidth.passivity.decision import Decision, decide
from zwidth.passivity.delay_interval import prove_delays
from zwidth.passivity.game import has_gap, with_game
from zwidth.passivity.linear import LinearProof, LinearRefutation, decide_linear
from zwidth.passivity.refutation import refute_friction, refute_linear
from zwidth.passivity.supremum import tightest
from zwidth.passivity.touching import refute_touching
from zwidth.passivity.verdict import Outcome, Verdict
from zwidth.passivity.witness import Witness
from zwidth.quantity.exact import Exact, ends


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
    verdict = check_by_closed_forms(device, environment)
    law = as_environment(environment)
    return with_game(device, law, verdict) if has_gap(device, law, verdict) else verdict


def check_by_closed_forms(device: Device, environment: Environment | Any) -> Verdict:
    """`check` without the game: exact, in milliseconds, of every hand."""
    if not isinstance(device, Device):
        raise InputError(f"the first argument is a Device, got {type(device).__name__}")
    law = as_environment(environment)
    corners = worst_corners(device, law)
    decisions = [decide(*corner) for corner in corners]
    failing = [k for k, d in enumerate(decisions) if not d.is_provable]
    if not failing:
        proofs = _proofs(device, law, corners, decisions)
        if proofs is not None:
            found = _passive(device, law, corners, decisions, proofs)
            return _touched(device, law, found) or found
        return _between(device, law, corners[0], decisions[0])
    worst = failing[0]
    witness = _refute(decisions[worst])
    outcome: Outcome = "undecided"
    least = witness if len(corners) == 1 and device.is_certain else _best_witness(device, law)
    if witness is not None and least is not None:
        outcome, witness = "active", least
    found = _not_passive(outcome, device, law, corners[worst], decisions[worst], witness)
    return (outcome == "undecided" and _touched(device, law, found)) or found


def _touched(device: Device, law: Environment, verdict: Verdict) -> Verdict | None:
    """Active, by a motion that touches and leaves, where a proof is of kept contact only; or None."""
    covered = verdict.certificate is not None and verdict.certificate.covers_contact
    if covered or not (law.unilateral and device.is_certain and law.is_certain):
        return None
    witness = refute_touching(verdict.decision.setting, law)
    if witness is None:
        return None
    motion = witness.describe()
    claim = f"A motion of the hand that touches and leaves takes energy out of this loop: {motion}."
    said = (ANYWHERE, *assumptions("active", device, law, verdict.decision)[1:])
    said += beyond_the_actuator(device, witness)
    return replace(
        verdict, outcome="active", claim=claim, assumptions=said, certificate=None, witness=witness
    )


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
        return Verdict("undecided", claim, assumed, *at, decision, None, None)
    everywhere = certificate.covers_contact or not law.unilateral
    kept = "" if everywhere else " that keeps contact"
    claim = f"No motion of the hand{kept}, however fast or skilled, can take energy out of this loop"
    if any(_at_limit(d) for d in decisions):
        claim += "; it is exactly at its limit, equality included"
    assumed = assumptions("passive", device, law, decision, certificate)
    return Verdict("passive", f"{claim}.", assumed, *at, decision, certificate, None)


def _between(device: Device, law: Environment, corner: tuple[Device, Environment], at: Decision) -> Verdict:
    claim = (
        "Passive at every corner of the intervals; that every value between them is too is not proved "
        "for intervals of these parameters together."
    )
    return Verdict("undecided", claim, assumptions("undecided", device, law, at), *corner, at, None, None)


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


def _refute(decision: Decision) -> Witness | None:
    """A checked motion that takes energy out, or None."""
    if decision.is_clamped:  # a motion in the linear law says nothing of it
        return None
    if isinstance(decision.viscous, LinearProof) and decision.friction_covers:
        return None
    if isinstance(decision.viscous, LinearRefutation):
        return refute_linear(decision.setting, decision.viscous.reason)
    return refute_friction(decision.setting)


def _best_witness(device: Device, law: Environment) -> Witness | None:
    """A motion that takes energy out even at the best values within the intervals, or None."""
    best = best_corner(device, law)
    if best is None:
        return None
    decision = decide(*best)
    return None if decision.is_provable else _refute(decision)


def _not_passive(
    outcome: Outcome,
    device: Device,
    law: Environment,
    corner: tuple[Device, Environment],
    decision: Decision,
    witness: Witness | None,
) -> Verdict:
    if outcome == "active":
        assert witness is not None
        claim = f"A motion of the hand takes energy out of this loop: {witness.describe()}."
    elif witness is not None:
        claim = (
            "The answer depends on where in its intervals the loop lies: a motion takes energy out at the "
            "worst corner, and for other values none is known to."
        )
    else:
        claim = open_claim(decision)
    assumed = assumptions(outcome, device, law, decision) + beyond_the_actuator(device, witness)
    return Verdict(outcome, claim, assumed, *corner, decision, None, witness)
