"""The picture of a vibration of two arms: some cycles of both, the spectrum, where the energy comes from."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from zwidth.show.plots.diagnosis import figure_of, last_cycles
from zwidth.show.plots.style import BLUE, ORANGE, label, scale

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from zwidth.data.diagnosis.pairs.energy import PairEvidence
    from zwidth.data.diagnosis.pairs.recording import PairRecording


def pair_figure(recording: PairRecording, seen: PairEvidence | None, claim: str) -> Figure:
    """Both arms over some cycles; the spectrum of the one that swings further beside the energy of a cycle.

    Raises
    ------
    InputError
        If nothing vibrates: there is nothing to draw.
    """
    further = recording.arms[0 if seen is None else seen.leading]
    return figure_of(further, seen, claim, lambda axes, seen: _cycles(axes, recording, seen))


def _cycles(axes: Axes, recording: PairRecording, seen: PairEvidence) -> None:
    part = last_cycles(seen.vibration, recording.leader.period)
    moved = [arm.position[part] for arm in recording.arms]
    factor, unit = scale(np.concatenate([x - x.mean() for x in moved]), "rad" if seen.rotary else "m")
    for x, colour, name in zip(moved, (BLUE, ORANGE), ("leader", "follower"), strict=True):
        axes.plot(recording.leader.time[part], factor * x, color=colour, label=name)
    axes.set_xlabel("time [s]")
    axes.set_ylabel(label("position", recording.leader.motion, unit=unit))
    axes.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=2, fontsize=8)
