"""How far one parameter may go, all else as given: the last value that is still proved.

Each answer is a double at which the loop was proved passive, beside one at which it was not.  The search
begins where the limit probably lies.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from fractions import Fraction
from functools import cache
from math import inf, isfinite

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.passivity.corners import worst_corners
from zwidth.passivity.criterion_choice import Decision, decide
from zwidth.passivity.linear.boundary import COARSE, Holds, largest_holding, smallest_holding
from zwidth.passivity.linear.criterion import LinearProof, decide_linear, tightest
from zwidth.passivity.linear.loop import HIGH_DEGREE, linear_loop
from zwidth.quantity.exact import Exact


def provable(change: Change, value: Fraction, contact: bool = False) -> bool:
    """True when the loop with this value is proved passive; a value that cannot be built is not.

    With `contact`, proved with contact made and broken; with intervals, at each of their corners.
    """
    try:
        device, law = change(value)
        certain = device.is_certain and law.is_certain
        corners = [(device, law)] if certain else worst_corners(device, law)
        decisions = (decide(*corner) for corner in corners)
        return all(d.covers_contact if contact and not d.is_spring else d.is_provable for d in decisions)
    except (InputError, ZeroDivisionError):
        return False


def required_damping(decision: Decision, contact: bool = False) -> float | None:
    """The smallest damping b that the linear criterion accepts [N·s/m]; None if none would do.

    For a clamped law and with `contact`, that the condition for contact made and broken accepts.
    """
    if decision.is_clamped or contact:
        need = decision.contact_damping
        return None if need is None else smallest_holding(lambda b: b >= need, float(need))
    loop = decision.loop
    guess, _ = tightest(loop)
    if guess == inf:
        return None

    def holds(b: Fraction) -> bool:
        return isinstance(decide_linear(loop.with_damping(b)), LinearProof)

    return smallest_holding(holds, max(guess, 0.0))


def max_stiffness(device: Device, environment: Environment, contact: bool = False) -> float | None:
    """The largest passive stiffness K [N/m; N·m/rad], all else as given.

    inf if every stiffness is, None if none is or the law has no stiffness; `contact` as for `provable`.
    Of a law of high order it is proved too, but only 2.4e-7 of itself from one that is not.
    """
    if not has_stiffness(environment):
        return None
    now = float(stiffness_of(environment))

    def change(k: Fraction) -> tuple[Device, Environment]:
        return device, environment.replace(stiffness=Exact(k))

    def holds(k: Fraction) -> bool:
        return provable(change, k, contact)

    is_high = is_of_high_degree(device, environment)
    grain = COARSE if is_high else 1
    likely = None if is_high or not now else likely_value(change, contact, now, now, more=False)
    found = largest_holding(holds, now or 1.0, grain, likely)
    if found:
        return found
    # with negative virtual damping a softer wall may ask for more friction: look among stiffer ones
    among = [] if _only_worse(change, now) else _stiffer(now)
    stiffer = next((k for k in among if holds(Exact(k).fraction)), None)
    return found if stiffer is None else largest_holding(holds, stiffer, grain)


def _only_worse(change: Change, now: float) -> bool:
    """True where the loop is active at one frequency, and all the more with more stiffness.

    What is asked for there, H and its size being linear in K, is convex in K: once it grows it always does.
    """
    violated = decide(*change(Exact(now).fraction))
    cosine = getattr(violated.viscous, "cosine", None)
    if cosine is None:
        return False
    need = violated.loop.required_damping_at(cosine)
    stiffer = decide(*change(Exact(_stiffer(now)[0]).fraction)).loop.required_damping_at(cosine)
    return stiffer >= need > float(violated.loop.damping)


def is_of_high_degree(device: Device, environment: Environment) -> bool:
    """True where one decision takes so long that fewer are made."""
    return linear_loop(device, environment).degree > HIGH_DEGREE


def _stiffer(stiffness: float) -> list[float]:
    """Stiffnesses above a given one, up to a million times as large [N/m; N·m/rad]."""
    return [(stiffness or 1.0) * 1.25**step for step in range(1, 62)]


def max_gain(device: Device, environment: Environment, contact: bool = False) -> float | None:
    """The largest factor on H(z) that stays passive, None where none does; `contact` as for `provable`."""
    if environment.scaled(Fraction(1)) is None:
        return None

    def change(factor: Fraction) -> tuple[Device, Environment]:
        law = environment.scaled(factor)
        assert law is not None
        return device, law

    holds: Holds = lambda factor: provable(change, factor, contact)  # noqa: E731
    return largest_holding(holds, _likely_gain(decide(device, environment)))


def _likely_gain(decision: Decision) -> float:
    """Where to look for the largest factor: what a law needs grows with it, of damping and of friction."""
    setting, friction = decision.setting, decision.sufficient_friction
    pairs = [(float(decision.loop.damping), tightest(decision.loop)[0])]
    pairs += [] if friction is None else [(float(setting.coulomb_friction), float(friction))]
    return min((has / need for has, need in pairs if has > 0 and 0 < need < inf), default=1.0)


def stiffness_of(environment: Environment) -> Exact:
    """The stiffness of a certain law that has one [N/m; N·m/rad]."""
    value: Exact = getattr(environment, "stiffness")  # noqa: B009  not every environment has it
    return value


def has_stiffness(environment: Environment) -> bool:
    """True when the law has a parameter that is its stiffness."""
    return any(f.name == "stiffness" for f in fields(environment))


# Where a limit probably lies, in doubles: what the proofs ask of damping and friction goes up with a
# parameter, often in proportion to it, and a few secants find where it reaches what the device has.  Nothing
# is claimed of what they find: at the limit that is given, and beside it, a loop was decided exactly.


Change = Callable[[Fraction], tuple[Device, Environment]]
"""The loop with a value of one of its parameters."""

_MOST = 8  # secants: where what is asked for is in proportion, two do
_NEAR = 1e-13  # of all that there is so much may be missing or left
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

    `decision`: of the loop with an encoder of 1 m or 1 rad: friction is asked for in proportion; `contact`:
    as for `provable`.
    """
    need = likely_friction(decision, contact)
    return float(decision.setting.coulomb_friction) / need if need else inf


def likely_value(change: Change, contact: bool, start: float, other: float, more: bool) -> float | None:
    """The value of a parameter at which all that there is is asked for; None where secants find none.

    `change`: the loop with a value of it; `contact`: as for `provable`; `start`, `other`: where it is, and
    another value for where it is 0; `more`: True where more of it is safer: then its inverse asks for more.
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
