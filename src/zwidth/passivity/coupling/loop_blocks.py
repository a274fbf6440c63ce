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

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment import as_environment
from zwidth.passivity.coupling.loop_condition import whole_delay
from zwidth.passivity.formulas.hypotheses import NO_CLOCK, positive
from zwidth.passivity.linear.criterion import sampled_frequencies
from zwidth.quantity.exact import RealLike

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]


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


# The storage of Lemma 2 along a motion: what device, hold and delay together hold, at every sample.
#
#     W(k) = ¼ Σ_{i=1}^{d+1} u(k−i)ᵀ Λ⁻¹ u(k−i) + V(k)/T
#     y(k) = v̄(k) + ½ Λ⁻¹ [u(k) − u(k−d−1)],     v̄(k) = [x(k+1) − x(k)]/T
#     W(k+1) − W(k) = yᵀu − yᵀΛy + h(k) − slack(k)
#     slack(k) = (1/T)∫ vᵀδv dt − v̄ᵀΛv̄
#
# u(k) is the force commanded at the end of sample k, for that is when y(k) is known; it is held over sample k
# + d + 1.  V is the energy of the device, h the mean power of the hand.  If the device dissipates at least
# vᵀΛv, the slack is ≥ 0, whatever u does: that is Lemma 2 (Miller, Colgate & Freeman).  W is a storage if V
# is bounded below; else it bounds what comes out on closed paths and nothing else.  For a constant δ = Λ the
# slack is (1/T)∫ (v − v̄)ᵀδ(v − v̄) dt: the lemma loses only the change of velocity within a sample.


def loop_storage(
    inputs: ArrayLike,
    positions: ArrayLike,
    energies: ArrayLike,
    damping: ArrayLike,
    sample_period: RealLike,
    delay: RealLike = 0,
    hand_work: ArrayLike | None = None,
) -> xr.Dataset:
    """W of Lemma 2 along a motion of any device, and what enters and leaves in each sample.

    Parameters
    ----------
    inputs
        u(k), one row of joints or axes a sample, n of them [N; N·m]; before the first, u = 0.
    positions
        x(0) … x(n), one row more [m; rad].
    energies
        V(0) … V(n): kinetic and potential energy of the device, and of the hand if it is in the loop [J].
        W is a storage only if V is bounded below over all states, which one motion cannot show.
    damping
        Λ: a number or a symmetric positive definite matrix [N·s/m; N·m·s/rad].
    sample_period
        T > 0 [s].
    delay
        dT ≥ 0, a whole number of samples, fewer than there are [s]: u(k) is held over the sample k + d + 1.
    hand_work
        What a hand outside puts in during each sample, ∫ f_hᵀ v dt [J]. Default 0.

    Returns
    -------
    xr.Dataset
        Over `edge` 0 … n: `storage` W [W]; over `sample` 0 … n−1: `supply` yᵀu, `dissipation` yᵀΛy, `hand`,
        `slack` = supply − dissipation + hand − [W(k+1) − W(k)], all [W].

    Raises
    ------
    InputError
        If the shapes do not match, T ≤ 0, the delay has a part of a sample or is longer than the motion,
        or Λ is not positive definite.
    """
    u, x, v = _arrays(inputs, positions, energies)
    inverse = np.linalg.inv(matrix := _matrix(damping, u.shape[1]))
    exact = positive("sample_period", sample_period, NO_CLOCK)
    period, d = float(exact), _shorter(whole_delay(delay, exact), len(u))
    hand = np.zeros(len(u)) if hand_work is None else np.asarray(hand_work, dtype=np.float64) / period
    if hand.shape != (len(u),):
        raise InputError(f"hand_work has one number for each of {len(u)} samples, got shape {hand.shape}")
    past = np.vstack([np.zeros((d + 1, u.shape[1])), u])
    waiting = np.einsum("ki,ij,kj->k", past, inverse, past) / 4
    storage = np.convolve(waiting, np.ones(d + 1), "valid") + v / period
    y = np.diff(x, axis=0) / period + (u - past[: len(u)]) @ inverse / 2
    supply, loss = np.einsum("ki,ki->k", y, u), np.einsum("ki,ij,kj->k", y, matrix, y)
    return _stored(storage, supply, loss, hand)


def _shorter(d: int, samples: int) -> int:
    """A delay of fewer samples than the motion has."""
    if d >= samples:
        raise InputError(
            f"the delay is {d} samples and the motion has {samples}: none of its forces would act; "
            "delay is in seconds"
        )
    return d


def _arrays(inputs: ArrayLike, positions: ArrayLike, energies: ArrayLike) -> tuple[Floats, Floats, Floats]:
    u, x = (np.asarray(a, dtype=np.float64) for a in (inputs, positions))
    v = np.asarray(energies, dtype=np.float64)
    u, x = (a[:, None] if a.ndim == 1 else a for a in (u, x))
    if u.ndim != 2 or x.shape != (len(u) + 1, u.shape[1]) or v.shape != (len(u) + 1,):
        raise InputError(
            "n inputs go with n + 1 positions of as many joints and n + 1 energies; got shapes "
            f"{u.shape}, {x.shape} and {v.shape}"
        )
    return u, x, v


def _matrix(damping: ArrayLike, joints: int) -> Floats:
    given = np.asarray(damping, dtype=np.float64)
    matrix = given * np.eye(joints) if given.ndim == 0 else given
    if matrix.shape != (joints, joints) or not np.array_equal(matrix, matrix.T):
        raise InputError(f"damping is a number or a symmetric matrix of {joints} × {joints}, got {damping!r}")
    if not np.linalg.eigvalsh(matrix)[0] > 0:
        raise InputError(
            f"damping must be positive definite, got {damping!r}: nothing pays for the hold without it"
        )
    return matrix


def _stored(storage: Floats, supply: Floats, loss: Floats, hand: Floats) -> xr.Dataset:
    import xarray as xr

    unit = {"units": "W"}
    return xr.Dataset(
        {
            "storage": ("edge", storage, unit),
            "supply": ("sample", supply, unit),
            "dissipation": ("sample", loss, unit),
            "hand": ("sample", hand, unit),
            "slack": ("sample", supply - loss + hand - np.diff(storage), unit),
        }
    )
