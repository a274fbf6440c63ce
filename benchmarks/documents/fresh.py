"""Documents written from nothing: small random loops and, in the right shape, a proof that they may not have.

The polynomials of a proof are multiplied out from the definition, whether they are positive or not.
"""

from __future__ import annotations

import copy
from collections.abc import Callable
from fractions import Fraction
from random import Random
from typing import Any

import numpy as np
from attack.referee import needed

from .fresh_held_pairs import FRESH_HELD_PAIRS
from .fresh_null_space import FRESH_NULL_SPACE
from .fresh_pairs import FRESH_PAIRS
from .judges.arms import Chain
from .judges.hands import held, radius
from .judges.motions import board_run, energy, kept_forces, taken_out, touched_forces, unrolled
from .plain import plain_loop, quantity
from .polynomials import (
    PERIODS,
    Document,
    Laurent,
    Polynomial,
    close,
    in_cosine,
    laurent_sum,
    laurent_times,
    over_one_less,
    plus,
    positivity,
    reciprocal,
    short,
    symmetric_in_cosine,
    texts,
    times,
)  # fmt: skip

Modes = list[tuple[Fraction, Fraction]]


def criterion(loop: Document, damping: Fraction | None = None) -> Polynomial:
    """q(c) of the loop, times b where the delay has a part of a sample."""
    above, below = ([Fraction(c) for c in loop[k]] for k in ("numerator", "denominator"))
    above = [Fraction(0)] * (len(below) - len(above)) + above
    b = quantity(loop, "damping") if damping is None else damping
    period = quantity(loop, "sample_period")
    late = quantity(loop, "delay") / period
    whole, part = int(late), late % 1
    moved = times([Fraction(1), Fraction(-1)], times([1 - part, part], above))
    hold = over_one_less(in_cosine([Fraction(0)] * whole + moved, below))
    q = plus([2 * b / period * c for c in in_cosine(below, below)], hold, -1)
    if not part:
        return q
    return plus([b * c for c in q], in_cosine(above, above), -period * part * (1 - part) / 2)


def loop_of(rng: Random, above: Polynomial, below: Polynomial, **given: Any) -> Document:
    """A device around a law, without friction and encoder, of some delay."""
    period = Fraction(rng.choice(PERIODS))
    delay = period * rng.choice((0, 0, 0, 1, 2, Fraction(1, 2), Fraction(rng.randint(1, 39), 20)))
    return {
        "damping_N_s_per_m": "1",
        "coulomb_friction_N": "0",
        "resolution_m": "0",
        "sample_period_s": str(period),
        "delay_s": str(delay),
        "numerator": texts(above),
        "denominator": texts(below),
        "unilateral": rng.random() < 0.5,
        **given,
    }


def damp(rng: Random, loop: Document) -> None:
    """Give it nearly the damping that the criterion asks for."""
    asked = needed(plain_loop(loop))[0]
    finite = asked if 0 < asked < 1e300 else 0.1
    loop["damping_N_s_per_m"] = str(close(rng, Fraction(f"{finite:.12g}")))


def law(rng: Random) -> tuple[Polynomial, Polynomial, Modes, Polynomial]:
    """N, D ascending in 1/z, and the modes and the rest that sum up to it."""
    poles = [Fraction(rng.randint(-9, 9), 10) for _ in range(rng.randint(0, 2))]
    return law_of_poles(rng, poles, rng.randint(0, 2))


def law_of_poles(
    rng: Random, poles: list[Fraction], more: int
) -> tuple[Polynomial, Polynomial, Modes, Polynomial]:
    """The same of given poles, its rest of so many terms and one."""
    modes = [(pole, short(rng, 1, 100) * rng.choice((-1, 1))) for pole in poles]
    rest = [short(rng, 10, 500), *(short(rng, 1, 200) * rng.choice((-1, 1)) for _ in range(more))]
    above, below = rest, [Fraction(1)]
    for pole, residue in modes:
        line = [Fraction(1), -pole]
        above, below = plus(times(above, line), [residue * c for c in below]), times(below, line)
    size = max(len(above), len(below))
    above, below = (s + [Fraction(0)] * (size - len(s)) for s in (above, below))
    return above, below, modes, rest


def _spring(rng: Random) -> Document:
    k = short(rng, 10, 1000)
    loop = loop_of(rng, [k], [Fraction(1)])
    damp(rng, loop)
    if rng.random() < 0.6:
        step = short(rng, 1e-6, 1e-3)
        loop |= {"resolution_m": str(step), "coulomb_friction_N": str(close(rng, k * step / 2))}
    return {"kind": "spring", "loop": loop}


def _stability(rng: Random) -> Document:
    if rng.random() < 0.8:
        return {"kind": "open loop"}
    return {"kind": "closed loop", "offset": str(short(rng, 1e-3, 10))}


def _linear(rng: Random) -> Document:
    above, below, _, _ = law(rng)
    if rng.random() < 0.1:
        below = times(below, [Fraction(1), Fraction(rng.choice((-1, 1)))])[: len(below)]
    loop = loop_of(rng, above, below)
    damp(rng, loop)
    proof = {"stability": _stability(rng), "positivity": positivity(criterion(loop))}
    return {"kind": "linear", "loop": loop, "proof": proof}


