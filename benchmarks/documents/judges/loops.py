"""Proofs about linear laws: the criterion in floats and balls, roots, and motions that try.

The loop as it is programmed and the motions are those of `attack`, which shares no code with zwidth.  A
premise of a theorem that does not hold, such as too little friction for ‖h‖₁ Δ/2, counts as false as well.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from math import cos, pi, sin
from typing import Any

import numpy as np
from attack.motions import ROUNDING, attack, refutes
from attack.referee import Fed, PlainLoop, ball, digits_of, needed, needed_at, violated
from flint import acb, arb, fmpq
from scipy.signal import lfilter

from ..opinion import Opinion, agrees, cannot_say, false, first
from ..plain import exact, in_lowest_terms, plain_loop, poles_of, quantity

Document = dict[str, Any]
Rng = np.random.Generator

CLOSE = 1e-6
"""Nearer to the limit than this the criterion is evaluated in balls."""

SLACK = 1e-9
"""By so much a bound in floats must be missed before anything is said."""

TERMS = 4000
"""Of a pulse response, summed from below."""


def passive(loop: PlainLoop, rng: Rng, *, kept: bool = False) -> Opinion:
    """Whether a hand gets anything out: the criterion where the law is a line inside, roots, and motions."""
    wrong = (criterion(loop) or unstable(loop)) if loop.linear_inside else ""
    if wrong:
        return false(wrong)
    found = attack(_as_a_double(loop), rng, 48, 100, kept=kept, angle=needed(loop)[1])
    if found.score > ROUNDING and refutes(loop, found, kept=kept):
        return false(
            f"a motion of {len(found.positions)} samples takes out {found.score:.3g} of what is lost"
        )
    return agrees()


def _as_a_double(loop: PlainLoop) -> PlainLoop:
    """The same with a whole sample where no double is between the part and 1."""
    return loop if float(loop.part) < 1 else replace(loop, delay=(loop.whole + 1) * loop.period)


def criterion(loop: PlainLoop) -> str:
    """Where the law asks for more damping than there is; "" where nowhere."""
    asked, angle = needed(loop)
    damping = float(loop.damping)
    if asked > damping * (1 - CLOSE) and violated(loop, angle):
        return f"the criterion asks for {asked:.12g} at ωT = {angle:.6g}, the damping is {damping:.12g}"
    if loop.part and not loop.damping and any(loop.numerator):
        return "the force changes inside a sample and nothing damps"
    return ""


def unstable(loop: PlainLoop) -> str:
    """A pole outside the circle, or one on it that no passive law has, or H(1) < 0; "" where none."""
    above, below = in_lowest_terms(list(loop.numerator), list(loop.denominator))
    if not sum(below):
        return "H(z) has a pole at z = 1"
    if sum(above) / sum(below) < 0:
        return f"H(1) = {float(sum(above) / sum(below)):.6g} < 0"
    for pole, times in poles_of(below):
        if abs(pole) > 1:
            return f"H(z) has a pole of size {float(abs(pole).mid()):.12g}"
        if abs(pole).overlaps(arb(1)) and (times > 1 or _pushes_on(loop, above, below, pole)):
            return "H(z) has a pole on the circle that no passive law has"
    return ""


def _pushes_on(loop: PlainLoop, above: list[Fraction], below: list[Fraction], pole: acb) -> bool:
    """Whether G = b + T z⁻ᵈ H/(z − 1) has a residue there that is not z₀ times a number ≥ 0."""
    if loop.part:
        return bool(abs(pole).rad() < 1e-12)
    late = 1 / pole
    slope = acb(0)
    for k, c in enumerate(below):
        slope += -k * acb(_ball(c)) * late ** (k + 1)
    residue = late**loop.whole * _value(above, late) / ((pole - 1) * slope) / pole
    return bool(residue.real < -1e-9 * abs(residue)) or bool(abs(residue.imag) > 1e-6 * abs(residue))


def _value(ascending: list[Fraction], at: acb) -> acb:
    total = acb(0)
    for c in reversed(ascending):
        total = total * at + _ball(c)
    return total


def _ball(value: Fraction) -> arb:
    return arb(fmpq(value.numerator, value.denominator))


def one_norm(above: list[Fraction], below: list[Fraction]) -> float:
    """Σ|h_k| of a law, from below."""
    pulse = np.zeros(TERMS)
    pulse[0] = 1.0
    response = lfilter([float(c) for c in above], [float(c) for c in below], pulse)
    return float(np.abs(response[np.isfinite(response)]).sum())


def friction_covers(loop: PlainLoop, parted: bool = False) -> Opinion:
    """f_c ≥ ‖h‖₁ Δ/2; `parted`: (K + ‖H − K‖₁) Δ/2."""
    if not loop.resolution:
        return agrees()
    above, size = list(loop.numerator), 0.0
    if parted:
        static = loop.static or Fraction(0)
        above, size = [n - static * d for n, d in zip(above, loop.denominator, strict=True)], float(static)
    size += one_norm(above, list(loop.denominator))
    asked, given = size * float(loop.resolution) / 2, float(loop.friction)
    if asked > given * (1 + SLACK):
        return false(f"the encoder needs a Coulomb friction of {asked:.12g}, there is {given:.12g}")
    return agrees()


def _fed(document: Document) -> Fed:
    return "position" if document["loop"]["unilateral"] else "both"


def _spring(document: Document, rng: Rng) -> Opinion:
    return passive(plain_loop(document["loop"], _fed(document)), rng)


def _linear(document: Document, rng: Rng) -> Opinion:
    loop = plain_loop(document["loop"], _fed(document))
    if loop.resolution:
        return false("an encoder with steps in a proof for an ideal one")
    return passive(loop, rng, kept=True)


def _quantized(document: Document, rng: Rng) -> Opinion:
    loop = plain_loop(document["loop"], _fed(document))
    return first(friction_covers(loop), passive(loop, rng, kept=True))


def _delays(document: Document, rng: Rng) -> Opinion:
    low, high = quantity(document["loop"], "delay"), exact(document["delay_high_s"])
    if high < low:
        return false("the interval of delays is empty")
    loop = plain_loop(document["loop"], _fed(document))
    inner = (low + Fraction(float(u)) * (high - low) for u in rng.random(3))
    for delay in (low, high, *inner):
        found = passive(replace(loop, delay=delay), rng, kept=True)
        if found.word != "agrees":
            return found._replace(why=f"at a delay of {float(delay):.9g} s: {found.why}")
    return friction_covers(loop)


def _contact(document: Document, rng: Rng) -> Opinion:
    loop = plain_loop(document["loop"], "position", clamped=bool(rng.random() < 0.5))
    return first(friction_covers(loop), passive(loop, rng), passive(replace(loop, clamped=False), rng))


def _relaxing(document: Document, rng: Rng) -> Opinion:
    law = document["law"]
    loop = plain_loop(document["loop"], law["fed_with"], clamped=law["never_pulls"])
    return first(friction_covers(loop), passive(loop, rng))


def _multiplier(document: Document, rng: Rng) -> Opinion:
    loop = plain_loop(document["loop"], "position", clamped=document["law"]["never_pulls"])
    return first(
        friction_covers(loop, parted=True), passive(replace(loop, clamped=False), rng), passive(loop, rng)
    )


def _slow_hands(document: Document, rng: Rng) -> Opinion:
    """What is enough for every hand is, and friction pays for what is missing at both ends of the speeds."""
    loop, enough = plain_loop(document["loop"], _fed(document)), document["enough"]
    damping, friction = quantity(enough, "damping"), quantity(enough, "coulomb_friction")
    speed = quantity(document, "largest_speed")
    for v in (Fraction(0), speed):
        if loop.friction + loop.damping * v < friction + damping * v:
            return false(f"at {float(v):.6g} the device loses less than what is enough")
    return passive(replace(loop, damping=damping, friction=friction), rng)


def _active_hand(document: Document, rng: Rng) -> Opinion:
    loop, activity = plain_loop(document["loop"], _fed(document)), quantity(document, "activity")
    if "reduced" in document["proof"]:
        return _less_damped(document["proof"]["reduced"], loop, activity, rng)
    b, a = float(loop.damping), float(activity)
    end = 2 * pi * float(exact(document["below_Hz"])) * float(loop.period)
    found = first(friction_covers(loop), passive(loop, rng, kept=True))
    if found.word != "agrees":
        return found
    for theta in np.concatenate([np.geomspace(1e-7 * end, end, 300), np.linspace(end / 50, end, 200)]):
        lost = 1 - (sin(theta / 2) / (theta / 2)) ** 2
        if b <= a * lost:
            return false(f"the hand alone gives out more than is damped at ωT = {theta:.6g}")
        allowed, asked = b * (b - a) / (b - a * lost), _needed(loop, theta)
        if asked > allowed + SLACK * (abs(allowed) + abs(asked) + b):
            return false(f"{asked:.9g} needed at ωT = {theta:.6g}, {allowed:.9g} left by the hand")
    return agrees()


def _needed(loop: PlainLoop, theta: float) -> float:
    late = complex(cos(theta), -sin(theta))
    top, bottom = (
        sum(float(c) * late**k for k, c in enumerate(s)) for s in (loop.numerator, loop.denominator)
    )
    h = top / bottom * late**loop.whole
    half = complex(cos(theta / 2), -sin(theta / 2))
    return -float(loop.period) / 2 * (half * h).imag / sin(theta / 2)


def _less_damped(reduced: Document, loop: PlainLoop, activity: Fraction, rng: Rng) -> Opinion:
    other = plain_loop(reduced["loop"], loop.fed)
    if replace(other, damping=other.damping + activity) != loop:
        return false("the loop that is proved is another one")
    return JUDGES[reduced["kind"]](reduced, rng)


def _violation(document: Document, rng: Rng) -> Opinion:
    loop, proof = plain_loop(document["loop"], _fed(document)), document["proof"]
    kind = proof["kind"]
    if kind == "criterion":
        return _violated_at(loop, exact(proof["cosine"]))
    if kind == "negative static stiffness":
        return agrees() if loop.static is not None and loop.static < 0 else false("H(1) is not negative")
    return _not_passive(loop)


def _violated_at(loop: PlainLoop, cosine: Fraction) -> Opinion:
    if abs(cosine) > 1:
        return false("no frequency has this cosine")
    if cosine == 1:
        asked = needed_at(loop, 1e-40, digits=250)  # nearer to 0 than any pole of a document is to 1
        if not sum(loop.denominator):  # what is asked for grows beyond any number
            return agrees() if asked > 0 else cannot_say("H(z) has a pole at the frequency 0")
        close = abs(float(asked.mid()) - float(loop.damping)) < 1e-6 * (float(loop.damping) + 1e-300)
        if close:
            return cannot_say("at the frequency 0 the limit is too close")
        return agrees() if asked > ball(loop.damping) else false("no violation near the frequency 0")
    with digits_of(120):
        theta = ball(cosine).acos()
        late = (acb(0, 1) * -theta).exp()
        below = abs(_exactly(loop.denominator, late))
        if below.contains(arb(0)):
            return cannot_say("a pole lies there")
        asked = _asked(loop, theta, late)
        if asked > ball(loop.damping):
            return agrees()
        return false(f"at cos ωT = {float(cosine):.9g} {float(asked.mid()):.9g} is needed, not more than b")


def _exactly(ascending: tuple[Fraction, ...], late: acb) -> acb:
    total = acb(0)
    for c in reversed(ascending):
        total = total * late + ball(c)
    return total


def _asked(loop: PlainLoop, theta: arb, late: acb) -> arb:
    """The damping that the criterion asks for, at an angle that is enclosed."""
    h = _exactly(loop.numerator, late) / _exactly(loop.denominator, late)
    part, period = ball(loop.part), ball(loop.period)
    mixed = (1 - late) * late**loop.whole * (1 - part + part * late) * h
    a = period / 2 * mixed.real / (1 - theta.cos())
    if not loop.part:
        return a
    return (a + (a * a + period**2 * part * (1 - part) * abs(h) ** 2).sqrt()) / 2


def _not_passive(loop: PlainLoop) -> Opinion:
    """An unstable environment: a pole that shows it, or with whole samples of delay any violation."""
    _, below = in_lowest_terms(list(loop.numerator), list(loop.denominator))
    sizes = [abs(pole) for pole, _ in poles_of(below)]
    if any(size > 1 for size in sizes) or (any(size.overlaps(arb(1)) for size in sizes) and loop.part):
        return agrees()
    if loop.part:
        return false("every pole of H(z) lies inside the unit circle")
    if unstable(loop) or criterion(loop):
        return agrees()
    asked = needed(loop)[0]
    if any(size.overlaps(arb(1)) for size in sizes) or asked > float(loop.damping) * (1 - CLOSE):
        return cannot_say("too close to the limit")
    return false(f"stable, H(1) ≥ 0, and the criterion asks for {asked:.9g} only")


JUDGES: dict[str, Callable[[Document, Rng], Opinion]] = {
    "spring": _spring,
    "linear": _linear,
    "quantized": _quantized,
    "delays": _delays,
    "contact": _contact,
    "relaxing contact": _relaxing,
    "multiplier contact": _multiplier,
    "slow hands": _slow_hands,
    "active hand": _active_hand,
    "violation": _violation,
}
