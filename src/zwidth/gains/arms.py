"""The gains of both arms, joint by joint, and the pairs that they make."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from zwidth.device import Device
from zwidth.errors import InputError
from zwidth.gains.joint import Gains, JointGains
from zwidth.gains.plant import GivenPlant, plant_of
from zwidth.gains.published import Family, family
from zwidth.pairs import Pair
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.text import shown
from zwidth.quantity.units import parse_number
from zwidth.showing import Lines, Part, Shown, Table

Delay = RealLike | tuple[RealLike, RealLike]


@dataclass(frozen=True)
class Setting:
    """The pairs of an arm's joints, and what was taken for granted to make them."""

    pairs: dict[str, Pair]
    notes: tuple[str, ...]


@dataclass(frozen=True, repr=False)
class ArmGains(Shown):
    """What the gain files of two arms say, in the units of the joints.

    Attributes
    ----------
    family
        Such as "openarm": whose law these gains are for.
    joints
        The gains of each joint, on both sides.
    notes
        What each number is, and what is not known of it.
    drives
        True where each arm's own part is computed in its motor drive.
    """

    family: str
    joints: tuple[JointGains, ...]
    notes: tuple[str, ...]
    drives: bool = True

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

        Raises
        ------
        InputError
            If there is no law of both arms, no plant, or a number is outside its bound.
        """
        return self.setting(plant, rate, delay, drive_rate).pairs

    def setting(
        self,
        plant: GivenPlant = None,
        rate: RealLike | None = None,
        delay: Delay | None = None,
        drive_rate: RealLike | None = None,
    ) -> Setting:
        """`pairs`, with what was taken for granted."""
        if not self.is_pair:
            raise InputError(
                f"{self.published.title}: the leader feels nothing, so this is no pair; --both takes the "
                "follower's gains on both sides"
            )
        known = self.published
        arms = plant_of(self.joints, known, plant)
        often = known.rate.value if rate is None else parse_number(rate, "Hz", "rate")
        link = known.link_delay.value if delay is None else delay
        inside = self._drive_rate(often, drive_rate)
        pairs = {}
        for n, joint in enumerate(self.joints):
            leader, follower = (
                Device(**rows[n], rate=often, delay=0, motion="rotary", name=f"{joint.name}, {side}")
                for side, rows in (("leader", arms.leader), ("follower", arms.follower))
            )
            assert joint.leader is not None
            pairs[joint.name] = Pair(
                leader,
                follower,
                delay=link if isinstance(link, tuple) else parse_number(link, "s", "link delay"),
                drive_rate=inside,
                **coupling(joint.leader, joint.follower),
            )
        taken = (
            *(f"rate {shown(often, 'Hz')}: {known.rate.source}" for _ in [0] if rate is None),
            *(
                f"link delay {shown(known.link_delay.value, 's')} each way: {known.link_delay.source}"
                for _ in [0]
                if delay is None
            ),
            *self._said_of_drives(inside, drive_rate is None),
            arms.note,
        )
        return Setting(pairs, taken)

    def _drive_rate(self, rate: Exact, given: RealLike | None) -> Exact | None:
        if given is not None:
            number = parse_number(given, "Hz", "drive_rate")
            return number if number else None
        if not self.drives:
            return None
        often = self.published.drive_rate.value.fraction // rate.fraction
        return Exact(rate.fraction * often) if often > 1 else None

    def _said_of_drives(self, rate: Exact | None, assumed: bool) -> Iterator[str]:
        if rate is None:
            yield "everything is computed once in a sample period: no loop inside the drive"
            return
        source = f": {self.published.drive_rate.source}" if assumed else ""
        yield (
            f"each arm's own part is computed in its drive at {shown(rate, 'Hz')}{source}; speed is the difference "
            "of two positions there, without filter, and current follows at once"
        )

    def to_dict(self) -> dict[str, Any]:
        """As plain data, units in the keys."""
        return {
            "family": self.family,
            "joints": [joint.to_dict() for joint in self.joints],
            "notes": list(self.notes),
        }

    def report(self) -> Iterator[Part]:
        """The gains joint by joint, and what they are."""
        yield f"{self.published.title}, {len(self.joints)} joints"
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


def coupling(leader: Gains, follower: Gains, times: Fraction = Fraction(1)) -> dict[str, Any]:
    """The arguments of `Pair` that the gains of both sides are; damping `times` what it is."""
    return {
        "stiffness": Exact(leader.stiffness),
        "damping": Exact(times * leader.damping),
        "local_damping": Exact(times * leader.local_damping),
        "follower_stiffness": Exact(follower.stiffness) if follower.stiffness != leader.stiffness else None,
        "follower_damping": Exact(times * follower.damping) if follower.damping != leader.damping else None,
        "follower_local_damping": Exact(times * follower.local_damping)
        if follower.local_damping != leader.local_damping
        else None,
    }
