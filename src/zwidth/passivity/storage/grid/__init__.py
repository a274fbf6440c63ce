"""Grids: where the hand may stand, what the law does there and what moves cost, in whole numbers."""
