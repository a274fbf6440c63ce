"""The least damping that makes a form ≥ 0: its multiplier chosen for the best, its worst frequency found.

The multiplier is found by floats; the form is then one of exact numbers, and decided as such.
"""

from __future__ import annotations

from fractions import Fraction
from math import inf, isfinite, pi

import numpy as np
from scipy.optimize import minimize_scalar

from zwidth.passivity.coupling.loop_transformation.environment_class import SlopeBounds
from zwidth.passivity.coupling.loop_transformation.forms import Connection, least_multiplier, slopes_form
from zwidth.passivity.coupling.loop_transformation.two_signals import TwoSignalForm

_ANGLES = np.linspace(0, pi, 2001)

_DECADES = np.linspace(-5, 4, 46)
"""Of g above its least value, in units of 1/(the greatest stiffness that occurs)."""


def best_form(slopes: SlopeBounds, connection: Connection, d: int) -> TwoSignalForm:
    """The form of `slopes_form` with the multiplier g that asks for the least damping.

    The need is convex in g: b and g enter the Hermitian form linearly.
    """
    least = least_multiplier(slopes)
    stiffness = [slopes.least.fraction, slopes.greatest.fraction, *connection[0]]
    scale = max(abs(c) for c in stiffness) or Fraction(1)
    cosines = np.cos(_ANGLES[::10])

    def form(more: float) -> TwoSignalForm:
        return slopes_form(slopes, least + Fraction(more) / scale, connection, d)

    def need(decade: float) -> float:
        return float(np.max(form(10.0**decade).need(cosines)))

    at = _DECADES[int(np.argmin([need(p) for p in _DECADES]))]
    found = minimize_scalar(need, bounds=(at - 0.2, at + 0.2), method="bounded", options={"xatol": 1e-7})
    bare = form(0.0)
    return bare if np.max(bare.need(cosines)) <= found.fun else form(10.0 ** float(found.x))


def largest_need(form: TwoSignalForm, period: Fraction) -> tuple[float, float]:
    """b that is enough [N·s/m], infinite if none is, and the frequency that asks for it [Hz].

    The need over frequency is found by floats, and raised until it is proved, by 10⁻¹² of itself or so.
    """
    needs = form.need(np.cos(_ANGLES))
    top = int(np.argmax(needs))
    angle, need = float(_ANGLES[top]), float(needs[top])
    if not form.first_is_nonnegative() or not isfinite(need):
        return inf, angle / (2 * pi * float(period))
    bounds = _ANGLES[max(top - 1, 0)], _ANGLES[min(top + 1, len(_ANGLES) - 1)]
    found = minimize_scalar(lambda a: -form.need(np.cos([a]))[0], bounds=bounds, method="bounded")
    if -found.fun > need:
        angle, need = float(found.x), -float(found.fun)
    return _proved(form, max(need, 0.0), period), angle / (2 * pi * float(period))


def _proved(form: TwoSignalForm, need: float, period: Fraction) -> float:
    """The first of need (1 + 10⁻¹⁵ 4ⁿ) that is proved; infinite if the floats were wrong by a millionth."""
    more = 1e-15
    while more < 1e-6:
        enough = float(period) * need * (1 + more)
        if form.is_nonnegative(Fraction(enough) / period):
            return enough
        more *= 4
    return inf
