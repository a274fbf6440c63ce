"""Two arms that follow each other: leader and follower, and what joins them."""

from zwidth.pairs.compensation import FrictionCompensation
from zwidth.pairs.pair import Pair, Side

__all__ = ["FrictionCompensation", "Pair", "Side"]
