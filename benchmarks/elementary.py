"""What do functions that have the same bits everywhere cost, beside those of the C library?

    python benchmarks/elementary.py [--turns 5]

Two tables: nanoseconds of each function in a loop in C over random arguments, ours and `math`'s, and
nanoseconds of a sample in loops that call them, as they are and with `math`'s put in their place.  Each
simulator is a process of its own with a library of its own; they take turns, and the least is printed.
"""

from __future__ import annotations

import argparse
import ctypes
import json
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import zwidth as zw
from zwidth.loop.setup import empty_record, prepare
from zwidth.loop.simulate import run_setup
from zwidth.native import build

SAMPLES = 50_000
REPEATS = 5

WHERE = {
    "exp": "exponential",
    "expm1": "exponential",
    "log": "logarithm",
    "log1p": "logarithm",
    "tanh": "hyperbolic",
    "power": "power",
}
"""The module of each."""

ADD = """
ZW_SEEN double added_{name}(const double *x, int64_t count, double n) {{
  double total = 0;
  (void)n;
  for (int i = 0; i < 50; i++) for (int64_t k = 0; k < count; k++) total += {call};
  return total;
}}
"""


def built(which: str, folder: Path) -> Path:
    """A library of all step functions with our functions, or the C library's, and loops that add up."""
    text = build.translated()
    for name, module in WHERE.items():
        own = f"elementary_{module}_{name}"
        called = own if which == "ours" else name.replace("power", "pow")
        text = re.sub(rf"(?<!double ){own}\(", f"{called}(", text)  # calls alone
        text += ADD.format(name=name, call=f"{called}(x[k]{', n' if name == 'power' else ''})")
    source, library = folder / f"{which}.c", folder / f"{which}.so"
    source.write_text(text, encoding="utf-8")
    command = [*build.compiler(), *build.FLAGS, "-w", "-o", str(library), str(source), "-lm"]
    subprocess.run(command, check=True)
    return library


def least(run: Callable[[], object], repeats: int) -> float:
    """The shortest of some runs [ns]; the first does not count."""
    run()
    found = []
    for _ in range(repeats):
        start = time.perf_counter()
        run()
        found.append(time.perf_counter() - start)
    return 1e9 * min(found)


def of_a_call(library: Any, name: str, x: np.ndarray, n: float) -> float:
    """One call, in a loop that adds up [ns]."""
    add = getattr(library, f"added_{name}")
    add.restype, add.argtypes = ctypes.c_double, (ctypes.c_void_p, ctypes.c_int64, ctypes.c_double)
    return least(lambda: add(x.ctypes.data, len(x), n), 2 * REPEATS) / (50 * len(x))


def functions(libraries: dict[str, Path]) -> str:
    """The first table."""
    random = np.random.default_rng(0)
    below, speeds = -3 * random.random(2000), 3 * random.standard_normal(2000)
    sizes = 10 ** (6 * random.random(2000) - 5)
    cases = [
        ("exp", "−3 … 0", below, 0),
        ("expm1", "−3 … 0", below, 0),
        ("log", "1e-5 … 10", sizes, 0),
        ("log1p", "−0.9 … 0", 0.3 * below, 0),
        ("tanh", "about 3", speeds, 0),
        ("power", "1e-5 … 10, n = 1", sizes, 1.0),
        ("power", "1e-5 … 10, n = 1.5", sizes, 1.5),
        ("power", "1e-5 … 10, n = 2.2", sizes, 2.2),
    ]
    lines = ["| function | arguments | ours [ns] | math [ns] | ratio |", "|---|---|---:|---:|---:|"]
    opened = [ctypes.CDLL(str(library)) for library in libraries.values()]
    for name, about, x, n in cases:
        one, two = (of_a_call(library, name, x, n) for library in opened)
        lines.append(f"| {name} | {about} | {one:.1f} | {two:.1f} | {one / two:.2f} |")
    return "\n".join(lines)


def loops() -> dict[str, tuple[Any, Any]]:
    """An environment and an amplifier by what they call."""
    wall, ideal = zw.Wall(stiffness=300), zw.amplifiers.Ideal()
    compensated = zw.render(wall, zw.FrictionCompensation(coulomb="0.1", speed="0.01"))
    return {
        "spring wall: none of them": (wall, ideal),
        "Hunt–Crossley, n = 1.5: power": (zw.HuntCrossley(3000, exponent="1.5", dissipation=1), ideal),
        "Hunt–Crossley, n = 2.2: power": (zw.HuntCrossley(30000, exponent="2.2", dissipation=1), ideal),
        "compensated friction: tanh": (compensated, ideal),
        "amplifier with a lag: exp, expm1, log": (wall, zw.amplifiers.FirstOrderLag("0.001")),
    }


def simulated(library: Path) -> dict[str, float]:
    """Nanoseconds of a sample of each loop, its trajectory recorded."""
    build.BUILT = library
    hand = 1.0 + 0.5 * np.sin(2 * np.pi * 5e-3 * np.arange(SAMPLES))
    device = zw.Device(
        mass="0.036", damping="0.15", coulomb_friction="0.12", resolution="22.4 um", sample_period="1 ms"
    )
    found = {}
    for name, (environment, amplifier) in loops().items():
        push = zw.operators.RecordedForce(hand)
        duration = SAMPLES * 1e-3
        setup = prepare(device, environment, push, duration, initial_position=-0.01, amplifier=amplifier)
        commands, record, work = empty_record(setup.frame)

        def run(setup=setup, commands=commands, record=record, work=work) -> None:
            run_setup(setup, setup.state.copy(), setup.memory.copy(), work, commands, record, None)

        found[name] = least(run, REPEATS) / SAMPLES
    return found


def simulators(libraries: dict[str, Path], turns: int) -> str:
    """The second table."""
    found: dict[str, dict[str, list[float]]] = {"ours": {}, "math": {}}
    for _ in range(turns):
        for which, values in found.items():
            command = [sys.executable, __file__, "--simulate", str(libraries[which])]
            run = subprocess.run(command, capture_output=True, encoding="utf-8", check=True)
            for name, ns in json.loads(run.stdout).items():
                values.setdefault(name, []).append(ns)
    lines = ["| a sample of | ours [ns] | math [ns] | ratio |", "|---|---:|---:|---:|"]
    for name, own in found["ours"].items():
        one, two = min(own), min(found["math"][name])
        lines.append(f"| {name} | {one:.0f} | {two:.0f} | {one / two:.2f} |")
    return "\n".join(lines)


def main() -> None:
    """Both tables, or the times of one simulator."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--turns", type=int, default=5, help="of both simulators")
    parser.add_argument("--simulate", type=Path, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.simulate:
        print(json.dumps(simulated(arguments.simulate)))
        return
    with tempfile.TemporaryDirectory() as folder:
        libraries = {which: built(which, Path(folder)) for which in ("ours", "math")}
        print(functions(libraries), simulators(libraries, arguments.turns), sep="\n\n")


if __name__ == "__main__":
    main()
