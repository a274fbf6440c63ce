"""Laws whose rounding is tried, and motions that are hard on them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

import zwidth as zw
from zwidth.model import rendering
from zwidth.model.environment.environment import Environment

Counts = NDArray[np.int64]

PADDLE = zw.Device(
    mass="0.1", damping="0.6", coulomb_friction="0.4", resolution="2.24e-5", sample_period="0.001"
)
STEPPED = PADDLE.replace(force_resolution="0.013")
LIMITED = STEPPED.replace(force_limit="4.7")


def _resonant(radius: float, angles: tuple[float, ...]) -> Environment:
    """Pairs of poles at r e^{±jθ}."""
    den = np.poly([p for a in angles for p in (radius * np.exp(1j * a), radius * np.exp(-1j * a))]).real
    num = 40.0 * den + 30.0 * np.append(1, np.zeros(len(den) - 1))
    return zw.PulseTransferFunction([round(c, 9) for c in num], [round(c, 9) for c in den])


def laws() -> dict[str, Environment]:
    """By name; those that are H(z) behind a surface, or without one, begin with the name of what they are."""
    slow = zw.PulseTransferFunction(["81.3", "-157.1", "75.9"], [1, "-1.93", "0.931"])
    return {
        "wall": zw.Wall(613.7),
        "wall damped": zw.Wall(613.7, damping="1.37"),
        "wall clamped": zw.Wall(613.7, damping="1.37", clamped=True),
        "wall window": zw.Wall(613.7, "0.9", rendering.Window(3)),
        "wall one pole": zw.Wall(613.7, "0.9", rendering.OnePole("5 ms")),
        "wall filter": zw.Wall(613.7, "0.9", rendering.VelocityFilter(["1.5", "-0.5"], [1, 0]), clamped=True),
        "solid": zw.GeneralizedMaxwell("200", [("300", "2.1"), ("150", "9")]),
        "maxwell": zw.Maxwell("400", "3.1"),
        "everywhere slow": slow,
        "everywhere resonant": _resonant(0.97, (0.3, 1.1)),
        "everywhere order 8": _resonant(0.9, (0.2, 0.7, 1.3, 2.9)),
        "everywhere fir": zw.PulseTransferFunction(["91.7", "-13.3", "40.1", "7.7"], [1, 0, 0, 0]),
        "damper": zw.render(zw.Wall(300), rendering.Damper("0.7", rendering.AdaptiveWindow(longest=1))),
        "detents": zw.NonlinearSpring.detents(3, "0.002", "0.5"),
        "hysteresis": zw.render(zw.Wall(300), rendering.Hysteresis("0.3", 900)),
        "saturation": zw.render(zw.Wall(613.7, damping="1.37"), rendering.Saturation(3)),
        "chain": zw.render(
            zw.Wall(300, damping="0.4"), rendering.Hysteresis("0.2", 700), rendering.Saturation(4)
        ),
    }


def motions(random: np.random.Generator, most: int, count: int) -> Iterator[Counts]:
    """Random walks, jumps, extremes, square waves and sinusoids of every speed, within ± most."""
    k = np.arange(count)
    for size in (1, 20, most // 50 + 1):
        yield np.clip(np.cumsum(random.integers(-size, size + 1, count)), -most, most)
    yield random.integers(-most, most + 1, count)
    yield np.where(random.random(count) < 0.5, -most, most)
    yield random.integers(-2, 3, count)
    for half in (1, 2, 3, 5, 10, 29, 100):
        yield np.where((k // half) % 2 == 0, most, -most) - random.integers(0, 9, count) * np.where(
            (k // half) % 2 == 0, 1, -1
        )
    for angle in random.uniform(0.01, 3.1, 3):
        yield np.round(most * np.sin(angle * k)).astype(np.int64)


def hardest(response: NDArray[np.float64], most: int, random: np.random.Generator) -> Counts:
    """The input that makes a response with these samples largest, at its end, with last digits that vary."""
    sign = np.where(response[::-1] >= 0, 1, -1)
    return sign * (most - random.integers(0, 999, len(sign)))
