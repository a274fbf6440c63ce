"""Rendering laws on one bench: the same touches, the same adversary, the same scores."""

from zwidth.bench.bench import LawComparison, compare
from zwidth.bench.laws import standard_laws

__all__ = ["LawComparison", "compare", "standard_laws"]
