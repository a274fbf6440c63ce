"""Which joints of an arm are passive with the gains of its files, and which gains would be."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

from zwidth.gains.arms import ArmGains, Delay
from zwidth.gains.best import best, required_damping, stiffest
from zwidth.gains.joint import JointGains
from zwidth.gains.plant import GivenPlant
from zwidth.pairs import Pair
from zwidth.passivity.outcome import COLOUR, Outcome
from zwidth.passivity.pairs import PairVerdict, check_pair
from zwidth.passivity.result import Documented
from zwidth.quantity.exact import RealLike
from zwidth.quantity.text import shown
from zwidth.showing import Headline, Lines, Part, Table

_NONE = "none"


def check_gains(
    gains: ArmGains,
    plant: GivenPlant = None,
    rate: RealLike | None = None,
    delay: Delay | None = None,
    drive_rate: RealLike | None = None,
) -> GainsVerdict:
    """Decide for each joint whether two hands can take energy out of it, with the gains of the files.

    Parameters
    ----------
    gains
        As `read_gains` reads them.
    plant, rate, delay, drive_rate
        As `ArmGains.pairs` takes them; what is not given is the family's, and is said.

    Raises
    ------
    InputError
        If the leader feels nothing, no plant is known, or a number is outside its bound.
    """
    setting = gains.setting(plant, rate, delay, drive_rate)
    joints = tuple(
        JointVerdict(joint, check_pair(setting.pairs[joint.name])) for joint in gains.joints
    )
    return GainsVerdict(gains, joints, setting.notes)


@dataclass(frozen=True)
class JointVerdict:
    """The verdict on one joint, and the gains that would be passive.

    Attributes
    ----------
    gains
        Of the files.
    verdict
        On the pair that they make.
    """

    gains: JointGains
    verdict: PairVerdict

    @property
    def name(self) -> str:
        """Of the joint."""
        return self.gains.name

    @property
    def outcome(self) -> Outcome:
        """ "passive", "active" or "undecided"."""
        return self.verdict.outcome

    @cached_property
    def stiffest(self) -> Pair | None:
        """The stiffest passive pair with the damping of the files, rounded down and proved; None if none is."""
        return stiffest(self.verdict.pair)

    @cached_property
    def best(self) -> Pair | None:
        """The stiffest passive pair over multiples of the damping, rounded and proved; None if none is."""
        return best(self.verdict.pair)

    @cached_property
    def required_damping(self) -> float | None:
        """The least b of both arms for the gains of the files [N·m·s/rad], rounded up and proved."""
        return required_damping(self.verdict.pair)

    @property
    def limit(self) -> str:
        """What binds, in a few words."""
        verdict = self.verdict
        if verdict.criterion.slips:
            return "kd, inside the drive"
        if verdict.violation is not None:
            return f"at {verdict.violation.frequency:.3g} Hz"
        return "" if verdict.passive else "Coulomb friction"

    def to_dict(self) -> dict[str, Any]:
        """As plain data, units in the keys; every gain that is told was proved."""
        return {
            **self.gains.to_dict(),
            "outcome": self.outcome,
            "claim": self.verdict.claim,
            "limit": self.limit,
            "assumptions": list(self.verdict.small_print()),
            "stiffest": _gains(self.stiffest),
            "best": _gains(self.best),
            "required_damping_N_m_s_per_rad": self.required_damping,
        }

    def saved(self) -> dict[str, Any]:
        """The same with the proof, or the violation, for `zwidth verify`."""
        parts = ("certificate", "violation", "motion")
        found = {name: getattr(self.verdict, name) for name in parts}
        proofs = {
            "witness" if name == "motion" else name: part.saved()
            for name, part in found.items()
            if part is not None
        }
        return {**self.to_dict(), **proofs}


@dataclass(frozen=True, repr=False)
class GainsVerdict(Documented):
    """The verdicts on all joints of an arm.

    Attributes
    ----------
    gains
        What the files say.
    joints
        The verdict on each joint.
    taken
        What was taken for granted that no file says.
    """

    FORMAT: ClassVar[str] = "zwidth gains 1"

    gains: ArmGains
    joints: tuple[JointVerdict, ...]
    taken: tuple[str, ...]

    @property
    def outcome(self) -> Outcome:
        """ "active" if a joint is, else "undecided" if a joint is, else "passive"."""
        found = {joint.outcome for joint in self.joints}
        return "active" if "active" in found else "undecided" if "undecided" in found else "passive"

    @property
    def claim(self) -> str:
        """How many joints are what, in a sentence."""
        counts = [
            (sum(joint.outcome == outcome for joint in self.joints), outcome)
            for outcome in ("passive", "active", "undecided")
        ]
        told = ", ".join(f"{count} {outcome}" for count, outcome in counts if count)
        return f"Of {len(self.joints)} joints, each by itself: {told}."

    @property
    def notes(self) -> tuple[str, ...]:
        """What each number is, what was taken for granted, and what is not counted."""
        return (*self.gains.notes, *self.taken, *self._steps(), *self._each())

    def _steps(self) -> Iterator[str]:
        if any(side.resolution for joint in self.joints for side in joint.verdict.pair.sides):
            return
        step = self.gains.published.position_step
        stiff = max(self.joints, key=lambda joint: joint.verdict.pair.stiffness.fraction)
        friction = float(stiff.verdict.pair.stiffness) * float(step.value)
        yield (
            f"positions come in steps of {shown(step.value, 'rad')} ({step.source}): not counted, for the plant "
            f"gives no resolution; of {stiff.name} the spring alone needs {shown(friction, 'N*m')} of Coulomb "
            "friction for them"
        )

    def _each(self) -> Iterator[str]:
        """What every joint's verdict takes for granted."""
        shared = [set(joint.verdict.small_print()) for joint in self.joints]
        yield from (text for text in self.joints[0].verdict.small_print() if all(text in s for s in shared))

    def table(self) -> tuple[list[list[str]], list[list[str]]]:
        """Heads and rows, joint by joint."""
        heads = [
            ["joint", "K", "kd", "verdict", "", "largest K", "best K", "best kd", "needs b", "has b"],
            ["", "N·m/rad", "N·m·s/rad", "", "", "N·m/rad", "N·m/rad", "N·m·s/rad", "N·m·s/rad", "N·m·s/rad"],
        ]
        return heads, [_row(joint) for joint in self.joints]

    def report(self) -> Iterator[Part]:
        """The sentence, the joints, and what is taken for granted."""
        yield Headline(self.outcome, COLOUR[self.outcome], self.claim)
        heads, rows = self.table()
        yield Table(rows=rows, heads=heads, lefts=1)
        yield Lines(self.notes, "assumptions")

    def to_dict(self) -> dict[str, Any]:
        """As plain data, units in the keys."""
        return self._document([joint.to_dict() for joint in self.joints])

    def saved(self) -> dict[str, Any]:
        """The same with the proof of each joint."""
        return self._document([joint.saved() for joint in self.joints])

    def _document(self, joints: list[dict[str, Any]]) -> dict[str, Any]:
        return {
            "format": self.FORMAT,
            "outcome": self.outcome,
            "claim": self.claim,
            "family": self.gains.family,
            "joints": joints,
            "notes": list(self.notes),
        }


