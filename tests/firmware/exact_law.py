"""A law in real numbers: its program in fractions, and H(z) by its definition."""

from __future__ import annotations

import operator as o
from collections.abc import Callable, Iterable
from fractions import Fraction
from math import floor, isqrt
from typing import Any

import zwidth as zw
from zwidth.machine.firmware.law import LawProgram
from zwidth.machine.firmware.program import Branch, Constant, Load, Operand, Operation, Statement, Store
from zwidth.model.environment.environment import Environment

BITS = 400
"""Of what is remembered: it is rounded to 2⁻⁴⁰⁰, since an endless response has endless digits."""

_DO: dict[str, Callable[..., Any]] = {
    "+": o.add, "-": o.sub, "*": o.mul, "/": o.truediv, "negate": o.neg, "abs": abs, "min": min, "max": max,
    "<": o.lt, "<=": o.le, "==": o.eq, "!=": o.ne, ">": o.gt, ">=": o.ge, "not": o.not_,
    "and": lambda a, b: a and b, "or": lambda a, b: a or b, "real": Fraction, "copy": lambda a: a,
    "floor": lambda a: Fraction(floor(a)), "sqrt": lambda a: Fraction(isqrt(floor(a * 4**BITS)), 2**BITS),
}  # fmt: skip


def kept(value: Fraction) -> Fraction:
    return Fraction(round(value * 2**BITS), 2**BITS)


class ExactProgram:
    """A law's program on fractions, without the converter's rounding.

    `values` is what every variable was at the last sample.
    """

    def __init__(self, law: LawProgram) -> None:
        self.law, self.values = law, {}
        floors = [s for s in law.program.statements() if isinstance(s, Operation) and s.operator == "floor"]
        self.converter = floors[-1] if law.step else None
        self.init(0)

    def init(self, counts: int) -> None:
        x = Fraction(self.law.resolution or 1.0) * counts
        lines = [self.law.line(k, counts > 0) for k in range(self.law.remembers)]
        self.cells = [Fraction(a) + Fraction(s) * x for a, s in lines]

    def step(self, counts: int) -> Fraction:
        self.values = {self.law.program.parameters[0]: Fraction(counts)}
        self._block(self.law.program.body)
        return self._value(self.law.program.results[0])

    def _value(self, operand: Operand) -> Any:
        if not isinstance(operand, Constant):
            return self.values[operand]
        return operand.value if operand.kind == "truth" else Fraction(operand.value)

    def _block(self, body: list[Statement]) -> None:
        for s in body:
            if isinstance(s, Operation):
                of = [self._value(it) for it in s.operands]
                self.values[s.result] = (
                    of[0] - Fraction(1, 2) if s is self.converter else _DO[s.operator](*of)
                )
            elif isinstance(s, Load):
                self.values[s.result] = self.cells[s.index.value]
            elif isinstance(s, Store):
                self.cells[s.index.value] = kept(self._value(s.value))
            else:
                assert isinstance(s, Branch)
                self._block(s.then if self._value(s.test) else s.other)


def linear_forces(
    device: zw.Device, law: Environment, counts: Iterable[int], surface: bool, clamped: bool
) -> list[Fraction]:
    """f = H(z) Δn by its definition, with the decimals that were typed; from rest at 0, outside of a wall.

    A wall without a surface pulls as well; one that is clamped never pulls.
    """
    top, bottom = law.pulse_transfer_function(device.exact("sample_period"))
    a = [Fraction(c) for c in bottom]
    b = [*[Fraction(0)] * (len(a) - len(top)), *(Fraction(c) for c in top)]
    xs, ys, out = [Fraction(0)] * len(a), [Fraction(0)] * len(a), []
    for n in counts:
        xs = [device.exact("resolution") * n, *xs[:-1]]
        y = sum(c * x for c, x in zip(b, xs, strict=True)) - sum(
            c * y for c, y in zip(a[1:], ys, strict=False)
        )
        ys = [kept(y / a[0]), *ys[:-1]]
        f = max(ys[0], Fraction(0)) if clamped else ys[0]
        out.append(Fraction(0) if surface and n <= 0 else f)
    return out
