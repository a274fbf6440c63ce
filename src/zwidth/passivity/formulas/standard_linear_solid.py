"""A standard linear solid: the damping that soft tissue which relaxes asks for.

Source: "A passivity criterion for real-time haptic simulation of viscoelastic soft tissues".
"""

from __future__ import annotations

from typing import Literal

from zwidth.errors import InputError
from zwidth.passivity.formulas.hypotheses import NEGATIVE_SPRING, NO_CLOCK, nonnegative, positive
from zwidth.quantity.exact import Exact, RealLike

_NO_BRANCH = (
    "with 0 the solid is a spring, for which kelvin_voigt_damping(stiffness, 0, sample_period) holds, "
    "and with a negative value H is unstable"
)


def standard_linear_solid_damping(
    stiffness: RealLike,
    branch_stiffness: RealLike,
    branch_damping: RealLike,
    sample_period: RealLike,
    discretization: Literal["backward", "tustin"] = "backward",
) -> Exact:
    """b ≥ μ0 T/2 + μ1 η1 T/(2 η1 + μ1 T) by backward Euler, (μ0 + μ1) T/2 by Tustin's rule.

    H(s) = μ0 + μ1 η1 s/(μ1 + η1 s), without delay.  For μ1, η1 > 0 the criterion is monotone in 1 − cos ωT
    and tightest at the Nyquist frequency.  By Tustin's rule the branch costs μ1 T/2 however small η1 is,
    although with η1 = 0 it is absent: the limit η1 → 0 is not the value there.

    Parameters
    ----------
    stiffness
        μ0 ≥ 0 [N/m; N·m/rad].
    branch_stiffness
        μ1 > 0 [N/m; N·m/rad].
    branch_damping
        η1 > 0 [N·s/m; N·m·s/rad].  For η1 < 0 H is unstable and no damping will do.
    sample_period
        T > 0 [s].
    discretization
        "backward" or "tustin".

    Returns
    -------
    Exact
        The smallest device damping [N·s/m; N·m·s/rad].

    References
    ----------
    "A passivity criterion for real-time haptic simulation of viscoelastic soft
    tissues", equations (9) and (22).
    """
    mu0 = nonnegative("stiffness", stiffness, NEGATIVE_SPRING)
    mu1 = positive("branch_stiffness", branch_stiffness, _NO_BRANCH)
    eta1 = positive("branch_damping", branch_damping, _NO_BRANCH)
    t = positive("sample_period", sample_period, NO_CLOCK)
    if discretization == "backward":
        return Exact(mu0 * t / 2 + mu1 * eta1 * t / (2 * eta1 + mu1 * t))
    if discretization == "tustin":
        return Exact((mu0 + mu1) * t / 2)
    raise InputError(
        f'the closed form covers "backward" and "tustin", got {discretization!r}; '
        "check the solid itself: the exact engine covers every discretization"
    )
