"""A virtual coupling before every passive environment: how much damping the device needs.

    b ≥ ¼ F(θ) [s (1 − cos θ) + (κ²/s)(1 + cos θ)],  0 ≤ θ ≤ π
    κ = K_c T,   s = K_c T + 2 B_c > 0,   delay = (d + α) T
    F = (1 − α) F_{d+1} + α F_{d+2},   F_n = n + 2 Σ_{j<n} (n − j) cos jθ

is necessary and sufficient for a loop that is passive whatever environment lies
behind Z_c = K_c + B_c (z − 1)/(T z), as long as that environment is passive with
each force on the move that led to it, Σ f_k (y_k − y_{k−1}) ≥ −S: linear or not,
touched and left, as implicit integrators make it.  Without delay, for B_c ≥ 0, it is

    b ≥ K_c T/2 + B_c

as before a rigid wall (Colgate, Stanley & Brown 1995 say so of the coupling; the
rest is derived for this project, the proof is in the documentation).  For B_c < 0
and with a delay a rigid wall is not the worst: a mass behind the coupling is.

The right side is a polynomial in cos θ, and so the need of one finite law
Ĥ(z), whose verdict decides the condition exactly and certifies it.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import sqrt
from typing import Any

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.device.instead import instead_of_device
from zwidth.model.environment import PulseTransferFunction, Wall
from zwidth.model.environment.environment import Environment
from zwidth.model.rendering import VirtualCoupling
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.check import check_by_closed_forms
from zwidth.passivity.formulas.colgate_stanley_brown import ideal_device, law_of, needed_damping
from zwidth.passivity.formulas.hypotheses import NEGATIVE_SPRING, nonnegative, number
from zwidth.passivity.linear.criterion import LinearRefutation
from zwidth.passivity.linear_verdict import LinearVerdict
from zwidth.passivity.outcome_evidence import Moves
from zwidth.passivity.result import Answer, share_left
from zwidth.passivity.scope import Outcome, Scope, unit_key
from zwidth.quantity.answered import known
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.text import told_quantity


@dataclass(frozen=True, repr=False)
class CouplingCondition(Answer):
    """Whether a coupling on a device is passive before every passive environment."""

    _FORMAT = "zwidth coupling condition 1"
    _YES = "holds"

    device: Device = known("its encoder and Coulomb friction play no part")
    stiffness: Exact = known("K_c", quantity="stiffness")
    damping: Exact = known("B_c", quantity="damping")
    verdict: LinearVerdict | None = known(
        "of the law Ĥ(z) that needs as much as the worst environment, with its certificate; None where no "
        "damping would do, K_c T + 2 B_c ≤ 0"
    )

    @property
    def holds(self) -> bool:
        """True when it is proved: the certificate is that of `verdict`."""
        return self.verdict is not None and self.verdict.outcome == "passive"

    @property
    def outcome(self) -> Outcome:
        """ "passive" where it holds; else what is known before the worst environment that was found."""
        worst = self.counterexample
        return "passive" if worst is None else worst.outcome

    @property
    def claim(self) -> str:
        """The outcome in a sentence."""
        negated = "" if self.holds else "not "
        return f"On this device the coupling is {negated}passive before every passive environment."

    @property
    def scope(self) -> Scope:
        """Environments touched and left, on an exact position; where it fails that of the counterexample."""
        if self.counterexample is not None:
            return self.counterexample.scope
        return Scope(
            contact="made and broken",
            encoder="not counted" if self.device.exact("resolution") else "ideal",
            damping=float(self.device.exact("damping")),
            motion=self.device.motion,
        )

    def _left(self) -> float | None:
        """Of the device's damping."""
        return share_left(self.required_damping, float(self.device.exact("damping")))

    @property
    def certificate(self) -> Certificate | None:
        """The proof of the law that needs as much as the worst environment."""
        return None if self.verdict is None else self.verdict.certificate

    @property
    def witness(self) -> Moves | None:
        """A motion that takes energy out before the counterexample."""
        return None if self.counterexample is None else self.counterexample.witness

    @property
    def required_damping(self) -> float | None:
        """Smallest device damping b that is enough [N·s/m; N·m·s/rad]; None if none would do."""
        return None if self.verdict is None else self.verdict.required_damping

    @property
    def critical_frequency(self) -> float | None:
        """Frequency at which the worst environment is tuned [Hz]; half the rate: it is rigid."""
        return None if self.verdict is None else self.verdict.critical_frequency

    @cached_property
    def counterexample(self) -> LinearVerdict | None:
        """The verdict "active" of the coupling before a passive environment; None where the condition holds.

        The wall of K_c and B_c where a rigid environment is enough; otherwise a Tustin mass or spring, with
        a damper where that is worse, tuned against the coupling.
        """
        if self.holds:
            return None
        ideal = ideal_device(self.device).replace(delay=self.device.delay)
        rigid = check_by_closed_forms(ideal, Wall(self.stiffness, self.damping))
        return rigid if rigid.outcome == "active" else check_by_closed_forms(ideal, self._worst())

    def before(self, environment: Environment | Any) -> VirtualCoupling:
        """This coupling with an environment behind it."""
        return VirtualCoupling(self.stiffness, self.damping, environment)

    def numbers(self) -> dict[str, Any]:
        """The coupling, and what it needs, as plain data."""
        motion = self.device.motion
        return {
            unit_key("stiffness", motion): float(self.stiffness),
            unit_key("damping", motion): float(self.damping),
            f"required_{unit_key('damping', motion)}": self.required_damping,
        }

    def rows(self) -> list[tuple[str, str]]:
        """The main numbers as (name, text) for a report."""
        need, motion = self.required_damping, self.device.motion
        return [
            ("coupling stiffness K_c", told_quantity(self.stiffness, "stiffness", motion)),
            ("coupling damping B_c", told_quantity(self.damping, "damping", motion)),
            (
                "required device damping",
                "none is enough" if need is None else told_quantity(need, "damping", motion),
            ),
            ("device damping", told_quantity(float(self.device.exact("damping")), "damping", motion)),
        ]

    def __repr__(self) -> str:
        says = "passive before every passive environment" if self.holds else "not before every one"
        return f"<CouplingCondition {says}: {'; '.join(f'{k} {v}' for k, v in self.rows())}>"

    def _worst(self) -> VirtualCoupling:
        """The coupling before an environment against which the device damping is too little."""
        viscous = None if self.verdict is None else self.verdict.decision.viscous
        cosine = viscous.cosine if isinstance(viscous, LinearRefutation) else None
        period = self.device.exact("sample_period")
        return self.before(
            _tuned(self.device, float(self.stiffness), float(self.damping), float(cosine or 0.0), period)
        )