def norm(rng: Random, modes: Modes, rest: Polynomial) -> tuple[Document, Fraction]:
    """A bound on ‖h‖₁ by modes and a rest, and the bound."""
    bound = sum((abs(r) / (1 - abs(p)) for p, r in modes), Fraction(0)) + sum(map(abs, rest), Fraction(0))
    found = {
        "modes": [{"pole": str(p), "residue": str(r)} for p, r in modes],
        "rest_numerator": texts(rest),
        "rest_denominator": ["1"],
        "inverse": ["1"],
    }
    return found, bound


def _quantized(rng: Random) -> Document:
    above, below, modes, rest = law(rng)
    loop = loop_of(rng, above, below)
    damp(rng, loop)
    found, bound = norm(rng, modes, rest)
    step = short(rng, 1e-6, 1e-3)
    loop |= {"resolution_m": str(step), "coulomb_friction_N": str(close(rng, bound * step / 2))}
    proof = {"stability": _stability(rng), "positivity": positivity(criterion(loop)), "norm": found}
    return {"kind": "quantized", "loop": loop, "proof": proof}


def _delays(rng: Random) -> Document:
    """Any number of pieces, none too, between any two delays."""
    above, below, _, _ = law(rng)
    loop = loop_of(rng, above, below)
    damp(rng, loop)
    period = quantity(loop, "sample_period")
    low = quantity(loop, "delay") / period
    whole = int(low)
    ends = sorted({low, *(whole + Fraction(rng.randint(0, 20), 20) for _ in range(rng.randint(0, 2)))})
    ends = [e for e in ends if e >= low]
    pieces = [_piece(loop, a, b, period) for a, b in zip(ends, ends[1:], strict=False)]
    proof = {"stability": {"kind": "open loop"}, "pieces": pieces}
    return {"kind": "delays", "loop": loop, "delay_high_s": str(ends[-1] * period), "proof": proof}


def _piece(loop: Document, low: Fraction, high: Fraction, period: Fraction) -> Document:
    """Both ends with the tangent of α(1 − α) at the middle."""
    whole, out = low // 1, {"low": str(low), "high": str(high)}
    middle = (low + high) / 2 - whole
    for name, end in (("at_low", low), ("at_high", high)):
        part = end - whole
        share = middle * (1 - middle) + (1 - 2 * middle) * (part - middle)
        out[name] = positivity(_bounded(loop, int(whole), part, share, period))  # type: ignore[assignment]
    return out


def _bounded(loop: Document, whole: int, part: Fraction, share: Fraction, period: Fraction) -> Polynomial:
    above, below = ([Fraction(c) for c in loop[k]] for k in ("numerator", "denominator"))
    b = quantity(loop, "damping")
    moved = times([Fraction(1), Fraction(-1)], times([1 - part, part], above))
    hold = over_one_less(in_cosine([Fraction(0)] * whole + moved, below))
    q = plus([2 * b * b / period * c for c in in_cosine(below, below)], hold, -b)
    return plus(q, in_cosine(above, above), -period * share / 2)


def _weights(rng: Random) -> Any:
    """Of the speed: a pole, or a list."""
    if rng.random() < 0.5:
        return {"pole": str(Fraction(rng.randint(0, 9), 10))}
    return texts([Fraction(rng.randint(-3, 5), 4) for _ in range(rng.randint(1, 3))])


def _contact(rng: Random) -> Document:
    """K + B W(ζ) (1 − ζ)/T near both bounds."""
    return _contact_of(rng, _weights(rng), Fraction(rng.choice(PERIODS)))


def _contact_of(rng: Random, weights: Any, period: Fraction) -> Document:
    k, b = short(rng, 10, 500), short(rng, 0.01, 1) * rng.choice((1, 1, -1))
    if isinstance(weights, dict):
        pole = Fraction(weights["pole"])
        top, bottom, gain, variation = [1 - pole], [Fraction(1), -pole], Fraction(1), 2 * (1 - pole)
    else:
        top = [Fraction(w) for w in weights]
        bottom, gain = [Fraction(1)], sum(map(abs, top), Fraction(0))
        variation = sum(map(abs, times(top, [Fraction(1), Fraction(-1)])), Fraction(0))
    above = plus(times(top, [b / period, -b / period]), bottom, k)
    size = max(len(above), len(bottom))
    above, bottom = (s + [Fraction(0)] * (size - len(s)) for s in (above, bottom))
    whole, step = rng.choice((0, 0, 1, 2)), short(rng, 1e-6, 1e-3)
    loop = loop_of(
        rng, above, bottom, unilateral=True, sample_period_s=str(period), delay_s=str(whole * period),
        resolution_m=str(step),
        coulomb_friction_N=str(close(rng, (k + abs(b) * variation / period) * step / 2)),
        damping_N_s_per_m=str(close(rng, (2 * whole + 1) * k * period / 2 + abs(b) * gain)),
    )  # fmt: skip
    told = {"stiffness_N_per_m": str(k), "virtual_damping_N_s_per_m": str(b), "weights": weights}
    return {"kind": "contact", "loop": loop, "law": told}


