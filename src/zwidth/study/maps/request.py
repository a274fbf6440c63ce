"""What a map is of: a device, a grid of walls, the hands that are known.

A cell stands for the wall at its middle, (K, B) = low + (i + ½)(high − low)/n, as the double nearest to it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment import BackwardDifference, Wall
from zwidth.model.environment.velocity import VelocityEstimator
from zwidth.model.operator import Dowel, Finger, HandsOn
from zwidth.model.operator.hand_impedance import HandImpedance, as_hand
from zwidth.passivity.scope import Hands, Scope, scope_of
from zwidth.passivity.stability.known_hand import motion_of
from zwidth.passivity.transmission import as_one_body, elastic_of, is_ideal
from zwidth.quantity.exact import Exact, Interval, RealLike, ends
from zwidth.quantity.parameter import read_number
from zwidth.quantity.text import in_words
from zwidth.study.chunks.layout import Layout

Array = NDArray[np.float64]

FORMAT = "zwidth map 1"

MOST_CELLS = 100_000_000
"""Of one map; more are a mistake in the numbers."""

CHUNK = 128
"""Cells along one side of what is computed and stored at a time."""


@dataclass(frozen=True)
class Axis:
    """The middles of n equal cells from `low` to `high`."""

    low: Exact
    high: Exact
    cells: int

    @property
    def values(self) -> Array:
        """The middles, each the nearest double."""
        step = (self.high.fraction - self.low.fraction) / self.cells
        return np.array([float(self.low.fraction + step * (i + Fraction(1, 2))) for i in range(self.cells)])

    @property
    def width(self) -> float:
        """Of one cell."""
        return (float(self.high) - float(self.low)) / self.cells


@dataclass(frozen=True)
class Request:
    """All that the bits of a map depend on."""

    device: Device
    """That as which it is proved: of one with a transmission what is seen at its motor."""
    whole: Device
    """As it is."""
    stiffness: Axis
    virtual_damping: Axis
    velocity_filter: VelocityEstimator
    hands: tuple[tuple[str, HandImpedance], ...]

    @property
    def gives_way(self) -> bool:
        """Whether the device has a transmission."""
        return self.whole.transmission is not None

    @cached_property
    def exactly(self) -> bool:
        """Whether walls are decided by motor, transmission and hand together."""
        return is_ideal(self.whole) and elastic_of(self.whole, Wall(1)) is not None

    @property
    def layout(self) -> Layout:
        """The arrays of the map."""
        stable = {f"stable_{name}": "bool" for name, _ in self.hands}
        return Layout(
            "map",
            FORMAT,
            self.describe(),
            {"stiffness": self.stiffness.values, "virtual_damping": self.virtual_damping.values},
            (CHUNK, CHUNK),
            {"passive": "bool", "passive_sustained": "bool", "admissible_speed": "float64"} | stable,
        )

    def describe(self) -> dict[str, Any]:
        """The request as JSON holds it; exact numbers as text."""
        return {
            "device": {
                **{
                    key: str(value.fraction)
                    for key, value in self.whole.parameters().items()
                    if isinstance(value, Exact)
                },
                **({"transmission": repr(self.whole.transmission)} if self.gives_way else {}),
                "motion": self.device.motion,
            },
            "stiffness": _axis(self.stiffness),
            "virtual_damping": _axis(self.virtual_damping),
            "velocity_filter": [
                [str(c) for c in part]
                for part in self.velocity_filter.transfer(self.device.exact("sample_period"))
            ],
            "hands": {
                name: [str(ends(value)[0]) for value in (hand.mass, hand.stiffness, hand.damping)]
                for name, hand in self.hands
            },
            "chunk": CHUNK,
        }


def _axis(axis: Axis) -> list[str]:
    return [str(axis.low.fraction), str(axis.high.fraction), str(axis.cells)]


def standard_hands(motion: str = "linear") -> dict[str, Any]:
    """No hand, a finger and a wooden dowel, by name; on a device that turns no hand and two on a wheel."""
    if motion == "rotary":
        return {"none": None, "hands-on": HandsOn()}
    return {"none": None, "finger": Finger(), "dowel": Dowel(force=1)}


def request(
    device: Device,
    stiffness: tuple[RealLike, RealLike],
    virtual_damping: tuple[RealLike, RealLike],
    cells: tuple[int, int],
    velocity_filter: VelocityEstimator | None,
    hands: Mapping[str, Any] | None,
) -> Request:
    """Read what `z_width` is given."""
    if not device.is_certain:
        wide = (key for key, value in device.parameters().items() if isinstance(value, Interval))
        given = in_words(next(wide, "transmission"))
        raise InputError(f"a map is of one device, and its {given} is an interval; choose a value in it")
    usual = standard_hands(device.motion) if device.transmission is None else {}
    named = usual if hands is None else dict(hands)
    known = tuple((name, as_hand(hand)) for name, hand in named.items())
    for name, hand in known:
        if not motion_of(device, hand).is_certain:
            raise InputError(
                f"hand {name}: a map needs one value of each number; robust_boundary covers intervals"
            )
    velocity = BackwardDifference() if velocity_filter is None else velocity_filter
    Wall(1, 1, velocity_filter=velocity)  # says what is wrong with it
    if np.shape(cells) != (2,) or not all(isinstance(n, Real) and n >= 1 and n % 1 == 0 for n in cells):
        raise InputError(f"cells are two whole numbers ≥ 1, such as (200, 200), got {cells!r}")
    k = _read_axis("stiffness", stiffness, cells[0], device.motion)
    b = _read_axis("virtual_damping", virtual_damping, cells[1], device.motion)
    if k.low.fraction < 0:
        raise InputError(f"stiffness must be ≥ 0, got {k.low:g}: a negative spring pulls the hand in")
    if k.cells * b.cells > MOST_CELLS:
        raise InputError(
            f"a map has at most {MOST_CELLS} cells, got {k.cells * b.cells}; a picture needs far fewer"
        )
    return Request(as_one_body(device), device, k, b, velocity, known)


def _read_axis(name: str, both: tuple[RealLike, RealLike], cells: int, motion: str) -> Axis:
    given = list(both) if isinstance(both, np.ndarray) else both
    span = read_number(given, name, name, uncertain=True, motion=motion)
    if not isinstance(span, Interval) or span.low == span.high:
        raise InputError(f"{name} is its two ends, such as (0, 1000), got {span}")
    return Axis(span.low, span.high, int(cells))


def scopes(asked: Request, speed: float) -> dict[str, Scope]:
    """The scope of each region by its name; `speed` is that up to which a wall is quiet [m/s; rad/s]."""
    every = scope_of(asked.device, Wall(1))
    if asked.gives_way:
        every = every.replace(transmission="any")
        this = scope_of(asked.whole.motor_side, Wall(1)).replace(transmission="as given")
        kept = this if asked.exactly else every
        return {"passive": every, "passive_sustained": kept.replace(contact="kept")}
    late = asked.device.exact("delay") / asked.device.exact("sample_period")
    known = every.replace(
        contact="kept",
        encoder="not counted" if every.encoder == "counted" else "ideal",
        coulomb_friction=None,
        assumed=(),
    )
    return {
        "passive": every,
        "passive_sustained": every.replace(contact="kept"),
        "quiet": every.replace(hands=Hands(speed=speed, in_each_part=late.denominator != 1)),
        **{f"stable_{name}": known.replace(hands=Hands(impedance=name)) for name, _ in asked.hands},
    }
