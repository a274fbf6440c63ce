"""The answer for an arm: what is proved of a wall in its workspace, what to change, all as plain data."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from math import inf, isfinite
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from zwidth.model.arms import Arm, DescribedArm
from zwidth.model.arms.arm import ArmMotion
from zwidth.model.arms.encoders import EncoderSteps
from zwidth.model.arms.joints import as_matrix, least_additions, single_addition
from zwidth.model.arms.wall import MatrixWall, wall_matrices
from zwidth.model.environment.environment import certain
from zwidth.model.environment.wall import Wall
from zwidth.passivity.advice import Advice, Kind, with_what_to_do
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.result import PassivityAnswer, share_left
from zwidth.passivity.scope import Encoder, Outcome, Scope, Torque, Transmission
from zwidth.passivity.workspace.certificate import arm_certificate
from zwidth.passivity.workspace.mapped import scaled_stiffness
from zwidth.passivity.workspace.question import Question
from zwidth.quantity.answered import answered, answers, finite, known
from zwidth.quantity.text import outward_decimal, shown, shown_at_least, shown_at_most

if TYPE_CHECKING:
    import xarray


OF_JOINTS_THAT_GIVE_WAY = (
    "What is proved holds for every stiffness of the joints and whatever the links do, by what the motors "
    "feel of friction; the postures are those that the encoders read."
)


@dataclass(frozen=True, kw_only=True, repr=False)
class Workspace(PassivityAnswer):
    """The answer for an arm: a verdict, the map, and what to change.

    "passive": the independent checker has shown the condition in the whole region, `certificate`.
    "passive without encoder steps": it has of an arm that is read without them, and this one has some.
    "theorem": it holds in every cell, reckoned in doubles with room for rounding, without a certificate.
    "active": at one point a motion of the hand takes energy out, `motion`.  "undecided": none of these.
    """

    _FORMAT = "zwidth workspace 1"
    _PICTURE = "workspace_figure"
    _BESIDES = (
        (
            "outcome, claim",
            '`"passive"`, `"passive without encoder steps"`, `"theorem"`, `"active"` or '
            '`"undecided"`; in words',
        ),
        ("arm, wall", "what was asked about; K and B as matrices"),
        ("joint_names", "in the order of every list of joints"),
        ("joint_damping_source", "of damping that comes from a description: what is to be known of it"),
        (
            "joint_damping_N_m_s_rad",
            "a list, of each joint, or the matrix of joints that damp each other: N·m·s/rad, N·s/m of"
            " joints that slide, N·s/rad between the two",
        ),
        (
            "joint_damping_that_motors_feel_N_m_s_rad",
            "of joints that give way, the same with what is there behind their motors whatever the links do",
        ),
        (
            "largest_forces_N, largest_moments_N_m",
            "lists of one or none: up to which force of the wall, and in pose which moment, the claim"
            " goes; empty: any",
        ),
        ("smallest_margin_N_s_per_m", "at the hand, over all points; null of a wall in pose"),
        (
            "smallest_margin_in_joints_N_m_s_per_rad",
            "smallest eigenvalue of the joints' damping less need, over all points",
        ),
        (
            "encoder_steps",
            "null where there are none or no bound is known; of each joint `friction_N_m` that covers"
            " them before next to no force, and `friction_per_force_m` for each newton, in pose "
            "`friction_per_moment`; `covered_force_N`, in pose with `covered_moment_N_m`; "
            "`refuted_force_N` with its `motion`",
        ),
        ("wall_leaves_out", "of a wall from a file of ros2_control: what of that controller is not in it"),
        (
            "too_little",
            "of the three additions, `to_all_N_m_s_per_rad`, `to_one_N_m_s_per_rad`, "
            "`least_N_m_s_per_rad`, of damping with which, or with less, the condition fails at a "
            "point",
        ),
        ("proved_part", "part of the cells that are proved"),
        (
            "motion",
            'a closed one that takes energy out: `energy_J`, `encoder`, `imposed_by` (`"end"` or '
            '`"links"`), `largest_force_N`, `joints_rad`, `positions_m`, `wall_rest_m`; in pose '
            "`rotations_rad` and `wall_rest_rotation_rad`, 2 sin(φ/2) along the axis from the "
            "orientation of rest, in the plane the angle",
        ),
        ("certificate", "if passive, a proof"),
    )
    witness = None  # its motion is reckoned in doubles, and no evidence

    outcome: Outcome = known("which of these")
    found: str = known("what was found and how much, without its point")
    besides: str = known("whole sentences on what is not counted, and on how the arm is read")
    arm: Arm = known("what was asked about")
    wall: Wall | MatrixWall = known("likewise")
    sample_period: float = answered("T", unit="s")
    delay_samples: int = answered("d, whole samples from reading to force")
    data: xarray.Dataset = known(
        "the map, an xarray Dataset over the cells; each variable has its unit in `attrs`"
    )
    added: Additions = known(
        "what more damping in the joints would do: `least`, `to_all`, `alone`, each with what is enough and "
        "with what still fails; found when it is asked for"
    )
    stiffness_factor: float = answered(
        "how many times as stiff the wall may be and hold at every point; null if there is no bound, as of "
        "one without stiffness",
        finite=True,
    )
    largest_stiffness: float | None = answered(
        "the stiffest wall of this kind that holds at every point, in the largest stiffness of any "
        "direction; null if there is no bound, and in pose, which has two units",
        unit="N/m",
        finite=True,
    )
    region: str = answered("in words: where the claim holds")
    torque: str = answered(
        '`"follows"`: that of each instant is that of the arm then, or of its readings; `"held"`: it is '
        "computed once a sample"
    )
    encoder: str = answered(
        '`"counted"`: the claim is of the wall\'s force and the Jacobian at the '
        'readings; `"ideal"`: of an arm that is read without steps'
    )
    largest_forces: tuple[float, ...] = known(
        "the force of the wall [N], in pose with its moment [N·m], up to which the claim goes; empty: any"
    )
    encoder_steps: EncoderSteps | None = known(
        "what the steps ask of Coulomb friction, up to which force it covers them, and from which on a "
        "motion across them takes energy out; None where there are none, or no bound is known"
    )
    can_be_refuted: bool = answered(
        "whether a hand at the end alone can; false of an arm with more joints than the hand has "
        "coordinates: there a `motion` is one of hands that hold the links, too"
    )
    motion: ArmMotion | None = known("what takes energy out, if one was found")
    certificate: Certificate | None = known(
        'the proof for `zwidth verify`, if "passive", with encoder steps or without', default=None
    )

    @property
    @answers(key="addition_to_one", unit="N*m*s/rad", finite=True)
    def additions(self) -> tuple[float, ...]:
        """The damping that, given to one joint alone, proves the region; ∞, null, where none [N·m·s/rad]."""
        return tuple(addition.enough[joint] for joint, addition in enumerate(self.added.alone))

    @property
    @answers(unit="N*m*s/rad")
    def addition_to_all(self) -> float:
        """The damping that, given to every joint, proves the region [N·m·s/rad]."""
        return self.added.to_all.enough[0]

    @property
    @answers(unit="N*m*s/rad")
    def least_additions(self) -> tuple[float, ...]:
        """The damping of the joints, of a small sum, that proves the region [N·m·s/rad]."""
        return self.added.least.enough

    @property
    def coordinates(self) -> int:
        """Of the hand: those of its point, and in pose those of its turn."""
        return int(self.data.attrs["coordinates"])

    @property
    def scope(self) -> Scope:
        """What the outcome is about: the wall pulls and pushes about its point of rest."""
        limits: tuple[float | None, ...] = (*self.largest_forces, None, None)
        follows: Torque = "follows the readings" if self.encoder == "counted" else "follows the arm"
        left_out: Encoder = "not counted" if any(self.arm.resolution) else "ideal"
        return Scope(
            contact="both sides",
            encoder="counted" if self.encoder == "counted" else left_out,
            largest_force=limits[0],
            largest_moment=limits[1],
            torque="held" if self.torque == "held" else follows,
            region=self.region,
            transmission=between(self.arm),
            motion="linear",
        )

    @cached_property
    def claim(self) -> str:
        """What was found, how much and what to do; then what is not counted, and how the arm is read."""
        return f"{with_what_to_do(self.found, self.advice, self.outcome)} {self.besides}"

    @cached_property
    def advice(self) -> tuple[Advice, ...]:
        """How stiff the wall may be; where no stiffness is low enough, which joints to damp."""
        loop, times = (self.arm, self.wall, self.coordinates), self.stiffness_factor
        if self.outcome in ("passive", "passive without encoder steps", "theorem"):
            if self.encoder == "counted":
                return ()  # friction may not cover the steps of a stiffer one
            return wall_advice(*loop, times, "slack", "holds at every point of the map")
        if 0 < times < 1:
            proved = self.proved_softer
            where = "" if proved else ", by the points of the map alone"
            return wall_advice(*loop, proved or times, "change", where)
        return damping_advice(self.arm, self.added.least.enough)

    @cached_property
    def proved_softer(self) -> float | None:
        """How many times as stiff a wall of this kind is proved; None where none was."""
        return self.added.stiffest(self.stiffness_factor) if 0 < self.stiffness_factor < inf else None

    def _left(self) -> float | None:
        """Of the stiffest wall that holds at every point."""
        return share_left(1, self.stiffness_factor)

    def evidence(self) -> dict[str, Any]:
        """The proof as plain data; None where there is none."""
        return {"certificate": None, **super().evidence()}

    def numbers(self) -> dict[str, Any]:
        """What was asked about, and what was found of it, as plain data; the map is in `data`."""
        data, steps, turns = self.data, self.encoder_steps, self.arm.turns
        return {
            **arm_document(self.arm),
            **super().numbers(),
            "wall": wall_document(self.wall, self.coordinates, turns),
            "largest_forces_N": list(self.largest_forces[:1]),
            "largest_moments_N_m": list(self.largest_forces[1:]),
            "smallest_margin_N_s_per_m": float(data["margin"].min()) if "margin" in data else None,
            "smallest_margin_in_joints_N_m_s_per_rad": float(data["margin_in_joints"].min()),
            "encoder_steps": None if steps is None else steps_document(steps, turns),
            "too_little": {
                "to_all_N_m_s_per_rad": self.added.to_all.fails[0],
                "to_one_N_m_s_per_rad": [finite(one.fails[i]) for i, one in enumerate(self.added.alone)],
                "least_N_m_s_per_rad": list(self.added.least.fails),
            },
            "proved_part": float(data["proved"].mean()),
            "motion": motion_document(self.motion, turns),
        }


_SHOWN = 1e-6
"""Of the sum: what one joint gets less than this is the room for rounding."""


def wall_advice(
    arm: Arm, wall: Wall | MatrixWall, coordinates: int, times: float, kind: Kind, where: str
) -> tuple[Advice, ...]:
    """That the wall may be so many times as stiff, or must be; nothing where that is any or none."""
    if not 0 < times < inf:
        return ()
    now, unit, factor = 1.0, "1", f"{outward_decimal(times, False):.4g} times"
    if not arm.turns:  # in pose there is no one stiffness
        now, unit = float(scaled_stiffness(wall, np.array(1.0), coordinates)), "N/m"
    most = shown_at_most(now * times, unit)
    if kind == "slack":
        text = f"a wall {f'{factor} as stiff' if arm.turns else f'of up to {most}'} {where}"
    elif arm.turns:
        text = f"lower the stiffness to {factor} what it is{where}"
    else:
        text = f"lower the stiffness from {shown(now, unit)} to {most}{where}"
    return (Advice("stiffness", now, now * times, unit, kind, text),)


def damping_advice(arm: Arm, additions: Sequence[float], where: str = "") -> tuple[Advice, ...]:
    """Which joints to give how much more damping; nothing where none is enough, or none is needed."""
    if not any(additions) or not all(map(isfinite, additions)):
        return ()
    text = f"give the joints more damping, {told_additions(arm, additions)}{where}"
    return (Advice("damping", 0.0, sum(additions), "N*m*s/rad", "change", text),)


def told_additions(arm: Arm, additions: Sequence[float]) -> str:
    """Of each joint that gets some how much."""
    return ", ".join(
        f"{shown_at_least(more, 'N*s/m' if slides else 'N*m*s/rad')} in {name}"
        for name, more, slides in zip(arm.joint_names, additions, arm.sliding, strict=True)
        if more > _SHOWN * sum(additions)
    )


def moved(motion: ArmMotion, period: float) -> str:
    """What a motion takes out, and how long it lasts."""
    by = "the hand" if motion.imposed_by == "end" else "the joints"
    lasts = shown(len(motion.joints) * period, "s")
    return f"a motion of {by} takes {shown(-motion.energy, 'J')} out in {lasts}, each time it is made"


def between(arm: Arm) -> Transmission:
    """What of motors, encoders and links a verdict on an arm is about."""
    return "any" if arm.transmissions else "rigid"


def arm_document(arm: Arm) -> dict[str, Any]:
    """Its name, its joints and their damping, and of joints that give way what motors feel."""
    source = arm.damping_source if isinstance(arm, DescribedArm) else ""
    felt = np.asarray(arm.at_motors.damping).tolist() if arm.transmissions else None
    return {
        "arm": arm.name,
        "joint_names": list(arm.joint_names),
        "joint_damping_N_m_s_rad": np.asarray(arm.damping).tolist(),
        **({"joint_damping_source": source} if source else {}),
        **({"joint_damping_that_motors_feel_N_m_s_rad": felt} if felt else {}),
    }


def wall_document(wall: Wall | MatrixWall, coordinates: int, turns: int) -> dict[str, Any]:
    """Its matrices; of a hand with turns each has two units."""
    k, b = wall_matrices(wall, coordinates)
    keys = ("stiffness_N_m_rad", "virtual_damping_N_m_s_rad") if turns else (
        "stiffness_N_per_m", "virtual_damping_N_s_per_m"
    )  # fmt: skip
    return dict(zip(keys, (k.tolist(), b.tolist()), strict=True))


def steps_document(steps: EncoderSteps, turns: int) -> dict[str, Any]:
    """What encoder steps ask of Coulomb friction, and the motion across their edges."""
    moment = {"friction_per_moment": list(steps.friction_per_moment)} if turns else {}
    return {
        "friction_N_m": list(steps.friction),
        "friction_per_force_m": list(steps.friction_per_force),
        **moment,
        "covered_force_N": steps.covered[0] if steps.covered else None,
        **({"covered_moment_N_m": steps.covered[1] if steps.covered else None} if turns else {}),
        "refuted_force_N": steps.refuted,
        "motion": motion_document(steps.motion, turns),
    }


def motion_document(motion: ArmMotion | None, turns: int) -> dict[str, Any] | None:
    """A motion with its energy; of a hand with turns its rotations apart from its positions."""
    if motion is None:
        return None
    point = motion.positions.shape[-1] - turns
    document = {
        "energy_J": motion.energy,
        "encoder": motion.encoder,
        "imposed_by": motion.imposed_by,
        "largest_force_N": motion.largest_force,
        "joints_rad": motion.joints.tolist(),
        "positions_m": motion.positions[:, :point].tolist(),
        "wall_rest_m": motion.rest[:point].tolist(),
    }
    if not turns:
        return document
    rotations = {"rotations_rad": motion.positions[:, point:].tolist()}
    return {**document, **rotations, "wall_rest_rotation_rad": motion.rest[point:].tolist()}


# How much more damping in the joints would do, or how much softer a wall: what is proved, and what fails.
#
#     fails    what is lacking at some point of the map: less of it, and δ_m − JᵀRJ is not ⪰ 0 there
#     enough   what the bounds between the points ask for: more than is needed, most of all of parallel arms
#
# Between the two the independent checker decides, which cuts cells where it must: the first of a few steps
# from `fails` to `enough` that it proves is told.  Of an arm with many joints such proofs take long,
# and there it is the bounds that decide.


Array = npt.NDArray[np.float64]

_STEPS = (1 / 8, 1 / 2)
"""Of the way from what fails to what is enough."""

_SOFTER = (0.01, 0.05, 0.2)
"""Than the wall that fails at a point of the map."""

_MOST_PROVED = 4
"""Joints of an arm of which the checker is asked."""

_NEAR = 0.06
"""Of what fails, tried first where the steps are longer: nearer to it the checker needs many cells."""


class Addition(NamedTuple):
    """Damping to be added to each joint [N·m·s/rad]; ∞ where none is enough.

    With it the region is proved, of an arm with more than four joints in doubles alone; with `fails`, or
    less in these proportions, the condition fails at a point.
    """

    enough: tuple[float, ...]
    fails: tuple[float, ...]


@dataclass(frozen=True, kw_only=True)
class Additions:
    """What to add to the damping of the joints for a question.

    `points`: δ_m − JᵀRJ at those of the map, (points, m, m); `cells`: less what it may lose between them.
    """

    question: Question
    points: Array
    cells: Array

    @cached_property
    def least(self) -> Addition:
        """With the smallest sum."""
        return self._smallest(lambda matrices: np.asarray(least_additions(matrices)[0]))

    @cached_property
    def to_all(self) -> Addition:
        """The same in every joint."""
        return self._smallest(_to_all)

    @cached_property
    def alone(self) -> tuple[Addition, ...]:
        """All in one joint, for each of them."""
        return tuple(self._smallest(partial(_alone, joint)) for joint in range(self._joints))

    @property
    def _joints(self) -> int:
        return int(self.points.shape[-1])

    def stiffest(self, fails: float) -> float | None:
        """How many times as stiff a wall is proved, `fails` at a point of the map; None where none was."""
        if self._joints > _MOST_PROVED:
            return None
        tried = (fails * (1 - softer) for softer in _SOFTER)
        return next((k for k in tried if self._proves(wall=_stiffer(self.question.wall, k))), None)

    def _smallest(self, needed: Callable[[Array], Array]) -> Addition:
        enough = needed(self.cells)
        if not enough.any():
            return Addition(_numbers(enough), _numbers(enough))
        fails = needed(self.points)
        if not all(map(isfinite, fails)):
            return Addition(_numbers(fails), _numbers(fails))
        if self._joints > _MOST_PROVED:
            return Addition(_numbers(enough), _numbers(fails))
        far = np.where(np.isfinite(enough), enough, 4 * fails)  # the bounds alone may ask for no end of it
        steps = [fails + share * (far - fails) for share in _STEPS]
        near = (1 + _NEAR) * fails
        for tried in steps if steps[0].sum() < near.sum() else [near, *steps]:
            damping = as_matrix(self.question.arm.damping) + np.diag(tried)
            if self._proves(arm=self.question.arm.replace(damping=damping)):
                return Addition(_numbers(tried), _numbers(fails))
        return Addition(_numbers(enough), _numbers(fails))

    def _proves(self, **changed: Any) -> bool:
        return arm_certificate(replace(self.question, **changed))[0] is not None


def _stiffer(wall: Wall | MatrixWall, times: float) -> Wall | MatrixWall:
    if isinstance(wall, Wall):
        return wall.replace(stiffness=times * certain(wall.stiffness, "stiffness"))
    return replace(wall, stiffness=times * np.array(wall.stiffness))


def _to_all(matrices: Array) -> Array:
    lacking = max(0.0, -float(np.linalg.eigvalsh(matrices)[:, 0].min()))
    return np.full(matrices.shape[-1], lacking)


def _alone(joint: int, matrices: Array) -> Array:
    found = np.zeros(matrices.shape[-1])
    found[joint] = single_addition(matrices, joint).max()
    return found


def _numbers(values: Array) -> tuple[float, ...]:
    return tuple(float(value) for value in values)
