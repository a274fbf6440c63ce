"""A second decision about accepted documents, by other roads than the checker's and the prover's."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ..opinion import Opinion, cannot_say, first
from . import (
    arms,
    boards,
    closed,
    hands,
    held_pairs,
    loops,
    mixes,
    motions,
    null_space,
    pair_motions,
    pairs,
    ports,
)

Judge = Callable[[dict[str, Any], np.random.Generator], Opinion]

JUDGES: dict[str, Judge] = {
    **loops.JUDGES,
    **closed.JUDGES,
    **motions.JUDGES,
    **boards.JUDGES,
    **hands.JUDGES,
    **ports.JUDGES,
    **arms.JUDGES,
    **null_space.JUDGES,
    **pairs.JUDGES,
    **pair_motions.JUDGES,
    **held_pairs.JUDGES,
}


def judge(document: dict[str, Any], rng: np.random.Generator, reason: str = "") -> Opinion:
    """The opinion of the judge of its kind; of corners that of each, and of mixes if they are claimed."""
    kind = document["kind"]
    if kind == "corners":
        corners = document["corners"]
        return first(*(judge(corner, rng) for corner in corners), mixes.between(corners, rng, reason))
    found = JUDGES.get(kind)
    return found(document, rng) if found else cannot_say("no judge of this kind")
