"""Gains of one arm's joints that are passive, as near to those of a file as the joints' damping allows.

    need(p, d) ≤ s b,   need(λ p, λ d) = λ need(p, d)

need is the damping that a joint needs for its spring and damper: of all frequencies the largest sum that goes
with p and d, so convex, and in proportion to both.  Gains that are proved stay.  Of others the spring comes
first: p of the file where a d between 0 and the file's allows it, else the stiffest with d/p up to the
file's; then as much of d as is left.  An integrator gives energy out to a slow hand whatever the damping, so
there is none.  What is found is rounded down and proved by itself, with the share s of the joint's damping.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from math import floor, inf, log10
from pathlib import Path
from typing import Any

from zwidth.data.gains.best import peak
from zwidth.data.gains.controllers import Controllers, JointLaw
from zwidth.data.gains.held_joints import HeldJoint, Loops, loops_of, wall
from zwidth.data.gains.parameters import parameter_file
from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.passivity.check import check
from zwidth.passivity.transmission import seen_at_motor
from zwidth.quantity.exact import Exact, RealLike, ends
from zwidth.quantity.text import shown
from zwidth.quantity.units import parse_number
from zwidth.showing import Shown
from zwidth.writing import writing_whole

SHARE = "0.8"
"""Of each joint's damping, where nothing is given."""

_DIGITS = 4
"""Significant digits that are written."""

_TRIES = 6
_HALVINGS = 24


class Saved(Shown, ABC):
    """What was found, as a file that an arm reads."""

    @abstractmethod
    def to_yaml(self) -> str:
        """As text: below the names of the file, units and what was found in comments."""

    def save(self, path: str | Path) -> None:
        """Write it as YAML, whole or not at all.

        Raises
        ------
        InputError
            If the file cannot be written.
        """
        with writing_whole(Path(path)) as file:
            file.write(self.to_yaml().encode())


@dataclass(frozen=True, repr=False)
class PassiveGains(Saved):
    """Gains of one arm's joints that are proved, as a parameter file of ros2_control.

    Attributes
    ----------
    asked
        The gains of the file.
    joints
        The gains that are passive, each with its proof, for the share of the joint's damping.
    share
        How much of each joint's damping they use at most.
    rate
        Of the controller [Hz].
    delay
        From reading to torque [s].
    notes
        What was taken for granted.
    """

    asked: Controllers
    joints: tuple[HeldJoint, ...]
    share: Fraction
    rate: Fraction
    delay: Fraction
    notes: tuple[str, ...]

    @property
    def changed(self) -> tuple[tuple[JointLaw, JointLaw], ...]:
        """(law of the file, law that is proved) of each joint."""
        return tuple(zip(self.asked.joints, (joint.law for joint in self.joints), strict=True))

    def to_yaml(self) -> str:
        """As text: below the names of the file, units and what was proved in comments."""
        return parameter_file(
            [(law, _comment(old, law)) for old, law in self.changed],
            self.rate,
            self.asked.manager,
            list(self.report()),
        )

    def report(self) -> Iterator[str]:
        """What is promised, and what that assumes."""
        yield (
            "Gains of joints, each proved passive by itself: no motion of a hand that moves the joint takes "
            f"energy out, as long as it damps at least {shown(self.share, '%', 6)} of what was given. "
            "Computed by zwidth, tried on no machine."
        )
        yield "For ROS: to be loaded after your own parameter file; what is not here stays as it is there."
        yield "What the proofs assume:"
        damping = (f"{one.law.name} {float(one.verdict.device.exact('damping')):.4g}" for one in self.joints)
        yield f"- damping in the joints [N*m*s/rad]: {', '.join(damping)}"
        for note in self.notes:
            yield f"- {note}"


def passive_gains(
    controllers: Controllers,
    plant: str | Device,
    rate: RealLike | None = None,
    delay: RealLike | None = None,
    *,
    share: RealLike = SHARE,
    stiffest: bool = False,
) -> PassiveGains:
    """Find gains of one arm's joints that are proved passive.

    Parameters
    ----------
    controllers, plant, rate, delay
        As of `check_controllers`.
    share
        How much of each joint's damping the gains may use, 0 < share ≤ 1.
    stiffest
        True: the stiffest springs that are proved, with the d that allows them, whatever the file has. Else p
        of the file is kept where it can be, and lowered where not, and then d.

    Raises
    ------
    InputError
        If a number is outside its bound, or of a joint no gains are proved.
    """
    if any(law.form == "joints" for law in controllers.joints):
        raise InputError(
            "kp and damping_ratio tie the damper to the spring: no gains are written of them; ask of p and d "
            "in {arm: {ros__parameters: {gains: {JOINT: {p: …, d: …}}}}}"
        )
    part = share_of(share)
    loops = loops_of(controllers, plant, rate, delay)
    joints = tuple(
        _Joint(law, _felt(device, part), loops).nearest(stiffest)
        for law, device in zip(controllers.joints, loops.devices, strict=True)
    )
    steps = any(device.exact("resolution") for device in loops.devices)
    more = () if steps else ("encoder steps are not counted: their size was not given",)
    return PassiveGains(controllers, joints, part, loops.rate, loops.delay, (*loops.notes, *more))


