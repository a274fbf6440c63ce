"""Is a bound of `robust_boundary` ever wrong?  Random hands within intervals, eigenvalues at 60 digits.

Device, hand and a damped wall in sustained contact are one linear system.  Its state matrix over a period
is written down here, with a delay of whole samples and a part of one and with the memory of the velocity's
filter, by another road than the project's, which has polynomials in z; mpmath finds its eigenvalues. What
may not be:

  shaken below     an eigenvalue outside the unit circle at the stiffness that is guaranteed, with an end of
                   each interval or with numbers inside
  stable above     none outside at the double after the one that is refuted with the hand that is named, nor
                   1e-7, 1e-3, half and three times above it

    python benchmarks/random_robust.py [--hands 20] [--seed 0]
"""

from __future__ import annotations

import argparse
import itertools
import math
import sys
from fractions import Fraction
from typing import Any, NamedTuple

import mpmath as mp
import numpy as np

import zwidth as zw

mp.mp.dps = 60
ABOVE = ("1.0000001", "1.001", "1.5", "4")


class Loop(NamedTuple):
    """What is known of a loop, exact: delay in samples, the filter's window or its time constant."""

    period: Fraction
    delay: Fraction
    window: int
    time_constant: Fraction


def main() -> int:
    """Print how many points were looked at, and each that is wrong."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--hands", type=int, default=20, help="with three points each (default: 20)")
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args()
    drawn = np.random.default_rng(asked.seed)
    wrong, gaps, points = 0, [], 0
    for _ in range(asked.hands):
        loop, ranges = _drawn(drawn)
        found = _bounds(drawn, loop, ranges)
        for j, virtual in enumerate(found.virtual_damping.values):
            points += 1
            named = [float(found[name][j]) for name in ("mass", "damping", "hand_stiffness")]
            guaranteed, refuted = float(found.guaranteed[j]), float(found.refuted[j])
            faults = [
                *_shaken_below(drawn, loop, ranges, _exact(virtual), guaranteed),
                *_stable_above(loop, ranges, named, _exact(virtual), refuted),
            ]
            wrong += len(faults)
            for fault in faults:
                print(fault, loop, ranges, f"B = {virtual!r}", flush=True)
            if not math.isnan(guaranteed):
                gaps.append(1 - guaranteed / refuted)
    print(f"{points} points of {asked.hands} hands, {wrong} wrong")
    print(f"between the two bounds: {np.median(gaps):.2%} in the middle, {max(gaps):.2%} at most")
    return int(wrong > 0)


Ranges = tuple[tuple[Fraction, Fraction], ...]
"""Of mass, damping and stiffness of device and hand together."""


def _exact(number: float) -> Fraction:
    """The decimal that Python prints."""
    return zw.Exact(float(number)).fraction


def _drawn(drawn: np.random.Generator) -> tuple[Loop, dict[str, tuple[float, float]]]:
    """A loop; and ranges of the device's mass and damping, and of the hand's mass, damping and stiffness."""

    def span(low: float, high: float, width: float) -> tuple[float, float]:
        first = float(f"{math.exp(drawn.uniform(math.log(low), math.log(high))):.3g}")
        return first, float(f"{first * (1 + drawn.uniform(0.01, width)):.4g}")

    ranges = {
        "mass": span(0.02, 0.3, 0.5),
        "damping": span(0.01, 2, 1),
        "hand mass": span(0.005, 0.2, 1),
        "hand damping": span(0.1, 5, 1),
        "hand stiffness": span(1, 800, 1),
    }
    kind = drawn.integers(4)  # all known; any hand up to one; an interval of the hand's stiffness; all
    for name, (low, high) in ranges.items():
        if kind == 0 or (kind == 2 and name != "hand stiffness"):
            ranges[name] = low, low
        elif kind == 1 and name.startswith("hand"):
            ranges[name] = 0.0, high
    is_window = drawn.integers(3) < 2
    loop = Loop(
        Fraction(str(drawn.choice(["0.001", "0.0005", "0.002"]))),
        Fraction(str(drawn.choice(["0", "0", "1", "2", "0.3", "1.7", "0.5"]))),
        int(drawn.choice([1, 1, 2, 5])) if is_window else 0,
        Fraction(0) if is_window else Fraction(str(drawn.choice(["0.001", "0.005"]))),
    )
    return loop, ranges


def _bounds(drawn: np.random.Generator, loop: Loop, ranges: dict[str, tuple[float, float]]) -> Any:
    """What the project says."""

    def given(name: str) -> Any:
        low, high = ranges[name]
        return low if low == high else zw.Interval(low, high)

    device = zw.Device(
        mass=given("mass"),
        damping=given("damping"),
        sample_period=zw.Exact(loop.period),
        delay=zw.Exact(loop.delay * loop.period),
    )
    hand = zw.stability.HandImpedance(
        mass=given("hand mass"), damping=given("hand damping"), stiffness=given("hand stiffness")
    )
    estimate: Any = zw.rendering.OnePole(zw.Exact(loop.time_constant))
    if loop.window:
        estimate = zw.rendering.Window(loop.window)
    scale = (ranges["mass"][0] + ranges["hand mass"][0]) / float(loop.period * (1 + loop.delay))
    most = float(f"{drawn.uniform(0.05, 1.3) * scale / max(loop.window, 1):.3g}")
    return zw.maps.robust_boundary(
        device, hand, (0, most), points=3, velocity_filter=estimate, progress=lambda *_: None
    )


def _together(ranges: dict[str, tuple[float, float]]) -> Ranges:
    mass, damping, *hand = (tuple(map(_exact, ends)) for ends in ranges.values())
    both = [
        tuple(a + b for a, b in zip(*pair, strict=True)) for pair in ((mass, hand[0]), (damping, hand[1]))
    ]
    return both[0], both[1], hand[2]  # type: ignore[return-value]


def _shaken_below(
    drawn: np.random.Generator, loop: Loop, ranges: dict[str, tuple[float, float]], virtual: Fraction,
    guaranteed: float,
) -> list[str]:  # fmt: skip
    """Hands in the ranges that are shaken at the stiffness that is guaranteed."""
    if math.isnan(guaranteed):
        return []
    ends = _together(ranges)
    inside = [
        tuple(low + (high - low) * Fraction(int(drawn.integers(1001)), 1000) for low, high in ends)
        for _ in range(2)
    ]
    return [
        f"shaken below: K = {guaranteed!r}, m, c, k = {[float(x) for x in hand]}"
        for hand in {*itertools.product(*ends), *inside}
        if not _radius(loop, hand, _exact(guaranteed), virtual) < 1
    ]


def _stable_above(
    loop: Loop, ranges: dict[str, tuple[float, float]], named: list[float], virtual: Fraction, refuted: float
) -> list[str]:
    """Stiffnesses beyond the one that is refuted at which the hand that is named comes to rest."""
    hand = min(
        itertools.product(*_together(ranges)),
        key=lambda hand: sum(
            abs(float(own) - name) / (1 + name) for own, name in zip(hand, named, strict=True)
        ),
    )
    beyond = [_exact(refuted if refuted > 0 else 1.0) * Fraction(part) for part in ABOVE]
    if refuted > 0:
        beyond.append(_exact(math.nextafter(refuted, math.inf)))
    return [
        f"stable above: K = {float(stiffness)!r}, refuted {refuted!r}, m, c, k = {[float(x) for x in hand]}"
        for stiffness in beyond
        if not _radius(loop, hand, stiffness, virtual) > 1
    ]


def _number(x: Fraction) -> Any:
    return mp.mpf(x.numerator) / mp.mpf(x.denominator)


def _radius(loop: Loop, hand: tuple[Fraction, ...], stiffness: Fraction, virtual: Fraction) -> Any:
    """The largest modulus of an eigenvalue of the state matrix of one period.

    The state is x, v, the positions that the filter remembers, its output, and the forces under way.
    """
    m, c, k = map(_number, hand)
    period, wall, damper = _number(loop.period), _number(stiffness), _number(virtual)

    def moved(time: Any) -> tuple[Any, Any]:
        """What a time makes of (x, v), and of a force held for that long."""
        both = mp.matrix([[0, 1, 0], [-k / m, -c / m, 1 / m], [0, 0, 0]])
        done = mp.expm(both * time, method="taylor")
        return done[:2, :2], done[:2, 2]

    whole = loop.delay.numerator // loop.delay.denominator
    part = _number(loop.delay - whole)
    memory = loop.window or 1
    under_way = whole + (1 if part else 0)
    first = 2 + memory + (0 if loop.window else 1)  # of the forces
    size = first + under_way
    force = mp.zeros(1, size)
    matrix = mp.zeros(size)
    force[0, 0] = -wall
    if loop.window:
        force[0, 0] -= damper / (memory * period)
        force[0, 1 + memory] += damper / (memory * period)
    else:
        tau = _number(loop.time_constant)
        for place, weight in ((0, 1), (2, -1), (3, tau)):
            matrix[3, place] = weight / (tau + period)
            force[0, place] -= damper * weight / (tau + period)
    step, held = moved(period)
    arriving = [(held, whole)]
    if part:
        late, early = moved(part * period), moved((1 - part) * period)
        arriving = [(early[1], whole), (early[0] * late[1], whole + 1)]
    for i in range(2):
        for j in range(2):
            matrix[i, j] = step[i, j]
        for effect, samples in arriving:
            if samples:
                matrix[i, first + samples - 1] += effect[i]
            else:
                for j in range(size):
                    matrix[i, j] += effect[i] * force[0, j]
    matrix[2, 0] = 1
    for i in range(1, memory):
        matrix[2 + i, 1 + i] = 1
    for i in range(under_way):
        if i:
            matrix[first + i, first + i - 1] = 1
        else:
            matrix[first, :] = force
    return max(map(abs, mp.eig(matrix, left=False, right=False)))


if __name__ == "__main__":
    sys.exit(main())
