"""What is known of a law for every hand: which road proves it, which motion refutes it, what that counts.

A status is about the loop that the bench simulates: encoder, delay, the converter's steps and the force
limit as the device states them.  So a proof for an ideal actuator is not enough where they are known:

- The converter errs by ΔF/2 at most, which ΔF/2 of Coulomb friction pays for.  Whatever is proved of a
  device with that much less friction is proved of this one, steps and all.
- The proofs of walls cover a force limit: it makes no wall steeper (docs, "Contact made and broken").
- Other proofs say what they count; what they do not count withholds the promise.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

import numpy as np

from zwidth.bench.adversary import LONGEST, Attack, taken_out
from zwidth.bench.game import by_the_game
from zwidth.device.actuator import current_rise
from zwidth.device.device import Device
from zwidth.environment.environment import Environment
from zwidth.environment.wall import Wall
from zwidth.passivity.bounding import check_bounding, is_bounded
from zwidth.passivity.check import check_by_closed_forms
from zwidth.passivity.verdict import Verdict
from zwidth.passivity.witness import Witness
from zwidth.rendering.rendered import Rendered
from zwidth.rendering.stage import Surroundings
from zwidth.rendering.theorem import half_a_step

Status = Literal["passive", "theorem", "active", "undecided"]

PROOFS = {"passive": "certificate", "theorem": "paper", "active": "motion", "undecided": "none"}
"""What stands behind a status."""


@dataclass(frozen=True, kw_only=True)
class Standing:
    """What is known of a law for every hand, contact made and broken, and why.

    Parameters
    ----------
    status
        "passive" with a certificate, "theorem" by a proof on paper, no certificate, "active" with a motion,
        or "undecided".
    reason
        Why, in a sentence.
    withheld
        Promises that the law makes and this device does not let it keep, in words; empty where there is
        none.
    counts_encoder, counts_delay, counts_force_steps, counts_force_limit
        True where the status holds with what the device states of it: a motion counts all of them, a proof
        what it was made for.  What the device does not state is counted as absent.
    counts_current_rise
        Never: every force acts at once, as in the simulator of the bench.
    """

    status: Status
    reason: str
    withheld: tuple[str, ...] = ()
    counts_encoder: bool = True
    counts_delay: bool = True
    counts_force_steps: bool = True
    counts_force_limit: bool = True
    counts_current_rise: bool = False

    @property
    def proof(self) -> str:
        """What stands behind the status: "certificate", "paper", "motion" or "none"."""
        return PROOFS[self.status]

    @property
    def evidence(self) -> str:
        """Reason, and what is withheld."""
        return ". ".join(part.removesuffix(".") for part in (self.reason, *self.withheld))


def standing(device: Device, law: Environment, found: Attack) -> Standing:
    """What is known of a law; `found` is the best motion of the adversary."""
    if found.extracts:
        return Standing(status="active", reason=str(found))
    withheld: list[str] = []
    for road in (_by_check, _by_a_covering_wall, _by_bounding, _by_a_theorem):
        outcome = road(device, law)
        if isinstance(outcome, Standing):
            return outcome
        withheld += outcome
    refuted, reason = by_the_game(device, law, found)
    status: Status = "active" if refuted else "undecided"
    return Standing(status=status, reason=reason, withheld=() if refuted else tuple(withheld))


def _by_check(device: Device, law: Environment) -> Standing | list[str]:
    """The verdict on a law without a row, with steps and limit of the actuator counted."""
    if isinstance(law, Rendered):
        return []
    verdict, why_not = _with_the_actuator(device, law)
    if verdict is not None:
        return Standing(status="passive", reason=f"{verdict.claim}{_paid(device)}")
    ideal = check_by_closed_forms(device, law)
    if ideal.outcome == "passive":
        return [f"For an ideal actuator: {ideal.claim} {why_not}"]
    if ideal.outcome == "active":
        if _takes_out(device, law, ideal):
            return Standing(status="active", reason=ideal.claim)
        return [f"For an ideal actuator: {ideal.claim} With this one that motion does not gain."]
    return [ideal.claim]


def _by_a_covering_wall(device: Device, law: Environment) -> Standing | list[str]:
    """A spring with laws that add no more than α |Δx|/T, by the proof of a wall with damping α."""
    covering = _covering(law)
    if covering is None:
        return []
    verdict, why_not = _with_the_actuator(device, covering)
    added = f"What the laws add is never more than that of {covering.damping} N·s/m"
    if verdict is None:
        promised = check_by_closed_forms(device, covering).outcome == "passive"
        return [f"{added}, which is covered for an ideal actuator. {why_not}"] if promised else []
    return Standing(
        status="passive",
        reason=f"{added}, and every such force is covered, contact made and broken: "
        f"{verdict.claim}{_paid(device)}",
    )


def _by_bounding(device: Device, law: Environment) -> Standing | list[str]:
    """Force bounding, by its certificate: it is told of steps and limit."""
    if not is_bounded(law):
        return []
    bounding = check_bounding(device, law)
    if bounding.outcome != "passive":
        return [f"The promise of force bounding is withheld. {bounding.claim}"]
    return Standing(status="passive", reason=bounding.claim)


def _by_a_theorem(device: Device, law: Environment) -> Standing | list[str]:
    """A proof on paper, where the device has nothing that it does not count."""
    if not isinstance(law, Rendered):
        return []
    last = law.stages[-1]
    theorem = last.theorem(Surroundings(device, law.environment))
    if theorem is None:
        return []
    if not theorem.holds_on(device):
        return [f"The promise of {last.describe(device.motion)} is {theorem.reason(device)}."]
    return Standing(
        status="theorem",
        reason=f"By a proof on paper, no certificate: {theorem.statement}.",
        counts_encoder=theorem.counts_encoder,
        counts_delay=theorem.counts_delay,
        counts_force_steps=theorem.counts_force_steps,
        counts_force_limit=theorem.counts_force_limit,
        counts_current_rise=theorem.counts_current_rise,
    )


def _with_the_actuator(device: Device, law: Environment) -> tuple[Verdict | None, str]:
    """A proof for contact made and broken that covers the actuator; or why there is none."""
    slow = _slow_current(device)
    if slow:
        return None, slow[0]
    spare = device.exact("coulomb_friction") - half_a_step(device)
    if spare < 0:
        return None, (
            f"The converter's steps are not covered: they take {float(half_a_step(device)):.6g} N of Coulomb "
            f"friction, and the device has {float(device.exact('coulomb_friction')):.6g} N."
        )
    verdict = check_by_closed_forms(_without(device, half_a_step(device)), law)
    proof = verdict.certificate
    if verdict.outcome == "passive" and proof is not None:
        if proof.covers_contact:
            return verdict, ""
        return None, "Making and breaking contact is not covered."
    half = float(half_a_step(device))
    return (
        None,
        f"The converter's steps are not covered: the {half:.6g} N that they take is needed elsewhere.",
    )


def _without(device: Device, friction: Fraction) -> Device:
    """The device with so much less friction; with the stiction that it has."""
    if friction == 0:
        return device
    return device.replace(coulomb_friction=device.exact("coulomb_friction") - friction)


def _paid(device: Device) -> str:
    """What is said of the actuator."""
    parts = []
    if device.force_resolution is not None:
        half = float(half_a_step(device))
        parts.append(f"the converter's steps are counted: {half:.3g} N of friction pays for them")
    if device.force_limit is not None:
        parts.append("the force limit is counted")
    return f" ({'; '.join(parts)})" if parts else ""


def _slow_current(device: Device) -> list[str]:
    """Where the record says that the force cannot be taken as instant."""
    rise = current_rise(device)
    return [f"A proof takes the force as instant, and it is not: {rise.text}."] if rise.ok is False else []


def _takes_out(device: Device, law: Environment, verdict: Verdict) -> bool:
    """Whether the motion of a verdict gains with the actuator that the device states."""
    if device.force_resolution is None and device.force_limit is None:
        return True
    if not isinstance(verdict.witness, Witness) or verdict.witness.motion.samples > LONGEST:
        return False
    whole = verdict.witness.motion.listed()
    positions, switches = (np.array(xs, float) for xs in (whole.positions, whole.switch_positions))
    return taken_out(device, law, positions, switches if switches.size else None) > 0


def _covering(law: Environment) -> Wall | None:
    """A wall whose proof, for |f − K u| ≤ B |v|, is one of a wall with laws that add no more than that."""
    if not isinstance(law, Rendered) or not isinstance(law.environment, Wall):
        return None
    if law.environment.damping or law.environment.clamped:
        return None
    bounds = [stage.most_damping() for stage in law.stages]
    if any(bound is None for bound in bounds):
        return None
    return law.environment.replace(damping=sum((b.fraction for b in bounds if b is not None), Fraction(0)))
