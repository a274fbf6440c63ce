"""Which joints of an arm are passive with the gains of its files, and which gains would be."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Any, ClassVar

from zwidth.data.gains.arms import MOST_READINGS, ArmGains, Delay
from zwidth.data.gains.best import best, passive_compensation, required_damping, stiffest
from zwidth.data.gains.held_joints import claim_of_joints
from zwidth.data.gains.joint import CoupledJoint, JointGains
from zwidth.data.gains.plant import GivenPlant
from zwidth.errors import InputError
from zwidth.missing import suggestion
from zwidth.model.specification.table import quoted
from zwidth.passivity.pairs import PairVerdict, check_pair
from zwidth.passivity.pairs.limits import samples_around
from zwidth.passivity.result import least
from zwidth.passivity.scope import COLOUR, Outcome
from zwidth.quantity.answered import answered, answers, data_of
from zwidth.quantity.documented import Documented
from zwidth.quantity.exact import RealLike
from zwidth.quantity.text import shown
from zwidth.showing import Headline, Lines, Part, Shown, Table

MOST_SAMPLES = 100
"""Samples that readings may be old around both arms; beyond, a search takes seconds for a joint."""

UNITS = "K in N·m/rad, kd and b in N·m·s/rad; leader/follower where they differ"
_NONE = "none"


def check_gains(
    gains: ArmGains,
    plant: GivenPlant = None,
    rate: RealLike | None = None,
    delay: Delay | None = None,
    drive_rate: RealLike | None = None,
    ideal_drive: bool = False,
    compensated: bool = True,
) -> GainsVerdict:
    """Decide for each joint whether two hands can take energy out of it, with the gains of the files.

    Parameters
    ----------
    gains
        As `read_gains` reads them.
    given, named
        As of `ArmGains.pairs`: plant, rate, delay, drive_rate, ideal_drive, compensated; what is not given
        is the family's, and is said.

    Raises
    ------
    InputError
        If the leader feels nothing, no plant is known, or a number is outside its bound.
    """
    setting = gains.setting(plant, rate, delay, drive_rate, ideal_drive, compensated)
    pairs = zip(gains.joints, setting.joints, strict=True)
    joints = tuple(JointVerdict(joint, model, check_pair(model.pair())) for joint, model in pairs)
    return GainsVerdict(gains, joints, setting.notes)


@dataclass(frozen=True, repr=False)
class JointVerdict(Shown):
    """The verdict on one joint, and the gains that would be passive.

    Attributes
    ----------
    gains
        Of the files.
    model
        The joint of both arms with all that decides it.
    verdict
        On the pair that they make.
    """

    gains: JointGains
    model: CoupledJoint
    verdict: PairVerdict

    @property
    def name(self) -> str:
        """Of the joint."""
        return self.gains.name

    @property
    @answers()
    def outcome(self) -> Outcome:
        """ "passive", "active" or "undecided"."""
        return self.verdict.outcome

    @property
    @answers()
    def claim(self) -> str:
        """As of the pair: what happens, how much and what to do."""
        return self.verdict.claim

    @property
    def margin(self) -> float | None:
        """As of the pair."""
        return self.verdict.margin

    def report(self) -> Iterable[Part]:
        """As of the pair."""
        return self.verdict.report()

    @property
    @answers()
    def is_searched(self) -> bool:
        """False where readings are too old, or a drive's too many, to look for passive gains: those are then
        null."""
        pair = self.verdict.pair
        return samples_around(pair) <= MOST_SAMPLES and pair.own_readings <= MOST_READINGS

    @cached_property
    @answers()
    def stiffest(self) -> CoupledJoint | None:
        """The stiffest passive joint with the damping of the files, rounded down, proved; null if none is."""
        return stiffest(self.model) if self.is_searched else None

    @cached_property
    @answers()
    def best(self) -> CoupledJoint | None:
        """The stiffest passive joint over multiples of the damping, rounded and proved; null if none is."""
        return best(self.model) if self.is_searched else None

    @cached_property
    @answers(unit="N*m*s/rad")
    def required_damping(self) -> float | None:
        """The least b of both arms, the same, for the gains of the files [N·m·s/rad]; rounded up, proved."""
        return required_damping(self.model) if self.is_searched else None

    @cached_property
    @answers(key="largest_compensation")
    def compensation(self) -> float | None:
        """How much of the compensation of friction is passive, 1 for all; null if none, or there is none."""
        return passive_compensation(self.model) if self.is_searched else None

    @cached_property
    @answers()
    def with_ideal_drive(self) -> Outcome | None:
        """The outcome if kd in the drive were a damper; null without a drive, or where it is taken so."""
        if self.model.drive_rate is None or self.model.ideal_drive:
            return None
        return check_pair(replace(self.model, ideal_drive=True).pair()).outcome

    @property
    @answers()
    def limit(self) -> str:
        """What binds, in a few words."""
        verdict = self.verdict
        if verdict.criterion.slips:
            return "kd in the drive"
        if verdict.violation is not None:
            return f"at {shown(verdict.violation.frequency, 'Hz', 3)}"
        return "" if verdict.passive else verdict.limit.partition(":")[0]

    @property
    @answers()
    def assumptions(self) -> tuple[str, ...]:
        """What the claim covers and takes for granted."""
        ideal = "kd of an arm's own speed, in its drive, is a damper at once: b holds it, the controller not"
        return (*self.verdict.small_print(), *([ideal] if self.model.is_ideal else []))

    def to_dict(self) -> dict[str, Any]:
        """As plain data, units in the keys; every gain that is told was proved."""
        damping = [float(b) for b in self.model.damping]
        return {**data_of(self.gains), **data_of(self), "damping_N_m_s_per_rad": damping}

    def saved(self) -> dict[str, Any]:
        """The same with the proof, or the violation, for `zwidth verify`."""
        of = self.verdict
        proofs = {"certificate": of.certificate, "violation": of.violation, "witness": of.motion}
        return {**self.to_dict(), **{key: part.saved() for key, part in proofs.items() if part is not None}}


@dataclass(frozen=True, repr=False)
class GainsVerdict(Documented):
    """The verdicts on all joints of an arm."""

    _FORMAT: ClassVar[str] = "zwidth gains 1"

    gains: ArmGains = answered("what the files say, of a `family` of arms", stands_as={"family": "family"})
    joints: tuple[JointVerdict, ...] = answered("the verdict on each joint")
    taken: tuple[str, ...] = answered("what was taken for granted that no file says", only_shown=True)

    @property
    @answers()
    def outcome(self) -> Outcome:
        """ "active" if a joint is, else "undecided" if a joint is, else "passive"."""
        found = {joint.outcome for joint in self.joints}
        return "active" if "active" in found else "undecided" if "undecided" in found else "passive"

    @property
    @answers()
    def claim(self) -> str:
        """How many joints are what, and of the worst what happens, how much and what to do."""
        return claim_of_joints(self.outcome, [(one.name, one.verdict, one.claim) for one in self.joints])

    @property
    def margin(self) -> float | None:
        """The least of the joints; None where one is not known."""
        return least(joint.margin for joint in self.joints)

    @property
    @answers()
    def notes(self) -> tuple[str, ...]:
        """What each number is, what was taken for granted, and what is not counted."""
        return (
            *self.gains.notes,
            *self.taken,
            *self._slips(),
            *self._unsearched(),
            *self._steps(),
            *self._each(),
        )

    def joint(self, name: str) -> JointVerdict:
        """The verdict on one joint.

        Raises
        ------
        InputError
            If there is none of that name.
        """
        for joint in self.joints:
            if joint.name == name:
                return joint
        names = [joint.name for joint in self.joints]
        raise InputError(f"there is no joint {quoted(name)}; {suggestion(name, names)}")

    def _slips(self) -> Iterator[str]:
        slipping = [joint for joint in self.joints if joint.verdict.criterion.slips]
        if slipping:
            rate = slipping[0].verdict.pair.drive_rate
            assert rate is not None, "only a drive gains between two samples"
            yield (
                f"kd in the drive: to and fro at {shown(float(rate) / 2, 'Hz')} the drive alone gives more "
                "than b takes; no arm moves so, and drives filter: an ideal drive leaves that part out"
            )

    def _unsearched(self) -> Iterator[str]:
        if not all(joint.is_searched for joint in self.joints):
            yield (
                f"passive gains are looked for where readings are at most {MOST_SAMPLES} samples "
                f"old around both arms, and a drive has at most {MOST_READINGS} in a sample"
            )

    def _steps(self) -> Iterator[str]:
        if any(side.resolution for joint in self.joints for side in joint.verdict.pair.sides):
            return
        step = self.gains.published.position_step
        stiff = max(self.joints, key=lambda joint: joint.verdict.pair.stiffness.fraction)
        friction = float(stiff.verdict.pair.stiffness) * float(step.value)
        yield (
            f"positions come in steps of {shown(step.value, 'rad')} ({step.source}): not counted, for the "
            f"plant gives no resolution; of {stiff.name} the spring alone needs {shown(friction, 'N*m')} of "
            "Coulomb friction for them"
        )

    def _each(self) -> Iterator[str]:
        """What every joint's verdict takes for granted."""
        shared = [set(joint.assumptions) for joint in self.joints]
        yield from (text for text in self.joints[0].assumptions if all(text in s for s in shared))

    def tables(self) -> tuple[Table, Table]:
        """The verdict on each joint, and the gains that would be passive."""
        decided = [["joint", "K", "kd", "b", "verdict", "limit", "with ideal drive"]]
        better = [["joint", "largest K", "best K", "with kd", "b needed", "compensation"]]
        return (
            Table(rows=[_decided(joint) for joint in self.joints], heads=decided, lefts=1, caption=UNITS),
            Table(rows=[_better(joint) for joint in self.joints], heads=better, lefts=1),
        )

    def report(self) -> Iterator[Part]:
        """The sentence, the joints, the gains that would be passive, and what is taken for granted."""
        yield Headline(self.outcome, COLOUR[self.outcome], self.claim)
        first, second = self.tables()
        yield first
        yield second
        yield Lines(self.notes, "assumptions")

    def saved(self) -> dict[str, Any]:
        """The same with the proof of each joint."""
        return {**self.to_dict(), "joints": [joint.saved() for joint in self.joints]}


