"""One arm of a pair in a known hand: what damping the other needs at each frequency, and how stiff each hand
lets the coupling be.
"""

from __future__ import annotations

from fractions import Fraction
from math import pi

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from zwidth.passivity.pairs.held import HeldVerdict
from zwidth.passivity.pairs.held.verdict import HeldCriterion
from zwidth.quantity.text import quantity_unit
from zwidth.show.plots.style import (
    BLUE,
    GREEN,
    GREY,
    LOOK,
    OUTCOME,
    RED,
    label,
    new_figure,
    number,
    page_heading,
)

_POINTS = 400


@rc_context(LOOK)
def plot_held_pair(verdict: HeldVerdict) -> Figure:
    """The damping that is asked of the free arm, where a law is felt; and the three largest stiffnesses.

    Parameters
    ----------
    verdict
        What `zwidth.check` returned of a `zwidth.Pair` with a known hand on one arm.
    """
    criterion = HeldCriterion(verdict.question)
    linear = not criterion.bends
    figure = new_figure(7.2 if linear else 4.2, 3.4)
    if linear:
        draw_held_damping(figure.add_subplot(1, 2, 1), verdict, criterion)
    draw_held_stiffness(figure.add_subplot(1, 2 if linear else 1, 2 if linear else 1), verdict)
    page_heading(figure, f"{verdict.outcome}: {verdict.limit}", 10, OUTCOME[verdict.outcome])
    return figure


def draw_held_damping(axes: Axes, verdict: HeldVerdict, criterion: HeldCriterion) -> None:
    """At each frequency, of the hand that asks for most; and what the free arm has."""
    motion, free = verdict.pair.motion, verdict.question.free
    nyquist = 0.5 / float(verdict.pair.sample_period)
    angles = np.geomspace(pi / 1000, pi, _POINTS)
    needs = np.max(
        [
            [law.required_damping_at(Fraction(float(np.cos(angle)))) for angle in angles]
            for _, law, _ in criterion.corners
        ],
        axis=0,
    )
    b = float(verdict.question.arms[0].side.damping)
    frequencies = angles / pi * nyquist
    axes.fill_between(frequencies, b, needs, where=(needs > b).tolist(), color=RED, alpha=0.2, lw=0)
    axes.plot(frequencies, needs, color=BLUE, label=f"asked of the {free}")
    axes.axhline(
        b, color="black", ls="--", lw=1.4, label=f"it has {number(b)} {quantity_unit('damping', motion)}"
    )
    top = max(b, float(needs.max()))
    axes.set_ylim(-0.3 * top, 1.2 * top)  # what is below 0 is given back
    axes.set_xscale("log")
    axes.set_xlim(nyquist / 1000, nyquist)
    axes.set_xlabel(label("frequency"))
    axes.set_ylabel(label("damping", motion, "required damping"))
    axes.legend(loc="best")


def draw_held_stiffness(axes: Axes, verdict: HeldVerdict) -> None:
    """With just this hand, with anything that damps as much, with a hand that does what it likes."""
    limits = {
        "just this": verdict.largest_stiffness,
        "damps as much": verdict.largest_stiffness_of_any_such_hand,
        "any": verdict.largest_stiffness_of_two_hands,
    }
    heights = [value or 0.0 for value in limits.values()]
    axes.barh(list(limits), heights, color=[GREEN, BLUE, GREY], height=0.6)
    axes.axvline(float(verdict.pair.felt_stiffness), color="black", ls="--", lw=1.4)
    axes.invert_yaxis()
    axes.set_xlabel(label("stiffness", verdict.pair.motion, "largest stiffness; dashed: this pair,"))
    axes.set_title(f"hand on the {verdict.question.held}")
