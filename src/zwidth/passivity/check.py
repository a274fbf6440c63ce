"""The main verb: is this device, rendering this environment, passive?

Nothing is claimed on the prover's word: "passive" needs a certificate that the independent checker accepts,
"active" a violation that it confirms or a motion whose energy it recomputes.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from fractions import Fraction
from functools import partial
from math import inf
from typing import TYPE_CHECKING, Any, overload

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.device.instead import instead_of_device
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.system import is_system
from zwidth.model.environment.transfer_function import as_environment
from zwidth.model.pairs import Pair
from zwidth.passivity.certificate import Certificate, certify_box
from zwidth.passivity.corners import Loop, best_corner, worst_corners
from zwidth.passivity.criterion_choice import Decision, decide
from zwidth.passivity.linear.criterion import LinearProof, LinearRefutation, decide_linear, tightest
from zwidth.passivity.linear.loop import HIGH_DEGREE, linear_loop
from zwidth.passivity.linear_verdict import LinearVerdict
from zwidth.passivity.outcome_evidence import Finding
from zwidth.passivity.scope import Also, Contact, Scope, as_contact, scope_of
from zwidth.passivity.value_iteration_fallback import has_gap, with_value_iteration
from zwidth.passivity.verdict import Verdict
from zwidth.passivity.witness.touching import refute_touching
from zwidth.passivity.witness.violation import Violation, refute_friction
from zwidth.passivity.witness.witness import Witness

if TYPE_CHECKING:
    from zwidth.model.arms import Arm
    from zwidth.model.arms.wall import MatrixWall
    from zwidth.model.environment import Wall
    from zwidth.passivity.pairs import PairVerdict
    from zwidth.passivity.pairs.held import HeldVerdict
    from zwidth.passivity.workspace import Workspace

MOST_CORNERS_OF_HIGH_DEGREE = 8
"""Corners of intervals that are decided for a law of high order."""

Evidence = Violation | Witness


@overload
def check(
    device: Device,
    environment: Environment | Any,
    *,
    contact: str = ...,
    iterate: bool = ...,
    progress: Callable[[int], None] | None = ...,
) -> Verdict: ...
@overload
def check(device: Pair) -> PairVerdict: ...
@overload
def check(device: Pair, *, leader: Any = ..., follower: Any = ...) -> PairVerdict | HeldVerdict: ...
@overload
def check(device: Arm, environment: Wall | MatrixWall, **of_an_arm: Any) -> Workspace: ...
def check(
    device: Device | Arm | Pair,
    environment: Environment | Any = None,
    *,
    contact: str = "made and broken",
    iterate: bool = True,
    progress: Callable[[int], None] | None = None,
    **of_an_arm: Any,
) -> Verdict | Workspace | PairVerdict | HeldVerdict:
    """Decide whether a hand can ever take energy out of the sampled loop.

    Passive means ∫ f_h v dt + E(0) ≥ 0 for every motion, E(0) finite.  For a
    linear law of force H(z), exactly if

        b ≥ (T/2) Re{(1 − e^{−jωT}) H(e^{jωT})}/(1 − cos ωT),  0 < ω ≤ π/T,

    and H is stable (Colgate & Schenkel 1997; Fardad & Bamieh 2009); with a delay of any length in the form
    derived in the documentation; and, with an encoder of resolution Δ, f_c must cover its error: f_c ≥ K Δ/2
    for a spring (Abbott & Okamura 2005).  Equality counts as passive.  A damped wall is covered with contact
    made and broken where b ≥ (2d + 1) K T/2 + |B| Σ|w_j| and f_c ≥ (K + |B| ‖h_v‖₁) Δ/2, clamped or not.
    Where these conditions leave a gap values are iterated as in `available_storage`, for some seconds of one
    core at most.

    Laws without H(z) are decided too: nonlinear springs by their slopes, laws in a chain by the force
    bounding that ends them or a wall that covers them, all by value iteration; `decided_by` says which.

    Parameters
    ----------
    device
        The device; where parameters are intervals the verdict holds for all values.  An arm of several joints
        is answered by `workspace`, whose further arguments (rate, delay, …) are given by name.  A `Pair` of
        arms that follow each other stands alone, and has its verdict from `check_pair`; with
        ``follower=hand`` or ``leader=hand``, None for nobody, from `check_held_pair`.
    environment
        Whatever can be rendered: an `Environment`, what `render` gives, a discrete python-control or
        scipy.signal system H(z); for an arm a `Wall` or a `MatrixWall`.
    contact
        "made and broken": a one-sided law is "passive" if no hand gains that touches and leaves at will, and
        "passive in contact" if this is proved only of hands that stay inside.  "kept": the question is about
        those alone.
    iterate
        False for closed forms alone, in milliseconds: what they leave open stays open.
    progress
        Told the number of states that still improve, where values are iterated.
    of_an_arm
        Further arguments of `workspace`, by name.

    Raises
    ------
    InputError
        If the environment cannot be sampled at this rate or is not an environment.
    """
    if environment is None and not isinstance(device, Pair):
        raise InputError("the environment is missing: check(device, zw.Wall(300)) asks for a wall of 300 N/m")
    given = {"contact": as_contact(contact), "iterate": iterate, "progress": progress}
    asked = of_an_arm | {name: told for name, told in given.items() if told != _USUAL[name]}
    called, takes, answer, why = next(own for kind, own in _SUBJECTS.items() if isinstance(device, kind))
    for name in asked:
        if name not in takes:
            why = _OF_THE_LAW if name == "discretization" else why
            raise InputError(f"check of {called} takes {', '.join(takes)}, and no {name}: {why}")
    verdict: Verdict | Workspace | PairVerdict | HeldVerdict = answer(device, environment, **asked)
    return verdict


def _check_device(
    device: Device,
    environment: Any,
    contact: str = "made and broken",
    iterate: bool = True,
    progress: Callable[[int], None] | None = None,
) -> Verdict:
    law = _as_law(device, environment)
    if device.transmission is not None:
        from zwidth.passivity.transmission import check_transmission  # few devices have one

        judged = partial(_check_device, environment=law, contact=contact, iterate=iterate, progress=progress)
        return check_transmission(device, law, as_contact(contact), judged)
    if not law.has_transfer_function:
        from zwidth.passivity.other_laws import check_other  # few loops have such a law

        return check_other(device, law, check_by_closed_forms, progress, iterate)
    verdict = check_by_closed_forms(device, law, contact=contact)
    if not iterate or contact == "kept" or not has_gap(device, law, verdict):
        return verdict
    return with_value_iteration(device, law, verdict, progress)


def _check_pair(pair: Pair, environment: Any, **hands: Any) -> PairVerdict | HeldVerdict:
    if environment is not None:
        raise InputError(
            "a pair of arms holds its coupling in itself: check(pair), or check(pair, follower=hand) where a "
            "known hand holds an arm"
        )
    if hands:
        from zwidth.passivity.pairs.held import check_held_pair

        return check_held_pair(pair, **hands)
    from zwidth.passivity.pairs import check_pair

    return check_pair(pair)


def _check_arm(arm: Any, wall: Any, **further: Any) -> Workspace:
    from zwidth.model.arms import Arm  # numpy takes its time

    if not isinstance(arm, Arm):
        raise InputError(f"the first argument is a Device or an arm, {_instead_of_one(arm)}")
    from zwidth.passivity.workspace import workspace

    if "rate" not in further:
        raise InputError('an arm has no rate of its own: give rate=…, such as rate="1 kHz"')
    return workspace(arm, wall, **further)


_USUAL = {"contact": "made and broken", "iterate": True, "progress": None}

_SUBJECTS: Mapping[type, tuple[str, tuple[str, ...], Callable[..., Any], str]] = {
    Device: ("a device", tuple(_USUAL), _check_device, "its rate and its delay are in the device itself"),
    Pair: (
        "a pair", ("leader", "follower"), _check_pair,
        "its coupling is in itself; where a known hand holds an arm it is check(pair, follower=hand)",
    ),
    object: (
        "an arm", ("rate", "delay", "points", "torque_held_up_to", "largest_force"), _check_arm,
        "its wall acts on both sides of where it rests",
    ),
}  # fmt: skip
"""What can be asked about, what each takes by name, who answers, why it takes no more; an arm comes last."""

_OF_THE_LAW = (
    "it belongs to the law: check(device, ContinuousTransferFunction(system, discretization=…)); a discrete "
    "system has its own H(z)"
)


def check_by_closed_forms(
    device: Device, environment: Environment | Any, *, contact: str = "made and broken"
) -> LinearVerdict:
    """`check` without value iteration: exact, in milliseconds, of every hand."""
    asked, law = as_contact(contact), _as_law(device, environment)
    return replace(_decided(device, law, asked), box=(device, law), asked=asked)


def _decided(device: Device, law: Environment, asked: Contact) -> LinearVerdict:
    corners = worst_corners(device, law)
    _require_few(corners)
    decisions = [decide(*corner) for corner in corners]
    failing = [k for k, d in enumerate(decisions) if not d.is_provable]
    if not failing:
        proofs = certify_box(device, law, corners, decisions)
        if proofs is not None:
            found = _passive(device, law, corners, decisions, proofs, asked)
            touched = _touched(device, law, found)
            return found if touched is None else touched
        return _undecided(device, law, corners[0], decisions[0], "between corners")
    worst = _worst(failing, decisions)
    at, decision = corners[worst], decisions[worst]
    shown, certain = _refute(decision), device.is_certain and len(corners) == 1
    best = None if certain else _refute_best(device, law)
    if best is not None:
        return _active(device, law, *(best if shown is None else (at, decision, shown)), best[2])
    if certain and shown is not None:
        return _active(device, law, at, decision, shown)
    finding: Finding = "open" if shown is None else "depends on values"
    found = _undecided(device, law, at, decision, finding, shown)
    touched = None if asked == "kept" else _touched(device, law, found)
    return found if touched is None else touched


def _require_few(corners: list[Loop]) -> None:
    """Refuse many corners of a law of high order: each is decided, and its proof checked, by itself."""
    if len(corners) <= MOST_CORNERS_OF_HIGH_DEGREE:
        return
    degree = max(linear_loop(*corner).degree for corner in corners)
    if degree > HIGH_DEGREE:
        raise InputError(
            f"the intervals have {len(corners)} corners, and the order of the environment plus the delay in "
            f"samples is {degree}: above {HIGH_DEGREE} at most {MOST_CORNERS_OF_HIGH_DEGREE} are decided; "
            "give single values for some parameters"
        )


def _touched(device: Device, law: Environment, verdict: LinearVerdict) -> LinearVerdict | None:
    """Active, by a motion that touches and leaves, where no proof covers that; or None."""
    open_still = verdict.outcome in ("passive in contact", "undecided")
    if not (open_still and law.unilateral and device.is_certain and law.is_certain):
        return None
    witness = refute_touching(verdict.decision.setting, law)
    if witness is None:
        return None
    scope = verdict.scope.replace(contact="made and broken", also=())
    return replace(verdict, outcome="active", scope=scope, certificate=None, motion=witness, at_limit=False)


def _as_law(device: Device, environment: Environment | Any) -> Environment:
    """The environment, once what comes first is a device."""
    if not isinstance(device, Device):
        raise InputError(f"the first argument is a Device, {_instead_of_one(device)}")
    if type(environment).__name__ == "MatrixWall":
        raise InputError("a MatrixWall is of several coordinates: give an arm in the place of the device")
    return as_environment(environment, device=device)


def _passive(
    device: Device,
    law: Environment,
    corners: list[Loop],
    decisions: list[Decision],
    proofs: list[dict[str, Any]],
    asked: Contact,
) -> LinearVerdict:
    certificate = Certificate(tuple(proofs))
    tight = _tightest(decisions)
    at, decision = corners[tight], decisions[tight]
    covered = certificate.covered()
    if covered is None or covered.shows != "passive":  # nothing is claimed that the checker does not accept
        return _undecided(device, law, at, decision, "unconfirmed")
    narrowed = asked == "kept" and covered.contact == "made and broken"  # no more is said than was asked
    scope = _scope(device, law, decision).replace(
        contact="kept" if narrowed else covered.contact,
        fed_with="" if narrowed else covered.fed_with,
        also=() if narrowed else _also(certificate, law),
    )
    return LinearVerdict(
        "passive in contact" if covered.contact == "kept" != asked else "passive",
        scope,
        *at,
        certificate,
        at_limit=any(_at_limit(d) for d in decisions),
        decision=decision,
    )


def _also(certificate: Certificate, law: Environment) -> tuple[Also, ...]:
    if certificate.is_of_springs:
        return ("springs",)
    return ("clamped",) if certificate.kind == "contact" and not law.clamped else ()


def _scope(device: Device, law: Environment, at: Decision) -> Scope:
    """What is asked, with the friction of the corner that the numbers speak of."""
    return scope_of(device, law).replace(
        damping=float(at.loop.damping), coulomb_friction=float(at.setting.coulomb_friction)
    )


def _at_limit(decision: Decision) -> bool:
    """True when the smallest decrease of b or f_c would lose the proof.

    Of a clamped law only the conditions for contact made and broken decide.  A criterion that touches zero
    may do so at a pole on the unit circle, whatever b is: so a slightly smaller b is decided too.
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


