"""Every option that a message, a hint or a report names is one of the command that it speaks of."""

from __future__ import annotations

import argparse
import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

import zwidth as zw
from zwidth.cli.commands import COMMANDS, configure

SOURCE = Path(zw.__file__).parent


@cache
def options_of(command: str) -> str:
    parser = argparse.ArgumentParser(add_help=False)
    configure(command, parser)
    return " ".join(f"{name} " for action in parser._actions for name in action.option_strings)


EVERY = "".join(map(options_of, COMMANDS)) + "--version --help "
OF_FILE = {own.file or name: name for name, own in COMMANDS.items()}
OPTION = re.compile(r"(?<![\w(-])--[a-z](?:[\w.-]*\w)?(?![\w-]*\{)")
CALL = re.compile(rf"zwidth ({'|'.join(COMMANDS)})\b((?:(?!zwidth |[;:,)`] |\n| && ).)*)")


def filled_in(text: ast.JoinedStr) -> str:
    return "".join(str(part.value) if isinstance(part, ast.Constant) else "{}" for part in text.values)


def texts_of(file: Path) -> Iterator[str]:
    """Every text in a source but those that explain it; what is filled in stands as {}."""
    nodes = [*ast.walk(ast.parse(file.read_text(encoding="utf-8")))]
    no_text = {id(node.value) for node in nodes if isinstance(node, ast.Expr)}
    no_text |= {id(part) for node in nodes if isinstance(node, ast.JoinedStr) for part in node.values}
    for node in nodes:
        if isinstance(node, ast.JoinedStr):
            yield filled_in(node)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in no_text:
            yield node.value


def none_such(text: str, of_file: str) -> Iterator[str]:
    """Options that the command before them has not; those before which none stands are the file's."""
    for command, rest in CALL.findall(text):
        yield from (
            f"{command} {one}" for one in OPTION.findall(rest) if not is_one(one, options_of(command))
        )
    own = of_file if " " in text else EVERY
    yield from (one for one in OPTION.findall(CALL.sub("", text)) if not is_one(one, own))


def is_one(option: str, options: str) -> bool:
    """Also --transmission, of which all are --transmission.something."""
    return re.search(rf"{re.escape(option)}[ .]", options) is not None or option in ("--help", "--version")


ROOMS = sorted({path.relative_to(SOURCE).parts[0] for path in SOURCE.rglob("*.py")})


@pytest.mark.parametrize("room", ROOMS)
def test_every_option_that_a_message_names_is_one(room):
    """Of the command that stands before it, else of that of the file, else of any; style sheets aside."""
    for file in [SOURCE / room] if room.endswith(".py") else (SOURCE / room).rglob("*.py"):
        in_cli = file.relative_to(SOURCE).parts[0] == "cli" and file.stem in OF_FILE
        of_file = options_of(OF_FILE[file.stem]) if in_cli else EVERY
        for text in texts_of(file):
            assert (
                "var(--" in text
                or "<style" in text
                or text.startswith("uv pip")
                or not [*none_such(text, of_file)]
            ), (file, text)


def test_an_option_of_another_command_is_found():
    said = "give --link-delay, see zwidth check --rate 1 --replay; or zwidth pair --replay, --nothing"
    assert [*none_such(said, EVERY)] == ["pair --replay", "--nothing"]
    assert [*none_such(said, options_of("check"))] == ["pair --replay", "--link-delay", "--nothing"]
