"""The motion that takes energy out: where the hand goes, what pushes it, what it gains.

The force is held between updates, so it lags the hand: it pushes harder on the
way out than it resisted on the way in.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil, floor
from typing import TYPE_CHECKING

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from zwidth.errors import InputError
from zwidth.passivity.verdict import Verdict
from zwidth.passivity.witness.witness import Witness
from zwidth.quantity.glossary import GLOSSARY
from zwidth.show.plots.cycle import draw_cycle
from zwidth.show.plots.replay import WHOLE, Replay, replay
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

_DOTS = 60
"""Samples up to which each is marked."""

_EDGES = 8
"""Encoder edges up to which each is drawn."""


@rc_context(LOOK)
def witness(verdict: Verdict) -> Figure:
    """Position at the samples, held force and energy out of an active verdict.

    Of a motion that repeats a few rounds are shown.

    Raises
    ------
    InputError
        If the verdict has no witness.
    """
    figure = new_figure(6.4, 5.0)
    rows = figure.subplots(3, 1, sharex=True)
    draw_witness(list(rows), verdict)
    return figure


def draw_witness(rows: Sequence[Axes], verdict: Verdict) -> None:
    """The same on three given axes, one above the other."""
    if verdict.witness is None:
        raise InputError(f"the loop is {verdict.outcome}: there is no motion to draw")
    draw_motion(rows, verdict.witness)


def draw_motion(rows: Sequence[Axes], found: Witness | Gain) -> None:
    """The same of a motion by itself."""
    if not isinstance(found, Witness):
        draw_cycle(rows, found)
        return
    played = replay(found)
    factor, unit = scale([played.times[-1] - played.times[0]], "s")
    times = [factor * t for t in played.times]
    _positions(rows[0], found, played, times)
    _forces(rows[1], found, played, times)
    _energy(rows[2], played, times)
    heading(rows[0], _title(found, played.caption), color=RED)
    rows[2].set_xlabel(f"time t [{unit}]")
    rows[0].set_xlim(times[0], times[-1])


def _title(found: Witness, caption: str) -> str:
    total = quantity_text(found.energy, "energy")
    if caption.endswith("rounds"):
        more = quantity_text(found.energy_per_cycle, "energy")
        return f"{caption}; one more takes out {more}, all of them {total}"
    return f"{caption} takes out {total}" if caption == WHOLE else f"{caption}; all of it takes out {total}"


def _positions(axes: Axes, found: Witness, played: Replay, times: list[float]) -> None:
    motion = found.setting.motion
    factor, unit = scale(played.positions, GLOSSARY["position"].unit_for(motion))
    values = [factor * p for p in played.positions]
    dots = "o" if len(played.sampled) <= _DOTS else ""
    axes.plot(times, values, color=BLUE, marker=dots, markevery=played.sampled, ms=3.5)
    step = factor * float(found.setting.resolution)
    if step:
        edges = range(ceil(min(values) / step - 1e-9), floor(max(values) / step + 1e-9) + 1)
        if len(edges) <= _EDGES:
            for n in edges:
                axes.axhline(n * step, color=GREY, lw=0.7, ls=":", gid="edge")
    elif min(values) < 0 < max(values):
        axes.axhline(0, color=GREY, lw=0.6)
    axes.set_ylabel(label("position", motion, "", unit))


def _forces(axes: Axes, found: Witness, played: Replay, times: list[float]) -> None:
    motion = found.setting.motion
    factor, unit = scale(played.forces, GLOSSARY["force"].unit_for(motion))
    axes.stairs([factor * f for f in played.forces], times, color=PURPLE, lw=1.6, baseline=None)
    if min(played.forces) <= 0 <= max(played.forces):
        axes.axhline(0, color=GREY, lw=0.6)
    axes.set_ylabel(label("force", motion, "", unit))


def _energy(axes: Axes, played: Replay, times: list[float]) -> None:
    factor, unit = scale(played.energies, "J")
    axes.plot(times, [factor * e for e in played.energies], color=RED, gid="energy")
    axes.axhline(0, color=GREY, lw=0.6)
    axes.set_ylabel(f"energy out [{unit}]")
