"""How far a machine's force is from the law's, at any sample, whatever the hand does.

    |f̃_k − f_k| ≤ ε        for all readings within their range

f is the law in real numbers, with the force that no converter rounds; f̃ what the machine's numbers give, to
the converter's nearest step.  The force that is off moves no more than ε |Δx| of energy in a move Δx, which
Coulomb friction of ε takes: so a loop that is passive with f_c − ε is passive with f_c on this machine.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import floor, inf, isfinite, log2
from typing import Literal

import numpy as np

from zwidth.errors import InputError
from zwidth.machine.firmware.bound import Bound, plain
from zwidth.machine.firmware.evaluation import Arithmetic, Exact, NoBound, Rounded
from zwidth.machine.firmware.fixed import Fixed, TooLarge, lowered
from zwidth.machine.firmware.invariant import Invariant, Rest, invariant
from zwidth.machine.firmware.law import LawProgram
from zwidth.machine.firmware.program import Constant, Operation, Statement, Variable
from zwidth.machine.firmware.simplified import FOLDED, simplified
from zwidth.machine.firmware.units import Scale, Unit
from zwidth.native.compiled import Array

Number = Literal["double", "float", "fixed"]

_FRACTIONS = {32: (24, 16, 8, 4, 1), 64: (40, 32, 24, 16, 8, 1)}
"""Parts of a force unit that are tried, as powers of two, by word: whole bytes are shifted in no time."""
_ANY = 2**31 - 1
"""Counts to each side that 32 bits hold."""
_WIDE = 2.0**-10
"""Of the force: an error beyond this is worth a wider word."""
_TRIES = 4
"""Times that a program is written anew, for numbers as large as their errors make them."""


@dataclass(frozen=True, eq=False)
class Machine:
    """A law in the numbers of a machine, for readings from the lowest to the highest [counts; m; rad].

    `error` is ε with half a step of the converter in it, `largest_force` the largest |f| that the machine can
    give [N; N·m]; None where no bound was found, for `reason`.  `fixed` is the program in whole numbers,
    where they are.
    """

    law: LawProgram
    number: Number
    counts: tuple[float, float]
    error: float | None
    reason: str = ""
    fixed: Fixed | None = None
    largest_force: float | None = None

    @property
    def cuts_readings(self) -> bool:
        """Whether a reading can lie outside of what is claimed: it is then taken as the nearest inside."""
        return self.law.resolution == 0.0 or max(map(abs, self.counts)) < _ANY

    @property
    def half_step(self) -> float:
        """What the converter's rounding is in ε."""
        return self.law.step / 2

    @property
    def rounding(self) -> float | None:
        """What the machine's numbers are in ε."""
        return None if self.error is None else max(self.error - self.half_step, 0.0)


def machine(
    law: LawProgram,
    number: Number,
    counts: tuple[float, float],
    force_unit: float | None = None,
    enough: float | None = None,
) -> Machine:
    """A law in the numbers of a machine, with the bound of their error.

    In fixed point `force_unit` is the unit of the force where the device's converter has no known step [N;
    N·m], and a rounding that is `enough` needs no wider numbers [N; N·m]; by default a 1000th of the force.
    """
    if number != "double" and not law.pays:
        law = replace(law, program=simplified(law.program))
    converter = _converter(law)
    if number != "fixed":
        arithmetic = DOUBLE if number == "double" else FLOAT
        try:
            found = _bounded(law, counts, arithmetic, converter, _binary_errors(law, counts, arithmetic))
        except NoBound as reason:
            return Machine(law, number, counts, None, str(reason))
        return _machine(law, number, counts, found, None)
    if law.resolution == 0.0:
        raise InputError(
            "fixed point counts encoder steps, and the device has no resolution: give it one, or take float"
        )
    try:
        return _fixed(law, counts, converter, force_unit, enough)
    except NoBound as reason:
        raise InputError(
            f'the law cannot be written in fixed point: {reason}; take number="double" or "float" (on '
            "the command line --number double), or another law"
        ) from None


