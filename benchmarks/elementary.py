"""What do functions that have the same bits everywhere cost, beside those of the C library?

    python benchmarks/elementary.py [--turns 5]

Two tables: nanoseconds of each function in a compiled loop over random arguments, ours and `math`'s, and
nanoseconds of a sample in loops that call them, as they are and with `math`'s put in their place.  Each
simulator is a process of its own with a cache of its own; they take turns, and the least of each is printed.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from typing import Any

import numpy as np
from numba import njit

import zwidth as zw
from zwidth.elementary import exponential, hyperbolic, logarithm, power

SAMPLES = 50_000
REPEATS = 5

Library = dict[str, Callable[..., float]]


def librarys() -> Library:
    """The functions of the C library, compiled."""
    return {
        "exp": njit(lambda x: math.exp(x)),
        "expm1": njit(lambda x: math.expm1(x)),
        "log": njit(lambda x: math.log(x)),
        "log1p": njit(lambda x: math.log1p(x)),
        "tanh": njit(lambda x: math.tanh(x)),
        "power": njit(lambda x, n: x**n),
    }


def ours() -> Library:
    """Those of zwidth."""
    return {name: getattr(place, name) for name, place in PLACES.items()}


PLACES: dict[str, Any] = {
    "exp": exponential,
    "expm1": exponential,
    "log": logarithm,
    "log1p": logarithm,
    "tanh": hyperbolic,
    "power": power,
}


def least(run: Callable[[], object], repeats: int) -> float:
    """The shortest of some runs [ns]; the first, which compiles, does not count."""
    run()
    found = []
    for _ in range(repeats):
        start = time.perf_counter()
        run()
        found.append(time.perf_counter() - start)
    return 1e9 * min(found)


def of_a_call(function: Callable[..., float], x: Any, further: tuple[float, ...]) -> float:
    """One call, in a loop that adds up [ns]."""

    @njit
    def add(x: Any, further: tuple[float, ...]) -> float:
        total = 0.0
        for _ in range(50):
            for one in x:
                total += function(one, *further)
        return total

    return least(lambda: add(x, further), 2 * REPEATS) / (50 * len(x))


def functions() -> str:
    """The first table."""
    random = np.random.default_rng(0)
    below, speeds = -3 * random.random(2000), 3 * random.standard_normal(2000)
    sizes = 10 ** (6 * random.random(2000) - 5)
    cases = [
        ("exp", "−3 … 0", below, ()),
        ("expm1", "−3 … 0", below, ()),
        ("log", "1e-5 … 10", sizes, ()),
        ("log1p", "−0.9 … 0", 0.3 * below, ()),
        ("tanh", "about 3", speeds, ()),
        ("power", "1e-5 … 10, n = 1", sizes, (1.0,)),
        ("power", "1e-5 … 10, n = 1.5", sizes, (1.5,)),
        ("power", "1e-5 … 10, n = 2.2", sizes, (2.2,)),
    ]
    lines = ["| function | arguments | ours [ns] | math [ns] | ratio |", "|---|---|---:|---:|---:|"]
    own, other = ours(), librarys()
    for name, about, x, further in cases:
        one, two = of_a_call(own[name], x, further), of_a_call(other[name], x, further)
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


def simulated(library: bool) -> dict[str, float]:
    """Nanoseconds of a sample of each loop, its trajectory recorded."""
    if library:
        for name, function in librarys().items():
            setattr(PLACES[name], name, function)
    from zwidth.loop.setup import empty_record, prepare  # they take the functions as they are now
    from zwidth.loop.simulate import run_setup

    hand = 1.0 + 0.5 * np.sin(2 * np.pi * 5e-3 * np.arange(SAMPLES))
    device = zw.Device(
        mass="0.036", damping="0.15", coulomb_friction="0.12", resolution="22.4 um", sample_period="1 ms"
    )
    found = {}
    for name, (environment, amplifier) in loops().items():
        push = zw.operators.RecordedForce(hand)
        duration = SAMPLES * 1e-3
        setup = prepare(device, environment, push, duration, initial_position=-0.01, amplifier=amplifier)
        commands, record, work = empty_record(setup)

        def run(setup=setup, commands=commands, record=record, work=work) -> None:
            run_setup(setup, setup.state.copy(), setup.memory.copy(), work, commands, record, None)

        found[name] = least(run, REPEATS) / SAMPLES
    return found


def simulators(turns: int) -> str:
    """The second table."""
    found: dict[str, dict[str, list[float]]] = {"ours": {}, "math": {}}
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(turns):
            for which, values in found.items():
                environment = os.environ | {"NUMBA_CACHE_DIR": os.path.join(folder, which)}
                command = [sys.executable, __file__, "--simulate", which]
                run = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
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
    parser.add_argument("--simulate", choices=("ours", "math"), help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.simulate:
        print(json.dumps(simulated(arguments.simulate == "math")))
        return
    print(functions(), simulators(arguments.turns), sep="\n\n")


if __name__ == "__main__":
    main()
