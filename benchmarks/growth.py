"""How does the time of each calculation grow with the size of what it is asked?

    python benchmarks/growth.py [pair map …]

Each case is calculated at sizes that double, three times each, and the shortest processor time counts.  The
exponent is the slope of a line through the logarithms of time and size, by least squares: 1 is in proportion,
2 is four times as long for twice the size.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from time import process_time
from typing import Any, NamedTuple

import numpy as np
from identification import record
from scenes import T, links

import zwidth as zw
from zwidth.data.identification.device.identify import identify
from zwidth.model.scene import SceneRun
from zwidth.passivity.check import check
from zwidth.passivity.pairs import check_pair

TIMES = 3
LONG = 1.0
"""What is announced [s]."""

PADDLE = zw.catalogue.device("haptic-paddle")
UNSURE = ("damping", "coulomb_friction", "resolution", "sample_period")


class Case(NamedTuple):
    """What grows, the sizes, and how to make what is timed at one of them."""

    name: str
    size: str
    sizes: tuple[int, ...]
    made: Callable[[int], Callable[[], Any]]


def order(n: int) -> Callable[[], Any]:
    """A wall whose velocity is the mean over n samples: H(z) of order n; the verdict with its advice."""
    return lambda: check(PADDLE, zw.Wall(50, "0.01", zw.rendering.Window(n)), iterate=False).advice


def delay(n: int) -> Callable[[], Any]:
    """A wall that acts n samples late."""
    late = PADDLE.replace(delay=n * PADDLE.exact("sample_period"))
    return lambda: check(late, zw.Wall(1, "0.001"), iterate=False).advice


def corners(n: int) -> Callable[[], Any]:
    """A device and a wall of which so many numbers are intervals as make n corners."""
    count = n.bit_length() - 1
    near = {key: tuple(PADDLE.exact(key) * part / 20 for part in (19, 21)) for key in UNSURE[: count - 1]}
    return lambda: check(PADDLE.replace(**near), zw.Wall((50, 60), "0.01"), iterate=False).advice


def pair(n: int) -> Callable[[], Any]:
    """Two arms with readings n samples old, stiff enough to be active."""
    joined = zw.Pair(PADDLE, PADDLE, stiffness=50, delay=n * PADDLE.exact("sample_period"))
    return lambda: check_pair(joined.replace(delay=joined.delay))


def proved_pair(n: int) -> Callable[[], Any]:
    """The same, soft enough to be passive: the proof is checked, too."""
    joined = zw.Pair(PADDLE, PADDLE, stiffness="0.01", delay=n * PADDLE.exact("sample_period"))
    return lambda: check_pair(joined.replace(delay=joined.delay))


def scene(n: int) -> Callable[[], Any]:
    """A thousand steps of a chain of springs and masses with so many elements."""
    path = 1e-3 * np.sin(np.arange(1000) * 0.01)
    run = SceneRun(zw.Scene(links(n // 2), port="m0"), T)
    return lambda: run.follow(path)


def cells(n: int) -> Callable[[], Any]:
    """A map with three hands."""
    side = round(n**0.5)
    return lambda: zw.z_width(PADDLE, (0, 30000), (0, 90), cells=(side, side))


def counts(n: int) -> Callable[[], Any]:
    """The limit of a wall for hands that go n counts deep, as fast as they like."""
    deep = n * PADDLE.exact("resolution")
    return lambda: zw.limit(PADDLE, zw.Wall(100, "0.05"), penetration=deep)


def rows(n: int) -> Callable[[], Any]:
    """A recording of the paddle."""
    log, _ = record(0, n)
    return lambda: identify(log)


def verify(n: int) -> Callable[[], Any]:
    """A proof of two arms with readings n samples old."""
    found = check_pair(zw.Pair(PADDLE, PADDLE, stiffness="0.01", delay=n * PADDLE.exact("sample_period")))
    document = found.certificate.to_dict()
    return lambda: zw.verify(document)


CASES = (
    Case("check", "order of H(z)", (8, 16, 32, 64), order),
    Case("check", "delay [samples]", (12, 25, 50, 100), delay),
    Case("check", "corners of intervals", (2, 4, 8, 16, 32), corners),
    Case("pair", "delay of an active pair [samples]", (50, 100, 200, 400), pair),
    Case("pair", "delay of a passive pair [samples]", (25, 50, 100, 200), proved_pair),
    Case("simulate", "elements of a scene", (100, 200, 400, 800), scene),
    Case("map", "cells", (62_500, 250_000, 1_000_000), cells),
    Case("limit", "counts", (5, 10, 20, 40), counts),
    Case("identify", "rows", (25_000, 50_000, 100_000, 200_000), rows),
    Case("verify", "delay of a passive pair [samples]", (25, 50, 100, 200), verify),
)


def seconds(call: Callable[[], Any]) -> float:
    """The shortest processor time [s]."""
    taken = []
    for _ in range(TIMES):
        begun = process_time()
        call()
        taken.append(process_time() - begun)
    return min(taken)


def measured(case: Case) -> Iterator[float]:
    """The time at each size [s]; what will be long is announced."""
    last = 0.0
    for size in case.sizes:
        if 2 * last > LONG:
            print(f"{case.name}, {size} {case.size}: {TIMES} times some seconds", flush=True)
        last = seconds(case.made(size))
        yield last


def exponent(sizes: tuple[int, ...], times: list[float]) -> float:
    """The slope of log time over log size."""
    return float(np.polyfit(np.log(sizes), np.log(times), 1)[0])


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    names = sorted({case.name for case in CASES})
    parser.add_argument("cases", nargs="*", metavar="NAME", help=", ".join(names))
    wanted = parser.parse_args().cases or names
    lines = []
    for case in CASES:
        if case.name in wanted:
            times = list(measured(case))
            told = ", ".join(f"{1e3 * t:.1f}" for t in times)
            sizes = ", ".join(map(str, case.sizes))
            lines.append(
                f"| {case.name} | {case.size} | {sizes} | {told} | {exponent(case.sizes, times):.1f} |"
            )
    print("| what | size | sizes | processor time [ms] | exponent |\n|---|---|---|---|---:|")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
