"""Functions of the subset have the same bits in C and JavaScript; others are refused by their lines."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from random import Random
from textwrap import indent
from types import ModuleType
from typing import Any

import numpy as np
import pytest
import random_functions
from machines import INCLUDES, compiled_c, program_in_c, program_in_javascript, run_c, run_node, same_bits
from numpy.typing import NDArray
from small_functions import FUNCTIONS, NUMPY
from strategies import seeds

import zwidth as zw
from zwidth.machine.firmware.program import Cells, Load, Operation, Program, Table, Variable
from zwidth.machine.firmware.specialise import specialised

Array = NDArray[np.float64]


def _program(function: Callable[..., Any], size: int = 4, *known: Any) -> Program:
    given = [Variable("real", "x"), Variable("integer", "k")]
    return specialised(function, (Cells("m", size), *known, *given))


def _assert_same(
    programs: Mapping[str, Program],
    python: Mapping[str, Callable[..., Any]],
    rows: Array,
    cells: Array,
    folder: Path,
) -> None:
    """`python` takes the cells and the numbers of a row."""
    wide = {name: len(p.results) for name, p in programs.items()}
    expected = {}
    for name, function in python.items():
        held = np.array(cells)
        given = [[*map(float, row[:-1]), int(row[-1])] for row in rows]
        with np.errstate(all="ignore"):
            results = np.array([function(held, *row) for row in given], dtype=float)
        expected[name] = results.reshape(len(rows), -1), held
    library = compiled_c(INCLUDES + "".join(program_in_c(p, n) for n, p in programs.items()), folder)
    text = "".join(program_in_javascript(p, n) for n, p in programs.items())
    in_node = run_node(text, folder, {n: (rows, cells, wide[n]) for n in programs})
    wrong = []
    for name, (outputs, held) in expected.items():
        for ran in (run_c(library, name, rows, cells, wide[name]), in_node[name]):
            if not (same_bits(outputs, ran.outputs) and same_bits(held, ran.cells)):
                wrong.append(name)
    assert not wrong


def _over_zero(function: Callable[..., Any]) -> Callable[..., Any]:
    return lambda m, x, k: function(m, np.float64(x), np.int64(k))


def test_small_functions_have_the_same_bits_in_every_language(tmp_path: Path) -> None:
    functions = {f.__name__: f for f in FUNCTIONS} | {f.__name__: _over_zero(f) for f in NUMPY}
    programs = {f.__name__: _program(f) for f in (*FUNCTIONS, *NUMPY)}
    random = np.random.default_rng(1)
    x = random.choice([0.0, -0.0, 0.5, 1.0, -2.5, 7.25], 200) * random.choice([1.0, 1e-3, -1.0], 200)
    rows = np.stack([x, random.integers(0, 10, 200)], 1)
    _assert_same(programs, functions, rows, np.array([1.0, -2.0, 0.25, 3.5]), tmp_path)


def _module(text: str, folder: Path, name: str) -> ModuleType:
    path = folder / f"{name}.py"
    path.write_text(text, encoding="utf-8")
    spec = spec_from_file_location(name, path)
    made = module_from_spec(spec)
    spec.loader.exec_module(made)
    return made


def _quotient(a: float, b: float) -> float:
    with np.errstate(all="ignore"):
        return float(np.float64(a) / np.float64(b))


@seeds(2)
def test_random_functions_have_the_same_bits_in_every_language(
    seed: int, tmp_path_factory: pytest.TempPathFactory
) -> None:
    """Whatever is put together of the subset: C and JavaScript do as Python does, also with ∞ and NaN.

    Functions that they call are written in place in one, and stand apart in the next.
    """
    random, folder = Random(seed), tmp_path_factory.mktemp("random")
    names = [f"f{k}" for k in range(25)]
    text = "".join(random_functions.random_function(random, n) for n in names)
    made = _module(f"{random_functions.HEAD}\n\n{text}", folder, f"made_{seed}")
    p = tuple(random.uniform(-3, 3) for _ in range(random_functions.KNOWN))
    given = (Variable("real", "x"), Variable("real", "y"), Variable("integer", "k"))
    cells = Cells("m", random_functions.CELLS)
    apart = [made.searched, made.twice, made.kept]
    programs = {
        n: specialised(getattr(made, n), (cells, p, 4, *given), apart if k % 2 else ())
        for k, n in enumerate(names)
    }
    made.over = _quotient  # type: ignore[attr-defined]  # Python raises where a number is divided by 0
    draw = np.random.default_rng(seed)
    x = draw.choice([0.0, -0.0, 1.5, -2.25, 3.0, 1e3, -1e-3, math.inf], 40)
    rows = np.stack([x, 3.0 * draw.normal(size=40), draw.integers(0, 10, 40)], 1)
    functions = {n: _of_lists(getattr(made, n), p) for n in names}
    _assert_same(programs, functions, rows, draw.normal(size=cells.size), folder)


def _of_lists(function: Callable[..., Any], p: tuple[float, ...]) -> Callable[..., Any]:
    """With numbers of Python in the array, which are quiet about ∞."""

    def run(m: Array, x: float, y: float, k: int) -> Any:
        held = [float(v) for v in m]
        result = function(held, p, 4, x, y, k)
        m[:] = held
        return result

    return run


REFUSED = {
    "power": ("y = x + 1.0\nreturn y**2.5", 2, "Pow"),
    "library": ("return math.sin(x)", 1, "math.sin"),
    "of_arrays": ("return float(np.sum(m))", 1, "np.sum"),
    "comprehension": ("return sum([x for _ in range(3)])", 1, "sum"),
    "text": ("name = 'x'\nreturn x if name else 0.0", 1, "'x'"),
    "raising": ("if x < 0.0:\n    raise ValueError\nreturn x", 2, "raise"),
    "one_way": ("if x > 0.0:\n    y = 1.0\nreturn y", 3, "y has no value on some way"),
    "whole_then_real": (
        "total = 0\nfor i in range(40):\n    total = total + x * i\nreturn total",
        3,
        "write 0.0",
    ),
    "over_an_array": ("total = 0.0\nfor value in m:\n    total += value\nreturn total", 2, "range"),
    "other_step": ("total = 0.0\nfor _ in range(0, 50, k):\n    total += x\nreturn total", 2, "step"),
    "loop_else": ("while x > 1.0:\n    x -= 1.0\nelse:\n    x = 0.0\nreturn x", 4, "else"),
    "beyond": ("return m[4]", 1, "there is no number at 4 of 4"),
    "real_index": ("return m[x]", 1, "an index is a whole number"),
    "itself": ("return refused(m, x - 1.0, k) if x > 0.0 else x", 1, "refused calls itself"),
    "real_quotient": ("return x // 0.5", 1, "//"),
    "no_value": ("n = 3 - 3\nreturn x * int(1e300) + n", 2, "no whole number of 32 bits"),
    "of_conditions": ("return x + (x > 0.0)", 1, "arithmetic is for numbers"),
    "two_lengths": ("if x > 0.0:\n    return x, x\nreturn x, x, x", 3, "as many"),
    "sent_along": ("pair = (x, x)\nreturn max(*pair)", 2, "one by one"),
    "unknown_name": ("return x + nowhere", 1, "nowhere"),
    "told_when_it_runs": ("return x + WHERE", 1, "WHERE is not known here"),
    "changed_list": ("pair = (x, x)\npair[0] = 1.0\nreturn x", 2, "only what is remembered"),
}
"""Bodies of functions outside of what can be emitted, the line, and what is said of it."""


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_emitted_is_refused_by_its_line(name: str, tmp_path: Path) -> None:
    body, line, what = REFUSED[name]
    head = "import math\nimport os\nimport numpy as np\nWHERE = float(os.name == 'posix')\n"
    text = f"{head}def refused(m, x, k):\n{indent(body, '    ')}\n"
    number = head.count("\n") + 1 + line
    with pytest.raises(zw.InputError, match=re.escape(f"made_{name}.py:{number}: ")) as refused:
        _program(_module(text, tmp_path, f"made_{name}").refused)
    assert what in str(refused.value)


def test_what_has_no_source_is_refused() -> None:
    with pytest.raises(zw.InputError, match="cannot be emitted"):
        specialised(math.hypot, (1.0, 2.0))


def _searched(p: Array, high: int, further: int, x: float) -> float:
    low = 3
    while high - low > 1:
        middle = (low + high) // 2
        if p[middle] <= x:
            low = middle
        else:
            high = middle
    return p[low] + p[low + further]


def test_a_short_search_is_written_out() -> None:
    program = specialised(_searched, (np.arange(20.0), 6, 10, Variable("real", "x")))
    assert not program.tables()
    sets = (s for s in program.statements() if isinstance(s, Operation) and s.result.changes)
    given = {float(s.operands[0].value) for s in sets}
    assert given == {16.0, 18.0, 20.0}


def test_a_table_has_what_can_be_read_alone() -> None:
    """Of 500 known numbers, of which a search reads 3 to 139, and 200 further, those are kept."""
    program = specialised(_searched, (np.arange(500.0), 140, 200, Variable("real", "x")))
    loads = [s for s in program.statements() if isinstance(s, Load)]
    kept = {s.source.values for s in loads if isinstance(s.source, Table)}
    assert kept == {tuple(map(float, range(3, 140))), tuple(map(float, range(203, 340)))}
