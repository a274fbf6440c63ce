"""A bracket as a report in the terminal: the two values, the motion, what is known of every hand."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from rich.padding import Padding
from rich.table import Table

from zwidth.cli.loop_lines import GLUE, device_line, environment_line
from zwidth.cli.output import encodes
from zwidth.cli.page import (
    PICTURE,
    Row,
    below,
    blocks,
    grid,
    headline,
    items,
    more_with_all,
    motion_in_short,
    motion_lines,
    page,
    section,
    small_print,
)
from zwidth.model.specification.read import Specification
from zwidth.passivity.bracket import Bracket
from zwidth.passivity.wording import in_short
from zwidth.quantity.text import in_words, shown

if TYPE_CHECKING:
    from rich.console import Console

_DIGITS = 6


def print_bracket(bracket: Bracket, loop: Specification, in_full: bool = False) -> None:
    with page() as out:
        out.print(_headline(bracket))
        if in_full:
            _all(out, bracket, loop)
            return
        motion = [] if bracket.witness is None else [("the motion", motion_in_short(bracket.witness))]
        device, environment, hand, *_ = _loop(bracket, loop)
        assumed = ("assumes", small_print(in_short(bracket.scope, hands=False)))
        answer = [hand, *_of_every_hand(bracket), *motion, *_cut(bracket)]
        blocks(out, answer, [device, environment, assumed])
        more_with_all(out, "the motion, how long it took, assumptions in full")


def _all(out: Console, bracket: Bracket, loop: Specification) -> None:
    fancy = encodes(PICTURE)
    out.print(below(grid(_loop(bracket, loop))))
    out.print(below(_values(bracket)))
    if bracket.witness is not None:
        _, at = _ends(bracket)
        section(out, f"the motion, at {at}", motion_lines(bracket.witness, fancy))
    section(out, "assumes", items(bracket.assumptions, "dim"))


def _of_every_hand(bracket: Bracket) -> list[Row]:
    """The two values of every hand, where the bracket is about bounded ones."""
    if bracket.hand == "every hand":
        return []
    passive, active = _told(bracket, bracket.every_hand)
    return [("every hand", f"proved passive: {passive}; active: {active}")]


def _headline(bracket: Bracket) -> Padding:
    if bracket.every_value:
        return headline("NO LIMIT", "green", f"{_name(bracket)}: every value is proved passive.")
    colour = "green" if bracket.outcome == "bracketed" else "yellow"
    return headline(bracket.outcome.upper(), colour, _claim(bracket))


def _claim(bracket: Bracket) -> str:
    name, (passive, active) = _name(bracket), _ends(bracket)
    if bracket.proved_passive is None and bracket.proved_active is None:
        return f"Neither a proof nor a motion was found for any {name} that was tried."
    if bracket.proved_active is None:
        return f"{name}: {passive} is proved passive; no value was found at which a hand gains."
    if bracket.proved_passive is None:
        return f"{name}: {active} is active; no value was found that is proved passive."
    apart = f"{shown(bracket.relative_width, '%', 2)} apart".replace(" ", GLUE, 1)
    return f"{name}: {passive} is proved passive, {active} is active, {apart}."


def _loop(bracket: Bracket, loop: Specification) -> list[Row]:
    law, proved = loop.environment, bracket.proved_passive
    if getattr(law.met, "stiffness", None) == 0 and bracket.parameter == "environment.stiffness" and proved:
        law = law.around(law.met.replace(stiffness=proved))  # that of a wall of which none was given
    of, scaled = "environment", law.met.scaled(Fraction(proved or 0))
    if bracket.parameter.endswith("gain") and proved and scaled is not None:
        of, law = "proved", law.around(scaled)  # a gain is no option: these are the forces to write
    return [
        ("device", device_line(loop.device)),
        (of, environment_line(law, loop.device.motion)),
        ("hand", bracket.hand),
        ("decided", f"{bracket.evaluations} loops in {shown(bracket.seconds, 's', 3)}"),
        *_cut(bracket),
    ]


def _cut(bracket: Bracket) -> list[Row]:
    """That the time ended the search, or the room of the proof, where it did."""
    rows: list[Row] = [("beyond", bracket.beyond)] if bracket.beyond else []
    if bracket.cut_by_time:
        rows.append(("cut", "the time given was over first: a faster machine, or more, may come closer"))
    return rows


def _values(bracket: Bracket) -> Table:
    """The two values, and beside them those of every hand where the bracket is about bounded ones."""
    table = Table(box=None, padding=(0, 3, 0, 0), header_style="dim", pad_edge=False)
    table.add_column(_name(bracket), style="dim")
    bounded = bracket.hand != "every hand"
    columns = [("this hand" if bounded else "every hand", _ends(bracket))]
    if bounded:
        columns.append(("every hand", _told(bracket, bracket.every_hand)))
    for title, _ in columns:
        table.add_column(title)
    for row, side in enumerate(("proved passive", "active")):
        table.add_row(side, *(texts[row] for _, texts in columns))
    return table


def _ends(bracket: Bracket) -> tuple[str, str]:
    return _told(bracket, (bracket.proved_passive, bracket.proved_active))


def _told(bracket: Bracket, values: tuple[float | None, float | None]) -> tuple[str, str]:
    """A proved and a refuted value, each rounded to its own side."""
    proved, refuted = (
        "none known" if value is None else shown(value, bracket.unit, _DIGITS)
        for value in bracket.outward(values, _DIGITS)
    )
    return proved, refuted


def _name(bracket: Bracket) -> str:
    """The parameter as people say it; damping is the device's, virtual damping the environment's."""
    owner, _, key = bracket.parameter.partition(".")
    name = "virtual_damping" if (owner, key) == ("environment", "damping") else key
    return in_words(f"{owner} {key}" if owner == "transmission" else name)
