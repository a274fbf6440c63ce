"""What was typed: a value that begins with a minus, an option twice, and what a message then calls it."""

from __future__ import annotations

import argparse
import re
from collections.abc import Sequence
from typing import Any

from zwidth.errors import InputError
from zwidth.quantity.spoken import ANGLES, note

_NEGATIVE = re.compile(r"-\s*(\d|\.\d|inf|nan|∞)", re.IGNORECASE)
_ALSO = {"--virtual-damping": "damping", "--active-below": "below"}
"""Options of which a message says another key; it is theirs where no option of that name was typed."""


class Once(argparse.Action):
    """Stores a value, and refuses a second one: the first would be ignored."""

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: Any,
        option_string: str | None = None,
    ) -> None:
        """Store the value of one option."""
        if getattr(namespace, self.dest, None) is not None:
            raise InputError(f"{option_string} is given twice; which one is meant?")
        setattr(namespace, self.dest, values)


def heed_angles(arguments: argparse.Namespace) -> None:
    """Answer in the angles that were asked for."""
    if arguments.angles is not None:
        if arguments.angles not in ANGLES:
            raise InputError(f"--angles is one of {', '.join(ANGLES)}, got {arguments.angles[:40]!r}")
        note(arguments.angles)


def joined(arguments: Sequence[str]) -> list[str]:
    """`--option -0.1` as `--option=-0.1`: a value may begin with a minus."""
    result: list[str] = []
    for argument in arguments:
        before = result[-1] if result else ""
        if _NEGATIVE.match(argument) and before.startswith("--") and before != "--" and "=" not in before:
            result[-1] = f"{before}={argument}"
        else:
            result.append(argument)
    return result


def as_typed(message: str, argv: Sequence[str]) -> str:
    """The message with the options of a command line in the place of the keys that they set.

    A key of one word is an everyday word too: it is the option only where the message begins with it.
    """
    options = [word.partition("=")[0] for word in argv if word.startswith("--")]
    for option in dict.fromkeys(options):
        key = option.removeprefix("--").replace("-", "_")
        message = _named(message, key, option)
        other = _ALSO.get(option)
        if other is not None and f"--{other}" not in options:
            message = _named(message, other, option)
    return message


def _named(message: str, key: str, option: str) -> str:
    if "_" in key:
        return re.sub(rf"(?<![\w.-]){re.escape(key)}(?![\w-])", option, message)
    begins = rf"^((?:[^:\s]+(?: line)?: )?){re.escape(key)}(?= (?:is|must|may)\b|: )"
    return re.sub(begins, rf"\g<1>{option}", message)
