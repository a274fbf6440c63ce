"""Proofs and motions as plain data that can be saved, sent and checked anywhere.

Numbers are written exactly: as a decimal where one exists, otherwise as text
"p/q".  Every key of a physical quantity carries its unit.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from zwidth.passivity.linear.loop import LinearLoop
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.text import exact_text


def unit_key(name: str, motion: str = "linear") -> str:
    """The JSON key of a quantity: its name and its SI unit, `damping_N_s_per_m`."""
    return GLOSSARY[name].key_for(motion)


def loop_document(
    loop: LinearLoop,
    coulomb_friction: Fraction,
    resolution: Fraction,
    unilateral: bool,
    motion: str,
) -> dict[str, Any]:
    """The loop that a proof or a motion speaks of, exact; H(z) in descending powers of z."""
    size = max(len(loop.numerator), len(loop.denominator))
    delay = (loop.whole_delay + loop.part_delay) * loop.period
    quantities = {
        "damping": loop.damping,
        "coulomb_friction": coulomb_friction,
        "resolution": resolution,
        "sample_period": loop.period,
        "delay": delay,
    }
    return {
        **{unit_key(name, motion): exact_text(value) for name, value in quantities.items()},
        "numerator": [str(c) for c in (*loop.numerator, *[0] * (size - len(loop.numerator)))],
        "denominator": [str(c) for c in (*loop.denominator, *[0] * (size - len(loop.denominator)))],
        "unilateral": unilateral,
    }
