"""What is known of a law for every hand: which road proves it, which motion refutes it, what that counts.

A status is about the loop that the bench simulates: encoder, delay, the converter's steps and the force
limit as the device states them.  So a proof for an ideal actuator is not enough where they are known:

- The converter errs by ΔF/2 at most, which ΔF/2 of Coulomb friction pays for.  Whatever is proved of a
  device with that much less friction is proved of this one, steps and all.
- The proofs of walls cover a force limit: it makes no wall steeper (docs, "Contact made and broken").
- Other proofs say what they count; what they do not count withholds the promise.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, Literal

import numpy as np

from zwidth.errors import InputError
from zwidth.model.device.amplifier import current_rise
from zwidth.model.device.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.model.rendering.rendered import laws_of
from zwidth.model.rendering.rendering_law import LoopContext, half_a_step
from zwidth.passivity.bounding import check_bounding, is_bounded
from zwidth.passivity.check import check, check_by_closed_forms
from zwidth.passivity.covering_wall import covering
from zwidth.passivity.outcome_evidence import claim, taken
from zwidth.passivity.scope import Scope, scope_of
from zwidth.passivity.storage import available_storage
from zwidth.passivity.storage.chain_program import COUNTS, ChainProgram, chain_program
from zwidth.passivity.storage.chain_table import DoesNotClose
from zwidth.passivity.storage.gain import Gain
from zwidth.passivity.storage.program import FINE, STEPS, DynamicProgram, program_of
from zwidth.passivity.transmission import as_one_body
from zwidth.passivity.verdict import Verdict
from zwidth.passivity.witness.witness import Witness
from zwidth.passivity.wording import describe_hands
from zwidth.quantity.text import told_quantity
from zwidth.study.bench.adversary import LONGEST, Attack, taken_out
from zwidth.study.bench.motions import NODES, Budget, Spent, budget_of

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
    scope
        What it is about.  Encoder, force limit and converter steps count as the device states them: a motion
        counts all of them, a proof what it was made for.  Every force acts at once, as in the simulator.
    """

    status: Status
    reason: str
    scope: Scope
    withheld: tuple[str, ...] = ()

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
        return Standing(status="active", reason=str(found), scope=_scope(device, law))
    if device.transmission is not None:
        return _behind(device, law)
    withheld: list[str] = []
    for road in (_by_check, _by_a_covering_wall, _by_bounding, _by_a_theorem):
        outcome = road(device, law)
        if isinstance(outcome, Standing):
            return outcome
        withheld += outcome
    refuted, reason = by_value_iteration(device, law, found)
    status: Status = "active" if refuted else "undecided"
    kept_back = () if refuted else tuple(withheld)
    return Standing(status=status, reason=reason, scope=_scope(device, law), withheld=kept_back)


def _behind(device: Device, law: Environment) -> Standing:
    """What the motor feels pays for whatever stands behind it; else what the verdict on this device says."""
    felt = as_one_body(device)
    for road in (_by_check, _by_a_covering_wall, _by_bounding, _by_a_theorem):
        outcome = road(felt, law)
        if isinstance(outcome, Standing) and outcome.status != "active":
            return replace(outcome, scope=outcome.scope.replace(transmission="any"))
    verdict = check(device, law, iterate=False)
    ideal = device.force_limit is device.force_resolution is None
    status: Status = "active" if ideal and verdict.outcome == "active" else "undecided"
    return Standing(status=status, reason=claim(verdict), scope=_scope(device, law))


def _scope(device: Device, law: Environment) -> Scope:
    """Contact made and broken, with all that the device states of its actuator."""
    scope = scope_of(device.motor_side, law)
    if device.transmission is not None:
        scope = scope.replace(transmission="as given")
    return scope.replace(
        force_limit=device.force_limit is not None, force_steps=device.force_resolution is not None
    )


