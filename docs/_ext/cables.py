"""The stiffest wall of a device on a cable, against the stiffness of the cable: a table, and a picture."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import pi
from typing import Any

from matplotlib import rc_context
from matplotlib.figure import Figure

import zwidth as zw
from zwidth.show.plots import style

MASS, MOTOR_DAMPING, HANDLE_DAMPING, PERIOD = 0.03, 0.06, 0.09, 0.001
INSIDE, VIRTUAL = 0.5, 0.03
"""Damping inside the cable, and of the law, where there is some [N·s/m]."""

Cable = dict[str, Any]
STIFFNESSES = (2e3, 1e4, 3e4, 1e5, 3e5, 1e6, 3e6, 1e7)
CURVES: dict[str, tuple[Cable, float, str, str]] = {
    "encoder at the motor": ({}, 0, style.BLUE, "-"),
    f"the same, {INSIDE:g} N·s/m inside the cable": ({"damping": INSIDE}, 0, style.GREEN, "--"),
    f"the same, {VIRTUAL:g} N·s/m of virtual damping": ({}, VIRTUAL, style.RED, "-."),
    "encoder at the handle": ({"encoder": "handle"}, 0, style.ORANGE, ":"),
}


def largest(stiffness: float, cable: Cable, virtual: float) -> float:
    """The stiffest wall that is passive while the hand stays inside [N/m]; 0 if none is."""
    transmission = zw.Transmission(stiffness=stiffness, handle_damping=HANDLE_DAMPING, **cable)
    device = zw.Device(mass=MASS, damping=MOTOR_DAMPING, sample_period=PERIOD, transmission=transmission)
    found = zw.check(device, zw.Wall(100, damping=virtual), contact="kept").max_stiffness_viscous
    return found or 0.0


def rigid(virtual: float) -> float:
    """The same with motor and handle as one [N/m]."""
    device = zw.Device(damping=MOTOR_DAMPING + HANDLE_DAMPING, sample_period=PERIOD)
    return zw.check(device, zw.Wall(100, damping=virtual)).max_stiffness or 0.0


def resonance(stiffness: float) -> float:
    """Where the motor swings while the handle is held [Hz]."""
    return float((stiffness / MASS) ** 0.5 / (2 * pi))


def table(markdown: Callable[[Sequence[str], list[Sequence[str]]], str]) -> str:
    """Both places of the encoder, without damping, with some inside, with some in the law."""
    ways: list[tuple[str, Cable, float]] = [
        (f"{place}{what}", {"encoder": place, **cable}, virtual)
        for place in ("motor", "handle")
        for what, cable, virtual in (
            ("", {}, 0.0),
            (", inside", {"damping": INSIDE}, 0.0),
            (", virtual", {}, VIRTUAL),
        )
    ]
    rows: list[Sequence[str]] = [
        (f"{k / 1e3:g}", f"{resonance(k):.0f}", *(f"{largest(k, cable, b):.0f}" for _, cable, b in ways))
        for k in STIFFNESSES
    ]
    rows.append(("rigid", "", *(f"{rigid(b):.0f}" for *_, b in ways)))
    return markdown(("cable [N/mm]", "swings at [Hz]", *(name for name, *_ in ways)), rows)


def curves(frequencies: Sequence[float]) -> dict[str, list[tuple[float, float]]]:
    """Resonance and the stiffest wall, for each curve."""
    return {
        name: [(f, largest(MASS * (2 * pi * f) ** 2, cable, virtual)) for f in frequencies]
        for name, (cable, virtual, *_) in CURVES.items()
    }


@rc_context(style.LOOK)
def figure(found: dict[str, list[tuple[float, float]]]) -> Figure:
    """The stiffest wall against the resonance of the motor on its cable."""
    drawn = style.new_figure(height=4.6)
    axes = drawn.add_subplot()
    for name, points in found.items():
        *_, colour, line = CURVES[name]
        axes.plot(*zip(*points, strict=True), line, color=colour, label=name)
    marks = {
        "motor and handle as one": MOTOR_DAMPING + HANDLE_DAMPING,
        "the motor's damping alone": MOTOR_DAMPING,
    }
    for words, damping in marks.items():
        axes.axhline(2 * damping / PERIOD, color=style.GREY, linewidth=0.8)
        axes.text(13, 2 * damping / PERIOD - 5, words, va="top", color=style.GREY, fontsize=style.SMALL)
    axes.axvline(0.5 / PERIOD, color=style.GREY, linewidth=0.8, linestyle=":")
    axes.text(0.48 / PERIOD, 12, "half the sample rate", color=style.GREY, fontsize=style.SMALL, ha="right")
    axes.set(xscale="log", xlim=(10, 5000), ylim=(0, 320))
    ticks = (10, 30, 100, 300, 1000, 3000)
    axes.set_xticks(ticks, map(str, ticks))
    axes.set_xlabel(style.with_unit("the motor swings on its cable at", "Hz"))
    axes.set_ylabel(style.with_unit("stiffest passive wall", "N/m"))
    style.legend(axes)
    style.heading(axes, "Motor 30 g and 0.06 N·s/m, handle 0.09 N·s/m, 1 kHz")
    return drawn
