"""From a cycle that gains to a witness: a motion from outside that takes energy out, recomputed exactly."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import ceil
from typing import Any

from zwidth.checker import verify
from zwidth.passivity.document import unit_key
from zwidth.passivity.result import Evidence
from zwidth.passivity.storage.evidence.storage_function import loop_document
from zwidth.passivity.storage.evidence.switching import switch_positions
from zwidth.passivity.storage.grid.grid import Grid
from zwidth.passivity.storage.hand_bounds import HandBounds, hand_bounds, max_mean_speed
from zwidth.passivity.storage.law import FiniteLaw
from zwidth.passivity.storage.losses import Losses
from zwidth.passivity.storage.solve.value_iteration import ValueIteration
from zwidth.passivity.witness.motion import Motion, Repeat
from zwidth.passivity.witness.witness import FORMAT, rounded_energy
from zwidth.quantity.text import readable

_NEAREST = 40
"""Halvings of a count by which a hand on the upper edge of a cell may have to stay below it."""


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

    PICTURE = "cycle"

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
        return float(max_mean_speed(self.motion, self.losses.period, self.losses.part))

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
            f"a cycle of {part.last - part.first} samples, to {readable(self.depth, self.unit)} at up to "
            f"{readable(self.peak_speed, f'{self.unit}/s')}, extracts "
            f"{readable(self.energy_per_cycle, 'J')} in each round"
        )


def gain(iteration: ValueIteration[Grid], motion: str, bounds: HandBounds | None = None) -> Gain | None:
    """The cycle of a value iteration as a witness, or None if exactly recomputed it gains nothing.

    It keeps to the bounds, those of the grid unless others are given.
    """
    grid = iteration.grid
    bounds = bounds or hand_bounds(grid.law, grid.losses, grid.domain)
    for halvings in range(grid.count_steps.bit_length() - 1, _NEAREST, 4):
        round_ = [_place(grid, node, cell, halvings) for node, cell in iteration.cycle]
        start = _outside(grid)
        approach = _steps(start, round_[0], grid.domain.speed * grid.losses.resolution)
        x = [*approach, *round_[1:], round_[0]]
        part = Repeat(len(approach) - 1, len(x) - 1, 1)
        path = Motion(tuple(x), switch_positions(grid, x, part), (part,))
        document = _document(grid, path, motion, bounds)
        for _ in range(3):  # rounds that settle the law, rounds that pay for the approach, and once more
            found = _recomputed(document, _settling(grid, len(round_)))
            if found is None:
                break
            energy, per_round = found
            if energy > 0:
                return _witness(grid, document, path, energy, per_round, motion)
            path = path.repeated(document["repeats"]["times"] + ceil(-energy / per_round) + 1)
            document = _document(grid, path, motion, bounds)
    return None


def _place(grid: Grid, node: int, cell: int, halvings: int) -> Fraction:
    """Where the hand stands; on the upper edge of its cell it stays just below."""
    x = Fraction(node, grid.steps)
    if x == cell + Fraction(1, grid.every):
        x -= Fraction(1, 2**halvings * grid.every)
    return x * grid.losses.resolution


def _outside(grid: Grid) -> Fraction:
    """A place where the law gives no force to a hand that rests there."""
    if grid.law.surface != "none" or not grid.law.points:
        return Fraction(0)
    resolution = grid.losses.resolution
    for n in sorted(range(grid.domain.lowest, grid.domain.highest + 1), key=abs):
        if grid.law.force((n * resolution,)) == 0:
            return n * resolution
    return Fraction(0)


def _steps(start: Fraction, end: Fraction, most: Fraction) -> list[Fraction]:
    count = max(1, ceil(abs(end - start) / most))
    return [start + (end - start) * Fraction(k, count) for k in range(count + 1)]


def _settling(grid: Grid, samples: int) -> int:
    """Rounds after which the law does the same in each, however finely it remembers."""
    if grid.law.relaxing is None:
        return 20
    return 20 + ceil(64 / (1 - grid.law.relaxing[0]) / samples)


def _recomputed(document: dict[str, Any], settling: int) -> tuple[Fraction, Fraction] | None:
    """Energy and gain per round, over enough rounds for the law to settle; None without gain."""
    document["repeats"]["times"] = max(document["repeats"]["times"], settling)
    found = verify(document)
    if found.energy is None or found.gain is None:  # it would leave the bounds, or does not settle
        return None
    return (found.energy, found.gain) if found.gain > 0 else None


def _document(grid: Grid, motion: Motion, kind: str, bounds: HandBounds) -> dict[str, Any]:
    law = grid.law_document(kind, motion.positions if grid.every > 1 else None)
    document = motion_document("contact motion", grid.encoder, law, bounds, motion, kind)
    if motion.switch_positions:
        length = unit_key("position", kind).removeprefix("position_")
        document[f"switch_positions_{length}"] = list(motion.switch_positions)
    return document


def motion_document(
    kind: str, losses: Losses, law: dict[str, Any], bounds: HandBounds, path: Motion, motion: str
) -> dict[str, Any]:
    """A motion, of which a part is repeated, as data for the checker; `motion` is "linear" or "rotary"."""
    length = unit_key("position", motion).removeprefix("position_")
    return {
        "format": FORMAT,
        "kind": kind,
        "loop": loop_document(losses, motion),
        "law": law,
        "bounds": bounds.document(motion),
        unit_key("sample_period"): losses.period,
        "energy_J": Fraction(0),
        "repeats": path.repeats[0]._asdict(),
        f"positions_{length}": list(path.positions),
    }


def _witness(
    grid: Grid, document: dict[str, Any], motion: Motion, energy: Fraction, per_round: Fraction, kind: str
) -> Gain:
    part = motion.repeats[0]._replace(times=int(document["repeats"]["times"]))
    return Gain(
        {**document, "energy_J": energy},
        motion.repeated(part.times),
        energy,
        per_round,
        grid.law,
        grid.encoder,
        "rad" if kind == "rotary" else "m",
    )
