"""What is kept of a loop whose trace is not: extremes at the samples.

deepest    max x                         peak    max |f_a|
extracted  max(−W_h), what the hand has got out at most
highest, lowest   of x over the last quarter of the samples: does it still move?
"""

from __future__ import annotations

from zwidth.compiled import Array, compiled
from zwidth.loop.kernel import R_ACTUATOR, R_HAND_WORK, R_POSITION

DEEPEST, PEAK, EXTRACTED, HIGHEST, LOWEST = range(5)
SUMMARY = 5


@compiled
def summarize(record: Array, samples: int, points: int, summary: Array) -> None:
    """Fill in the summary of one record."""
    summary[DEEPEST] = summary[EXTRACTED] = summary[HIGHEST] = -1e300
    summary[PEAK], summary[LOWEST] = 0.0, 1e300
    quarter = samples - samples // 4
    for k in range(samples + 1):
        column = k * points
        x = record[R_POSITION, column]
        summary[DEEPEST] = max(summary[DEEPEST], x)
        summary[PEAK] = max(summary[PEAK], abs(record[R_ACTUATOR, column]))
        summary[EXTRACTED] = max(summary[EXTRACTED], -record[R_HAND_WORK, column])
        if k >= quarter:
            summary[HIGHEST] = max(summary[HIGHEST], x)
            summary[LOWEST] = min(summary[LOWEST], x)
