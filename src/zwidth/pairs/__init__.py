"""Two arms that follow each other: leader and follower, and what joins them."""

from zwidth.pairs.pair import Pair, Side
from zwidth.rendering.force.friction_compensation import FrictionCompensation

__all__ = ["FrictionCompensation", "Pair", "Side"]
