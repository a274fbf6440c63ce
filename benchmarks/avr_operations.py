"""What does avr-gcc make of one operation on an ATmega328P: how many cycles?

    python benchmarks/avr_operations.py

Of each operation the median and the worst over some operands, by -Os; loads and stores of the operands are
not counted.  Emulated by simavr: on every machine with the same compiler the numbers are the same.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))

from firmware.emulated.avr import AvrLaw

WHOLE16, WHOLE32, REAL = "int16_t", "int32_t", "float"
OPERANDS = (3, 100, -77, 9000, 30_000, -32_767)
SECOND = {WHOLE16: "12345", WHOLE32: "1234567", REAL: "0.0123f"}

OPERATIONS = {
    "int16 × int16 → int32": (WHOLE16, WHOLE32, "(int32_t)x * y"),
    "int16 × constant of 16 bits → int32": (WHOLE16, WHOLE32, "(int32_t)x * 8221"),
    "int32 × int16 → int32": (WHOLE32, WHOLE32, "x * (int16_t)y"),
    "int32 × int32 → int32": (WHOLE32, WHOLE32, "x * y"),
    "int32 × int32 → int64, >> 16": (WHOLE32, WHOLE32, "(int32_t)(((int64_t)x * y) >> 16)"),
    "int32 × int32 → int64, >> 32": (WHOLE32, WHOLE32, "(int32_t)(((int64_t)x * y) >> 32)"),
    "int64 + int64, >> 32": (WHOLE32, WHOLE32, "(int32_t)(((int64_t)x + y) >> 32)"),
    "int32 + int32": (WHOLE32, WHOLE32, "x + y"),
    **{f"int32 >> {n}": (WHOLE32, WHOLE32, f"x >> {n}") for n in (1, 4, 8, 12, 15, 16, 20, 24)},
    **{f"int32 << {n}": (WHOLE32, WHOLE32, f"(int32_t)((uint32_t)x << {n})") for n in (1, 4, 8, 16)},
    "int16 >> 4": (WHOLE16, WHOLE32, "x >> 4"),
    "int32 between two bounds of 32 bits": (
        WHOLE32,
        WHOLE32,
        "x > 999999 ? 999999 : x < -999999 ? -999999 : x",
    ),
    "int32 between two bounds of 16 bits": (
        WHOLE32,
        WHOLE32,
        "(int16_t)(x > 999 ? 999 : x < -999 ? -999 : x)",
    ),
    "int32, 0 where it is negative": (WHOLE32, WHOLE32, "x > 0 ? x : 0"),
    "int32 / int32": (WHOLE32, WHOLE32, "y / (x | 1)"),
    "float + float": (REAL, REAL, "x + y"),
    "float × float": (REAL, REAL, "x * y"),
    "float / float": (REAL, REAL, "x / y"),
    "float, 0 where it is negative": (REAL, REAL, "x > 0 ? x : 0"),
    "float between two bounds": (REAL, REAL, "x > 99.5f ? 99.5f : x < -99.5f ? -99.5f : x"),
    "int16 → float": (WHOLE16, REAL, "(float)x"),
    "int32 → float": (WHOLE32, REAL, "(float)x"),
    "float → int32": (REAL, WHOLE32, "(int32_t)x"),
}
"""What its operands x and y are, what it gives, and how it is written."""


def header(operand: str, result: str, expression: str) -> str:
    """A law that does one operation on what it was told at the beginning."""
    return f"""
#include <stdint.h>
#define LAW_FORCE_PER_UNIT 1
typedef {result} law_force;
typedef struct {{ volatile {operand} x, y; }} law_state;
static inline void law_init(law_state *s, int32_t counts) {{
    s->x = ({operand})counts;
    s->y = {SECOND[operand]};
}}
static inline law_force law_step(law_state *s, int32_t counts) {{
    {operand} x = s->x, y = s->y;
    (void)x, (void)y, (void)counts;
    return {expression};
}}
static inline void law_reset(law_state *s) {{ (void)s; }}
"""


def cycles(operand: str, result: str, expression: str) -> np.ndarray[tuple[int], np.dtype[np.int64]]:
    """Of one operation, operand by operand."""
    found = []
    with AvrLaw(header(operand, result, expression)) as law:
        for x in OPERANDS:
            law.init(x)
            found.append(law.run([0]).worst)
    return np.array(found)


def main() -> None:
    """Print the table."""
    argparse.ArgumentParser(description=__doc__.partition("\n")[0]).parse_args()
    print("| operation | median | worst |")
    print("|---|---:|---:|")
    for name, (operand, result, expression) in OPERATIONS.items():
        alone = "x" if operand == result else "0"
        taken = cycles(operand, result, expression) - cycles(operand, result, alone)
        print(f"| {name} | {int(np.median(taken))} | {taken.max()} |")


if __name__ == "__main__":
    main()