def _worst(failing: list[int], decisions: list[Decision]) -> int:
    """Of the corners that are not proved the one that asks for most: of damping, else of friction."""
    refuted = [k for k in failing if not isinstance(decisions[k].viscous, LinearProof)]
    if len(refuted or failing) == 1:
        return (refuted or failing)[0]
    if refuted:
        return max(refuted, key=lambda k: tightest(decisions[k].loop)[0])

    def friction(k: int) -> float:
        need = decisions[k].sufficient_friction
        return inf if need is None else float(need)

    return max(failing, key=friction)


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
    if decision.viscous.reason == "too close to zero":
        return None
    violation = Violation(decision.setting, decision.viscous)
    return violation if violation.verify() else violation.witness


def _refute_best(device: Device, law: Environment) -> tuple[Loop, Decision, Evidence] | None:
    """What shows that the loop is active even at the best values within the intervals, or None."""
    best = best_corner(device, law)
    if best is None:
        return None
    decision = decide(*best)
    shown = None if decision.is_provable else _refute(decision)
    return None if shown is None else (best, decision, shown)


def _active(
    device: Device,
    law: Environment,
    corner: Loop,
    decision: Decision,
    shown: Evidence,
    best: Evidence | None = None,
) -> LinearVerdict:
    scope = _scope(device, law, decision).replace(contact=shown.contact)
    elsewhere = None if best is None or best.setting == shown.setting else best
    return LinearVerdict(
        "active", scope, *corner, decision=decision, best_corner=elsewhere, **_as_evidence(shown)
    )


def _undecided(
    device: Device,
    law: Environment,
    corner: Loop,
    decision: Decision,
    finding: Finding,
    shown: Evidence | None = None,
) -> LinearVerdict:
    scope = _scope(device, law, decision)
    return LinearVerdict(
        "undecided", scope, *corner, decision=decision, finding=finding, **_as_evidence(shown)
    )


def _as_evidence(shown: Evidence | None) -> dict[str, Any]:
    """Where a verdict keeps it."""
    return {"violation": shown} if isinstance(shown, Violation) else {"motion": shown}


def _instead_of_one(thing: object) -> str:
    """What was given; and what a plant is as a device."""
    got = instead_of_device(thing)
    if not is_system(thing):
        return got
    return (
        f"{got}: a plant 1/(m s² + b s) is Device(mass=m, damping=b, sample_period=T); of another one the "
        "damping is the input index of its impedance, velocity → force: zw.ports.passivity_indices(Z).input"
    )
