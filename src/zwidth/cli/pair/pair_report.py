"""The verdict on two arms as a report in the terminal."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rich.text import Text

from zwidth.cli.loop_lines import advice_rows, advice_section, device_line
from zwidth.cli.output import encodes
from zwidth.cli.page import (
    PICTURE,
    Row,
    below,
    blocks,
    claimed,
    grid,
    items,
    levels,
    more_with_all,
    page,
    section,
    small_print,
)
from zwidth.model.device import Device
from zwidth.model.pairs import Pair
from zwidth.passivity.pairs import PairVerdict, PairWitness
from zwidth.passivity.pairs.held import HeldVerdict, HeldWitness
from zwidth.passivity.pairs.in_short import pair_in_short
from zwidth.quantity.text import quantity_unit, shown

if TYPE_CHECKING:
    from rich.console import Console

_SAMPLES_SHOWN = 48

_NOTHING = "nothing is violated"
_ABOUT = (
    "coupling",
    *(f"on the {arm}" for arm in ("leader", "follower")),
    *(f"compensated in the {arm}" for arm in ("leader", "follower")),
)
"""Of the numbers: what a short report has."""


def print_pair(verdict: PairVerdict | HeldVerdict, in_full: bool = False) -> None:
    witness = verdict.witness if verdict.outcome == "active" else None
    with page() as out:
        out.print(claimed(verdict.outcome, verdict.claim))
        (_all if in_full else _few)(out, verdict, witness)


def _few(out: Console, verdict: PairVerdict | HeldVerdict, witness: PairWitness | HeldWitness | None) -> None:
    """What binds and what to change; the pair, and what is assumed of it."""
    rows = dict(verdict.rows())
    do: list[Row] = [*advice_rows(verdict.advice, verdict.passive, verdict.claim)]
    if rows["limit"] != _NOTHING:
        do.append(("limit", rows["limit"]))
    if witness is not None:
        do.append(("the motion", f"{_how_long(witness)} takes {shown(witness.energy, 'J')} out"))
    if not verdict.advice and "largest stiffness" in rows:
        do.append(("stiffness", f"largest: {rows['largest stiffness']}"))
    if "largest compensation" in rows:
        do.append(("compensation", f"largest: {rows['largest compensation']}"))
    pair: list[Row] = [(name, rows[name]) for name in _ABOUT if name in rows]
    blocks(out, do, (*_arms(verdict.pair), *pair, ("assumes", small_print(pair_in_short(verdict)))))
    more_with_all(out, "numbers, motion, every change, assumptions in full")


def _all(out: Console, verdict: PairVerdict | HeldVerdict, witness: PairWitness | HeldWitness | None) -> None:
    out.print(below(grid(_arms(verdict.pair))))
    out.print(below(grid(_numbers(verdict))))
    if witness is not None:
        section(out, "the motion", _motion(witness))
    title, lines = advice_section(verdict.advice, verdict.passive)
    section(out, title, lines)
    section(out, "with something else changed", items(at.text for at in verdict.stiffness_elsewhere))
    section(out, "assumes", items(verdict.small_print(), "dim"))


def _arms(pair: Pair) -> Iterator[tuple[str, str]]:
    if pair.leader == pair.follower:
        yield "both arms", device_line(pair.leader)
        return
    for role, device in (("leader", pair.leader), ("follower", pair.follower)):
        yield role, _line(role, device)


def _line(role: str, device: Device) -> str:
    """The device in a line; one that is called after its role is not called so twice."""
    return device_line(device).removeprefix(f"{role}: ")


def _numbers(verdict: PairVerdict | HeldVerdict) -> Iterator[tuple[str, str | Text]]:
    for name, text in verdict.rows():
        if name != "motion":
            yield name, Text(text, style="bold" if name == "limit" else "")


def _how_long(witness: PairWitness | HeldWitness) -> str:
    hands = "both hands" if len(witness.paths) > 1 else "one hand"
    return f"{witness.samples:.6g} samples in {shown(witness.duration, 's')}, of {hands} from rest at 0"


def _motion(witness: PairWitness | HeldWitness) -> Iterator[Text]:
    length, fancy = quantity_unit("position", witness.pair.motion), encodes(PICTURE)
    yield Text(_how_long(witness))
    for part in witness.repeats:
        yield Text(f"samples {part.first} to {part.last} are a round, done {part.times:.6g} times")
    yield Text(f"extracts {shown(witness.energy, 'J')}", style="bold")
    for role, path in witness.paths.items():
        first = [float(x) for x in path[:_SAMPLES_SHOWN]]
        more = " …" if len(path) > len(first) else ""
        far = shown(float(path.max() - path.min()), length)
        yield Text(f"{role:8}  {levels(first, fancy)}{more}  over {far}", style="cyan")
