"""A motion that gains with every round: where the hand is at the samples, what pushes it, what it gains."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil, floor
from typing import TYPE_CHECKING

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from zwidth.quantity.glossary import GLOSSARY
from zwidth.show.plots.style import (
    BLUE,
    GREY,
    LOOK,
    PURPLE,
    RED,
    heading,
    label,
    new_figure,
    quantity_text,
    scale,
)

if TYPE_CHECKING:
    from zwidth.passivity.storage.gain import Gain

_EDGES = 16
"""Encoder edges up to which each is drawn."""

_SHOWN = 24
"""Samples that are filled with rounds where one is shorter."""

_DOTS = 60


@rc_context(LOOK)
def cycle(gain: Gain) -> Figure:
    """Position at the samples, held force and energy out over some rounds of a motion that gains.

    Parameters
    ----------
    gain
        `zwidth.available_storage(…).witness`.
    """
    figure = new_figure(6.4, 5.0)
    draw_cycle(list(figure.subplots(3, 1, sharex=True)), gain)
    return figure


def draw_cycle(rows: Sequence[Axes], gain: Gain) -> None:
    """The same on three given axes, one above the other."""
    from zwidth.passivity.storage.gain import settled_round  # loaded by now

    motion = "rotary" if gain.unit == "rad" else "linear"
    once = settled_round(gain)
    samples = round(once.times[-1])
    rounds = max(2, _SHOWN // samples // 2)
    times = [n * samples + t for n in range(rounds) for t in once.times[:-1]] + [rounds * samples]
    x = [*once.positions[:-1] * rounds, once.positions[-1]]
    _positions(rows[0], times, x, once.resolution, motion)
    factor, unit = scale(once.forces, GLOSSARY["force"].unit_for(motion))
    rows[1].stairs([factor * f for f in once.forces * rounds], times, color=PURPLE, baseline=None)
    rows[1].axhline(0, color=GREY, lw=0.6)
    rows[1].set_ylabel(label("force", motion, "", unit))
    out = [n * once.energies[-1] + e for n in range(rounds) for e in once.energies[:-1]]
    _energy(rows[2], times, [*out, rounds * once.energies[-1]])
    rows[2].set_xlabel("sample k, the law settled")
    rows[2].set_xlim(0, times[-1])
    rows[2].xaxis.set_major_locator(MaxNLocator(integer=True))
    energy = quantity_text(gain.energy_per_cycle, "energy")
    heading(rows[0], f"{energy} out in every round of {samples} samples", color=RED)


def _positions(
    axes: Axes, times: Sequence[float], x: Sequence[float], resolution: float, motion: str
) -> None:
    factor, unit = scale(x, GLOSSARY["position"].unit_for(motion))
    axes.plot(times, [factor * v for v in x], color=BLUE)
    if len(x) <= _DOTS:  # a dot where the encoder is read
        read = [(t, factor * v) for t, v in zip(times, x, strict=True) if t == round(t)]
        axes.plot(*zip(*read, strict=True), "o", color=BLUE, ms=3.5, clip_on=False, gid="samples")
    edges = range(floor(min(x) / resolution + 1e-9), ceil(max(x) / resolution - 1e-9) + 1)
    if len(edges) <= _EDGES:
        for n in edges:
            axes.axhline(factor * n * resolution, color=GREY, lw=0.7, ls=":", gid="edge")
    axes.set_ylabel(label("position", motion, "", unit))


def _energy(axes: Axes, times: Sequence[float], energies: Sequence[float]) -> None:
    factor, unit = scale(energies, "J")
    axes.plot(times, [factor * e for e in energies], color=RED, gid="energy")
    axes.axhline(0, color=GREY, lw=0.6)
    axes.set_ylabel(f"energy out [{unit}]")
