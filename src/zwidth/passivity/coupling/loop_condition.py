"""Does the damping of the device cover the hold, the delay, the coupling and what the environment lacks?

Loop transformation (Miller, Colgate & Freeman): with A(z) = (T/2b)(1 + z⁻¹ + … + z⁻ᵈ) added, the device is
b-output strictly passive, and everything on the other side, seen through −A, may lack as much:

    Σ f̂ ŷ ≥ −S − b Σ ŷ²,    ŷ = v̄ − (1/2b)(f − z^{−d−1} f)

Written out this is Σ [v̄ z^{−d−1}f + b v̄²] up to what the forces on their way can still give, f²/4b each:
nothing is lost.  What the environment is known to keep (`environment_class`) is taken off, and what is left
must be ≥ 0 for all moves D of the handle and all changes a of the coupling's length:

    (b/T) D² + (z^{−d−1}f) D − f (D − a) + ½ Δf e − g (Δf − μ e)(L e − Δf) ≥ 0    e = D − a
    (b/T) D² + (z^{−d−1}f) D − f (D − a) + ι e²/T + ο T f² ≥ 0

a form of two sequences, decided exactly; 2 g (L − μ) ≥ 1 is chosen for the best.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import inf, isfinite, sqrt
from typing import Literal

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.device.instead import instead_of_device
from zwidth.passivity.coupling.environment_class import PassivityExcess, SlopeBounds
from zwidth.passivity.coupling.loop_forms import (
    DIRECT,
    Connection,
    best_form,
    coupled,
    excess_form,
    largest_need,
)
from zwidth.passivity.formulas.hypotheses import NEGATIVE_SPRING, NO_CLOCK, nonnegative, number, positive
from zwidth.passivity.result import Answer, share_left
from zwidth.passivity.scope import Outcome, Scope
from zwidth.quantity.answered import answered, known
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.text import told_quantity

Binding = Literal["device damping", "coupling and environment"]


@dataclass(frozen=True, repr=False)
class TransformedCondition(Answer):
    """Whether the theorem promises passivity for a device, a coupling and a class of environments."""

    _FORMAT = "zwidth transformed condition 1"
    _YES = "holds"
    certificate = None  # the proof is on paper
    witness = None

    device: Device = known("its encoder and Coulomb friction play no part")
    environment: SlopeBounds | PassivityExcess = known("what is known of the environment")
    holds: bool = known(
        "True when it is proved, by exact arithmetic.  False says that this theorem does not promise it"
    )
    required_damping: float | None = answered(
        "b that is enough, itself proved; null if none is", quantity="damping"
    )
    binding: Binding = answered(
        "what would have to change: the damping of the device, against hold and delay; or coupling and "
        "environment, which together must be strictly passive whatever the device"
    )
    critical_frequency: float | None = known(
        "where it is tightest; None where a closed form decides", unit="Hz"
    )

    @property
    def outcome(self) -> Outcome:
        """ "theorem": a proof on paper, without a certificate; else "undecided"."""
        return "theorem" if self.holds else "undecided"

    def _left(self) -> float | None:
        """Of the device's damping."""
        return share_left(self.required_damping, float(self.device.exact("damping")))

    @property
    def scope(self) -> Scope:
        """What it is about.

        Springs may be one-sided, and what the environments keep holds wherever they are; the theorem knows
        exact positions; `law` says what the environments must keep besides slopes or excess.
        """
        slopes = isinstance(self.environment, SlopeBounds)
        return Scope(
            contact="made and broken",
            encoder="not counted" if self.device.exact("resolution") else "ideal",
            damping=float(self.device.exact("damping")),
            law=("potential bounded below" if slopes else "energy at first bounded",),
            motion=self.device.motion,
        )

    @property
    def claim(self) -> str:
        """What is proved, and for which environments."""
        of = self.environment.describe(self.device.motion)
        if not self.holds:
            return f"No promise for {of}."
        counts = "; the counts of the encoder are not in it" if self.scope.encoder == "not counted" else ""
        return f"Passive before {of}, contact made and broken{counts}."

    def rows(self) -> list[tuple[str, str]]:
        """The main numbers as (name, text) for a report."""
        motion = self.device.motion
        need = self.required_damping
        return [
            (
                "required device damping",
                "none is enough" if need is None else told_quantity(need, "damping", motion),
            ),
            ("device damping", told_quantity(float(self.device.exact("damping")), "damping", motion)),
            ("binding inequality", self.binding),
            ("contact", self.scope.contact),
            ("encoder", self.scope.encoder),
            ("environments", "; ".join(self.scope.law)),
        ]

    def __repr__(self) -> str:
        rows = "; ".join(f"{k} {v}" for k, v in self.rows())
        return f"<TransformedCondition {self.claim} By a proof on paper: {rows}>"


def transformed_condition(
    device: Device,
    environment: SlopeBounds | PassivityExcess,
    stiffness: RealLike | None = None,
    damping: RealLike = 0,
) -> TransformedCondition:
    """Is the loop passive for every environment of a class, felt as it is or behind a virtual coupling?

    Of springs: for those whose potential is bounded below, as `SlopeBounds` states.  A sufficient condition;
    where it is exact, the documentation says so.

    Parameters
    ----------
    device
        Certain b and T, and a delay of whole samples.
    environment
        `SlopeBounds` or `PassivityExcess`.
    stiffness
        K_c ≥ 0 of the coupling [N/m; N·m/rad]. None: there is none.
    damping
        B_c of the coupling, of either sign [N·s/m; N·m·s/rad].

    Raises
    ------
    InputError
        If an argument is of another kind, a number of the device is an interval, the delay has a part of a
        sample, or the coupling is nothing or K_c < 0.

    References
    ----------
    Miller, Colgate & Freeman, On the role of dissipation in haptic systems, IEEE. The classes, their forms
    and the closed forms are derived for this project.
    """
    _check_kinds(device, environment)
    period, b = device.exact("sample_period"), device.exact("damping")
    d = whole_delay(device.exact("delay"), period)
    if stiffness is None:
        if number("damping", damping):
            raise InputError(
                "damping is that of a coupling, and there is none: give its stiffness, 0 if need be"
            )
        if isinstance(environment, SlopeBounds):
            return _condition(device, environment, *_bare_spring(environment, d, b, period))
        return _condition(device, environment, *_bare_excess(environment, b))
    connection = _connection(stiffness, damping, period)
    if isinstance(environment, SlopeBounds):
        form = best_form(environment, connection, d)
    else:
        form = excess_form(environment, connection, d, period)
    return _condition(device, environment, form.is_nonnegative(b / period), *largest_need(form, period))


