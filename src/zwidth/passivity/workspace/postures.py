"""How stiff a wall an arm with many joints may render, posture by posture over all of its joint ranges.

    largest s with δ_m ⪰ Jᵀ(s K (2d + 1) T/2 + |B|) J    at each posture q

Seven joints have no map of cells: postures are drawn evenly from their ranges, the worst are followed
downhill, and what each gives is put where its hand is, by distance from the first axis and by height.  What
is found is of these postures; between them nothing is proved.  Where the joints' encoders step, the stiffest
wall whose steps their Coulomb friction covers is mapped, too: a stiffer one may buzz.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property, partial
from math import acos, pi
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from zwidth.errors import InputError
from zwidth.model.arms import Arm, ArmMotion, DescribedArm
from zwidth.model.arms.encoders import covered_factors
from zwidth.model.arms.joints import largest_scale, least_additions, surplus
from zwidth.model.arms.replay import refuting_motion
from zwidth.model.arms.wall import MatrixWall, WallNeed, wall_matrices
from zwidth.model.environment.wall import Wall
from zwidth.passivity.advice import Advice, Kind, with_what_to_do
from zwidth.passivity.result import PassivityAnswer, share_left
from zwidth.passivity.scope import Outcome, Scope
from zwidth.passivity.workspace.mapped import scaled_stiffness, stiffness_factors
from zwidth.passivity.workspace.question import Question, asked_of
from zwidth.passivity.workspace.verdict import (
    OF_JOINTS_THAT_GIVE_WAY,
    arm_document,
    between,
    damping_advice,
    motion_document,
    moved,
    wall_advice,
    wall_document,
)
from zwidth.quantity.answered import answered, answers, known
from zwidth.quantity.exact import RealLike
from zwidth.quantity.text import outward_decimal, shown, shown_at_most

if TYPE_CHECKING:
    import xarray

Array = npt.NDArray[np.float64]

MOST_POSTURES = 1_000_000
_AT_ONCE = 5000
_WORST, _AROUND, _ROUNDS = 8, 60, 12
"""Postures that are followed, neighbours of each in a round, and rounds, each of half the size."""
_FIRST = 0.05
"""Of the ranges: how far the first neighbours are."""


@dataclass(frozen=True, kw_only=True, repr=False)
class PostureMap(PassivityAnswer):
    """How stiff a wall may be, at the postures that were tried."""

    _FORMAT = "zwidth postures 1"
    _PICTURE = "postures_figure"
    certificate = witness = None

    question: Question = answered(
        "the arm, the wall and the loop",
        stands_as={"sample_period_s": "period", "delay_samples": "delay_samples"},
    )
    tried: int = answered("how many postures were tried", key="postures")
    data: xarray.Dataset = known(
        "by `radius` from the first axis and `height`, the hand's [m]: the smallest and the largest "
        "`stiffness_factor` of the postures in a cell, of a wall at a point `largest_stiffness` [N/m] too, "
        "and how many there are; nan where none is.  With encoder steps the smallest `encoder_factor`, too"
    )
    stiffness_factor: float = answered(
        "how many times as stiff the wall may be at every posture that was tried", finite=True
    )
    worst: tuple[float, ...] = answered(
        "the joints at the posture where that is least", key="worst_joints", unit="rad"
    )
    motion: ArmMotion | None = known(
        "what takes energy out there, if the wall is too stiff and one was found"
    )
    damping_factor: float | None = answered(
        "how many times its virtual damping the wall may have, as stiff as it is, at every posture tried; "
        "null without virtual damping",
        finite=True,
        default=None,
    )
    encoder_factor: float | None = answered(
        "how many times as stiff the wall may be with Coulomb friction covering the joints' encoder steps at "
        "every posture drawn, to first order and before next to no force; null without steps",
        finite=True,
        default=None,
    )

    @property
    def outcome(self) -> Outcome:
        """ "active" with a motion at a posture; else "undecided": of postures alone no region is proved."""
        return "undecided" if self.motion is None else "active"

    @cached_property
    @answers(unit="N/m")
    def largest_stiffness(self) -> float | None:
        """The stiffest wall of this kind at every posture tried [N/m]; None of a wall in pose."""
        return None if self.question.arm.turns else self._times(self.stiffness_factor)

    def _times(self, factor: float) -> float:
        """The largest stiffness of so many times the wall, at a point [N/m]."""
        return float(scaled_stiffness(self.question.wall, np.array(factor), 3))

    @property
    def claim(self) -> str:
        """What was found, how much and what to do; and that it is of postures."""
        arm, steepest = self.question.arm, self.stiffness_factor
        of = ", ".join([f"{self.tried} postures over the joint ranges", *getattr(arm, "locked", ())])
        after = [OF_JOINTS_THAT_GIVE_WAY] if arm.transmissions else []
        if steepest >= 1:
            told = f"At each of {of}, the joints have the damping that this wall asks for"
            after.insert(
                0,
                "Between them nothing is proved, and so it is undecided; a map of two joints is proved: "
                "leave out --postures, in Python zwidth.workspace.",
            )
        elif self.motion is None:
            found = "looked for" if arm.transmissions else "found that takes energy out"
            told = f"At some of {of}, the condition fails, and no motion was {found}"
        else:
            told = f"At one of {of}, {moved(self.motion, self.question.period)}"
            if self.motion.imposed_by == "links":
                after.append(
                    "These are hands that hold the links, such as one at the elbow and one at the end."
                )
        outcome = "passive" if steepest >= 1 else "active"
        return " ".join([with_what_to_do(told, self.advice, outcome), *after])

    @cached_property
    def advice(self) -> tuple[Advice, ...]:
        """How stiff the wall may be at the postures tried; where that is not at all, how much it may damp."""
        arm, size = self.question.arm, 3 + self.question.arm.turns
        kind: Kind = "slack" if self.stiffness_factor >= 1 else "change"
        where = "holds at every posture tried" if kind == "slack" else ", which holds at every posture tried"
        found = wall_advice(arm, self.question.wall, size, self.stiffness_factor, kind, where)
        if found or self.stiffness_factor:
            return found
        if not self.damping_factor:
            return damping_advice(arm, self._additions, ", at the worst posture")
        text = f"lower the virtual damping to {_down(self.damping_factor)} times what it is{where}"
        return (Advice("virtual_damping", 1.0, self.damping_factor, "1", "change", text),)

    @cached_property
    def _additions(self) -> tuple[float, ...]:
        """The least damping that the joints lack at the worst posture [N·m·s/rad]."""
        _, jacobian, need, damping = _placed(self.question, np.array([self.worst]))
        lacking = surplus(jacobian, damping, need.stiffness_share + need.bound)
        return tuple(least_additions(lacking)[0].tolist())

    @property
    def scope(self) -> Scope:
        """A wall on both sides of its rest, read without steps, at the postures tried."""
        return Scope(
            contact="both sides",
            encoder="not counted" if any(self.question.arm.resolution) else "ideal",
            torque="held" if self.question.torque_held else "follows the arm",
            region="the postures that were tried",
            transmission=between(self.question.arm),
        )

    def _left(self) -> float | None:
        """Of the stiffest wall at every posture tried, which no region is proved from."""
        return share_left(1, self.stiffness_factor)

    def rows(self) -> Iterator[tuple[str, str]]:
        """The main numbers as (name, text) for a report."""
        best = float(self.data["best_stiffness_factor"].max())
        if not self.stiffness_factor:
            yield ("stiffness", "none: at some posture its virtual damping alone is too much for the joints")
        elif self.largest_stiffness is None:
            yield "stiffness", f"{_down(self.stiffness_factor)} times everywhere, {_down(best)} times at best"
        else:
            everywhere, most = (shown_at_most(k, "N/m") for k in (self.largest_stiffness, self._times(best)))
            yield "largest stiffness", f"{everywhere} at every posture tried, {most} at the best"
        if self.damping_factor is not None:
            yield "virtual damping", self._damping(self.damping_factor)
        if self.encoder_factor is not None:
            yield "encoder steps", self._steps(self.encoder_factor)
        yield "worst posture", self.question.arm.at(self.worst, 3)
        for advice in damping_advice(self.question.arm, self._additions, ", at the worst posture"):
            yield "or", advice.text
        if self.motion is not None:
            often = shown(self.question.rate / len(self.motion.joints), "Hz")
            taken = shown(-self.motion.energy, "J")
            yield "motion", f"to and fro at {often}, {len(self.motion.joints)} samples, takes {taken} out"

    def _damping(self, factor: float) -> str:
        """How much of it the joints pay for, and from which frequency on more of it gains."""
        text = f"the joints pay for {_down(factor)} times this much of it at every posture tried"
        slow = acos(-factor) / (2 * pi) * self.question.rate if 0 < factor < 1 else 0.0
        _, damper = wall_matrices(self.question.wall, 3 + self.question.arm.turns)
        if not slow or self.question.delay_samples or np.linalg.eigvalsh(damper)[0] < 0:
            return text
        return f"{text}; no small motion there slower than {shown(slow, 'Hz')} gains"

    def _steps(self, factor: float) -> str:
        """Up to which stiffness Coulomb friction covers them."""
        if not any(self.question.arm.coulomb_friction):
            return "no Coulomb friction is known that covers them: any wall may buzz"
        if not factor:
            return "Coulomb friction does not cover those of the virtual damping: it may buzz"
        most = f"{_down(factor)} times this stiffness"
        if not self.question.arm.turns:
            most = shown_at_most(self._times(factor), "N/m")
        return f"Coulomb friction covers them up to {most}, by a light touch; a stiffer wall may buzz"

    def numbers(self) -> dict[str, Any]:
        """As plain data, units in the keys."""
        arm = self.question.arm
        return {
            **arm_document(arm),
            "wall": wall_document(self.question.wall, 3 + arm.turns, arm.turns),
            **super().numbers(),
            "motion": motion_document(self.motion, arm.turns),
        }


def _down(factor: float) -> str:
    return f"{outward_decimal(factor, False):.4g}"


def stiffness_over_postures(
    arm: Arm,
    wall: Wall | MatrixWall,
    *,
    rate: RealLike,
    delay: RealLike = 0,
    postures: int = 20_000,
    cells: int = 40,
) -> PostureMap:
    """Map the largest passive stiffness over all postures of an arm from a description.

    Parameters
    ----------
    arm
        `zwidth.arms.read_arm(…, whole=True)`: every joint that is not held goes over its whole range.
    wall
        As of `zwidth.workspace`.
    rate, delay
        As of `zwidth.workspace`.
    postures
        How many are drawn from the ranges, from 100 to 1 000 000; the same ones every time.
    cells
        Of the map along radius and height, from 2 to 1000.

    Raises
    ------
    InputError
        If a number is outside its bound, or the arm is not from a description.
    """
    if not isinstance(arm, DescribedArm):
        raise InputError(
            "postures are drawn of arms from a description; of others zwidth.workspace has a map"
        )
    if isinstance(postures, bool) or not isinstance(postures, int) or not 100 <= postures <= MOST_POSTURES:
        raise InputError(f"postures must be a whole number from 100 to {MOST_POSTURES}, got {postures!r}")
    question = asked_of(arm, wall, rate, delay, cells, None, None)
    places = _drawn(arm, postures)
    drawn = _factors(question, places)
    worst = places[np.argsort(drawn[0])[:_WORST]]
    followed, lowest = _followed(question, worst, lambda near: _factors(question, near)[0])
    at = int(np.argmin(lowest))
    more = _factors(question, followed)
    motion = _refuted(question, followed[np.argsort(lowest)]) if lowest[at] < 1 else None
    factors, positions, covered = (np.concatenate(both) for both in zip(drawn, more, strict=True))
    return PostureMap(
        question=question,
        tried=postures,
        data=_by_place(question, factors, positions, covered, cells),
        stiffness_factor=float(lowest[at]),
        worst=tuple(followed[at].tolist()),
        motion=motion,
        damping_factor=_least_damping_factor(question, places),
        encoder_factor=float(covered.min()) if any(arm.resolution) else None,
    )


def _drawn(arm: DescribedArm, count: int) -> Array:
    """Evenly from the ranges (Halton 1960), the same every time."""
    from scipy.stats import qmc

    low, high = np.array(arm.joint_range).T
    return np.asarray(low + (high - low) * qmc.Halton(len(low), scramble=False).random(count + 1)[1:])


def _factors(question: Question, places: Array) -> tuple[Array, Array, Array]:
    """How many times as stiff the wall may be at each place, where the hand is, and what the steps allow."""
    arm, found, covered = question.arm, list[Array](), list[Array]()
    positions, jacobians, need, damping = _placed(question, places)
    for start in range(0, len(places), _AT_ONCE):
        some = jacobians[start : start + _AT_ONCE]
        found.append(stiffness_factors(damping, need, some))
        if any(arm.resolution):
            covered.append(covered_factors(arm, question.wall, question.period, some))
    steps = np.concatenate(covered) if covered else np.full(len(places), np.inf)
    return np.concatenate(found), positions[:, :3], steps


def _placed(question: Question, places: Array) -> tuple[Array, Array, WallNeed, Array]:
    """Where the hand is at each place, J there, what the wall asks for and what the joints have for it."""
    assert isinstance(question.arm, DescribedArm)
    size = 3 + question.arm.turns
    return (*question.arm.placed(places), question.need(size), question.damping(size))


def _least_damping_factor(question: Question, places: Array) -> float | None:
    """Of the places, and downhill from the worst of them; None without virtual damping."""
    if not question.need(3 + question.arm.turns).bound.any():
        return None
    factors = _damping_factors(question, places)
    worst = places[np.argsort(factors)[:_WORST]]
    return float(_followed(question, worst, partial(_damping_factors, question))[1].min())


def _damping_factors(question: Question, places: Array) -> Array:
    """How many times |B| the joints pay for beside K.

    s = it: with B ⪰ 0 and no delay δ_m − Jᵀ(KT/2 − B cos θ)J ⪰ 0 wherever −cos θ ≤ s.
    """
    _, jacobians, need, damping = _placed(question, places)
    load = np.swapaxes(jacobians, -1, -2) @ need.bound @ jacobians
    return largest_scale(surplus(jacobians, damping, need.stiffness_share), load)


def _followed(question: Question, places: Array, measure: Callable[[Array], Array]) -> tuple[Array, Array]:
    """Downhill of a measure from some places, inside the ranges, with its values there."""
    arm = question.arm
    assert isinstance(arm, DescribedArm)
    low, high = np.array(arm.joint_range).T
    steps = np.random.default_rng(0).normal(size=(_ROUNDS, _AROUND, len(low)))
    lowest, rows = measure(places), np.arange(len(places))
    for turn in range(_ROUNDS):
        near = places[:, None] + _FIRST * 0.5**turn * (high - low) * steps[turn]
        near = np.clip(near, low, high).reshape(-1, len(low))
        values = measure(near).reshape(len(places), _AROUND)
        best = values.argmin(axis=1)
        better = values[rows, best] < lowest
        chosen = near.reshape(len(places), _AROUND, -1)[rows, best]
        places = np.where(better[:, None], chosen, places)
        lowest = np.minimum(lowest, values[rows, best])
    return places, lowest


def _refuted(question: Question, places: Array) -> ArmMotion | None:
    """A motion at one of the places, replayed with the full kinematics."""
    loop = (question.arm, question.wall, question.period, question.delay_samples)
    found = (refuting_motion(*loop, place, question.torque_held) for place in places)
    return next((motion for motion in found if motion is not None), None)


def _by_place(
    question: Question, factors: Array, positions: Array, covered: Array, cells: int
) -> xarray.Dataset:
    """The least and the most of the factors in each cell, and how many there are."""
    import xarray as xr

    radius, height = np.hypot(positions[:, 0], positions[:, 1]), positions[:, 2]
    edges = [np.linspace(v.min(), v.max() + 1e-12, cells + 1) for v in (radius, height)]
    place = tuple(
        np.clip(np.searchsorted(edge, v, side="right") - 1, 0, cells - 1)
        for edge, v in zip(edges, (radius, height), strict=True)
    )
    least, most, steps = (np.full((cells, cells), v) for v in (np.inf, -np.inf, np.inf))
    count = np.zeros((cells, cells), dtype=np.int64)
    np.minimum.at(least, place, factors)
    np.maximum.at(most, place, factors)
    np.minimum.at(steps, place, covered)
    np.add.at(count, place, 1)
    least[count == 0] = most[count == 0] = steps[count == 0] = np.nan
    dims = ("radius", "height")
    variables: dict[str, Any] = {
        "stiffness_factor": (dims, least, {"units": "1", "long_name": "least of the postures in this cell"}),
        "best_stiffness_factor": (dims, most, {"units": "1", "long_name": "most of them"}),
        "postures": (dims, count, {"units": "1", "long_name": "how many there are"}),
    }
    if any(question.arm.resolution):
        words = "least up to which Coulomb friction covers the encoder steps"
        variables["encoder_factor"] = (dims, steps, {"units": "1", "long_name": words})
    if not question.arm.turns:
        values = np.where(count > 0, scaled_stiffness(question.wall, least, 3), np.nan)
        words = "stiffest wall that every posture in this cell bears"
        variables["largest_stiffness"] = (dims, values, {"units": "N/m", "long_name": words})
    middles = {
        name: (name, (edge[1:] + edge[:-1]) / 2, {"units": "m"})
        for name, edge in zip(dims, edges, strict=True)
    }
    return xr.Dataset(variables, middles, {"arm": question.arm.name, "tried": len(factors)})
