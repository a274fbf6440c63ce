"""The plant of a one-sided wall: a device in a tied hand, or as given.

x = −G f,    G = N/D, strictly proper
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from ..document.fields import Number, Read, Record, numbers, only_if
from ..document.number import common_scale
from ..document.refusal import Invalid
from ..document.unit import DAMPING, MASS, SECONDS, STIFFNESS
from ..exact.enclosed import Enclosed, in_z
from .held_motion import Motion, motion_of, sampled

MOST_ORDER = 300

PLANT = {
    "plant": Record(
        {"numerator": numbers(least=1, most=MOST_ORDER), "denominator": numbers(least=1, most=MOST_ORDER)},
        default=None,
    ),
    "loop": Record(
        {
            "mass": Number(MASS, above=0),
            "damping": Number(DAMPING, least=0),
            "hand_mass": Number(MASS, least=0),
            "hand_damping": Number(DAMPING, least=0),
            "hand_stiffness": Number(STIFFNESS, least=0),
            "sample_period": Number(SECONDS, above=0),
            "delay": Number(SECONDS, least=0),
        },
        default=None,
    ),
}
"""One of both: G(z) in descending powers of z, or device and hand."""


class Plant(NamedTuple):
    """N and D in descending powers of z, within bounds."""

    numerator: list[Enclosed]
    denominator: list[Enclosed]

    @property
    def bits(self) -> int:
        """Of their fixed point; 0 where both are whole numbers."""
        return self.denominator[0].bits


def plant_of(told: Read, bits: int) -> Plant:
    """The plant of a document; computed with so many bits where it is not given."""
    if told.plant is not None:
        only_if(False, told.loop, "loop")
        return Plant(*(_known(part) for part in given(told.plant)))
    loop = only_if(True, told.loop, "loop")
    found = sampled(_touched(loop), bits)
    zero = Enclosed(bits, 0)
    return Plant(in_z(found.numerator), [*in_z(found.denominator), *[zero] * found.late])


def given(plant: Read) -> tuple[list[int], list[int]]:
    """N and D in whole numbers, in descending powers of z."""
    top, bottom = plant.numerator, plant.denominator
    if bottom[0] == 0 or len(top) >= len(bottom):
        raise Invalid("G(z) must be strictly proper")
    scale = common_scale((*top, *bottom))
    first, second = ([int(c * scale) for c in part] for part in (top, bottom))
    return first, second


def _known(whole: Sequence[int]) -> list[Enclosed]:
    return [Enclosed(0, c) for c in whole]


def _touched(loop: Read) -> Motion:
    mass, damping, k = loop.mass + loop.hand_mass, loop.damping + loop.hand_damping, loop.hand_stiffness
    return motion_of((mass, mass), (damping, damping), (k, k), loop.sample_period, loop.delay)
