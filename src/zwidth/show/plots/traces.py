"""A touch against time, as the papers draw it: position, forces, energy."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from zwidth.loop.energy import PairLedger, ledger
from zwidth.show.plots.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    LOOK,
    ORANGE,
    PURPLE,
    RED,
    SKY,
    as_written,
    axis,
    heading,
    legend,
    legend_of_all,
    new_figure,
    page_heading,
    quantity_text,
    verbatim,
)
from zwidth.showing import printable

if TYPE_CHECKING:
    import xarray as xr

    from zwidth.native.compiled import Array


_MOST = 4000
"""Points of a curve that are drawn; of more, the highest and lowest of each stretch."""

_STAIRS = 400
"""Samples up to which the encoder's steps are drawn."""

_COMPARED: dict[str, tuple[str | None, Callable[[xr.Dataset], Array]]] = {
    "position": (None, lambda t: t["position"].values),
    "force": (None, lambda t: t["actuator_force"].values),
    "energy": ("energy out", lambda t: t["hand_work"].values[0] - t["hand_work"].values),
}

_COLOURS = (BLUE, ORANGE, BLACK, GREEN, PURPLE, RED, SKY, GREY)
_LINES = ("-", "-", "--", "--", "-.", "-.", ":", ":")
"""Of a trace; two that follow each other differ in grey, and those further apart in their dashes."""


@rc_context(LOOK)
def trace_figure(trace: xr.Dataset) -> Figure:
    """Position, forces and energy of one trace, one above the other."""
    figure = new_figure(height=7.0)
    above, middle, below = figure.subplots(3, 1, sharex=True)
    draw_position(above, trace)
    draw_forces(middle, trace)
    draw_energies(below, trace)
    loop = f"{trace.attrs['device']}, {as_written(trace.attrs['environment'])}"
    page_heading(figure, printable(f"{loop}\n{as_written(trace.attrs['operator'])}"))
    below.set_xlabel(timed(trace)[1])
    return figure


@rc_context(LOOK)
def comparison_figure(traces: Mapping[str, xr.Dataset]) -> Figure:
    """Position, actuator force and the energy that the hand got out, of several traces."""
    figure = new_figure(height=6.6 + 0.18 * len(traces))
    rows = figure.subplots(3, 1, sharex=True)
    motion = str(next(iter(traces.values())).attrs["motion"])
    longest = max(float(trace["time"].values[-1]) for trace in traces.values())
    seconds, text = axis([longest], "time")
    rows[-1].set_xlabel(text)
    for axes, (name, (words, values)) in zip(rows, _COMPARED.items(), strict=True):
        factor, text = axis([float(np.abs(values(t)).max()) for t in traces.values()], name, motion, words)
        for place, (label, trace) in enumerate(traces.items()):
            x, y = thinned(trace["time"].values * seconds, values(trace) * factor)
            colour, line = _COLOURS[place % len(_COLOURS)], _LINES[place % len(_LINES)]
            axes.plot(x, y, color=colour, ls=line, label=verbatim(label), lw=1.3)
        axes.axhline(0, color=GREY, lw=0.8)
        axes.set_ylabel(text)
    legend_of_all(figure, rows[0].get_legend_handles_labels()[0])
    return figure


def draw_position(axes: Axes, trace: xr.Dataset) -> None:
    """Position, what the encoder read, what the muscles wanted; the wall is shaded."""
    time = timed(trace)[0]
    x = trace["position"].values
    factor, text = axis([float(np.abs(x).max())], "position", str(trace.attrs["motion"]))
    wanted = trace["anchor_position"].values if "anchor_position" in trace else x
    if wanted is not x and np.abs(wanted).max() < 5 * np.abs(x).max():
        curve = thinned(time, wanted * factor)
        axes.plot(*curve, color=GREY, lw=1, ls="--", label="wanted by the muscles")
    if time.size <= _STAIRS:
        read = trace["measured_position"].values * factor
        axes.step(time, read, where="post", color=SKY, lw=1, label="read by the encoder")
    axes.plot(*thinned(time, x * factor), color=BLUE, label="position")
    if "motor_position" in trace:
        motor = thinned(time, trace["motor_position"].values * factor)
        axes.plot(*motor, color=BLACK, ls=":", lw=1, label="motor")
    shade_wall(axes)
    axes.set_ylabel(text)
    legend(axes)


def shade_wall(axes: Axes) -> None:
    """Positions inside it, as far as they are drawn."""
    low, high = axes.get_ylim()
    if high > 0:
        axes.axhspan(0, high, color=GREY, alpha=0.15, lw=0, label="in the wall")
        axes.set_ylim(low, high)
    axes.axhline(0, color=GREY, lw=0.8)


def draw_forces(axes: Axes, trace: xr.Dataset) -> None:
    """The actuator's staircase and the force of the hand."""
    time = timed(trace)[0]
    hand, actuator = trace["hand_force"].values, trace["actuator_force"].values
    largest = max(float(np.abs(hand).max()), float(np.abs(actuator).max()))
    factor, text = axis([largest], "force", str(trace.attrs["motion"]))
    axes.plot(*thinned(time, hand * factor), color=BLACK, ls="--", lw=1.2, label="hand, into the wall")
    steps: Any = {"drawstyle": "steps-post"} if time.size <= _MOST else {}
    axes.plot(*thinned(time, actuator * factor), color=PURPLE, lw=1.2, label="actuator, out of it", **steps)
    axes.axhline(0, color=GREY, lw=0.8)
    axes.set_ylabel(text)
    legend(axes)


