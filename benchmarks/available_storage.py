"""How long available storage takes: a bracket, one sweep beside brute force, its limits, its growth.

    python benchmarks/available_storage.py [--json FILE] [--plot]

The loop is the haptic paddle of the catalogue and a damped wall, 0.05 N·s/m, at most 100
counts deep and 100 counts per sample where nothing else is said.

* A bracket of stiffness by `zw.limit`, the whole call.
* One sweep over the grid from V = 0, on one thread: the hull, a plain loop over all moves
  in C, and NumPy over all readings and targets at once.  V and the best
  moves must be the same to the last bit.
* The same loads without the hull, and the same sums, products and comparisons without the
  loads: what memory and arithmetic alone would take.
* The time of one proof over counts, readings remembered, steps per count and threads.

Times are the least of some runs, compiled before.  `--plot` writes docs/_static/available-storage-cost.svg.
"""

from __future__ import annotations

import argparse
import json
import os
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from in_c import WHOLE, WHOLES, library

import zwidth as zw
from zwidth.passivity.storage import value_iteration as solve
from zwidth.passivity.storage.grid import Grid
from zwidth.passivity.storage.hull import NOWHERE, ONE_MOVE, extremes, sweep, worthwhile
from zwidth.passivity.storage.program import DynamicProgram, program_of
from zwidth.quantity.exact import Exact

PADDLE = zw.catalogue.device("haptic-paddle")
COUNT, SAMPLE = PADDLE.exact("resolution"), PADDLE.exact("sample_period")
FIGURE = Path(__file__).resolve().parent.parent / "docs" / "_static" / "available-storage-cost.svg"
WALLS = {
    0: zw.Wall(250),
    1: zw.Wall(250, damping=0.05),
    2: zw.Wall(250, damping=0.05, velocity_filter=zw.rendering.Window(2)),
    3: zw.Wall(250, damping=0.05, velocity_filter=zw.rendering.Window(3)),
}
"""By readings remembered; all passive for the paddle."""


def bounds(counts: int) -> tuple[Exact, Exact]:
    """So many counts deep [m], and as many per sample [m/s]."""
    return Exact(counts * COUNT), Exact(counts * COUNT / SAMPLE)


def program(counts: int, remembered: int = 1) -> DynamicProgram:
    return program_of(PADDLE, WALLS[remembered], *bounds(counts))


def least_time(action: Callable[[], object], runs: int = 5) -> float:
    """Of so many runs [s]."""
    spent = []
    for _ in range(runs):
        start = time.perf_counter()
        action()
        spent.append(time.perf_counter() - start)
    return min(spent)


def bracket() -> dict:
    """The whole call, the first and the best of three."""
    penetration, speed = bounds(100)

    def call() -> object:
        return zw.limit(PADDLE, WALLS[1], penetration=penetration, speed=speed)

    first = least_time(call, 1)
    found = call()
    return {
        "passive_N_per_m": found.proved_passive,
        "active_N_per_m": found.proved_active,
        "relative_width": found.relative_width,
        "evaluations": found.evaluations,
        "first_s": first,
        "s": least_time(call, 3),
    }


IN_C = library(Path(__file__).with_name("storage.c"))
IN_C.plain_sweep.argtypes = [
    WHOLES,
    WHOLES,
    WHOLE,
    WHOLE,
    WHOLES,
    WHOLES,
    WHOLE,
    WHOLES,
    *[WHOLE] * 3,
    WHOLES,
    WHOLES,
]
IN_C.loads_alone.argtypes = [WHOLES, WHOLES, WHOLES, WHOLES, WHOLE, WHOLE, WHOLES, WHOLES, WHOLES]
IN_C.arithmetic_alone.argtypes = [WHOLE] * 4
for function in (IN_C.plain_sweep, IN_C.loads_alone, IN_C.arithmetic_alone):
    function.restype = WHOLE


