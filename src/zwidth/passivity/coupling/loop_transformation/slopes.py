"""A static spring known by its slopes alone, its force d samples late: the damping it needs.

SlopeBounds between μ and L > 0, of which one may be negative, and a potential that is bounded below:

    b ≥ (2d + 1) L T/2                 d |μ| ≤ (d + 1) L  or  μ ≥ 0

exactly, for the spring of the greatest slope needs as much already: up to (1 + 1/d) L, a negative slope
costs nothing, and without delay it never does.  Beyond, what is enough comes of a form of two sequences.
Derived for this project.
"""

from __future__ import annotations

from fractions import Fraction

from zwidth.errors import InputError
from zwidth.passivity.coupling.loop_transformation.environment_class import SlopeBounds
from zwidth.passivity.coupling.loop_transformation.forms import DIRECT
from zwidth.passivity.coupling.loop_transformation.least_damping import best_form, largest_need
from zwidth.passivity.formulas.hypotheses import NO_CLOCK, nonnegative, positive
from zwidth.quantity.exact import Exact, RealLike


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
