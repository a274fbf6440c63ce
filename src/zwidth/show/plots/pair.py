"""A pair of arms: which dampings are enough, and how much stiffness the delay of a link leaves.

Where what is needed and what is there are far apart, an axis is logarithmic.
"""

from __future__ import annotations

from fractions import Fraction
from functools import partial
from math import pi

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from zwidth.model.pairs import Pair
from zwidth.passivity.linear.boundary import COARSER, smallest_holding
from zwidth.passivity.pairs import PairVerdict
from zwidth.passivity.pairs.criterion import spending
from zwidth.passivity.pairs.evidence import energy_in_time
from zwidth.passivity.pairs.held import HeldVerdict
from zwidth.passivity.pairs.held.verdict import HeldCriterion
from zwidth.passivity.pairs.limits import MOST_SAMPLES, largest_stiffness, samples_around
from zwidth.quantity.exact import Exact
from zwidth.show.plots.style import (
    BLUE,
    GREEN,
    GREY,
    LOOK,
    OUTCOME,
    PURPLE,
    RED,
    axis,
    drawn_in,
    heading,
    label,
    legend,
    new_figure,
    number,
    page_heading,
    quantity_text,
    with_unit,
)
from zwidth.show.plots.traces import ARMS

Array = NDArray[np.float64]

_DAMPINGS, _AGES, _MOST, _FEW = 40, 8, 24, 6
"""Points of the boundary; samples of link delay shown at least, and steps at most; a few of either."""

_FAR = 30
"""Apart by more than this an axis is logarithmic."""


@rc_context(LOOK)
def plot_pair(verdict: PairVerdict) -> Figure:
    """The plane of both dampings, the largest stiffness against the link's delay, the motion and its energy.

    Parameters
    ----------
    verdict
        What `zwidth.check` returned of a `zwidth.Pair`.
    """
    moved = verdict.witness is not None
    figure = new_figure(height=8.0 if moved else 4.2)
    grid = figure.add_gridspec(3 if moved else 1, 2, height_ratios=[2, 1, 1] if moved else [1])
    draw_pair_damping(figure.add_subplot(grid[0, 0]), verdict)
    draw_pair_link(figure.add_subplot(grid[0, 1]), verdict)
    if moved:
        draw_pair_motion(figure.add_subplot(grid[1, :]), verdict)
        draw_pair_energy(figure.add_subplot(grid[2, :]), verdict)
    page_heading(figure, f"{verdict.outcome}: {verdict.claim}", color=OUTCOME[verdict.outcome])
    return figure


def draw_pair_damping(axes: Axes, verdict: PairVerdict) -> None:
    """Damping of the follower that is enough beside that of the leader, at this stiffness and link."""
    sides = damping_boundary(verdict.pair)
    factor, unit = drawn_in("damping", verdict.pair.motion, sides[0])
    leader, follower = (factor * side for side in sides)
    here = [factor * float(side.damping) for side in verdict.pair.sides]
    shown = np.isfinite(follower)
    top, low = float(leader.max()), 0.0
    if min(here) > 0 and min(here) < top / _FAR:
        low = min(here) / 3
        axes.set(xscale="log", yscale="log")
    inside = verdict.criterion.holds and not verdict.passive
    enough = "enough damping, not friction" if inside else "enough damping"
    axes.fill_between(leader[shown], follower[shown], 1e3 * top, color=GREEN, alpha=0.16, lw=0, label=enough)
    edge = leader[shown][:1], np.full(int(shown.any()), 1e3 * top)  # left of it none is enough
    axes.plot(
        np.append(edge[0], leader[shown]), np.append(edge[1], follower[shown]), color=GREEN, gid="boundary"
    )
    axes.set(xlim=(low, top), ylim=(low, top))
    axes.set_xlabel(with_unit("damping of the leader b", unit))
    axes.set_ylabel(with_unit("damping of the follower b", unit))
    _mark(axes, verdict, here[0], here[1])
    heading(axes, "which dampings are enough")


