"""Questions to a person: answered by options, in a terminal until the answer can be used, or from a pipe.

Whoever does not know presses Enter, or writes "unknown": what then becomes of it is said, and nothing is
filled in behind anybody's back.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from typing import NamedTuple

from zwidth.cli.output import print_text, quiet_pipe
from zwidth.errors import InputError
from zwidth.specification.table import COMMAND_LINE, located

_UNKNOWN = ("", "?", "unknown", "don't know", "dont know")


class Question(NamedTuple):
    """One question: its key, what is asked, why, how the answer is checked, and what follows without one.

    `needed` questions must be answered, by "unknown" if need be; others may be passed over in silence by a
    script.
    """

    key: str
    ask: str
    why: str
    check: Callable[[str], object]
    unknown: str
    needed: bool = False

    @property
    def option(self) -> str:
        """Its name on the command line."""
        return "--" + self.key.replace("_", "-")


class Asker:
    """Asks, and remembers what nobody answered.

    Parameters
    ----------
    given
        Answers of the command line, by key.
    asks
        False where nobody is asked, and the options are all there is.
    """

    def __init__(self, given: Mapping[str, str], asks: bool) -> None:
        self._given = dict(given)
        self._asks = asks
        self.in_terminal = asks and sys.stdin is not None and sys.stdin.isatty()
        self._line = 0
        self._unanswered: list[str] = []

    def __contains__(self, key: str) -> bool:
        return key in self._given

    def __call__(self, question: Question) -> str | None:
        """The answer, checked; None where it is not known.

        Raises
        ------
        InputError
            If an answer that is no dialogue cannot be used.
        """
        if question.key in self._given:
            return self._checked(question, self._given.pop(question.key), COMMAND_LINE)
        if self.in_terminal:
            return self._until_usable(question)
        if self._asks and (line := sys.stdin.readline() if sys.stdin is not None else ""):
            self._line += 1
            return self._checked(question, line.strip(), f"line {self._line} of the answers")
        if question.needed:
            self._unanswered.append(question.option)
        return None

    def finish(self, what: str) -> None:
        """Refuse options that nothing asked for, and questions that must be answered and were not."""
        if self._given:
            names = ", ".join("--" + key.replace("_", "-") for key in self._given)
            raise InputError(
                f"{COMMAND_LINE}: {names}: {what} like this one has no such thing, or has it already"
            )
        if self._unanswered:
            raise InputError(
                f"not answered: {', '.join(self._unanswered)}; give what you know as options, such as "
                f'{self._unanswered[0]} "…", and "unknown" where you do not'
            )

    def _checked(self, question: Question, answer: str, where: str) -> str | None:
        if answer.lower() in _UNKNOWN:
            return None
        with located(where):
            question.check(answer)
        return answer

    def _until_usable(self, question: Question) -> str | None:
        print_text(f"\n{question.ask}\n  {question.why}")
        while True:
            answer = _typed()
            try:
                found = self._checked(question, answer, "this cannot be used")
            except InputError as error:
                print_text(f"  {error}")
                continue
            if found is None:
                print_text(f"  {question.unknown}")
            return found


def _typed() -> str:
    try:
        with quiet_pipe():
            print("> ", end="")
        return input().strip()
    except EOFError:
        raise InputError("the answers ended; nothing was written") from None
