"""The command `each`: the same question of each of several devices, a row for each."""

from __future__ import annotations

import argparse
import csv
import re
from collections import Counter
from collections.abc import Iterator, Mapping
from copy import deepcopy
from dataclasses import dataclass, field
from io import StringIO
from math import inf, isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from zwidth.cli.options import PARAMETERS, overrides
from zwidth.cli.output import print_found, targets
from zwidth.errors import InputError
from zwidth.model.specification.table import plain, quoted
from zwidth.passivity.scope import unit_key
from zwidth.passivity.verdict import Verdict
from zwidth.quantity.documented import Documented
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.spoken import angles_in, spoken
from zwidth.quantity.text import at_most, in_words, outward_decimal, shown_at_most, unit_text
from zwidth.quantity.units import parse_number
from zwidth.showing import Part, Table
from zwidth.writing import csv_cell, csv_text, writing_whole

if TYPE_CHECKING:
    from zwidth.model.specification.read import Specification
    from zwidth.model.specification.table import Table as Given

_STATUS = ("active", "undecided", "passive in contact", "passive")
"""The outcome of the worst device says the status."""

USAGE = "SOURCE SOURCE ... [--PARAMETER VALUE ...] [--measured FILE] [--json] [-o FILE] [--force]"
OPTIONS = (
    {
        "sources=SOURCE*": "devices of the catalogue, or TOML files with a [device] each; one file may have "
        "the [environment] of all of them"
    },
    "output",
    {
        "--measured FILE": "CSV with a device and a stiffness in each line: from where on it was seen to "
        "shake",
        "--json": "print the verdicts as JSON, units in the keys",
        "-o FILE": "save the table as .csv, or the verdicts with their evidence as .json, for zwidth verify",
        "--force": "replace a file that exists",
    },
    *PARAMETERS,
)


def run(arguments: argparse.Namespace) -> int:
    """`zwidth each`: the status says the outcome of the worst device."""
    from zwidth.cli.decision import exit_status
    from zwidth.passivity.check import check

    _, save = targets(None, arguments.save, arguments.force)
    if save is not None and save.suffix.lower() not in (".csv", ".json"):
        raise InputError(f"--save: the file must end in .csv or .json, got {quoted(save.name)}")
    loops = _named(_loops(arguments.sources, overrides(arguments)))
    motions = {loop.device.motion for loop in loops.values()}
    if len(motions) > 1:
        raise InputError("some of these devices turn and some slide: their stiffnesses do not compare")
    measured = {} if arguments.measured is None else read_measured(Path(arguments.measured), *motions)
    if unknown := measured.keys() - loops.keys():
        raise InputError(
            f"--measured: {quoted(min(unknown))} is none of these devices, which are {', '.join(loops)}"
        )
    verdicts = {name: check(loop.device, loop.environment, iterate=False) for name, loop in loops.items()}
    found = EachDevice(verdicts, measured)
    if save is not None and save.suffix.lower() == ".json":
        found.save(save)
    elif save is not None:
        with writing_whole(save) as file:
            file.write(found.csv().encode())
    print_found(arguments.json, found.to_json, found.report, save)
    outcomes = {verdict.outcome for verdict in verdicts.values()}
    return exit_status(next(word for word in _STATUS if word in outcomes))


def _loops(sources: list[str], typed: Mapping[str, str]) -> Iterator[Specification]:
    """A loop for each source with a device; an environment alone is that of all."""
    from zwidth.model.specification.read import built, keep_axis, merged, read_tables

    found = [read_tables([source]) for source in sources]
    shared = [tables["environment"] for tables in found if "device" not in tables]
    if len(shared) > 1:
        raise InputError(
            f"{shared[0].label} and {shared[1].label} both give an environment for all; drop one"
        )
    devices = [tables for tables in found if "device" in tables]
    if len(devices) < 2:
        raise InputError(
            f"name two devices or more, got {len(devices)}; of one device zwidth check says more"
        )
    for tables in devices:
        own: dict[str, Given] = dict(tables)
        if shared and "environment" in tables:
            raise InputError(
                f"{tables['device'].label} has an environment, and so has {shared[0].label}: drop one"
            )
        if shared:
            own["environment"] = deepcopy(shared[0])
        if angles_in(list(typed.values())):
            keep_axis(own["device"], list(typed.values()))
        yield built(*merged(own, typed))


