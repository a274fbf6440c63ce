"""Two arms joined by a spring and a damper over a link: position–position coupling.

Each side computes, once a sample, from its own reading and from the last one received of the other

    f_l(k) = K_l (x_l(k) − x_f(k − n_l)) + B_l (v_l(k) − v_f(k − n_l)) + D_l v_l(k)
    f_f(k) = K_f (x_f(k) − x_l(k − n_f)) + B_f (v_f(k) − v_l(k − n_f)) + D_f v_f(k)

with v the backward difference of x, and holds it.  A reading that is sent at kT arrives a link delay
later and is used at the next sample: n = ⌈delay/T⌉.

Instead of the other's position, or beside it, a side may be sent the other's coupling force
c_f = K_f (x_f − x_l') + B_f (v_f − v_l') and render it, r_l times, as it arrives:

    f_l(k) = c_l(k) − r_l c_f(k − n_l) + D_l v_l(k)

With K_l = 0 and r_l = 1 that is position–force coupling, of computed forces; with both it has four channels.

Most arms close their own part of this inside the motor drive, at 10 to 40 kHz, and send each other only
references, at 50 to 1000 Hz.  With a `drive_rate` x_l and v_l of the leader's own are read at that rate,
the terms of the other stay what they are for T; and so on the follower's side.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.rendering.friction_compensation import FrictionCompensation
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.parameter import Certain, CertainOrNone, Parametric, exact, parameters_of, read_number
from zwidth.quantity.text import shown

LONGEST = 400
"""Samples that a reading may be old where it acts."""

MOST_READINGS = 1000
"""Of an arm's own in a sample period."""

_PUSHES = "a spring below 0 pushes the arms apart and gives out energy without end"
_EARLY = "a reading cannot arrive before it is sent"
_ATTRACTS = "the other's force felt with its sign turned round pushes the arms apart"
_NO_COMPENSATION = FrictionCompensation()
_GAINS = (
    "stiffness",
    "damping",
    "local_damping",
    "follower_stiffness",
    "follower_damping",
    "follower_local_damping",
    "reflection",
    "follower_reflection",
    "drive_rate",
)
_CERTAIN = ("damping", "coulomb_friction", "resolution", "sample_period", "delay")


@dataclass(frozen=True)
class Side:
    """One arm of a pair, every number exact: its device, its gains, and how old the other's reading is.

    Attributes
    ----------
    damping, coulomb_friction, resolution
        b [N·s/m; N·m·s/rad], f_c [N; N·m], Δ [m; rad] of the device.
    delay
        From reading to force [s].
    stiffness, virtual_damping, local_damping
        K, B and D of its controller [N/m, N·s/m; N·m/rad, N·m·s/rad].
    reflection
        r: how many times it adds the coupling force of the other.
    link_delay
        Of what it receives [s].
    compensation
        Of its friction, by its own controller.
    echo_stiffness, echo_damping, return_delay
        r times K and B of the other, and the delay of what the other receives: its own motion comes back to
        it with these [N/m, N·s/m, s; N·m/rad, N·m·s/rad, s].
    """

    damping: Fraction
    coulomb_friction: Fraction
    resolution: Fraction
    delay: Fraction
    stiffness: Fraction
    virtual_damping: Fraction
    local_damping: Fraction
    reflection: Fraction
    link_delay: Fraction
    compensation: FrictionCompensation
    echo_stiffness: Fraction
    echo_damping: Fraction
    return_delay: Fraction

    @cached_property
    def felt_stiffness(self) -> Fraction:
        """Of the spring to the other arm in all, at rest [N/m; N·m/rad]."""
        return self.stiffness + self.echo_stiffness