def damping_boundary(pair: Pair) -> tuple[Array, Array]:
    """Dampings of the leader, and the least of the follower beside each; inf where none is enough."""

    def holds(leader: Fraction, follower: Fraction) -> bool:
        arms = {
            "leader": pair.leader.replace(damping=leader),
            "follower": pair.follower.replace(damping=follower),
        }
        return spending(pair.replace(**arms)).holds

    ratio = 1 / pair.power_ratio
    guess = float(pair.felt_stiffness * pair.sample_period)
    equal = smallest_holding(lambda b: holds(b, b * ratio), guess, COARSER) or guess
    found = []
    top = 1.25 * max(3 * equal, *(float(side.damping) for side in pair.sides))
    # to the left of the first no follower that is drawn is enough
    first = smallest_holding(lambda b: holds(b, Exact(top).fraction), equal, COARSER) or 0.1 * equal
    steps = np.geomspace(min(first, top / 2), top, _number(pair, _DAMPINGS))
    for step in steps:
        least = smallest_holding(partial(holds, Exact(float(step)).fraction), equal, COARSER)
        found.append(np.inf if least is None else least)
    return steps, np.array(found)


def draw_pair_link(axes: Axes, verdict: PairVerdict) -> None:
    """The largest passive stiffness against the delay of the link: it falls with every sample."""
    pair = verdict.pair
    delays, stiffness = link_limits(pair)
    which = "each way" if pair.there == pair.back else "mean of there and back"
    seconds, text = axis([float(delays[-1])], "link_delay", text=f"link delay, {which}")
    factor, unit = drawn_in("stiffness", pair.motion, [*stiffness, float(pair.felt_stiffness)])
    ends, stiffness, felt = seconds * delays, factor * stiffness, factor * float(pair.felt_stiffness)
    top, low = 1.3 * max(felt, float(stiffness.max())), 0.0
    if 0 < stiffness[stiffness > 0].min(initial=top) < top / _FAR:
        low = float(stiffness[stiffness > 0].min()) / 3
        axes.set_yscale("log")
    axes.stairs(stiffness[1:], ends, baseline=low, color=GREEN, fill=True, alpha=0.16, lw=0, label="passive")
    axes.stairs(stiffness[1:], ends, baseline=None, color=GREEN, lw=1.6, gid="stairs")
    axes.plot([0], stiffness[:1], ".", color=GREEN, clip_on=False, label="passive up to here at no delay")
    axes.set(xlim=(0, ends[-1]), ylim=(low, top))
    axes.set_xlabel(text)
    axes.set_ylabel(label("stiffness", pair.motion, unit=unit))
    _mark(axes, verdict, seconds * float(pair.there + pair.back) / 2, felt)
    heading(axes, "how stiff over what link" if stiffness.any() else "no stiffness is passive")


def link_limits(pair: Pair) -> tuple[Array, Array]:
    """Mean delays of the link up to which readings stay as old [s], and the largest passive stiffness.

    Delays there and back are in proportion as they are.
    """
    period = pair.sample_period
    ways = [value.fraction for value in pair.delay]
    ways = ways if any(ways) else [period, period]
    last = max(Fraction(2), _AGES * period / max(ways)) if any(pair.delay) else Fraction(_AGES)
    counts = [(way, int(last * way / period)) for way in ways if way]
    shares = sorted({k * period / way for way, most in counts for k in range(most + 1)} | {Fraction(1)})
    chosen = {
        0,
        len(shares) - 1,
        *np.linspace(0, len(shares) - 1, _number(pair, _MOST)).round().astype(int).tolist(),
    }
    shares = [share for k, share in enumerate(shares) if k in chosen or share == 1]
    found = [
        largest_stiffness(pair.replace(delay=(Exact(share * ways[0]), Exact(share * ways[1])))) or 0.0
        for share in shares
    ]
    mean = float(sum(ways)) / 2
    return np.array([float(share) * mean for share in shares]), np.array(found)


def _number(pair: Pair, usual: int) -> int:
    """Fewer points where readings are so old that each of them takes a second."""
    return usual if samples_around(pair) <= MOST_SAMPLES else _FEW


def _mark(axes: Axes, verdict: PairVerdict, x: float, y: float) -> None:
    marker = "o" if verdict.outcome == "passive" else "X"
    axes.plot(
        [x], [y], marker, color=OUTCOME[verdict.outcome], ms=8, clip_on=False, zorder=6, gid="pair",
        label="this pair",
    )  # fmt: skip
    legend(axes)


