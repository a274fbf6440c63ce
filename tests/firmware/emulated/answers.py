"""What a law answered on some target, sample by sample."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

_REAL = {4: np.dtype(np.float32), 8: np.dtype(np.float64)}
_WHOLE = {4: np.dtype(np.int32), 8: np.dtype(np.int64)}


@dataclass(frozen=True)
class Answers:
    """Forces in the units of the law, one for each count, and what each step cost.

    `cost` is in cycles or in instructions, as the target has it; `flash` and `ram` in bytes are the
    program's with the law in it, less those of the same program with a law that does nothing.
    """

    forces: NDArray[Any]
    cost: NDArray[np.int64]
    flash: int
    ram: int

    @property
    def median(self) -> int:
        return int(np.median(self.cost))

    @property
    def worst(self) -> int:
        return int(self.cost.max())


def force_type(whole: int, size: int) -> np.dtype[Any]:
    return _WHOLE[size] if whole else _REAL[size]


def as_counts(counts: object) -> NDArray[np.int32]:
    given = np.asarray(counts)
    found = np.ascontiguousarray(given, dtype=np.int32)
    assert np.array_equal(found, given), "counts are whole numbers of 32 bits"
    return found


IDLE = """
#include <stdint.h>
typedef int32_t law_force;
typedef struct { uint8_t nothing; } law_state;
static inline void law_init(law_state *s, int32_t counts) { (void)s, (void)counts; }
static inline law_force law_step(law_state *s, int32_t counts) { (void)s; return counts; }
static inline void law_reset(law_state *s) { (void)s; }
"""
"""A law that does nothing: what is left of a program without the law's own bytes."""
