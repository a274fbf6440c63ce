"""Motions of a hand that tries to take energy out: drawn from families, run, and the best improved.

Lengths are in counts, or in any unit where the encoder is ideal; energies in N/m times
that unit squared.  The score of a motion is what it has taken out, less what the loop may
store at rest, over what friction and damping took: > 0 refutes.  A motion that ends with
equal rounds is scored by the last round too.
"""

from __future__ import annotations

from ctypes import CDLL, POINTER, byref, c_int, c_uint64
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from pathlib import Path

import numpy as np
from flint import arb
from in_c import REAL, REALS, library
from numpy.typing import NDArray

from .referee import DIGITS, PlainLoop, ball, digits_of, energies, largest_pole

GATE, CLAMPED, COUNTED, PHASE, FRICTION, DRAG, WHOLE, PART, KEPT, STORED, ANGLE, POLE, STATIC = range(13)
BOTH, POSITION, PENETRATION = 0.0, 1.0, 2.0
ROUNDING = 1e-12
Array = NDArray[np.float64]
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


def _search(
    rng: np.random.Generator, law: Array, num: Array, den: Array, length: int, motions: int, climbs: int
) -> tuple[float, Array, int]:
    """(score, positions, samples of the last round) of the best motion found."""
    best, order = np.zeros(length), num.size - 1
    room = np.zeros(3 * length + order + 2 + int(law[WHOLE]) + 2)
    last, turn = c_int(), c_int()
    score = searches().search(
        seed(rng), law, num, den, order, length, motions, climbs, best, byref(last), byref(turn), room
    )
    return score, best[: last.value], turn.value


@cache
def searches() -> CDLL:
    """What `search.c` defines."""
    found = library(Path(__file__).with_name("search.c"))
    found.search.restype = found.search_row.restype = REAL
    found.search.argtypes = [
        c_uint64, REALS, REALS, REALS, *[c_int] * 4, REALS, POINTER(c_int), POINTER(c_int), REALS
    ]  # fmt: skip
    found.search_row.argtypes = [c_uint64, REALS, REALS, *[c_int] * 4, REALS, POINTER(c_int), REALS]
    found.forces.argtypes = [REALS, REALS, REALS, c_int, REALS]
    return found


def seed(rng: np.random.Generator) -> int:
    """Of the draws of one search."""
    return int(rng.integers(0, 2**63))
