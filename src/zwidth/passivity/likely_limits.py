"""Where a limit probably lies, in doubles: a search begins there.

What the proofs ask of damping and friction goes up with a parameter, often in proportion to it, and a few
secants find where it reaches what the device has.  Nothing is claimed of what they find: at the limit that
is given, and beside it, a loop was decided exactly.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from functools import cache
from math import inf, isfinite

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.passivity.decision import Decision, decide
from zwidth.passivity.linear.supremum import tightest
from zwidth.quantity.exact import Exact

Change = Callable[[Fraction], tuple[Device, Environment]]
"""The loop with a value of one of its parameters."""

_MOST = 8
"""Secants: where what is asked for is in proportion, two do."""

_NEAR = 1e-13
"""Of all that there is so much may be missing or left."""

_ROUNDED = 1 + 1e-12


def likely_damping(decision: Decision, contact: bool) -> float:
    """The least damping of the device that is enough, inf where none is; `contact` as for `provable`."""
    covered = _friction(decision, contact) <= float(decision.setting.coulomb_friction) * _ROUNDED
    return _damping(decision, contact) if covered else inf


def likely_friction(decision: Decision, contact: bool) -> float:
    """The least Coulomb friction that is enough, inf where none is; `contact` as for `provable`."""
    covered = _damping(decision, contact) <= float(decision.loop.damping) * _ROUNDED
    return _friction(decision, contact) if covered else inf


def likely_resolution(decision: Decision, contact: bool) -> float:
    """The coarsest encoder whose steps friction covers, 0 where none is fine enough.

    Parameters
    ----------
    decision
        Of the loop with an encoder of 1 m or 1 rad: friction is asked for in proportion.
    contact
        As for `provable`.
    """
    need = likely_friction(decision, contact)
    return float(decision.setting.coulomb_friction) / need if need else inf


def likely_value(change: Change, contact: bool, start: float, other: float, more: bool) -> float | None:
    """The value of a parameter at which all that there is is asked for; None where secants find none.

    Parameters
    ----------
    change
        The loop with a value of it.
    contact
        As for `provable`.
    start, other
        Where it is, and another value for where it is 0.
    more
        True where more of it is safer: then its inverse asks for more.
    """

    @cache  # asked of friction where it was asked of damping
    def at(value: float) -> Decision:
        return decide(*change(Exact(1 / value if more else value).fraction))

    def damping(value: float) -> float:
        decision = at(value)
        return _part(_damping(decision, contact), float(decision.loop.damping))

    def friction(value: float) -> float:
        decision = at(value)
        return _part(_friction(decision, contact), float(decision.setting.coulomb_friction))

    begin = 1 / start if more else start
    try:
        found = _secants(damping, begin, other)
        if found is None or friction(found) > _ROUNDED:
            found = _secants(friction, begin, other)
    except (InputError, ArithmeticError):  # where the secants lead there is no such loop
        return None
    return 1 / found if more and found else found


def _damping(decision: Decision, contact: bool) -> float:
    """What is asked of the device, to rounding [N·s/m; N·m·s/rad]; inf where nothing is enough."""
    if not _with_contact(decision, contact):
        return tightest(decision.loop)[0]
    need = decision.contact_damping
    return inf if need is None else float(need)


def _friction(decision: Decision, contact: bool) -> float:
    """The same of Coulomb friction [N; N·m]."""
    if decision.setting.resolution == 0:
        return 0.0
    if not _with_contact(decision, contact):
        return inf if decision.norm is None else float(decision.norm.bound * decision.setting.resolution / 2)
    need = decision.contact_friction
    return inf if need is None else float(need)


def _with_contact(decision: Decision, contact: bool) -> bool:
    """Whether a proof for contact made and broken is asked for; of a spring it is the same, and quicker."""
    if decision.is_spring:
        return decision.wall is not None and not decision.loop.part_delay
    return contact or decision.is_clamped


def _part(need: float, has: float) -> float:
    if has:
        return need / has
    return inf if need > 0 else 0.0


def _secants(load: Callable[[float], float], start: float, other: float) -> float | None:
    """Where the load is 1, if it gets there."""
    here, was = start, load(start)
    there = here / was if here and was > 0 else other
    for _ in range(_MOST):
        now = load(there)
        if abs(now - 1) <= _NEAR:
            return there
        if not isfinite(now) or now == was:
            return None
        step = (1 - now) * (there - here) / (now - was)
        here, was, there = there, now, there + step
        if not 0 < there < inf:
            return None
    return there