def _check_kinds(device: Device, environment: SlopeBounds | PassivityExcess) -> None:
    if not isinstance(device, Device):
        raise InputError(f"the first argument is a Device, {instead_of_device(device)}")
    if not isinstance(environment, (SlopeBounds, PassivityExcess)):
        raise InputError(
            f"the environment is SlopeBounds or PassivityExcess, got {type(environment).__name__}. "
            "Where the law is known, the transformation adds nothing: use check"
        )


def _connection(stiffness: RealLike, damping: RealLike, period: Fraction) -> Connection:
    k, b = nonnegative("stiffness", stiffness, NEGATIVE_SPRING), number("damping", damping)
    if not k and not b:
        raise InputError(
            "a coupling without stiffness and damping passes no force on; leave both out to have no coupling"
        )
    return coupled(k, b, period)


def _condition(
    device: Device, environment: SlopeBounds | PassivityExcess, holds: bool, need: float, hertz: float | None
) -> TransformedCondition:
    finite = isfinite(need)
    return TransformedCondition(
        device=device,
        environment=environment,
        holds=holds,
        required_damping=need if finite else None,
        binding="device damping" if finite else "coupling and environment",
        critical_frequency=hertz,
    )


def _bare_spring(
    slopes: SlopeBounds, d: int, b: Fraction, period: Fraction
) -> tuple[bool, float, float | None]:
    """Whether it is proved, the damping that is enough, and where."""
    exact = exact_need(slopes, d)
    if exact is not None:
        return b >= period * exact, float(period * exact), None
    form = best_form(slopes, DIRECT, d)
    return form.is_nonnegative(b / period), *largest_need(form, period)


def _bare_excess(excess: PassivityExcess, b: Fraction) -> tuple[bool, float, float | None]:
    """b ≥ [1 + √(1 − 4 ι ο)]/(2 ο), whatever the delay: the force may have come from any sample."""
    iota, omicron = excess.input.fraction, excess.output.fraction
    if omicron <= 0:
        return False, inf, None
    need = (1 + sqrt(1 - 4 * iota * omicron)) / (2 * float(omicron))
    return omicron * b * b - b + iota >= 0 and 2 * omicron * b >= 1, need, None


# A static spring known by its slopes alone, its force d samples late: the damping it needs.
#
# SlopeBounds between μ and L > 0, of which one may be negative, and a potential that is bounded below:
#
#     b ≥ (2d + 1) L T/2                 d |μ| ≤ (d + 1) L  or  μ ≥ 0
#
# exactly, for the spring of the greatest slope needs as much already: up to (1 + 1/d) L, a negative slope
# costs nothing, and without delay it never does.  Beyond, what is enough comes of a form of two sequences.
# Derived for this project.


def required_damping_by_slopes(
    least: RealLike, greatest: RealLike, sample_period: RealLike, delay: RealLike = 0
) -> Exact | float:
    """The device damping that is enough for every static spring with slopes between μ and L and Φ ≥ Φ_min.

    Only for those whose potential Φ is bounded below: a spring that leads away for ever, as a constant force
    or a negative spring does, gives out energy without end before every device.  (2d + 1) L T/2 as long as
    d |μ| ≤ (d + 1) L, and then exact.

    Parameters
    ----------
    least, greatest
        μ ≤ L [N/m; N·m/rad]; 0 and K for a wall of stiffness K, touched and left.
    sample_period
        T > 0 [s].
    delay
        dT ≥ 0, a whole number of samples [s].

    Returns
    -------
    Exact or float
        b [N·s/m; N·m·s/rad].

    Raises
    ------
    InputError
        If the slopes are in the wrong order, T ≤ 0, or the delay is not a whole number of samples.

    Notes
    -----
    Derived for this project.
    """
    slopes = SlopeBounds(least=least, greatest=greatest, bounded_below=True)  # as the docstring says
    t = positive("sample_period", sample_period, NO_CLOCK)
    d = whole_delay(delay, t)
    exact = exact_need(slopes, d)
    return largest_need(best_form(slopes, DIRECT, d), t)[0] if exact is None else Exact(t * exact)


def exact_need(slopes: SlopeBounds, d: int) -> Fraction | None:
    """b/T = (d + ½) L where that is the need [N/m; N·m/rad]; None for deeper negative slopes."""
    high = max(slopes.greatest.fraction, Fraction(0))
    return (d + Fraction(1, 2)) * high if -d * slopes.least.fraction <= (d + 1) * high else None


def whole_delay(delay: RealLike, period: Fraction) -> int:
    """d of delay = dT; a message for any other."""
    samples = nonnegative("delay", delay, "a force cannot come before its sample") / period
    if samples.denominator != 1:
        raise InputError(
            f"delay must be a whole number of samples, got {float(samples):.6g} of them: the transformation "
            "delays by samples. check and coupling_condition know what a part of a sample costs"
        )
    return int(samples)
