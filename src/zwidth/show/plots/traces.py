"""A touch against time, as the papers draw it: position, forces, energy."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from zwidth.loop.energy import PairLedger, ledger
from zwidth.loop.trace import UNITS
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
    heading,
    new_figure,
    number,
    scale,
    verbatim,
)

if TYPE_CHECKING:
    import xarray as xr

    from zwidth.native.compiled import Array


_MOST = 4000
"""Points of a curve that are drawn; of more, the highest and lowest of each stretch."""

_STAIRS = 400
"""Samples up to which the encoder's steps are drawn."""

_COMPARED: dict[str, Callable[[xr.Dataset], Array]] = {
    "position": lambda t: t["position"].values,
    "actuator force": lambda t: t["actuator_force"].values,
    "energy got out by the hand": lambda t: t["hand_work"].values[0] - t["hand_work"].values,
}

_COLOURS = (BLUE, ORANGE, GREEN, RED, PURPLE, SKY, BLACK, GREY)


@rc_context(LOOK)
def trace_figure(trace: xr.Dataset) -> Figure:
    """Position, forces and energy of one trace, one above the other."""
    figure = new_figure(8.4, 6.6)
    above, middle, below = figure.subplots(3, 1, sharex=True, height_ratios=(1.15, 1, 1))
    draw_position(above, trace)
    draw_forces(middle, trace)
    draw_energies(below, trace)
    heading(above, _title(trace))
    below.set_xlabel(f"time [{_time(trace)[1]}]")
    return figure


@rc_context(LOOK)
def comparison_figure(traces: Mapping[str, xr.Dataset]) -> Figure:
    """Position, actuator force and the energy that the hand got out, of several traces."""
    figure = new_figure(7.2, 6.6 + 0.18 * len(traces))
    rows = figure.subplots(3, 1, sharex=True)
    motion = str(next(iter(traces.values())).attrs["motion"])
    units = (UNITS[motion][0], UNITS[motion][2], "J")
    longest = max(float(trace["time"].values[-1]) for trace in traces.values())
    seconds, unit = scale([longest], "s")
    for axes, (name, values), base in zip(rows, _COMPARED.items(), units, strict=True):
        factor, shown = scale([float(np.abs(values(t)).max()) for t in traces.values()], base)
        for colour, (label, trace) in zip(_cycle(len(traces)), traces.items(), strict=True):
            x, y = thinned(trace["time"].values * seconds, values(trace) * factor)
            axes.plot(x, y, color=colour, label=verbatim(label), lw=1.3)
        axes.axhline(0, color=GREY, lw=0.8)
        axes.set_ylabel(f"{name}\n[{shown}]")
    rows[-1].set_xlabel(f"time [{unit}]")
    handles, labels = rows[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper left", ncols=1)
    return figure


def draw_position(axes: Axes, trace: xr.Dataset) -> None:
    """Position, what the encoder read, what the muscles wanted; the wall is shaded."""
    time = _time(trace)[0]
    x = trace["position"].values
    factor, unit = scale([float(np.abs(x).max())], UNITS[str(trace.attrs["motion"])][0])
    wanted = trace["anchor_position"].values if "anchor_position" in trace else x
    if wanted is not x and np.abs(wanted).max() < 5 * np.abs(x).max():
        curve = thinned(time, wanted * factor)
        axes.plot(*curve, color=GREY, lw=1, ls="--", label="wanted by the muscles")
    if time.size <= _STAIRS:
        read = trace["measured_position"].values * factor
        axes.step(time, read, where="post", color=SKY, lw=1, label="read by the encoder")
    axes.plot(*thinned(time, x * factor), color=BLUE, label="position")
    if "motor_position" in trace:
        axes.plot(*thinned(time, trace["motor_position"].values * factor), color=GREEN, lw=1, label="motor")
    low, high = axes.get_ylim()
    if high > 0:
        axes.axhspan(0, high, color=GREY, alpha=0.12, lw=0)
        axes.set_ylim(low, high)
    axes.axhline(0, color=GREY, lw=0.8)
    axes.set_ylabel(f"position [{unit}]\n(wall shaded)")
    if len(axes.get_lines()) > 2:
        _legend(axes)


def draw_forces(axes: Axes, trace: xr.Dataset) -> None:
    """The actuator's staircase and the force of the hand."""
    time = _time(trace)[0]
    hand, actuator = trace["hand_force"].values, trace["actuator_force"].values
    largest = max(float(np.abs(hand).max()), float(np.abs(actuator).max()))
    factor, unit = scale([largest], UNITS[str(trace.attrs["motion"])][2])
    axes.plot(*thinned(time, hand * factor), color=ORANGE, lw=1.2, label="hand, into the wall")
    steps: Any = {"drawstyle": "steps-post"} if time.size <= _MOST else {}
    axes.plot(*thinned(time, actuator * factor), color=PURPLE, lw=1.2, label="actuator, out of it", **steps)
    axes.axhline(0, color=GREY, lw=0.8)
    axes.set_ylabel(f"force [{unit}]")
    _legend(axes)


def draw_energies(axes: Axes, trace: xr.Dataset) -> None:
    """What the hand and the actuator put in, and what friction took; below 0 the hand has got out energy."""
    time = _time(trace)[0]
    names = {
        "hand_work": (ORANGE, "from the hand"),
        "actuator_work": (PURPLE, "from the actuator"),
        "loss": (GREEN, "lost in friction"),
        "kinetic_energy": (BLUE, "kinetic"),
    }
    if "transmission_energy" in trace:
        names["transmission_energy"] = (GREY, "in the transmission")
    lost = trace["viscous_loss"].values + trace["coulomb_loss"].values
    lost = lost + trace["transmission_loss"].values if "transmission_loss" in trace else lost
    curves = {name: lost if name == "loss" else trace[name].values for name in names}
    factor, unit = scale([max(float(np.abs(c).max()) for c in curves.values())], "J")
    for name, (colour, text) in names.items():
        axes.plot(*thinned(time, curves[name] * factor), color=colour, lw=1.3, label=text)
    axes.axhline(0, color=GREY, lw=0.8)
    axes.set_ylabel(f"energy [{unit}]")
    _legend(axes)
    book = ledger(trace)
    if book.active:
        out = book.extracted
        f, u = scale([out], "J")
        heading(axes, f"the hand got out {number(out * f)} {u}: this loop is active", color=RED)


def _legend(axes: Axes) -> None:
    """Beside the axes: curves that swing leave no room inside."""
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))


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


