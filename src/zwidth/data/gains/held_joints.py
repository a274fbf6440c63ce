"""Which joints of one arm are passive with the springs of its controllers: each a wall on its own device."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import inf
from typing import Any, ClassVar, NamedTuple

from zwidth.data.gains.controllers import Controllers, JointLaw
from zwidth.data.gains.plant import plant_of_file
from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.transfer_function import PulseTransferFunction
from zwidth.passivity.check import check
from zwidth.passivity.pairs import PairVerdict
from zwidth.passivity.result import evidence_of, least
from zwidth.passivity.scope import COLOUR, Outcome
from zwidth.passivity.verdict import Verdict
from zwidth.passivity.wording import claim_of_passivity
from zwidth.quantity.answered import answered, answers, data_of
from zwidth.quantity.documented import Documented
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.text import shown
from zwidth.quantity.units import parse_number
from zwidth.showing import Headline, Lines, Part, Table

_NONE = "–"
_WORST: tuple[Outcome, ...] = ("active", "undecided", "passive without encoder steps", "passive in contact")


@dataclass(frozen=True)
class HeldJoint:
    """A joint, its law and the verdict on it."""

    law: JointLaw
    verdict: Verdict = answered("the verdict on it", stands_as={"outcome": "outcome"})

    @property
    @answers(key="required_damping", unit="N*m*s/rad")
    def needed(self) -> float | None:
        """The damping that the joint needs [N·m·s/rad]; None where none is enough, or it is not known."""
        left = self.verdict.margins.get("damping")
        return None if left is None else float(self.verdict.device.motor_side.exact("damping")) - left

    @property
    @answers()
    def claim(self) -> str:
        """The verdict's; of a passive one no lower rate, at which a delay of one period would be longer."""
        found = self.verdict
        passive = found.outcome == "passive"
        return f"{claim_of_passivity(found.scope, found.at_limit)}." if passive else found.claim

    def to_dict(self) -> dict[str, Any]:
        """As plain data, units in the keys."""
        return {**data_of(self.law), **data_of(self)}


@dataclass(frozen=True, repr=False)
class HeldJoints(Documented):
    """The verdicts on the joints of one arm, held at a target by springs and dampers."""

    _FORMAT: ClassVar[str] = "zwidth held joints 1"

    joints: tuple[HeldJoint, ...] = answered("each with its verdict, which holds proof or motion")
    notes: tuple[str, ...] = answered("what was taken for granted")

    @property
    @answers()
    def outcome(self) -> Outcome:
        """Of all joints: "passive" where every one is, else the worst."""
        found = [joint.verdict.outcome for joint in self.joints]
        return next((outcome for outcome in _WORST if outcome in found), "passive")

    @property
    @answers()
    def claim(self) -> str:
        """How many joints are what, and of the first of the worst what happens, how much and what to do."""
        told = claim_of_joints(self.outcome, [(one.law.name, one.verdict, one.claim) for one in self.joints])
        if self.outcome == "passive":
            return told
        return f"{told} Gains that are proved are written by -o passive.yaml, in Python by passive_gains."

    @property
    def margin(self) -> float | None:
        """The least of the joints; None where one is not known."""
        return least(joint.verdict.margin for joint in self.joints)

    def saved(self) -> dict[str, Any]:
        """The same with the proof, or the motion, of each joint."""
        joints = [{**joint.to_dict(), **evidence_of(joint.verdict)} for joint in self.joints]
        return {**self.to_dict(), "joints": joints}

    def report(self) -> Iterator[Part]:
        """The sentence, joint by joint, and what is taken for granted."""
        yield Headline(self.outcome, COLOUR[self.outcome], self.claim)
        heads = [["joint", "p", "i", "d", "b", "b needed", "verdict"]]
        heads.append(["", "N·m/rad", "N·m/(rad·s)", *["N·m·s/rad"] * 3, ""])
        rows = [
            [
                joint.law.name,
                *(f"{float(v):g}" for v in (joint.law.stiffness, joint.law.integral, joint.law.damping)),
                f"{float(joint.verdict.device.motor_side.exact('damping')):g}",
                _NONE if joint.needed is None else f"{joint.needed:.4g}",
                joint.verdict.outcome,
            ]
            for joint in self.joints
        ]
        yield Table(rows=rows, heads=heads, lefts=1)
        yield Lines(self.notes, "assumes")


