"""Stability with a hand that is known: device, hand and wall as one sampled linear system."""

from zwidth.model.operator.hand_impedance import HandImpedance
from zwidth.passivity.stability.known_hand.coupled import Stability, coupled_stability

__all__ = ["HandImpedance", "Stability", "coupled_stability"]
