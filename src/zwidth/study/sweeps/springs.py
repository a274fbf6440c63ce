"""Springs by the thousand: the conditions of a spring wall, compared in doubles where that is beyond doubt.

    b ≥ (K T/4) [2d + 1 + 2α + √((2d + 1)² + 8α(d + 1))]     and     f_c ≥ K Δ/2,      delay = (d + α) T

are enough and necessary (`spring_stiffness`; Abbott & Okamura 2005).  A loop near its limit is left to
`zwidth.check`: there doubles may be wrong, and the motion that refutes it may be too long to be found.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import inf, nextafter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zwidth.model.device import Device
from zwidth.model.environment import Wall
from zwidth.passivity.budget import DELAY, QUANTIZATION, SAMPLING
from zwidth.passivity.linear.boundary import LARGEST, SMALLEST
from zwidth.quantity.exact import Exact
from zwidth.study.chunks.layout import Layers
from zwidth.study.sweeps.axes import Axis
from zwidth.study.sweeps.columns import Columns
from zwidth.study.sweeps.loops import Loop, Parameter, changed

Floats = NDArray[np.float64]

_OF_DEVICE = ("damping", "coulomb_friction", "resolution", "sample_period", "delay")
"""On which the conditions depend, beside the stiffness."""

_SURE = 1e-9
"""Relative difference of two sides that is more than all roundings of both together."""

_SURELY_FOUND = 0.05
"""Part by which Coulomb friction must fall short for the motion over an encoder's edge to be surely found."""


@dataclass(frozen=True)
class Springs:
    """Springs on a grid.

    Parameters
    ----------
    numbers
        By name the values of each number, exact: as many as its axis has, or one where it is not varied.
    along
        By name the axis along which it varies; None where it does not.
    """

    numbers: Mapping[str, Sequence[Fraction]]
    along: Mapping[str, int | None]

    def layers(self, cells: tuple[slice, ...], shape: tuple[int, ...], columns: Columns) -> _Decided:
        """The answers on the cells of a chunk, and where they are beyond doubt."""
        given = {name: self._doubles(name, cells) for name in self.numbers}
        k, b, friction = given["stiffness"], given["damping"], given["coulomb_friction"]
        hold = k * given["sample_period"] / 2
        need = hold * _samples(given["delay"] / given["sample_period"])
        steps = k * given["resolution"] / 2
        damped, covered = b >= need, friction >= steps
        viscous = _loads(need, b)
        edges = _loads(steps, friction)
        delayed = need - hold
        sure = (
            (_apart(b, need) | ((need == 0) & (b >= 0)))
            & ((friction >= steps * (1 + _SURE)) | (friction < steps * (1 - _SURELY_FOUND)) | (steps == 0))
            & _apart(edges, viscous)
            & _apart(delayed, hold)
        )
        passive = damped & covered
        binding = np.where(edges > viscous, QUANTIZATION, np.where(delayed > hold, DELAY, SAMPLING))
        found: dict[str, Any] = {
            "outcome": np.where(passive, "passive", "active"),
            "contact": np.where(passive, "made and broken", "kept"),
            "encoder": np.where(given["resolution"] > 0, "counted", "ideal"),
            "binding": binding,
        }
        layers: Layers = {name: np.zeros(shape, columns[name].kind) for name in columns}
        for name, words in found.items():
            layers[name][...] = _codes(words, columns[name].words)
        layers["max_stiffness"][...] = self._largest(cells)
        return _Decided(layers, np.broadcast_to(sure, shape))

    def _row(self, name: str, cells: tuple[slice, ...]) -> Sequence[Fraction]:
        axis = self.along[name]
        return self.numbers[name] if axis is None else self.numbers[name][cells[axis]]

    def _doubles(self, name: str, cells: tuple[slice, ...]) -> Floats:
        """A number along its axis, of length 1 along the others."""
        row, axis = self._row(name, cells), self.along[name]
        shape = [len(row) if k == axis else 1 for k in range(len(cells))]
        return np.array([float(value) for value in row]).reshape(shape)

    def _largest(self, cells: tuple[slice, ...]) -> Floats:
        """The largest passive stiffness of every combination of the other numbers."""
        rows = [(self._row(name, cells), self.along[name]) for name in _OF_DEVICE]
        lengths = {axis: len(row) for row, axis in rows if axis is not None}
        found = np.empty([lengths.get(k, 1) for k in range(len(cells))])
        for place in np.ndindex(found.shape):
            numbers = (row[0] if axis is None else row[place[axis]] for row, axis in rows)
            found[place] = largest_spring(*numbers)
        return found


