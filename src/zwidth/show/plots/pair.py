"""A pair of arms: which dampings are enough, and how much stiffness the delay of a link leaves.

Where what is needed and what is there are far apart, an axis is logarithmic.
"""

from __future__ import annotations

from fractions import Fraction
from functools import partial

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from zwidth.model.pairs import Pair
from zwidth.passivity.linear.boundary import COARSER, smallest_holding
from zwidth.passivity.pairs import PairVerdict
from zwidth.passivity.pairs.criterion import spending
from zwidth.passivity.pairs.limits import MOST_SAMPLES, largest_stiffness, samples_around
from zwidth.quantity.exact import Exact
from zwidth.quantity.text import quantity_unit
from zwidth.show.plots.pair_motion import draw_pair_energy, draw_pair_motion
from zwidth.show.plots.style import GREEN, LOOK, OUTCOME, new_figure, page_heading, scale

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
    figure = new_figure(7.2, 6.8 if moved else 3.7)
    grid = figure.add_gridspec(3 if moved else 1, 2, height_ratios=[2.2, 1, 1] if moved else [1])
    draw_pair_damping(figure.add_subplot(grid[0, 0]), verdict)
    draw_pair_link(figure.add_subplot(grid[0, 1]), verdict)
    if moved:
        draw_pair_motion(figure.add_subplot(grid[1, :]), verdict)
        draw_pair_energy(figure.add_subplot(grid[2, :]), verdict)
    page_heading(figure, f"{verdict.outcome}: {verdict.claim}", 10, OUTCOME[verdict.outcome])
    return figure


def draw_pair_damping(axes: Axes, verdict: PairVerdict) -> None:
    """Damping of the follower that is enough beside that of the leader, at this stiffness and link.

    Parameters
    ----------
    axes
        Where to draw.
    verdict
        What `zwidth.check` returned of a `zwidth.Pair`.
    """
    leader, follower = damping_boundary(verdict.pair)
    here = [float(side.damping) for side in verdict.pair.sides]
    unit = quantity_unit("damping", verdict.pair.motion)
    shown = np.isfinite(follower)
    top, low = float(leader.max()), 0.0
    if min(here) > 0 and min(here) < top / _FAR:
        low = min(here) / 3
        axes.set(xscale="log", yscale="log")
    axes.fill_between(leader[shown], follower[shown], 1e3 * top, color=GREEN, alpha=0.16, lw=0)
    edge = leader[shown][:1], np.full(int(shown.any()), 1e3 * top)  # left of it none is enough
    axes.plot(
        np.append(edge[0], leader[shown]), np.append(edge[1], follower[shown]), color=GREEN, gid="boundary"
    )
    axes.set(xlim=(low, top), ylim=(low, top))
    axes.set_xlabel(f"damping of the leader [{unit}]")
    axes.set_ylabel(f"damping of the follower [{unit}]")
    inside = verdict.criterion.holds and not verdict.passive
    axes.set_title("shaded: enough damping, not friction" if inside else "shaded: enough damping")
    _mark(axes, verdict, here[0], here[1])


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
    """The largest passive stiffness against the delay of the link: it falls with every sample.

    Parameters
    ----------
    axes
        Where to draw.
    verdict
        What `zwidth.check` returned of a `zwidth.Pair`.
    """
    pair = verdict.pair
    delays, stiffness = link_limits(pair)
    seconds, unit = scale([float(delays[-1])], "s")
    ends = seconds * delays
    top, low = 1.3 * max(float(pair.felt_stiffness), float(stiffness.max())), 0.0
    if 0 < stiffness[stiffness > 0].min(initial=top) < top / _FAR:
        low = float(stiffness[stiffness > 0].min()) / 3
        axes.set_yscale("log")
    axes.stairs(stiffness[1:], ends, baseline=low, color=GREEN, fill=True, alpha=0.16, lw=0)
    axes.stairs(stiffness[1:], ends, baseline=None, color=GREEN, lw=1.6, gid="stairs")
    axes.plot([0], stiffness[:1], ".", color=GREEN, clip_on=False)
    axes.set(xlim=(0, ends[-1]), ylim=(low, top))
    which = "each way" if pair.there == pair.back else "mean of there and back"
    axes.set_xlabel(f"link delay, {which} [{unit}]")
    axes.set_ylabel(f"stiffness [{quantity_unit('stiffness', pair.motion)}]")
    axes.set_title("shaded: passive" if stiffness.any() else "none is passive")
    _mark(axes, verdict, seconds * float(pair.there + pair.back) / 2, float(pair.felt_stiffness))


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
    axes.plot([x], [y], marker, color=OUTCOME[verdict.outcome], ms=8, clip_on=False, zorder=6, gid="pair")
