"""Stability with a hand that is known: device, hand and wall as one sampled linear system."""

from zwidth.stability.known_hand.coupled import Stability, coupled_stability
from zwidth.stability.known_hand.hand import HandImpedance

__all__ = ["HandImpedance", "Stability", "coupled_stability"]
