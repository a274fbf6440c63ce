"""A request made ready: all that a chunk needs, computed once and the same for every worker.

    passive          K ≤ K_max(B), the smaller of  2 (b − g|B|)/((2d + 1) T)  and  2 f_c/Δ − v|B|/T
    admissible speed (f_c − F)/(b_need − b),  F = (K + v|B|/T) Δ/2,  b_need = (2d + 1) K T/2 + g|B|

with g = Σ|w_j| and v = T ‖h_v‖₁ of the velocity estimate: the two conditions for contact made and broken, and
what is left of them for a hand of bounded speed (docs: contact made and broken).  K_max is rational, so that
a cell is passive by an exact comparison.  With a delay of d + α samples, 0 < α < 1, it is the root of

    b (b − Q) = α(1 − α) (K T + 2 g|B|)²/4,    Q = (2d + 1 + 2α) K T/2 + g|B|,    2 b_need = Q + √(Q² + …),

rounded down.  With a filter whose response does not end no condition covers a wall with damping; a spring
alone is compared with

    b² − b (K T/2)(2d + 1 + 2α) − ¼ T² α(1 − α) K² ≥ 0,    2 b ≥ (K T/2)(2d + 1 + 2α),    f_c ≥ K Δ/2.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable
from fractions import Fraction
from math import floor
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from zwidth.loop.sampled_plant import Coefficients, Motion
from zwidth.model.environment import Wall
from zwidth.model.environment.environment import RationalFunction
from zwidth.passivity.check import check
from zwidth.passivity.criterion_choice import decide
from zwidth.passivity.formulas.colgate_schenkel import spring_stiffness
from zwidth.passivity.linear.contact import damped_wall, root_above
from zwidth.passivity.stability.characteristic import (
    Family,
    as_floats,
    bilinear,
    family,
    last_stable_of_each,
    plain,
)
from zwidth.passivity.stability.known_hand import motion_of
from zwidth.quantity.balls import precision
from zwidth.quantity.exact import Exact
from zwidth.study.maps.cables import allowed_walls, joined
from zwidth.study.maps.request import Array, Request

_NOT_COVERED = "walls with this velocity filter, whose response does not end"

_BITS = 192
"""Of the coefficients before they are rounded to doubles."""


class HandPlan(NamedTuple):
    """One hand: its polynomials in w as doubles, and what an exact decision starts from."""

    name: str
    free: Array
    stiff: Array
    damped: Array
    slack: float
    """How far a coefficient may be from the true one beyond its rounding: the radius of its ball."""
    motion: Motion
    velocity: RationalFunction


class Contact(NamedTuple):
    """The two conditions for contact made and broken as numbers: see above; `part` is α(1 − α)."""

    period: float
    part: float
    hold: float
    gain: float
    variation: float
    damping: float
    friction: float
    half_step: float


class Plan(NamedTuple):
    """What a chunk is computed from."""

    stiffness: Array
    damping: Array
    passive: NDArray[np.int64]
    """For each B how many of the stiffnesses are passive, from the softest on."""
    sustained: NDArray[np.int64]
    """For each B the first stiffness that is passive while contact lasts, and the one past the last."""
    limit: Array
    """For each B the largest passive stiffness, below 0 or NaN where none is."""
    contact: Contact | None
    hands: tuple[HandPlan, ...]
    not_covered: str
    """Why walls with damping have no condition for contact made and broken; "" where they have one."""


def plan(asked: Request) -> Plan:
    """All that does not depend on the chunk."""
    period = asked.device.exact("sample_period")
    k, b = asked.stiffness.values, asked.virtual_damping.values
    contact = _contact(asked, period)
    softest_first = [Exact(value).fraction for value in k]
    if contact is not None:
        limits = [_limit(contact, abs(Exact(value).fraction)) for value in b]
        passive = [bisect_right(softest_first, limit) for limit in limits]
        ends = [float(limit) for limit in limits]
    else:
        springs = sum(_spring_passes(asked, stiffness) for stiffness in softest_first)
        passive = [springs if value == 0 else 0 for value in b]
        ends = [spring_limit(asked) if value == 0 else np.nan for value in b]
    velocity = asked.velocity_filter.transfer(period)
    sign = 1 if velocity.denominator[0] > 0 else -1  # positive below: Routh's signs are then all +
    velocity = RationalFunction(*(tuple(sign * c for c in part) for part in velocity))
    return Plan(
        stiffness=k,
        damping=b,
        passive=np.array(passive, dtype=np.int64),
        sustained=sustained_walls(asked),
        limit=np.array(ends),
        contact=None if contact is None or asked.gives_way else Contact(*(float(value) for value in contact)),
        hands=tuple(_hand(name, motion_of(asked.device, hand), velocity) for name, hand in asked.hands),
        not_covered="" if contact is not None else _NOT_COVERED,
    )


def spring_limit(asked: Request) -> float:
    """The stiffest spring, B = 0, that is passive, contact made and broken [N/m; N·m/rad]; to rounding."""
    device = asked.device
    by_damping = float(spring_stiffness(*(device.exact(k) for k in ("damping", "sample_period", "delay"))))
    count = float(device.exact("resolution"))
    return min(by_damping, 2 * float(device.exact("coulomb_friction")) / count) if count else by_damping


def _spring_passes(asked: Request, stiffness: Fraction) -> bool:
    device = asked.device
    period, b = device.exact("sample_period"), device.exact("damping")
    late = device.exact("delay") / period
    part = late % 1
    turned = stiffness * period / 2
    linear = turned * (2 * late + 1)
    # the larger root is asked for: for b = 0 and a delay of whole samples the square alone is 0
    viscous = 2 * b >= linear and b * b - b * linear - part * (1 - part) * turned * turned >= 0
    return viscous and 2 * device.exact("coulomb_friction") >= stiffness * device.exact("resolution")


def _contact(asked: Request, period: Fraction) -> tuple[Fraction, ...] | None:
    """The numbers of `Contact`, exact; None where no condition covers the loop."""
    device = asked.device
    wall = Wall(1, 1, velocity_filter=asked.velocity_filter)
    unit, late = damped_wall(wall, period), device.exact("delay") / period
    if unit is None or decide(device, wall).contact_damping is None:
        return None
    return (
        period,
        late % 1 * (1 - late % 1),
        (2 * late + 1) * period / 2,
        unit.estimate.gain,
        unit.estimate.variation / period,
        device.exact("damping"),
        device.exact("coulomb_friction"),
        device.exact("resolution") / 2,
    )


def stable_limits(hand: HandPlan, damping: Array) -> Array:
    """For each B the largest stiffness that is stable with a hand, NaN where none is; floats, for curves."""
    with precision(_BITS):
        polynomials = plain(family(hand.motion, hand.velocity))
    found = last_stable_of_each(polynomials, damping)
    return np.array([np.nan if end is None else end.stiffness for end in found])


def _limit(contact: tuple[Fraction, ...], b: Fraction) -> Fraction:
    """K_max for one |B|; below 0 where no stiffness will do."""
    period, part, hold, gain, variation, damping, friction, half_step = contact
    viscous = _viscous_limit(period, part, hold, damping, gain * b)
    return viscous if half_step == 0 else min(viscous, friction / half_step - variation * b)


def _viscous_limit(
    period: Fraction, part: Fraction, hold: Fraction, damping: Fraction, asked: Fraction
) -> Fraction:
    """The larger root K of (part/4) T² K² + m K − n, rounded down; below 0 where no stiffness will do."""
    left = damping - asked
    if part == 0:
        return left / hold
    m, n = damping * hold + part * period * asked, damping * left - part * asked**2
    if n <= 0 or left <= 0:
        return min(n, left)
    return 2 * n / (m + root_above(m**2 + part * period**2 * n))


def _hand(name: str, motion: Motion, velocity: RationalFunction) -> HandPlan:
    with precision(_BITS):
        parts = _in_w(family(motion, velocity))
        free, stiff, damped = (as_floats(part) for part in parts)
        # of the balls, and a little more
        slack = max(0.0 if isinstance(c, Fraction) else 1.01 * float(c.rad()) for part in parts for c in part)
    return HandPlan(name, free, stiff, damped, slack, motion, velocity)


def _in_w(polynomials: Family) -> list[Coefficients]:
    """The three polynomials in w, all with the degree of the first."""
    size = len(polynomials.free)
    padded: list[Any] = [[*([0 * part[0]] * (size - len(part))), *part] for part in polynomials]
    return [bilinear(part) for part in padded]


# Which walls are passive as long as contact lasts: for each virtual damping an interval of stiffness.


Proved = Callable[[int], bool]

_ANGLES = 2000


def sustained_walls(asked: Request) -> NDArray[np.int64]:
    """For each B the first stiffness of the axis that is proved, and the one past the last: 2 × n."""
    k, b = asked.stiffness.values, asked.virtual_damping.values
    found = np.zeros((2, len(b)), dtype=np.int64)
    if asked.exactly:
        runs = allowed_walls(asked)
    else:
        low, high = _by_floats(asked, b)
        runs = np.array([np.searchsorted(k, low, side="left"), np.searchsorted(k, high, side="right")])
    for j, (first, past) in enumerate(runs.T):
        if first < past:
            found[:, j] = _column(asked, float(b[j]), int(first), int(past))
    return found


def _by_floats(asked: Request, b: Array) -> Array:
    """For each B the stiffnesses that the criterion allows at frequencies on a grid: 2 × n."""
    device = asked.device
    period, damping = device.exact("sample_period"), float(device.exact("damping"))
    late = device.exact("delay") / period
    part = float(late - floor(late))
    theta = np.unique(
        np.concatenate([np.geomspace(1e-4, np.pi, _ANGLES), np.linspace(0, np.pi, _ANGLES)[1:]])
    )
    z = np.exp(1j * theta)
    above, below = (np.polyval([float(c) for c in p], z) for p in asked.velocity_filter.transfer(period))
    velocity = above / below
    hold = (1 - 1 / z) * z ** -floor(late) * (1 - part + part / z) / (4 * np.sin(theta / 2) ** 2)
    switching = part * (1 - part) / 4 * float(period)
    low, high = np.full(len(b), -np.inf), np.full(len(b), np.inf)
    for at in range(len(theta)):
        # (c₂ K + c₁) K ≤ c₀, all divided by T
        c2 = switching
        c1 = damping * hold[at].real + 2 * switching * b * velocity[at].real
        c0 = damping * (damping / float(period) - b * (hold[at] * velocity[at]).real)
        c0 = c0 - switching * b**2 * abs(velocity[at]) ** 2
        ends = _between(c2, c1, c0)
        low, high = np.maximum(low, ends[0]), np.minimum(high, ends[1])
    return np.array([low, high])


def _between(c2: float, c1: Array, c0: Array) -> tuple[Array, Array]:
    """The K with c₂ K² + c₁ K ≤ c₀, c₂ ≥ 0; an empty range where there are none."""
    with np.errstate(divide="ignore", invalid="ignore"):
        if c2 == 0:
            low, high = np.where(c1 < 0, c0 / c1, -np.inf), np.where(c1 > 0, c0 / c1, np.inf)
            never = (c1 == 0) & (c0 < 0)
        else:
            root = np.sqrt(c1**2 + 4 * c2 * c0)
            low, high = (-c1 - root) / (2 * c2), (-c1 + root) / (2 * c2)
            never = np.isnan(root)
    return np.where(never, np.inf, low), np.where(never, -np.inf, high)


def _column(asked: Request, damping: float, first: int, past: int) -> tuple[int, int]:
    """The walls of one B that are proved, both ends with a certificate; 0, 0 without one."""
    k, device = asked.stiffness.values, asked.whole if asked.exactly else asked.device

    def proved(i: int) -> bool:
        wall = Wall(Exact(float(k[i])), Exact(damping), velocity_filter=asked.velocity_filter)
        return check(device, wall, contact="kept", iterate=False).outcome == "passive"

    low, high = _exactly(proved, first, past)
    while asked.exactly and low < high and not joined(asked, damping, low, high - 1, proved):
        high = (low + high) // 2
    return low, high


def _exactly(proved: Proved, first: int, past: int) -> tuple[int, int]:
    """The proved part of a range that floats allow."""
    inside = next((i for i in (first, (first + past - 1) // 2, past - 1) if proved(i)), None)
    if inside is None:
        return 0, 0
    return _end(proved, inside, first, -1), _end(proved, inside, past - 1, 1) + 1


def _end(proved: Proved, inside: int, far: int, step: int) -> int:
    """The proved cell nearest to `far`: there, one short of it, or by halving."""
    for i in (far, far - step):
        if (i - inside) * step <= 0:
            return inside
        if proved(i):
            return i
    good, bad = inside, far - step
    while abs(bad - good) > 1:
        middle = (good + bad) // 2
        if proved(middle):
            good = middle
        else:
            bad = middle
    return good