def plain_sweep(value, choice, first, last, forces, costs, nodes, places, reach, steps):
    """The update by its definition, move by move."""
    best, shape = np.empty(2 * (2 * reach + 1), np.int64), np.array(value.shape)
    return IN_C.plain_sweep(
        value, choice, first, last, forces, costs, costs.size, nodes, reach, steps, NOWHERE, shape, best
    )


def numpy_sweep(value, choice, first, last, forces, costs, nodes, places, reach, steps):
    """The same, all readings and targets of a group and a node at once."""
    cells, histories, edges = value.shape
    width = 2 * reach + 1
    per_cell = histories // width
    values, improved = value.reshape(-1), 0
    for group in range(first, last):
        n, newer = group // per_cell, group % per_cell
        states = np.arange(newer * width, (newer + 1) * width)
        states = states[forces[n, states] != NOWHERE]
        n2 = np.arange(max(0, n - reach), min(cells - 1, n + reach) + 1)
        h2 = (n - n2 + reach) * per_cell + newer
        targets = ((n2 * histories + h2)[:, None] * edges + np.arange(edges)).reshape(-1)
        places = ((n2 - n)[:, None] * steps + nodes).reshape(-1)
        f = forces[n, states][:, None]
        for j in range(edges):
            near = np.abs(places - nodes[j]) < costs.size
            d, there = (places - nodes[j])[near], targets[near]
            energy = values[there] - costs[np.abs(d)] - f * d
            best = energy.argmax(axis=1)
            most = np.take_along_axis(energy, best[:, None], axis=1)[:, 0]
            better = most > value[n, states, j]
            value[n, states[better], j], choice[n, states[better], j] = most[better], there[best[better]]
            improved += int(better.sum())
    return improved


def side_by_side(grid: Grid) -> dict:
    """One sweep from V = 0 by each, seconds and nanoseconds per state and move."""
    tables = 0, len(grid.forces), *_tables(grid)
    pairs = counted(grid)["pairs"]
    ends, rows = {}, {}
    for name, one, runs in (
        ("zwidth, the hull", lambda *of: sweep(*of, *ONE_MOVE), 20),
        ("C, every move", plain_sweep, 3),
        ("NumPy, every move", numpy_sweep, 2),
    ):
        times = []
        for _ in range(runs + 1):
            value = np.zeros(grid.first_guess.shape, np.int64)
            choice = np.full(value.shape, -1, np.int64)
            times.append(least_time(lambda v=value, c=choice, s=one: s(v, c, *tables), 1))
        ends[name] = value, choice
        rows[name] = {"s": min(times[1:]), "ns_per_pair": min(times[1:]) / pairs * 1e9}
    value, choice = ends["zwidth, the hull"]
    same = all((v == value).all() and (c == choice).all() for v, c in ends.values())
    return {"pairs": pairs, "improved": int((choice >= 0).sum()), "the_same_bits": bool(same), "rows": rows}


def _tables(grid: Grid) -> tuple:
    """What a sweep reads and does not change."""
    return grid.forces, grid.costs, grid.nodes, grid.places, grid.domain.reach, grid.steps


def counted(grid: Grid) -> dict:
    """States and moves, and what the hull looks at in one sweep."""
    value = grid.first_guess.reshape(-1)
    tables = grid.forces, grid.costs, grid.nodes, grid.steps, grid.domain.reach
    pairs, targets, points, states = _counts(value, *tables)
    return {"pairs": pairs, "targets": targets, "hull_points": points, "states": states}


def _counts(values, forces, costs, nodes, steps, reach):
    cells, edges = len(forces), nodes.size
    scratch = np.empty((3, (2 * reach + 1) * edges), np.int64)
    pairs = targets = points = states = 0
    for n in range(cells):
        here = int((forces[n] != NOWHERE).sum())
        states += here * edges
        low, high = max(0, n - reach), min(cells - 1, n + reach)
        targets += (high - low + 1) * edges
        least, most = extremes(forces, n, reach)
        points += edges * worthwhile(
            values, forces, costs, nodes, steps, n, reach, least, most, scratch[0], scratch[1], scratch[2]
        )
        far = (np.arange(low, high + 1) - n)[:, None, None] * steps + nodes - nodes[:, None]
        pairs += here * int((np.abs(far) < costs.size).sum())
    return pairs, targets, points, states


