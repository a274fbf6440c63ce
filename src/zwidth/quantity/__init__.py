"""What a number means: exact decimals, intervals, units and the glossary."""

from zwidth.quantity.exact import Exact, Interval
from zwidth.quantity.glossary import GLOSSARY, Quantity

__all__ = ["GLOSSARY", "Exact", "Interval", "Quantity"]
