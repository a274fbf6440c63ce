"""What does a step of a law cost on an ATmega328P and on a Cortex-M4, and how fast may it be sampled?

    python benchmarks/targets.py [--samples 5000]

Every law on every target, emulated: the median and the worst step of a hand that goes in and out of the wall,
the bytes of flash and RAM that the law adds to an empty program, and the highest rate at which the worst step
takes half the period.  On the ATmega328P at 16 MHz cycles are counted, on the Cortex-M4 instructions: its
rate is that of 100 MHz and one cycle an instruction, which no chip reaches.  Wanted: a step of a wall in
fixed point in 300 cycles of the ATmega328P.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))

from firmware.baselines.read import NAMES, text, touch
from firmware.emulated import cortex
from firmware.emulated.answers import Answers
from firmware.emulated.avr import FREQUENCY, AvrLaw
from firmware.emulated.required import missing

LAWS = {name: text(name) for name in NAMES}
"""By name, the text of a header each."""

CORTEX_FREQUENCY = 100e6


def on_avr(optimized: str, header: str, counts: np.ndarray[Any, Any]) -> Answers:
    """From rest at 0."""
    with AvrLaw(header, optimized) as law:
        law.init(0)
        return law.run(counts)


def on_cortex(floats: tuple[str, ...], header: str, counts: np.ndarray[Any, Any]) -> Answers:
    """From rest at 0."""
    return cortex.run(header, counts, floats=floats)


TARGETS: dict[str, tuple[str, float, Callable[..., Answers]]] = {
    "ATmega328P, -Os": ("avr", FREQUENCY, partial(on_avr, "-Os")),
    "ATmega328P, -O2": ("avr", FREQUENCY, partial(on_avr, "-O2")),
    "Cortex-M4, soft floats": ("cortex-m4", CORTEX_FREQUENCY, partial(on_cortex, cortex.SOFT)),
    "Cortex-M4, its unit": ("cortex-m4", CORTEX_FREQUENCY, partial(on_cortex, cortex.HARD)),
}
"""What is needed, its frequency [Hz], and what runs a law there."""


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--samples", type=int, default=5000, help="how many steps of each")
    counts = touch(parser.parse_args().samples)
    print("| law | target | median | worst | flash [bytes] | RAM [bytes] | highest rate |")
    print("|---|---|---:|---:|---:|---:|---:|")
    for target, (needed, frequency, run) in TARGETS.items():
        if missing(needed):
            print(f"| | {target} | not on this machine: {', '.join(missing(needed))} | | | | |")
            continue
        unit = "cycles" if needed == "avr" else "instructions"
        for name, header in LAWS.items():
            answers = run(header, counts)
            rate = f"{'' if needed == 'avr' else '< '}{frequency / (2 * answers.worst) / 1000:.1f} kHz"
            cost = f"{answers.median} {unit} | {answers.worst}"
            print(f"| `{name}` | {target} | {cost} | {answers.flash} | {answers.ram} | {rate} |")


if __name__ == "__main__":
    main()
