"""From a cycle that gains to a witness: a motion from outside that takes energy out, recomputed exactly."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import accumulate, pairwise
from math import ceil, floor
from typing import Any, NamedTuple

from zwidth.checker import verify
from zwidth.passivity.result import Evidence
from zwidth.passivity.scope import unit_key
from zwidth.passivity.storage.domain import Losses
from zwidth.passivity.storage.grid import Grid
from zwidth.passivity.storage.hand_bounds import HandBounds, hand_bounds
from zwidth.passivity.storage.law import FiniteLaw
from zwidth.passivity.storage.storage_function import loop_document
from zwidth.passivity.storage.value_iteration import ValueIteration
from zwidth.passivity.witness.motion import Motion, Repeat
from zwidth.passivity.witness.witness import FORMAT, rounded_energy
from zwidth.passivity.wording import size
from zwidth.quantity.text import quantity_unit, shown

_NEAREST = 40  # halvings of a count by which a hand on the upper edge of a cell may have to stay below it


@dataclass(frozen=True, repr=False)
class Gain(Evidence):
    """A motion with contact made and broken that takes energy out, and again with every round.

    Energy out, in rational arithmetic: −Σ f Δx − f_c Σ|Δx| − (b/T) Σ Δx², over each part of
    a sample with one force.

    Parameters
    ----------
    document
        The motion, the law and the loop, as data for the checker.
    motion
        Positions at the samples, the cycle as its repeated part.
    exact_energy, exact_gain
        Taken out by the whole motion and by one more round [J]; of a law that relaxes, at least so much.
    law, losses
        Against which the hand moves, and what the device takes out.
    """

    _PICTURE = "cycle"

    document: dict[str, Any]
    motion: Motion
    exact_energy: Fraction
    exact_gain: Fraction
    law: FiniteLaw
    losses: Losses
    unit: str

    @property
    def energy(self) -> float:
        """Taken out by the whole motion [J], > 0."""
        return float(self.exact_energy)

    @property
    def energy_per_cycle(self) -> float:
        """Taken out by one more round [J], > 0."""
        return float(self.exact_gain)

    @property
    def sample_period(self) -> float:
        """T [s]."""
        return float(self.losses.period)

    @property
    def cycle(self) -> tuple[float, ...]:
        """One round: positions at the samples, the last as the first [m; rad]."""
        part = self.motion.repeats[0]
        return tuple(float(x) for x in self.motion.positions[part.first : part.last + 1])

    @property
    def positions(self) -> tuple[float, ...]:
        """Positions at the samples, the cycle listed once [m; rad]."""
        return tuple(float(x) for x in self.motion.positions)

    @cached_property
    def peak_speed(self) -> float:
        """Largest mean speed of the whole motion, over each time in which one force is held [m/s; rad/s]."""
        return float(self.motion.peak_speed(self.losses.period, self.losses.part))

    @cached_property
    def depth(self) -> float:
        """Deepest position of the whole motion; on either side where the law acts there too [m; rad]."""
        places = (*self.motion.positions, *self.motion.switch_positions)
        return float(max(map(abs, places)) if self.law.surface == "none" else max(places))

    def to_dict(self) -> dict[str, Any]:
        """The motion as plain data, positions exact."""
        return self.document

    def saved(self) -> dict[str, Any]:
        """The energy rounded: the checker recomputes it anyway."""
        return rounded_energy(self.document)

    def describe(self) -> str:
        """The motion in a sentence."""
        part = self.motion.repeats[0]
        return (
            f"a cycle of {part.last - part.first} samples, {size(self.depth, self.peak_speed, self.unit)}, "
            f"extracts {shown(self.energy_per_cycle, 'J')} in each round"
        )


def gain(iteration: ValueIteration[Grid], motion: str, bounds: HandBounds | None = None) -> Gain | None:
    """The cycle of a value iteration as a witness, or None if exactly recomputed it gains nothing.

    It keeps to the bounds, those of the grid unless others are given.
    """
    grid = iteration.grid
    bounds = bounds or hand_bounds(grid.law, grid.losses, grid.domain)
    for halvings in range(grid.count_steps.bit_length() - 1, _NEAREST, 4):
        round_ = [_place(grid, node, cell, halvings) for node, cell in iteration.cycle]
        bare = grid.law.surface != "none" or not grid.law.points
        rests = [Fraction(0)] if bare else resting_places(grid.law, grid.encoder, bounds.ends)
        start = min(rests, key=lambda x: abs(x - round_[0]), default=None)
        if start is None:
            return None
        approach = straight(start, round_[0], grid.domain.speed * grid.losses.resolution)
        x = [*approach, *round_[1:], round_[0]]
        part = Repeat(len(approach) - 1, len(x) - 1, _settling(grid, len(round_)))
        path = Motion(tuple(x), switch_positions(grid, x, part), (part,))
        law = grid.law_document(motion, path.positions if grid.every > 1 else None)
        found = gain_of(path, grid.law, grid.encoder, law, bounds, motion)
        if found is not None:
            return found
    return None


def gain_of(
    path: Motion, law: FiniteLaw, losses: Losses, told: dict[str, Any], bounds: HandBounds | None, motion: str
) -> Gain | None:
    """A motion as the checker finds it, with as many more rounds as its way in costs; None without gain.

    `path`: with rounds in which the law settles; `told`: the law as data; the rest as in `motion_document`.
    """
    for _ in range(3):  # rounds that settle the law, rounds that pay for the way in, and once more
        document = motion_document("contact motion", losses, told, bounds, path, motion)
        found = verify(document)
        if found.energy is None or found.gain is None or found.gain <= 0:  # beyond the bounds, not settled
            return None
        if found.energy > 0:
            unit = quantity_unit("position", motion)
            witness = {**document, "energy_J": found.energy}
            return Gain(witness, path, found.energy, found.gain, law, losses, unit)
        path = path.repeated(path.rounds + ceil(-found.energy / found.gain) + 1)
    return None


def _place(grid: Grid, node: int, cell: int, halvings: int) -> Fraction:
    """Where the hand stands; on the upper edge of its cell it stays just below."""
    x = Fraction(node, grid.steps)
    if x == cell + Fraction(1, grid.every):
        x -= Fraction(1, 2**halvings * grid.every)
    return x * grid.losses.resolution


def resting_places(
    law: FiniteLaw, losses: Losses, ends: tuple[Fraction | None, Fraction | None]
) -> list[Fraction]:
    """Amid the counts next to where the force rises through 0: friction holds a handle there.

    `law`: a spring given by points; `ends`: between which positions, None: no bound.
    """
    count, friction = losses.resolution, max(f for f, _ in losses.models)
    zeros = [x for x, f in law.points if f == 0]
    zeros += [x0 - f0 * (x1 - x0) / (f1 - f0) for (x0, f0), (x1, f1) in pairwise(law.points) if f0 < 0 < f1]
    readings = sorted({n * count for x in zeros for n in (floor(x / count), ceil(x / count))})
    low, high = ends
    inside = (x for x in readings if (low is None or low <= x) and (high is None or x + count <= high))
    return [x + count / 2 for x in inside if abs(law.force((x,))) <= friction]


def straight(start: Fraction, end: Fraction, most: Fraction) -> list[Fraction]:
    """From one position to another, each next one `most` away at most."""
    count = max(1, ceil(abs(end - start) / most))
    return [start + (end - start) * Fraction(k, count) for k in range(count + 1)]


def _settling(grid: Grid, samples: int) -> int:
    """Rounds after which the law does the same in each, however finely it remembers."""
    if grid.law.relaxing is None:
        return 20
    return 20 + ceil(64 / (1 - grid.law.relaxing[0]) / samples)


def motion_document(
    kind: str, losses: Losses, law: dict[str, Any], bounds: HandBounds | None, path: Motion, motion: str
) -> dict[str, Any]:
    """A motion, of which a part is repeated, as data for the checker; `motion` is "linear" or "rotary".

    `bounds`: that the hand keeps to; None: nothing is said of them.
    """
    length = unit_key("position", motion).removeprefix("position_")
    switches = {f"switch_positions_{length}": list(path.switch_positions)} if path.switch_positions else {}
    return {
        "format": FORMAT,
        "kind": kind,
        "loop": loop_document(losses, motion),
        "law": law,
        **({} if bounds is None else {"bounds": bounds.document(motion)}),
        unit_key("sample_period"): losses.period,
        "energy_J": Fraction(0),
        "repeats": path.repeats[0]._asdict(),
        f"positions_{length}": list(path.positions),
        **switches,
    }


# Where the hand is best at the instant within a sample at which the force changes.
#
# From x to x' in one interval, f for its first part αT and f' for the rest:
#
#     m = x + α D + (T/2b) α (1 − α) (f' − f − φ (s − s')),      D = x' − x
#
# s and s' the signs of both moves; or an end of a move, or of what is allowed.


_GRID = 2**20  # positions between samples are whole multiples of a count over this, to keep them short


def switch_positions(grid: Grid, x: list[Fraction], part: Repeat) -> tuple[Fraction, ...]:
    """One position for each interval of a motion whose repeated part goes on for ever; none without need."""
    if grid.losses.part == 1:
        return ()
    law, losses = grid.law, grid.losses
    used = law.memory + 1
    step = grid.encoder.resolution
    readings = [step * (x[0] // step)] * (used + losses.delay)
    found: dict[int, Fraction] = {}
    rounds = 2 + len(readings) // (part.last - part.first)  # until all readings are of the cycle
    for k in [*range(part.first), *[*range(part.first, part.last)] * rounds, *range(part.last, len(x) - 1)]:
        readings = [step * (x[k] // step), *readings[:-1]]
        older = law.force(tuple(readings[losses.delay : losses.delay + used]))
        newer = law.force(tuple(readings[losses.delay - 1 : losses.delay - 1 + used]))
        found[k] = _best(losses, x[k], x[k + 1], older, newer, *_allowed(grid, x[k], x[k + 1]))
    return tuple(found[k] for k in range(len(x) - 1))


def _allowed(grid: Grid, start: Fraction, end: Fraction) -> tuple[Fraction, Fraction]:
    """Between which positions the hand keeps to its bounds."""
    losses, domain = grid.losses, grid.domain
    early, late = (domain.speed * losses.resolution * part for part in (losses.part, 1 - losses.part))
    max_depth = (domain.highest + 1 if domain.max_depth is None else domain.max_depth) * losses.resolution
    low, high = max(start - early, end - late), min(start + early, end + late, max_depth)
    if grid.law.surface == "none":
        low = max(low, -max_depth)
    return low, max(low, high)


def _best(
    losses: Losses,
    start: Fraction,
    end: Fraction,
    older: Fraction,
    newer: Fraction,
    low: Fraction,
    high: Fraction,
) -> Fraction:
    part, friction = losses.part, losses.coulomb_friction
    candidates = [start, end, low, high]
    if losses.damping:
        step = losses.period / (2 * losses.damping) * part * (1 - part)
        for signs in (-2, 0, 2):
            m = start + part * (end - start) + step * (newer - older - friction * signs)
            candidates.append(round(m / losses.resolution * _GRID) * losses.resolution / _GRID)

    def taken(m: Fraction) -> Fraction:
        before, after = m - start, end - m
        paid = losses.lost(before, part) + losses.lost(after, 1 - part)
        return -older * before - newer * after - paid

    return max((min(max(m, low), high) for m in candidates), key=taken)


# Played back: the force held in each interval, to rounding, to look at.


_SETTLING = 400  # rounds after which the law is taken to do the same in each


class Round(NamedTuple):
    """One round of the cycle, the law settled."""

    # the samples, and the instants between them at which a delayed force changes [T]
    times: tuple[float, ...]
    positions: tuple[float, ...]  # x then, the last as the first [m; rad]
    forces: tuple[float, ...]  # held from each of them to the next [N; N·m]
    energies: tuple[float, ...]  # taken out since the first sample, at each [J]
    resolution: float  # Δ [m; rad]


def settled_round(gain: Gain) -> Round:
    """The round that is gained with, again and again."""
    _, forces = _forces(gain)
    losses = gain.losses
    first, last, _ = gain.motion.repeats[0]
    x, switches = gain.motion.positions, gain.motion.switch_positions
    times, positions = [Fraction(0)], [x[first]]
    for k in range(first, last):
        if switches:
            times.append(k - first + losses.part)
            positions.append(switches[k])
        times.append(Fraction(k - first + 1))
        positions.append(x[k + 1])
    out = (
        -f * float(b - a) - float(losses.lost(b - a, t1 - t0))
        for f, (a, b), (t0, t1) in zip(forces, pairwise(positions), pairwise(times), strict=True)
    )
    path = tuple(map(float, times)), tuple(map(float, positions))
    return Round(*path, tuple(forces), tuple(accumulate(out, initial=0.0)), float(losses.resolution))


def peak_force(gain: Gain) -> float:
    """Largest actuator force on the way in and in the cycle [N; N·m]."""
    return max(abs(f) for part in _forces(gain) for f in part)


def _forces(gain: Gain) -> tuple[list[float], list[float]]:
    """Forces on the way in, and in a round once the law has settled."""
    listed = next((gain.document[key] for key in gain.document if key.startswith("forces_")), None)
    if listed is not None:  # laws in a chain, settled from the first round on
        first = gain.motion.repeats[0].first
        return [float(f) for f in listed[:first]], [float(f) for f in listed[first:]]
    controller = _Controller(gain.law, gain.losses, gain.motion.positions[0])
    x, (first, last, _) = gain.motion.positions, gain.motion.repeats[0]
    way_in = [force for position in x[:first] for force in controller.forces(position)]
    before: list[float] = []
    for _ in range(_SETTLING):
        forces = [force for position in x[first:last] for force in controller.forces(position)]
        if forces == before:
            break
        before = forces
    return way_in, before


class _Controller:
    """The law behind the encoder, sample by sample."""

    def __init__(self, law: FiniteLaw, losses: Losses, start: Fraction) -> None:
        self._law, self._losses = law, losses
        self._used = law.memory + 1
        resting = self._read(start)
        average = Fraction(0) if law.surface == "penetration" or law.relaxing is None else resting
        self._readings = [resting] * (self._used + losses.delay)
        self._averages = [average] * (losses.delay + 1)

    def forces(self, position: Fraction) -> list[float]:
        """The force held after a sample at this position; two where it changes within the interval."""
        reading = self._read(position)
        self._readings = [reading, *self._readings[:-1]]
        late = self._losses.delay
        ages = [late] if self._losses.part == 1 else [late, late - 1]
        forces = [
            self._law.force(tuple(self._readings[age : age + self._used]), self._averages[age])
            for age in ages
        ]
        after = float(self._law.averaged(self._averages[0], reading))  # exact, its digits would grow
        self._averages = [Fraction(after), *self._averages[:-1]]
        return [float(force) for force in forces]

    def _read(self, position: Fraction) -> Fraction:
        return self._losses.resolution * (position // self._losses.resolution)
