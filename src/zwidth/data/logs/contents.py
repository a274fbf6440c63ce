"""What a recording of a served loop holds: a head, then parts of rows and events, then perhaps an end.

The columns carry their unit in the name, all are float64.  A row is a sample of the loop, forces are
positive out of the wall, positions positive into it.  A recording without an end was cut off: the process
was killed, or the disk was full; what comes before is good.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from zwidth.errors import InputError
from zwidth.showing import one_line

if TYPE_CHECKING:
    from zwidth.native.compiled import Array

FORMAT = "zwidth recording 1"

ROWS_LOST = "rows lost"
"""The event that says how many rows the ring wrote over before the file had them, and where."""

COLUMNS = {"linear": ("position_m", "force_N"), "rotary": ("position_rad", "force_N_m")}
"""Of the position as read and of the force given."""

OF_A_LOOP = ("sample", "time_s", "late_s", "status", "phase", "law")
"""Of the loop itself: which sample, when, how late; the answer; what the loop was doing, by which law."""

_NUMBERS = ("origin_m", "origin_rad", "sense", "resolution_m", "resolution_rad")

_UNITS = {
    "_m_per_s": "m/s",
    "_rad_per_s": "rad/s",
    "_N_m": "N*m",
    "_rad": "rad",
    "_m": "m",
    "_N": "N",
    "_J": "J",
    "_s": "s",
}
"""By how a name ends, the longer endings first."""


@dataclass(frozen=True, kw_only=True)
class Head:
    """What is known before the first row."""

    columns: tuple[str, ...]
    motion: str
    period: float
    """T [s]."""
    title: str
    about: dict[str, Any]
    """Whatever else was told: device, environment, laws, safety, versions; as JSON has it."""

    def text(self, **more: Any) -> str:
        return as_json({"format": FORMAT, **asdict(self), **more})


def as_json(said: dict[str, Any]) -> str:
    """As JSON, numbers of numpy too; anything else in words: no recording ends for what an event holds."""
    return json.dumps(said, ensure_ascii=False, default=lambda v: v.item() if hasattr(v, "item") else str(v))


def from_json(text: str | bytes) -> dict[str, Any]:
    """A table of JSON; what is no number there, such as NaN, becomes a text."""
    try:
        found = json.loads(text, parse_constant=str)
    except RecursionError:
        raise ValueError("a table in a table in a table") from None
    if not isinstance(found, dict):
        raise ValueError("no table")
    return found


class Part(NamedTuple):
    """What was written together: rows × columns, the events since the part before; is it the end?"""

    rows: Array
    events: list[dict[str, Any]]
    last: bool = False


def head_in(text: str | bytes, source: object) -> tuple[Head, dict[str, Any]]:
    try:
        said = from_json(text)
        form = said.pop("format")
        named = {key: said.pop(key) for key in ("motion", "period", "title", "about")}
        named["title"] = one_line(str(named["title"]))
        head = Head(columns=tuple(map(str, said.pop("columns"))), **named)
    except (ValueError, KeyError, TypeError):
        raise InputError(f"{source} is no whole recording: what it says of itself cannot be read") from None
    if form != FORMAT:
        raise InputError(f"{source} is not read: it calls itself {form!r}, and this zwidth reads {FORMAT!r}")
    _check(head, source)
    return head, said


def _check(head: Head, source: object) -> None:
    """What is computed with must be what it should be: a file of others may say anything."""
    known = head.motion in COLUMNS
    good = isinstance(head.period, int | float) and 0 < head.period < 1e9 and isinstance(head.about, dict)
    names = all(name.isprintable() for name in head.columns) and len(set(head.columns)) == len(head.columns)
    if not (known and good and names):
        raise InputError(f"{source} is no recording: its motion, period or columns are not those of a loop")
    wrong = [key for key in _NUMBERS if not isinstance(head.about.get(key, 0.0), int | float)]
    if wrong:
        raise InputError(f"{source} is no whole recording: its {wrong[0]} is no number")
    missing = {*OF_A_LOOP, *COLUMNS[head.motion]} - set(head.columns)
    if missing:
        raise InputError(f"{source} is no recording of a loop: it lacks {', '.join(sorted(missing))}")


def rows_lost(events: list[dict[str, Any]]) -> int:
    counts = (event.get("rows") for event in events if event.get("event") == ROWS_LOST)
    return sum(count for count in counts if isinstance(count, int))


def name_and_unit(column: str) -> tuple[str, str]:
    """The name of a column without its unit, and the unit; "1" where it has none."""
    for ending, unit in _UNITS.items():
        if column.endswith(ending) and len(column) > len(ending):
            return column.removesuffix(ending), unit
    return column, "1"