def family(rng: Random) -> list[Document]:
    """Corners around one device, of one denominator, one of them near its limit."""
    kind, number = rng.choice(("spring", "linear", "quantized", "contact")), rng.randint(2, 4)
    if kind == "contact":
        weights, period = _weights(rng), Fraction(rng.choice(PERIODS))
        corners = [_contact_of(rng, weights, period) for _ in range(number)]
    else:
        poles = [
            Fraction(rng.randint(-9, 9), 10) for _ in range(rng.randint(0, 2) if kind != "spring" else 0)
        ]
        more = rng.randint(0, 2)
        corners = [_corner(rng, kind, poles, more) for _ in range(number)]
    most = {key: max((corner["loop"][key] for corner in corners), key=Fraction) for key in _LOSSES}
    shared = {"delay_s", "sample_period_s", "resolution_m", "unilateral"}
    for corner in corners:
        corner["loop"] |= {**{key: corners[0]["loop"][key] for key in shared}, **most}
        if kind in ("linear", "quantized"):
            corner["proof"]["positivity"] = positivity(criterion(corner["loop"]))
    return corners


_LOSSES = ("damping_N_s_per_m", "coulomb_friction_N")


def _corner(rng: Random, kind: str, poles: list[Fraction], more: int) -> Document:
    """A proof with a law of these poles, the device its own."""
    above, below, modes, rest = law_of_poles(rng, poles, more)
    if kind == "spring":
        above, below, rest = rest[:1], [Fraction(1)], rest[:1]
    loop = loop_of(rng, above, below)
    damp(rng, loop)
    document: Document = {"format": "zwidth certificate 1", "kind": kind, "loop": loop}
    if kind != "linear":
        found, bound = norm(rng, modes, rest)
        loop |= {"resolution_m": "0.0001", "coulomb_friction_N": str(close(rng, bound / 20000))}
    if kind != "spring":
        document["proof"] = {"stability": {"kind": "open loop"}, "positivity": {}}
    if kind == "quantized":
        document["proof"]["norm"] = found
    return document


def _relaxing(rng: Random) -> Document:
    """Parts of either sign, near what either theorem asks for."""
    k = short(rng, 1, 500)
    parts = [
        (Fraction(rng.randint(-9, 9), 10), short(rng, 1, 300) * rng.choice((1, 1, 1, -1)))
        for _ in range(rng.randint(1, 2))
    ]
    above, below = [k], [Fraction(1)]
    for pole, g in parts:
        line = [Fraction(1), -pole]
        above, below = plus(times(above, line), times(below, [g, -g])), times(below, line)
    period, whole = Fraction(rng.choice(PERIODS)), rng.choice((0, 0, 0, 1))
    far = rng.random() < 0.5
    moved = sum((abs(g) / (1 - abs(p)) if far else g / (1 + p) for p, g in parts), Fraction(0))
    step = short(rng, 1e-6, 1e-3)
    friction = (k + sum((2 * abs(g) / (1 + min(p, Fraction(0))) for p, g in parts), Fraction(0))) * step / 2
    loop = loop_of(
        rng, above, below, unilateral=True, sample_period_s=str(period), delay_s=str(whole * period),
        resolution_m=str(step), coulomb_friction_N=str(close(rng, friction)),
        damping_N_s_per_m=str(abs(close(rng, period * ((2 * whole + 1) * k / 2 + moved)))),
    )  # fmt: skip
    told = {
        "stiffness_N_per_m": str(k),
        "parts": [{"pole": str(p), "stiffness_N_per_m": str(g)} for p, g in parts],
        "fed_with": rng.choice(("penetration", "position")),
        "never_pulls": rng.random() < 0.5,
    }
    return {"kind": "relaxing contact", "loop": loop, "law": told}


def _multiplier(rng: Random) -> Document:
    """4 λ κ |D|² − |D − λ ζ^{d+1} N_G|² of one pole, at a random λ, its sign as it comes."""
    k, g, pole = (
        short(rng, 1, 50),
        short(rng, 1, 300) * rng.choice((1, 1, -1)),
        Fraction(rng.randint(-9, 9), 10),
    )
    above, below = [k + g, -k * pole - g], [Fraction(1), -pole]
    period, whole = Fraction(rng.choice(PERIODS)), rng.choice((0, 0, 1))
    damping = period * ((2 * whole + 1) * k / 2 + abs(g) * Fraction(rng.randint(10, 300), 100))
    left = damping / period - (2 * whole + 1) * k / 2
    multiplier = short(rng, 0.1, 10) / (2 * left)
    moved = [Fraction(0)] * (whole + 1) + [multiplier * g]
    gap = plus(below, moved, -1)
    q = plus([4 * multiplier * left * c for c in in_cosine(below, below)], in_cosine(gap, gap), -1)
    loop = loop_of(
        rng, above, below, unilateral=True, sample_period_s=str(period), delay_s=str(whole * period),
        damping_N_s_per_m=str(damping),
    )  # fmt: skip
    told = {"fed_with": "position", "never_pulls": rng.random() < 0.5}
    return {
        "kind": "multiplier contact",
        "loop": loop,
        "law": told,
        "proof": {"multiplier": str(multiplier), "positivity": positivity(q)},
    }


def _points(rng: Random, ends: bool) -> list[tuple[Fraction, Fraction]]:
    x, points = -short(rng, 0.001, 0.1), []
    for _ in range(rng.randint(2, 5)):
        points.append((x, short(rng, 0.01, 5) * rng.choice((-1, 1))))
        x += short(rng, 0.001, 0.1)
    if ends:
        points[0] = (points[0][0], -abs(points[0][1]))
        points[-1] = (points[-1][0], abs(points[-1][1]))
    return points


def _device(rng: Random, period: Fraction, **numbers: Fraction) -> Document:
    units = {"damping": "N_s_per_m", "coulomb_friction": "N", "resolution": "m", "delay": "s"}
    return {
        **{f"{n}_{u}": str(numbers.get(n, Fraction(0))) for n, u in units.items()},
        "sample_period_s": str(period),
    }