def _by_check(device: Device, law: Environment) -> Standing | list[str]:
    """The verdict on a law without a row, with steps and limit of the actuator counted."""
    if laws_of(law):
        return []
    verdict, why_not = _with_the_actuator(device, law)
    if verdict is not None:
        reason = f"{claim(verdict)}{_paid(device)}"
        return Standing(status="passive", reason=reason, scope=_scope(device, law))
    ideal = check_by_closed_forms(device, law)
    if ideal.is_proved:
        return [f"For an ideal actuator: {claim(ideal)} {why_not}"]
    if ideal.outcome == "active":
        if _takes_out(device, law, ideal):
            return Standing(status="active", reason=claim(ideal), scope=_scope(device, law))
        return [f"For an ideal actuator: {claim(ideal)} With this one that motion does not gain."]
    return [claim(ideal)]


def _by_a_covering_wall(device: Device, law: Environment) -> Standing | list[str]:
    """A spring with laws that add no more than α |Δx|/T, by the proof of a wall with damping α."""
    half = min(half_a_step(device), device.exact("coulomb_friction"))
    covered = covering(_without(device, half), law)  # what is left beside the converter's steps
    if covered is None:
        return []
    less, wall = _without(covered[0], -half), covered[1]
    verdict, why_not = _with_the_actuator(less, wall)
    dry = device.exact("coulomb_friction") - less.exact("coulomb_friction")
    more = f" and {_force(dry, device)} of Coulomb friction" if dry else ""
    most = told_quantity(wall.damping, "virtual_damping", device.motion)
    added = f"What the laws add is never more than that of {most}{more}"
    if verdict is None:
        promised = check_by_closed_forms(less, wall).outcome == "passive"
        return [f"{added}, which is covered for an ideal actuator. {why_not}"] if promised else []
    return Standing(
        status="passive",
        reason=f"{added}, and every such force is covered, contact made and broken: "
        f"{claim(verdict)}{_paid(device)}",
        scope=_scope(device, law),
    )


def _by_bounding(device: Device, law: Environment) -> Standing | list[str]:
    """Force bounding, by its certificate: it is told of steps and limit."""
    if not is_bounded(law):
        return []
    bounding = check_bounding(device, law)
    if bounding.outcome != "passive":
        return [f"The promise of force bounding is withheld. {bounding.claim}"]
    return Standing(status="passive", reason=bounding.claim, scope=bounding.scope)


def _by_a_theorem(device: Device, law: Environment) -> Standing | list[str]:
    """A proof on paper, where the device has nothing that it does not count."""
    chain = laws_of(law)
    if not chain:
        return []
    last = chain[-1]
    theorem = last.theorem(LoopContext(device, law.met))
    if theorem is None:
        return []
    if not theorem.holds_on(device):
        return [f"The promise of {last.describe(device.motion)} is {theorem.reason(device)}."]
    return Standing(
        status="theorem",
        reason=f"By a proof on paper, no certificate: {theorem.statement}.",
        scope=_scope(device, law),
    )


def _with_the_actuator(device: Device, law: Environment) -> tuple[Verdict | None, str]:
    """A proof for contact made and broken that covers the actuator; or why there is none."""
    rise = current_rise(device)
    if rise.ok is False:  # the record says that the force cannot be taken as instant
        return None, f"A proof takes the force as instant, and it is not: {rise.text}."
    spare = device.exact("coulomb_friction") - half_a_step(device)
    if spare < 0:
        return None, (
            f"The converter's steps are not covered: they take {_force(half_a_step(device), device)} of "
            f"Coulomb friction, and the device has {_force(device.exact('coulomb_friction'), device)}."
        )
    verdict = check_by_closed_forms(_without(device, half_a_step(device)), law)
    if verdict.outcome == "passive":
        return verdict, ""
    if verdict.outcome == "passive in contact":
        return None, "Making and breaking contact is not covered."
    half = _force(half_a_step(device), device)
    return None, f"The converter's steps are not covered: the {half} that they take is needed elsewhere."


def _force(value: Fraction, device: Device) -> str:
    return told_quantity(float(value), "force", device.motion)


def _without(device: Device, friction: Fraction) -> Device:
    """The device with so much less friction; with the stiction that it has."""
    if friction == 0:
        return device
    return device.replace(coulomb_friction=device.exact("coulomb_friction") - friction)


