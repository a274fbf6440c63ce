"""The damping that a device needs, in every axis, for H(z), sampled and held.

    b ≥ −ν of T z⁻ᵈ H(z)/(z − 1)

Of one axis that is the criterion that `check` decides; with matrices in its place it asks for
b + T z⁻ᵈ H/(z − 1) to be positive real.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import inf, nextafter
from typing import Any

from flint import fmpq_poly

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment.discretization import Discretization
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.system import is_system, time_of
from zwidth.model.environment.transfer_function import as_environment
from zwidth.passivity import parameter_limits
from zwidth.passivity.criterion_choice import decide
from zwidth.passivity.linear.criterion import frequency, tightest
from zwidth.passivity.ports.largest import Largest, largest_level
from zwidth.passivity.ports.port import Port, in_lowest_terms
from zwidth.passivity.ports.reading import from_polynomials
from zwidth.passivity.scope import Scope
from zwidth.quantity.balls import as_fmpq
from zwidth.quantity.text import told_quantity

_SAME_PERIOD = Fraction(1, 10**9)


@dataclass(frozen=True)
class SampledDamping:
    """The damping that a device must have for H(z), sampled and held, to give out no energy.

    Attributes
    ----------
    required
        The least b that is proved [N·s/m; N·m·s/rad]; None if none is enough.
    frequency
        Where the criterion is tightest [Hz].
    device
        The device that was given; without one, one of no damping and no delay.
    """

    required: float | None
    frequency: float
    device: Device

    @property
    def scope(self) -> Scope:
        """The linear criterion: of a one-sided law it speaks of contact that is kept, and of no encoder."""
        return Scope(contact="kept", damping=float(self.device.exact("damping")), motion=self.device.motion)

    @property
    def margin(self) -> float | None:
        """b − required of the device [N·s/m; N·m·s/rad]; None if none is enough."""
        return None if self.required is None else float(self.device.exact("damping")) - self.required

    def describe(self) -> str:
        """The need in a line."""
        if self.required is None:
            return "no damping is enough"
        required = told_quantity(self.required, "damping", self.device.motion, 9)
        return f"b ≥ {required}, tightest at {self.frequency:.6g} Hz"

    def __repr__(self) -> str:
        return f"<SampledDamping {self.describe()}>"


def sampled_damping(
    system: Environment | Any, port: Port, device: Device | None, discretization: Discretization | None
) -> SampledDamping | None:
    """What the system, read as this port, needs of a device; None where no sample period is known."""
    of_several = port.axes > 1
    if of_several and (discretization is not None or (device is not None and port.time == "continuous")):
        raise InputError(
            "several inputs are sampled and held as H(z) only: discretize the system first, and leave "
            "discretization out"
        )
    if device is None and discretization is not None:
        raise InputError("a discretization needs the device whose rate it is for; give device = …")
    on = device or _bare(system)
    if on is None:
        return None
    if of_several:
        return _of_several_axes(port, on)
    decision = decide(on, as_environment(system, discretization))
    _, cosine = tightest(decision.loop)
    return SampledDamping(
        parameter_limits.required_damping(decision), frequency(cosine, decision.loop.period), on
    )


def _bare(system: Any) -> Device | None:
    """A device of no damping at the rate that a discrete system says."""
    period = time_of(system)[1] if is_system(system) else None
    return None if period is None else Device(damping=0, sample_period=period)


def _of_several_axes(port: Port, device: Device) -> SampledDamping:
    """Minus the input index, for whole samples of delay at the rate that H(z) was made for."""
    period = _period(port, device)
    delay = device.exact("delay") / period
    if delay.denominator != 1:
        raise InputError(
            f"the delay is {float(delay):g} samples; with several axes the damping is decided for whole "
            "samples: round the delay up and down"
        )
    found = largest_level(_integrated(port, period, int(delay)))
    if not isinstance(found, Largest):
        return SampledDamping(None, 0.0, device)
    cosine = Fraction(-1) if found.cosine is None else found.cosine  # of equals the highest, as for one axis
    required = _not_below(max(-found.low, Fraction(0)))
    return SampledDamping(required, frequency(cosine, period), device)


def _integrated(port: Port, period: Fraction, delay: int) -> Port:
    """T H(z)/(zᵈ (z − 1)), in lowest terms."""
    d = fmpq_poly(list(port.denominator)) * fmpq_poly([0] * delay + [-1, 1])
    gain = as_fmpq(period)
    n = [[fmpq_poly(list(p)) * gain for p in row] for row in port.outputs]
    found = in_lowest_terms(n, d)
    assert found is not None, "a denominator is not zero"
    return from_polynomials(found[1], found[0], "discrete", period)


def _period(port: Port, device: Device) -> Fraction:
    period = device.exact("sample_period")
    if abs(period - port.period) > _SAME_PERIOD * period:
        raise InputError(
            f"H(z) was made for the sample period {float(port.period):.12g} s and the device samples every "
            f"{float(period):.12g} s; discretize it again, or change the device's rate"
        )
    return period


def _not_below(value: Fraction) -> float:
    """The least double that is typed for a number of at least this value."""
    double = float(value)
    while Fraction(repr(double)) < value:
        double = nextafter(double, inf)
    return double
