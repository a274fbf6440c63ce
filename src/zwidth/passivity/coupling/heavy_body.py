"""How much damping a coupling needs before heavy bodies.

    B_c ≥ φ κ + min(g² κ²/(4b), g κ/2),    κ = K_c T,    g = ½ + δ − φ,    φ = φ₀ + 2d

without the minimum, g² κ²/(4b), for g ≤ 0; δ is the device's delay and d that of an exchange each way, in
samples.  φ₀ says how late the position is: 1 by forward, −1 by backward Euler, ½ where a held force is
integrated, −½ by the implicit midpoint, 0 by semi-implicit Euler, Verlet's and the trapezoidal rule.
Derived for this project.
"""

from __future__ import annotations

from fractions import Fraction
from typing import get_args

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment.bodies import Body, Integrator, stepped
from zwidth.passivity.formulas.hypotheses import NEGATIVE_SPRING, nonnegative
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.parameter import one_of


def heavy_body_damping(
    device: Device,
    stiffness: RealLike,
    integrator: Integrator = "semi-implicit-euler",
    exchange_delay: RealLike = 0,
) -> Exact:
    """The coupling damping B_c that every heavy free body asks for behind a spring K_c [N·s/m; N·m·s/rad].

    With more of it, and more b than the wall of K_c and B_c needs, all bodies from some mass on are passive;
    with less no heavy one is.  Without delay, by semi-implicit Euler, it is (K_c T)²/(16 b).

    Parameters
    ----------
    device
        Certain b > 0 and T, a delay of whole samples; the answer is for an ideal encoder.
    stiffness
        K_c ≥ 0 [N/m; N·m/rad].
    integrator
        As of `CoupledBody`.
    exchange_delay
        Samples each way to the process of the body, ≥ 0.

    Raises
    ------
    InputError
        If a number is outside its bound or an interval, or the delay is no whole number of samples.
    """
    one_of("integrator", integrator, *get_args(Integrator))
    b, t = device.exact("damping"), device.exact("sample_period")
    delta = device.exact("delay") / t
    if b == 0 or delta.denominator != 1:
        raise InputError(
            "heavy_body_damping is for a device with damping and a delay of whole samples, got "
            f"{float(b):g} and {float(delta):g} samples; ask passive_masses"
        )
    kappa = nonnegative("stiffness", stiffness, NEGATIVE_SPRING) * t
    lag = _lag(integrator) + 2 * nonnegative("exchange_delay", exchange_delay, "a message cannot come early")
    lead = Fraction(1, 2) + delta - lag
    tuned = lead**2 * kappa**2 / (4 * b)
    return Exact(max(lag * kappa + (min(tuned, lead * kappa / 2) if lead > 0 else tuned), Fraction(0)))


def _lag(integrator: Integrator) -> Fraction:
    """φ₀ = 1 − the mean power of z in M (z − 1)² Y/T² of a free body."""
    position = stepped(integrator, Body(Fraction(1), Fraction(0), Fraction(0), Fraction(1))).position
    mean = sum((i * c for i, c in enumerate(reversed(position))), Fraction(0)) / sum(position)
    return 1 - mean
