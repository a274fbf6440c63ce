"""Ports of several axes: their passivity indices, with proofs and motions (`positive_real` for one axis)."""