def claim_of_joints(outcome: Outcome, joints: Sequence[tuple[str, Verdict | PairVerdict, str]]) -> str:
    """How many are what, and the sentence of one: of those of this outcome the one that lacks most."""
    found = [verdict.outcome for _, verdict, _ in joints]
    counts = ", ".join(
        f"{found.count(one)} {one}" for one in (*_WORST[::-1], "passive")[::-1] if one in found
    )
    name, _, claim = min(
        (one for one in joints if one[1].outcome == outcome),
        key=lambda one: -inf if one[1].margin is None else one[1].margin,
    )
    return f"Of {len(found)} joints, each by itself: {counts}. {name}: {claim}"


def check_controllers(
    controllers: Controllers, plant: str | Device, rate: RealLike | None = None, delay: RealLike | None = None
) -> HeldJoints:
    """Decide for each joint of one arm whether a hand can take energy out of its spring.

    Parameters
    ----------
    controllers
        As `read_controllers` reads them.
    plant
        A TOML file with damping, coulomb_friction and resolution of the joints, or a rotary device for all.
    rate
        Of the controller [Hz]; None: that of the file.
    delay
        From reading to torque [s]; None: one period, as ros2_control reads, updates and writes in turn.

    Raises
    ------
    InputError
        If there are no joint gains or no rate, or a number is outside its bound.
    """
    loops = loops_of(controllers, plant, rate, delay)
    joints = tuple(
        HeldJoint(law, check(device, wall(law, loops.rate)))
        for law, device in zip(controllers.joints, loops.devices, strict=True)
    )
    return HeldJoints(joints, loops.notes)


class Loops(NamedTuple):
    """Each joint as a device; the controller's rate [Hz], the delay [s]; what was taken for granted."""

    devices: tuple[Device, ...]
    rate: Fraction
    delay: Fraction
    notes: tuple[str, ...]


def loops_of(
    controllers: Controllers, plant: str | Device, rate: RealLike | None, delay: RealLike | None
) -> Loops:
    """The loops of joint gains; arguments and errors as of `check_controllers`."""
    laws = controllers.joints
    if not laws:
        raise InputError(
            "the file has no gains of joints; a Cartesian impedance is a wall at the end: "
            "zwidth workspace ARM.urdf --pose --wall FILE"
        )
    often = controllers.rate if rate is None else parse_number(rate, "Hz", "rate").fraction
    if often is None:
        raise InputError("the file does not say its update_rate; give --rate [Hz]")
    late = 1 / often if delay is None else parse_number(delay, "s", "delay").fraction
    notes = (
        *controllers.notes,
        f"{shown(Exact(often), 'Hz')}, torque {shown(Exact(late), 's')} after the reading"
        + (": one period, an assumption" if delay is None else ""),
    )
    own: dict[str, Any] = {"rate": Exact(often), "delay": Exact(late)}
    if isinstance(plant, Device):
        devices = (plant.replace(**own),) * len(laws)
    else:
        rows = zip(laws, plant_of_file(len(laws), plant).follower, strict=True)
        devices = tuple(Device(**row, **own, motion="rotary", name=law.name) for law, row in rows)
    rigid = all(device.transmission is None for device in devices)
    out = "what joints share, gravity and flexible gears" if rigid else "what joints share and gravity"
    more = () if rigid else ("b is of the motors' side: gears that give way are in the model, as given",)
    return Loops(devices, often, late, (*notes, f"each joint by itself: {out} are not in the model", *more))


def wall(law: JointLaw, rate: Fraction) -> Environment:
    """On both sides of the target: H(z) = p + i T/(z − 1) + d (z − 1)/(T z)."""
    if not law.integral:
        k, b = law.stiffness, law.damping * rate
        return PulseTransferFunction([Exact(k + b), Exact(-b)], [1, 0])
    p, i, d = law.stiffness, law.integral / rate, law.damping * rate
    numerator = (p + d, i - p - 2 * d, d)
    return PulseTransferFunction([Exact(c) for c in numerator], [1, -1, 0])
