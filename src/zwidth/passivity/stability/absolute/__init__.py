"""One-sided walls against a known hand: slopes proved by absolute stability, refuted by periodic motions."""

from zwidth.passivity.stability.absolute.motion import (
    PeriodicMotion,
    describing_guess,
    periodic_motion,
    replay_motion,
    smallest_motion,
)
from zwidth.passivity.stability.absolute.plant import Plant, given_plant, touched_plant
from zwidth.passivity.stability.absolute.result import AbsoluteStability, Proved, absolute_stability

__all__ = [
    "AbsoluteStability",
    "PeriodicMotion",
    "Plant",
    "Proved",
    "absolute_stability",
    "describing_guess",
    "given_plant",
    "periodic_motion",
    "replay_motion",
    "smallest_motion",
    "touched_plant",
]
