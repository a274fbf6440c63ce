"""The published recursive estimate of a solid, on five parameters for three.

    F_t = −a1 F_{t−1} − a2 F_{t−2} + b1 u_t + b2 u_{t−1} + b3 u_{t−2}

is the bilinear recursion of a standard linear solid times (1 + z⁻¹), estimated by least squares with
forgetting.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from zwidth.data.tissue import recursion
from zwidth.data.tissue.recursive import positive
from zwidth.errors import InputError
from zwidth.native.compiled import Array
from zwidth.quantity.exact import RealLike

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


def track_five_parameters(
    position: ArrayLike,
    force: ArrayLike,
    sample_period: RealLike,
    *,
    forgetting: RealLike = "0.999",
    initial_covariance: float = 1e6,
) -> Mapping[str, Array]:
    """The published regression on five parameters, beside which there is a line of others as good.

    F_t = −a1 F_{t−1} − a2 F_{t−2} + b1 u_t + b2 u_{t−1} + b3 u_{t−2} is three parameters times (1 + z⁻¹).
    With (1 + c z⁻¹) for any c the same motion fits as well, so that P grows along that line as λ⁻ᵏ and the
    estimates drift.  Use `RecursiveSolid`; this is here to show it.

    Parameters
    ----------
    position, force
        As for `RecursiveSolid.track`; samples in contact only.
    sample_period
        T > 0 [s].
    forgetting
        λ. Default 0.999.
    initial_covariance
        P at the start, times the identity.

    Returns
    -------
    Mapping
        "a1", "a2", "b1", "b2", "b3", "stiffness", "branch_stiffness", "branch_damping" by equation (32) of
        the paper, and "trace" of P, each an array.

    Raises
    ------
    InputError
        If the samples are not two arrays of one length.

    References
    ----------
    "A passivity criterion for real-time haptic simulation of viscoelastic soft tissues", appendix 2.
    """
    period = float(positive("sample_period", sample_period))
    keep = float(positive("forgetting", forgetting))
    x, f = (np.ascontiguousarray(part, dtype=float) for part in (position, force))
    if x.ndim != 1 or x.shape != f.shape:
        raise InputError("position and force are two arrays of one length")
    out = np.full((6, x.size), np.nan)
    p = (initial_covariance * np.eye(5)).ravel()
    recursion.run_five(np.zeros(5), p, np.zeros(10), x, f, keep, out)
    a1, b1, b3 = out[0], out[2], out[4]
    viscous = a1 * b1 - b1 - b3
    with np.errstate(divide="ignore", invalid="ignore"):
        solid = (b1 + b3) / a1, 2 * viscous / (a1 * (2 - a1)), viscous * period / a1**2
    names = ("a1", "a2", "b1", "b2", "b3", "trace", "stiffness", "branch_stiffness", "branch_damping")
    return dict(zip(names, (*out, *solid), strict=True))
