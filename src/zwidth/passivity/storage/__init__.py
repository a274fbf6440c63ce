"""Available storage: the most a hand can take out of a loop, certified; motions that gain, recomputed."""

from zwidth.passivity.storage.chain_document import law_of, same_law
from zwidth.passivity.storage.solution import AvailableStorage, available_storage

__all__ = ["AvailableStorage", "available_storage", "law_of", "same_law"]
