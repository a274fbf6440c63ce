"""Bounds of single operations and of branches, against points drawn inside of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import product
from math import isfinite, sqrt
from random import Random
from typing import NamedTuple

import pytest
from strategies import seeds

from zwidth.machine.firmware import bound
from zwidth.machine.firmware import program as ir
from zwidth.machine.firmware.bound import Bound, plain
from zwidth.machine.firmware.evaluation import Evaluation, Exact
from zwidth.machine.firmware.machine import FLOAT


class Point(NamedTuple):
    exact: float
    computed: float


def drawn(random: Random) -> tuple[Bound, list[Point]]:
    ends = sorted(random.choice([0.0, -1.0, 2.0, random.uniform(-9, 9)]) for _ in range(2))
    error = random.choice([0.0, 1.0, random.uniform(0, 2)])
    signed = random.random() < 0.5
    points = []
    for _ in range(40):
        v = random.choice([*ends, random.uniform(*ends), min(max(0.0, ends[0]), ends[1])])
        w = v + error * random.choice([-1, 1, random.uniform(-1, 1)])
        if signed and (v > 0) - (v < 0) != (w > 0) - (w < 0):
            w = v
        points.append(Point(v, w))
    return plain(*ends, error, signed), points


def holds(b: Bound, exact: float, computed: float) -> None:
    """What a bound says is so, to within the rounding of this test."""
    slack = 1e-9 * (1 + abs(exact) + abs(computed))
    assert b.low - slack <= exact <= b.high + slack
    assert abs(computed - exact) <= b.error + slack
    if b.signed:
        assert (exact > 0) - (exact < 0) == (computed > 0) - (computed < 0)


OPERATIONS: dict[str, tuple[Callable, Callable, int]] = {
    "added": (lambda a, b: bound.added(a, b, 1.0), lambda a, b: a + b, 2),
    "less": (lambda a, b: bound.added(a, b, -1.0), lambda a, b: a - b, 2),
    "multiplied": (bound.multiplied, lambda a, b: a * b, 2),
    "divided": (bound.divided, lambda a, b: a / b, 2),
    "least": (bound.least, min, 2),
    "most": (bound.most, max, 2),
    "absolute": (bound.absolute, abs, 1),
    "floored": (bound.floored, lambda a: a // 1.0, 1),
    "rooted": (bound.rooted, sqrt, 1),
    "scaled": (lambda a: bound.scaled(a, -1.7), lambda a: -1.7 * a, 1),
    "scaled by 0": (lambda a: bound.scaled(a, 0.0), lambda a: 0.0, 1),
}
"""Of bounds and of numbers, and how many operands."""


@pytest.mark.parametrize("name", OPERATIONS)
@seeds(40)
def test_bounds_of_operations(name: str, seed: int) -> None:
    """Range, error and sign of a result hold for all numbers that those of its operands hold for."""
    bounds, compute, operands = OPERATIONS[name]
    random = Random(seed)
    given, points = zip(*(drawn(random) for _ in range(operands)), strict=True)
    result = bounds(*given)
    if isfinite(result.error):
        for of in product(*points):
            holds(result, compute(*(p.exact for p in of)), compute(*(p.computed for p in of)))


def test_a_root_of_what_may_be_negative_has_no_bound() -> None:
    assert not isfinite(bound.rooted(plain(0.0, 1.0, 0.1)).error)
    assert isfinite(bound.rooted(plain(0.0, 1.0, 0.1, signed=True)).error)


@seeds(40)
def test_one_or_the_other(seed: int) -> None:
    random = Random(seed)
    (a, ps), (b, qs) = drawn(random), drawn(random)
    both = bound.hull(a, b)
    for p in (*ps, *qs):
        holds(both, p.exact, p.computed)
    for p in ps:
        assert all(abs(p.computed - q.exact) <= max(bound.apart(a, b), bound.apart(b, a)) + 1e-9 for q in qs)


@seeds(40)
def test_narrowing_loses_no_point(seed: int) -> None:
    random = Random(seed)
    a, points = drawn(random)
    low, high = sorted((random.uniform(-9, 9), random.uniform(-9, 9)))
    narrow = a.within(low, high)
    assert all(narrow.low <= p.exact <= narrow.high for p in points if low <= p.exact <= high)


@dataclass
class Shaken(Exact):
    """An arithmetic that is off by anything up to half of a unit, everywhere."""

    off: float = 0.3
    signs: dict[object, bool] = field(default_factory=dict)

    def rounding(self, statement: object, of: tuple[Bound, ...], result: Bound) -> float:
        return self.off

    def keeps_sign(self, statement: object) -> bool:
        return False


def branching(random: Random) -> ir.Program:
    """y = one or the other affine function of x and of what is remembered; it is remembered."""
    cells, x, m = ir.Cells("memory", 1), ir.Variable("real", "x"), ir.Variable("real", "m")
    y, test = ir.Variable("real", "y", True), ir.Variable("truth")
    side = random.choice([ir.Constant(random.choice([0.0, 1.0, random.uniform(-3, 3)]), "real"), m])
    body: list = [ir.Load(m, cells, ir.Constant(0, "integer"))]
    u = ir.Variable("real", "u")
    body.append(ir.Operation(u, "*", (ir.Constant(random.uniform(-2, 2), "real"), x)))
    body.append(ir.Operation(test, random.choice(["<", "<=", ">", ">="]), (random.choice([u, m]), side)))
    ways = []
    for _ in range(2):
        v, w = ir.Variable("real", "v"), ir.Variable("real", "w")
        given = ir.Operation(v, "*", (ir.Constant(random.uniform(-0.8, 0.8), "real"), random.choice([m, u])))
        add = random.choice([u, ir.Constant(random.uniform(-4, 4), "real")])
        ways.append(
            [given, ir.Operation(w, random.choice(["+", "-", "min", "max"]), (v, add)), ir.set_to(y, w)]
        )
    body.append(ir.Branch(test, *ways))
    body.append(ir.Store(cells, ir.Constant(0, "integer"), y))
    return ir.Program((x,), (cells,), body, (y,))


def ran(program: ir.Program, x: float, m: float, off: Callable[[], float]) -> tuple[float, float]:
    values, held = {program.parameters[0]: x}, [m]
    do = {"*": lambda a, b: a * b, "+": lambda a, b: a + b, "-": lambda a, b: a - b, "min": min, "max": max}
    do["copy"] = lambda a: a  # a set
    tests = {"<": float.__lt__, "<=": float.__le__, ">": float.__gt__, ">=": float.__ge__}

    def value(o: object) -> float:
        return o.value if isinstance(o, ir.Constant) else values[o]

    def block(body: list) -> None:
        for s in body:
            if isinstance(s, ir.Load):
                values[s.result] = held[0]
            elif isinstance(s, ir.Operation) and s.operator in tests:
                values[s.result] = tests[s.operator](value(s.operands[0]) + off(), value(s.operands[1]))
            elif isinstance(s, ir.Operation):
                values[s.result] = do[s.operator](*map(value, s.operands)) + off()
            elif isinstance(s, ir.Store):
                held[0] = value(s.value) + off()
            else:
                block(s.then if value(s.test) else s.other)

    block(program.body)
    return value(program.results[0]), held[0]


def anything(random: Random, off: float) -> float:
    return random.choice([off, -off, random.uniform(-off, off)])


@seeds(60)
def test_branches_whose_test_is_in_doubt(seed: int) -> None:
    """Where the two go different ways, the error counts what they differ by; a test is rounded too."""
    random = Random(seed)
    program, arithmetic = branching(random), Shaken(off=random.choice([0.01, 0.3]))
    low, high, error = -random.uniform(0, 4), random.uniform(0, 4), random.choice([0.0, 0.4])
    given = {program.parameters[0]: plain(-3.0, 3.0)}
    after, (result,) = Evaluation(arithmetic).run(program, given, [(low, high, error)])
    for _ in range(300):
        x, m = random.choice([-3.0, 0.0, 3.0, random.uniform(-3, 3)]), random.uniform(low, high)
        exact = ran(program, x, m, lambda: 0.0)
        shifted = m + error * random.uniform(-1, 1)
        computed = ran(program, x, shifted, lambda: anything(random, arithmetic.off))
        for found, e, c in zip((result, after[0]), exact, computed, strict=True):
            holds(found, e, c)


def test_a_float_too_large_has_no_bound() -> None:
    """A factor that no float holds makes the error endless; it may still be compared with."""
    x, y = ir.Variable("real", "x"), ir.Variable("real", "y")
    for operator, endless in (("*", True), ("min", False)):
        body = [ir.Operation(y, operator, (ir.Constant(1e39, "real"), x))]
        _, (result,) = Evaluation(FLOAT).run(ir.Program((x,), (), body, (y,)), {x: plain(0.0, 1e-5)}, [])
        assert isfinite(result.error) != endless
    assert Fraction(FLOAT.unit) == Fraction(1, 2**24)
