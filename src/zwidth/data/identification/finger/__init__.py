"""A finger from a log: mass, damping and stiffness while it holds against a perturbation."""

from zwidth.data.identification.finger.identified import IdentifiedFinger
from zwidth.data.identification.finger.identify import identify_finger

__all__ = ["IdentifiedFinger", "identify_finger"]