def _named(loops: Iterator[Specification]) -> dict[str, Specification]:
    named: dict[str, Specification] = {}
    for loop in loops:
        name = plain(loop.device.name)
        if name in named:
            raise InputError(f"two devices are called {quoted(name)}: give one of them another name")
        named[name] = loop
    return named


LARGEST_FILE = 1 << 20
"""Bytes of a table of what was measured."""

_UNIT = re.compile(r"\[([^]]*)\]")
_COMMA = re.compile(r"(?<=\d),(?=\d)(?!\d{3}\b)")


@dataclass(frozen=True, repr=False)
class EachDevice(Documented):
    """What is proved of each device.

    `verdicts`: by the name of the device, all of one motion.
    `measured`: from which stiffness on it was seen to shake, where that was measured [N/m; N·m/rad].
    """

    _FORMAT: ClassVar[str] = "zwidth each 1"

    verdicts: Mapping[str, Verdict]
    measured: Mapping[str, float] = field(default_factory=dict)

    @property
    def motion(self) -> str:
        """ "linear" or "rotary"."""
        return next(iter(self.verdicts.values())).device.motion

    def largest(self, name: str) -> float | None:
        """The largest stiffness that is proved [N/m; N·m/rad]; None where none is, or the law has none."""
        return getattr(self.verdicts[name], "stiffest", None)

    def to_dict(self) -> dict[str, Any]:
        """The verdict on each, with its name and what was measured."""
        key = f"measured_{unit_key('stiffness', self.motion)}"
        devices = [
            {
                "device": name,
                **({key: self.measured[name]} if name in self.measured else {}),
                **verdict.to_dict(),
            }
            for name, verdict in self.verdicts.items()
        ]
        return {"format": self._FORMAT, "devices": devices}

    def report(self) -> Iterator[Part]:
        """On how many it is passive and up to where on all, the table, and what it rests on."""
        yield self._outcomes()
        yield from self._on_all()
        yield from self._against_the_measured()
        yield ""
        unit = unit_text(spoken(GLOSSARY["stiffness"].unit_for(self.motion))[1])
        more = (("shook from", "times"), (unit, "")) if self.measured else ((), ())
        heads = [("", "", "passive up to", *more[0]), ("", "", unit, *more[1])]
        yield Table(heads=heads, rows=list(self._rows()), lefts=2)
        yield ""
        yield from self._what_limits()
        yield from self._taken_as_nothing()
        yield "each with every value in its ranges, by the closed forms; zwidth check of one says the rest"

    def csv(self) -> str:
        """The table, units in the heads, for a spreadsheet."""
        _, unit = spoken(GLOSSARY["stiffness"].unit_for(self.motion))
        heads = ["device", "outcome", f"largest passive stiffness [{unit}]", "limit"]
        rows = [[*heads, *([f"shook from [{unit}]", "times what is proved"] if self.measured else [])]]
        for name in self.verdicts:
            more = [_plain(self._told(self.measured.get(name))), _plain(self._times(name))]
            largest = _plain(at_most(self._told(self.largest(name)), "1"))
            rows.append([*self._first(name), largest, self._limit(name), *(more if self.measured else [])])
        return csv_text(rows)

    def _outcomes(self) -> str:
        counted = Counter(verdict.outcome for verdict in self.verdicts.values())
        told = ", ".join(f"{word} on {count}" for word, count in counted.most_common())
        laws = {verdict.environment.describe(self.motion) for verdict in self.verdicts.values()}
        law = laws.pop() if len(laws) == 1 else "what each file renders"
        return f"{law}: {told} of {len(self.verdicts)} devices"

    def _on_all(self) -> Iterator[str]:
        limits = {name: self.largest(name) for name in self.verdicts}
        known = {name: limit for name, limit in limits.items() if limit}
        if len(known) < len(limits):
            return
        weakest = min(known, key=lambda name: known[name])
        if isfinite(known[weakest]):
            most = shown_at_most(known[weakest], GLOSSARY["stiffness"].unit_for(self.motion))
            yield f"passive on every one of them up to {most}, the limit of {weakest}"

    def _against_the_measured(self) -> Iterator[str]:
        times = {name: share for name in self.verdicts if (share := self._times(name)) is not None}
        if not times:
            return
        below = [name for name, share in times.items() if share < 1]
        yield f"shook from {min(times.values()):.3g} to {max(times.values()):.3g} times what is proved"
        if below:
            yield (
                f"shook below what is proved: {', '.join(below)}. A number in its file is too favourable "
                "(damping, delay), or its loop does something that the file does not say"
            )

    def _what_limits(self) -> Iterator[str]:
        for limit in dict.fromkeys(map(self._limit, self.verdicts)):
            if limit:
                yield f"{limit}: {', '.join(n for n in self.verdicts if self._limit(n) == limit)}"

    def _taken_as_nothing(self) -> Iterator[str]:
        """Numbers that a file does not give and a limit rests on."""
        for key in ("coulomb_friction", "resolution", "delay"):
            names = [name for name, verdict in self.verdicts.items() if key in verdict.scope.assumed]
            if names:
                yield f"{in_words(key)} not given, taken as 0: {', '.join(names)}"

    def _times(self, name: str) -> float | None:
        limit, seen = self.largest(name), self.measured.get(name)
        return seen / limit if seen is not None and limit and isfinite(limit) else None

    def _rows(self) -> Iterator[tuple[str, ...]]:
        for name in self.verdicts:
            more = [self._told(self.measured.get(name)), self._times(name)] if self.measured else []
            largest = self._told(self.largest(name))
            numbers = [None if largest is None else outward_decimal(largest, False), *more]
            told = ("–" if n is None else "any" if n == inf else f"{n:.4g}" for n in numbers)
            yield (*self._first(name), *told)

    def _first(self, name: str) -> tuple[str, str]:
        return name, self.verdicts[name].outcome

    def _limit(self, name: str) -> str:
        return str(getattr(self.verdicts[name], "limit", ""))

    def _told(self, stiffness: float | None) -> float | None:
        factor, _ = spoken(GLOSSARY["stiffness"].unit_for(self.motion))
        return None if stiffness is None else stiffness * factor


