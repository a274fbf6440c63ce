"""A pair of arms of which one is held by a hand that is known, or by nobody."""

from zwidth.passivity.pairs.held.law import HeldPair
from zwidth.passivity.pairs.held.verdict import ANY, HeldVerdict, check_held_pair
from zwidth.passivity.pairs.held.wave import HeldWitness

__all__ = ["ANY", "HeldPair", "HeldVerdict", "HeldWitness", "check_held_pair"]
