"""An impedance at the end of an arm that all postures bear, as near to a file's as the joints allow.

    δ_m ⪰ Jᵀ (K (2d + 1) T/2 + |D|) J / s,    D = 2 ζ √K

at every posture that is tried, with a share s of the joints' damping.  The spring comes first: K of the file,
or the same part of all of it; then the same part of every ζ.  Both go with the damping, so that a share of it
is a wall 1/s times as stiff and as damped.  What is found is rounded down and asked again.  Between the
postures nothing is proved, and no certificate comes with it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import sqrt

import numpy as np

from zwidth.data.gains.controllers import AXES, CartesianGains
from zwidth.data.gains.parameters import Tree, double, place_of, text_of
from zwidth.data.gains.passive import SHARE, Saved, rounded_down, share_of
from zwidth.errors import InputError
from zwidth.model.arms import Arm
from zwidth.model.arms.wall import MatrixWall
from zwidth.passivity.workspace import PostureMap, stiffness_over_postures
from zwidth.quantity.exact import RealLike
from zwidth.quantity.text import shown

_TRIES = 4
_LESS = 0.98
"""What a try that misses is lowered to."""


@dataclass(frozen=True, repr=False)
class BorneImpedance(Saved):
    """An impedance that all postures bear that were tried, as a parameter file of ros2_control.

    Attributes
    ----------
    asked
        The impedance of the file.
    stiffness, factors
        K of x, y, z [N/m] and about them [N·m/rad], and ζ of each [1]; of a point the first three count.
    found
        What was found of it, with the share of the damping in the place of all of it.
    share
        How much of each joint's damping it uses at most.
    """

    asked: CartesianGains
    stiffness: tuple[Fraction, ...]
    factors: tuple[Fraction, ...]
    found: PostureMap
    share: Fraction

    def to_yaml(self) -> str:
        """As text: below the names of the file, units and what was found in comments."""
        tree: Tree = {}
        place = place_of(tree, self.asked.keys)
        place["stiffness"] = dict(self._groups(self.stiffness, self.asked.stiffness, ("N/m", "N*m/rad")))
        place["damping"] = dict(self._groups(self.factors, self.asked.factors, ("factor", "factor")))
        return text_of(tree, list(self.report()))

    @property
    def size(self) -> int:
        return 3 + self.found.question.arm.turns

    def _groups(
        self, values: Sequence[Fraction], was: Sequence[float], units: Sequence[str]
    ) -> Iterator[tuple[str, Tree | str]]:
        for first, part, unit in ((0, "translation", units[0]), (3, "rotation", units[1])):
            if first >= self.size:
                return
            yield (
                part,
                {
                    axis: f"{double(now)}  # {unit}"
                    + ("" if float(now) == before else f"; your file: {before:g}")
                    for axis, now, before in zip(AXES, values[first:], was[first:], strict=False)
                },
            )

    def report(self) -> Iterator[str]:
        """What was found, and what that assumes."""
        asked = self.found.question
        count, part = self.found.tried, shown(self.share, "%", 6)
        yield (
            f"An impedance for {asked.arm.name}: the condition of passivity holds at all of {count} postures "
            "over its joint ranges, and between them nothing is proved. Computed by zwidth, tried on no "
            "machine."
        )
        yield "For ROS: to be loaded after your own parameter file; what is not here stays as it is there."
        yield "What it supposes:"
        joints = ", ".join(f"{float(b) * float(self.share):.4g}" for b in np.diag(asked.damping(self.size)))
        yield f"- damping in the joints, {part} of what was given, or more [N*m*s/rad]: {joints}"
        late = shown(asked.delay_samples / asked.rate, "s")
        yield f"- {shown(asked.rate, 'Hz')}, torque {late} after the reading"
        yield "- the torque follows the arm within a sample; encoder steps are not counted"
        for note in self.asked.notes(self.size - 3):
            yield f"- left out: {note}"


def borne_impedance(
    asked: CartesianGains,
    arm: Arm,
    *,
    rate: RealLike,
    delay: RealLike = 0,
    postures: int = 20_000,
    share: RealLike = SHARE,
) -> BorneImpedance:
    """Find an impedance that every posture bears which is tried, as near to one of a file as may be.

    Parameters
    ----------
    asked
        One of `read_controllers(…).cartesian`.
    arm, rate, delay, postures
        As of `zwidth.stiffness_over_postures`.
    share
        How much of each joint's damping it may use, 0 < share ≤ 1.

    Raises
    ------
    InputError
        If a number is outside its bound, the arm is in the plane, or no stiffness is borne.
    """
    part, turns = share_of(share), arm.turns
    if asked.of_task:
        raise InputError(
            f"{asked.source}: written are the keys of Cartesian-Impedance-Controller; without -o the report "
            "has the part of K and D that all postures bear, to be typed as k_pos_x … and d_pos_x …"
        )
    if turns not in (0, 3):
        raise InputError("an impedance of ros2_control has three rotations; a hand in the plane has one")

    def tried(k: Sequence[Fraction], factors: Sequence[Fraction]) -> PostureMap:
        stiff = [float(v) for v in k[: 3 + turns]]
        damped = [2 * float(z) * sqrt(v) for z, v in zip(factors, stiff, strict=False)]
        wall = MatrixWall(np.diag(stiff) / float(part), np.diag(damped) / float(part), turns=turns)
        return stiffness_over_postures(arm, wall, rate=rate, delay=delay, postures=postures)

    none = [Fraction(0)] * 6
    times = min(1.0, tried([Fraction(v) for v in asked.stiffness], none).stiffness_factor)
    whole = 1.0
    for _ in range(_TRIES):
        k = [_part(v, times) for v in asked.stiffness]
        if not any(k[: 3 + turns]):
            break
        damping = tried(k, [Fraction(z) for z in asked.factors]).damping_factor
        whole = min(whole, 1.0 if damping is None else damping)
        factors = [_part(z, whole) for z in asked.factors]
        found = tried(k, factors)
        if found.stiffness_factor >= 1 and found.motion is None:
            return BorneImpedance(asked, tuple(k), tuple(factors), found, part)
        times, whole = times * _LESS, whole * _LESS
    raise InputError(
        f"no stiffness of this kind is borne at every posture by {shown(part, '%', 6)} of the joints' "
        "damping: measure it, --joint-damping, or hold joints where they need not move, --hold"
    )


def _part(value: float, times: float) -> Fraction:
    return Fraction(str(value)) if times == 1 else rounded_down(times * value)