def _felt(device: Device, part: Fraction) -> Device:
    """With a part of its damping; of a joint that gives way, of what its motor feels, however it does."""
    if device.transmission is not None and device.transmission.encoder == "motor":
        device = seen_at_motor(device)
        return device.replace(damping=Exact(part * ends(device.damping)[0]))
    return device.replace(damping=Exact(part * device.exact("damping")))


def share_of(given: RealLike) -> Fraction:
    """How much of each joint's damping gains may use."""
    part = parse_number(given, "1", "share").fraction
    if not 0 < part <= 1:
        raise InputError(
            f"share is how much of a joint's damping the gains may use, 0 < share ≤ 1, got {float(part):g}"
        )
    return part


@dataclass(frozen=True)
class _Joint:
    law: JointLaw
    device: Device
    loops: Loops

    def nearest(self, stiffest: bool) -> HeldJoint:
        p, d = float(self.law.stiffness), float(self.law.damping)
        if min(p, d) < 0:
            raise InputError(f"{self.law.source}: p and d must be ≥ 0: a spring pulls back, a damper brakes")
        own = self._held(self.law.stiffness, self.law.damping)
        if own.verdict.passive and not stiffest:
            return own
        found = self._stiffest() if stiffest else self._near(p, d)
        proved = self._proved(*found)
        if proved is None:
            raise InputError(f"no gains of {self.law.name} are proved: {self._lacking()}")
        return proved

    def _lacking(self) -> str:
        if self.device.exact("resolution") and not self.device.exact("coulomb_friction"):
            return (
                f"encoder steps of {shown(self.device.resolution, 'rad')} take Coulomb friction, and none "
                "was given; give coulomb_friction, or leave out resolution to ask without the steps"
            )
        return (
            f"{shown(self.device.damping, 'N*m*s/rad')} of damping and "
            f"{shown(self.device.coulomb_friction, 'N*m')} of Coulomb friction leave nothing for a spring"
        )

    @property
    def budget(self) -> float:
        return float(self.device.exact("damping"))

    def _near(self, p: float, d: float) -> tuple[float, float]:
        if not p:
            return 0.0, self.budget / self._need(0.0, 1.0)
        ratio = self._best_ratio(d / p)
        most = self.budget / self._need(1.0, ratio)
        if most < p:
            return most, ratio * most
        return p, _last(lambda damping: self._need(p, damping) <= self.budget, ratio * p, d)

    def _stiffest(self) -> tuple[float, float]:
        """Slow hands need p (τ + T/2) − d: beyond d = p (τ + T) it is the quick ones that decide."""
        ratio = self._best_ratio(float(self.loops.delay + 1 / self.loops.rate))
        most = self.budget / self._need(1.0, ratio)
        return most, ratio * most

    def _best_ratio(self, high: float) -> float:
        """d/p with which a spring needs the least."""
        return peak(lambda ratio: -self._need(1.0, ratio), high, 0.0)

    def _need(self, p: float, d: float) -> float:
        if not p and not d:
            return 0.0
        margin = self._held(Exact(p).fraction, Exact(d).fraction).verdict.margins.get("damping")
        return inf if margin is None else self.budget - margin

    def _held(self, p: Fraction, d: Fraction) -> HeldJoint:
        law = replace(self.law, stiffness=p, integral=Fraction(0), damping=d)
        return HeldJoint(law, check(self.device, wall(law, self.loops.rate)))

    def _proved(self, p: float, d: float) -> HeldJoint | None:
        """Rounded down, and lower until it is proved; by halving where encoder steps ask for less."""
        for tries in range(_TRIES):
            if (found := self._try(p * (1 - tries / 10**_DIGITS), d)) is not None:
                return found
        part = _last(lambda s: self._try(s * p, s * d) is not None, 0.0, 1.0)
        return self._try(part * p, part * d) if part else None

    def _try(self, p: float, d: float) -> HeldJoint | None:
        kept = p == float(self.law.stiffness)
        stiffness, damping = self.law.stiffness if kept else rounded_down(p), rounded_down(d)
        if not stiffness and not damping:
            return None
        held = self._held(stiffness, damping)
        return held if held.verdict.passive else None


def _last(holds: Callable[[float], bool], low: float, high: float) -> float:
    """The last number up to which it holds, as far as 24 halvings tell; it is taken to hold at `low`."""
    if holds(high):
        return high
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        low, high = (middle, high) if holds(middle) else (low, middle)
    return low


def rounded_down(value: float) -> Fraction:
    """To the digits that are written."""
    if value <= 0:
        return Fraction(0)
    unit = Fraction(10) ** (floor(log10(value)) - _DIGITS + 1)
    return Exact(value).fraction // unit * unit


def _comment(old: JointLaw, new: JointLaw) -> dict[str, str]:
    """What stood in the file, where that is another number."""
    pairs: dict[str, tuple[Any, Any]] = {
        "p": (old.stiffness, new.stiffness),
        "i": (old.integral, new.integral),
        "d": (old.damping, new.damping),
    }
    return {key: f"your file: {float(was):g}" for key, (was, now) in pairs.items() if was != now}