def limits(grid: Grid) -> dict:
    """One sweep that improves nothing, beside its loads alone and its arithmetic alone."""
    found = counted(grid)
    targets, points, states = found["targets"], found["hull_points"], found["states"]
    value = solve.value_iteration(grid).value
    choice = np.full(value.shape, -1, np.int64)
    per_node = points // (len(grid.forces) * grid.nodes.size)
    shape, place = np.array(value.shape), np.arange(per_node)
    tables = (
        value,
        grid.forces,
        grid.costs,
        grid.nodes,
        grid.domain.reach,
        per_node,
        shape,
        place,
        place.copy(),
    )
    actions = {
        "sweep": lambda: sweep(value, choice, 0, len(grid.forces), *_tables(grid), *ONE_MOVE),
        "loads": lambda: IN_C.loads_alone(*tables),
        "arithmetic": lambda: IN_C.arithmetic_alone(targets, points, states, -7),
    }
    for action in actions.values():
        action()
    times = {f"{name}_s": least_time(action, 20) for name, action in actions.items()}
    items = targets + points + states
    # loads: a target V; a point its place, index, V and cost; a state its force and V.
    # Operations: a target 2 products, 3 sums, 1 comparison and the slope 1 and 1; a point 1, 3 and 1;
    # a state 2 products, 2 sums and 2 comparisons with the corner beside it.
    return {
        **found,
        **times,
        "bytes": 8 * targets + 32 * points + 16 * states,
        "operations": 8 * targets + 5 * points + 6 * states,
        "grid_bytes": value.nbytes + grid.forces.nbytes,
        "sweep_ns_per_item": times["sweep_s"] / items * 1e9,
        "loads_ns_per_item": times["loads_s"] / items * 1e9,
        "arithmetic_ns_per_item": times["arithmetic_s"] / items * 1e9,
    }


def growth() -> list[dict]:
    """The time of one proof, one thing after the other varied."""
    cases = [("counts", n, n, 1, 8) for n in (8, 12, 16, 25, 35, 50, 70, 100, 140, 200)]
    cases += [("remembered", n, 8, n, 8) for n in (0, 1, 2, 3)]
    cases += [("steps", n, 50, 1, n) for n in (4, 8, 16, 32, 64)]
    usual, rows = solve.THREADS, []
    for varied, at, counts, remembered, steps in cases:
        loop = program(counts, remembered)
        grid = Grid(loop.law, loop.losses, loop.domain, steps, "outer")
        row = {"varied": varied, "at": at, "states": counted_states(grid)}
        for threads in (1, 2):
            solve.THREADS = threads
            row[f"s_{threads}"] = least_time(lambda p=loop, s=steps: p.prove(s), 9)
        solve.THREADS = usual
        proof = loop.prove(steps)
        row["proved"] = proof is not None
        row["check_s"] = least_time(lambda p=proof: p.certificate().verify(), 2) if proof else None
        rows.append(row)
    return rows


def counted_states(grid: Grid) -> int:
    return int((grid.forces != NOWHERE).sum()) * grid.nodes.size