def coupling_condition(device: Device, stiffness: RealLike, damping: RealLike = 0) -> CouplingCondition:
    """Is this virtual coupling passive before every passive environment?

    Without delay and for B_c ≥ 0 exactly if b ≥ K_c T/2 + B_c; with a delay or B_c < 0 as the module says.
    "Passive environment": Σ f_k (y_k − y_{k−1}) ≥ −S for every motion y of its end of the coupling.

    Parameters
    ----------
    device
        Certain b, T and delay.  With an encoder no Coulomb friction is enough for every environment
        (see the documentation); the answer is for an ideal one.
    stiffness
        K_c ≥ 0 of the coupling [N/m; N·m/rad].
    damping
        B_c of the coupling, of either sign [N·s/m; N·m·s/rad].

    Raises
    ------
    InputError
        If K_c < 0, a number of the device is an interval, or the delay is too long to be certified.

    References
    ----------
    Colgate, Stanley & Brown, IROS 1995; derived for this project beyond a rigid wall without delay.
    """
    if not isinstance(device, Device):
        raise InputError(f"the first argument is a Device, {instead_of_device(device)}")
    k = nonnegative("stiffness", stiffness, NEGATIVE_SPRING)
    b = number("damping", damping)
    device.exact("damping")  # an interval of it has no single answer to rows() and the counterexample
    need = needed_damping(k, b, device.exact("sample_period"), device.exact("delay"))
    verdict = None
    if need is not None:
        law = PulseTransferFunction(*law_of(need, device.exact("sample_period")))
        verdict = check_by_closed_forms(ideal_device(device), law)
    return CouplingCondition(device, Exact(k), Exact(b), verdict)


def _tuned(
    device: Device, stiffness: float, damping: float, cosine: float, period: Fraction
) -> PulseTransferFunction:
    """The passive environment that is worst at one frequency: a reactance, with a damper where that is worse.

    The mobility Y = Y_c + Y_e of coupling and environment, Re Y_e ≥ 0, is brought as near to
    −c/(2b) as it can be, c = z^{−d−1}(1 − α + α z⁻¹).
    """
    t = float(period)
    z = complex(cosine, sqrt(1 - cosine * cosine))
    whole, alpha = divmod(float(device.exact("delay")) / t, 1)
    c = z ** -(int(whole) + 1) * (1 - alpha + alpha / z)
    b = float(device.exact("damping")) or (stiffness * t + abs(damping)) * 1e-3
    own = (1 - 1 / z) / (stiffness * t + damping * (1 - 1 / z))
    loss = max(0.0, -c.real / (2 * b) - own.real)
    reactance = -c.imag / (2 * b) - own.imag
    tangent = sqrt((1 - cosine) / (1 + cosine))
    loss_exact, part = Exact(loss).fraction, Exact(abs(reactance) / tangent ** (1 if reactance > 0 else -1))
    return _element(loss_exact, part.fraction, reactance > 0, period)


def _element(loss: Fraction, part: Fraction, spring: bool, period: Fraction) -> PulseTransferFunction:
    """E(z) of the mobility loss + part (z − 1)/(z + 1), a spring, or loss + part (z + 1)/(z − 1), a mass."""
    if spring and not loss:
        return PulseTransferFunction([1, 1], [period * part, 0])
    if spring:  # E = (z − 1)(z + 1)/(T z [loss (z + 1) + part (z − 1)])
        return PulseTransferFunction([1, 0, -1], [period * (loss + part), period * (loss - part), 0])
    return PulseTransferFunction([1, -2, 1], [period * (loss + part), period * (part - loss), 0])
