"""A null-space spring: the loop that takes energy out, and the joules of a loop of each size."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FormatStrFormatter, NullLocator

from zwidth.model.arms import DescribedArm
from zwidth.model.arms.null_space import Loop, Shape, gain, shapes
from zwidth.quantity.text import shown
from zwidth.show.plots.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    LOOK,
    ORANGE,
    OUTCOME,
    RED,
    heading,
    new_figure,
    number,
    page_heading,
    verbatim,
)

if TYPE_CHECKING:
    from zwidth.passivity.workspace import NullSpace

Array = npt.NDArray[np.float64]

_SIZES = 24
_SPAN = 1.8
"""How much farther than the loop, or the distance asked about, the joules are drawn."""
_FIRST = 0.02
"""The smallest size that is drawn [rad]."""
_ROUND = 200
_TICKS = (0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0)


@rc_context(LOOK)
def null_space_figure(found: NullSpace) -> Figure:
    """The loop in the two joints that move most, and joules per turn over the size of the region.

    Parameters
    ----------
    found
        What `zwidth.null_space` returned.
    """
    figure = new_figure(8.0, 3.9)
    left, right = figure.subplots(1, 2, width_ratios=(4, 5))
    shape = _shape(found)
    _draw_loop(left, found, shape)
    _draw_joules(right, found, shape)
    arm = verbatim(found.question.arm.name)
    spring = shown(found.spring.stiffness, "N*m/rad")
    page_heading(
        figure, f"{arm}: null-space spring of {spring}, {found.outcome}", color=OUTCOME[found.outcome]
    )
    return figure


def _shape(found: NullSpace) -> Shape | None:
    """Of the loop that was replayed, else of the one that would begin to gain soonest."""
    arm, spring = found.question.arm, found.spring
    if found.loop is not None:
        reach = found.loop.reach(spring.rest)
        centre = found.loop.centre - np.asarray(spring.rest)
        return Shape(centre / reach, found.loop.cosine / reach, found.loop.sine / reach)
    if not spring.stiffness:
        return None
    return next(iter(shapes(arm, spring)), None)  # type: ignore[arg-type]  # a chain or a description


def _draw_loop(axes: Axes, found: NullSpace, shape: Shape | None) -> None:
    rest = np.asarray(found.spring.rest)
    if shape is None:
        axes.set_axis_off()
        return
    size = found.loop.reach(found.spring.rest) if found.loop is not None else _largest(found)
    swing = np.hypot(shape.cosine, shape.sine)
    first, second = sorted(np.argsort(swing)[-2:].tolist())
    joints = Loop(rest + size * shape.centre, size * shape.cosine, size * shape.sine, _ROUND).joints()
    joints = np.vstack([joints, joints[:1]])
    colour, line = (RED, "-") if found.loop is not None else (GREY, ":")
    axes.plot(joints[:, first], joints[:, second], line, color=colour)
    if found.loop is not None:
        start = _ROUND // 8
        axes.annotate(
            "",
            xy=_pair(joints[start + 4], first, second),
            xytext=_pair(joints[start], first, second),
            arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 1.4},
        )
    axes.plot(rest[first], rest[second], "+", color=BLACK, ms=9)
    axes.annotate("rest", _pair(rest, first, second), xytext=(4, 4), textcoords="offset points", fontsize=8)
    names = [verbatim(name) for name in _names(found)]
    axes.set_xlabel(f"{names[first]} [rad]")
    axes.set_ylabel(f"{names[second]} [rad]")
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.15)
    axes.locator_params(nbins=5)
    told = "the loop, replayed" if found.loop is not None else "a loop that is first to gain, if larger"
    others = [i for i in np.argsort(-np.abs(shape.centre)) if i not in (first, second)]
    away = [f"{names[i]} {number(round(size * shape.centre[i], 2))}" for i in others[:2]]
    heading(axes, f"{told}; off its rest by {', '.join(away)} rad", size=8.5)


def _pair(joints: Array, first: int, second: int) -> tuple[float, float]:
    return float(joints[first]), float(joints[second])


def _names(found: NullSpace) -> list[str]:
    arm = found.question.arm
    if isinstance(arm, DescribedArm):
        return list(arm.joint_names)
    return [f"q{i + 1}" for i in range(arm.joint_count)]


def _largest(found: NullSpace) -> float:
    """The size up to which something is known or was asked [rad]."""
    reach = 0.0 if found.loop is None else found.loop.reach(found.spring.rest)
    return max(reach, found.within or 0.0, found.covered, 5 * _FIRST)


def _draw_joules(axes: Axes, found: NullSpace, shape: Shape | None) -> None:
    most = _SPAN * _largest(found)
    least = min(_FIRST, most / 10)
    sizes = np.geomspace(least, most, _SIZES)
    axes.set_yscale("log")
    if shape is not None:
        joules = [gain(found.question.arm, found.spring, shape, float(size)) for size in sizes]
        given, lost = np.abs([one[0] for one in joules]), np.array([one[1] for one in joules])
        axes.plot(sizes, given, color=RED, label="the spring gives, slowly round")
        if lost.any():
            axes.plot(sizes, lost, "--", color=BLUE, label="Coulomb friction takes")
    if found.covered:
        axes.axvspan(least, found.covered, color=GREEN, alpha=0.15, lw=0)
        axes.axvline(found.covered, color=GREEN, lw=1.2, label=f"proved up to {found.covered:.3g} rad")
    if found.loop is not None and found.slow is not None:
        reach = found.loop.reach(found.spring.rest)
        axes.axvspan(reach, most, color=ORANGE, alpha=0.15, lw=0)
        axes.plot(
            [reach], [-found.slow.energy], "o", color=BLACK, ms=5,
            label=f"replayed: {shown(-found.slow.energy, 'J')} out at {reach:.3g} rad",
        )  # fmt: skip
    if found.within is not None:
        axes.axvline(found.within, color=GREY, lw=1.0, ls=":", label=f"asked: {found.within:.3g} rad")
    axes.set_xscale("log")
    axes.set_xlim(least, most)
    axes.xaxis.set_major_locator(FixedLocator([tick for tick in _TICKS if least <= tick <= most]))
    axes.xaxis.set_major_formatter(FormatStrFormatter("%g"))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xlabel("distance from the rest [rad]")
    axes.set_ylabel("energy of one turn [J]")
    axes.legend(loc="upper left", fontsize=7.5, frameon=True, framealpha=0.9, edgecolor="none")
    known = (found.covered, found.loop.reach(found.spring.rest) if found.loop is not None else most)
    edges = (least, max(least, known[0]), known[1], most)
    for word, (start, end) in zip(("proved", "not known", "active"), pairwise(edges), strict=True):
        if end > 1.5 * start:
            middle = float(np.sqrt(start * end))
            axes.text(
                middle, 0.02, word, ha="center", fontsize=8, color=GREY, transform=axes.get_xaxis_transform()
            )
    low, high = axes.get_ylim()
    axes.set_ylim(low, high * (high / low) ** 0.45)  # room for the legend