def draw_energies(axes: Axes, trace: xr.Dataset) -> None:
    """What the hand and the actuator put in, and what friction took; below 0 the hand has got out energy."""
    time = timed(trace)[0]
    lost = trace["viscous_loss"].values + trace["coulomb_loss"].values
    lost = lost + trace["transmission_loss"].values if "transmission_loss" in trace else lost
    curves: dict[str, tuple[str, str, Array]] = {
        "from the hand": (BLACK, "--", trace["hand_work"].values),
        "from the actuator": (PURPLE, "-", trace["actuator_work"].values),
        "lost in friction": (GREEN, "-.", lost),
        "kinetic": (BLUE, "-", trace["kinetic_energy"].values),
    }
    if "transmission_energy" in trace:
        curves["in the transmission"] = (GREY, ":", trace["transmission_energy"].values)
    _draw_energies(axes, time, curves)
    if (book := ledger(trace)).active:
        out = quantity_text(book.extracted, "energy")
        heading(axes, f"the hand got out {out}: this loop is active", color=RED)


def _draw_energies(axes: Axes, time: Array, curves: Mapping[str, tuple[str, str, Array]]) -> None:
    factor, text = axis([max(float(np.abs(c).max()) for *_, c in curves.values())], "energy")
    axes.set_ylabel(text)
    for name, (colour, line, curve) in curves.items():
        axes.plot(*thinned(time, curve * factor), color=colour, ls=line, lw=1.3, label=name)
    axes.axhline(0, color=GREY, lw=0.8)
    legend(axes)


def thinned(x: Array, y: Array) -> tuple[Array, Array]:
    """The curve, or of a long one the lowest and highest point of each stretch, in order."""
    if x.size <= _MOST:
        return x, y
    width = -(-x.size // (_MOST // 2))
    whole = x.size // width * width
    parts = y[:whole].reshape(-1, width)
    start = np.arange(parts.shape[0]) * width
    picks = np.stack([start + parts.argmin(1), start + parts.argmax(1)], 1)
    picks.sort(axis=1)
    index = np.append(picks.ravel(), np.arange(whole, x.size))
    return x[index], y[index]


def timed(trace: xr.Dataset) -> tuple[Array, str]:
    """The times of a trace or a recording, and what the axis says."""
    time = trace["time"].values
    factor, text = axis([float(time[-1])], "time")
    return time * factor, text


ARMS = {"leader": (BLUE, "-"), "follower": (ORANGE, "--")}
"""How each is drawn, wherever two are."""


@rc_context(LOOK)
def pair_trace_figure(trace: xr.Dataset) -> Figure:
    """Both positions, both hands' forces, and what the hands put in, one above the other.

    Parameters
    ----------
    trace
        What `zwidth.simulate` returned of a `zwidth.Pair`.
    """
    figure = new_figure(height=7.4)
    above, middle, below = figure.subplots(3, 1, sharex=True)
    draw_both(above, trace, "position")
    draw_both(middle, trace, "hand_force", "force of its holder")
    draw_pair_energies(below, trace)
    about = trace.attrs
    held = as_written(f"leader: {about['leader_holder']}\nfollower: {about['follower_holder']}")
    page_heading(figure, printable(f"{about['coupling']}\n{held}"))
    below.set_xlabel(axis([float(trace["time"].values[-1])], "time")[1])
    return figure


def draw_both(axes: Axes, trace: xr.Dataset, name: str, text: str | None = None) -> None:
    time = timed(trace)[0]
    values = trace[name].values
    quantity = "position" if name == "position" else "force"
    factor, text = axis([float(np.abs(values).max())], quantity, str(trace.attrs["motion"]), text)
    for row, (arm, (colour, line)) in zip(values, ARMS.items(), strict=True):
        axes.plot(*thinned(time, row * factor), color=colour, ls=line, lw=1.3, label=arm)
    axes.axhline(0, color=GREY, lw=0.8)
    axes.set_ylabel(text)
    legend(axes)


def draw_pair_energies(axes: Axes, trace: xr.Dataset) -> None:
    """What both hands put in together, where it went; below 0 they have got energy out."""
    time, book = timed(trace)[0], PairLedger(trace)
    ratio = np.array([[1.0], [book.power_ratio]])
    lost = trace["viscous_loss"].values + trace["coulomb_loss"].values
    curves: dict[str, tuple[str, str, Array]] = {
        "from both hands": (BLACK, "--", book.hand_work),
        "into the coupling": (PURPLE, "-", book.coupling),
        "lost in friction": (GREEN, "-.", (ratio * lost).sum(axis=0)),
        "kinetic": (BLUE, "-", (ratio * trace["kinetic_energy"].values).sum(axis=0)),
    }
    _draw_energies(axes, time, curves)
    if book.active:
        out = quantity_text(book.extracted, "energy")
        heading(axes, f"{out} came out beyond what was in it: this pair is active", color=RED)