def _machine(
    law: LawProgram, number: Number, counts: tuple[float, float], found: Invariant, fixed: Fixed | None
) -> Machine:
    (result,) = found.results
    if not isfinite(result.error):
        return Machine(law, number, counts, None, "a number may leave its range", fixed)
    return Machine(law, number, counts, float(result.error), "", fixed, float(result.computed_size))


def _converter(law: LawProgram) -> Operation | None:
    """The floor of the converter's rounding."""
    if law.step == 0.0:
        return None
    floors = [s for s in law.program.statements() if isinstance(s, Operation) and s.operator == "floor"]
    return floors[-1]


def _given(law: LawProgram, counts: tuple[float, float]) -> dict[Variable, Bound]:
    """The bounds of what is measured."""
    low, high = counts
    return {law.program.parameters[0]: plain(float(low), float(high), 0.0, signed=True)}


def _binary_errors(law: LawProgram, counts: tuple[float, float], arithmetic: Binary) -> list[float]:
    """How far what it remembers at first is off: at + slope (Δ n), of rounded numbers, is rounded thrice."""
    most = (law.resolution or 1.0) * max(map(abs, counts))
    sizes = np.abs(law.rest[:, 0]) + np.abs(law.rest[:, 1]) * most
    return [8 * arithmetic.unit * float(size) + arithmetic.least for size in sizes.max(axis=0)]


def _bounded(
    law: LawProgram,
    counts: tuple[float, float],
    arithmetic: Arithmetic,
    converter: Operation | None,
    errors: Sequence[float],
) -> Invariant:
    """From rest anywhere."""
    rest = Rest(rest_ends(law, counts), tuple(errors))
    return invariant(law.program, _given(law, counts), rest, arithmetic, converter)


def rest_ends(law: LawProgram, counts: tuple[float, float]) -> Array:
    """What it remembers at the ends of both lines: outside, and inside, with the surface between them."""
    outside, inside = np.minimum(counts, 0.0), np.maximum(counts, 0.0)
    sides = zip(law.rest, (outside, inside), strict=True)
    return np.array([at + per * (law.resolution or 1.0) * x for (at, per), ends in sides for x in ends])


# ---- fixed point


def _fixed(
    law: LawProgram,
    counts: tuple[float, float],
    converter: Operation | None,
    force_unit: float | None,
    enough: float | None,
) -> Machine:
    """The finest unit of force with which nothing leaves its word; where that is off by more than is enough,
    a coarser one, whose factors are kept with more digits, or a wider word: whichever is off by least.
    """
    exact = _bounded(law, counts, Exact(), converter, [0.0] * law.remembers)
    best: Machine | None = None
    for word in (32, 64):
        for fraction in _FRACTIONS[word]:
            scale = Scale(law.resolution, _unit(law, exact, force_unit), fraction, word)
            try:
                made = _proved(law, counts, converter, scale, exact)
            except TooLarge:
                continue
            if best is None or (made.error or 0.0) < (best.error or 0.0):
                best = made
            wanted = _WIDE * (made.largest_force or 0.0) if enough is None else enough
            if (made.rounding or 0.0) <= wanted:
                return best
    if best is None:
        raise NoBound("its numbers leave 64 bits")
    return best


def _unit(law: LawProgram, exact: Invariant, force_unit: float | None) -> float:
    if law.step > 0.0:
        return law.step
    if force_unit is not None:
        return force_unit
    size = exact.results[0].size or 1.0
    return float(2.0 ** floor(log2(size) - 14))


def _proved(
    law: LawProgram, counts: tuple[float, float], converter: Operation | None, scale: Scale, found: Invariant
) -> Machine:
    """The bound of the error, and that no number is larger than it was written for, with its error."""
    most = max(map(abs, counts))
    for _ in range(_TRIES):
        cells = [max(-low, high) + error for low, high, error in found.memory]
        fixed = lowered(law.program, scale, found.values, cells)
        errors = [
            max(fixed_rest_error(law, fixed, k, inside, most) for inside in (False, True))
            for k in range(law.remembers)
        ]
        found = _bounded(law, counts, fixed, converter, errors)
        sizes = ((found.values[v].computed_size, size) for v, size in fixed.most.items() if v in found.values)
        if all(found_size <= size for found_size, size in sizes):
            return _machine(law, "fixed", counts, found, fixed)
    raise TooLarge


