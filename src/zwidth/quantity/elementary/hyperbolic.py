"""The hyperbolic tangent.

tanh x = e/(e + 2),   e = e²ˣ − 1
"""

from __future__ import annotations

from zwidth.native.compiled import compiled
from zwidth.quantity.elementary.double_double import two_product, two_sum
from zwidth.quantity.elementary.exponential import expm1_parts

_LINEAR_UP_TO = 2.0**-28
"""Up to which tanh x is x but for rounding."""

_ONE_FROM = 20.0
"""From which tanh x is 1 but for rounding."""


@compiled
def tanh(x: float) -> float:
    """tanh x to 0.6 units in the last place; tanh (−x) = −tanh x to the bit."""
    size = abs(x)
    if size < _LINEAR_UP_TO or x != x:
        return x
    y = 1.0
    if size < _ONE_FROM:
        a, b = expm1_parts(2.0 * size)
        d, missed = two_sum(2.0, a)
        y = a / d
        p, error = two_product(y, d)
        y += (((a - p) - error) + (b - y * (missed + b))) / d
    return -y if x < 0.0 else y