def draw_pair_motion(axes: Axes, verdict: PairVerdict) -> None:
    """Positions of both hands in the motion that takes energy out, each repeated part once.

    Of a verdict that is active.
    """
    found = verdict.witness
    assert found is not None
    pair = verdict.pair
    step = float(pair.sample_period) / pair.own_readings
    time, text = axis([step * len(found.positions[0])], "time")
    axes.set_xlabel(text)
    length, text = axis([float(np.ptp(path)) for path in found.positions], "position", pair.motion)
    axes.set_ylabel(text)
    for path, (name, (colour, line)) in zip(found.positions, ARMS.items(), strict=True):
        axes.plot(time * step * np.arange(len(path)), length * path, line, color=colour, label=name, gid=name)
    rounds = [
        f"samples {p.first} to {p.last}: {p.times:.6g} times" for p in found.leader.repeats if p.times > 1
    ]
    legend(axes)
    heading(axes, "; ".join(["a motion of both hands", *rounds]))


def draw_pair_energy(axes: Axes, verdict: PairVerdict) -> None:
    """What has come out of both hands' motion by each instant, every round of it: exact sums.

    Of a verdict that is active.
    """
    found = verdict.witness
    assert found is not None
    instants, energies = energy_in_time(found)
    time, text = axis([max(abs(float(v)) for v in instants)], "time", text="time t, every round")
    axes.set_xlabel(text)
    size, text = axis([max(abs(float(v)) for v in energies)], "energy", text="energy out")
    axes.set_ylabel(text)
    axes.axhline(0, color=GREY, lw=0.8)
    axes.plot(
        [time * float(t) for t in instants], [size * float(e) for e in energies], color=PURPLE, gid="energy"
    )
    heading(axes, f"{quantity_text(found.energy, 'energy')} have come out at the end")


# One arm of a pair in a known hand: what damping the other needs at each frequency, and how stiff each hand
# lets the coupling be.


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
    figure = new_figure(height=4.4 if linear else 3.2)
    if linear:
        draw_held_damping(figure.add_subplot(1, 2, 1), verdict, criterion)
    draw_held_stiffness(figure.add_subplot(1, 2 if linear else 1, 2 if linear else 1), verdict)
    page_heading(figure, f"{verdict.outcome}: {verdict.claim}", color=OUTCOME[verdict.outcome])
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
    factor, unit = drawn_in("damping", motion, [*needs, b])
    needs, b = factor * needs, factor * b
    frequencies = angles / pi * nyquist
    lacks = (needs > b).tolist()
    if any(lacks):
        axes.fill_between(frequencies, b, needs, where=lacks, color=RED, alpha=0.2, lw=0, label="b too small")
    axes.plot(frequencies, needs, color=BLUE, label=f"asked of the {free}")
    axes.axhline(b, color="black", ls="--", lw=1.4, label=f"it has {number(b)} {unit}")
    top = max(b, float(needs.max()))
    axes.set_ylim(-0.3 * top, 1.2 * top)  # what is below 0 is given back
    axes.set_xscale("log")
    axes.set_xlim(nyquist / 1000, nyquist)
    axes.set_xlabel(label("frequency"))
    axes.set_ylabel(label("damping", motion, "required damping", unit))
    legend(axes)


def draw_held_stiffness(axes: Axes, verdict: HeldVerdict) -> None:
    """With just this hand, with anything that damps as much, with a hand that does what it likes."""
    limits = {
        "just this": verdict.largest_stiffness,
        "damps as much": verdict.largest_stiffness_of_any_such_hand,
        "any": verdict.largest_stiffness_of_two_hands,
    }
    felt = float(verdict.pair.felt_stiffness)
    factor, unit = drawn_in("stiffness", verdict.pair.motion, [felt, *(v or 0.0 for v in limits.values())])
    heights = [factor * (value or 0.0) for value in limits.values()]
    axes.barh(list(limits), heights, color=[GREEN, BLUE, GREY], height=0.6)
    axes.axvline(factor * felt, color="black", ls="--", lw=1.4, label="this pair")
    axes.invert_yaxis()
    axes.set_xlabel(label("stiffness", verdict.pair.motion, "largest stiffness", unit))
    legend(axes)
    heading(axes, f"hand on the {verdict.question.held}")
