"""Whether the null-space spring of a redundant arm lets hands take energy out, and what friction covers.

    τ = −P(q) (k (q − q_d) + d_n q̇)

With P₀ = P(q_d) and |q − q_d| ≤ ρ, the spring is one with a potential, k P₀, and a rest of no more than
k η(ρ) ρ in each joint, η ≥ ‖P(q) − P₀‖.  What Coulomb friction has above the rest takes it:

    f_c,i ≥ k η ρ   and   δ_m ⪰ JᵀRJ + (2d + 1) T/2 k P₀ + d_n (P₀ + η 1)

Beyond, loops are looked for on which the rest gives more than friction takes.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from zwidth.arms import Arm, ArmMotion, DescribedArm, PlanarChain
from zwidth.arms.joints import as_matrix, largest_scale
from zwidth.arms.matrix_wall import MatrixWall
from zwidth.arms.need import wall_need
from zwidth.arms.null_space import (
    Loop,
    NullSpaceSpring,
    fast_motion,
    moving,
    projector,
    slow_loop,
    task_jacobian,
)
from zwidth.environment.wall import Wall
from zwidth.errors import InputError
from zwidth.passivity.outcome import Outcome
from zwidth.passivity.result import PassivityAnswer
from zwidth.passivity.scope import Scope
from zwidth.passivity.workspace.question import Question, asked_of
from zwidth.passivity.workspace.report import finite, motion_document, wall_document
from zwidth.quantity.exact import RealLike
from zwidth.quantity.text import shown
from zwidth.quantity.units import parse_number

Array = npt.NDArray[np.float64]

_DISTANCES = (0.05, 0.1, 0.2, 0.4, 0.8, 1.6)
"""At which loops are looked for [rad]; of a smaller region, in parts of it."""
_PARTS = (0.35, 0.6)
_HALVINGS = 50
_ROUNDING = 1e-12
"""Of the matrices: a margin below it may be rounding."""


@dataclass(frozen=True, kw_only=True, repr=False)
class NullSpace(PassivityAnswer):
    """What is known of a wall and a null-space spring together.

    Parameters
    ----------
    question
        The arm, the wall and the loop.
    spring
        The spring.
    within
        How far from the rest was asked about, root of the sum of squares of the joints [rad]; None: the
        ranges of all joints.
    covered
        So far from it no motion takes energy out, by the theorem; 0 where it says nothing [rad].
    wall_factor
        How many times as stiff the wall alone may be at the rest.
    largest_damping
        The largest null-space damping that the joints pay for at the rest, beside wall and spring
        [N·m·s/rad]; 0 where these ask for too much by themselves.
    fast
        A small motion to and fro at the rest that takes energy out; None: none was found.
    loop, slow
        A slow loop of the joints, and its energy; None: none was found.
    """

    FORMAT = "zwidth null space 1"
    certificate = witness = None

    question: Question
    spring: NullSpaceSpring
    within: float | None
    covered: float
    wall_factor: float
    largest_damping: float
    fast: ArmMotion | None
    loop: Loop | None
    slow: ArmMotion | None

    @property
    def outcome(self) -> Outcome:
        """ "active" with a motion, "theorem" where all that was asked about is covered."""
        if self.slow is not None or self.fast is not None:
            return "active"
        return "theorem" if self.within is not None and self.within <= self.covered else "undecided"

    @property
    def claim(self) -> str:
        """What was found, of whom, and of what."""
        if self.outcome == "active":
            return f"{' '.join(self._motions())} {self._by_whom()}"
        near = f"within {shown(self.covered, 'rad')} of the rest of the null-space spring"
        if self.outcome == "theorem":
            near = f"within {shown(self.within or 0.0, 'rad')} of the rest of the null-space spring"
            steps = " Encoder steps are not counted." if any(self.question.arm.resolution) else ""
            return f"No motion of the hands takes energy out {near}, by a proof on paper.{steps}"
        if self.covered:
            return f"No motion was found that takes energy out; that there is none is known {near} alone."
        return "No motion was found that takes energy out, and that there is none is known nowhere."

    def _motions(self) -> Iterator[str]:
        if self.loop is not None and self.slow is not None:
            lasts = shown(self.loop.samples * self.question.period, "s")
            yield (
                f"Once round a slow loop of the joints, {lasts} long, hands take {self._taken(self.slow)} "
                "out: the null-space spring has no potential. No viscous damping mends that, for a slower "
                "loop loses less to it."
            )
        if self.fast is not None:
            yield (
                f"To and fro at the rest in {len(self.fast.joints)} samples hands take "
                f"{self._taken(self.fast)} out: the joints are damped too little for wall and spring."
            )

    def _taken(self, motion: ArmMotion) -> str:
        return shown(-motion.energy, "J")

    def _by_whom(self) -> str:
        return (
            "These are hands that hold the links, such as one at the elbow and one at the end; of a hand at "
            "the end alone nothing is said."
        )

    @property
    def scope(self) -> Scope:
        """A law at every position, read without steps, near the rest or over the ranges."""
        around = "the ranges of all joints"
        if self.within is not None:
            around = f"within {shown(self.within, 'rad')} of the rest, root of the sum of squares"
        return Scope(
            contact="both sides",
            encoder="not counted" if any(self.question.arm.resolution) else "ideal",
            torque="follows the arm",
            region=around,
        )

    def rows(self) -> Iterator[tuple[str, str]]:
        """The main numbers as (name, text) for a report."""
        if self.loop is not None and self.slow is not None:
            far = shown(self.loop.reach(self.spring.rest), "rad")
            force = shown(self.slow.largest_force, "N")
            lost = shown(self.slow.loss, "J")
            yield "slow loop", f"goes {far} from the rest; friction takes {lost}; forces up to {force}"
        yield "friction covers", self._covers()
        if self.spring.damping:
            most = shown(self.largest_damping, "N*m*s/rad")
            text = f"the joints pay for {most} of null-space damping at the rest, beside wall and spring"
            yield "damper", text if self.largest_damping else "beside this wall the joints pay for none"
        alone = f"at the rest it may be {self.wall_factor:.4g} times as stiff"
        yield "wall alone", alone if self.wall_factor else "its virtual damping is too much for the joints"
        if self.slow is not None:
            text = "leave the spring out, or take a null-space damper alone; keep the joints near its rest; "
            yield (
                "change",
                text + "or bound what it gives by an energy tank (Dietrich, Ott & Stramigioli 2016)",
            )

    def _covers(self) -> str:
        """How far from the rest the theorem goes, or why it goes nowhere."""
        if self.covered:
            far = shown(self.covered, "rad")
            return f"the spring's want of a potential up to {far} from the rest, by a bound that is not tight"
        if self.spring.stiffness and not _least_friction(self.question.arm):
            return "nothing: a joint has no Coulomb friction that is known"
        return "nothing: at the rest wall and null space ask for more damping than the joints have"

    @property
    def margin(self) -> float | None:
        """How much farther than asked the theorem goes [rad]; None where no region is asked about."""
        return None if self.within is None else self.covered - self.within

    def numbers(self) -> dict[str, Any]:
        """As plain data, units in the keys."""
        arm, spring, turns = self.question.arm, self.spring, self.question.arm.turns
        size = task_jacobian(arm, spring.rest).shape[0]
        return {
            "arm": arm.name,
            "wall": wall_document(self.question.wall, size, turns),
            "null_stiffness_N_m_per_rad": spring.stiffness,
            "null_damping_N_m_s_per_rad": spring.damping,
            "null_rest_rad": list(spring.rest),
            "regularization": spring.regularization,
            "sample_period_s": self.question.period,
            "delay_samples": self.question.delay_samples,
            "within_rad": self.within,
            "covered_rad": self.covered,
            "wall_factor": finite(self.wall_factor),
            "largest_null_damping_N_m_s_per_rad": finite(self.largest_damping),
            "fast_motion": None if self.fast is None else motion_document(self.fast, turns),
            "slow_loop": None if self.loop is None or self.slow is None else _loop(self.loop, self.slow),
        }


def null_space(
    arm: Arm,
    wall: Wall | MatrixWall,
    *,
    rate: RealLike,
    stiffness: RealLike,
    damping: RealLike = 0,
    rest: Mapping[str, float] | Sequence[float] | None = None,
    regularization: float = 0,
    delay: RealLike = 0,
    within: RealLike | None = None,
) -> NullSpace:
    """Ask what τ = −P(q)(k (q − q_d) + d_n q̇) adds to a wall, P the projector on motions that leave the hand.

    Parameters
    ----------
    arm
        With more joints than the hand has coordinates: `arms.read_arm(…, whole=True)` or a planar chain.
    wall
        As of `zwidth.workspace`, whose torque follows the arm.
    rate, delay
        As of `zwidth.workspace`. The null-space torque is computed once a sample and held.
    stiffness, damping
        k, d_n ≥ 0 of every joint [N·m/rad], [N·m·s/rad].
    rest
        q_d by the names of the joints [rad; m], or of each; None, and of those not named: the middle of the
        ranges.
    regularization
        λ ≥ 0 of the controller's pseudo-inverse, 0.2 in the examples of Franka.
    within
        How far from the rest is asked about, root of the sum of squares [rad]; None: the joints' ranges.

    Raises
    ------
    InputError
        If a number is outside its bound, or the arm has no null space.
    """
    if not isinstance(arm, (DescribedArm, PlanarChain)):
        raise InputError(
            "a null-space spring is asked of chains and of arms from a description, read_arm(…, whole=True)"
        )
    question = asked_of(arm, wall, rate, delay, 2, None, None)
    spring = NullSpaceSpring(
        stiffness=_not_negative(stiffness, "N*m/rad", "null-space stiffness"),
        damping=_not_negative(damping, "N*m*s/rad", "null-space damping"),
        rest=_rest(arm, rest),
        regularization=_not_negative(regularization, "1", "regularization"),
    )
    _has_null_space(arm, spring)
    far = None if within is None else _not_negative(within, "rad", "within")
    found = _slow(arm, question, spring, far)
    return NullSpace(
        question=question,
        spring=spring,
        within=far,
        covered=_covered(question, spring),
        wall_factor=_factor(question, spring),
        largest_damping=_largest_damping(question, spring),
        fast=fast_motion(arm, question.wall, spring, question.period, question.delay_samples),
        loop=None if found is None else found[0],
        slow=None if found is None else found[1],
    )


def _not_negative(value: RealLike, unit: str, name: str) -> float:
    number = float(parse_number(value, unit, name))
    if number < 0:
        raise InputError(f"{name} must be ≥ 0 {unit}, got {number:g}: a spring pulls back, a damper brakes")
    return number


def _rest(
    arm: DescribedArm | PlanarChain, given: Mapping[str, float] | Sequence[float] | None
) -> tuple[float, ...]:
    """q_d, inside the ranges."""
    names = [f"q{i + 1}" for i in range(arm.joint_count)]
    if isinstance(arm, DescribedArm):
        names = [str(name) for name in arm.model.names][1:]
    if given is not None and not isinstance(given, Mapping):
        if len(given) != len(names):
            raise InputError(f"the null-space rest has a value for each of {len(names)} joints")
        given = dict(zip(names, given, strict=True))
    values = {name: sum(ends) / 2 for name, ends in zip(names, arm.joint_range, strict=True)}
    for name, value in (given or {}).items():
        if name not in values:
            raise InputError(f"null-space rest: there is no joint {name!r}; there are {', '.join(names)}")
        low, high = arm.joint_range[names.index(name)]
        if not low <= value <= high:
            raise InputError(f"null-space rest: {name} can be from {low:g} to {high:g}, got {value:g}")
        values[name] = float(value)
    return tuple(values.values())


def _has_null_space(arm: Arm, spring: NullSpaceSpring) -> None:
    jacobian = task_jacobian(arm, spring.rest)
    size = len(jacobian)
    count = np.count_nonzero(jacobian[:, moving(arm)].any(axis=0))  # no fingers beside the hand
    if count <= size:
        pose = "; in pose it has none, held at a point it may" if arm.turns else ""
        raise InputError(
            f"{arm.name} has {count} joints that move the hand, for {size} coordinates of it: no motion of "
            f"the joints leaves the hand where it is, and no null-space spring does anything{pose}"
        )
    if not spring.regularization and np.linalg.matrix_rank(jacobian) < size:
        raise InputError(
            "the null-space spring rests in a singular position, where the pseudo-inverse jumps; give "
            "another null-space rest, or the controller's regularization"
        )


def _slow(
    arm: DescribedArm | PlanarChain, question: Question, spring: NullSpaceSpring, within: float | None
) -> tuple[Loop, ArmMotion] | None:
    """The first loop that takes energy out, those near the rest first."""
    distances = _DISTANCES if within is None else tuple(part * within for part in _PARTS)
    for distance in distances:
        found = slow_loop(arm, question.wall, spring, question.period, question.delay_samples, distance)
        if found is not None and (within is None or found[0].reach(spring.rest) <= within):
            return found
    return None


def _covered(question: Question, spring: NullSpaceSpring) -> float:
    """The largest ρ of the theorem, from below [rad]."""
    arm = question.arm
    friction = _least_friction(arm)
    slope = _slope(arm, spring)

    def holds(far: float) -> bool:
        eta = slope * far
        if eta >= 1 or spring.stiffness * eta * far > friction * (1 - _ROUNDING):
            return False
        return _margin(question, spring, far, eta) > 0

    low, high = 0.0, 1.0
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        low, high = (middle, high) if holds(middle) else (low, middle)
    return low if holds(low) and low > 1e-9 else 0.0


def _least_friction(arm: Arm) -> float:
    """Of the joints that are not held."""
    return min((arm.coulomb_friction[i] for i in moving(arm)), default=0.0) if arm.coulomb_friction else 0.0


def _slope(arm: Arm, spring: NullSpaceSpring) -> float:
    """L with ‖P(q) − P(q_d)‖ ≤ L |q − q_d|."""
    jacobian = task_jacobian(arm, spring.rest)
    moves, turns = _changes(arm, jacobian)
    if not spring.regularization:
        inverse = np.linalg.pinv(jacobian)
        point = len(jacobian) - arm.turns
        size = [
            float(np.linalg.norm(part, 2)) if part.size else 0.0 for part in np.split(inverse, [point], 1)
        ]
        return size[0] * moves + size[1] * turns
    values = np.linalg.svd(jacobian, compute_uv=False)
    extra = float((values / (values**2 + spring.regularization**2)).max())
    return float(np.hypot(moves, turns)) * (0.5 / spring.regularization + extra)


def _changes(arm: Arm, jacobian: Array) -> tuple[float, float]:
    """‖J_p(q) − J_p(q_d)‖ and the same of the turn, each for |q − q_d| = 1."""
    assert isinstance(arm, (DescribedArm, PlanarChain))
    moves = float(np.linalg.norm(arm.second_derivatives, 2))
    if arm.turns != 3:
        return moves, 0.0
    turning = np.linalg.norm(jacobian[-3:], axis=0) > 0.5  # an axis turns with the joints before it
    return moves, float(np.linalg.norm(np.tril(np.outer(turning, turning), -1), 2))


def _needs(question: Question, spring: NullSpaceSpring) -> tuple[Array, Array, Array, Array]:
    """R, J and P at the rest, and what wall and spring ask of the joints there."""
    arm = question.arm
    jacobian = task_jacobian(arm, spring.rest)
    need = wall_need(question.wall, question.period, question.delay_samples, len(jacobian))
    inside = projector(jacobian, spring.regularization)
    share = (2 * question.delay_samples + 1) * question.period / 2 * spring.stiffness
    hand = need.stiffness_share + need.bound
    return hand, jacobian, inside, jacobian.T @ hand @ jacobian + share * inside


def _margin(question: Question, spring: NullSpaceSpring, far: float, eta: float) -> float:
    """What the joints have beyond need wherever |q − q_d| ≤ far, from below [N·m·s/rad]."""
    hand, jacobian, inside, needed = _needs(question, spring)
    values, vectors = np.linalg.eigh(hand)
    root = (vectors * np.sqrt(np.maximum(values, 0.0))) @ vectors.T
    moves, turns = _changes(question.arm, jacobian)
    point = len(jacobian) - question.arm.turns
    change = far * (_size(root[:, :point]) * moves + _size(root[:, point:]) * turns)
    lost = 2 * _size(root @ jacobian) * change + change**2
    damper = spring.damping * (inside + eta * np.eye(len(inside)))
    left = as_matrix(question.arm.damping) - needed - damper
    rounding = _ROUNDING * (_size(as_matrix(question.arm.damping)) + _size(needed) + _size(damper))
    free = moving(question.arm)
    return float(np.linalg.eigvalsh(left[np.ix_(free, free)])[0]) - lost - rounding


def _size(matrix: Array) -> float:
    return float(np.linalg.norm(matrix, 2)) if matrix.size else 0.0


def _factor(question: Question, spring: NullSpaceSpring) -> float:
    """How many times as stiff the wall alone may be at the rest."""
    jacobian = task_jacobian(question.arm, spring.rest)
    need = wall_need(question.wall, question.period, question.delay_samples, len(jacobian))
    base = as_matrix(question.arm.damping) - jacobian.T @ need.bound @ jacobian
    free = np.ix_(moving(question.arm), moving(question.arm))
    return float(largest_scale(base[free], (jacobian.T @ need.stiffness_share @ jacobian)[free]))


def _largest_damping(question: Question, spring: NullSpaceSpring) -> float:
    _, _, inside, needed = _needs(question, spring)
    free = np.ix_(moving(question.arm), moving(question.arm))
    return float(largest_scale((as_matrix(question.arm.damping) - needed)[free], inside[free]))


def _loop(loop: Loop, motion: ArmMotion) -> dict[str, Any]:
    return {
        "energy_J": motion.energy,
        "friction_takes_J": motion.loss,
        "samples": loop.samples,
        "centre_rad": loop.centre.tolist(),
        "cosine_rad": loop.cosine.tolist(),
        "sine_rad": loop.sine.tolist(),
        "largest_force_N": motion.largest_force,
        "imposed_by": motion.imposed_by,
    }
