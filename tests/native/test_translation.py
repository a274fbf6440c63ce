"""Step functions as C: the bits of Python, and what is outside told with file and line."""

from __future__ import annotations

import math
from collections.abc import Callable
from ctypes import CDLL, Union, c_double, c_int64, c_void_p
from pathlib import Path
from random import Random
from shutil import which
from subprocess import run
from textwrap import dedent
from typing import Any, ClassVar

import numpy as np
import pytest

from zwidth.native.build import FLAGS, PACKAGE
from zwidth.native.names import OutsideError
from zwidth.native.translation import Translation

HEAD = """
from __future__ import annotations
from math import ceil, floor, inf, sqrt
from typing import NamedTuple
import numpy as np
from numpy.typing import NDArray
def compiled(function):
    return function
Array = NDArray[np.float64]
Integers = NDArray[np.int64]
FIRST, SECOND, THIRD = range(3)
_POWERS = tuple(2.0**-n for n in range(4))
class Pair(NamedTuple):
    left: float
    right: float
"""

SAME = """
@compiled
def step(x: float, y: float, n: int, a: Array) -> float:
    pair = Pair(x, right=y)
    total = 0
    for k in range(a.shape[0] - 1, -1, -2):
        total += a[k] * (x if k % 2 == 0 else -y)
    low, high = min(x, y, total), max(x, y)
    i = -7 // 3 + n % -3 + (n << 2 ^ 5) + (n >> 1 & 3)
    if low < 0.0 <= high or not n > 2:
        total = total + pair.left * i - _POWERS[abs(n) % len(_POWERS)]
    while total > 1e3:
        total *= 0.5
        if total < 2e3 and n in (1, 2, 3):
            break
    rest = a[1:].copy()
    rest[FIRST], rest[SECOND] = rest[SECOND], rest[FIRST]
    a[-1] = inner(rest, pair, 1.5, steep=0.25)
    for k in range(4):
        if k > 0:
            below += last * k
        else:
            below = 0.25
        above = x if k == 0 else above + y
        last = above - k
    total = total - below
    whole = floor(x) + ceil(y) + round(y)
    return total + a[-1] + whole + np.floor(x / 3.0) + x % 0.7 + y // 0.3 + sqrt(abs(x))


@compiled
def inner(a: Array, of: Pair, flat: float, steep: float) -> float:
    table = np.full((2, 3), -1)
    table[1, THIRD] = 4
    row = table[1, :]
    return a[0] * flat + a[1] * steep + row[2] * of.left + table.size - (0.0 - of.right)
"""


class Word(Union):
    _fields_: ClassVar[Any] = [("f", c_double), ("i", c_int64), ("p", c_void_p)]


def translated(folder: Path, text: str) -> str:
    for name in ("names", "types"):
        (folder / f"{name}.py").write_text("", encoding="utf-8")
    (folder / "steps.py").write_text(HEAD + dedent(text), encoding="utf-8")
    return Translation(folder).text()


def python(text: str) -> Callable[..., Any]:
    space: dict[str, Any] = {}
    exec(compile(HEAD + dedent(text), "steps", "exec", dont_inherit=True), space)
    found: Callable[..., Any] = space["step"]
    return found


@pytest.fixture
def package(tmp_path: Path) -> Path:
    (tmp_path / "zwidth").mkdir()
    return tmp_path / "zwidth"


@pytest.mark.skipif(which("cc") is None, reason="no C compiler")
def test_c_has_the_bits_of_python(package: Path) -> None:
    source = package / "steps.c"
    source.write_text(translated(package, SAME), encoding="utf-8")
    run(["cc", *FLAGS, "-Wall", "-Wno-unused", "-o", package / "steps.so", source, "-lm"], check=True)
    entry, step, random = CDLL(str(package / "steps.so")).zwx_steps_step, python(SAME), Random(7)
    for _ in range(2000):
        x, y = (random.choice([0.0, -0.0, random.uniform(-4, 4), random.gauss(0, 1e4)]) for _ in range(2))
        n, a = random.randint(-9, 9), np.array([random.gauss(0, 30) for _ in range(random.randint(3, 8))])
        b, row = a.copy(), (Word * 8)()
        row[0].f, row[1].f, row[2].i, row[3].p = x, y, n, b.ctypes.data
        for k, size in enumerate((b.size, 1, 1, 1)):
            row[4 + k].i = size
        entry(row)
        wanted = float(step(x, y, n, a))
        assert row[0].f.hex() == wanted.hex(), (x, y, n)
        assert a.tobytes() == b.tobytes()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("def step(x): return x", "says what it takes"),
        ("def step(x: str) -> float: return 1.0", "cannot take str"),
        ("def step(x: float) -> float: return math.gamma(x)", "math.gamma"),
        ("def step(x: float) -> float:\n    y = [x]\n    return y[0]", "[x]"),
        (
            "def step(x: float) -> float:\n    x = 1\n    for y in (1, 2):\n        break\n    return x",
            "to its end",
        ),
        ("def step(x: float) -> int: return x", "where"),
        ("def step(x: float, *y: float) -> float: return x", "one by one"),
        ("def step(a: Array) -> float:\n    y = a\n    y = 1.0\n    return y", "y would be"),
        ("def step(x: float) -> float: return other(x)\ndef other(x: float) -> float: return x", "decorate"),
        ("def step(x: float) -> float: return x or 1.0", "neither True nor False"),
        ("def step(a: Array) -> Array: return a[1:]", "returns none"),
        ("def step(a: Array) -> float:\n    return a.copy()[0] if a[0] > 0 else 1.0", "a line of its own"),
        ("def step(x: float) -> Pair:\n    return Pair(x, x) if x > 0 else (1, 2)", "is of two types"),
        ("def step(x: float | None) -> float: return 1.0", "cannot take float | None"),
        ("def step(x: float) -> bool: return x is x", "x is x is outside"),
        (
            "def step(a: Array) -> None:\n    a[at()] += 1.0\n@compiled\ndef at() -> int: return 0",
            "is no call",
        ),
        ("def step(x: int) -> float: return Pair(x)", "takes left, right"),
        ("def step(x: float) -> float:\n    try:\n        return x\n    finally:\n        pass", "try:"),
    ],
)
def test_what_is_outside_is_told_with_file_and_line(package: Path, text: str, said: str) -> None:
    with pytest.raises(OutsideError) as told:
        translated(package, "@compiled\n" + text)
    first = str(told.value).splitlines()[0]
    assert first.startswith(f"{package / 'steps.py'}:")
    assert math.isfinite(int(first.removeprefix(f"{package / 'steps.py'}:").split(":")[0]))
    assert said in first


def test_nothing_of_the_package_is_outside() -> None:
    """A step function that cannot be translated is an error where the package is built, not where it runs."""
    assert "zwx_loop_kernel_run(" in Translation(PACKAGE).text()
