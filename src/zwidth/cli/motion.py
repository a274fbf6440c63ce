"""A motion that takes energy out: in words, and its first samples as a row of levels."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rich.text import Text

from zwidth.cli.bars import levels
from zwidth.quantity.text import shown

if TYPE_CHECKING:
    from zwidth.passivity.storage.gain import Gain
    from zwidth.passivity.witness.witness import Witness

_SAMPLES_SHOWN = 48


def joules(witness: Witness | Gain) -> str:
    """What comes out, and what one round of a cycle gives."""
    total = shown(witness.energy, "J")
    if witness.motion.rounds > 1 and len(witness.motion.repeats) == 1:
        return f"{total} ({shown(witness.energy_per_cycle, 'J')} per cycle)"
    return total


def motion_in_short(witness: Witness | Gain) -> str:
    """How long, how deep and how fast it is."""
    return (
        f"{witness.motion.samples:.6g} samples in "
        f"{shown(witness.motion.samples * witness.sample_period, 's')}, to "
        f"{shown(witness.depth, witness.unit)} at up to {shown(witness.peak_speed, witness.unit + '/s')}"
    )


def motion_lines(witness: Witness | Gain, fancy: bool) -> Iterator[Text]:
    """The motion, line by line."""
    yield Text(motion_in_short(witness))
    for part in witness.motion.repeats:
        if part.times > 1:
            yield Text(f"samples {part.first} to {part.last} are a cycle, done {part.times:.6g} times")
    yield Text(f"extracts {joules(witness)}", style="bold")
    first = witness.positions[:_SAMPLES_SHOWN]
    more = " …" if len(witness.positions) > len(first) else ""
    yield Text(f"x(kT)  {levels(first, fancy)}{more}", style="cyan")
