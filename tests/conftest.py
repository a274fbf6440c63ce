"""Makes the shared Hypothesis strategies importable, `from strategies import …`."""
