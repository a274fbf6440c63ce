"""Arithmetic of the checker: numbers within bounds, and where the roots of a polynomial lie."""