def rest_numbers(law: LawProgram, fixed: Fixed, place: int, inside: bool) -> tuple[int, int, int]:
    """(a, m, k) of what is remembered at rest at n counts, a + (m n >> k)."""
    size = fixed.units.scale.size(cell_unit(fixed, place))
    at, slope = law.line(place, inside)
    ratio = slope * law.resolution / size
    if ratio == 0.0 or abs(ratio - round(ratio)) <= 1e-12 * abs(ratio) or abs(ratio) >= 4096:
        return round(at / size), round(ratio), 0
    return round(at / size), round(ratio * 2**16), 16


def fixed_rest_error(law: LawProgram, fixed: Fixed, place: int, inside: bool, most: float) -> float:
    """How far that is off."""
    size = fixed.units.scale.size(cell_unit(fixed, place))
    a, m, k = rest_numbers(law, fixed, place, inside)
    at, slope = law.line(place, inside)
    own = abs(at - a * size) + abs(slope * law.resolution - m * 2.0**-k * size) * most
    return own + (size if k else 0.0)


def cell_unit(fixed: Fixed, place: int) -> Unit:
    """The unit of what is remembered in a place."""
    return fixed.units.cells.get(place, fixed.units.scale.force)


_ROUNDED = {"+", "-", "*", "/", "sqrt", "real"}
_DOUBLE = 2.0**-53
_TINY = 2.0**-40
"""Three factors of this size leave a count far above the least float."""


@dataclass(frozen=True)
class Binary:
    """The rounding of a format to the nearest of 53 or of 24 bits.

    A result v is off by u |v| (`unit`) or by `least` at most, and beyond `largest` nothing is kept.  `single`
    where the law's numbers, which are double, are rounded again.
    """

    unit: float
    least: float
    largest: float
    single: bool

    def constant(self, value: float, statement: Statement | None) -> float:
        """A number of the law is the double nearest to the exact one."""
        own = (FOLDED if self.single else _DOUBLE) * abs(value)
        if not self.single:
            return own
        if abs(value) > self.largest:  # endless: it can be compared with, no more
            computes = isinstance(statement, Operation) and statement.operator in _ROUNDED
            return inf if computes else own
        return own + max(abs(float(np.float32(value)) - value), min(abs(value), self.least))

    def rounding(self, statement: Rounded, of: tuple[Bound, ...], result: Bound) -> float:
        """u of the computed result, where there is a rounding."""
        if not isinstance(statement, Operation) or statement.operator not in _ROUNDED:
            return 0.0
        if statement.result.kind != "real":
            return 0.0
        size = result.computed_size
        if not size < self.largest:
            return inf
        if statement.operator == "real" and size * self.unit <= 0.5:
            return 0.0
        if size == 0.0:
            return 0.0
        return self.unit * size * (1 + 2 * self.unit) + self.least

    def keeps_sign(self, statement: Rounded) -> bool:
        """Of products with known numbers that are not tiny."""
        if not isinstance(statement, Operation) or statement.operator not in ("*", "/", "real"):
            return False
        known = [abs(float(o.value)) for o in statement.operands if isinstance(o, Constant)]
        if statement.operator == "/":  # the divisor
            return isinstance(statement.operands[1], Constant) and 0.0 < known[-1] < 1 / _TINY
        return statement.operator == "real" or any(k == 0.0 or k > _TINY for k in known)


DOUBLE = Binary(_DOUBLE, 2.0**-1074, 1.7e308, False)
FLOAT = Binary(2.0**-24, 2.0**-126, 3.4e38, True)
"""Numbers below 2⁻¹²⁶ may be taken for 0 by a machine."""