def _decided(joint: JointVerdict) -> list[str]:
    return [
        joint.name,
        _stiffness(joint.model),
        _damping(joint.model),
        _sides(*joint.model.damping),
        joint.outcome,
        joint.limit,
        joint.with_ideal_drive or "",
    ]


def _better(joint: JointVerdict) -> list[str]:
    if not joint.is_searched:
        return [joint.name, *["–"] * 5]
    top, stiff, need = joint.best, joint.stiffest, joint.required_damping
    return [
        joint.name,
        _NONE if stiff is None else _stiffness(stiff),
        _NONE if top is None else _stiffness(top),
        "" if top is None else _damping(top),
        _NONE if need is None else f"{need:.4g}",
        _share(joint),
    ]


def _share(joint: JointVerdict) -> str:
    """Of the compensation of friction, in percent."""
    if not joint.model.is_compensated:
        return ""
    return _NONE if joint.compensation is None else shown(joint.compensation, "%", 3)


def _stiffness(joint: CoupledJoint) -> str:
    return _sides(*(gains.stiffness for gains in joint.gains))


def _damping(joint: CoupledJoint) -> str:
    """kd as the files have it: of the speed against the other arm, or of its own."""
    return _sides(*(gains.damping or gains.local_damping for gains in joint.gains))


def _sides(leader: Fraction, follower: Fraction) -> str:
    first, second = (f"{float(value):.4g}" for value in (leader, follower))
    return first if first == second else f"{first}/{second}"
