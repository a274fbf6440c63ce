"""Nothing but what IEEE 754 fixes to the last bit, in the functions and in all that is simulated."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator
from pathlib import Path
from random import Random
from types import FunctionType
from typing import Any

import pytest
from points import both, even, wide

import zwidth
from zwidth.quantity.elementary import exp, expm1, log, log1p, power, tanh

PACKAGE = Path(zwidth.__file__).parent
SIMULATED = ("quantity", "model/scene", "model/rendering", "loop", "links")

FIXED = {"sqrt", "floor", "ceil", "inf", "nan"}
"""What a step may take of `math`: correctly rounded, or exact."""

FIXED_OF_ARRAYS = {"empty", "floor", "sign", "sqrt", "zeros"}
"""And of numpy."""


def plain(function: Any) -> Callable[..., Any]:
    """The Python of a compiled function, and of all that it calls."""
    source = function.py_func
    named = {
        name: source.__globals__[name] for name in source.__code__.co_names if name in source.__globals__
    }
    names = {name: plain(value) if hasattr(value, "py_func") else value for name, value in named.items()}
    return FunctionType(source.__code__, names)


@pytest.mark.parametrize(
    ("function", "draws", "further"),
    [
        (exp, [even(-746.0, 710.0), both(wide(1e-20, 5.0))], ()),
        (expm1, [even(-50.0, 710.0), both(wide(1e-20, 5.0))], ()),
        (log, [wide(5e-324, 1e308), even(0.4, 3.0)], ()),
        (log1p, [wide(1e-20, 1e308), even(-1.0, 1.0)], ()),
        (tanh, [both(even(0.0, 22.0)), both(wide(1e-20, 1.0))], ()),
        (power, [wide(1e-150, 1e150)], (2.2,)),
        (power, [wide(1e-300, 1e6)], (1.5,)),
    ],
)
def test_python_and_machine_code_have_the_same_bits(function, draws, further):
    """The compiler neither contracts a product with a sum nor puts a function of its own in their place."""
    random, python = Random(51), plain(function)
    for draw in draws:
        for _ in range(1000):
            x = draw(random)
            assert python(x, *further) == function(x, *further), x


def steps(text: str) -> Iterator[ast.FunctionDef]:
    """The functions of a source that are compiled."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef) and any(
            isinstance(mark, ast.Name) and mark.id == "compiled" for mark in node.decorator_list
        ):
            yield node


def names_of(text: str, module: str) -> set[str]:
    """The names that a source takes from a module."""
    found = [node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.ImportFrom)]
    return {alias.asname or alias.name for node in found if node.module == module for alias in node.names}


def unfixed(text: str) -> list[str]:
    """What the compiled functions of a source do whose last bit is the library's."""
    found, library = [], names_of(text, "math") - FIXED
    for step in steps(text):
        for node in ast.walk(step):
            if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow):
                found.append(f"{step.name}: **")
            elif isinstance(node, ast.Name) and node.id in library:
                found.append(f"{step.name}: {node.id}")
            elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
                known = {"np": FIXED_OF_ARRAYS, "math": FIXED}.get(node.value.id)
                if known is not None and node.attr not in known:
                    found.append(f"{step.name}: {node.value.id}.{node.attr}")
    return found


@pytest.mark.parametrize("chapter", SIMULATED)
def test_steps_take_no_function_whose_last_bit_is_the_librarys(chapter):
    sources = sorted((PACKAGE / chapter).rglob("*.py"))
    assert sources
    found = {path.name: unfixed(path.read_text(encoding="utf-8")) for path in sources}
    assert not {name: calls for name, calls in found.items() if calls}


def test_a_librarys_function_would_be_seen():
    text = """
from math import exp, sqrt
@compiled
def step(x: float) -> float:
    return exp(x) + sqrt(x) + np.tanh(x) + np.floor(x) + x**1.5
def laid_out(x: float) -> float:
    return exp(x)
"""
    assert sorted(unfixed(text)) == ["step: **", "step: exp", "step: np.tanh"]