def _nonlinear(rng: Random) -> Document:
    points, period, whole = (
        _points(rng, rng.random() < 0.9),
        Fraction(rng.choice(PERIODS)),
        rng.choice((0, 0, 1, 2)),
    )
    slopes = [(f1 - f0) / (x1 - x0) for (x0, f0), (x1, f1) in zip(points, points[1:], strict=False)]
    largest, steepest = max(0, *slopes), max(map(abs, slopes))
    step = short(rng, 1e-6, 1e-3)
    loop = _device(
        rng, period, delay=whole * period, resolution=step,
        damping=close(rng, (largest / 2 + whole * steepest) * period),
        coulomb_friction=close(rng, steepest * step / 2),
    )  # fmt: skip
    return {"kind": "nonlinear spring", "loop": loop, "law": {"points_m_N": [texts(p) for p in points]}}


def _pull(rng: Random) -> Document:
    points = _points(rng, False)
    pull = max(points[0][1], -points[-1][1], Fraction(1, 100))
    loop = _device(rng, Fraction(1, 1000), damping=short(rng, 0.01, 1), coulomb_friction=close(rng, pull))
    return {"kind": "endless pull", "loop": loop, "law": {"points_m_N": [texts(p) for p in points]}}


def _slow(rng: Random) -> Document:
    document = _spring(rng)
    loop, speed = document["loop"], short(rng, 0.01, 1)
    enough = {"kind": "spring", **{k: loop[k] for k in ("damping_N_s_per_m", "coulomb_friction_N")}}
    damping, friction = (quantity(loop, n) for n in ("damping", "coulomb_friction"))
    less = damping * Fraction(rng.randint(1, 99), 100)
    loop["damping_N_s_per_m"] = str(damping - less)
    loop["coulomb_friction_N"] = str(friction + close(rng, less * speed))
    return {"kind": "slow hands", "loop": loop, "enough": enough, "largest_speed_m_per_s": str(speed)}


def _bounding(rng: Random) -> Document:
    period, b, fc, step, rounded = (
        Fraction(rng.choice(PERIODS)), short(rng, 0.01, 1), short(rng, 0.01, 1), short(rng, 1e-6, 1e-3),
        short(rng, 1e-4, 0.1),
    )  # fmt: skip
    loop = {
        **_device(rng, period, damping=b, coulomb_friction=fc, resolution=step),
        "force_resolution_N": str(rounded),
    }
    u = Fraction(1, 2**53)
    told = {
        "credit_N_per_m": str(close(rng, b / period)),
        "friction_N": str(close(rng, fc / (1 + u))),
        "count_m": str(close(rng, step)),
        "half_step_N": str(close(rng, rounded / 2)),
        "hair": str(u * rng.choice((32, 16, 12, 10, 9, 8, 1))),
        "roundoff": str(u),
    }
    return {"kind": "force bounding", "loop": loop, "law": told}


def _active(rng: Random) -> Document:
    """In a band, or everywhere, nearly as active as it may be."""
    above, below, _, _ = law(rng)
    period = Fraction(rng.choice(PERIODS))
    loop = loop_of(
        rng, above, below, delay_s=str(period * rng.choice((0, 0, 1))), sample_period_s=str(period)
    )
    damp(rng, loop)
    b = quantity(loop, "damping") * (1 + Fraction(rng.randint(0, 100), 100))
    loop["damping_N_s_per_m"] = str(b)
    activity = (
        close(rng, b - quantity(loop, "damping"))
        if rng.random() < 0.3
        else b * Fraction(rng.randint(1, 130), 100)
    )
    if rng.random() < 0.4:
        reduced = {**loop, "damping_N_s_per_m": str(b - activity)}
        inner = {"kind": "linear", "loop": reduced, "proof": {"stability": {"kind": "open loop"}}}
        inner["proof"]["positivity"] = positivity(criterion(reduced))  # type: ignore[index]
        return {
            "kind": "active hand",
            "loop": loop,
            "activity_N_s_per_m": str(activity),
            "proof": {"reduced": inner},
        }
    angle = Fraction(rng.randint(1, 300), 100)
    cosine = Fraction(f"{np.cos(float(angle)) - 1e-9:.12f}")
    below_hz = Fraction(f"{float(angle / period) / 6.283185307179587 * (1 - 1e-9):.9g}")
    rest = b - activity * angle**2 / 12
    inside = b - activity if activity <= b or not rest else b * (b - activity) / rest
    proof = {
        "stability": {"kind": "open loop"},
        "positivity": positivity(criterion(loop)),
        "angle": str(angle),
        "cosine": str(cosine),
        "in_band": positivity(_moved(criterion(loop, inside), cosine)),
    }
    return {
        "kind": "active hand",
        "loop": loop,
        "activity_N_s_per_m": str(activity),
        "below_Hz": str(below_hz),
        "proof": proof,
    }


def _moved(q: Polynomial, low: Fraction) -> Polynomial:
    """q on [low, 1] as a polynomial on [−1, 1]."""
    line, total = [(1 + low) / 2, (1 - low) / 2], [Fraction(0)]
    for c in reversed(q):
        total = plus(times(total, line), [c])
    return total


