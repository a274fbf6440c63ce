"""Two arms of which one is held by a known hand: does the hand on the other take energy out?

With x_h = −G f_h of the held arm in its hand, G = g/a in powers of ζ, and fᵢ = Aᵢ xᵢ + Cᵢ xⱼ, the free arm's
hand meets the law

    H = A − C G C_h/(1 + G A_h) = N/D,    D = a + g A_h,    N = A D − C C_h g,

to which the criterion of one arm applies.  The hold makes g and a of exponentials, known within bounds.  In
powers of w = 1 − ζ, in which slow motions do not cancel, with |w|² = 2u and u = 1 − cos θ,

    q = 2b/T |D|² − Re{w ζᵈ (1 − α + α ζ) N D̄}/u − (T/2b) α (1 − α) |N|²

is a polynomial in u, to be > 0 for 0 ≤ u ≤ 2 at every end of what is not known.  Where q > 0, D has no root
on the circle, as D(1) > 0 is made of positive terms: stable at one hand of a box, it is stable at all.
H(1) = S k/(k + S_h) ≥ 0.

An encoder's half count moves the force by ‖H‖₁ Δ/2, that of the held arm by ‖C/(1 + G A_h)‖₁ Δ_h/2.
Derivation: docs/theory/pairs.md.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from ..document.fields import Between, Choice, Number, Read, Record, document, numbers
from ..document.number import DAMPING, LENGTH, MASS, STIFFNESS, about, common_scale
from ..document.refusal import Invalid, spend
from ..exact.enclosed import Enclosed, in_z, known
from ..exact.polynomial import shifted
from ..known_hand.held_motion import motion_of, sampled
from ..known_hand.rest import Loop, comes_to_rest
from ..loop.motion import TOLD
from .coupling import PAIR, sides_of
from .felt import Held, Port, at, in_w, in_zeta, one_norm, port_of, real_part, require_above_zero, times
from .passive import readings

MOST_ORDER = 120
MOST_BOXES = 500
MOST_HALVINGS = 40
BITS = 256
"""And four for each order: wʲ has coefficients of 2ʲ in powers of ζ, its real part of 4ʲ in those of u."""
HELD = Record(
    {
        "arm": Choice("leader", "follower"),
        "mass": Between(MASS, above=0),
        "damping": Between(DAMPING, least=0),
        "stiffness": Between(STIFFNESS, least=0),
    },
    named=True,
)
"""Which arm, and what moves there: arm and hand together."""
HELD_PAIR = document({"loop": PAIR, "held": HELD})
HELD_VIOLATION = document(
    {"loop": PAIR, "held": HELD, "proof": Record({"cosine": Number(least=-1, most=1)}, shown=False)}
)


def held_pair(told: Read) -> str:
    """The free arm's hand takes nothing out."""
    held = held_of(told)
    if held.arm.coulomb_friction:
        raise Invalid("Coulomb friction of the held arm bends its law, and such a proof is of a linear one")
    if not comes_to_rest(_alone(held)):
        raise Invalid("that the held arm comes to rest in its hand could not be confirmed")
    boxes = _covered(held)
    hands = "the hand on the other arm"
    if held.motion != held.motion.middle:
        hands = f"every such hand, in {boxes} box{'es' * (boxes != 1)}, the other one"
    return f"with the {told.held.arm} held, the work of {hands} is nowhere negative"


def held_violation(told: Read) -> str:
    """A frequency at which it does; large motions do not know of friction and steps on either arm."""
    held = held_of(told)
    if held.motion.middle != held.motion:
        raise Invalid("that a hand takes energy out is shown with single values, not with intervals")
    if at(_criterion(held, port_of(held)), told.proof.cosine).sign != -1:
        raise Invalid("the work of the hand is not shown to be negative at this frequency")
    return f"with the {told.held.arm} held, at one frequency a motion of the other arm takes energy out"


def held_of(told: Read) -> Held:
    """What a document says of both arms and the hand."""
    sides, place = sides_of(told.loop), ("leader", "follower").index(told.held.arm)
    arm, free = sides[place], sides[1 - place]
    if told.loop.own_readings > 1 or any(side.law is not None for side in sides):
        raise Invalid("a held arm is decided without drives and without compensation of friction")
    if told.held.damping[0] < arm.damping:
        raise Invalid("arm and hand together damp less than the arm alone: the hand would drive it")
    rows = (*readings(free), *readings(arm))
    scale = common_scale(c for row in rows for c in row.values())
    own, other, its_own, its_other = (
        [int(row.get(k, Fraction(0)) * scale) for k in range(max(row, default=0) + 1)] for row in rows
    )
    period = told.loop.sample_period
    delay = (arm.whole + arm.part) * period
    motion = motion_of(told.held.mass, told.held.damping, told.held.stiffness, period, delay)
    order = len(other) + len(its_other) + len(own) + len(its_own) + free.whole + arm.whole + 4
    if order > MOST_ORDER:
        raise Invalid(f"readings and forces are too old for a held arm: order {order}, at most {MOST_ORDER}")
    taps = own, other, its_own, its_other
    return Held(free, arm, motion, period, scale, taps, BITS + 4 * order)


def _alone(held: Held) -> Loop:
    """The held arm, the other one at rest, at one hand."""
    its_own = held.taps[2]
    return Loop(held.motion.middle, shifted(its_own), shifted([held.scale] + [0] * (len(its_own) - 1)))


