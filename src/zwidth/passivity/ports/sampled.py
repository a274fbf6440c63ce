"""The damping that every axis of a device needs for H(z) of several axes, sampled and held.

    b ≥ −ν of T z⁻ᵈ H(z)/(z − 1)

b + T z⁻ᵈ H/(z − 1) positive real is the criterion of one axis with matrices in its place.
"""

from __future__ import annotations

from fractions import Fraction
from math import inf, nextafter

from flint import fmpq_poly

from zwidth.device import Device
from zwidth.errors import InputError
from zwidth.passivity.linear.supremum import frequency
from zwidth.passivity.ports.largest import Largest, largest_level
from zwidth.passivity.ports.port import Port, in_lowest_terms
from zwidth.passivity.ports.reading import from_polynomials
from zwidth.quantity.balls import as_fmpq

_SAME_PERIOD = Fraction(1, 10**9)


def sampled_damping(port: Port, device: Device) -> tuple[float | None, float]:
    """(b that is proved [N·s/m; N·m·s/rad], None if none is enough; where it is tightest [Hz]).

    Raises
    ------
    InputError
        If the device samples at another rate than H(z) was made for, or late by part of a sample.
    """
    period = _period(port, device)
    delay = device.exact("delay") / period
    if delay.denominator != 1:
        raise InputError(
            f"the delay is {float(delay):g} samples; with several axes the damping is decided for whole "
            "samples: round the delay up and down"
        )
    found = largest_level(_integrated(port, period, int(delay)))
    if not isinstance(found, Largest):
        return None, 0.0
    cosine = Fraction(-1) if found.cosine is None else found.cosine  # of equals the highest, as for one axis
    return _not_below(max(-found.low, Fraction(0))), frequency(cosine, period)


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
