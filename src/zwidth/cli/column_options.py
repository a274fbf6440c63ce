"""Options that say what the columns of a file hold, --column force=NAME, and messages that speak of them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from zwidth.errors import InputError
from zwidth.model.specification.table import quoted, suggestion

SHEET = "of a workbook, where several hold a recording"
"""Help of --sheet."""


def pairs_of(option: str, typed: Sequence[str] | None, quantities: Sequence[str]) -> dict[str, str]:
    """What an option that may come several times says of each quantity."""
    pairs = dict(_pair(option, text, quantities) for text in typed or ())
    if len(pairs) < len(typed or ()):
        raise InputError(f"{option} names a quantity twice; which one is meant?")
    return pairs


def _pair(option: str, typed: str, quantities: Sequence[str]) -> tuple[str, str]:
    key, sign, value = typed.partition("=")
    name = key.strip().replace("-", "_")
    if not sign or not value:
        raise InputError(f"{option} is written {option} {quantities[1]}=VALUE, got {quoted(typed)}")
    if name not in quantities:
        raise InputError(f"{option}: there is no quantity {quoted(key)}; {suggestion(name, quantities)}")
    return name, value


_PYTHON = re.compile(r"(columns|units|scale)=\{[\"'](\w+)[\"']: (?:\"([^\"]*)\"|(None|…))\}")
_NAMES = {"columns": "--column", "units": "--unit", "scale": "--scale"}


@contextmanager
def as_options() -> Iterator[None]:
    """What to try, in messages, as it is typed here."""
    try:
        yield
    except InputError as error:
        raise InputError(_PYTHON.sub(_as_option, _plain_options(sheet_option(str(error))))) from None


def sheet_option(text: str) -> str:
    """The name of a sheet, in a message, as it is typed here."""
    return re.sub(r'\bsheet=("[^"]*")', r"--sheet \1", text)


def _as_option(found: re.Match[str]) -> str:
    name, quantity, value, other = found.groups()
    value = value if value is not None else {"None": "none"}.get(other, "…")
    written = f"'{quantity}={value}'" if " " in value else f"{quantity}={value}"
    return f"{_NAMES[name]} {written}"


def _plain_options(text: str) -> str:
    text = text.replace("sample_rate or sample_period", "--rate or --sample-period")
    text = re.sub(r'\bresolution=("[^"]*")', r"--resolution \1", text)
    return re.sub(r"\bcounts_per_turn=(\d+)", r"--counts-per-turn \1", text)
