"""Closed forms: bounds of springs, counts and delays, and the (β, σ) plane."""