def _covered(held: Held) -> int:
    left, tried, shown = [(held.motion, 0)], 0, 0
    coupling = Fraction(sum(held.taps[2]), held.scale)
    while left:
        box, halved = left.pop()
        tried += 1
        try:
            _require(held._replace(motion=box))
            shown += 1
        except Invalid:
            _require(held._replace(motion=box.middle))
            if tried > MOST_BOXES or halved > MOST_HALVINGS:
                raise Invalid(
                    f"that it holds for every such hand was not confirmed in {tried} boxes"
                ) from None
            left += [(half, halved + 1) for half in box.halves(held.motion, coupling)]
    return shown


def _require(held: Held) -> None:
    port = port_of(held)
    require_above_zero(_criterion(held, port))
    error = Fraction(0)
    for count, top, scale in (
        (held.free.resolution, port.numerator, port.scale),
        (held.arm.resolution, port.stray, 1),
    ):
        if count:
            error += one_norm(in_zeta(top), in_zeta(port.denominator)) * count / (2 * scale)
    if error > held.free.coulomb_friction:
        raise Invalid(
            f"Coulomb friction of {about(held.free.coulomb_friction)} is below the force error of the "
            f"encoders, {about(error)}"
        )


def _criterion(held: Held, port: Port) -> list[Enclosed]:
    """q times positive numbers, ascending in u; times b where α > 0."""
    b, part, period = held.free.damping, held.free.part, held.period
    late = [*[0] * held.free.whole, part.denominator - part.numerator, part.numerator]
    mixed = times(port.numerator, [0, *in_w(late)])
    power = b if part else Fraction(1)
    weights = [
        2 * power * b * port.scale**2,
        -power * period * port.scale / part.denominator,
        -(period**2) / 2 * part * (1 - part),
    ]
    common = common_scale(weights)
    size = len(mixed) + len(port.denominator)
    total = [Enclosed(held.bits, 0)] * size
    for weight, first, second, over in (
        (weights[0], port.denominator, port.denominator, 0),
        (weights[1], mixed, port.denominator, 1),
        (weights[2], port.numerator, port.numerator, 0),
    ):
        if weight:
            found = real_part(first, second, size + 1)[over : size + over]
            total = [x + y.times(int(weight * common)) for x, y in zip(total, found, strict=True)]
    return total


# A motion of the free arm re-run while a known hand holds the other: what it takes out at the least.
#
#     a x_h = −g f_h,    f_h = A_h x_h + C_h x,    f = A x + C x_h,    all from rest at 0
#
# Straight from sample to sample, an interval costs (1 − α) f(k−d) Δx + α f(k−d−1) Δx + b Δx²/T + f_c |Δx|.
# The held arm is where numbers with bounds say: those grow from sample to sample, and bits are there for
# that.


LONGEST = 10_000
BITS_A_SAMPLE = 2
"""Of |a₁| + |a₂| < 3 for each sample, at most."""
HELD_MOTION = document(
    {"loop": PAIR, "held": HELD, **TOLD, "positions": numbers(LENGTH, least=2, most=LONGEST, shown=False)}
)


def held_motion_energy(told: Read) -> Fraction:
    """What comes out at least [J]."""
    held, path = held_of(told), told.positions
    if held.motion.middle != held.motion:
        raise Invalid("a motion is re-run with single values of a hand, not with intervals")
    if held.arm.coulomb_friction or held.free.resolution or held.arm.resolution:
        raise Invalid("a motion is re-run without encoders, and without Coulomb friction of the held arm")
    if path[0]:
        raise Invalid("the motion must start at rest at 0")
    bits = held.bits + BITS_A_SAMPLE * len(path)
    spend(12 * len(path), bits, bits)
    forces = _forces(held._replace(bits=bits), [known(x, bits) for x in path])
    return -_cost(held, path, forces)


def _forces(held: Held, path: list[Enclosed]) -> list[Enclosed]:
    """Those of the free arm as they are computed, times `scale`."""
    found, zero = sampled(held.motion, held.bits), Enclosed(held.bits, 0)
    drag, push = in_z(found.denominator)[1:], in_z(found.numerator)
    late = found.late + len(drag) + 1 - len(push)
    own, other, its_own, its_other = held.taps
    where, its, forces = list[Enclosed](), list[Enclosed](), list[Enclosed]()
    for k in range(len(path)):
        moved = _tapped(drag, where, k - 1, zero) + _tapped(push, its, k - late, zero)
        where.append(-moved)
        its.append(_tapped(its_own, where, k, _tapped(its_other, path, k, zero)).over(held.scale))
        forces.append(_tapped(own, path, k, _tapped(other, where, k, zero)))
    return forces


def _tapped(taps: Sequence[Any], values: Sequence[Enclosed], newest: int, total: Enclosed) -> Enclosed:
    """With Σ taps_i values(newest − i), of whole numbers or of numbers with bounds."""
    for age, c in enumerate(taps[: max(newest + 1, 0)]):
        if isinstance(c, Enclosed):
            total = total + values[newest - age] * c
        elif c:
            total = total + values[newest - age].times(c)
    return total


def _cost(held: Held, path: list[Fraction], forces: list[Enclosed]) -> Fraction:
    """At most [J]."""
    free, bits = held.free, forces[0].bits
    total, rubbed = Enclosed(bits, 0), Fraction(0)
    for k in range(len(path) - 1):
        move = path[k + 1] - path[k]
        rubbed += free.damping * move**2 / held.period + free.coulomb_friction * abs(move)
        for late, share in ((free.whole, 1 - free.part), (free.whole + 1, free.part)):
            if share and k >= late:
                total = total + forces[k - late] * known(move * share, bits)
    return Fraction(total.middle + total.reach, held.scale << bits) + rubbed