def _violation(rng: Random) -> Document:
    above, below, _, _ = law(rng)
    if rng.random() < 0.3:
        pole = 1 + Fraction(rng.randint(-9, 9), 10 ** rng.randint(1, 9))
        above, below = ([*side, Fraction(0)] for side in (above, below))
        below = times(below[:-1], [Fraction(1), -pole * rng.choice((-1, 1))])
    loop = loop_of(rng, above, below)
    damp(rng, loop)
    kind = rng.choice(("criterion", "criterion", "negative static stiffness", "unstable environment"))
    proof: Document = {"kind": kind}
    if kind == "criterion":
        angle = needed(plain_loop(loop))[1] if rng.random() < 0.7 else rng.uniform(0, 3.14159)
        proof["cosine"] = str(Fraction(f"{np.cos(angle):.9f}"))
    elif kind == "unstable environment" and not quantity(loop, "delay") % quantity(loop, "sample_period"):
        proof["offset"] = str(short(rng, 1e-3, 100))
    return {"kind": "violation", "loop": loop, "proof": proof}


def _motion(rng: Random) -> Document:
    """To and fro by a little, its own energy told."""
    above, below, _, _ = law(rng) if rng.random() < 0.5 else ([short(rng, 10, 2000)], [Fraction(1)], [], [])
    loop = loop_of(rng, above, below)
    damp(rng, loop)
    if rng.random() < 0.5:
        loop["damping_N_s_per_m"] = str(quantity(loop, "damping") * Fraction(rng.randint(1, 20), 20))
    if rng.random() < 0.4:
        loop["resolution_m"] = str(short(rng, 1e-5, 1e-3, 1))
    unit = quantity(loop, "resolution") or Fraction(1, 1000)
    size = rng.randint(2, 7)
    loop["unilateral"] = loop["unilateral"] and len(above) == 1  # a law with memory must not be left
    x = [
        Fraction(0),
        *(unit * (rng.randint(1, 4) - Fraction(1, rng.choice((1, 10**6)))) for _ in range(size)),
        Fraction(0),
    ]
    document: Document = {"kind": "motion", "loop": loop, "positions_m": texts(x)}
    late = quantity(loop, "delay") / quantity(loop, "sample_period") % 1
    y = (
        [a + (b - a) * Fraction(rng.randint(-2, 12), 10) for a, b in zip(x, x[1:], strict=False)]
        if late
        else None
    )
    if y is not None:
        document["switch_positions_m"] = texts(y)
    parts = []
    if rng.random() < 0.6:
        last = rng.randint(2, size)
        parts = [(1, last, rng.randint(1, 40))]
        document["repeats"] = [dict(zip(("first", "last", "times"), parts[0], strict=True))]
    out = energy(loop, x, y, parts, lambda motion: kept_forces(loop, motion))
    value = float(out.mid()) if hasattr(out, "mid") else float(out)
    document["energy_J"] = repr(value) if hasattr(out, "mid") else str(Fraction(out))
    return document


def _vibration(rng: Random) -> Document:
    poles = [Fraction(rng.randint(-12, 12), 10) for _ in range(rng.randint(1, 3))]
    below = [Fraction(1)]
    for p in poles:
        below = times(below, [Fraction(1), -p])
    above = [Fraction(rng.randint(-20, 20), 10) for _ in poles]
    plant = {"numerator": texts(above), "denominator": texts(below)}
    inside = [rng.random() < 0.5 for _ in range(rng.randint(2, 8))]
    return {
        "kind": "vibration",
        "plant": plant,
        "slope": str(short(rng, 0.1, 10)),
        "gap": str(rng.choice((-1, 1)) * short(rng, 0.1, 2)),
        "inside": inside,
    }


def _absolute(rng: Random) -> Document:
    above = [Fraction(rng.randint(-20, 20), 10), Fraction(rng.randint(-9, 9), 10)]
    first, second = (Fraction(rng.randint(-9, 9), 10) for _ in range(2))
    below = times([Fraction(1), -first], [Fraction(1), -second])
    taps = [
        {"place": p, "weight": str(Fraction(rng.randint(-3, 9), 20))}
        for p in rng.sample((-2, -1, 1, 2), rng.randint(0, 2))
    ]
    return {
        "kind": "absolute stability",
        "plant": {"numerator": texts(above), "denominator": texts(below)},
        "nonlinearity": rng.choice(("monotone", "odd monotone")),
        "slope": str(short(rng, 0.05, 5)),
        "center": "1",
        "taps": taps,
        "convexity": str(rng.choice((0, 0, short(rng, 0.1, 2)))),
        "smoothness": str(rng.choice((0, 0, short(rng, 0.1, 2)))),
    }


def _known_hand(rng: Random) -> Document:
    """A law nearly as strong as the hand allows, some numbers within intervals."""
    above, below, _, _ = law(rng)
    period, late = Fraction(1, 1000), Fraction(rng.choice((0, 0, 1, 2, 3, rng.randint(1, 60))), 20)
    mass, damping, stiffness = short(rng, 0.01, 1), short(rng, 0.1, 10), short(rng, 10, 1000)
    plant = held(float(mass), float(damping), float(stiffness), float(period), float(late * period))
    n, d = (np.array([float(c) for c in side]) for side in (above, below))
    low, high = 1e-3, 1e6
    for _ in range(24):
        middle = (low * high) ** 0.5
        low, high = (middle, high) if radius(plant, middle * n, d) < 1 else (low, middle)
    scale = abs(close(rng, Fraction(f"{low:.9g}")))
    loop: Document = {
        "mass_kg": str(mass), "damping_N_s_per_m": str(damping), "stiffness_N_per_m": str(stiffness),
        "sample_period_s": str(period), "delay_s": str(late * period),
        "numerator": texts([scale * c for c in above]), "denominator": texts(below),
    }  # fmt: skip
    kind = rng.choice(("stability", "instability"))
    if kind == "stability" and rng.random() < 0.3:
        key = rng.choice(("mass_kg", "damping_N_s_per_m", "stiffness_N_per_m"))
        loop[key] = [loop[key], str(Fraction(loop[key]) * Fraction(rng.randint(101, 150), 100))]
    return {"kind": kind, "loop": loop}