def show(results: dict) -> None:
    """The results as tables."""
    b, s, c = results["bracket"], results["sweep"], results["limits"]
    print(f"{os.cpu_count()} processors\n")
    print(
        f"bracket of stiffness: {b['passive_N_per_m']} N/m passive, {b['active_N_per_m']} N/m active, "
        f"{100 * b['relative_width']:.2f} % wide\n{b['evaluations']} loops decided: {b['first_s']:.2f} s at "
        f"first, {b['s']:.2f} s again\n"
    )
    print(
        f"one sweep over {s['pairs']:,} pairs of state and move, {s['improved']:,} states improve; the same"
    )
    print(f"V and the same best moves: {s['the_same_bits']}\n")
    hull = s["rows"]["zwidth, the hull"]["s"]
    print(f"{'':<20}{'ms':>10}{'ns per pair':>13}{'ratio':>9}")
    for name, row in s["rows"].items():
        print(f"{name:<20}{1e3 * row['s']:>10.2f}{row['ns_per_pair']:>13.4f}{row['s'] / hull:>9.1f}")
    print(
        f"\none sweep: {c['targets']:,} targets, {c['hull_points']:,} points for hulls, "
        f"{c['states']:,} states;"
    )
    print(f"{c['bytes']:,} bytes loaded of a grid of {c['grid_bytes']:,}, {c['operations']:,} operations\n")
    print(f"{'':<20}{'ms':>10}{'ns per item':>13}{'share':>9}")
    for name in ("sweep", "loads", "arithmetic"):
        spent = c[f"{name}_s"]
        share = spent / c["sweep_s"]
        print(f"{name:<20}{1e3 * spent:>10.2f}{c[f'{name}_ns_per_item']:>13.2f}{share:>9.2f}")
    binds = max(("loads", "arithmetic"), key=lambda name: c[f"{name}_s"])
    longer = c["sweep_s"] / c[f"{binds}_s"]
    print(f"the limit is that of the {binds}: the sweep takes {longer:.1f} times as long")
    print("\none proof")
    print(f"{'':<16}{'states':>11}{'1 thread, ms':>14}{'2 threads, ms':>15}{'checker, ms':>13}  proved")
    for row in results["growth"]:
        check = "" if row["check_s"] is None else f"{1e3 * row['check_s']:.1f}"
        print(
            f"{row['varied']:<11}{row['at']:>5}{row['states']:>11,}{1e3 * row['s_1']:>14.1f}"
            f"{1e3 * row['s_2']:>15.1f}{check:>13}  {row['proved']}"
        )


def plot(rows: list[dict]) -> None:
    """Time of one proof over counts, readings remembered and steps, on one and two threads."""
    import matplotlib

    matplotlib.use("Agg")
    matplotlib.rcParams["svg.hashsalt"] = "available storage"
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, 3, figsize=(9, 3), sharey=True, layout="constrained")
    names = {
        "counts": "counts deep, and per sample",
        "remembered": "readings remembered, 8 counts",
        "steps": "steps per count, 50 counts",
    }
    for axis, (varied, name) in zip(axes, names.items(), strict=True):
        chosen = [row for row in rows if row["varied"] == varied]
        at = [row["at"] for row in chosen]
        for threads, style in ((1, "o-"), (2, "s--")):
            label = f"{threads} thread" + "s" * (threads > 1)
            axis.plot(at, [1e3 * row[f"s_{threads}"] for row in chosen], style, ms=4, label=label)
        axis.set(xlabel=name, yscale="log")
        if varied != "remembered":
            axis.set_xscale("log", base=2)
            axis.xaxis.set_major_formatter("{x:.0f}")
        else:
            axis.set_xticks(at)
        axis.grid(alpha=0.3)
    axes[0].set_ylabel("one proof [ms]")
    axes[0].legend()
    figure.savefig(FIGURE, metadata={"Date": None})


def main() -> None:
    raw = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=raw)
    parser.add_argument("--json", type=Path, help="save the numbers there")
    parser.add_argument("--plot", action="store_true", help=f"draw {FIGURE.name}")
    arguments = parser.parse_args()
    loop = program(100)
    grid = Grid(loop.law, loop.losses, loop.domain, 8, "outer")
    results = {
        "bracket": bracket(),
        "sweep": side_by_side(grid),
        "limits": limits(grid),
        "growth": growth(),
    }
    show(results)
    if arguments.json:
        arguments.json.write_text(json.dumps(results, indent=2) + "\n")
    if arguments.plot:
        plot(results["growth"])


if __name__ == "__main__":
    main()
