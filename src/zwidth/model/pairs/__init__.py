"""Two arms that follow each other: leader and follower, and what joins them."""

from zwidth.model.pairs.pair import Pair, Side
from zwidth.model.rendering.force.friction_compensation import FrictionCompensation

__all__ = ["FrictionCompensation", "Pair", "Side"]
