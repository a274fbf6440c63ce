"""Does a sweep ever say something else than `zw.check` of the loop by itself?  Random lines of damped walls.

Devices, delays of whole samples and of parts of one, filters of velocity and virtual damping are drawn. On
each line stand a dozen stiffnesses over three decades, and the limits of contact that is kept and of
contact made and broken: themselves, the next double, and 1e-12 to 3e-2 beside them. A sweep decides most of
a line at once; every column of its answer is compared with that of the loop asked by itself, to the last
bit.

    python benchmarks/random_sweeps.py [--loops 20000] [--seed 0]
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from typing import Any

import numpy as np

import zwidth as zw
from zwidth.passivity.check import check_by_closed_forms
from zwidth.study.sweeps.loops import Loop
from zwidth.study.sweeps.questions import Line, checked
from zwidth.study.sweeps.request import Request, request
from zwidth.study.sweeps.run import compute
from zwidth.study.sweeps.springs import FEWEST


def main() -> int:
    """Print how many loops were compared, and each that differs."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--loops", type=int, default=20_000, help="to compare (default: 20000)")
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args()
    drawn = np.random.default_rng(asked.seed)
    loops = different = 0
    swept = alone = 0.0
    while loops < asked.loops:
        line = _line(drawn)
        if line is None:
            continue
        begun = time.process_time()
        layers = compute(line, (0,))
        middle = time.process_time()
        expected, about = [], Line()
        for place in range(line.size):
            expected.append(checked(line.at((place,)), about))
        alone += time.process_time() - middle
        swept += middle - begun
        loops += line.size
        for place, answer in enumerate(expected):
            for name, value in answer.items():
                own = line.columns[name].kept(value)
                found = layers[name][place].item()
                if own != found and not (math.isnan(own) and math.isnan(found)):
                    different += 1
                    print(f"{name}: sweep {found}, alone {own}: {line.at((place,))}", flush=True)
    print(f"{loops} loops, {different} answers differ")
    print(f"a loop: sweep {swept / loops * 1e3:.3f} ms, alone {alone / loops * 1e3:.3f} ms of the processor")
    return int(different > 0)


def _line(drawn: np.random.Generator) -> Request | None:
    """A line of walls that differ in their stiffness alone; None where too few are drawn."""
    period = zw.Exact(f"{10 ** drawn.uniform(-3.7, -2.5):.3g}")
    damping = float(f"{10 ** drawn.uniform(-2, 0.5):.3g}")
    device = zw.Device(
        mass="0.05",
        damping=damping,
        coulomb_friction=float(f"{10 ** drawn.uniform(-3, 0):.3g}"),
        resolution=float(drawn.choice([0, 1e-5, 2.24e-5, 1e-4])),
        sample_period=period,
        delay=zw.Exact(str(drawn.choice(["0", "0", "1", "2", "5", "0.5", "0.3", "1.25"]))).fraction
        * period.fraction,
    )
    filters: tuple[Any, ...] = (
        zw.rendering.BackwardDifference(),
        zw.rendering.Window(3),
        zw.rendering.Window(8),
        zw.rendering.OnePole(float(f"{float(period) * 10 ** drawn.uniform(-0.5, 1.5):.3g}")),
    )
    estimate = filters[drawn.integers(len(filters))]
    virtual = float(f"{damping * 10 ** drawn.uniform(-2, 0.3):.3g}")
    scale = damping / float(period)
    values = set(np.round(10 ** drawn.uniform(-2, 1, 14) * scale, 3).tolist())
    for contact in ("made and broken", "kept"):
        soft = zw.Wall(1e-3 * scale, virtual, estimate)
        limit = check_by_closed_forms(device, soft, contact=contact).max_stiffness
        if limit and limit < 1e15:
            values |= {limit * (1 + off) for k in (1e-12, 1e-9, 1e-6, 1e-3, 0.03) for off in (-k, k)}
            values |= {limit, math.nextafter(limit, math.inf)}
    positive = [value for value in values if value > 0]
    if len(positive) < FEWEST:
        return None
    drawn.shuffle(positive)
    return request("check", Loop(device, zw.Wall(1, virtual, estimate)), {"stiffness": positive})


if __name__ == "__main__":
    sys.exit(main())
