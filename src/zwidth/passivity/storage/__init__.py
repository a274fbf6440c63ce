"""The worst hand there is: available storage, certified; motions that gain, recomputed."""

from zwidth.passivity.storage.hand import WorstHand, worst_hand
from zwidth.passivity.storage.row_document import law_of, same_law

__all__ = ["WorstHand", "law_of", "same_law", "worst_hand"]
