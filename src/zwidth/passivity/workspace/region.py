"""Where in its workspace an arm renders a wall passively, and what to change where it does not.

The loop is passive for every motion that stays in cells in which δ_m ⪰ Jᵀ R J is proved.  Where it does
not hold: in which direction, what would help, and a motion that takes energy out.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from zwidth.errors import InputError
from zwidth.model.arms import Arm
from zwidth.model.arms.replay import steps_of
from zwidth.model.arms.wall import MatrixWall, wall_need
from zwidth.model.environment.wall import Wall
from zwidth.passivity.scope import Outcome
from zwidth.passivity.workspace.account import account_of, all_in_blocks, reached_cells, refinement
from zwidth.passivity.workspace.additions import Additions
from zwidth.passivity.workspace.claim import Covers, claim
from zwidth.passivity.workspace.counting import counting
from zwidth.passivity.workspace.evidence import Evidence, evidence_for
from zwidth.passivity.workspace.mapped import columns_of, dataset, scaled_stiffness, stiffness_factors
from zwidth.passivity.workspace.question import Question, asked_of
from zwidth.passivity.workspace.verdict import Workspace
from zwidth.quantity.exact import RealLike

_OUTSIDE = "a reading may be outside the region, and one step around it nothing is proved"


def workspace(
    arm: Arm,
    wall: Wall | MatrixWall,
    *,
    rate: RealLike,
    delay: RealLike = 0,
    points: int = 100,
    torque_held_up_to: float | Sequence[float] | None = None,
    largest_force: float | Sequence[float] | None = None,
) -> Workspace:
    """Map over the workspace whether an arm renders a wall passively.

    Parameters
    ----------
    arm
        `zwidth.arms.built_in`, `PlanarChain`, `LeggedArm`, or `read_arm` of a description.
    wall
        `Wall`, equally stiff in every direction (or a plane wall with any normal), or `MatrixWall`; of an
        arm in pose `MatrixWall.in_pose`.
    rate
        Samples per second, > 0 [Hz], or a text such as "1 kHz".
    delay
        From reading to force, a whole number of samples [s], or a text; round up what is not.
    points
        Cells along each side of the map, from 2 to 1000.
    torque_held_up_to
        None: the force is held, and the torque J(q)ᵀF follows the arm within each period, as Miller and
        others assume. A force ≥ 0 [N]: the torque J(q_k)ᵀF is held, and the wall renders no more than
        this; for chains and descriptions, whose curvature is bounded, and without delay. In pose a force
        and a moment [N], [N·m].
    largest_force
        Of the wall, ≥ 0 [N], in pose with a moment: up to it encoder steps are to be counted, and the answer
        is "undecided" where they cannot be. None: as far as Coulomb friction covers them; where it does at
        no force, and no motion across them is found, the answer is "passive without encoder steps" at best.

    Raises
    ------
    InputError
        If a number is outside its bound, or the arm reaches no point of its region.
    """
    question = asked_of(arm, wall, rate, delay, points, torque_held_up_to, largest_force)
    sites = arm.sites(points)
    n, period = sites.jacobians.shape[-2], question.period
    reached = reached_cells(sites)
    if not reached.any():
        raise InputError(f"{arm.name} reaches no point of its region, {sites.region}; choose another one")
    need = wall_need(wall, period, question.delay_samples, n)
    damping = question.damping(n)
    parts = refinement(sites, points)
    fine = sites if parts == 1 else arm.sites(points * parts)
    account = account_of(damping, need.stiffness_share + need.bound, fine, arm.turns)
    factors = stiffness_factors(damping, need, fine.jacobians[account.reached])
    count = counting(arm, wall, period, fine, question.forces)
    found = evidence_for(question, count, sites, fine, account)
    whole = np.zeros(account.reached.shape, dtype=bool)
    whole[account.reached] = account.proved
    if found.nothing_missing:
        whole[...] = True
        account = account._replace(counted=np.eye(arm.joint_count)[None])
    outcome = _outcome(found, question, bool(whole.all()))
    limits = question.forces
    if found.encoder == "counted" and found.motion is None:
        limits = count.limits or limits
    columns = columns_of(arm, damping, wall, need, sites, reached, period, limits)
    factor = min(columns["stiffness_factor"][0].min(), factors.min())
    covers = Covers(
        region=fine.region,
        torque="held" if question.torque_held else "follows",
        encoder=found.encoder,
        forces=limits,
        why_ideal=(count.reason or _OUTSIDE) if any(arm.resolution) else "",
        can_be_refuted=arm.joint_count <= n,
        has_friction=any(arm.coulomb_friction),
    )
    return Workspace(
        outcome=outcome,
        claim=claim(outcome, covers, account, found.words, found.steps),
        arm=arm,
        wall=wall,
        sample_period=period,
        delay_samples=question.delay_samples,
        data=dataset(arm, sites, reached, all_in_blocks(whole, reached.shape), columns),
        added=Additions(question=question, points=account.points, cells=account.counted),
        stiffness_factor=float(factor),
        largest_stiffness=None if arm.turns else float(scaled_stiffness(wall, factor, n)),
        region=covers.region,
        torque=covers.torque,
        encoder=covers.encoder,
        largest_forces=covers.forces,
        encoder_steps=found.steps,
        can_be_refuted=covers.can_be_refuted,
        motion=found.motion,
        certificate=found.certificate,
    )


def _outcome(found: Evidence, question: Question, everywhere: bool) -> Outcome:
    """Of an arm whose steps are to be counted there is no theorem: without a certificate nothing is said."""
    if found.motion is not None:
        return "active"
    if found.certificate is not None:
        stepped = found.encoder == "ideal" and bool(steps_of(question.arm).any())
        return "passive without encoder steps" if stepped else "passive"
    return "theorem" if everywhere and not question.asked else "undecided"
