"""Stability with a hand that is known: device, hand and wall as one sampled linear system."""

from zwidth.coupled_stability.known_hand.hand import PassiveHand
from zwidth.coupled_stability.known_hand.stability import Stability, stability

__all__ = ["PassiveHand", "Stability", "stability"]
