"""Estimates of a velocity from counts."""
