"""A motion to and fro on a rise of a spring given by points: where it is too steep, energy comes out.

In to x_b in m equal moves, w samples still, out to x_a, and w still.  Of a rise r = f(q_b) − f(q_a), without
delay and in one move each way, a round gives

    r D − 2 f_c D − 2 (b/T) D²,      D = x_b − x_a > q_b − q_a − Δ

Behind d samples, on one slope s and still for d of them, s D² [(2d + 1)/m − d (d + 1)/m²] stands in the place
of r D for m ≥ d, and 2 (b/T) D²/m is lost.  What gains is reckoned in doubles, and replayed by the checker.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import pairwise, product
from math import ceil, floor, inf
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from zwidth.passivity.storage.domain import Losses
from zwidth.passivity.storage.gain import Gain, gain_of, peak_force, resting_places
from zwidth.passivity.storage.hand_bounds import HandBounds
from zwidth.passivity.storage.law import FiniteLaw
from zwidth.passivity.witness.motion import Motion, Repeat
from zwidth.passivity.wording import LARGEST_OF_HANDS, LONGEST_OF_HANDS, is_beyond_hands
from zwidth.quantity.text import quantity_unit

_MOVES = (1, 2, 3, 4, 5, 6, 8, 10, 13, 16, 20, 26, 34, 44)
_RISES = 3  # that are tried, the largest ones, and of each slope
_LONGEST_DELAY = 100  # samples
_WAY_IN = 100  # samples from where the hand begins to the round
_FROM_EDGES = (1 / 8, 1 / 1024)  # counts from the edges of the encoder to the turns
_REPLAYED = 8  # motions at most
_OF_FORCE = 0.999  # of the largest force that may be asked for
_FINE = 2**20  # turns are at whole multiples of a count over this, to keep them short

Floats = NDArray[np.float64]


class _Turns(NamedTuple):
    """A round: from one turn to the other in so many moves, so many samples still at each; in counts."""

    low: float
    high: float
    moves: int
    still: int

    def positions(self) -> Floats:
        """The last as the first."""
        way = np.linspace(self.low, self.high, self.moves + 1)
        still = np.ones(self.still)
        return np.concatenate([way, self.high * still, way[-2::-1], self.low * still])


def slope_motion(
    law: FiniteLaw,
    losses: Losses,
    motion: str,
    bounds: HandBounds | None = None,
    most: Fraction | None = None,
) -> Gain | None:
    """The shortest that is found, one that hands can make before others; None where none gains.

    `law`: a spring given by points; `motion`: "linear" or "rotary"; `bounds`: that the hand keeps to;
    `most`: the largest force that the motion may ask for [N; N·m].
    """
    slopes = _Slopes(law, losses, motion, bounds, most)
    found = (slopes.replayed(turns) for turns in slopes.best())
    return next((motion for motion in found if motion is not None), None)


@dataclass(frozen=True)
class _Slopes:
    """One loop, and the rises of its law on which a hand may gain; positions in counts, to rounding."""

    law: FiniteLaw
    losses: Losses
    motion: str
    bounds: HandBounds | None
    most: Fraction | None

    def best(self) -> list[_Turns]:
        """Those that gain: what hands can make first, then by how long it takes."""
        if self.losses.delay > _LONGEST_DELAY or not self._rests:
            return []
        gained = ((turns, self._gained(turns)) for turns in dict.fromkeys(self._turns()))
        found = [(self._lasts(turns, energy), turns) for turns, energy in gained if energy > 0]
        return [turns for (_, samples), turns in sorted(found)[:_REPLAYED] if samples < inf]

    def replayed(self, turns: _Turns) -> Gain | None:
        """From rest, with enough rounds, as the checker finds it; None where it does not gain."""
        part, count = self.losses.part, self.losses.resolution
        low, high = (Fraction(round(end * _FINE), _FINE) * count for end in (turns.low, turns.high))
        step, start = (high - low) / turns.moves, self._start(turns)
        way = [low + step * k for k in range(turns.moves + 1)]
        steps = self._way_in(abs(low - start) / count)
        before = [start] * self.losses.delay  # until the force there is the one that acts
        before += [start + (low - start) * Fraction(k, steps) for k in range(steps)]
        x = (*before, *way, *[high] * turns.still, *way[-2::-1], *[low] * turns.still)
        switches = () if part == 1 else tuple(a + part * (b - a) for a, b in pairwise(x))
        path = Motion(x, switches, (Repeat(len(before), len(x) - 1, self.losses.delay + 3),))
        told = self.law.document(self.motion)
        gain = gain_of(path, self.law, self.losses, told, self.bounds, self.motion)
        return None if gain is None or (self.most is not None and peak_force(gain) > self.most) else gain

    def _turns(self) -> Iterator[_Turns]:
        """What is tried."""
        late = self.losses.delay
        speeds = {min(LARGEST_OF_HANDS[self._unit][1] * self._per_speed, self._speed), self._speed}
        for (low, high), moves in product(self._rises(), _MOVES if late else _MOVES[:1]):
            for reach in {1.0, *(moves * speed for speed in speeds)}:
                for (a, b), edge in product(self._within(low, high, reach), _FROM_EDGES):
                    for still in {0, late, 2 * late}:
                        yield self._turning(a, b, moves, still, edge, reach)

    def _rises(self) -> list[tuple[float, float]]:
        """From where to where the force rises most, over what damping takes; and the steepest pieces."""
        x, f = self._points
        kept = abs(f) <= self._level * (1 + 1e-12)
        pieces = np.flatnonzero(kept[:-1] & kept[1:])
        lengths, rises = np.diff(x)[pieces], np.diff(f)[pieces]
        over = rises - 2 * self._drag / (2 * self.losses.delay + 1) * lengths
        ranks = (np.argsort(-v, kind="stable")[:_RISES] for v in (over, abs(rises / lengths)))
        found = [(float(x[k]), float(x[k + 1])) for k in pieces[sorted({k for rank in ranks for k in rank})]]
        largest, total, begin, longest = 0.0, 0.0, 0, None
        for k, piece in enumerate(pieces.tolist()):  # the largest rise over pieces that follow each other
            if total <= 0 or piece != pieces[k - 1] + 1:
                begin, total = piece, 0.0
            total += over[k]
            if total > largest:
                largest, longest = total, (float(x[begin]), float(x[piece + 1]))
        return found if longest is None else [longest, *found]

    def _within(self, low: float, high: float, reach: float) -> Iterator[tuple[int, int]]:
        """Readings at the turns: the ends; of a long piece either one, or where f is least."""
        if high - low <= reach:
            yield round(low), round(high)
            yield ceil(low - 1e-9), floor(high + 1e-9)
            return
        x, f = self._points
        inside = (x >= low) & (x <= high)
        rises = f[inside][0] < f[inside][-1]
        middle = float(np.interp(0.0, f[inside], x[inside])) if rises else (low + high) / 2
        for start in (low, min(max(middle - reach / 2, low), high - reach), high - reach):
            first = ceil(start - 1e-9)
            yield first, first + 1 + max(0, floor(reach - 2 * _FROM_EDGES[0]))

    def _turning(self, a: int, b: int, moves: int, still: int, edge: float, reach: float) -> _Turns:
        """Between two readings, as far from each other as gains most."""
        least, most = (b - a + side * (1 - 2 * edge) for side in (-1, 1))
        rise = abs(float(np.diff(self._force(np.array([a, b])))[0]))
        paid = 2 * float(self.losses.coulomb_friction)
        best = (rise - paid) * moves / (4 * self._drag) if self._drag else most
        half, middle = min(max(best, least), most, reach) / 2, (a + b + 1) / 2
        return _Turns(middle - half, middle + half, moves, still)

    def _gained(self, turns: _Turns) -> float:
        """By one more round [J]; nothing beyond the bounds or the largest force."""
        low, high = self._ends
        step = (turns.high - turns.low) / turns.moves
        if step <= 0 or turns.low < low or turns.high > high or step > self._speed * (1 + 1e-12):
            return 0.0
        x, part, late = turns.positions(), float(self.losses.part), self.losses.delay
        f = self._force(np.floor(x[:-1]))
        if abs(f).max() > self._level:
            return 0.0
        held = part * np.roll(f, late) + (1 - part) * np.roll(f, late - 1)
        return float(-held @ np.diff(x)) * self._count - 2 * turns.moves * self._lost(step)

    def _lasts(self, turns: _Turns, gained: float) -> tuple[bool, float]:
        """Whether it is more than a hand does, and how many samples it takes; too much force is never."""
        x, _ = self._points
        start = float(self._start(turns)) / self._count
        low, high = sorted((start, turns.low))
        places = np.array([low, *x[(x > low) & (x < high)], high])
        forces = self._force(places)
        if abs(forces).max() > self._level:
            return True, inf
        steps = self._way_in(high - low)
        lost = steps * self._lost((high - low) / steps)
        cost = max(0.0, self._stored(turns.low) + lost)  # what the spring stores at the start is no gain
        samples = steps + 2 * (turns.moves + turns.still) * (self.losses.delay + 3 + cost / gained)
        speed = (turns.high - turns.low) / turns.moves / self._per_speed
        depth = max(abs(turns.low), abs(turns.high)) * self._count
        long = samples * float(self.losses.period) > LONGEST_OF_HANDS
        return long or is_beyond_hands(depth, speed, self._unit), samples

    def _stored(self, place: float) -> float:
        """The potential of the spring over its lowest value [J]."""
        x, f = self._law
        i = np.flatnonzero((f[:-1] < 0) & (f[1:] > 0))
        places = np.unique([*x, *(x[i] - f[i] * (x[i + 1] - x[i]) / (f[i + 1] - f[i])), place])
        forces = self._force(places)
        potential = np.cumsum([0.0, *(np.diff(places) * (forces[1:] + forces[:-1]) / 2)]) * self._count
        return float(potential[np.searchsorted(places, place)] - potential.min())

    def _start(self, turns: _Turns) -> Fraction:
        """Where the hand begins: the nearest rest."""
        return min(self._rests, key=lambda rest: abs(float(rest) / self._count - turns.low))

    def _way_in(self, far: Fraction | float) -> int:
        """Samples on the way to the round, so many counts."""
        return _WAY_IN if self.bounds is None else max(_WAY_IN, ceil(far / self.bounds.counts_per_sample))

    def _force(self, readings: Floats) -> Floats:
        """The force at readings [N; N·m]."""
        f = np.interp(readings, *self._law)
        if self.law.force_step is not None:
            f = float(self.law.force_step) * np.floor(f / float(self.law.force_step) + 0.5)
        limit = inf if self.law.force_limit is None else float(self.law.force_limit)
        return np.clip(f, -limit, limit)

    def _lost(self, move: float) -> float:
        """Friction in a move within one sample [J]."""
        if self.losses.curve is not None:
            return float(self.losses.lost(Fraction(move * self._count), Fraction(1)))
        return (float(self.losses.coulomb_friction) + self._drag * move) * move * self._count

    @cached_property
    def _rests(self) -> list[Fraction]:
        return resting_places(self.law, self.losses, self._bounds)

    @property
    def _bounds(self) -> tuple[Fraction | None, Fraction | None]:
        return (None, None) if self.bounds is None else self.bounds.ends

    @cached_property
    def _law(self) -> tuple[Floats, Floats]:
        x, f = (np.array(v, dtype=np.float64) for v in zip(*self.law.points, strict=True))
        return x / self._count, f

    @cached_property
    def _points(self) -> tuple[Floats, Floats]:
        """Where the force bends, between the ends, and where it reaches the largest that may be asked for."""
        x, f = self._law
        crossed = [
            x0 + (level - f0) * (x1 - x0) / (f1 - f0)
            for (x0, f0), (x1, f1) in pairwise(zip(x, f, strict=True))
            for level in (-self._level, self._level)
            if f0 < level < f1 or f1 < level < f0
        ]
        low, high = self._ends
        places = np.unique([*np.clip([*x, *crossed], low, high), *(e for e in (low, high) if abs(e) < inf)])
        return places, np.interp(places, x, f)

    @cached_property
    def _level(self) -> float:
        return inf if self.most is None else _OF_FORCE * float(self.most)

    @cached_property
    def _ends(self) -> tuple[float, float]:
        """Between which positions the hand may be."""
        low, high = self._bounds
        known = -inf if low is None else float(low), inf if high is None else float(high)
        return known[0] / self._count, known[1] / self._count

    @cached_property
    def _speed(self) -> float:
        """Counts a sample, at most."""
        return inf if self.bounds is None else float(self.bounds.counts_per_sample)

    @cached_property
    def _count(self) -> float:
        return float(self.losses.resolution)

    @cached_property
    def _per_speed(self) -> float:
        """Counts a sample at a speed of 1 m/s; 1 rad/s."""
        return float(self.losses.period) / self._count

    @cached_property
    def _drag(self) -> float:
        """Force by damping at a count a sample [N; N·m]."""
        return float(self.losses.damping) / self._per_speed

    @property
    def _unit(self) -> str:
        return quantity_unit("position", self.motion)
