"""Questions to a person: answered by options, in a terminal until the answer can be used, or from a pipe.

Whoever does not know presses Enter, or writes "unknown": what then becomes of it is said, and nothing is
filled in behind anybody's back.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable, Mapping
from typing import NamedTuple, TypeVar

from zwidth.cli.output import print_text, quiet_pipe
from zwidth.errors import InputError
from zwidth.model.specification.table import COMMAND_LINE, located
from zwidth.model.specification.write import toml
from zwidth.quantity.exact import Exact, Interval, ends
from zwidth.quantity.text import shown

T = TypeVar("T")

_UNKNOWN = ("", "?", "unknown", "don't know", "dont know")


_BACK = "back"

_TRIES = 3
"""How often Enter is taken for an answer where one is needed."""


class Back(Exception):
    """The person wants the question before."""


class Question(NamedTuple):
    """One question: its key, what is asked, why, how the answer is checked, and what follows without one.

    `check` says how the answer is understood, "" where there is nothing to say.  `needed` questions must be
    answered, by "unknown" if need be; others may be passed over in silence by a script.  `enter` is what
    Enter means, where that is an answer.
    """

    key: str
    ask: str
    why: str
    check: Callable[[str], str]
    unknown: str
    needed: bool = False
    enter: str = ""

    @property
    def option(self) -> str:
        return "--" + self.key.replace("_", "-")


class Asker:
    """Asks, and remembers what was answered, and what nobody answered.

    `given`: answers of the command line, by key.
    `asks`: False where nobody is asked, and the options are all there is.
    """

    def __init__(self, given: Mapping[str, str], asks: bool) -> None:
        self._options = dict(given)
        self.in_terminal = asks and sys.stdin is not None and sys.stdin.isatty()
        self.piped = asks and not self.in_terminal and sys.stdin is not None
        self._line = 0
        self._said: list[str | None] = []
        self._begin()

    def _begin(self) -> None:
        self._given = dict(self._options)
        self._asked: list[str] = []
        self._unanswered: list[str] = []
        self._repeated = 0

    def until_done(self, ask: Callable[[], T]) -> T:
        """What `ask` makes of the answers; where a person goes back, once more with those before."""
        while True:
            try:
                return ask()
            except Back:
                self._said.pop()
                self._begin()

    def __contains__(self, key: str) -> bool:
        return key in self._given

    def __call__(self, question: Question) -> str | None:
        """The answer, checked; None where it is not known."""
        self._asked.append(question.option)
        if question.key in self._given:
            return self._checked(question, self._given.pop(question.key), COMMAND_LINE)[0]
        if self.in_terminal:
            if self._repeated == len(self._said):
                self._said.append(self._until_usable(question))
            self._repeated += 1
            return self._said[self._repeated - 1]
        if self.piped and (line := sys.stdin.readline()):
            return self._from_pipe(question, line.strip())
        if question.needed:
            self._unanswered.append(question.option)
        return None

    def sure(self, question: Question) -> str:
        """An answer without which there is no file."""
        for _ in range(_TRIES if self.in_terminal else 1):
            if (answer := self(question)) is not None:
                return answer
        raise InputError(f"{question.option} must be known, and nothing was written: {question.ask}")

    def finish(self, what: str) -> None:
        """Refuse questions that must be answered and were not, and options that nothing asked for."""
        if self._unanswered:
            raise InputError(
                f"not answered: {', '.join(self._unanswered)}; give what you know as options, such as "
                f'{self._unanswered[0]} "…", and "unknown" where you do not'
            )
        if self._given:
            names = ", ".join("--" + key.replace("_", "-") for key in self._given)
            raise InputError(
                f"{COMMAND_LINE}: {names}: nothing asks for it; {what} like this one takes "
                + ", ".join(dict.fromkeys(self._asked))
            )

    def _checked(self, question: Question, answer: str, where: str) -> tuple[str | None, str]:
        answer = answer or question.enter
        if answer.lower() in _UNKNOWN:
            return None, question.unknown
        with located(where):
            meant = question.check(answer)
        return answer, f"understood: {meant}" if meant else ""

    def _from_pipe(self, question: Question, answer: str) -> str | None:
        self._line += 1
        print_text(f"{question.ask}\n> {answer}")
        asked = question.ask.partition("?")[0]
        found, said = self._checked(question, answer, f'line {self._line} of the answers, "{asked}?"')
        if said:
            print_text(f"  {said}")
        return found

    def _until_usable(self, question: Question) -> str | None:
        print_text(f"\n{question.ask}\n  {question.why}")
        while True:
            answer = _typed()
            if answer.lower() == _BACK:
                if self._said:
                    raise Back
                print_text("  This is the first question.")
                continue
            try:
                found, said = self._checked(question, answer, "this cannot be used")
            except InputError as error:
                print_text(f"  {error}")
                continue
            if said:
                print_text(f"  {said}")
            return found


def _typed() -> str:
    try:
        with quiet_pipe():
            print("> ", end="")
        return input().strip()
    except EOFError:
        raise InputError("the answers ended; nothing was written") from None


_LIKELY = {"m": "mm", "rad": "deg"}
"""What a person means who writes a length or an angle without its unit."""


def is_bare(answer: str) -> bool:
    return not any(c.isalpha() or c in "°%" for c in answer)


def with_unit(answer: str, unit: str) -> str:
    """The answer with the unit that a bare number has, as a file should show it."""
    return f"{answer} {unit}" if is_bare(answer) and unit not in ("", "1") else answer


def need_unit(answer: str, number: Exact | Interval, unit: str, key: str) -> None:
    """Ask for the unit of a length or an angle: 1000 is hardly a kilometre, 10 hardly ten radians."""
    if unit in _LIKELY and is_bare(answer) and any(ends(number)):
        raise InputError(
            f'{key} needs its unit, got {answer[:40]}: write "{answer[:40]} {_LIKELY[unit]}", '
            f'or "{answer[:40]} {unit}" if that is meant'
        )


def understood(number: Exact | Interval, unit: str) -> str:
    """A number as it was understood, in SI; an angle in degrees too."""
    if isinstance(number, Interval):
        return shown(number, unit)
    value = float(number)
    degrees = f" ({math.degrees(value):.6g}°)" if unit == "rad" else ""
    return shown(value, unit, 6) + degrees


class Row(NamedTuple):
    """A key of the file; without a value the remark stands in its place."""

    key: str
    value: str | list[str] | None
    remark: str = ""

    def __str__(self) -> str:
        if self.value is None:
            return f"# {self.key} is not known. {self.remark}"
        remark = f"  # {self.remark}" if self.remark else ""
        return f"{self.key} = {toml(self.value)}{remark}"


class Written(NamedTuple):
    """A file, and what to say when it is there."""

    text: str
    then: list[str]


def table(name: str, head: str, rows: Iterable[Row]) -> str:
    """A table of a specification as text."""
    return "\n".join([f"# {head}", f"[{name}]", *map(str, rows), ""])
