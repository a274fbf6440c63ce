"""A pair of arms of which one is held by a hand that is known, or by nobody."""

from zwidth.passivity.pairs.held.evidence import HeldWitness
from zwidth.passivity.pairs.held.law import ANY, HeldPair, felt_law
from zwidth.passivity.pairs.held.verdict import HeldVerdict, check_held_pair

__all__ = ["ANY", "HeldPair", "HeldVerdict", "HeldWitness", "check_held_pair", "felt_law"]
