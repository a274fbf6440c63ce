"""The motion that takes energy out, step by step: where the hand is, what pushes it, what it has gained."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

from zwidth.passivity.pairs.evidence import PairWitness
from zwidth.passivity.storage.gain import Gain, settled_round
from zwidth.passivity.witness.witness import Witness
from zwidth.quantity.glossary import GLOSSARY
from zwidth.showing import Part, Table

_STEPS = 12
"""Instants that are listed."""


class _Steps(NamedTuple):
    """At each instant time [s], position and energy; the force that is held from there on."""

    times: Sequence[float]
    positions: Sequence[float]
    forces: Sequence[float]
    energies: Sequence[float]
    motion: str


def first_steps(found: Any) -> Iterator[Part]:
    """The motion in a sentence, and its first steps as a table."""
    yield f"{found.describe()}."
    if isinstance(found, Witness):
        yield _table(_of_a_witness(found))
    elif isinstance(found, Gain):
        yield "One round of it, once the law does the same in each:"
        yield _table(_of_a_gain(found))
    elif isinstance(found, PairWitness):
        yield _of_both_arms(found)


def _of_both_arms(found: PairWitness) -> Table:
    """Where both are at the first samples."""
    from zwidth.show.plots.style import number, scale

    listed = [[float(x) for x in positions[:_STEPS]] for positions in found.positions]
    factor, unit = scale([x for positions in listed for x in positions], found.pair.leader.unit("position"))
    rows = [(str(k), *(number(factor * x) for x in both)) for k, both in enumerate(zip(*listed, strict=True))]
    return Table(heads=[("sample", "leader", "follower"), ("", unit, unit)], rows=rows, lefts=0)


def _of_a_witness(found: Witness) -> _Steps:
    from zwidth.show.plots.replay import replay  # the pictures play it too

    played = replay(found)
    return _Steps(played.times, played.positions, played.forces, played.energies, found.setting.motion)


def _of_a_gain(found: Gain) -> _Steps:
    once = settled_round(found)
    times = [found.sample_period * t for t in once.times]
    motion = "rotary" if found.unit == "rad" else "linear"
    return _Steps(times, once.positions, once.forces, once.energies, motion)


def _table(steps: _Steps) -> Table:
    from zwidth.show.plots.style import number, scale

    units = ("s", *(GLOSSARY[name].unit_for(steps.motion) for name in ("position", "force")), "J")
    begin = next((max(0, k - 1) for k, force in enumerate(steps.forces) if force), 0)
    columns = []
    for values, unit in zip(steps[:4], units, strict=True):
        listed = values[begin : begin + _STEPS]
        factor, name = scale(listed, unit)
        columns.append((name, [number(factor * value) for value in listed]))
    many = len(steps.times) > begin + _STEPS
    heads = [
        ("time", "position", "force from then on", "energy out so far"),
        tuple(name for name, _ in columns),
    ]
    texts = [texts for _, texts in columns]
    texts[2] += [""] * (len(texts[0]) - len(texts[2]))
    rows = [tuple(row) for row in zip(*texts, strict=True)]
    caption = "from the first force on" if begin else ""
    return Table(heads=heads, rows=[*rows, ("…",) * 4] if many else rows, lefts=0, caption=caption)
