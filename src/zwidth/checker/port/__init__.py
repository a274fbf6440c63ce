"""Indices of a linear system, of one axis or several."""
