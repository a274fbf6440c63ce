"""One verdict against the referee: is it wrong?

passive, theorem     the criterion holds at its tightest frequency, and no motion tried takes energy out
passive in contact   the same for motions that stay inside; whether one that touches does is counted
active               the motion, run again, takes out what it is said to, and more than was stored; or the
                     criterion is violated, or H unstable, in numbers of the referee's own
undecided, refused   never wrong
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import acos
from typing import Any

import numpy as np

import zwidth as zw
from zwidth.errors import InputError
from zwidth.passivity.check import check_by_closed_forms

from .loops import Case
from .motions import ROUNDING, attack, refutes
from .referee import PlainLoop, ball, differs, energies, largest_pole, needed, needed_at, violated

OUTCOMES = ("passive", "passive in contact", "theorem", "active", "undecided", "refused")
PASSIVE, KEPT, THEOREM, ACTIVE, UNDECIDED, REFUSED = OUTCOMES

LIGHT, HEAVY = (48, 100), (128, 600)
"""Motions drawn, and steps by which the best is improved."""

HEAVY_SHARE = 0.04

SLOWEST = 1e-12
"""The smallest ωT that is looked at."""

MOTION_SHARE = 0.005
"""Of violations whose motion is made and run again."""

SHORT, LONG, FEW = 250, 20_000, 2_000
"""Samples of a motion that is always run again, of one that is where nothing else confirms it, and those
that longer ones are cut to."""


@dataclass(frozen=True)
class Judged:
    """What came out for one loop.

    Parameters
    ----------
    wrong
        What contradicts the outcome, "" for nothing.
    touched
        True where a proof of kept contact is defeated by a hand that touches and leaves.
    """

    kind: str
    outcome: str
    wrong: str = ""
    touched: bool = False


def judge(case: Case, rng: np.random.Generator) -> Judged:
    """Decide a loop and look for a contradiction."""
    try:
        verdict = decide(case)
    except InputError:
        return Judged(case.kind, REFUSED)
    said = str(verdict.outcome)
    if said not in OUTCOMES:
        return Judged(case.kind, UNDECIDED, f"unknown outcome {said!r}")
    if case.points:
        return Judged(case.kind, said, against_points(case, said))
    if said == ACTIVE:
        return Judged(case.kind, said, against_active(verdict, case.loop, rng))
    if said in (PASSIVE, THEOREM, KEPT):
        wrong, touched = against_passive(case.loop, rng, kept=said == KEPT)
        return Judged(case.kind, said, wrong, touched)
    return Judged(case.kind, said)


def decide(case: Case) -> Any:
    """The verdict; the game, which takes seconds, only where it is asked for."""
    if case.loop.resolution and not case.full:
        return check_by_closed_forms(case.device, case.law)
    return zw.check(case.device, case.law)


def against_passive(loop: PlainLoop, rng: np.random.Generator, *, kept: bool) -> tuple[str, bool]:
    """(what contradicts a proof or "", whether a hand that touches and leaves defeats it)."""
    if loop.linear_inside:
        wrong = _criterion(loop)
        if wrong:
            return wrong, False
    angle = needed(loop)[1]
    effort = HEAVY if rng.random() < HEAVY_SHARE else LIGHT
    found = attack(loop, rng, *effort, kept=kept, angle=angle)
    if found.score > ROUNDING and refutes(loop, found, kept=kept):
        return (
            f"a motion of {len(found.positions)} samples takes out {found.score:.3g} of what is lost",
            False,
        )
    if not kept:
        return "", False
    through = attack(loop, rng, *effort, kept=False, angle=angle)
    return "", through.score > ROUNDING and refutes(loop, through, kept=False)


def _criterion(loop: PlainLoop) -> str:
    """Whether the linear criterion is violated, or H unstable; "" if not."""
    asked, angle = needed(loop)
    close = asked > float(loop.damping) * (1 - 1e-6)
    if (close or needed_at(loop, SLOWEST) > ball(loop.damping)) and violated(loop, angle):
        return f"the criterion asks for {asked:.12g} at ωT = {angle:.6g}"
    if largest_pole(loop) > 1 + 1e-6:
        return "H(z) is unstable"
    if loop.static is not None and loop.static < 0:
        return "H(1) < 0"
    return ""


def against_active(verdict: Any, loop: PlainLoop, rng: np.random.Generator) -> str:
    """Why an active verdict is not confirmed, "" if it is."""
    violation, witness = evidence_of(verdict, with_motion=rng.random() < MOTION_SHARE)
    if violation is None and witness is None:
        return "active without evidence"
    if violation is not None and not violation.verify():
        return "the checker refuses the violation"
    motion = getattr(witness, "motion", None)
    samples = getattr(motion, "samples", 0)
    if motion is not None and samples <= SHORT:
        wrong = _run_again(witness, loop)
        if wrong or violation is None:
            return wrong
    if loop.linear_inside and (_criterion(loop) or _violated_where_told(violation, loop)):
        return ""
    if motion is not None and samples <= LONG:
        return _run_again(witness, loop)
    for _ in range(20):
        found = attack(loop, rng, *HEAVY, kept=False)
        if found.score > ROUNDING and refutes(loop, found, kept=False):
            return ""
    if motion is not None:
        return "" if motion.repeats and _by_fewer_rounds(motion, loop) else "a long motion, not confirmed"
    return "active, not confirmed"


def _violated_where_told(violation: Any, loop: PlainLoop) -> bool:
    """Whether the criterion, in the referee's own numbers, is violated at the frequency that is named."""
    proof = violation.to_dict()["proof"] if violation is not None else {}
    if proof.get("kind") != "criterion":
        return False
    return bool(needed_at(loop, acos(float(Fraction(proof["cosine"])))) > ball(loop.damping))


