"""The linear criterion against frequency: what damping is asked for, and what is there.

The loop is passive against every sustained motion where the curve stays at or
below the device's damping b, at every frequency up to half the sample rate.
"""

from __future__ import annotations

from math import cos, inf, isfinite, pi
from statistics import median

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from zwidth.passivity.linear_verdict import LinearVerdict
from zwidth.quantity.text import shown
from zwidth.show.plots.style import (
    BLACK,
    BLUE,
    GREY,
    LOOK,
    ORANGE,
    OUTCOME,
    PURPLE,
    RED,
    SKY,
    drawn_in,
    heading,
    label,
    legend,
    new_figure,
    number,
    symbol,
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
    factor, unit = drawn_in("damping", motion, [*needs, float(verdict.decision.loop.damping)])
    needs, b = [factor * need for need in needs], factor * float(verdict.decision.loop.damping)
    low, high = damping_range(needs, b, room=0.12)
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
    _mark(axes, verdict, needs, factor * verdict.budget.required, unit)
    axes.set_xlabel(label("frequency"))
    axes.set_ylabel(label("damping", motion, "required damping", unit))
    legend(axes)
    heading(axes, f"{verdict.outcome}: {verdict.limit}", color=OUTCOME[verdict.outcome])


def refined_curve(verdict: LinearVerdict) -> tuple[list[float], list[float]]:
    """(frequencies [Hz], required damping) with points crowding towards the tightest frequency.

    However narrow the peak, its top and both its sides are among them.
    """
    loop = verdict.decision.loop
    nyquist, peak = 0.5 / float(loop.period), verdict.critical_frequency
    steps = [nyquist * 10 ** (-10 * k / _NEAR) for k in range(_NEAR)]
    near = [f for s in steps for f in (peak - s, peak + s) if 0 < f < nyquist]
    known = dict(zip(*verdict.curve(400), strict=True))
    needs = loop.required_dampings_at([cos(pi * f / nyquist) for f in near])
    known.update(zip(near, needs, strict=True))
    known[min(peak, nyquist)] = verdict.budget.required
    frequencies = sorted(known)
    return frequencies, [known[f] for f in frequencies]


def damping_range(needs: list[float], b: float, room: float = 0.45) -> tuple[float, float]:
    """Ends of the vertical axis: all of the curve, unless it has no end, and some room above it."""
    finite = [n for n in needs if isfinite(n)]
    top = max([b, *finite])
    if len(finite) < len(needs):
        top = 10 * max(b, abs(median(finite)) if finite else 1.0)
    bottom = max(min(0.0, *finite), -top)  # how far it lies below zero is of no interest
    span = (top - bottom) or 1.0
    return (bottom - 0.05 * span if bottom < 0 else 0.0), top + room * span


def _mark(axes: Axes, verdict: LinearVerdict, needs: list[float], need: float, unit: str) -> None:
    peak, (low, high) = verdict.critical_frequency, axes.get_ylim()
    if low < 0:
        axes.axhline(0, color=GREY, lw=0.6)
    if verdict.required_damping is None and need < inf:
        axes.plot([], [], ls="none", label="no damping is enough")
        return
    if need == inf:
        text, height = f"no damping is enough at {shown(peak, 'Hz')}", high * 0.9
    elif max(needs) - min(needs) <= _FLAT * abs(need):
        text, height = f"{number(need)} {unit} at every frequency", need
    else:
        place = f"at {shown(peak, 'Hz')}" if peak else "towards 0 Hz"
        text, height = f"{number(need)} {unit} {place}", need
    at = max(peak, axes.get_xlim()[0])
    axes.plot([at], [height], "o", color=RED, ms=6, clip_on=False, zorder=5, gid="critical", label=text)


# The budget: what leaks energy, against what takes it out.


_SHARES = (
    ("hold", "hold, K T/2", SKY),
    ("dynamics", "dynamics of the law", PURPLE),
    ("delay", "delay", ORANGE),
)
_TINY = 1e-9


@rc_context(LOOK)
def budget(verdict: LinearVerdict) -> Figure:
    """Leaks against dissipation as bars: damping above, Coulomb friction below.

    The second pair is left out for an ideal encoder.
    """
    figure = new_figure(height=3.6 if has_friction(verdict) else 2.2)
    rows = figure.subplots(2 if has_friction(verdict) else 1, 1, squeeze=False)
    draw_damping(rows[0][0], verdict)
    if has_friction(verdict):
        draw_friction(rows[1][0], verdict)
    return figure


def has_friction(verdict: LinearVerdict) -> bool:
    """True when the encoder asks for anything."""
    return verdict.device.exact("resolution") > 0


def draw_damping(axes: Axes, verdict: LinearVerdict) -> None:
    """Shares of the required damping, stacked, above the device's damping."""
    account, motion = verdict.budget, verdict.device.motion
    factor, unit = drawn_in("damping", motion, (account.damping, account.required, account.hold))
    if isfinite(account.required) and verdict.required_damping is not None:
        _stack(axes, [(factor * getattr(account, key), text, colour) for key, text, colour in _SHARES])
        asked = factor * account.required
        if account.required < account.hold + max(account.dynamics, 0) + max(account.delay, 0) - _TINY:
            total = f"asked in all: {number(asked)}"
            axes.plot([asked] * 2, [0.6, 1.4], color=BLACK, lw=2, label=total)
    else:
        _words(axes, "no damping is enough")
    has = factor * account.damping
    axes.barh(0, has, height=0.6, color=BLACK, gid="b")
    _finish(axes, ("leaks", f"b = {number(has)}"))
    axes.set_xlabel(label("damping", motion, unit=unit))


def draw_friction(axes: Axes, verdict: LinearVerdict) -> None:
    """What one encoder count asks for, above the device's Coulomb friction."""
    account, motion = verdict.budget, verdict.device.motion
    need, has = account.friction_required, account.coulomb_friction
    factor, unit = drawn_in("coulomb_friction", motion, (has, need or 0.0))
    if need is not None:
        name = "encoder count, K Δ/2" if verdict.decision.is_spring else "largest error of a count"
        _stack(axes, [(factor * need, name, SKY)])
    else:
        _words(axes, "none is known to be enough for this law")
    axes.barh(0, factor * has, height=0.6, color=BLACK, gid="f_c")
    _finish(axes, ("leaks", f"{symbol('coulomb_friction')} = {number(factor * has)}"))
    axes.set_xlabel(label("coulomb_friction", motion, unit=unit))


def _stack(axes: Axes, shares: list[tuple[float, str, str]]) -> None:
    """Positive shares to the right of zero one after the other, negative ones to the left."""
    ends = {True: 0.0, False: 0.0}
    largest = max(abs(value) for value, _, _ in shares)
    if largest == 0:
        _words(axes, "nothing")
    for value, text, colour in shares:
        if abs(value) > _TINY * largest:
            axes.barh(
                1, value, left=ends[value > 0], height=0.6, color=colour, edgecolor="white",
                label=f"{text}: {number(value)}", gid="leak",
            )  # fmt: skip
            ends[value > 0] += value


def _words(axes: Axes, text: str) -> None:
    """In the place of the upper bar."""
    axes.text(0.02, 1, text, va="center", transform=axes.get_yaxis_transform())


def _finish(axes: Axes, names: tuple[str, str]) -> None:
    axes.set_yticks([1, 0], names)
    axes.set_ylim(-0.5, 1.5)
    axes.axvline(0, color=GREY, lw=0.8)
    axes.margins(x=0.06)
    if not axes.dataLim.width:
        axes.set_xlim(0, 1)
    axes.spines["left"].set_visible(False)
    axes.tick_params(axis="y", length=0)
    axes.locator_params(axis="x", nbins=5)
    legend(axes)
