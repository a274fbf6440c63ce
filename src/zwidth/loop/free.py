"""The free mass: no spring at the hand, a constant force, in closed form.

    M v̇ = G − D v,   G with the Coulomb friction of one direction in it

With a0 = (G − D v0)/M and λ = D/M,

    v = v0 + a0 h1,   Δx = v0 t + a0 h2,   ∫v² = v0² t + 2 v0 a0 h2 + a0² h3
    h1 = (1 − e^{−λt})/λ,   h2 = ∫h1,   h3 = ∫h1²

and v is monotone, so that it has one zero at most, where h1 = −v0/a0.  For small
λt the three are power series: the closed forms then lose their digits.
"""

from __future__ import annotations

from zwidth.native.compiled import compiled
from zwidth.quantity.elementary import expm1, log1p

_SERIES_UP_TO = 1.0
_TERMS = 40
_OVER = (0.0, *(1.0 / n for n in range(1, _TERMS + 3)))
"""1/n: a product takes a third of the time of a quotient."""


@compiled
def free_response(rate: float, t: float) -> tuple[float, float, float]:
    """(h1, h2, h3) [s, s², s³] for λ = `rate` ≥ 0 [1/s] and t ≥ 0 [s]."""
    z = rate * t
    if z > _SERIES_UP_TO:
        h1 = -expm1(-z) / rate
        h2 = (t - h1) / rate
        h3 = (t - 2.0 * h1 - expm1(-2.0 * z) / (2.0 * rate)) / (rate * rate)
        return h1, h2, h3
    # h1 = t Σ (−z)ⁿ/(n+1)!,  h2 = t² Σ (−z)ⁿ/(n+2)!,  h3 = t³ Σ (−z)ⁿ (2ⁿ⁺² − 2)/((n+3) (n+2)!)
    s1, s2, s3 = 1.0, 0.5, 1.0 / 3.0
    term, two = 1.0, 4.0  # (−z)ⁿ/(n+1)! and 2ⁿ⁺², at n = 0
    for n in range(1, _TERMS):
        term *= -z * _OVER[n + 1]
        two += two
        further = term * _OVER[n + 2]
        last = further * ((two - 2.0) * _OVER[n + 3])
        s1 += term
        s2 += further
        s3 += last
        if abs(last) < 1e-18:
            break
    return t * s1, t * t * s2, t * t * t * s3


@compiled
def free_stop(rate: float, velocity: float, acceleration: float) -> float:
    """The time at which v0 + a0 h1 is 0 [s], for v0 and a0 of opposite sign.

    The caller knows that there is one: the velocity has changed its sign by then.
    """
    ratio = -velocity / acceleration
    z = rate * ratio
    if z == 0.0:
        return ratio
    if z >= 1.0:  # by rounding only: the asymptote itself
        return ratio * 1e3
    return -ratio * log1p(-z) / z
