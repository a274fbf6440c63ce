"""What does a step of an emitted law cost on an ATmega328P and a Cortex-M4, and how fast may it be sampled?

    python benchmarks/targets.py [--samples 1500] [--by-hand]

Each law on each chip, emulated: the median and the worst step of a hand that goes in and out of the wall, the
bytes of flash and RAM that the law adds to an empty program, and the highest rate at which the worst step
takes half the period; beside it the rate for which the law is proved.  On the ATmega328P at 16 MHz cycles are
counted, on the Cortex-M4 instructions: its rate is that of 100 MHz and one cycle an instruction, which no
chip reaches.  Wanted: a step of a damped wall in fixed point in 300 cycles of the ATmega328P.  With --by-hand
also laws that a person would write.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))

from firmware.baselines.read import NAMES, text, touch
from firmware.chip_laws import DEVICE, LAWS, emitted
from firmware.emulated import cortex
from firmware.emulated.answers import Answers
from firmware.emulated.avr import FREQUENCY, AvrLaw
from firmware.emulated.required import missing

from zwidth.errors import InputError

Row = tuple[str, ...]

HEAD = (
    "law",
    "numbers",
    "median",
    "worst",
    "flash [bytes]",
    "RAM [bytes]",
    "rate at which it fits",
    "proved at",
)

CORTEX_FREQUENCY = 100e6

FARTHEST = 2600
"""Counts: the travel of `chip_laws`, nearly."""


def on_avr(header: str, counts: np.ndarray[Any, Any]) -> Answers:
    """From rest at 0, compiled as Arduino compiles a sketch."""
    with AvrLaw(header, "-Os", sketch=True) as law:
        law.init(0)
        return law.run(counts)


def on_cortex(floats: tuple[str, ...], header: str, counts: np.ndarray[Any, Any]) -> Answers:
    """From rest at 0."""
    return cortex.run(header, counts, floats=floats)


TARGETS: dict[str, tuple[str, float, tuple[str, ...], Callable[..., Answers]]] = {
    "ATmega328P at 16 MHz, cycles": ("avr", FREQUENCY, ("fixed", "float"), on_avr),
    "Cortex-M4, instructions, its unit for floats": (
        "cortex-m4",
        CORTEX_FREQUENCY,
        ("fixed", "float", "double"),
        partial(on_cortex, cortex.HARD),
    ),
    "Cortex-M4, instructions, floats by the library": (
        "cortex-m4",
        CORTEX_FREQUENCY,
        ("float",),
        partial(on_cortex, cortex.SOFT),
    ),
}
"""What is needed, its frequency [Hz], the numbers that are tried, and what runs a law there."""


def rows(target: str, samples: int, by_hand: bool = False) -> Iterator[Row]:
    """The table of a target, row by row.

    Parameters
    ----------
    target
        One of `TARGETS`.
    samples
        How many steps of each.
    by_hand
        True for the laws that a person would write, too.
    """
    _, frequency, numbers, run = TARGETS[target]
    counts = touch(samples, FARTHEST)
    for name in LAWS:
        for number in numbers:
            try:
                found = emitted(name, number)
            except InputError:
                yield (name, number, "not written in these numbers", "", "", "", "", "")
                continue
            proved = (
                f"{float(1 / DEVICE.sample_period):g} Hz" if found.judged.proved else found.judged.outcome
            )
            yield (name, number, *_cost(run(found.text, counts), frequency), proved)
    for name in NAMES if by_hand else ():
        yield (f"`{name}`", "by hand", *_cost(run(text(name), counts), frequency), "")


def _cost(answers: Answers, frequency: float) -> Row:
    rate = f"{'< ' if frequency == CORTEX_FREQUENCY else ''}{frequency / (2 * answers.worst) / 1000:.1f} kHz"
    return (str(answers.median), str(answers.worst), str(answers.flash), str(answers.ram), rate)


def lacks(target: str) -> tuple[str, ...]:
    """What this machine lacks for it."""
    return missing(TARGETS[target][0])


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--samples", type=int, default=1500, help="how many steps of each")
    parser.add_argument("--by-hand", action="store_true", help="laws that a person would write, too")
    asked = parser.parse_args()
    for target in TARGETS:
        print(f"\n{target}\n")
        if lacks(target):
            print(f"not on this machine: {', '.join(lacks(target))}")
            continue
        print("| " + " | ".join(HEAD) + " |\n" + "|---" * 2 + "|---:" * 6 + "|")
        for row in rows(target, asked.samples, asked.by_hand):
            print("| " + " | ".join(row) + " |")


if __name__ == "__main__":
    main()
