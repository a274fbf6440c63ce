"""One device and one environment, decided: which proof, or which refutation, applies.

Two conditions, and both must hold:

viscous    the hold, the delay and the law itself leak energy that b must take
           out: the linear criterion (`criterion`), exact and necessary;
friction   one encoder count leaks energy that f_c must take out.  For a spring
           f_c ≥ K Δ/2 is necessary and sufficient (Abbott & Okamura 2005; with any delay: see the
           documentation).  For another law f_c ≥ ‖h‖₁ Δ/2 is sufficient and straddling an edge gives a
           necessary bound; between the two nothing is claimed.

Coulomb friction never helps against the first: a larger motion outweighs it.

Both speak of the law while the hand stays inside.  A law for which the conditions
of `contact` hold is passive with contact made and broken too;
of a clamped law with memory nothing else is claimed, for it is not linear inside.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Literal

from zwidth.model.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.passivity.linear.contact import (
    DampedWall,
    MultiplierLaw,
    RelaxingLaw,
    damped_wall,
    multiplier_law,
    relaxing_law,
)
from zwidth.passivity.linear.criterion import LinearProof, LinearRefutation, decide_linear
from zwidth.passivity.linear.loop import LinearLoop, linear_loop
from zwidth.passivity.linear.one_norm import NormBound, bound_one_norm
from zwidth.passivity.witness.motion import best_waits
from zwidth.passivity.witness.witness import Setting

Kind = Literal["spring", "contact", "relaxing contact", "multiplier contact", "linear", "quantized"]


ContactLaw = DampedWall | RelaxingLaw | MultiplierLaw
"""A law as one proof for contact made and broken sees it: the damping and the friction that it asks for."""


@dataclass(frozen=True)
class Decision:
    """What is known of one loop; nothing here is claimed before its proof or motion is checked.

    `wall` and `multiplier` are the law as the conditions for contact made and broken see
    it, None for a law of which none are known; `never_pulls` says whether its force is clamped.
    """

    setting: Setting
    wall: DampedWall | RelaxingLaw | None = None
    never_pulls: bool = False
    multiplier: MultiplierLaw | None = None

    @property
    def loop(self) -> LinearLoop:
        """The exact linear loop."""
        return self.setting.loop

    @property
    def is_spring(self) -> bool:
        """True when H(z) is a constant K ≥ 0."""
        loop = self.loop
        return len(loop.numerator) == len(loop.denominator) == 1 and loop.numerator[0] >= 0

    @property
    def kind(self) -> Kind:
        """Which kind of certificate covers this loop."""
        if self.is_spring:
            return "spring"
        if self.covers_contact:
            if not self._covered_by(self.wall):
                return "multiplier contact"
            return "relaxing contact" if isinstance(self.wall, RelaxingLaw) else "contact"
        return "quantized" if self.setting.resolution else "linear"

    @property
    def is_clamped(self) -> bool:
        """True for a clamped law with memory: not linear inside, so H(z) alone decides nothing."""
        return self.never_pulls and not self.is_spring

    @property
    def contact_damping(self) -> Fraction | None:
        """Device damping that covers a wall touched and left [N·s/m; N·m·s/rad]; None where none is known."""
        return None if self._least_contact is None else self._least_contact[0]

    @property
    def contact_friction(self) -> Fraction | None:
        """The same for Coulomb friction and the encoder [N; N·m]."""
        if self._least_contact is None:
            return None
        return self._least_contact[1].required_friction(self.setting.resolution, self.loop.period)

    @cached_property
    def _least_contact(self) -> tuple[Fraction, ContactLaw] | None:
        """The least damping that any conditions ask for, and which."""
        laws = [law for law in (self.wall, self.multiplier) if law is not None]
        needs = [(need, law) for law in laws if (need := law.required_damping(self.loop)) is not None]
        return min(needs, key=lambda pair: pair[0], default=None)

    def _covered_by(self, law: ContactLaw | None) -> bool:
        if law is None:
            return False
        damping = law.required_damping(self.loop)
        if damping is None or self.loop.damping < damping:
            return False
        friction = law.required_friction(self.setting.resolution, self.loop.period)
        return friction is not None and self.setting.coulomb_friction >= friction

    @cached_property
    def covers_contact(self) -> bool:
        """True when both conditions for a wall touched and left hold."""
        if self._covered_by(self.wall):
            return True
        is_told = self.multiplier is not None and isinstance(self.viscous, LinearProof)
        return is_told and self._covered_by(self.multiplier)

    @cached_property
    def viscous(self) -> LinearProof | LinearRefutation:
        """The linear criterion, decided."""
        return decide_linear(self.loop)

    @cached_property
    def norm(self) -> NormBound | None:
        """The bound on ‖h‖₁."""
        return bound_one_norm(self.loop)

    @property
    def sufficient_friction(self) -> Fraction | None:
        """Coulomb friction that certainly covers the encoder [N; N·m]; None where no bound is known."""
        if self.setting.resolution == 0:
            return Fraction(0)
        if self.is_clamped:
            return self.contact_friction
        bounds = [] if self.norm is None else [self.norm.bound * self.setting.resolution / 2]
        if self.covers_contact and self.contact_friction is not None:
            bounds.append(self.contact_friction)
        return min(bounds, default=None)

    @cached_property
    def necessary_friction(self) -> float:
        """Coulomb friction below which straddling an encoder edge gains energy, to rounding [N; N·m]."""
        if self.setting.resolution == 0:
            return 0.0
        if self.is_spring:
            return float(self.sufficient_friction or 0)
        return max(0.0, best_waits(self.loop).gain * float(self.setting.resolution) / 2)

    @property
    def friction_covers(self) -> bool:
        """True when Coulomb friction certainly covers the encoder."""
        need = self.sufficient_friction
        return need is not None and self.setting.coulomb_friction >= need

    @property
    def is_provable(self) -> bool:
        """True when the conditions hold and no hidden mode grows, so that a certificate exists."""
        if self.covers_contact or self.is_clamped:
            return self.covers_contact
        proved = isinstance(self.viscous, LinearProof) and self.loop.hidden_modes_decay
        return proved and self.friction_covers


def decide(device: Device, environment: Environment) -> Decision:
    """The decision for one certain device and environment."""
    loop = linear_loop(device, environment)
    setting = Setting(
        loop,
        device.exact("coulomb_friction"),
        device.exact("resolution"),
        environment.unilateral,
        device.motion,
    )
    wall = damped_wall(environment, loop.period) or relaxing_law(environment, loop)
    return Decision(setting, wall, environment.clamped, multiplier_law(environment, loop))