def _time(trace: xr.Dataset) -> tuple[Array, str]:
    time = trace["time"].values
    factor, unit = scale([float(time[-1])], "s")
    return time * factor, unit


def _title(trace: xr.Dataset) -> str:
    about = trace.attrs
    return verbatim(f"{about['device']}, {as_written(about['environment'])}\n{as_written(about['operator'])}")


def _cycle(count: int) -> list[str]:
    return [_COLOURS[i % len(_COLOURS)] for i in range(count)]


_ARM_COLOURS = {"leader": BLUE, "follower": ORANGE}


@rc_context(LOOK)
def pair_trace_figure(trace: xr.Dataset) -> Figure:
    """Both positions, both hands' forces, and what the hands put in, one above the other.

    Parameters
    ----------
    trace
        What `zwidth.simulate` returned of a `zwidth.Pair`.
    """
    figure = new_figure(8.4, 6.8)
    above, middle, below = figure.subplots(3, 1, sharex=True, height_ratios=(1.15, 1, 1))
    draw_both(above, trace, "position", "position")
    draw_both(middle, trace, "hand_force", "force on the arm\nby what holds it")
    draw_pair_energies(below, trace)
    about = trace.attrs
    held = as_written(f"leader: {about['leader_holder']}\nfollower: {about['follower_holder']}")
    heading(above, verbatim(f"{about['coupling']}\n{held}"))
    below.set_xlabel(f"time [{scale([float(trace['time'].values[-1])], 's')[1]}]")
    return figure


def draw_both(axes: Axes, trace: xr.Dataset, name: str, text: str) -> None:
    """One variable of both arms."""
    time = _arm_time(trace)
    values = trace[name].values
    unit = UNITS[str(trace.attrs["motion"])][0 if name == "position" else 2]
    factor, shown = scale([float(np.abs(values).max())], unit)
    for row, (arm, colour) in zip(values, _ARM_COLOURS.items(), strict=True):
        axes.plot(*thinned(time, row * factor), color=colour, lw=1.3, label=arm)
    axes.axhline(0, color=GREY, lw=0.8)
    axes.set_ylabel(f"{text} [{shown}]")
    _legend(axes)


def draw_pair_energies(axes: Axes, trace: xr.Dataset) -> None:
    """What both hands put in together, where it went; below 0 they have got energy out."""
    time, book = _arm_time(trace), PairLedger(trace)
    ratio = np.array([[1.0], [book.power_ratio]])
    lost = trace["viscous_loss"].values + trace["coulomb_loss"].values
    curves: dict[str, tuple[str, Array]] = {
        "from both hands": (RED, book.hand_work),
        "into the coupling": (PURPLE, book.coupling),
        "lost in friction": (GREEN, (ratio * lost).sum(axis=0)),
        "kinetic": (BLUE, (ratio * trace["kinetic_energy"].values).sum(axis=0)),
    }
    factor, unit = scale([max(float(np.abs(c).max()) for _, c in curves.values())], "J")
    for text, (colour, curve) in curves.items():
        axes.plot(*thinned(time, curve * factor), color=colour, lw=1.3, label=text)
    axes.axhline(0, color=GREY, lw=0.8)
    axes.set_ylabel(f"energy [{unit}]")
    _legend(axes)
    if book.active:
        f, u = scale([book.extracted], "J")
        heading(
            axes,
            f"{number(book.extracted * f)} {u} came out beyond what was in it: this pair is active",
            color=RED,
        )


def _arm_time(trace: xr.Dataset) -> Array:
    time: Array = trace["time"].values
    return time * scale([float(time[-1])], "s")[0]
