"""A device from a log: mass, damping, Coulomb friction, and how well they are known."""
