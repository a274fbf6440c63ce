"""The criterion on H(z) and what decides it: positive on the circle, roots, stability, contact, delays."""
