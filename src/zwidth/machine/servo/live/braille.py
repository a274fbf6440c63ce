"""Curves as text: each character has two dots across and four down, a braille pattern of Unicode.

From above the dots are worth 1, 2, 4, 64 on the left and 8, 16, 32, 128 on the right, added to U+2800 (The
Unicode Standard, block U+2800 to U+28FF).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from zwidth.native.compiled import Array

DOTS_ACROSS, DOTS_DOWN = 2, 4

_WORTH = np.array([[1, 8], [2, 16], [4, 32], [64, 128]])
EMPTY = 0x2800

Codes = NDArray[np.int64]


def cells(low: Array, high: Array, lines: int, bottom: float, top: float) -> Codes:
    """The character codes of a curve, a row for each line of text, from above; 0x2800 where there is no dot.

    Parameters
    ----------
    low, high
        Lowest and highest of each column of dots, NaN where there is nothing.
    lines
        Lines of text.
    bottom, top
        What the lowest and the highest row of dots stand for.
    """
    down = lines * DOTS_DOWN
    low, high = _joined(low, high)
    scale = (down - 1) / (top - bottom)
    with np.errstate(invalid="ignore"):
        first = np.rint((top - high) * scale)
        last = np.rint((top - low) * scale)
        row = np.arange(down)[:, None]
        dots = (row >= first) & (row <= last)  # False where NaN
    blocks = dots.reshape(lines, DOTS_DOWN, -1, DOTS_ACROSS)
    return EMPTY + np.einsum("ldwa,da->lw", blocks, _WORTH)


def _joined(low: Array, high: Array) -> tuple[Array, Array]:
    """Each column reaches to where the one before ended, so that a steep curve has no holes."""
    before_low, before_high = np.append(np.nan, low[:-1]), np.append(np.nan, high[:-1])
    with np.errstate(invalid="ignore"):
        low = np.where(before_high < low, before_high, low)
        high = np.where(before_low > high, before_low, high)
    return low, high
