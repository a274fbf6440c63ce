"""A finger from a log: mass, damping and stiffness while it holds against a perturbation."""

from zwidth.identification.finger.identified import IdentifiedFinger
from zwidth.identification.finger.identify import identify_finger

__all__ = ["IdentifiedFinger", "identify_finger"]
