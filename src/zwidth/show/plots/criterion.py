"""The linear criterion against frequency: what damping is asked for, and what is there.

The loop is passive against every sustained motion where the curve stays at or
below the device's damping b, at every frequency up to half the sample rate.
"""

from __future__ import annotations

from math import cos, inf, isfinite, log, pi
from statistics import median

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from zwidth.passivity.linear_verdict import LinearVerdict
from zwidth.show.plots.style import (
    BLUE,
    GREY,
    LOOK,
    OUTCOME,
    RED,
    drawn_in,
    heading,
    label,
    new_figure,
    number,
)

_NEAR = 120
"""Extra points on each side of the tightest frequency."""

_FLAT = 1e-6


@rc_context(LOOK)
def criterion(verdict: LinearVerdict, log_frequency: bool = False) -> Figure:
    """Required damping against frequency, 0 … 1/(2T), with the device's damping.

    Parameters
    ----------
    verdict
        What `zwidth.check` returned.
    log_frequency
        Frequency on a logarithmic axis.
    """
    figure = new_figure()
    draw_criterion(figure.add_subplot(), verdict, log_frequency)
    return figure


def draw_criterion(axes: Axes, verdict: LinearVerdict, log_frequency: bool = False) -> None:
    """The same on given axes."""
    frequencies, needs = refined_curve(verdict)
    motion = verdict.device.motion
    factor, unit = drawn_in("damping", motion)
    needs, b = [factor * need for need in needs], factor * float(verdict.decision.loop.damping)
    low, high = damping_range(needs, b)
    wanting = [n > b for n in needs]
    if any(wanting):
        axes.fill_between(
            frequencies, b, needs, where=wanting, color=RED, alpha=0.2, lw=0, label="b too small"
        )
    axes.plot(frequencies, needs, color=BLUE, label="asked of the device")
    axes.axhline(b, color="black", ls="--", lw=1.4, label=f"device damping b = {number(b)} {unit}")
    nyquist = 0.5 / float(verdict.decision.loop.period)
    slowest = nyquist / 1000 if log_frequency else 0.0
    if log_frequency:
        slowest = min(slowest, verdict.critical_frequency / 10 or slowest)
        axes.set_xscale("log")
    axes.set_xlim(slowest, nyquist)
    axes.set_ylim(low, high)
    _mark(axes, verdict, needs, (low, high))
    axes.set_xlabel(label("frequency"))
    axes.set_ylabel(label("damping", motion, "required damping"))
    heading(axes, f"{verdict.outcome}: {verdict.limit}", color=OUTCOME[verdict.outcome])
    axes.legend(loc="upper left")


def refined_curve(verdict: LinearVerdict, points: int = 400) -> tuple[list[float], list[float]]:
    """(frequencies [Hz], required damping) with points crowding towards the tightest frequency.

    However narrow the peak, its top and both its sides are among them.
    """
    loop = verdict.decision.loop
    nyquist, peak = 0.5 / float(loop.period), verdict.critical_frequency
    steps = [nyquist * 10 ** (-10 * k / _NEAR) for k in range(_NEAR)]
    near = [f for s in steps for f in (peak - s, peak + s) if 0 < f < nyquist]
    known = dict(zip(*verdict.curve(points), strict=True))
    needs = loop.required_dampings_at([cos(pi * f / nyquist) for f in near])
    known.update(zip(near, needs, strict=True))
    known[min(peak, nyquist)] = verdict.budget.required
    frequencies = sorted(known)
    return frequencies, [known[f] for f in frequencies]


def damping_range(needs: list[float], b: float) -> tuple[float, float]:
    """Ends of the vertical axis: all of the curve, unless it has no end."""
    finite = [n for n in needs if isfinite(n)]
    top = max([b, *finite])
    if len(finite) < len(needs):
        top = 10 * max(b, abs(median(finite)) if finite else 1.0)
    bottom = max(min(0.0, *finite), -top)  # how far it lies below zero is of no interest
    span = (top - bottom) or 1.0
    return (bottom - 0.05 * span if bottom < 0 else 0.0), top + 0.45 * span


def _mark(axes: Axes, verdict: LinearVerdict, needs: list[float], limits: tuple[float, float]) -> None:
    factor, unit = drawn_in("damping", verdict.device.motion)
    peak, need = verdict.critical_frequency, factor * verdict.budget.required
    if limits[0] < 0:
        axes.axhline(0, color=GREY, lw=0.6)
    if verdict.required_damping is None and need < inf:
        axes.text(0.03, 0.66, "no damping is enough", transform=axes.transAxes, fontsize=8.5)
        return
    if need == inf:
        text, height = f"no damping is enough at {number(peak)} Hz", limits[1] * 0.68
    elif max(needs) - min(needs) <= _FLAT * abs(need):
        text, height = f"{number(need)} {unit} at every frequency", need
    else:
        place = f"at {number(peak)} Hz" if peak else "towards 0 Hz"
        text, height = f"{number(need)} {unit} {place}", need
    nyquist = 0.5 / float(verdict.decision.loop.period)
    slowest = axes.get_xlim()[0]
    at = max(peak, slowest)
    across = log(at / slowest) / log(nyquist / slowest) if slowest else min(at / nyquist, 1.0)
    axes.plot([at], [height], "o", color=RED, ms=6, clip_on=False, zorder=5, gid="critical")
    side = "left" if across < 0.35 else "right" if across > 0.65 else "center"
    shift = {"left": 6, "right": -6, "center": 0}[side]
    axes.annotate(text, (at, height), (shift, 7), textcoords="offset points", ha=side, fontsize=8.5)
