"""The motion of both hands that takes energy out of a pair, and what has come out of it by and by."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from zwidth.passivity.pairs import PairVerdict
from zwidth.passivity.pairs.evidence import energy_in_time
from zwidth.quantity.text import quantity_unit
from zwidth.show.plots.style import BLUE, GREY, PURPLE, RED, heading, number, scale


def draw_pair_motion(axes: Axes, verdict: PairVerdict) -> None:
    """Positions of both hands in the motion that takes energy out, each repeated part once.

    Parameters
    ----------
    axes
        Where to draw.
    verdict
        What `zwidth.check` returned of a `zwidth.Pair` that is active.
    """
    found = verdict.witness
    assert found is not None
    pair = verdict.pair
    step = float(pair.sample_period) / pair.own_readings
    time, unit = scale([step * len(found.positions[0])], "s")
    length, far = scale(
        [float(np.ptp(path)) for path in found.positions], quantity_unit("position", pair.motion)
    )
    for path, name, colour, line in zip(
        found.positions, ("leader", "follower"), (BLUE, RED), ("-", "--"), strict=True
    ):
        axes.plot(time * step * np.arange(len(path)), length * path, line, color=colour, label=name, gid=name)
    rounds = [
        f"samples {p.first} to {p.last}: {p.times:.6g} times" for p in found.leader.repeats if p.times > 1
    ]
    heading(axes, "; ".join(["a motion of both hands", *rounds]), color=GREY)
    axes.set_xlabel(f"time [{unit}]")
    axes.set_ylabel(f"position [{far}]")
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))


def draw_pair_energy(axes: Axes, verdict: PairVerdict) -> None:
    """What has come out of both hands' motion by each instant, every round of it: exact sums.

    Parameters
    ----------
    axes
        Where to draw.
    verdict
        What `zwidth.check` returned of a `zwidth.Pair` that is active.
    """
    found = verdict.witness
    assert found is not None
    instants, energies = energy_in_time(found)
    (time, unit), (size, joule) = (
        scale([max(abs(float(v)) for v in values)], name)
        for values, name in ((instants, "s"), (energies, "J"))
    )
    axes.axhline(0, color=GREY, lw=0.8)
    axes.plot(
        [time * float(t) for t in instants], [size * float(e) for e in energies], color=PURPLE, gid="energy"
    )
    heading(axes, f"{number(size * found.energy)} {joule} have come out at the end", color=GREY)
    axes.set_xlabel(f"time, every round [{unit}]")
    axes.set_ylabel(f"energy out [{joule}]")
