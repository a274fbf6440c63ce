"""The transformed blocks over frequency: what the device has gained, what the environment has lost.

    A(z) = (T/2α)(1 + z⁻¹ + … + z⁻ᵈ)        added to the position of the device, taken from the environment's
    Ĝ = z^{−d−1} G + (1 − z^{−d−1})/(2α)     force u → velocity y, G from the held force to the mean velocity
    1/Ĉ = 1/C − (1 − z^{−d−1})/(2α)          velocity y → force, C = T z H/(z − 1)

With α = b, the damping of the device, Re{1/Ĝ} ≥ b, and the linear criterion is Re Ĉ ≥ −b.  For a coupling V
before an environment E, 1/H = 1/V + 1/E: the block is a negative compliance in series, 1/V̂ = 1/V − A, Ê = E.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth.model.device import Device
from zwidth.model.environment import as_environment
from zwidth.passivity.coupling.loop_transformation.slopes import whole_delay
from zwidth.passivity.formulas.hypotheses import NO_CLOCK, positive
from zwidth.passivity.linear.criterion import sampled_frequencies
from zwidth.quantity.exact import RealLike

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import ArrayLike, NDArray


def delay_sum(
    frequencies: ArrayLike, damping: RealLike, sample_period: RealLike, delay: RealLike = 0
) -> NDArray[np.complex128]:
    """A(z) = (T/2α)(1 + z⁻¹ + … + z⁻ᵈ) at z = e^{2πj f T} [m/N; rad/(N·m)]: at rest (d + 1) T/2α.

    Parameters
    ----------
    frequencies
        f [Hz].
    damping
        α > 0 [N·s/m; N·m·s/rad].
    sample_period
        T > 0 [s].
    delay
        dT ≥ 0, a whole number of samples [s].
    """
    t = positive("sample_period", sample_period, NO_CLOCK)
    alpha = positive("damping", damping, "nothing pays for the hold without it")
    late = np.exp(-2j * np.pi * np.asarray(frequencies, dtype=np.float64) * float(t))
    ones = np.ones(whole_delay(delay, t) + 1)
    return np.asarray(float(t / (2 * alpha)) * np.polynomial.polynomial.polyval(late, ones))


def transformed_blocks(device: Device, environment: Any, frequencies: ArrayLike | None = None) -> xr.Dataset:
    """Ĝ and Ĉ of a device and a linear environment, α being the damping of the device.

    Parameters
    ----------
    device
        Certain b > 0 and T, a delay of whole samples; an unknown mass counts as 0.
    environment
        With an H(z), a coupling before another included.
    frequencies
        From above 0 to half the rate [Hz]; default 2000 of them, evenly.

    Returns
    -------
    xr.Dataset
        Over `frequency` [Hz]: `device` Ĝ [m/(N·s)], `environment` Ĉ [N·s/m], `excess` = Re{1/Ĝ} ≥ b and
        `shortage` = −Re Ĉ [N·s/m]. Where the shortage exceeds b, `check` finds the loop active.

    Raises
    ------
    InputError
        If a number is outside its bound or an interval, or the environment has no H(z).
    """
    b = float(positive("damping", device.exact("damping"), "nothing pays for the hold without it"))
    period = device.exact("sample_period")
    late = 1 + whole_delay(device.exact("delay"), period)
    hertz = sampled_frequencies(frequencies, float(period))
    z = np.exp(2j * np.pi * hertz * float(period))
    h = as_environment(environment).pulse_transfer_function(period)
    force = np.polyval([float(c) for c in h.numerator], z) / np.polyval([float(c) for c in h.denominator], z)
    impedance = float(period) * z * force / (z - 1)
    given = (1 - z**-late) / (2 * b)
    held = z**-late * _mobility(device, b, float(period), z) + given
    return _dataset(hertz, held, impedance / (1 - given * impedance))


def _mobility(device: Device, b: float, period: float, z: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """From the force that is held to the mean velocity of the sample: m (v⁺ − v) = (F − b v̄) T."""
    mass = 0.0 if device.mass is None else float(device.exact("mass"))
    if not mass:
        return np.full_like(z, 1 / b)
    decay = np.exp(-b * period / mass)
    return np.asarray((1 - mass / (b * period) * (1 - decay) * (z - 1) / (z - decay)) / b)


def _dataset(
    hertz: NDArray[np.float64], device: NDArray[np.complex128], environment: NDArray[np.complex128]
) -> xr.Dataset:
    import xarray as xr

    return xr.Dataset(
        {
            "device": ("frequency", device, {"units": "m/(N·s)"}),
            "environment": ("frequency", environment, {"units": "N·s/m"}),
            "excess": ("frequency", (1 / device).real, {"units": "N·s/m"}),
            "shortage": ("frequency", -environment.real, {"units": "N·s/m"}),
        },
        coords={"frequency": ("frequency", hertz, {"units": "Hz"})},
    )
