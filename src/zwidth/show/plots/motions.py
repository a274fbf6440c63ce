"""The motion that takes energy out: where the hand goes, what pushes it, what it gains.

The force is held between updates, so it lags the hand: it pushes harder on the
way out than it resisted on the way in.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import ceil, floor
from typing import TYPE_CHECKING

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.passivity.formulas.abbott_okamura import linear_worst_case, stiffness_of_wall
from zwidth.passivity.formulas.abbott_okamura import worst_case as worst_case_at
from zwidth.passivity.formulas.diolaiti import plane_point
from zwidth.passivity.formulas.hypotheses import positive
from zwidth.passivity.outcome_evidence import Moves
from zwidth.passivity.result import Evidence
from zwidth.passivity.verdict import Verdict
from zwidth.passivity.witness.witness import Witness
from zwidth.quantity.exact import RealLike
from zwidth.show.plots.cables import draw_replayed
from zwidth.show.plots.replay import WHOLE, Replay, replay
from zwidth.show.plots.style import (
    BLUE,
    GREY,
    LOOK,
    ORANGE,
    PURPLE,
    RED,
    axis,
    heading,
    legend,
    new_figure,
    quantity_text,
    scale,
    shown_name,
    with_unit,
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
    figure = new_figure(height=5.0)
    rows = figure.subplots(3, 1, sharex=True)
    draw_witness(list(rows), verdict)
    return figure


def draw_witness(rows: Sequence[Axes], verdict: Verdict) -> None:
    """The same on three given axes, one above the other."""
    if verdict.witness is None:
        raise InputError(f"the loop is {verdict.outcome}: there is no motion to draw")
    draw_motion(rows, verdict.witness)


def draw_motion(rows: Sequence[Axes], found: Moves) -> None:
    if not isinstance(found, Evidence):
        draw_replayed(rows, found)
        return
    if not isinstance(found, Witness):
        draw_cycle(rows, found)
        return
    played = replay(found)
    factor, text = axis([played.times[-1] - played.times[0]], "time")
    times = [factor * t for t in played.times]
    _positions(rows[0], found, played, times)
    _forces(rows[1], found, played, times)
    _energy(rows[2], played.energies, times)
    heading(rows[0], _title(found, played.caption), color=RED)
    rows[2].set_xlabel(text)
    rows[0].set_xlim(times[0], times[-1])


def _title(found: Witness, caption: str) -> str:
    total = quantity_text(found.energy, "energy")
    if caption.endswith("rounds"):
        more = quantity_text(found.energy_per_cycle, "energy")
        return f"{caption}; one more takes out {more}, all of them {total}"
    return f"{caption} takes out {total}" if caption == WHOLE else f"{caption}; all of it takes out {total}"


def _positions(axes: Axes, found: Witness, played: Replay, times: list[float]) -> None:
    motion = found.setting.motion
    factor, text = axis(played.positions, "position", motion)
    values = [factor * p for p in played.positions]
    dots = "o" if len(played.sampled) <= _DOTS else ""
    axes.plot(times, values, color=BLUE, marker=dots, markevery=played.sampled, ms=3.5, label="position")
    step = factor * float(found.setting.resolution)
    if step:
        edges = range(ceil(min(values) / step - 1e-9), floor(max(values) / step + 1e-9) + 1)
        if len(edges) <= _EDGES:
            _edges(axes, [n * step for n in edges])
    elif min(values) < 0 < max(values):
        axes.axhline(0, color=GREY, lw=0.6)
    axes.set_ylabel(text)


def _edges(axes: Axes, places: Sequence[float]) -> None:
    """Where the encoder counts, and a legend that says so."""
    for n, place in enumerate(places):
        name = None if n else "edges of the encoder's counts"
        axes.axhline(place, color=GREY, lw=0.7, ls=":", gid="edge", label=name)
    if places:
        legend(axes)


def _forces(axes: Axes, found: Witness, played: Replay, times: list[float]) -> None:
    motion = found.setting.motion
    factor, text = axis(played.forces, "force", motion)
    axes.stairs([factor * f for f in played.forces], times, color=PURPLE, lw=1.6, baseline=None)
    if min(played.forces) <= 0 <= max(played.forces):
        axes.axhline(0, color=GREY, lw=0.6)
    axes.set_ylabel(text)


def _energy(axes: Axes, energies: Sequence[float], times: Sequence[float]) -> None:
    factor, text = axis(energies, "energy", text="energy out")
    axes.plot(times, [factor * e for e in energies], color=RED, gid="energy")
    axes.axhline(0, color=GREY, lw=0.6)
    axes.set_ylabel(text)


_ROUND_EDGES = 16
"""Encoder edges up to which each is drawn."""

_SHOWN = 24
"""Samples that are filled with rounds where one is shorter."""


@rc_context(LOOK)
def cycle(gain: Gain) -> Figure:
    """Position at the samples, held force and energy out over some rounds of a motion that gains.

    Parameters
    ----------
    gain
        `zwidth.available_storage(…).witness`.
    """
    figure = new_figure(height=5.0)
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
    _round_positions(rows[0], times, x, once.resolution, motion)
    factor, text = axis(once.forces, "force", motion)
    rows[1].stairs([factor * f for f in once.forces * rounds], times, color=PURPLE, baseline=None)
    rows[1].axhline(0, color=GREY, lw=0.6)
    rows[1].set_ylabel(text)
    out = [n * once.energies[-1] + e for n in range(rounds) for e in once.energies[:-1]]
    _energy(rows[2], [*out, rounds * once.energies[-1]], times)
    rows[2].set_xlabel("sample k, the law settled")
    rows[2].set_xlim(0, times[-1])
    rows[2].xaxis.set_major_locator(MaxNLocator(integer=True))
    energy = quantity_text(gain.energy_per_cycle, "energy")
    heading(rows[0], f"{energy} out in every round of {samples} samples", color=RED)


def _round_positions(
    axes: Axes, times: Sequence[float], x: Sequence[float], resolution: float, motion: str
) -> None:
    factor, text = axis(x, "position", motion)
    axes.plot(times, [factor * v for v in x], color=BLUE, label="position")
    if len(x) <= _DOTS:  # a dot where the encoder is read
        read = [(t, factor * v) for t, v in zip(times, x, strict=True) if t == round(t)]
        axes.plot(
            *zip(*read, strict=True), "o", color=BLUE, ms=3.5, clip_on=False, gid="samples", label="samples"
        )
    edges = range(floor(min(x) / resolution + 1e-9), ceil(max(x) / resolution - 1e-9) + 1)
    if len(edges) <= _ROUND_EDGES:
        _edges(axes, [factor * n * resolution for n in edges])
    axes.set_ylabel(text)


# Worst-case J* of a spring wall behind an encoder (Abbott & Okamura 2005, figures 4 and 5).


_POINTS = 100


@rc_context(LOOK)
def worst_case(device: Device, stiffness: RealLike, span: RealLike | None = None) -> Figure:
    """J* against λ, compression on the left and release on the right, with the linear worst case.

    Parameters
    ----------
    device
        Certain values, Δ > 0, no delay.
    stiffness
        K > 0 [N/m; N·m/rad].
    span
        Largest |λ| [m; rad]; if not given, where the quadratic part has grown
        to twice the linear one, and at least four encoder counts.

    Raises
    ------
    InputError
        If the formulas do not apply or `span` ≤ 0.
    """
    figure = new_figure()
    draw_worst_case(figure.add_subplot(), device, stiffness, span)
    return figure


def draw_worst_case(axes: Axes, device: Device, stiffness: RealLike, span: RealLike | None = None) -> None:
    """The same on given axes."""
    wall = stiffness_of_wall(stiffness)
    region = plane_point(device, wall).region
    reach = (
        _span(device, wall)
        if span is None
        else positive("span", span, "there is no motion to draw", "position")
    )
    steps = [reach * k / _POINTS for k in range(-_POINTS, _POINTS + 1)]
    curve = [float(worst_case_at(device, wall, s)) for s in steps]
    line = [float(linear_worst_case(device, wall, s)) for s in steps]
    energy, joules = scale([*curve, *line], "J")
    length, metres = scale([float(reach)], device.unit("position"))
    x = [length * float(s) for s in steps]
    axes.plot(x, [energy * j for j in curve], color=BLUE, label="worst case J*")
    axes.plot(x, [energy * j for j in line], color=ORANGE, ls="--", label="linear worst case")
    axes.axhline(0, color=GREY, lw=0.8)
    axes.axvline(0, color=GREY, lw=0.8)
    axes.set_xlim(x[0], x[-1])
    for place, word in ((0.25, "compression"), (0.75, "release")):
        axes.text(place, 0.02, word, transform=axes.transAxes, ha="center", va="bottom", color=GREY)
    axes.set_xlabel(with_unit("way out in one sample λ", metres))
    axes.set_ylabel(with_unit("beyond an ideal spring, J*", joules))
    k = quantity_text(float(wall), "stiffness", device.motion)
    axes.margins(y=0.12)
    legend(axes)
    heading(axes, f"{shown_name(device)}, K = {k}: {region}", parse_math=False)


def _span(device: Device, k: Fraction) -> Fraction:
    count = device.exact("resolution")
    slope = max(device.exact("coulomb_friction"), abs(k * count - device.exact("coulomb_friction")))
    curvature = abs(device.exact("damping") / device.exact("sample_period") - k / 2)
    natural = 2 * slope / curvature if curvature else Fraction(0)
    return max(natural, 4 * count) or Fraction(1, 1000)
