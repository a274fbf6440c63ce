"""Laws in a chain behind a spring wall, written down once more, attacked where something is promised.

The laws are those that come with a claim: force bounding with a certificate, energy bounding,
the passive leap and the local spring with a proof on paper; extrapolation or saturation may
come before them, and the converter's steps after.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np
from numba import njit

import zwidth as zw
from zwidth.passivity.bounding import check_bounding, is_bounded
from zwidth.rendering import DualRate, EnergyBounding, Extrapolation, ForceBounding, PassiveLeap, Saturation
from zwidth.rendering.rendering_law import LoopContext

from .judge import HEAVY, HEAVY_SHARE, LIGHT, Judged
from .loops import decades, near, period_of, typed
from .motions import ANGLE, COUNTED, DRAG, FAMILIES, FRICTION, GATE, POSITION, _change, _draw, _inside

ROUNDING = 1e-9
"""Of what friction and damping took: the laws reckon with doubles."""

FULL_SHARE = 0.002
"""Of rows behind an encoder that the whole of `check` decides."""

(WALL, AHEAD, SATURATED, LAW, STEP, RESETS, SAMPLES, SLOPE, COUNT, CREDITED) = range(10)
BOUNDING, ENERGY, LEAP, LOCAL = range(4)


@dataclass(frozen=True)
class Row:
    """A device, a chain of laws, and its numbers for the referee: `numbers` in units of length `unit`."""

    device: zw.Device
    law: Any
    numbers: tuple[float, ...]
    unit: float


def draw(rng: np.random.Generator) -> Row:
    """A row near K = 2b/T, with and without encoder, converter steps, delay and friction."""
    period, k = period_of(rng), typed(decades(rng, 1, 4.5))
    damping = near(rng, k * period / 2) or typed(decades(rng, -3, 0))
    count = typed(decades(rng, -6, -3)) if rng.random() < 0.3 else Fraction(0)
    friction = near(rng, k * count / 2) if count else typed(decades(rng, -4, 0)) * int(rng.random() < 0.5)
    step = typed(decades(rng, -4, 0)) if rng.random() < 0.4 else None
    delay = period if rng.random() < 0.05 else Fraction(0)
    device = zw.Device(
        damping=damping, coulomb_friction=friction, resolution=count, sample_period=period, delay=delay,
        force_resolution=step,
    )  # fmt: skip
    numbers = [0.0] * 10
    last = _law(rng, int(rng.integers(0, 4)), numbers, device)
    before = _before(rng, numbers, k)
    unit = float(count) or (float(step / k) if step else 0.0) or float(friction / k) or 1e-3
    numbers[WALL], numbers[COUNT] = float(k), float(count > 0)
    numbers[STEP] = float(step or 0) / unit
    numbers[SATURATED] /= unit
    numbers[CREDITED] /= unit
    if numbers[LAW] == LOCAL and not numbers[SLOPE]:
        numbers[SLOPE] = min(float(k), 2 * float(damping / period))
    if numbers[LAW] == LEAP:
        numbers[SLOPE] = numbers[SLOPE] or float(k)
    return Row(device, zw.render(zw.Wall(k), *before, last), tuple(numbers), unit)


def _before(rng: np.random.Generator, numbers: list[float], k: Fraction) -> list[Any]:
    way = rng.random()
    if way < 0.6:
        return []
    if way < 0.8:
        ahead = typed(decades(rng, -1, 0.7))
        numbers[AHEAD] = float(ahead)
        return [Extrapolation(samples=ahead)]
    limit = typed(float(k) * decades(rng, -4, -1))
    numbers[SATURATED] = float(limit)
    return [Saturation(limit)]


def _law(rng: np.random.Generator, law: int, numbers: list[float], device: zw.Device) -> Any:
    numbers[LAW] = float(law)
    resets = bool(rng.random() < 0.3)
    numbers[RESETS] = float(resets)
    if law == BOUNDING:
        counted = bool(rng.random() < 0.75)
        numbers[SAMPLES] = float(counted)
        numbers[CREDITED] = float(device.exact("coulomb_friction")) if counted else 0.0
        return ForceBounding(encoder="counted" if counted else "ideal", resets=resets)
    if law == ENERGY:
        return EnergyBounding()
    if law == LEAP:
        numbers[CREDITED] = float(device.exact("coulomb_friction"))
        return PassiveLeap(resets=resets)
    numbers[SAMPLES] = float(rng.integers(1, 6))
    if rng.random() < 0.5:
        return DualRate(samples=int(numbers[SAMPLES]))
    slope = near(rng, 2 * device.exact("damping") / device.exact("sample_period")) or Fraction(1)
    numbers[SLOPE] = float(slope)
    return DualRate(samples=int(numbers[SAMPLES]), slope=slope)


def judge(row: Row, rng: np.random.Generator) -> Judged:
    """What is claimed of a row, attacked."""
    said = claimed(row.device, row.law, full=row.numbers[COUNT] == 0 or rng.random() < FULL_SHARE)
    if said not in ("passive", "theorem"):
        return Judged("rows", said)
    effort = HEAVY if rng.random() < HEAVY_SHARE else LIGHT
    score, motion = attack(row, rng, *effort)
    if score <= ROUNDING:
        return Judged("rows", said)
    return Judged("rows", said, f"{motion.size} samples take out {score:.3g} of what is lost")


def claimed(device: zw.Device, law: Any, full: bool) -> str:
    """What is said of a row: by `check`, or without its game, which takes seconds where there are counts.

    `check` speaks of an ideal actuator: behind converter steps only what counts them is held to its word.
    """
    if full and device.force_resolution is None:
        return str(zw.check(device, law).outcome)
    if device.delay == 0 and is_bounded(law):
        return str(check_bounding(device, law).outcome)
    theorem = law.laws[-1].theorem(LoopContext(device, law.environment))
    return "theorem" if theorem is not None and theorem.holds_on(device) else "refused"


def attack(row: Row, rng: np.random.Generator, motions: int, climbs: int) -> tuple[float, np.ndarray]:
    """(taken out over lost, positions in metres) of the best motion found."""
    device = row.device
    law = np.zeros(13)
    law[GATE], law[COUNTED], law[ANGLE] = POSITION, row.numbers[COUNT], 3.0
    law[FRICTION] = float(device.exact("coulomb_friction")) / row.unit
    law[DRAG] = float(device.exact("damping") / device.exact("sample_period"))
    late = int(device.exact("delay") / device.exact("sample_period"))
    length = int(rng.integers(6, 100))
    score, x = _search(rng, law, np.array(row.numbers), late, length, motions, climbs)
    return score, x * row.unit


@njit(cache=True)
def _search(rng, law, row, late, length, motions, climbs):
    best, trial, force = np.zeros(length), np.zeros(length), np.zeros(length)
    score, last = -1e300, 0
    for k in range(motions + climbs):
        if k < motions:
            _draw(rng, law, k % FAMILIES, trial)
        else:
            trial[:] = best
            _change(rng, law, trial, 0)
        _inside(law, trial)
        forces(law, row, trial, force)
        found, end = _taken(law, trial, force, late)
        if found > score:
            score, last = found, end
            best[:] = trial
    return score, best[: last + 1].copy()


@njit(cache=True)
def _taken(law, x, force, late):
    """The most that was taken out over what was lost until then, and when."""
    out, lost, best, at = 0.0, 0.0, -1e300, x.shape[0] - 1
    for k in range(x.shape[0] - 1):
        moved = x[k + 1] - x[k]
        held = force[k - late] if k >= late else 0.0
        took = law[FRICTION] * abs(moved) + law[DRAG] * moved * moved
        out -= held * moved + took
        lost += took + 1e-12 * abs(held * moved)
        if k > 1 and lost > 0.0 and out / lost > best:
            best, at = out / lost, k + 1
    return best, at


@njit(cache=True)
def forces(law, row, x, force):
    """The force of each sample, as the row of laws gives it."""
    counted, p = row[COUNT] > 0.0, law[DRAG]
    energy, slope, left, reference, base, off, spare, held = 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0
    before = 0.0
    for k in range(x.shape[0]):
        q = np.floor(x[k]) if counted else x[k]
        if k == 0:
            before, reference = q, q
        moved = q - before
        seen = q + row[AHEAD] * moved
        wish = row[WALL] * seen if seen > 0.0 else 0.0
        if row[SATURATED] > 0.0:
            wish = min(max(wish, -row[SATURATED]), row[SATURATED])
        half = row[STEP] / 2.0
        if row[LAW] == BOUNDING:
            size = 1.0 if counted and row[SAMPLES] > 0.0 else 0.0
            if row[RESETS] > 0.0 and held == 0.0:
                energy, slope = 0.0, 0.0
            energy, slope, room = _bounded(energy, slope, held, moved, p, row[CREDITED], size)
            f = min(max(wish, -max(room - half, 0.0)), max(room - half, 0.0))
        elif row[LAW] == ENERGY:
            room = max(abs(held + 2.0 * p * moved) - half, 0.0)
            f = min(max(wish, -room), room)
        elif row[LAW] == LEAP:
            if row[RESETS] > 0.0 and held == 0.0:
                energy = min(energy, 0.0)
            energy += held * moved + p * moved * moved + row[CREDITED] * abs(moved)
            room = np.sqrt(2.0 * row[SLOPE] * max(energy, 0.0))
            f = min(max(wish, -room), room)
        else:
            f = 0.0 if off > 0.0 else max(base + row[SLOPE] * (q - reference), 0.0)
            if left <= 0.0:
                room = np.sqrt(f * f + 2.0 * row[SLOPE] * spare)
                new = min(max(wish, 0.0), room)
                spare = max(spare + (f * f - new * new) / (2.0 * row[SLOPE]), 0.0)
                left, reference, base = row[SAMPLES], q, new
                off = 1.0 if wish <= 0.0 else 0.0
                f = new
            left -= 1.0
        if row[STEP] > 0.0:
            f = row[STEP] * np.floor(f / row[STEP] + 0.5)
        before, held = q, f
        force[k] = f


@njit(cache=True)
def _bounded(energy, slope, held, moved, p, friction, size):
    """(E, g, the largest force) of force bounding after a move, as its docstring has it."""
    low, high = held - friction, held + friction
    if moved != 0.0:
        middle = held + 2.0 * p * moved + (friction if moved > 0.0 else -friction)
        low, high = middle - p * size, middle + p * size
    new = min(max(slope, low), high)
    beyond = max(abs(new - held) - friction, 0.0)
    energy += new * moved - beyond * beyond / (4.0 * p) - abs(new - slope) * size / 2.0
    spare = energy - abs(new) * size / 2.0
    if spare < 0.0:
        energy, new, spare = 0.0, 0.0, 0.0
    return energy, new, friction + 2.0 * np.sqrt(p * spare)
