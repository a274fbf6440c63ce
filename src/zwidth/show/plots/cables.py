"""A device with a transmission: its criterion against frequency, and the motion that was replayed."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import cos, pi
from typing import TYPE_CHECKING

from matplotlib.axes import Axes

from zwidth.passivity.transmission import TransmissionVerdict
from zwidth.quantity.text import shown
from zwidth.show.plots.style import (
    BLUE,
    GREY,
    ORANGE,
    OUTCOME,
    PURPLE,
    RED,
    axis,
    heading,
    label,
    legend,
    quantity_text,
    with_unit,
)

if TYPE_CHECKING:
    from zwidth.passivity.witness.replayed import ReplayedMotion

_POINTS = 240
_NEAR = 40
"""Points, and those that crowd on each side towards where the criterion is violated."""


def draw_circle(axes: Axes, verdict: TransmissionVerdict) -> None:
    """How far the criterion's left side lies from its circle's middle, in radii; ≥ 1 is passive."""
    elastic = verdict.elastic
    assert elastic is not None
    half = 0.5 / float(elastic.loop.period)
    marked = [f for f in (getattr(verdict.violation, "frequency", None), verdict.resonance) if f and f < half]
    near = [f + side * half * 0.8**i for f in marked for side in (-1, 1) for i in range(_NEAR)]
    even = [half * (i + 1) / (_POINTS + 1) for i in range(_POINTS)]
    frequencies = sorted(f for f in (*even, *near, *marked) if 0 < f < half)
    radii = [elastic.distance(Fraction(cos(pi * f / half))) for f in frequencies]
    axes.plot(frequencies, radii, color=BLUE, label="from the middle")
    axes.axhline(1, color="black", ls="--", lw=1.4, label="radius of the circle")
    inside = [r < 1 for r in radii]
    if any(inside):
        axes.fill_between(
            frequencies, radii, 1, where=inside, color=RED, alpha=0.35, lw=0, label="a hand gains"
        )
    if verdict.resonance is not None and verdict.resonance < half:
        text = f"the motor swings at {shown(verdict.resonance, 'Hz')}"
        axes.axvline(verdict.resonance, color=GREY, lw=1, ls=":", label=text)
    inside_or_marked = [*marked, *(f for f, r in zip(frequencies, radii, strict=True) if r < 1)]
    axes.set_xlim(0, min(half, 2 * max(inside_or_marked, default=half)))
    reach = max(0.05, 3 * (1 - min(radii)))
    axes.set_ylim(1 - reach, 1 + 2 * reach)
    axes.set_xlabel(label("frequency"))
    axes.set_ylabel(with_unit("distance from the circle's middle", "radii"))
    legend(axes)
    heading(axes, f"{verdict.outcome}: {verdict.decided_by}", color=OUTCOME[verdict.outcome])


def draw_replayed(rows: Sequence[Axes], found: ReplayedMotion) -> None:
    """Handle and motor, force of the actuator and energy out, on three axes one above the other."""
    trace, motion = found.trace, found.device.motion
    factor, text = axis([found.sample_period * found.motion.samples], "time")
    times = factor * trace["time"].values
    rows[2].set_xlabel(text)
    x, x1 = trace["position"].values, trace["motor_position"].values
    factor, text = axis([*x, *x1], "position", motion)
    rows[0].plot(times, factor * x1, color=ORANGE, lw=1, label="motor")
    rows[0].plot(times, factor * x, color=BLUE, label="handle")
    rows[0].set_ylabel(text)
    legend(rows[0])
    force = trace["actuator_force"].values
    factor, text = axis(force, "force", motion)
    rows[1].step(times, factor * force, where="post", color=PURPLE, lw=1)
    rows[1].set_ylabel(text)
    out = -trace["hand_work"].values
    factor, text = axis(out, "energy", text="energy out")
    rows[2].plot(times, factor * out, color=RED, gid="energy")
    rows[2].axhline(0, color=GREY, lw=0.6)
    rows[2].set_ylabel(text)
    rows[0].set_xlim(times[0], times[-1])
    energy = quantity_text(found.energy, "energy")
    heading(rows[0], f"replayed in the simulator: {energy} taken out", color=RED)
