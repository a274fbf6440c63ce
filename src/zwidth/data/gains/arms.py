"""The gains of both arms, joint by joint, and the pairs that they make."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from zwidth.data.gains.joint import CoupledJoint, JointGains, coupled
from zwidth.data.gains.plant import Family, GivenPlant, Value, family, plant_of
from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.pairs import Pair
from zwidth.quantity.answered import answered, data_of
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.text import shown
from zwidth.quantity.units import parse_number
from zwidth.showing import Lines, Part, Shown, Table

MOST_READINGS = 200
"""Of a drive's own in a sample period where its rate is assumed: more change little and take long."""

Delay = RealLike | tuple[RealLike, RealLike]

_WITHOUT = "compensation of friction is left out: the claim is of arms without it"


@dataclass(frozen=True)
class Setting:
    """The joints of both arms with all that decides them, and what was taken for granted to make them."""

    joints: tuple[CoupledJoint, ...]
    notes: tuple[str, ...]


@dataclass(frozen=True, repr=False)
class ArmGains(Shown):
    """What the gain files of two arms say, in the units of the joints."""

    family: str = answered('such as "openarm": whose law these gains are for')
    joints: tuple[JointGains, ...] = answered("the gains of each joint, on both sides")
    notes: tuple[str, ...] = answered("what each number is, and what is not known of it")
    drives: bool = answered(
        "true where each arm's own part is computed in its motor drive", default=True, only_shown=True
    )
    follows: bool = answered(
        "true where the files are of a follower alone, whatever was taken for the leader",
        default=False,
        only_shown=True,
    )

    @property
    def published(self) -> Family:
        """What is published about the family."""
        return family(self.family)

    @property
    def is_pair(self) -> bool:
        """True where a law of both arms is known: the leader feels the follower."""
        return all(joint.leader is not None for joint in self.joints)

    def pairs(
        self,
        plant: GivenPlant = None,
        rate: RealLike | None = None,
        delay: Delay | None = None,
        drive_rate: RealLike | None = None,
        ideal_drive: bool = False,
        compensated: bool = True,
    ) -> dict[str, Pair]:
        """The pair of each joint, by its name.

        Parameters
        ----------
        plant
            A TOML file, the name of a published plant, a `Device` or one for each joint; None: the published
            one of the family.
        rate
            Of the references [Hz]; None: the family's.
        delay
            Of the link, one number or (there, back) [s]; None: the family's.
        drive_rate
            Of the loop in each drive [Hz], 0 where there is none; None: the family's, an assumption.
        ideal_drive
            True: what a drive does with its own speed is a damper, at once and without steps; the damping of
            each device then holds it.
        compensated
            False: compensation of friction is left out.

        Raises
        ------
        InputError
            If there is no law of both arms, no plant, or a number is outside its bound.
        """
        setting = self.setting(plant, rate, delay, drive_rate, ideal_drive, compensated)
        return {joint.name: joint.pair() for joint in setting.joints}

    def setting(
        self,
        plant: GivenPlant = None,
        rate: RealLike | None = None,
        delay: Delay | None = None,
        drive_rate: RealLike | None = None,
        ideal_drive: bool = False,
        compensated: bool = True,
    ) -> Setting:
        """The joints that `pairs` is made of, with what was taken for granted."""
        if not self.is_pair:
            raise InputError(
                f"{self.published.title}: the leader feels nothing, so this is no pair"
                + ("; --both takes the follower's gains on both sides" if self.follows else "")
            )
        known = self.published
        arms = plant_of(self.joints, known, plant)
        often = known.rate.value if rate is None else parse_number(rate, "Hz", "rate")
        if often.fraction <= 0:
            raise InputError(f"rate must be > 0, got {float(often):g} Hz: references are sent that often")
        usual = known.link_delay
        link = usual.value if delay is None else delay
        there, back = link if isinstance(link, (tuple, list)) and len(link) == 2 else (link, link)
        ways = parse_number(there, "s", "link delay"), parse_number(back, "s", "link delay back")
        inside = self._drive_rate(often, drive_rate)
        joints = []
        for joint, *rows in zip(self.joints, arms.leader, arms.follower, strict=True):
            leader, follower = (
                Device(**row, rate=often, delay=0, motion="rotary", name=joint.name) for row in rows
            )
            joints.append(
                coupled(
                    joint,
                    (leader, follower),
                    delay=ways,
                    drive_rate=inside,
                    ideal_drive=ideal_drive,
                    compensation=Fraction(compensated),
                    largest_stiffness=_of(known.largest_stiffness),
                    largest_damping=_of(known.largest_damping),
                )
            )
        notes = [
            *([f"rate {shown(often, 'Hz')}: {known.rate.source}"] if rate is None else []),
            *([f"link delay {shown(usual.value, 's')} each way: {usual.source}"] if delay is None else []),
            self._said_of_drives(inside, drive_rate is None, ideal_drive),
            *([] if compensated else [_WITHOUT]),
            arms.note,
            *self._beyond(known),
        ]
        return Setting(tuple(joints), tuple(notes))

    def _beyond(self, known: Family) -> Iterator[str]:
        """Gains that the drive does not take as they are."""
        limits = (
            (known.largest_stiffness, ("stiffness",), "kp"),
            (known.largest_damping, ("damping", "local_damping"), "kd"),
        )
        for limit, keys, said in limits:
            names = [
                joint.name
                for joint in self.joints
                for gains in (joint.leader, joint.follower)
                if limit and gains and any(getattr(gains, key) > limit.value.fraction for key in keys)
            ]
            if limit and names:
                yield (
                    f"{said} of {', '.join(dict.fromkeys(names))} is more than {float(limit.value):g} "
                    f"({limit.source}): decided as it stands in the file"
                )

    def _drive_rate(self, rate: Exact, given: RealLike | None) -> Exact | None:
        if given is not None:
            number = parse_number(given, "Hz", "drive_rate")
            return number if number else None
        if not self.drives:
            return None
        often = min(self.published.drive_rate.value.fraction // rate.fraction, MOST_READINGS)
        return Exact(rate.fraction * often) if often > 1 else None

    def _said_of_drives(self, rate: Exact | None, assumed: bool, ideal: bool) -> str:
        if rate is None:
            return "everything is computed once in a sample period: no loop inside the drive"
        source = f" ({self.published.drive_rate.source})" if assumed else ""
        speed = "its speed is the difference of two positions there, without filter or lag"
        if ideal:
            speed = "its kd of its own speed acts as a damper, at once and without steps"
        return f"each arm's own part is computed in its drive at {shown(rate, 'Hz')}{source}; {speed}"

    def to_dict(self) -> dict[str, Any]:
        """As plain data, units in the keys."""
        return data_of(self)

    def report(self) -> Iterator[Part]:
        """The gains joint by joint, and what they are."""
        yield f"{self.published.title}, {len(self.joints)} {'joint' if len(self.joints) == 1 else 'joints'}"
        heads = [["joint", "side", "K", "kd, against the other", "kd, of its own speed"]]
        heads.append(["", "", "N·m/rad", "N·m·s/rad", "N·m·s/rad"])
        rows = []
        for joint in self.joints:
            for side, gains in (("leader", joint.leader), ("follower", joint.follower)):
                if gains is None:
                    rows.append([joint.name, side, "none", "", ""])
                    continue
                numbers = (gains.stiffness, gains.damping, gains.local_damping)
                rows.append([joint.name, side, *(f"{float(v):.4g}" for v in numbers)])
        yield Table(rows=rows, heads=heads, lefts=2)
        yield Lines(self.notes, "what they are")


def _of(value: Value | None) -> Fraction | None:
    return None if value is None else value.value.fraction
