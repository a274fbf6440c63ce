"""Every law emitted, against the compiled step functions: a million samples each, in C and in JavaScript.

    python benchmarks/emitted_bits.py [--steps 1000000] [LAW …]

Prints of each law the lines of its step in C, how many forces it gave, and how many of them, and of what it
remembers, differ in C (-O2; -O3 for this processor) and in node; then of the plant its size, and the time
that one period takes. 0 everywhere is what is claimed.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path
from time import perf_counter

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "firmware"))

from emitted_laws import laws, readings
from machines import Ran, compiled_c, law_in_c, law_in_javascript, run_c, run_node
from moved_plants import CELLS, PERIOD, PLANTS, hand_and_law, plant_header, plant_in_c, plant_in_javascript

from zwidth.loop.law import sampled_force, sampled_force_at
from zwidth.loop.plant import STATE_SIZE, WORK
from zwidth.machine.firmware.javascript import module
from zwidth.machine.firmware.law import LawProgram, law_program
from zwidth.machine.firmware.plant import one_period, plant_module, plant_program

OPTIONS = (("-std=c99", "-O2"), ("-std=gnu99", "-O3", "-march=native"))


def _by_counts(law, memory, given, out):
    for k in range(len(given)):
        out[k, 0] = sampled_force(law, memory, int(given[k]))


def _by_position(law, memory, given, out):
    for k in range(len(given)):
        out[k, 0] = sampled_force_at(law, memory, given[k])


def simulated(law: LawProgram, given: np.ndarray) -> Ran:
    """What the compiled functions make of the readings."""
    numbers, out = np.array(law.law), np.empty((len(given), 1))
    at, per = law.rest[int(given[0] > 0)]
    memory = at + per * (given[0] * (law.resolution or 1.0))
    (_by_counts if law.resolution > 0 else _by_position)(numbers, memory, given, out)
    return Ran(out, memory)


def differing(one: np.ndarray, other: np.ndarray) -> int:
    """How many numbers differ in a bit; any NaN is NaN."""
    nan = np.isnan(one) & np.isnan(other)
    return int((~nan & (one.view(np.int64) != other.view(np.int64))).sum())


def of_laws(names: list[str], steps: int, folder: Path) -> int:
    """The table of the laws; how many numbers differ."""
    made = {n: law_program(*make()) for n, make in laws().items() if not names or n in names}
    texts = {n: law_in_c(law, n) for n, law in made.items()}
    libraries = [compiled_c("".join(texts.values()), folder, o) for o in OPTIONS]
    print(f"{'law':38} {'lines':>6} {'forces':>8} {'-O2':>5} {'-O3':>5} {'node':>5}")
    total = 0
    for name, law in made.items():
        given = readings(law, 11, steps)
        ran = simulated(law, given)
        rows, cells = given[:, None], np.zeros(law.remembers)
        others = [run_c(library, name, rows, cells, 1) for library in libraries]
        beside = {f"{name}.mjs": module(law, about=[name], numbers=[])}
        others += run_node(law_in_javascript(name), folder, {name: (rows, cells, 1)}, beside).values()
        wrong = [sum(differing(a, b) for a, b in zip(ran, other, strict=True)) for other in others]
        step = texts[name].split(f"{name}_step(")[1].split("\n}")[0]
        print(
            f"{name:38} {step.count(chr(10)) - 1:6} {len(np.unique(ran.outputs)):8}",
            *(f"{w:5}" for w in wrong),
        )
        total += sum(wrong)
    return total


def _periods(state, work, plant, rows, out, anchored):
    for k in range(len(rows)):
        anchor, speed = (rows[k, 2], rows[k, 3]) if anchored else (0.0, 0.0)
        one_period(state, work, plant, rows[k, 0], rows[k, 1], anchor, speed, PERIOD)
        out[k] = state


def of_plants(steps: int, folder: Path) -> int:
    """The table of the plants."""
    print(
        f"\n{'plant':18} {'C lines':>8} {'bytes':>7} {'JS':>6} {'bytes':>7}",
        f"{'C':>8} {'node':>8} differ",
    )
    total = 0
    for name, (plant, hand) in PLANTS.items():
        program, rows = plant_program(plant, PERIOD, hand), hand_and_law(hand, steps, 5)
        header, text = plant_header(program, name), plant_module(program)
        alone = folder / name
        alone.mkdir()
        library = compiled_c(plant_in_c(program, name), alone)
        state, work, out = np.zeros(STATE_SIZE), np.zeros(WORK), np.empty((steps, STATE_SIZE))
        _periods(state, work, plant, rows, out, hand == "anchored")
        expected = Ran(out, np.concatenate([state, work]))
        in_c_for, in_c = timed(run_c, library, name, rows, CELLS, STATE_SIZE)
        files, given = {f"{name}.mjs": text}, {name: (rows, CELLS, STATE_SIZE)}
        few = {name: (rows[:1], CELLS, STATE_SIZE)}
        start = timed(run_node, plant_in_javascript(name), folder, few, files)[0]
        seconds, in_node = timed(run_node, plant_in_javascript(name), folder, given, files)
        wrong = sum(
            differing(a, b) for other in (in_c, in_node[name]) for a, b in zip(expected, other, strict=True)
        )
        sizes = (header.count("\n"), len(header), text.count("\n"), len(text))
        print(f"{name:18} {sizes[0]:8} {sizes[1]:7} {sizes[2]:6} {sizes[3]:7}", end=" ")
        print(*(f"{1e9 * t / steps:5.0f} ns" for t in (in_c_for, seconds - start)), f"{wrong:7}")
        total += wrong
    return total


def timed(function, *arguments):
    """Seconds, and what it gave."""
    start = perf_counter()
    result = function(*arguments)
    return perf_counter() - start, result


def main() -> int:
    """1 if anything differs."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("laws", nargs="*")
    parser.add_argument("--steps", type=int, default=10**6)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        wrong = of_laws(given.laws, given.steps, Path(folder))
        wrong += 0 if given.laws else of_plants(min(given.steps, 200_000), Path(folder))
    print(f"\n{wrong} numbers differ")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
