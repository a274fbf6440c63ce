"""A hand that drives below some frequency, as people do, and is passive above it."""

from zwidth.passivity.stability.active_hand.shaking import ShakingHand
from zwidth.passivity.stability.active_hand.tolerated import ToleratedActivity, tolerated_activity

__all__ = ["ShakingHand", "ToleratedActivity", "tolerated_activity"]
