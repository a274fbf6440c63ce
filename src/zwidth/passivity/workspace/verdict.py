"""The answer for an arm: what is proved of a wall in its workspace, and what to change."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from zwidth.model.arms import Arm
from zwidth.model.arms.arm import ArmMotion
from zwidth.model.arms.encoders import EncoderSteps
from zwidth.model.arms.wall import MatrixWall
from zwidth.model.environment.wall import Wall
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.result import PassivityAnswer
from zwidth.passivity.scope import Outcome, Scope, Torque
from zwidth.passivity.workspace.additions import Additions
from zwidth.passivity.workspace.report import (
    additions_document,
    arm_document,
    finite,
    motion_document,
    steps_document,
    wall_document,
)

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True, kw_only=True, repr=False)
class Workspace(PassivityAnswer):
    """The answer for an arm: a verdict, the map, and what to change.

    Parameters
    ----------
    outcome
        "passive": the independent checker has shown the condition in the whole region, ``certificate``.
        "passive without encoder steps": it has of an arm that is read without them, and this one has some.
        "theorem": it holds in every cell, reckoned in doubles with room for rounding, without a certificate.
        "active": at one point a motion of the hand takes energy out, `motion`. "undecided": none of these.
    claim
        In words, with what was assumed.
    arm, wall
        What was asked about.
    sample_period
        T [s].
    delay_samples
        d, whole samples from reading to force.
    data
        The map, an xarray Dataset over the cells; each variable has its unit in `attrs`.
    added
        What more damping in the joints would do: `least`, `to_all`, `alone`, each with what is enough and
        with what still fails; found when it is asked for.
    stiffness_factor
        How many times as stiff the wall may be and hold at every point; ∞ if it has no stiffness.
    largest_stiffness
        The stiffest wall of this kind that holds at every point, in the largest stiffness of any
        direction [N/m]; None of a wall in pose, which has two units.
    region
        In words: where the claim holds.
    torque
        "follows": the torque of each instant is that of the arm then, or of its readings. "held": it is
        computed once a sample.
    encoder
        "counted": the claim is of the wall's force and the Jacobian at the readings. "ideal": of an arm that
        is read without steps.
    largest_forces
        The force of the wall [N], in pose with its moment [N·m], up to which the claim goes; empty: any.
    encoder_steps
        What the steps ask of Coulomb friction, up to which force it covers them, and from which on a motion
        across them takes energy out; None where there are none, or no bound is known.
    can_be_refuted
        Whether a hand at the end alone can: False of an arm with more joints than the hand has coordinates.
        There a `motion` is one of hands that hold the links, too.
    motion
        What takes energy out, if one was found.
    certificate
        The proof for `zwidth verify`, if "passive", with encoder steps or without.
    """

    FORMAT = "zwidth workspace 1"
    PICTURE = "workspace_figure"
    witness = None  # its motion is reckoned in doubles, and no evidence

    outcome: Outcome
    claim: str
    arm: Arm
    wall: Wall | MatrixWall
    sample_period: float
    delay_samples: int
    data: xarray.Dataset
    added: Additions
    stiffness_factor: float
    largest_stiffness: float | None
    region: str
    torque: str
    encoder: str
    largest_forces: tuple[float, ...]
    encoder_steps: EncoderSteps | None
    can_be_refuted: bool
    motion: ArmMotion | None
    certificate: Certificate | None = None

    @property
    def additions(self) -> tuple[float, ...]:
        """The damping that, given to one joint alone, proves the region; ∞ where none does [N·m·s/rad]."""
        return tuple(addition.enough[joint] for joint, addition in enumerate(self.added.alone))

    @property
    def addition_to_all(self) -> float:
        """The damping that, given to every joint, proves the region [N·m·s/rad]."""
        return self.added.to_all.enough[0]

    @property
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
        return Scope(
            contact="both sides",
            encoder="counted" if self.encoder == "counted" else self._encoder_left_out,
            largest_force=limits[0],
            largest_moment=limits[1],
            torque="held" if self.torque == "held" else follows,
            region=self.region,
            motion="linear",
        )

    @property
    def _encoder_left_out(self) -> Literal["ideal", "not counted"]:
        return "not counted" if any(self.arm.resolution) else "ideal"

    def __repr__(self) -> str:
        stiffest = f"{self.stiffness_factor:.6g} times this one"
        if self.largest_stiffness is not None:
            stiffest = f"{self.largest_stiffness:.6g} N/m"
        return f"<Workspace {self.outcome}: {self.claim} Stiffest wall at every point: {stiffest}>"

    @property
    def margin(self) -> float:
        """What the joints have of damping over what is needed, at the worst place and in the worst direction.

        At the hand [N·s/m]; of a wall in pose, which has two units, in the joints [N·m·s/rad].
        """
        return float(self.data["margin" if "margin" in self.data else "margin_in_joints"].min())

    def evidence(self) -> dict[str, Any]:
        """The proof as plain data; None where there is none."""
        return {"certificate": None, **super().evidence()}

    def numbers(self) -> dict[str, Any]:
        """What was asked about, and what was found of it, as plain data; the map is in `data`."""
        data, motion, steps = self.data, self.motion, self.encoder_steps
        turns, largest = self.arm.turns, self.largest_stiffness
        return {
            **arm_document(self.arm),
            "joint_damping_N_m_s_rad": np.asarray(self.arm.damping).tolist(),
            "region": self.region,
            "wall": wall_document(self.wall, self.coordinates, turns),
            "torque": self.torque,
            "encoder": self.encoder,
            "largest_forces_N": list(self.largest_forces[:1]),
            "largest_moments_N_m": list(self.largest_forces[1:]),
            "can_be_refuted": self.can_be_refuted,
            "sample_period_s": self.sample_period,
            "delay_samples": self.delay_samples,
            "smallest_margin_N_s_per_m": self.margin if "margin" in data else None,
            "smallest_margin_in_joints_N_m_s_per_rad": float(data["margin_in_joints"].min()),
            "stiffness_factor": finite(self.stiffness_factor),
            "largest_stiffness_N_per_m": None if largest is None else finite(largest),
            "encoder_steps": None if steps is None else steps_document(steps, turns),
            **additions_document(self.added),
            "proved_part": float(data["proved"].mean()),
            "motion": None if motion is None else motion_document(motion, turns),
        }
