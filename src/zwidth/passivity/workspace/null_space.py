"""Whether the null-space spring of a redundant arm lets hands take energy out, and what friction covers.

    τ = −P(q) (k (q − q_d) + d_n q̇)

With P₀ = P(q_d) the spring is one with a potential, k P₀, and what lacks to it.  Within ρ of the rest Coulomb
friction takes whatever that moves:

    f_c,i ≥ k |((P − P₀)(q − q_d))_i|   and   δ_m ≻ JᵀRJ + (2d + 1) T/2 k P₀ + d_n (P₀ + η 1),   η ≥ ‖P − P₀‖

The independent checker bounds both.  Beyond, loops are looked for on which the lack gives more than
friction takes.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from zwidth.errors import InputError
from zwidth.model.arms import Arm, ArmMotion, DescribedArm, PlanarChain
from zwidth.model.arms.joints import as_matrix, largest_scale
from zwidth.model.arms.null_space import Loop, NullSpaceSpring, fast_motion, moving, slow_loop, task_jacobian
from zwidth.model.arms.wall import MatrixWall
from zwidth.model.environment.wall import Wall
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.result import PassivityAnswer, share_left
from zwidth.passivity.scope import Outcome, Scope
from zwidth.passivity.workspace.certificate import largest_certified, needed_at_rest, null_space_certificate
from zwidth.passivity.workspace.question import Question, asked_of
from zwidth.passivity.workspace.verdict import (
    OF_JOINTS_THAT_GIVE_WAY,
    arm_document,
    between,
    motion_document,
    wall_document,
)
from zwidth.quantity.answered import answered, known
from zwidth.quantity.exact import RealLike
from zwidth.quantity.text import shown
from zwidth.quantity.units import in_si

Array = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, repr=False)
class NullSpace(PassivityAnswer):
    """What is known of a wall and a null-space spring together."""

    _FORMAT = "zwidth null space 1"
    _PICTURE = "null_space_figure"
    _BESIDES = (
        ("fast_motion", "null, or a small one to and fro at the rest that takes energy out"),
        (
            "slow_loop",
            "null, or `energy_J`, `friction_takes_J`, `samples`, `largest_force_N`, `imposed_by` and "
            "$c$, $a$, $b$ of $q_k=c+a\\cos(2\\pi k/N)+b\\sin(2\\pi k/N)$ as `centre_rad`, `cosine_rad`, "
            "`sine_rad`",
        ),
    )
    witness = None  # its motions are reckoned in doubles, and no evidence

    question: Question = answered(
        "the arm, the wall and the loop",
        stands_as={"sample_period_s": "period", "delay_samples": "delay_samples"},
    )
    spring: NullSpaceSpring = answered(
        "the spring",
        stands_as={
            "null_stiffness_N_m_per_rad": "stiffness",
            "null_damping_N_m_s_per_rad": "damping",
            "null_rest_rad": "rest",
            "regularization": "regularization",
        },
    )
    within: float | None = answered(
        "how far from the rest was asked about, root of the sum of squares of the joints; null: the ranges "
        "of all joints",
        unit="rad",
    )
    covered: float = answered(
        "so far from it no motion takes energy out, as the checker has proved: `within` where it proves "
        "that, else the largest distance to some 5 %; 0 where it proves nothing",
        unit="rad",
    )
    why_not_more: str = answered(
        "what the checker said of a region that is a little larger, or of every region; empty where all that "
        "was asked is proved"
    )
    wall_factor: float = answered("how many times as stiff the wall alone may be at the rest", finite=True)
    largest_damping: float = answered(
        "the largest null-space damping that the joints pay for at the rest, beside wall and spring; 0 where "
        "these ask for too much by themselves",
        key="largest_null_damping",
        unit="N*m*s/rad",
        finite=True,
    )
    fast: ArmMotion | None = known(
        "a small motion to and fro at the rest that takes energy out; None: none was found"
    )
    loop: Loop | None = known("a slow loop of the joints; None: none was found")
    slow: ArmMotion | None = known("its energy")
    certificate: Certificate | None = known(
        "the proof of the region that was asked about; None: there is none", default=None
    )

    @property
    def outcome(self) -> Outcome:
        """ "active" with a motion; "passive" with a certificate, of an arm with steps without them."""
        if self.slow is not None or self.fast is not None:
            return "active"
        if self.certificate is None:
            return "undecided"
        return "passive without encoder steps" if any(self.question.arm.resolution) else "passive"

    @property
    def claim(self) -> str:
        """What was found, of whom, and of what."""
        if self.outcome == "active":
            return (
                f"{' '.join(self._motions())} These are hands that hold the links, such as one at the elbow "
                "and one at the end; of a hand at the end alone nothing is said."
                + ("" if self.slow is None else " Leave the spring out, or take a null-space damper alone.")
            )
        more = f" {OF_JOINTS_THAT_GIVE_WAY}" if self.question.arm.transmissions else ""
        if self.within is not None and self.certificate is not None:
            steps = " Encoder steps are not counted." if any(self.question.arm.resolution) else ""
            return f"No motion of the hands takes energy out {self._near(self.within)}.{steps}{more}"
        found = "looked for" if more else "found"
        if self.covered:
            near = f"proved {self._near(self.covered)} alone.{more}"
            return f"No motion was {found} that takes energy out; that there is none is {near}"
        return f"No motion was {found} that takes energy out, and that there is none is proved nowhere."

    @staticmethod
    def _near(distance: float) -> str:
        return f"within {shown(distance, 'rad')} of the rest of the null-space spring"

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
            transmission=between(self.question.arm),
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
            yield (
                "or",
                "keep the joints near its rest; or bound what it gives by an energy tank (Dietrich, Ott & "
                "Stramigioli 2016)",
            )

    def _covers(self) -> str:
        """How far from the rest it is proved, or why nowhere."""
        if self.covered:
            far = shown(self.covered, "rad")
            return f"the spring's want of a potential up to {far} from the rest, proved"
        return f"nothing: {self.why_not_more}"

    def _left(self) -> float | None:
        """Of the distance from the rest that is proved; beyond one proved as asked it is not known."""
        return None if self.certificate else share_left(self.within, self.covered)

    def numbers(self) -> dict[str, Any]:
        """As plain data, units in the keys."""
        arm = self.question.arm
        size = task_jacobian(arm, self.spring.rest).shape[0]
        return {
            **arm_document(arm),
            "wall": wall_document(self.question.wall, size, arm.turns),
            **super().numbers(),
            "fast_motion": motion_document(self.fast, arm.turns),
            "slow_loop": None if self.loop is None or self.slow is None else _loop(self.loop, self.slow),
        }


def null_space(
    arm: Arm,
    wall: Wall | MatrixWall,
    *,
    rate: RealLike,
    stiffness: RealLike,
    damping: RealLike = 0,
    rest: Mapping[str, float | str] | Sequence[float | str] | None = None,
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
    certificate = None if far is None else null_space_certificate(question, spring, far)[0]
    covered, why = (far or 0.0, "") if certificate else largest_certified(question, spring)
    loop, rigid = (question.wall, spring, question.period, question.delay_samples), not arm.transmissions
    found = slow_loop(arm, *loop, far) if rigid else None  # no hand moves motors as it likes
    return NullSpace(
        question=question,
        spring=spring,
        within=far,
        covered=covered,
        why_not_more=why,
        wall_factor=_factor(question, spring),
        largest_damping=_largest_damping(question, spring),
        fast=fast_motion(arm, *loop) if rigid else None,
        loop=None if found is None else found[0],
        slow=None if found is None else found[1],
        certificate=certificate,
    )


def _not_negative(value: RealLike, unit: str, name: str) -> float:
    number = in_si(value, unit, name)
    if number < 0:
        raise InputError(f"{name} must be ≥ 0 {unit}, got {number:g}: a spring pulls back, a damper brakes")
    return number


def _rest(
    arm: DescribedArm | PlanarChain, given: Mapping[str, float | str] | Sequence[float | str] | None
) -> tuple[float, ...]:
    """q_d, inside the ranges."""
    names = arm.joint_names
    if given is not None and not isinstance(given, Mapping):
        if len(given) != len(names):
            raise InputError(f"the null-space rest has a value for each of {len(names)} joints")
        given = dict(zip(names, given, strict=True))
    values = {name: sum(ends) / 2 for name, ends in zip(names, arm.joint_range, strict=True)}
    for name, value in (given or {}).items():
        if name not in values:
            raise InputError(f"null-space rest: there is no joint {name!r}; there are {', '.join(names)}")
        place = names.index(name)
        low, high = arm.joint_range[place]
        values[name] = at = in_si(value, "m" if arm.sliding[place] else "rad", f"null-space rest of {name}")
        if not low <= at <= high:
            raise InputError(f"null-space rest: {name} can be from {low:g} to {high:g}, got {at:g}")
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
            "another rest, --null-rest, or the controller's --regularization (in Python rest, regularization)"
        )


def _factor(question: Question, spring: NullSpaceSpring) -> float:
    """How many times as stiff the wall alone may be at the rest."""
    jacobian = task_jacobian(question.arm, spring.rest)
    need = question.need(len(jacobian))
    load = jacobian.T @ need.stiffness_share @ jacobian
    return _largest_scale(question.arm, jacobian.T @ need.bound @ jacobian, load)


def _largest_damping(question: Question, spring: NullSpaceSpring) -> float:
    inside, needed = needed_at_rest(question, spring)
    return _largest_scale(question.arm, needed, inside)


def _largest_scale(arm: Arm, taken: Array, load: Array) -> float:
    """How many times the load the joints that move pay for beside what is taken."""
    free = np.ix_(moving(arm), moving(arm))
    return float(largest_scale((as_matrix(arm.damping) - taken)[free], load[free]))


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
