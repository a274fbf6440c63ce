"""Sweeps: the same question asked of every loop on a grid of parameters."""