def _row(joint: JointVerdict) -> list[str]:
    pair, best_one, stiff = joint.verdict.pair, joint.best, joint.stiffest
    need = joint.required_damping
    return [
        joint.name,
        _both(pair, "stiffness"),
        _damping(pair),
        joint.outcome,
        joint.limit,
        _NONE if stiff is None else _both(stiff, "stiffness"),
        _NONE if best_one is None else _both(best_one, "stiffness"),
        "" if best_one is None else _damping(best_one),
        _NONE if need is None else f"{need:.4g}",
        _sides(*(side.damping for side in pair.sides)),
    ]


def _both(pair: Pair, key: str) -> str:
    other = getattr(pair, f"follower_{key}")
    own = getattr(pair, key)
    return _sides(own, own if other is None else other)


def _damping(pair: Pair) -> str:
    """B, or D where there is no B."""
    leader, follower = pair.sides
    if leader.virtual_damping or follower.virtual_damping:
        return _sides(leader.virtual_damping, follower.virtual_damping)
    return _sides(leader.local_damping, follower.local_damping)


def _sides(leader: Any, follower: Any) -> str:
    """One number, or leader / follower."""
    first, second = (f"{float(value):.4g}" for value in (leader, follower))
    return first if first == second else f"{first} / {second}"


def _gains(pair: Pair | None) -> dict[str, Any] | None:
    if pair is None:
        return None
    return {
        side: {
            "stiffness_N_m_per_rad": float(own.stiffness),
            "damping_N_m_s_per_rad": float(own.virtual_damping),
            "local_damping_N_m_s_per_rad": float(own.local_damping),
        }
        for side, own in zip(("leader", "follower"), pair.sides, strict=True)
    }
