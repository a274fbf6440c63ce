"""The numbers that several hands share."""

from __future__ import annotations

from zwidth.quantity.glossary import Quantity

MASS = Quantity("mass", "m_h", "kg", "kg*m^2", "of the hand, moves with the handle")
STIFFNESS = Quantity("stiffness", "k", "N/m", "N*m/rad", "of the hand, to the position that it wants")
DAMPING = Quantity("damping", "c", "N*s/m", "N*m*s/rad", "of the hand, to the position that it wants")
FORCE = Quantity("force", "F", "N", "N*m", "of the hand, positive into the wall")
START = Quantity("start", "x_0", "m", "rad", "position where the touch starts; negative is outside")
SPEED = Quantity("speed", "v", "m/s", "rad/s", "of the approach")

NO_NEGATIVE_MASS = "a body has inertia; 0 is a hand without mass"
NO_NEGATIVE_DAMPING = "a hand with negative damping gives out energy by itself; 0 loses none"
OUTSIDE = (
    "a touch starts outside the wall or at its surface, x = 0, so that what it finds there is contact; "
    "where the device starts is said by initial_position"
)
