"""A message about a parameter, with the name under which it was typed: `--coulomb-friction`, not a key."""

from __future__ import annotations

import re
from collections.abc import Sequence

_ALSO = {"--virtual-damping": "damping", "--active-below": "below"}
"""Options of which a message says another key; it is theirs where no option of that name was typed."""


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
