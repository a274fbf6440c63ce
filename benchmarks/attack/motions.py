"""Motions of a hand that tries to take energy out: drawn from families, run, and the best improved.

Lengths are in counts, or in any unit where the encoder is ideal; energies in N/m times
that unit squared.  The score of a motion is what it has taken out, less what the loop may
store at rest, over what friction and damping took: > 0 refutes.  A motion that ends with
equal rounds is scored by the last round too.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from flint import arb
from numba import njit

from .referee import DIGITS, PlainLoop, ball, digits_of, energies, largest_pole

GATE, CLAMPED, COUNTED, PHASE, FRICTION, DRAG, WHOLE, PART, KEPT, STORED, ANGLE, POLE, STATIC = range(13)
BOTH, POSITION, PENETRATION = 0.0, 1.0, 2.0
FAMILIES = 8
ROUNDING = 1e-12
_GATES = {"both": BOTH, "position": POSITION, "penetration": PENETRATION}


@dataclass(frozen=True)
class Found:
    """The best motion of an attack: score, positions [m; rad], samples of its last round (0: none)."""

    score: float
    positions: tuple[Fraction, ...]
    round: int
    phase: Fraction


def attack(
    loop: PlainLoop, rng: np.random.Generator, motions: int, climbs: int, *, kept: bool, angle: float = 3.0
) -> Found:
    """The best of many random motions, improved for some steps; `kept`: of those that stay inside."""
    unit = float(loop.resolution) or _unit(loop)
    phase = 0.0
    if loop.resolution and loop.fed != "both" and not kept and rng.random() < 0.25:
        phase = float(np.round(rng.random(), 3))
    law = np.zeros(13)
    law[GATE], law[CLAMPED] = _GATES[loop.fed], float(loop.clamped)
    law[COUNTED], law[PHASE] = float(loop.resolution > 0), phase
    law[FRICTION], law[DRAG] = float(loop.friction) / unit, float(loop.damping / loop.period)
    law[WHOLE], law[PART] = float(loop.whole), float(loop.part)
    law[KEPT], law[ANGLE] = float(kept and loop.fed != "both"), angle
    inside = loop.fed == "both" or kept
    law[STORED] = max(float(loop.static or 0), 0.0) / 8 if loop.resolution and inside else 0.0
    law[STATIC] = float(loop.static or 0)
    real = [
        p.real for p in np.roots([float(c) for c in loop.denominator]) if abs(p.imag) < 1e-9 and p.real > 0.05
    ]
    law[POLE] = max(real, default=0.0)
    num, den = (np.array([float(c) for c in side]) for side in (loop.numerator, loop.denominator))
    slow = min(2 / max(1 - law[POLE], 1e-3), 500) if law[POLE] < 1 and rng.random() < 0.4 else 0
    length = int(rng.integers(8, 128) + slow)
    score, x, turn = _search(rng, law, num, den, length, motions, climbs)
    exact = Fraction(unit) if not loop.resolution else loop.resolution
    return Found(score, tuple(Fraction(v) * exact for v in x), turn, Fraction(phase))


def _unit(loop: PlainLoop) -> float:
    """A length at which Coulomb friction and damping take about as much, where there is friction."""
    if loop.friction and loop.damping:
        return float(loop.friction * loop.period / loop.damping)
    return 1e-3


def refutes(loop: PlainLoop, found: Found, *, kept: bool) -> bool:
    """Whether the motion takes out more than was stored, in exact arithmetic."""
    stored = ball(loop.stored) if loop.fed == "both" or kept else arb(0)
    if any(v > stored for v in energies(loop, found.positions, phase=found.phase)):
        return True
    turn = found.round
    if not turn or len(found.positions) <= 2 * turn:
        return False
    last = found.positions[-turn:]
    if found.positions[-turn - 1] != last[-1]:
        return False
    if largest_pole(loop) ** (20 * turn) > 0.1:  # what a round gains may come from the start, and fade
        return False
    longer = [*found.positions, *(last * 60)]
    out = energies(loop, longer, phase=found.phase)
    if out[-1] > stored:
        return True
    with digits_of(DIGITS):
        late, later = out[-1 - 20 * turn] - out[-1 - 40 * turn], out[-1] - out[-1 - 20 * turn]
        return bool(later > 0) and bool(later > late * 0.999)


@njit(cache=True)
def _search(rng, law, num, den, length, motions, climbs):
    """(score, positions, samples of the last round) of the best motion found."""
    best, kept = np.zeros(length), np.zeros(length)
    score, turn = -1e300, 0
    energy, loss = np.zeros(length), np.zeros(length)
    trial, last = np.zeros(length), 0
    for k in range(motions):
        period = _draw(rng, law, k % FAMILIES, trial)
        _inside(law, trial)
        found, end = _score(law, num, den, trial, period, energy, loss)
        if found > score:
            score, turn, last = found, period, end
            best[:] = trial
    for _ in range(climbs):
        trial[:] = best
        period = _change(rng, law, trial, turn)
        _inside(law, trial)
        found, end = _score(law, num, den, trial, period, energy, loss)
        if found > score:
            score, turn, last = found, period, end
            best[:] = trial
    kept[:] = best
    return score, kept[: last + 1].copy(), turn if last == length - 1 else 0


@njit(cache=True)
def _score(law, num, den, x, period, energy, loss):
    """What was taken out beyond what was stored over what was lost, at best; and the sample where."""
    _run(law, num, den, x, energy, loss)
    n = x.shape[0]
    best, at = -1e300, n - 1
    for k in range(2, n):
        if loss[k] > 0.0:
            value = (energy[k] - law[STORED]) / loss[k]
            if value > best:
                best, at = value, k
    if period > 0 and n > 3 * period and x[n - 1] == x[n - 1 - period]:
        lost = loss[n - 1] - loss[n - 1 - period]
        gain = energy[n - 1] - energy[n - 1 - period]
        before = energy[n - 1 - period] - energy[n - 1 - 2 * period]
        if lost > 0.0 and abs(gain - before) <= 0.001 * abs(gain):  # the law has settled
            value = gain / lost
            if value > best:
                best, at = value, n - 1
    return best, at


@njit(cache=True)
def _run(law, num, den, x, energy, loss):
    """Energy taken out and lost up to each sample."""
    order = num.shape[0] - 1
    memory = np.zeros(order + 1)
    whole, part = int(law[WHOLE]), law[PART]
    line = np.zeros(whole + 2)
    fc, drag = law[FRICTION], law[DRAG]
    out, lost = 0.0, 0.0
    first = 0.0  # where the law has been at rest for ever
    energy[0], loss[0] = 0.0, 0.0
    for k in range(x.shape[0] - 1):
        q = np.floor(x[k] + law[PHASE]) + law[PHASE] if law[COUNTED] > 0.0 else x[k]
        u = max(q, 0.0) if law[GATE] == PENETRATION else q
        if k == 0:
            first = u
        u -= first
        f = num[0] * u + memory[0]
        for i in range(1, order + 1):
            memory[i - 1] = memory[i] + num[i] * u - den[i] * f
        f += law[STATIC] * first
        if law[GATE] != BOTH and q <= 0.0:
            f = 0.0
        if law[CLAMPED] > 0.0:
            f = max(f, 0.0)
        for i in range(whole + 1, 0, -1):
            line[i] = line[i - 1]
        line[0] = f
        moved = x[k + 1] - x[k]
        if part == 0.0:
            took = fc * abs(moved) + drag * moved * moved
            out -= line[whole] * moved + took
        else:
            gain, took = _within(line[whole + 1], line[whole], moved, part, fc, drag)
            out += gain
        lost += took + 1e-16 * abs(line[whole] * moved)
        energy[k + 1], loss[k + 1] = out, lost


@njit(cache=True)
def _within(early, late, moved, part, fc, drag):
    """(taken out, lost) over a sample in which the force changes, the hand at its best when it does."""
    best, took = -1e300, 0.0
    lean = part * (1.0 - part) / (2.0 * drag) if drag > 0.0 else 0.0
    for way in range(5):
        u = 0.0
        if way == 1:
            u = moved
        elif way > 1:
            u = part * moved - lean * (early - late + (way - 3) * 2.0 * fc)
        v = moved - u
        lost = fc * (abs(u) + abs(v)) + drag * (u * u / part + v * v / (1.0 - part))
        value = -early * u - late * v - lost
        if value > best:
            best, took = value, lost
    return best, took


@njit(cache=True)
def _inside(law, x):
    """Begin at rest; a motion that has to stay inside is carried there."""
    counted = law[COUNTED] > 0.0
    if law[GATE] == BOTH:
        x[0] = 0.0
    elif law[KEPT] > 0.0:
        lowest = 1e300
        for k in range(1, x.shape[0]):
            lowest = min(lowest, x[k])
        least = 1.0 if counted else 1e-9
        if lowest < least:
            shift = np.ceil(least - lowest) if counted else least - lowest
            for k in range(1, x.shape[0]):
                x[k] += shift
                if not counted:
                    x[k] = max(x[k], least)
        x[0] = 0.0
    elif law[PHASE] > 0.0:
        x[0] = min(x[0], -2.0)  # the position is x + 2 φ: a reading of 0 or less may lie a count inside
    else:
        x[0] = min(x[0], -1.0 if counted else 0.0)


@njit(cache=True)
def _size(rng, law):
    """A step: part of a count, counts, or anything over decades."""
    kind = rng.random()
    if law[COUNTED] > 0.0:
        if kind < 0.35:
            return 10.0 ** (-7.0 * rng.random())
        if kind < 0.7:
            return 1.0 + np.floor(8.0 * rng.random())
        return 10.0 ** (6.0 * rng.random())
    if law[FRICTION] > 0.0:
        return 10.0 ** (7.0 * rng.random() - 2.0)
    return 1.0


@njit(cache=True)
def _depth(rng, law, step):
    """How deep a motion goes on: near the surface, some counts, or much deeper than its step."""
    kind = rng.random()
    if kind < 0.3:
        return 0.0
    if kind < 0.7:
        return np.floor(10.0 * rng.random()) if law[COUNTED] > 0.0 else step * 3.0 * rng.random()
    return step * 10.0 ** (3.0 * rng.random())


@njit(cache=True)
def _draw(rng, law, family, x):
    """A motion of a family; returns the samples of a round that it ends with, 0 for none."""
    n = x.shape[0]
    step = _size(rng, law)
    deep = _depth(rng, law, step)
    late = int(law[WHOLE]) + (1 if law[PART] > 0.0 else 0)
    x[:] = 0.0
    if family == 0:  # in and out, each way for some samples
        hold, away = 1 + int(rng.random() * (1.5 + late)), 1 + int(rng.random() * (1.5 + late))
        low = deep if rng.random() < 0.7 else deep - step * rng.random()
        for k in range(1, n):
            x[k] = low + step if (k - 1) % (hold + away) < hold else low
        return hold + away
    if family == 1:  # a sinusoid where the criterion is tightest, inside or through the surface
        angle = law[ANGLE] if rng.random() < 0.7 else np.pi * rng.random()
        middle = deep + step if rng.random() < 0.6 else step * (2.0 * rng.random() - 1.0)
        phase = 2.0 * np.pi * rng.random()
        for k in range(1, n):
            x[k] = middle + step * np.cos(angle * k + phase)
        return 0
    if family == 2:  # to and fro over one edge, with waits
        hold, away = 1 + late + int(3.0 * rng.random() ** 2), 1 + late + int(3.0 * rng.random() ** 2)
        edge = 1.0 + np.floor(6.0 * rng.random()) if law[COUNTED] > 0.0 else 0.0
        edge -= law[PHASE]
        tiny = 10.0 ** (-7.0 * rng.random()) if law[COUNTED] > 0.0 else step
        lead = min(n // 3, 24)
        for k in range(1, n):
            turn = (k - lead) % (hold + away)
            x[k] = (edge - tiny) * k / lead if k < lead else (edge if turn < hold else edge - tiny)
        return hold + away
    if family == 3:  # a run-up that grows like the law forgets, a touch, and away
        rate = 1.0 / law[POLE] if law[POLE] > 0.0 and rng.random() < 0.7 else 1.0 + 2.0 * rng.random() ** 3
        rate = 1.0 + (rate - 1.0) * (0.5 + rng.random())
        span = 1 + int(rng.random() * (n - 4))
        total = 0.0
        for k in range(span, 0, -1):
            x[k] = -total
            total += step * rate ** (k - span)
        x[0] = -total
        touch = 10.0 ** (-8.0 * rng.random()) * step
        if law[COUNTED] > 0.0:
            touch = 1.0 - law[PHASE]
        for k in range(span + 1):
            x[k] += touch
        back, turns = step * 10.0 ** (rng.random() * 3.0 - 2.0), rng.random() < 0.5
        if law[POLE] < 1.0:
            back /= 1.0 - law[POLE] ** 2
        decay = law[POLE] if law[POLE] > 0.0 and rng.random() < 0.7 else 0.5 + 0.5 * rng.random()
        for k in range(span + 1, n):
            x[k] = touch - back if (k - span) % 2 == 1 or not turns else touch
            back *= decay if turns else 1.0
        return 0
    if family == 4:  # a walk on counts
        here, tiny = deep, 10.0 ** (-6.0 * rng.random())
        unit = 1.0 if law[COUNTED] > 0.0 and rng.random() < 0.7 else step
        for k in range(1, n):
            here += unit * (np.floor(3.0 * rng.random()) - 1.0)
            x[k] = here - (tiny if rng.random() < 0.5 else 0.0)
        return 0
    if family == 5:  # press, slowly, wait, and let go at once, again and again
        rise, wait, free = 1 + int(rng.random() * n / 3), int(8.0 * rng.random()), 1 + int(6.0 * rng.random())
        out = 0.0 if rng.random() < 0.5 else -step * rng.random()
        for k in range(1, n):
            turn = (k - 1) % (rise + wait + free)
            x[k] = step * min(turn + 1, rise) / rise if turn < rise + wait else out
        return 0
    if family == 6:  # a short pattern, again and again
        period = 2 + int(6.0 * rng.random())
        for k in range(1, n):
            if k <= period:
                x[k] = deep + step * (np.floor(5.0 * rng.random()) - 1.0)
            else:
                x[k] = x[k - period]
        return period
    smooth, here, speed = rng.random(), 0.0, 0.0
    for k in range(1, n):
        speed = smooth * speed + step * rng.standard_normal()
        here += speed
        x[k] = here + deep
    return 0


@njit(cache=True)
def _change(rng, law, x, turn):
    """Change a motion a little; its rounds stay equal."""
    n = x.shape[0]
    scale = 0.0
    for k in range(1, n):
        scale = max(scale, abs(x[k] - x[k - 1]))
    kind = int(5.0 * rng.random())
    shift = scale * rng.standard_normal() * 10.0 ** (-4.0 * rng.random())
    if law[COUNTED] > 0.0 and rng.random() < 0.3:
        shift = 1.0 if rng.random() < 0.5 else -1.0
    k = 1 + int((n - 1) * rng.random())
    if turn > 0 and kind < 3:
        for i in range(k % turn, n, turn):
            if i > 0:
                x[i] += shift
        return turn
    if kind == 0:
        x[k] += shift
    elif kind == 1:
        x[k:] += shift
    elif kind == 2:
        j = k + 1 + int((n - k) * rng.random())
        x[k:j] += shift
    elif kind == 3:
        factor = 1.0 + 0.3 * rng.standard_normal() * rng.random()
        x *= factor
        return turn
    else:
        x += shift
        return turn
    return 0
