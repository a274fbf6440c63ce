"""Systems of harold (Transfer and State), under the names of python-control.

    SamplingPeriod   T [s], None in continuous time        dt
    num, den         of one axis rows in a matrix, of several a list of rows of such       num[i][j]
    a, b, c, d       without states empty                                                  A, B, C, D

They are recognised by what they have, so that harold is not needed here.  Source: ilayn/harold,
harold/_classes.py, version 1.0.2.
"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any


def is_of_harold(thing: object) -> bool:
    """True for what looks like a Transfer or a State of harold."""
    return hasattr(thing, "SamplingPeriod") and hasattr(thing, "shape") and not isinstance(thing, type)


def renamed(system: Any) -> Any:
    """A system as python-control would have it; one that is not of harold as it is."""
    if not is_of_harold(system):
        return system
    period = system.SamplingPeriod
    outputs, inputs = (int(size) for size in system.shape)
    own = {"dt": 0 if period is None else period, "noutputs": outputs, "ninputs": inputs}
    if all(hasattr(system, name) for name in "abcd"):
        matrices = {name.upper(): getattr(system, name) for name in "abcd"}
        return SimpleNamespace(**own, **matrices)
    num, den = (_by_entry(getattr(system, name), outputs, inputs) for name in ("num", "den"))
    return SimpleNamespace(**own, num=num, den=den)


def _by_entry(polynomials: Any, outputs: int, inputs: int) -> list[list[list[Any]]]:
    """[output][input] → coefficients."""
    if (outputs, inputs) == (1, 1):
        return [[list(polynomials[0])]]
    return [[list(polynomials[i][j][0]) for j in range(inputs)] for i in range(outputs)]