def _plain(number: float | None) -> str:
    return "" if number is None else f"{number:.6g}"


def read_measured(path: Path, motion: str) -> dict[str, float]:
    """From which stiffness on each device was seen to shake [N/m; N·m/rad].

    A line for each device, its name and the stiffness, with a unit or in that of the head: "stiffness [N/m]".
    """
    rows, unit = _lines(path), GLOSSARY["stiffness"].unit_for(motion)
    bracket = _UNIT.search(" ".join(rows[0][1:2]))
    found: dict[str, float] = {}
    for number, row in enumerate(rows, 1):
        if number == 1 and len(row) > 1 and not any(map(str.isdigit, row[1])):
            continue  # the head
        where = f"{plain(path.name)}, line {number}"
        if len(row) < 2:
            raise InputError(
                f'{where}: a device and a stiffness, such as "kit-1, 240 N/m"; got {quoted(",".join(row))}'
            )
        name, text = csv_cell(row[0]).strip(), row[1].strip()
        if not text:
            continue  # it did not shake, or nobody tried
        if bracket and not any(map(str.isalpha, text)):
            text += f" {bracket[1]}"
        try:
            value = float(parse_number(text, unit, "stiffness"))
        except InputError as error:
            raise InputError(f"{where}: {error}") from None
        if not 0 < value < inf:
            raise InputError(f"{where}: a stiffness at which it shook is > 0, got {quoted(text)}")
        if name in found:
            raise InputError(f"{where}: {quoted(name)} stands there twice")
        found[name] = value
    return found


def _lines(path: Path) -> list[list[str]]:
    try:
        with path.open("rb") as file:
            text = file.read(LARGEST_FILE + 1).decode("utf-8-sig")
    except OSError as error:
        raise InputError(f"{plain(str(path), 100)} cannot be read: {error.strerror}") from None
    except UnicodeDecodeError:
        raise InputError(f"{plain(str(path), 100)} is no text in UTF-8; save the table as CSV") from None
    if len(text.encode()) > LARGEST_FILE:
        raise InputError(f"{plain(str(path), 100)} is larger than a megabyte, and no table of a class is")
    separator = ";" if ";" in text.partition("\n")[0] else ","
    rows = [row for row in csv.reader(StringIO(text), delimiter=separator) if any(map(str.strip, row))]
    if separator == ";":  # a spreadsheet that writes decimal commas; 1,018 may be a thousand
        rows = [[row[0], *(_COMMA.sub(".", cell) for cell in row[1:])] for row in rows]
    if not rows:
        raise InputError(f"{plain(str(path), 100)} is empty; a line is, for example, kit-1, 240 N/m")
    return rows
