"""One law on one device, as a program for a machine."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields

import numpy as np

from zwidth.errors import InputError
from zwidth.loop.law import LIMIT, STEP, sampled_force, sampled_force_at
from zwidth.machine.firmware.program import Cells, Program, Variable
from zwidth.machine.firmware.specialise import specialised
from zwidth.machine.servo.cycle import pack
from zwidth.model.device.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.transfer_function import as_environment
from zwidth.native.compiled import Array
from zwidth.passivity.bounding import is_bounded
from zwidth.quantity.exact import Interval
from zwidth.quantity.text import in_words

MEMORY = "memory"

_SMALL = 1e100
"""Any force may be given where a law begins: the machine begins where it is."""


@dataclass(frozen=True, eq=False)
class LawProgram:
    """A law, from counts, or from a position where the device has no counts, to the force; and how it begins.

    `law` are the packed numbers that it was made of, see `loop.law`, `rest` what it remembers at rest, 2 × 2
    × n, see `loop.setup.resting_lines`.  The resolution is Δ, metres or radians per count, 0 where the
    position is given. It `pays` where force bounding at its end pays for the roundings of its operations as
    they stand.
    """

    program: Program
    law: Array
    rest: Array
    resolution: float
    pays: bool

    @property
    def step(self) -> float:
        """ΔF of the converter, 0 where it is not known."""
        return float(self.law[STEP])

    @property
    def limit(self) -> float:
        """The force limit, 0 where there is none."""
        return float(self.law[LIMIT])

    @property
    def remembers(self) -> int:
        """Numbers in its memory."""
        return int(self.rest.shape[2])

    def line(self, place: int, inside: bool) -> tuple[float, float]:
        """a and s of a place that holds a + s x at rest."""
        a, s = self.rest[int(inside), :, place]
        return float(a), float(s)

    def rest_texts(self, seen: str, written: Callable[[int, bool], str]) -> list[str]:
        """What each place holds at rest at `seen`, in C and in JavaScript, where `written` writes a line."""
        both = [(written(k, False), written(k, True)) for k in range(self.remembers)]
        return [o if o == i else f"{seen} > 0 ? {i} : {o}" for o, i in both] or ["0"]


def law_program(device: Device, environment: Environment | object, *, single: bool = False) -> LawProgram:
    """The program of a law.

    `single` where the machine keeps numbers in 24 bits: a law that reckons with its own rounding then sets
    more aside.
    """
    if not device.motor_side.is_certain:
        keys = (f.name for f in fields(device))
        named = ", ".join(in_words(key) for key in keys if isinstance(getattr(device, key), Interval))
        raise InputError(
            f"a machine runs one law with one period: give a single value, the one that you take, for {named}"
        )
    law = as_environment(environment, device=device)
    packed = pack(device, law, 0.0, _SMALL, single=single)
    resolution = float(device.exact("resolution"))
    cells = Cells(MEMORY, packed.rest.shape[2])
    if resolution > 0.0:
        program = specialised(sampled_force, (packed.law, cells, Variable("integer", "counts")))
    else:
        program = specialised(sampled_force_at, (packed.law, cells, Variable("real", "position")))
    return LawProgram(
        program, packed.law, np.asarray(packed.rest, dtype=np.float64), resolution, is_bounded(law)
    )