def _positive_real(rng: Random) -> Document:
    """Re F − σ of a small port at a level near its least, its roots where they may be."""
    above, below = ([Fraction(rng.randint(-30, 60), 10) for _ in range(rng.randint(1, 3))] for _ in range(2))
    below += [Fraction(rng.randint(1, 30), 10)] * max(0, len(above) - len(below))
    n, d = above[::-1], below[::-1]  # ascending in s or z
    continuous = rng.random() < 0.5
    z = 1j * np.geomspace(1e-3, 1e3, 60) if continuous else np.exp(1j * np.linspace(0, np.pi, 60))
    top, bottom = (np.polyval([float(c) for c in side], z) for side in (above, below))
    usable = bottom != 0
    least = float((top[usable] / bottom[usable]).real.min(initial=1e9))
    level = close(rng, Fraction(f"{least:.6g}"))
    m = plus(n, d, -level)
    order = max(len(n), len(d)) - 1
    q = _on_axis(m, d, order) if continuous else in_cosine(m, d)
    return {
        "kind": "positive real",
        "system": {
            "time": "continuous" if continuous else "discrete",
            "numerator": texts(above),
            "denominator": texts(below),
        },
        "index": "input",
        "level": str(level),
        "proof": {"offset": str(short(rng, 0.01, 10)), "positivity": positivity(q)},
    }