def _paid(device: Device) -> str:
    parts = []
    if device.force_resolution is not None:
        half = _force(half_a_step(device), device)
        parts.append(f"the converter's steps are counted: {half} of friction pays for them")
    if device.force_limit is not None:
        parts.append("the force limit is counted")
    return f" ({'; '.join(parts)})" if parts else ""


def _takes_out(device: Device, law: Environment, verdict: Verdict) -> bool:
    """Whether the motion of a verdict gains with the actuator that the device states."""
    if device.force_resolution is None and device.force_limit is None:
        return True
    if not isinstance(verdict.witness, Witness) or verdict.witness.motion.samples > LONGEST:
        return False
    whole = verdict.witness.motion.listed()
    positions, switches = (np.array(xs, float) for xs in (whole.positions, whole.switch_positions))
    return taken_out(device, law, positions, switches if switches.size else None) > 0


# What value iteration adds to the bench, with the actuator that the device states.


MOVES = 4e9
"""Moves that are looked at."""

STATES = 20_000
"""States that a law in a chain may have on its grid."""


def by_value_iteration(device: Device, law: Environment, found: Attack) -> tuple[bool, str]:
    """Whether a motion refutes the law, and what is known; a proof is one of hands on a small grid."""
    no_proof = f"{found}; no criterion covers this law"
    try:
        refuted, said = _of_a_row(device, law) if laws_of(law) else _of_a_law(device, law)
    except InputError as error:
        return False, f"{no_proof}; values were not iterated: {_cause(error)}"
    except Spent:
        return False, f"{no_proof}; nor does value iteration decide it"
    if refuted:
        return True, f"{found}; but value iteration finds more. {said}"
    return False, f"{no_proof}; {said}"


def _of_a_law(device: Device, law: Environment) -> tuple[bool, str]:
    actuator = _actuator(device)
    program = program_of(device, law, **actuator)
    assert isinstance(program, DynamicProgram)  # it is no row
    told = budget_of(program, MOVES)
    played = available_storage(device, law, **actuator, effort=float("inf"), progress=told)
    if played.outcome == "undecided":
        return False, "nor does value iteration decide it"
    return played.outcome == "active", played.claim if played.outcome == "active" else _proved(program)


def _of_a_row(device: Device, law: Environment) -> tuple[bool, str]:
    """On the largest domain on which the law closes."""
    program = _largest(device, law)
    width = program.table.successors.shape[1]
    told = Budget(MOVES // (program.table.states * width * NODES**2))
    for outcome in _rounds(program, told):
        if isinstance(outcome, Gain):
            return True, f"{taken(outcome)}."
        if outcome:
            return False, _proved(program)
    return False, "nor does value iteration decide it"


def _rounds(program: ChainProgram, told: Budget) -> Iterator[bool | Gain | None]:
    """On finer and finer steps: whether it is proved, or a motion."""
    for steps, fine in zip(STEPS, (*FINE, None, None), strict=True):
        storage = program.prove(steps, progress=told)
        yield storage is not None and storage.certificate().verify()
        yield None if fine is None else program.refute(fine, progress=told)


def _largest(device: Device, law: Environment) -> ChainProgram:
    """The dynamic program on the largest domain with no more than `STATES`; a larger one has no fewer."""
    program = None
    for counts in reversed(COUNTS):
        try:
            program = chain_program(device, law, domains=(counts,), most=STATES, **_actuator(device))
        except DoesNotClose:
            if program is None:
                raise
            break
    assert program is not None
    return program


def _actuator(device: Device) -> Any:
    """What of the actuator is counted: all that is known."""
    return {key: getattr(device, key) is not None for key in ("force_limit", "force_resolution")}


def _proved(program: DynamicProgram | ChainProgram) -> str:
    hands = describe_hands(program.hands, program.motion)
    return f"{hands} take no energy out, proved; others may"


def _cause(error: InputError) -> str:
    """What is wrong, without what to try."""
    return str(error).partition(";")[0]
