"""The laws between the hand and what it meets: virtual coupling."""

from zwidth.rendering.virtual_coupling import VirtualCoupling

__all__ = ["VirtualCoupling"]
