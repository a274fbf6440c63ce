"""A device with a transmission: its criterion against frequency, and the motion that was replayed."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import cos, pi
from typing import TYPE_CHECKING

from matplotlib.axes import Axes

from zwidth.passivity.transmission import TransmissionVerdict
from zwidth.quantity.glossary import GLOSSARY
from zwidth.show.plots.style import (
    BLUE,
    GREY,
    ORANGE,
    OUTCOME,
    PURPLE,
    RED,
    heading,
    label,
    number,
    quantity_text,
    scale,
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
        text = f"the motor swings at {number(verdict.resonance)} Hz"
        axes.axvline(verdict.resonance, color=GREY, lw=1, ls=":", label=text)
    axes.set_xlim(0, half)
    reach = max(0.05, 3 * (1 - min(radii)))
    axes.set_ylim(1 - reach, 1 + 2 * reach)
    axes.set_xlabel(label("frequency"))
    axes.set_ylabel("distance from the circle's middle [radii]")
    heading(axes, f"{verdict.outcome}: {verdict.decided_by}", color=OUTCOME[verdict.outcome])
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.13), ncols=2)


def draw_replayed(rows: Sequence[Axes], found: ReplayedMotion) -> None:
    """Handle and motor, force of the actuator and energy out, on three axes one above the other."""
    trace, motion = found.trace, found.device.motion
    factor, unit = scale([found.sample_period * found.motion.samples], "s")
    times = factor * trace["time"].values
    x, x1 = trace["position"].values, trace["motor_position"].values
    size, length = scale([*x, *x1], GLOSSARY["position"].unit_for(motion))
    rows[0].plot(times, size * x1, color=ORANGE, lw=1, label="motor")
    rows[0].plot(times, size * x, color=BLUE, label="handle")
    rows[0].set_ylabel(label("position", motion, "", length))
    rows[0].legend(loc="upper right", ncols=2)
    rows[0].margins(y=0.3)
    force = trace["actuator_force"].values
    size, newton = scale(force, GLOSSARY["force"].unit_for(motion))
    rows[1].step(times, size * force, where="post", color=PURPLE, lw=1)
    rows[1].set_ylabel(label("force", motion, "", newton))
    out = -trace["hand_work"].values
    size, joule = scale(out, "J")
    rows[2].plot(times, size * out, color=RED, gid="energy")
    rows[2].axhline(0, color=GREY, lw=0.6)
    rows[2].set_ylabel(f"energy out [{joule}]")
    rows[2].set_xlabel(f"time t [{unit}]")
    rows[0].set_xlim(times[0], times[-1])
    energy = quantity_text(found.energy, "energy")
    heading(rows[0], f"replayed in the simulator: {energy} taken out", color=RED)
