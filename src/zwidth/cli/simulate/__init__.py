"""Commands of a touch: simulated, saved, compared."""
