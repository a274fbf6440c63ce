"""What fixed point does for small chips: the same whole numbers from fewer and smaller operations."""

from __future__ import annotations

import ctypes
import random
from pathlib import Path

import numpy as np
import pytest
from firmware.chip_laws import DEVICE
from firmware.emulated.built import STRICT, called
from firmware.emulated.host import HostLaw
from firmware.emulated.required import require

import zwidth as zw
from zwidth.machine.firmware import program as ir
from zwidth.machine.firmware.bound import plain
from zwidth.machine.firmware.c99 import HELPERS, NARROW
from zwidth.machine.firmware.emit import emit
from zwidth.machine.firmware.evaluation import Evaluation, Exact
from zwidth.machine.firmware.fixed import lowered
from zwidth.machine.firmware.simplified import tidied
from zwidth.machine.firmware.units import Scale, Unit


def test_a_narrow_product_is_the_wide_one(tmp_path: Path) -> None:
    require("host")
    words = {"word": "int32_t", "prefix": "law"}
    scaled, narrow = (HELPERS[k].format(**words) for k in ("scaled", "scaled_narrow"))
    text = f"""#include <stdint.h>
{scaled}
{narrow}
int32_t wide(int32_t n, int32_t m) {{ return law_scaled(n, m, 16); }}
int32_t narrow(int32_t n, int32_t h, int32_t l)
{{ return law_scaled_narrow((int16_t)n, (int16_t)h, (int16_t)l); }}
"""
    (tmp_path / "a.c").write_text(text, encoding="utf-8")
    called(["gcc", *STRICT, "-shared", "-fPIC", str(tmp_path / "a.c"), "-o", str(tmp_path / "a.so")])
    library = ctypes.CDLL(str(tmp_path / "a.so"))
    draw = random.Random(5)
    most = (NARROW << 16) - 1
    for _ in range(20_000):
        n = draw.choice([-NARROW, NARROW, 0, draw.randint(-NARROW, NARROW)])
        m = draw.choice([-most, most, 32768, -32768, draw.randint(-most, most)])
        high = (m + NARROW + 1) >> 16
        assert abs(high) <= NARROW + 1
        got = library.narrow(n, high, m - (high << 16))
        assert got == library.wide(n, m) == (n * m + 2**15) >> 16


@pytest.mark.parametrize("travel", [None, "-60 .. 60 mm", "-3 .. 200 mm"])
def test_every_reading_of_a_travel(tmp_path: Path, travel: str | None) -> None:
    """A damped wall in fixed point is off from K x + B v by what was proved at most, and beyond the travel
    gives what it gives at its end."""
    require("host")
    found = emit(DEVICE, zw.Wall(150, 0.05), number="fixed", travel=travel)
    low, high = map(int, found.machine.counts)
    law = HostLaw(found.text, tmp_path)
    counts = np.arange(low - 5, high + 6, dtype=np.int32)
    order = np.random.default_rng(2).permutation(counts)[:50_000]
    law.init(int(order[0]))
    forces = law.run(order) * law.force_per_unit
    x = 22.4e-6 * np.clip(order, low, high)
    wall = np.where(x > 0, 150 * x + 0.05 * np.diff(x, prepend=x[0]) / 1e-3, 0.0)
    assert np.abs(forces - np.clip(wall, -16.5, 16.5)).max() <= found.machine.error + 1e-12


def test_what_changes_nothing_is_left_out() -> None:
    given, changing = ir.Variable("integer", "n"), ir.Variable("integer", "w", changes=True)
    a, b, c, d = (ir.Variable("integer", name) for name in "abcd")
    memory, zero = ir.Cells("memory", 1), ir.Constant(0, "integer")
    body = [
        ir.Operation(a, "copy", (given,)),
        ir.Load(b, memory, zero),
        ir.Operation(c, "-", (b, zero)),
        ir.set_to(changing, a),
        ir.Operation(d, "copy", (changing,)),
        ir.Branch(ir.Constant(True, "truth"), [ir.set_to(changing, c)], [ir.set_to(changing, zero)]),
        ir.Store(memory, zero, d),
    ]
    program = tidied(ir.Program((given,), (memory,), list(body), (changing,)))
    made = [(s.result.changes, s.operands) for s in program.statements() if isinstance(s, ir.Operation)]
    assert made == [(True, (given,)), (False, (changing,)), (True, (b,)), (True, (zero,))]
    assert len(body) == 7
    assert body[3].operands == (a,)


def test_a_set_in_another_unit_is_a_set() -> None:
    """y is a position on one way and a force on the other: both ways set one whole number, in one unit."""
    n, y = ir.Variable("integer", "n"), ir.Variable("real", "y", changes=True)
    real, x, f = (ir.Variable("real", name) for name in ("real", "x", "f"))
    inside = ir.Variable("truth", "inside")
    ways = [ir.set_to(y, x)], [ir.Operation(f, "*", (ir.Constant(300.0, "real"), x)), ir.set_to(y, f)]
    body = [
        ir.Operation(real, "real", (n,)),
        ir.Operation(x, "*", (ir.Constant(1e-4, "real"), real)),
        ir.Operation(inside, ">", (x, ir.Constant(0.0, "real"))),
        ir.Branch(inside, *ways),
    ]
    program = ir.Program((n,), (), body, (y,))
    evaluation = Evaluation(Exact())
    evaluation.run(program, {n: plain(-100.0, 100.0)}, [])
    found = lowered(program, Scale(1e-4, 0.01, 4), evaluation.seen, [])
    branch = found.program.body[-1]
    sets = [way[-1].result for way in (branch.then, branch.other)]
    assert sets[0] is sets[1] is found.program.results[0]
    assert sets[0].changes
    assert (branch.then[-2].operator, found.result) == ("scaled", Unit(0, 1, 4))


def test_a_coefficient_that_is_a_unit_by_chance() -> None:
    """K + B/T is 200 N/m, which is 2 per unit of force of 0.01 N: a product as any other."""
    device = DEVICE.replace(force_resolution="0.01 N")
    found = emit(device, zw.Wall(150, 0.05), number="fixed", travel="-60 .. 60 mm")
    assert found.machine.rounding < 0.002