@dataclass(frozen=True, init=False, repr=False)
class Pair(Parametric):
    """Leader and follower, joined by a spring and a damper over a link.

    ``f = K (x − x') + B (v − v') + D v`` on each side, of its own reading and of the last one received.

    Parameters
    ----------
    leader, follower
        The two devices: b, f_c, Δ, T and delay of each, as seen by one hand on each of them.  Both send what
        they read at the same instants, at the slower rate of the two; an arm that reads a whole number of
        times as often computes its own part at its own rate.
    stiffness
        K ≥ 0 on both sides, or on the leader's; 0 where it is felt by `reflection` alone [N/m; N·m/rad].
    damping
        B of the speed of one arm against the other, any sign [N·s/m; N·m·s/rad].
    local_damping
        D of each arm's own speed, any sign [N·s/m; N·m·s/rad].
    follower_stiffness, follower_damping, follower_local_damping
        The same on the follower's side, where they differ.  With another stiffness the energy of the
        follower's hand is counted K_l/K_f times, see `power_ratio`.
    reflection, follower_reflection
        r ≥ 0 of each side: how many times it adds the coupling force of the other, as it is received.  The
        follower's is 0 unless it is given.
    delay
        Of the link [s]: a number for each way, or (there, back): from leader to follower, and from follower
        to leader.
    drive_rate
        Of the drives, each of which holds its arm to the last reference at this rate [Hz], a whole number of
        times in T; both devices then are without delay.  None: everything is computed once in T.
    compensation
        Of each arm's friction, computed once in T; None: none.
    follower_compensation
        On the follower's side, where it is another; `FrictionCompensation()` where there is none.

    Raises
    ------
    InputError
        If the devices cannot be joined, a number is an interval, or outside its bound.
    """

    leader: Device
    follower: Device
    stiffness: Certain = exact("stiffness", bound="≥ 0", why=_PUSHES, meaning="spring between the arms")
    damping: Certain = exact(
        "virtual_damping", 0, meaning="virtual damping of the speed of one arm against the other"
    )
    local_damping: Certain = exact("local_damping", 0)
    follower_stiffness: CertainOrNone = exact(
        "stiffness", None, "≥ 0", _PUSHES, "stiffness on the follower's side, where it is another"
    )
    follower_damping: CertainOrNone = exact(
        "virtual_damping", None, meaning="virtual damping on the follower's side, where it is another"
    )
    follower_local_damping: CertainOrNone = exact(
        "local_damping", None, meaning="local damping on the follower's side, where it is another"
    )
    there: Certain = exact("link_delay", 0, "≥ 0", _EARLY, "from leader to follower, or each way")
    back: Certain = exact("link_delay", 0, "≥ 0", _EARLY, "from follower to leader, where it is another")
    drive_rate: CertainOrNone = exact(
        "rate",
        None,
        "> 0",
        "leave it out where there is no loop inside the drive",
        "of the loop inside each drive, a whole number of times the device's",
    )
    reflection: Certain = exact("reflection", 0, "≥ 0", _ATTRACTS)
    follower_reflection: Certain = exact(
        "reflection",
        0,
        "≥ 0",
        _ATTRACTS,
        "how many times the follower adds the leader's coupling force, as it is received",
    )
    compensation: FrictionCompensation | None = None
    follower_compensation: FrictionCompensation | None = None

    def __init__(
        self,
        leader: Device,
        follower: Device,
        *,
        stiffness: RealLike,
        damping: RealLike = 0,
        local_damping: RealLike = 0,
        follower_stiffness: RealLike | None = None,
        follower_damping: RealLike | None = None,
        follower_local_damping: RealLike | None = None,
        reflection: RealLike = 0,
        follower_reflection: RealLike = 0,
        delay: RealLike | tuple[RealLike, RealLike] = 0,
        drive_rate: RealLike | None = None,
        compensation: FrictionCompensation | None = None,
        follower_compensation: FrictionCompensation | None = None,
    ) -> None:
        for name, device in (("leader", leader), ("follower", follower)):
            if not isinstance(device, Device):
                raise InputError(f"{name} is a Device, got {type(device).__name__}")
        if leader.motion != follower.motion:
            raise InputError(
                f"a {leader.motion} leader and a {follower.motion} follower have no common spring; "
                "give both as seen by the hand, in the same unit"
            )
        laws = {"compensation": compensation, "follower_compensation": follower_compensation}
        for name, law in laws.items():
            if not isinstance(law, FrictionCompensation | None):
                raise InputError(f"{name} is a FrictionCompensation or None, got {type(law).__name__}")
        there, back = delay if isinstance(delay, (tuple, list)) and len(delay) == 2 else (delay, delay)
        everything = locals()
        given = {name: everything[name] for name in parameters_of(Pair)}
        self._keep(leader=leader, follower=follower, **laws, **given)
        read = {name: self._number(name, value) for name, value in given.items()}
        self._keep(**read)
        self._check("leader", "follower")

    def _check(self, *changed: str) -> None:
        """What ties its numbers together, and that those of devices that changed are certain."""
        for name in changed:
            for key in _CERTAIN:
                try:
                    getattr(self, name).exact(key)
                except InputError as error:
                    raise InputError(f"{name}: {error}") from None
        self._check_springs()
        self._check_clocks()

    def _number(self, name: str, value: Any) -> Exact | None:
        if value is None:
            return None
        own = parameters_of(Pair)[name]
        said = {"there": "delay there", "back": "delay back"}.get(name, name)
        return Exact(read_number(value, own.quantity, said, bound=own.bound, why=own.why, motion=self.motion))

    def _check_springs(self) -> None:
        for name, side in zip(("leader", "follower"), self.sides, strict=True):
            if not side.felt_stiffness:
                raise InputError(
                    f"the {name} feels no spring: with a stiffness of 0 it needs a reflection > 0 of the "
                    "other's force, or the arms do not follow"
                )

    def _check_clocks(self) -> None:
        quick, slow = sorted(device.exact("sample_period") for device in (self.leader, self.follower))
        if slow % quick:
            rates = " and ".join(shown(1 / period, "Hz", 6) for period in (quick, slow))
            raise InputError(
                f"one arm reads a whole number of times as often as the other, got {rates}: give both the "
                "slower rate, or the rate of the bus that reads both"
            )
        if self.drive_rate is not None:
            self._check_drives(self.drive_rate)
        elif slow // quick > MOST_READINGS:
            raise InputError(
                f"one arm reads at most {MOST_READINGS} times as often as the other, got {slow // quick}"
            )
        if self.own_readings > 1 and any(side.delay for side in self.sides):
            raise InputError(
                "an arm that reads more often than it sends is without delay, and so is the other: that of a "
                "drive is not decided here; leave out the delay of both devices, and give that of the bus as "
                "delay of the link"
            )
        for name, side in zip(("leader", "follower"), self.sides, strict=True):
            for what, time in (("delay", side.delay), ("link delay", side.link_delay)):
                if time > LONGEST * slow:
                    raise InputError(
                        f"the {what} of the {name} is {float(time / slow):.0f} samples, at most "
                        f"{LONGEST} are decided; so old a reading leaves next to nothing that is passive: "
                        "lower the rate"
                    )

    def _check_drives(self, rate: Exact) -> None:
        often = rate.fraction * self.sample_period
        if often.denominator != 1 or not 1 <= often <= MOST_READINGS:
            raise InputError(
                f"drive_rate must be 1 to {MOST_READINGS} whole times the "
                f"{shown(1 / self.sample_period, 'Hz', 6)} of the references, got {shown(rate, 'Hz', 6)}: "
                "the loop of the drive and the bus are taken in step"
            )

    @cached_property
    def readings(self) -> tuple[int, int]:
        """Readings of its own that leader and follower take in T."""
        if self.drive_rate is not None:
            both = int(self.drive_rate.fraction * self.sample_period)
            return both, both
        leader, follower = (
            int(self.sample_period / device.exact("sample_period")) for device in (self.leader, self.follower)
        )
        return leader, follower

    @property
    def own_readings(self) -> int:
        """Readings in T of the arm that reads more often."""
        return max(self.readings)

    @property
    def motion(self) -> str:
        """ "linear" or "rotary"."""
        return self.leader.motion

    @cached_property
    def sample_period(self) -> Fraction:
        """T, from one reading that is sent to the next [s]."""
        return max(device.exact("sample_period") for device in (self.leader, self.follower))

    @property
    def delay(self) -> tuple[Exact, Exact]:
        """Of the link, there and back [s]."""
        return self.there, self.back

    @property
    def power_ratio(self) -> Fraction:
        """K_l/K_f, reflections added: how often the work of the follower's hand counts.

        1 where both springs are the same.
        """
        return self.sides[0].felt_stiffness / self.sides[1].felt_stiffness

    @cached_property
    def sides(self) -> tuple[Side, Side]:
        """Leader and follower, with what each computes from."""
        gains = [value.fraction for value in (self.stiffness, self.damping, self.local_damping)]
        own = (self.follower_stiffness, self.follower_damping, self.follower_local_damping)
        its = [mine if value is None else value.fraction for mine, value in zip(gains, own, strict=True)]
        law, other = self.compensations
        links = (self.back.fraction, self.there.fraction)
        reflections = (self.reflection.fraction, self.follower_reflection.fraction)
        return (
            _side(self.leader, (gains, its), reflections[0], links, law),
            _side(self.follower, (its, gains), reflections[1], links[::-1], other),
        )

    @property
    def compensations(self) -> tuple[FrictionCompensation, FrictionCompensation]:
        """Of leader and follower; of zeros where there is none."""
        law = self.compensation or _NO_COMPENSATION
        return law, law if self.follower_compensation is None else self.follower_compensation

    @property
    def felt_stiffness(self) -> Fraction:
        """Of the spring between the arms in all, as the leader feels it at rest [N/m; N·m/rad]."""
        return self.sides[0].felt_stiffness

    def stiffened(self, felt: Fraction) -> Pair:
        """With a spring that the leader feels with this stiffness, both sides in proportion."""
        leader, follower = (side.stiffness * felt / self.felt_stiffness for side in self.sides)
        return self.replace(stiffness=Exact(leader), follower_stiffness=Exact(follower))

    def replace(self, **changes: Any) -> Pair:
        """The same pair with some arguments changed."""
        if all(self._is_alike(name, value) for name, value in changes.items()):
            return self._with(**changes)
        others = ("leader", "follower", "delay", "compensation", "follower_compensation")
        return Pair(**{**{name: getattr(self, name) for name in (*_GAINS, *others)}, **changes})

    def _is_alike(self, name: str, value: Any) -> bool:
        """True of what may be changed while all else stays as it was read."""
        if isinstance(value, Device):
            return name in ("leader", "follower") and value.motion == self.motion
        if name == "delay":
            return type(value) is tuple and len(value) == 2
        return type(value) is Exact and name in _GAINS

    def _with(self, **changes: Any) -> Pair:
        """The same with such changes."""
        if "delay" in changes:
            changes["there"], changes["back"] = changes.pop("delay")
        devices = [name for name, value in changes.items() if isinstance(value, Device)]
        numbers = {name: self._number(name, value) for name, value in changes.items() if name not in devices}
        pair: Pair = self._changed(**{**changes, **numbers})
        pair._check(*devices)
        return pair

    def describe(self) -> str:
        """The coupling in a line."""
        unit = self.leader.unit
        parts = [f"K = {shown(self.stiffness, unit('stiffness'))}"]
        if self.follower_stiffness is not None:
            parts.append(f"{shown(self.follower_stiffness, unit('stiffness'))} on the follower's side")
        for symbol, name in (("B", "damping"), ("D", "local_damping")):
            gain, its = getattr(self, name), getattr(self, f"follower_{name}")
            if gain or its:
                parts.append(f"{symbol} = {shown(gain, unit('virtual_damping'))}")
            if its is not None:
                parts.append(f"{shown(its, unit('virtual_damping'))} on the follower's side")
        for name, share in (("leader", self.reflection), ("follower", self.follower_reflection)):
            if share:
                parts.append(f"{float(share):g} times the other's coupling force felt by the {name}")
        if self.drive_rate is not None:
            parts.append(f"each arm's own part in its drive at {shown(self.drive_rate, 'Hz')}")
        law, other = self.compensations
        if law or other:
            parts.append(f"compensation of friction by {law.force_in_words(self.motion)}")
        if other != law:
            parts.append(f"on the follower's side by {other.force_in_words(self.motion)}")
        there, back = (shown(value, "s") for value in self.delay)
        parts.append(
            f"link delay {there} there, {back} back" if there != back else f"link delay {there} each way"
        )
        return ", ".join(parts)

    def __repr__(self) -> str:
        return f"<Pair {self.leader.name} and {self.follower.name}: {self.describe()}>"


def _side(
    device: Device,
    gains: tuple[list[Fraction], list[Fraction]],
    reflection: Fraction,
    links: tuple[Fraction, Fraction],
    law: FrictionCompensation,
) -> Side:
    (stiffness, virtual, local), (its_stiffness, its_virtual, _) = gains
    return Side(
        damping=device.exact("damping"),
        coulomb_friction=device.exact("coulomb_friction"),
        resolution=device.exact("resolution"),
        delay=device.exact("delay"),
        stiffness=stiffness,
        virtual_damping=virtual,
        local_damping=local,
        reflection=reflection,
        link_delay=links[0],
        compensation=law,
        echo_stiffness=reflection * its_stiffness,
        echo_damping=reflection * its_virtual,
        return_delay=links[1],
    )