def _on_axis(m: Polynomial, d: Polynomial, order: int) -> Polynomial:
    """Re(M D̄) at s = j tan θ/2, times (1 + c)ⁿ; tan² θ/2 = (1 − c)/(1 + c)."""
    total = [Fraction(0)] * (order + 1)
    for i, x in enumerate(m):
        for j, y in enumerate(d):
            if (i - j) % 2 == 0:
                term, power = x * y * (-1) ** ((i - j) // 2), (i + j) // 2
                factor = [Fraction(1)]
                for k in range(order):
                    factor = times(factor, [Fraction(1), Fraction(-1 if k < power else 1)])
                total = plus(total, factor, term)
    return total


def _extraction(rng: Random) -> Document:
    document = _positive_real(rng)
    del document["proof"]
    document["system"]["time"] = "discrete"
    latent = [Fraction(rng.randint(-3, 3)) for _ in range(rng.randint(1, 12))]
    return {**document, "kind": "extraction", "motion": {"kind": "sequence", "latent": texts(latent)}}


def _row_motion(rng: Random) -> Document:
    loop = _device(
        rng,
        Fraction(1, 1000),
        damping=short(rng, 0.01, 1),
        coulomb_friction=short(rng, 1e-3, 0.1),
        resolution=Fraction(1, 10**4),
    )
    x = [Fraction(rng.randint(-3, 30), 10**5) for _ in range(rng.randint(2, 5))]
    x.append(x[0])
    forces = [short(rng, 1e-3, 1) * rng.choice((-1, 1)) for _ in x[1:]]
    b, fc = (quantity(loop, n) for n in ("damping", "coulomb_friction"))
    moves = [b - a for a, b in zip(x, x[1:], strict=False)]
    gain = -sum(f * d + fc * abs(d) + b * 1000 * d * d for f, d in zip(forces, moves, strict=True))
    rounds = rng.randint(1, 9)
    return {
        "kind": "row motion",
        "loop": loop,
        "law": {"description": "a row", "counts_force_limit": False, "counts_force_resolution": False},
        "sample_period_s": "0.001",
        "energy_J": str(close(rng, gain * rounds)),
        "positions_m": texts(x),
        "forces_N": texts(forces),
        "repeats": {"first": 0, "last": len(x) - 1, "times": rounds},
    }


def _laurent(a: Polynomial) -> Laurent:
    return dict(enumerate(a))


def _matrix_port(rng: Random) -> Document:
    """Two axes in discrete time near the least eigenvalue, minors and resolvent multiplied out."""
    below = [Fraction(1), Fraction(rng.randint(-9, 9), 10)]
    rows = [
        [
            [Fraction(rng.randint(-9, 9), 10) + (3 if i == j and not k else 0) for k in range(2)]
            for j in range(2)
        ]
        for i in range(2)
    ]
    z = np.exp(1j * np.linspace(0, np.pi, 80))
    g = np.array([[np.polyval([float(c) for c in q], z) for q in row] for row in rows])
    g = np.moveaxis(g / np.polyval([float(c) for c in below], z), 2, 0)
    least = np.linalg.eigvalsh((g + np.conj(np.swapaxes(g, 1, 2))) / 2)[:, 0].min()
    level = close(rng, Fraction(f"{least:.9g}"))
    half = Fraction(1, 2)
    d, n = _laurent(below[::-1]), [[_laurent(q[::-1]) for q in row] for row in rows]
    size = laurent_times(reciprocal(d), d)
    p = [
        [
            laurent_sum(
                (half, laurent_times(reciprocal(d), n[i][j])),
                (half, laurent_times(reciprocal(n[j][i]), d)),
                (-level if i == j else Fraction(0), size),
            )
            for j in range(2)
        ]
        for i in range(2)
    ]
    trace = laurent_sum((Fraction(1), p[0][0]), (Fraction(1), p[1][1]))
    determinant = laurent_sum(
        (Fraction(1), laurent_times(p[0][0], p[1][1])), (Fraction(-1), laurent_times(p[0][1], p[1][0]))
    )
    offset = short(rng, 0.1, 10)
    m = [
        [plus(rows[i][j], below, offset - level) if i == j else rows[i][j] for j in range(2)]
        for i in range(2)
    ]
    whole = plus(times(m[0][0], m[1][1]), times(m[0][1], m[1][0]), -1)
    minus = [[[-c for c in q] for q in row] for row in m]
    resolvent = [[m[1][1], minus[0][1]], [minus[1][0], m[0][0]]]
    return {
        "kind": "positive real matrix",
        "system": {
            "time": "discrete",
            "numerators": [[texts(q) for q in row] for row in rows],
            "denominator": texts(below),
        },
        "index": "input",
        "level": str(level),
        "proof": {
            "offset": str(offset),
            "minors": [
                {"power": 0, "positivity": positivity(symmetric_in_cosine(e))} for e in (trace, determinant)
            ],
            "resolvent": {
                "numerators": [[texts(times(below, q)) for q in row] for row in resolvent],
                "denominator": texts(whole),
            },
        },
    }


def _matrix_extraction(rng: Random) -> Document:
    document = _matrix_port(rng)
    del document["proof"]
    size = rng.randint(1, 8)
    latent = [[str(rng.randint(-3, 3)) for _ in range(size)] for _ in range(2)]
    return {**document, "kind": "matrix extraction", "motion": {"kind": "sequence", "latent": latent}}


def _touching(rng: Random) -> Document:
    """A run-up from outside, a touch, and back: its own energy told, or nearly."""
    above, below, _, _ = law(rng)
    loop = loop_of(rng, above, below, unilateral=True)
    damp(rng, loop)
    loop["damping_N_s_per_m"] = str(quantity(loop, "damping") * Fraction(rng.randint(1, 30), 20))
    unit = Fraction(1, 1000)
    x = [unit * Fraction(rng.randint(-40, 8), 4) for _ in range(rng.randint(3, 9))]
    x = [min(x[0], Fraction(0)), *x[1:], min(x[0], Fraction(0))]
    told = {"fed_with": rng.choice(("penetration", "position")), "never_pulls": rng.random() < 0.5}
    document: Document = {"kind": "touching motion", "loop": loop, "law": told, "positions_m": texts(x)}
    late = quantity(loop, "delay") / quantity(loop, "sample_period") % 1
    y = (
        [a + (b - a) * Fraction(rng.randint(-2, 12), 10) for a, b in zip(x, x[1:], strict=False)]
        if late
        else None
    )
    if y is not None:
        document["switch_positions_m"] = texts(y)
    out = taken_out(loop, x, y, touched_forces(loop, told["fed_with"], told["never_pulls"], x))
    return {**document, "sample_period_s": loop["sample_period_s"], "energy_J": _told(rng, out)}


def _told(rng: Random, energy_out: Any) -> str:
    value = Fraction(float(energy_out.mid())) if hasattr(energy_out, "mid") else Fraction(energy_out)
    return str(close(rng, value) if rng.random() < 0.2 else value)


def _contact_motion(rng: Random) -> Document:
    """In, a short round some times, its own energy told."""
    count, period = Fraction(1, 10**4), Fraction(1, 1000)
    k = short(rng, 50, 1000)
    taps = [k, *(short(rng, 1, 300) * rng.choice((-1, 1)) for _ in range(rng.randint(0, 2)))]
    law_told: Document = {
        "surface": rng.choice(("position", "penetration")), "clamped": rng.random() < 0.5,
        "taps_N_per_m": texts(taps),
    }  # fmt: skip
    if rng.random() < 0.3:
        law_told["force_limit_N"] = str(short(rng, 0.01, 0.3))
    if rng.random() < 0.3:
        law_told["force_step_N"] = str(short(rng, 0.001, 0.1))
    late = rng.choice((0, 0, 1, Fraction(2, 5)))
    b, fc = close(rng, k * period / 2) * Fraction(rng.randint(2, 22), 20), close(rng, k * count / 2)
    loop = _device(rng, period, damping=b, coulomb_friction=fc, resolution=count, delay=late * period)
    tiny = Fraction(1, 10 ** rng.randint(1, 9))
    x = [count * (rng.randint(0, 6) - rng.choice((0, tiny))) for _ in range(rng.randint(2, 5))]
    x = [-count * tiny, *x, x[0]]
    part = late - -(-late // 1) + 1
    y = [a + (b - a) * (part + Fraction(rng.randint(-2, 2), 10)) for a, b in zip(x, x[1:], strict=False)]
    rounds = rng.randint(5, 12)
    motion, places = unrolled(x, [(1, len(x) - 1, rounds)])
    turns = [y[at] + motion[i] - x[at] for i, at in enumerate(places)] if part < 1 else motion[1:]
    taken = board_run(loop, law_told, motion, turns, int(-(-late // 1)), part) or [Fraction(0)]
    document: Document = {
        "kind": "contact motion", "loop": loop, "law": law_told, "sample_period_s": str(period),
        "energy_J": _told(rng, sum(taken, Fraction(0))), "positions_m": texts(x),
        "repeats": {"first": 1, "last": len(x) - 1, "times": rounds},
    }  # fmt: skip
    return {**document, "switch_positions_m": texts(y)} if part < 1 else document


def _shared(rng: Random, joints: list[Document]) -> list[list[str]]:
    """In the place of the joints' own damping a matrix, each coupling less than what leaves it positive."""
    keys = [next(key for key in joint if key.startswith("damping")) for joint in joints]
    own = [Fraction(joint.pop(key)) for joint, key in zip(joints, keys, strict=True)]
    rows = [[b if i == k else Fraction(0) for k in range(len(own))] for i, b in enumerate(own)]
    for i, a in enumerate(own):
        for k, b in enumerate(own[:i]):
            rows[i][k] = rows[k][i] = Fraction(rng.randint(-45, 45), 100) * min(a, b)
    return [texts(row) for row in rows]


def _arm(rng: Random) -> Document:
    """Two or three joints of any placement, the wall nearly as stiff as some places allow."""
    joints = []
    for _ in range(rng.randint(2, 3)):
        slides = rng.random() < 0.2
        unit, per = ("m", "N_s_per_m") if slides else ("rad", "N_m_s_per_rad")
        turn = rng.choice(TURNS)
        low = Fraction(rng.randint(-20, 20), 100 if slides else 10)
        joints.append({
            "kind": "prismatic" if slides else "revolute", "rotation": turn,
            "translation_m": texts([Fraction(rng.randint(-15, 15), 100) for _ in range(3)]),
            f"low_{unit}": str(low),
            f"high_{unit}": str(low + Fraction(rng.randint(1, 6), 20)),
            f"damping_{per}": str(short(rng, 1, 9) if slides else short(rng, 0.01, 0.2)),
        })  # fmt: skip
    machine = {
        "geometry": "chain",
        "joints": joints,
        "end_m": texts([Fraction(rng.randint(1, 15), 100) for _ in range(3)]),
    }
    if rng.random() < 0.5:
        machine |= {"damping_N_m_s_rad": _shared(rng, joints)}
    size, chain = rng.randint(1, 3), Chain(machine)
    most, places = np.inf, np.random.default_rng(rng.randrange(2**31))
    for k in range(16):
        share = places.integers(0, 2, len(joints)) if k < 8 else places.random(len(joints))
        j = chain.jacobian(chain.low + share * (chain.high - chain.low), lambda q: chain.placed(q)[0][:size])
        load = np.linalg.eigvalsh(j @ np.linalg.inv(chain.damping) @ j.T)[-1]
        most = min(most, 1 / load if load > 0 else np.inf)
    share = rng.choice((Fraction(1, 2), Fraction(4, 5), Fraction(9, 10), Fraction(51, 50), Fraction(11, 10)))
    k = share * Fraction(f"{min(2000 * most, 1e6):.9g}")  # nearer to the limit, cells are many
    rows = [[str(k) if i == j else "0" for j in range(size)] for i in range(size)]
    none = [["0"] * size for _ in range(size)]
    wall = {"stiffness_N_per_m": rows, "virtual_damping_N_s_per_m": none, "damping_bound_N_s_per_m": none}
    loop = {"sample_period_s": "0.001", "delay_samples": 0, "encoder": "ideal", "torque": "follows the arm"}
    return {"kind": "arm", "arm": machine, "wall": wall, "loop": loop}


TURNS = (
    [["1", "0", "0"], ["0", "1", "0"], ["0", "0", "1"]],
    [["1", "0", "0"], ["0", "0", "-1"], ["0", "1", "0"]],
    [["0", "0", "1"], ["0", "1", "0"], ["-1", "0", "0"]],
    [["3/5", "-4/5", "0"], ["4/5", "3/5", "0"], ["0", "0", "1"]],
    [["3/5", "0", "4/5"], ["0", "1", "0"], ["-4/5", "0", "3/5"]],
)


_FRESH: dict[str, Callable[[Random], Document]] = {
    "spring": _spring,
    "linear": _linear,
    "quantized": _quantized,
    "delays": _delays,
    "contact": _contact,
    "relaxing contact": _relaxing,
    "multiplier contact": _multiplier,
    "nonlinear spring": _nonlinear,
    "endless pull": _pull,
    "slow hands": _slow,
    "force bounding": _bounding,
    "active hand": _active,
    "violation": _violation,
    "motion": _motion,
    "row motion": _row_motion,
    "vibration": _vibration,
    "absolute stability": _absolute,
    "stability": _known_hand,
    "instability": _known_hand,
    "arm": _arm,
    "positive real matrix": _matrix_port,
    "matrix extraction": _matrix_extraction,
    "touching motion": _touching,
    "contact motion": _contact_motion,
    "positive real": _positive_real,
    "extraction": _extraction,
    **FRESH_PAIRS,
    **FRESH_HELD_PAIRS,
    **FRESH_NULL_SPACE,
}

KINDS = tuple(_FRESH)


def fresh(kind: str, rng: Random) -> Document:
    """A document of one of the kinds, with no part that belongs to another."""
    return {"format": "zwidth certificate 1", **copy.deepcopy(_FRESH[kind](rng))}
