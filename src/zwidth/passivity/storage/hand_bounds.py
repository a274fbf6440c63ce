"""Which hands an outcome is about: how fast and how deep, as exact data; and a proof of slow ones."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.passivity.certificate import FORMAT, Certificate, wall_document
from zwidth.passivity.criterion_choice import Decision, decide
from zwidth.passivity.linear.contact import DampedWall, enough_damping
from zwidth.passivity.scope import Hands, unit_key
from zwidth.passivity.storage.domain import Domain, Losses
from zwidth.passivity.storage.law import FiniteLaw
from zwidth.quantity.exact import Exact
from zwidth.quantity.text import exact_text
from zwidth.quantity.units import parse_number


@dataclass(frozen=True)
class HandBounds:
    """Bounds on the hand, exact."""

    speed: Fraction  # largest mean speed over a sample, or over each part of it with one force [m/s; rad/s]
    penetration: Fraction  # deepest position that a proof covers, a whole number of counts [m; rad]
    max_depth: Fraction  # deepest position of a motion that refutes, at most `penetration` [m; rad]
    outside: Fraction | None  # how far outside the hand may go [m; rad]; None: any distance
    # Δ [m; rad] and T [s]
    resolution: Fraction
    period: Fraction

    @property
    def counts_per_sample(self) -> Fraction:
        """The speed in counts a sample."""
        return self.speed * self.period / self.resolution

    @property
    def counts_deep(self) -> int:
        """The depth of a proof in counts."""
        return int(self.penetration / self.resolution)

    def hands(self, in_each_part: bool) -> Hands:
        """The hands of a proof, for its scope."""
        return Hands(
            speed=float(self.speed),
            in_each_part=in_each_part,
            inside=float(self.penetration),
            outside=None if self.outside is None else float(self.outside),
            counts_a_sample=float(self.counts_per_sample),
            counts_inside=float(self.counts_deep),
        )

    def document(self, motion: str) -> dict[str, str]:
        """What a motion keeps to, as data for the checker."""
        length = unit_key("position", motion).removeprefix("position_")
        document = {
            f"speed_{length}_per_s": exact_text(self.speed),
            f"depth_{length}": exact_text(self.max_depth),
        }
        if self.ends[0] is not None:
            document[f"outside_{length}"] = exact_text(-self.ends[0])
        return document

    @property
    def ends(self) -> tuple[Fraction | None, Fraction]:
        """Between which positions a motion that refutes stays [m; rad]; None: as far outside as it likes."""
        far = self.max_depth if self.outside == self.penetration else self.outside
        return None if far is None else -far, self.max_depth


def bounds_given(device: Device, penetration: object, speed: object) -> tuple[Exact | None, Exact | None]:
    """Bounds on the hand in SI, as numbers or as texts with a unit; None where there is none."""
    return (
        None if penetration is None else parse_number(penetration, device.unit("position"), "penetration"),
        None if speed is None else parse_number(speed, device.unit("velocity"), "speed"),
    )


def hand_bounds(law: FiniteLaw, losses: Losses, domain: Domain) -> HandBounds:
    """The bounds of a domain, whose cells are those of the losses."""
    step = losses.resolution
    outside: Fraction | None = None
    if law.surface == "none" or (law.relaxing is not None and law.surface == "position"):
        outside = -domain.lowest * step
    deep, speed = domain.highest + 1, domain.speed * step / losses.period
    max_depth = deep if domain.max_depth is None else domain.max_depth
    return HandBounds(speed, deep * step, max_depth * step, outside, step, losses.period)


# Slow hands: what covers every hand with more damping covers slow ones with more Coulomb friction.
#
#     v (b_0 − b) ≤ f_c − f_0
#
# b_0 and f_0 cover contact made and broken by every hand: of a spring, or of a wall with virtual damping
# (`contact`).  No count of the encoder is gone through: a fine one is as easy as a coarse one.


KIND = "slow hands"


def slow_hands(device: Device, environment: Environment, speed: Fraction) -> Certificate | None:
    """A proof for hands whose mean speed stays at or below `speed` [m/s; rad/s], at any depth; None without.

    The mean is over each time in which one force is held: a sample, or each part of it where a delay
    changes the force in between.
    """
    try:
        decision = decide(device, environment)
    except InputError:  # a law without H(z)
        return None
    enough = _enough(decision)
    if enough is None or not _covers(decision, *enough, speed):
        return None
    certificate = Certificate((_document(decision, *enough, speed),))
    return certificate if certificate.verify() else None


def _enough(decision: Decision) -> tuple[Fraction, Fraction] | None:
    """b_0 and f_0 that cover every hand; None where none are known."""
    if decision.is_spring:
        spring = Fraction(decision.loop.numerator[0], decision.loop.denominator[0])
        return enough_damping(decision.loop, spring), spring * decision.setting.resolution / 2
    wall = decision.wall
    if not (isinstance(wall, DampedWall) and decision.setting.unilateral and wall.stiffness >= 0):
        return None
    damping = wall.required_damping(decision.loop)
    if damping is None:
        return None
    return damping, wall.required_friction(decision.setting.resolution, decision.loop.period)


def _covers(decision: Decision, damping: Fraction, friction: Fraction, speed: Fraction) -> bool:
    left_over = decision.setting.coulomb_friction - friction
    return left_over >= 0 and left_over >= (damping - decision.loop.damping) * speed


def _document(decision: Decision, damping: Fraction, friction: Fraction, speed: Fraction) -> dict[str, Any]:
    motion = decision.setting.motion
    kind = "spring" if decision.is_spring else "contact"
    document: dict[str, Any] = {
        "format": FORMAT,
        "kind": KIND,
        "loop": decision.setting.loop_document(),
        f"largest_speed_{'rad_per_s' if motion == 'rotary' else 'm_per_s'}": exact_text(speed),
        "enough": {
            "kind": kind,
            unit_key("damping", motion): exact_text(damping),
            unit_key("coulomb_friction", motion): exact_text(friction),
        },
    }
    if kind == "contact":
        assert isinstance(decision.wall, DampedWall)
        document["law"] = wall_document(decision.wall, motion)
    return document
