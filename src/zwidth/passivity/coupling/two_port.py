"""The two-port view of a display with a virtual coupling: Llewellyn's conditions over frequency.

A two-port [p11 p12; p21 p22] between hand and environment is stable with every
passive hand and every passive environment exactly if its poles are stable and

    Re p11 ≥ 0,   Re p22 ≥ 0,   2 Re p11 Re p22 ≥ |p12 p21| + Re(p12 p21)

at all ω (Llewellyn 1952; Adams & Hannaford 1999); here the poles always are.  For a device that displays
impedance, in their discrete model,

    [F_h; −v_e] = [[Z_d, ZOH], [−1, 1/Z_c]] [v_h; F_e]
    Z_d = m s + b,  s = (2/T)(z − 1)/(z + 1),   ZOH = ½ (1 + z⁻¹)
    Re{1/Z_c} ≥ (1 − cos∠ZOH) |ZOH|/(2 Re Z_d),   Z_c = B_c + K_c T z/(z − 1)

The hold is an average of samples there, and what happens between them is left out.  Held exactly, with
positions sampled and velocities their backward difference, ZOH becomes z⁻¹ and the same conditions become

    b ≥ (1 − cos θ)/(2 Re{1/Z_c})

that of `coupling`, necessary and sufficient (derived for this project, as is the
comparison: for B_c ≥ 0, without delay, Llewellyn's model asks for ¼ to ⅛ of it).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from scipy.optimize import minimize_scalar

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.passivity.formulas.hypotheses import NEGATIVE_SPRING, NO_CLOCK, nonnegative, positive
from zwidth.passivity.linear.criterion import sampled_frequencies
from zwidth.quantity.exact import RealLike

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import ArrayLike, NDArray

    Complex = NDArray[np.complex128]

Hold = Literal["average", "exact"]

_ROUNDING = 1e-9
"""Relative difference that counts as equality."""


def __dir__() -> list[str]:  # as a part of its package it may be loaded before it is asked for
    return ["admittance_display", "impedance_display", "llewellyn_damping"]


def impedance_display(
    device: Device,
    stiffness: RealLike,
    damping: RealLike = 0,
    frequencies: ArrayLike | None = None,
    hold: Hold = "average",
) -> xr.Dataset:
    """Llewellyn's conditions of an impedance display with a virtual coupling in series.

    [F_h; −v_e] = [[Z_d, h], [−1, 1/Z_c]] [v_h; F_e], h the hold.

    Parameters
    ----------
    device
        Certain b, T and delay; an unknown mass counts as 0, the conditions do not depend on it.
    stiffness, damping
        K_c ≥ 0 [N/m; N·m/rad] and B_c ≥ 0 [N·s/m; N·m·s/rad], not both 0.
    frequencies
        From above 0 to half the rate [Hz]; default 2000 of them, evenly.
    hold
        "average": ½ (1 + z⁻¹) and the delay e^{−jω delay} (Adams & Hannaford 1999).
        "exact": z^{−d−1} (1 − α + α z⁻¹), delay = (d + α) T, and 1 for |p12 p21|; then the answer is that of
        `coupling_condition`.

    Returns
    -------
    xr.Dataset
        Over `frequency` [Hz]: `re_p11` [N·s/m], `re_p22` [m/(N·s)], `surplus` = 2 Re p11 Re p22 − |p12 p21|
        − Re(p12 p21), and `needed_damping` [N·s/m].  Attributes: `unconditionally_stable`,
        `tightest_frequency` [Hz].

    References
    ----------
    Adams & Hannaford, IEEE Transactions on Robotics and Automation 15(3), 1999.
    """
    t, b = float(device.exact("sample_period")), float(device.exact("damping"))
    k, d = _coupling(stiffness, damping)
    hertz = sampled_frequencies(frequencies, t)
    z = np.exp(2j * np.pi * hertz * t)
    mobility = (1 - 1 / z) / (k * t + d * (1 - 1 / z))
    between, size = _hold(device, hold, z, hertz)
    mass = 0.0 if device.mass is None else float(device.exact("mass"))
    p11 = b + mass * 2 / t * 1j * np.tan(np.pi * hertz * t)
    need = (size - between.real) / (2 * mobility.real)
    return _dataset(hertz, p11, mobility, -between, size, need)


def admittance_display(
    device: Device,
    stiffness: RealLike,
    damping: RealLike,
    velocity_gain: RealLike,
    position_gain: RealLike = 0,
    frequencies: ArrayLike | None = None,
) -> xr.Dataset:
    """Llewellyn's conditions of an admittance display with a virtual coupling in parallel.

    The hand's force is measured, the environment answers with a velocity v_d, and a controller
    C = C_p + C_i T z/(z − 1) makes the device follow it:

        v_h = (F_h + ZOH C v_d)/(Z_d + ZOH C)
        [v_h; −F_e] = [[Y, H], [−1, Z_c]] [F_h; v_d],   Y = 1/(Z_d + ZOH C),   H = ZOH C Y

    The coupling holds the virtual tool to the ground: the environment is given F_h − Z_c v_d.

    Parameters
    ----------
    device
        Certain m, b and T, without delay.
    stiffness, damping
        K_c ≥ 0 [N/m; N·m/rad] and B_c ≥ 0 [N·s/m; N·m·s/rad] of the coupling, not both 0.
    velocity_gain, position_gain
        C_p ≥ 0 [N·s/m; N·m·s/rad] and C_i ≥ 0 [N/m; N·m/rad].
    frequencies
        From above 0 to half the rate [Hz]; default 2000 of them, evenly.

    Returns
    -------
    xr.Dataset
        As for `impedance_display`, with `re_p11` a mobility, `re_p22` an impedance and, in the place of
        the damping, `needed_impedance` = the Re Z_c that is needed [N·s/m].

    Notes
    -----
    The conditions are those of Adams & Hannaford (1999); the model of the inner loop is derived for this
    project.  Its poles are stable: Z_d and ZOH C are positive real, Re ZOH = cos²(θ/2) and ZOH T z/(z − 1) =
    (T/2) (z + 1)/(z − 1).  A hold that averages is as little exact here as for impedance.
    """
    if device.mass is None:
        raise InputError("mass is not known: the inner loop of an admittance display depends on it")
    if device.exact("delay") != 0:
        raise InputError(
            "the poles of the inner loop are found without delay only; give a device with delay=0"
        )
    t, b, mass = (float(device.exact(key)) for key in ("sample_period", "damping", "mass"))
    k, d = _coupling(stiffness, damping)
    why = "the inner loop would push away from the velocity it is given"
    p = float(nonnegative("velocity_gain", velocity_gain, why, "damping"))
    i = float(nonnegative("position_gain", position_gain, why, "stiffness"))
    hertz = sampled_frequencies(frequencies, t)
    z = np.exp(2j * np.pi * hertz * t)
    between, _ = _hold(device, "average", z, hertz)
    follow = between * (p + i * t * z / (z - 1))
    mobility = 1 / (b + mass * 2 / t * 1j * np.tan(np.pi * hertz * t) + follow)
    transfer = follow * mobility
    impedance = d + k * t * z / (z - 1)
    need = (np.abs(transfer) - transfer.real) / (2 * mobility.real)
    data = _dataset(hertz, mobility, impedance, -transfer, np.abs(transfer), need)
    return data.rename(needed_damping="needed_impedance")


def llewellyn_damping(stiffness: RealLike, damping: RealLike, sample_period: RealLike) -> float:
    """Device damping that Llewellyn's conditions ask for in the model with an averaging hold, without delay.

    b ≥ (s/4) max over 0 ≤ C ≤ 1 of (1 − ρ) C (1 − C) + ρ C/(1 + C),   C = cos(θ/2)
    s = K_c T + 2 B_c,   ρ = (K_c T/s)²

    From s/16 for a damper to s/8 for a spring, K_c T/8.  The exact need is s/2 (`coupling`).

    Parameters
    ----------
    stiffness, damping
        K_c ≥ 0 [N/m; N·m/rad] and B_c ≥ 0 [N·s/m; N·m·s/rad], not both 0.
    sample_period
        T > 0 [s].

    Notes
    -----
    Derived for this project from the conditions of Adams & Hannaford (1999).
    """
    k, d = _coupling(stiffness, damping)
    t = float(positive("sample_period", sample_period, NO_CLOCK))
    s = k * t + 2 * d
    share = (k * t / s) ** 2

    def need(c: float) -> float:
        return (1 - share) * c * (1 - c) + share * c / (1 + c)

    found = minimize_scalar(lambda c: -need(c), bounds=(0, 1), method="bounded", options={"xatol": 1e-10})
    return s / 4 * max(need(float(found.x)), need(1.0))


def _coupling(stiffness: RealLike, damping: RealLike) -> tuple[float, float]:
    k = nonnegative("stiffness", stiffness, NEGATIVE_SPRING)
    d = nonnegative("damping", damping, "the two-port formulas are for a coupling that dissipates")
    if k == d == 0:
        raise InputError("stiffness and damping are both 0: a coupling of nothing connects nothing")
    return float(k), float(d)


def _hold(device: Device, hold: str, z: Complex, hertz: NDArray[np.float64]) -> tuple[Complex, Any]:
    """The hold with the delay, and the |p12 p21| that goes with it."""
    t, delay = device.exact("sample_period"), device.exact("delay")
    if hold == "average":
        between = (1 + 1 / z) / 2 * np.exp(-2j * np.pi * hertz * float(delay))
        return between, np.abs(between)
    if hold != "exact":
        raise InputError(f'hold is "average" or "exact", got {hold!r}')
    whole = int(delay // t)
    alpha = float(delay / t - whole)
    return z ** -(whole + 1) * (1 - alpha + alpha / z), np.ones_like(hertz)


def _dataset(
    hertz: NDArray[np.float64], p11: Complex, p22: Complex, product: Complex, size: Any, need: Any
) -> xr.Dataset:
    import xarray as xr

    asked = size + product.real
    surplus = 2 * p11.real * p22.real - asked
    holds = (p11.real >= 0) & (p22.real >= 0) & (surplus >= -_ROUNDING * asked)
    data = xr.Dataset(
        {
            "re_p11": ("frequency", p11.real),
            "re_p22": ("frequency", p22.real),
            "surplus": ("frequency", surplus),
            "needed_damping": ("frequency", np.asarray(need, dtype=np.float64)),
            "holds": ("frequency", holds),
        },
        coords={"frequency": ("frequency", hertz, {"units": "Hz"})},
    )
    data.attrs = {
        "unconditionally_stable": bool(np.all(holds)),
        "tightest_frequency": float(hertz[int(np.argmax(need))]),
    }
    return data
