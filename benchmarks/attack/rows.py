"""Laws in a chain behind a spring wall, written down once more, attacked where something is promised.

The laws are those that come with a claim: force bounding with a certificate, energy bounding,
the passive leap and the local spring with a proof on paper; extrapolation or saturation may
come before them, and the converter's steps after.
"""

from __future__ import annotations

from ctypes import byref, c_int
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

import zwidth as zw
from zwidth.model.rendering import (
    DualRate,
    EnergyBounding,
    Extrapolation,
    ForceBounding,
    PassiveLeap,
    Saturation,
)
from zwidth.model.rendering.rendering_law import LoopContext
from zwidth.passivity.bounding import check_bounding, is_bounded

from .judge import HEAVY, HEAVY_SHARE, LIGHT, Judged
from .loops import decades, near, period_of, typed
from .motions import ANGLE, COUNTED, DRAG, FRICTION, GATE, POSITION, Array, searches, seed

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
    best, last, room = np.zeros(length), c_int(), np.zeros(2 * length)
    score = searches().search_row(
        seed(rng), law, np.array(row.numbers), late, length, motions, climbs, best, byref(last), room
    )
    return score, best[: last.value] * row.unit


def forces(law: Array, row: Array, x: Array, force: Array) -> None:
    """The force of each sample, as the row of laws gives it."""
    searches().forces(law, row, x, x.size, force)
