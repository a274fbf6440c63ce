"""The picture of a vibration of two arms: some cycles of both, the spectrum, where the energy comes from."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure

from zwidth.diagnosis.picture import draw_energy, draw_spectrum, last_cycles
from zwidth.errors import InputError
from zwidth.plots.style import BLUE, LOOK, ORANGE, label, new_figure, page_heading, scale

if TYPE_CHECKING:
    from zwidth.diagnosis.pairs.energy import PairEvidence
    from zwidth.diagnosis.pairs.recording import PairRecording


@rc_context(LOOK)
def pair_figure(recording: PairRecording, seen: PairEvidence | None, claim: str) -> Figure:
    """Both arms over some cycles; the spectrum of the one that swings further beside the energy of a cycle.

    Raises
    ------
    InputError
        If nothing vibrates: there is nothing to draw.
    """
    if seen is None:
        raise InputError("nothing vibrates in this recording, so there is no picture of a vibration")
    figure = new_figure(9.0, 6.6)
    grid = figure.add_gridspec(2, 2, height_ratios=(1.1, 1.0))
    axes = figure.add_subplot(grid[0, :])
    part = last_cycles(seen.vibration, recording.leader.period)
    moved = [arm.position[part] for arm in recording.arms]
    factor, unit = scale(np.concatenate([x - x.mean() for x in moved]), "rad" if seen.rotary else "m")
    for x, colour, name in zip(moved, (BLUE, ORANGE), ("leader", "follower"), strict=True):
        axes.plot(recording.leader.time[part], factor * x, color=colour, label=name)
    axes.set_xlabel("time [s]")
    axes.set_ylabel(label("position", recording.leader.motion, unit=unit))
    axes.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=2, fontsize=8)
    draw_spectrum(figure.add_subplot(grid[1, 0]), recording.arms[seen.leading], seen)
    draw_energy(figure.add_subplot(grid[1, 1]), seen)
    page_heading(figure, claim)
    return figure
