"""Springs by the thousand: the conditions of a spring wall, compared in doubles where that is beyond doubt.

    b ≥ (K T/4) [2d + 1 + 2α + √((2d + 1)² + 8α(d + 1))]     and     f_c ≥ K Δ/2,      delay = (d + α) T

are enough and necessary (`spring_stiffness`; Abbott & Okamura 2005).  A loop near its limit is left to
`zwidth.check`: there doubles may be wrong, and the motion that refutes it may be too long to be found.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import inf, nextafter
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from zwidth.model.device import Device
from zwidth.model.environment import Wall
from zwidth.model.environment.environment import Average
from zwidth.passivity.budget import DELAY, LIMITS, QUANTIZATION, SAMPLING, VIRTUAL_DAMPING
from zwidth.passivity.criterion_choice import Decision, decide
from zwidth.passivity.linear.boundary import LARGEST, SMALLEST
from zwidth.passivity.linear.contact import DampedWall
from zwidth.passivity.linear.criterion import LinearRefutation
from zwidth.passivity.linear.loop import HIGH_DEGREE, LinearLoop
from zwidth.quantity.exact import Exact
from zwidth.study.chunks.layout import Layers
from zwidth.study.sweeps.axes import Axis, Columns
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

    `numbers`: by name the values of each number, exact: as many as its axis has, or one where it is not
        varied.
    `along`: by name the axis along which it varies; None where it does not.
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


# Walls with virtual damping that differ in their stiffness alone: most are decided by a few of them.


FEWEST = 8
"""Loops of a line below which each is asked by itself: the ends take as long."""

_ANGLES = 600
"""Of the frequencies for each sample of delay and filter, and twice as many evenly over their logarithm."""

_LONGEST, _SLOWEST = 24, 0.999
"""Samples of delay and filter, and a pole, up to which so many are enough."""

_AT_ONCE = 2_000_000
"""Needs that are compared at a time."""

_NEAR = 1e-4
"""Of the largest need: what a place beside it may be off, between two angles."""

_APART = 1e-2
"""Relative difference of two sides that is more than the bounds on them are wide."""


class Part(NamedTuple):
    """Loops of a line that have one answer, but for what binds.

    `about`: of the entries of an answer those that make the part.
    `binding`: what binds: its place in `LIMITS`, from 1 on; 0 where it must be asked.
    """

    places: NDArray[np.intp]
    about: Mapping[str, str]
    binding: NDArray[np.uint8]


def is_of_walls(loop: Loop, parameters: Sequence[Parameter]) -> bool:
    """Whether all loops of a sweep are walls of single numbers before a device without stiction."""
    device, wall = loop.subject, loop.environment
    if not isinstance(device, Device) or not isinstance(wall, Wall) or loop.options:
        return False
    if wall.clamped or not (wall.is_certain and device.is_certain and device.stiction is None):
        return False
    return all(own.part in ("device", "law") for own in parameters)


def parts(loop: Loop, stiffnesses: Floats) -> list[Part]:
    """What is known of a line, as conjectured before one loop of each part is asked; [] where nothing is.

    `stiffnesses`: of all of them [N/m; N·m/rad].
    """
    device, wall = loop.subject, loop.environment
    assert isinstance(device, Device)
    assert isinstance(wall, Wall)
    order = np.argsort(stiffnesses)

    def at(place: int) -> Decision:
        return decide(device, wall.replace(stiffness=Exact(float(stiffnesses[order[place]]))))

    softest = at(0)
    law = softest.wall
    if not isinstance(law, DampedWall) or not _is_usual(law, softest.loop):
        return []
    covered = bisect_left(range(len(order)), True, key=lambda place: not _covers(at(place)))
    violated = _violated(covered, len(order), at)
    binding = _binding(softest, law, stiffnesses)
    softer, stiffer = order[:covered], order[violated:]
    found = (softer, "passive", "made and broken"), (stiffer, "active", "kept")
    return [
        Part(places, {"outcome": outcome, "contact": contact}, binding[places])
        for places, outcome, contact in found
        if len(places)
    ]


def _is_usual(law: DampedWall, loop: LinearLoop) -> bool:
    """Whether what is compared below has been looked at closely enough."""
    if law.damping <= 0 or loop.degree > HIGH_DEGREE:
        return False
    if isinstance(law.estimate, Average):
        return law.estimate.weights[0] >= 0 and loop.whole_delay + len(law.estimate.weights) <= _LONGEST
    return law.estimate.pole <= _SLOWEST and loop.whole_delay < _LONGEST


def _covers(decision: Decision) -> bool:
    law = decision.wall
    assert isinstance(law, DampedWall)
    need = law.required_damping(decision.loop)
    if need is None or decision.loop.damping < need:
        return False
    setting = decision.setting
    return setting.coulomb_friction >= law.required_friction(setting.resolution, decision.loop.period)


def _violated(first: int, size: int, at: Callable[[int], Decision]) -> int:
    """The first place from which on every wall violates the criterion; `size` where none is found."""

    def is_rising(place: int) -> bool:
        decision = at(place)
        cosine = getattr(decision.viscous, "cosine", None)
        if not isinstance(decision.viscous, LinearRefutation) or cosine is None:
            return False
        softer = at(0).loop.required_damping_at(cosine)
        here = decision.loop.required_damping_at(cosine)
        return place > 0 and here > softer * (1 + _NEAR) and here > float(decision.loop.damping)

    if first >= size or not is_rising(size - 1):
        return size
    return bisect_left(range(size), True, first, key=is_rising)


def _binding(decision: Decision, law: DampedWall, stiffnesses: Floats) -> NDArray[np.uint8]:
    """What binds, as `passivity.budget` has it; 0 where it is not beyond doubt."""
    loop = decision.loop
    samples = loop.whole_delay + 2 + (len(law.estimate.weights) if isinstance(law.estimate, Average) else 0)
    even, fine = np.linspace(0, np.pi, _ANGLES * samples)[1:], np.geomspace(1e-4, np.pi, 2 * _ANGLES)[:-1]
    needs = _Needs(loop, law, np.concatenate([fine, even]))
    blocks = np.array_split(stiffnesses, -(-len(stiffnesses) * (len(fine) + len(even)) // _AT_ONCE))
    found = [needs.tightest(block) for block in blocks]
    most, first = (np.concatenate(rows) for rows in zip(*found, strict=True))
    setting = decision.setting
    steps = stiffnesses + float(law.damping * law.estimate.variation / loop.period)
    with np.errstate(divide="ignore", invalid="ignore"):
        friction = steps * float(setting.resolution) / 2
        friction = np.where(friction > 0, friction / float(setting.coulomb_friction), 0)
        viscous = np.where(most > 0, most / float(loop.damping), 0)
        sure = (first >= 0) & (np.abs(friction - viscous) > _APART * np.maximum(friction, viscous))
    codes = np.array([LIMITS.index(name) + 1 for name in (SAMPLING, VIRTUAL_DAMPING, DELAY)])[first]
    codes = np.where(friction > viscous, LIMITS.index(QUANTIZATION) + 1, codes)
    return np.where(sure, codes, 0).astype(np.uint8)


class _Needs:
    """The damping that the criterion asks for at many angles ωT, and what of it comes from the damper."""

    def __init__(self, loop: LinearLoop, law: DampedWall, theta: Floats) -> None:
        self._period, self._part, self._virtual = (
            float(loop.period),
            float(loop.part_delay),
            float(law.damping),
        )
        z = np.exp(1j * theta)
        self._velocity = _velocity(law, self._period, z)
        held = self._period / 4 * (1 - 1 / z) / np.sin(theta / 2) ** 2
        delayed = held * z ** -float(loop.whole_delay) * (1 - self._part + self._part / z)
        self._spring, self._damper = delayed.real, self._virtual * (delayed * self._velocity).real
        self._dynamics = self._virtual * (held * self._velocity).real

    def tightest(self, stiffnesses: Floats) -> tuple[Floats, NDArray[np.intp]]:
        """What each wall needs at most; which of hold, damper and delay asks for most there, −1 in doubt."""
        k = stiffnesses[:, None]
        needs = k * self._spring + self._damper
        if self._part:
            switched = np.abs(k + self._virtual * self._velocity) ** 2
            extra = self._period**2 * self._part * (1 - self._part) * switched
            needs = (needs + np.sqrt(needs**2 + extra)) / 2
        most = needs.max(axis=1)
        hold = stiffnesses * self._period / 2
        slack = _NEAR * (np.abs(most) + hold + np.abs(self._dynamics).max())
        row, column = np.nonzero(needs >= (most - slack)[:, None])  # where it may be tightest
        dynamics = self._dynamics[column]
        shares = np.array([hold[row], dynamics, needs[row, column] - hold[row] - dynamics])
        largest, first = shares.argmax(axis=0), np.empty(len(stiffnesses), np.intp)
        first[row] = largest
        doubt = (shares.max(axis=0) - np.median(shares, axis=0) <= slack[row]) | (largest != first[row])
        first[row[doubt]] = -1
        return most, first


def _velocity(law: DampedWall, period: float, z: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """V(z) = Σ w_j z⁻ʲ (1 − z⁻¹)/T."""
    estimate = law.estimate
    if isinstance(estimate, Average):
        weighed = np.polyval([float(w) for w in estimate.weights[::-1]], 1 / z)
    else:
        pole = float(estimate.pole)
        weighed = (1 - pole) / (1 - pole / z)
    return np.asarray(weighed * (1 - 1 / z) / period)