def evidence_of(verdict: Any, *, with_motion: bool) -> tuple[Any, Any]:
    """(violation, motion) that an active verdict stands on; of a violation the motion only if asked for."""
    violation = getattr(verdict, "violation", None)
    if violation is not None and hasattr(violation, "verify"):
        return violation, violation.witness if with_motion and hasattr(violation, "witness") else None
    return None, getattr(verdict, "witness", None)


def _run_again(witness: Any, loop: PlainLoop) -> str:
    listed = witness.motion.listed()
    x = [Fraction(v) for v in listed.positions]
    switches = [Fraction(v) for v in listed.switch_positions] or _switches_of(witness)
    stored = Fraction(0) if _can_be_made_again(loop, x) else loop.stored
    for digits in (60, 600, 4000):
        out = energies(loop, x, switches, digits=digits)[-1]
        if out > ball(stored):
            break
    else:
        return f"the motion takes out {float(out):.6g} J, stored {float(stored):.6g} J"
    told = witness.exact_energy
    if differs(out, Fraction(told)):
        return f"the motion takes out {float(out):.17g} J, not {float(told):.17g} J"
    return ""


def _can_be_made_again(loop: PlainLoop, x: list[Fraction]) -> bool:
    """Whether it ends where it began, at a reading without force, and a law that forgets has only to wait."""
    outside = x[0] // loop.resolution <= 0 if loop.resolution else x[0] <= 0
    return loop.fed != "both" and outside and x[0] == x[-1] and largest_pole(loop) < 1


def _switches_of(witness: Any) -> list[Fraction] | None:
    """Positions within samples, where they are kept in the document alone."""
    document = witness.to_dict()
    for unit in ("m", "rad"):
        if document.get(f"switch_positions_{unit}"):
            return [Fraction(v) for v in document[f"switch_positions_{unit}"]]
    return None


def _by_fewer_rounds(motion: Any, loop: PlainLoop) -> bool:
    """Whether a long motion gains more in later rounds, of those that can be run."""
    span = max(r.last - r.first for r in motion.repeats)
    few = max(2, FEW // span)
    listed = [motion.repeated(n).listed() for n in (few, 2 * few)]
    if len(listed[1].positions) > 4 * LONG:
        return False
    less, more = (energies(loop, one.positions, one.switch_positions or None)[-1] for one in listed)
    return bool(more > less)


def against_points(case: Case, said: str) -> str:
    """What is said of all values against what is said of some of them."""
    for device, law in case.points:
        try:
            point = str(decide(Case(case.kind, device, law, case.loop)).outcome)
        except InputError:
            continue
        # kept contact is passive and a hand that touches and leaves gains: no contradiction
        if {said, point} in ({PASSIVE, ACTIVE}, {THEOREM, ACTIVE}):
            return f"{said} for all values, {point} for {device!r}, {law!r}"
    return ""
