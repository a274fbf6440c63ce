"""The worst hand there is: available storage, certified; motions that gain, recomputed."""

from zwidth.passivity.worst_hand.hand import WorstHand, worst_hand
from zwidth.passivity.worst_hand.limit import Bracket, passive_limit
from zwidth.passivity.worst_hand.row_document import law_of, same_law

__all__ = ["Bracket", "WorstHand", "law_of", "passive_limit", "same_law", "worst_hand"]