@dataclass(frozen=True)
class _Decided:
    """Answers, and where they are beyond doubt."""

    layers: Layers
    sure: NDArray[np.bool_]


def springs(loop: Loop, parameters: Sequence[Parameter], axes: Sequence[Axis]) -> Springs | None:
    """The loops of a sweep, where all of them are spring walls of single numbers; else None."""
    device, wall = loop.subject, loop.environment
    if not isinstance(device, Device) or not isinstance(wall, Wall) or "contact" in loop.options:
        return None
    if not (wall.spring and wall.is_certain and device.is_certain and device.stiction is None):
        return None
    if any(own.part not in ("device", "law") or own.name == "virtual_damping" for own in parameters):
        return None
    stiffness = wall.stiffness
    assert isinstance(stiffness, Exact), "a certain wall"
    numbers = {name: [device.exact(name)] for name in _OF_DEVICE} | {"stiffness": [stiffness.fraction]}
    along: dict[str, int | None] = dict.fromkeys(numbers)
    for k, (own, axis) in enumerate(zip(parameters, axes, strict=True)):
        name = _MADE_OF.get(own.key, own.key)
        if name not in numbers:
            continue  # no condition depends on it
        if along[name] is not None:
            return None
        loops = [changed(loop, {own: value}) for value in axis.values]
        numbers[name] = [_number(each, name) for each in loops]
        along[name] = k
    return Springs(numbers, along)


_MADE_OF = {"rate": "sample_period", "counts_per_turn": "resolution"}
"""A number that another one is made of."""


def _number(loop: Loop, name: str) -> Fraction:
    thing = loop.environment if name == "stiffness" else loop.subject
    value: Exact = getattr(thing, name)
    return value.fraction


def largest_spring(
    damping: Fraction, friction: Fraction, resolution: Fraction, period: Fraction, delay: Fraction
) -> float:
    """The largest double K that is passive, as `check` has it: the next one is not.

    inf where every stiffness is, 0 where no spring is.
    """
    late = delay / period
    part = late % 1
    linear = 2 * late + 1

    def holds(stiffness: float) -> bool:
        k = Exact(stiffness).fraction
        half = k * period / 2
        slow = 2 * damping >= half * linear  # without it the square below would do for b = 0
        return (
            slow
            and damping * damping - damping * half * linear - part * (1 - part) * half * half >= 0
            and 2 * friction >= k * resolution
        )

    viscous = 2 * float(damping) / float(period) / float(_samples(np.float64(late)))
    guess = min(viscous, 2 * float(friction) / float(resolution) if resolution else inf)
    if guess > LARGEST:
        return inf
    if guess < SMALLEST:
        return 0.0
    while not holds(guess):
        guess = nextafter(guess, 0)
    while holds(above := nextafter(guess, inf)):
        guess = above
    return guess


def _samples(late: Any) -> Any:
    """½ [2d + 1 + 2α + √((2d + 1)² + 8α(d + 1))]: what a delay of so many samples multiplies K T/2 with."""
    whole = np.floor(late)
    part = late - whole
    root = np.sqrt((2 * whole + 1) ** 2 + 8 * part * (whole + 1))
    return (2 * late + 1 + root) / 2


def _loads(need: Floats, has: Floats) -> Floats:
    """What is needed over what there is; 0 where nothing is needed."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(need > 0, np.where(has > 0, need / has, np.inf), 0.0)


def _apart(one: Floats, other: Floats) -> NDArray[np.bool_]:
    """Where two numbers differ by more than rounding."""
    with np.errstate(invalid="ignore"):
        differ = np.abs(one - other) > _SURE * np.maximum(np.abs(one), np.abs(other))
    return np.asarray(differ | (np.isinf(one) != np.isinf(other)))


def _codes(words: NDArray[np.str_], known: tuple[str, ...]) -> NDArray[np.uint8]:
    """Each word as its place among the known ones, from 1 on."""
    found = np.zeros(words.shape, np.uint8)
    for code, word in enumerate(known, start=1):
        found[words == word] = code
    return found
