"""The command `zwidth`: reads the command line, runs one subcommand, returns the exit status.

Bad input ends in one message on standard error and status 2.  Anything else that
goes wrong is a mistake of this program and is not hidden.
"""

from __future__ import annotations

import argparse
import os
import re
import sys
from collections.abc import Iterator, Sequence
from glob import glob
from itertools import pairwise
from typing import NoReturn

from zwidth import __version__
from zwidth.cli.commands import COMMANDS, configure, run
from zwidth.cli.output import print_message, quiet_pipe, tolerate_encoding
from zwidth.cli.parsing import Help, as_typed, joined
from zwidth.errors import InputError
from zwidth.missing import suggestion
from zwidth.model.device.transmission import NOT_OF_IT
from zwidth.model.specification.table import plain, quoted
from zwidth.quantity.spoken import answers_as_typed

BAD_INPUT = 2
INTERRUPTED = 130
_LONGEST_MESSAGE = 1000


class Parser(argparse.ArgumentParser):
    """An argument parser whose errors are messages like all others."""

    def error(self, message: str) -> NoReturn:
        """Bad input, with where to read more."""
        raise InputError(f"{message} (see {self.prog} --help)")


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command line; its exit status, of `check` 0 passive, 1 active, 3 undecided; 2 for bad input.

    `argv`: the arguments after the program's name; by default those of the process.
    """
    tolerate_encoding()
    if argv is None and "_ARGCOMPLETE" in os.environ:  # the shell asks how its line may go on
        from zwidth.cli.start.completion import answer

        answer(_parser)
    typed = list(sys.argv[1:] if argv is None else argv)
    try:
        with answers_as_typed():
            return _run(typed)
    except InputError as error:
        said = str(error).removesuffix(f" {error.command}")
        print_message(plain(as_typed(_in_a_file(said, typed), typed), _LONGEST_MESSAGE), error.command)
        return BAD_INPUT
    except KeyboardInterrupt:
        print_message("interrupted")
        return INTERRUPTED


_EXAMPLE = re.compile(r"--([a-z-]+) '([^']*)'")


def _in_a_file(message: str, argv: Sequence[str]) -> str:
    """The message with a line of a file in the place of an example of an option that the command has not."""
    if not _EXAMPLE.search(message) or not argv or argv[0] not in COMMANDS:
        return message
    child = Parser(add_help=False)
    configure(argv[0], child)
    known = {option for action in child._actions for option in action.option_strings}

    def shown(found: re.Match[str]) -> str:
        line = f'{found[1].replace("-", "_")} = "{found[2]}" in a file'
        return found[0] if f"--{found[1]}" in known else line

    return _EXAMPLE.sub(shown, message)


def _run(argv: list[str]) -> int:
    if argv and not argv[0].startswith("-") and argv[0] not in COMMANDS:
        raise InputError(f"there is no command {quoted(argv[0])}; {suggestion(argv[0], COMMANDS)}")
    parser = _parser(argv)
    try:
        with quiet_pipe():
            typed = list(_with_files(argv, parser.get_default(_CHILD)))
            arguments, unknown = parser.parse_known_args(joined(typed))
    except SystemExit:  # --help and --version end so
        return 0
    if unknown:
        raise InputError(_unknown(unknown, parser, arguments))
    if arguments.command is None:
        with quiet_pipe():
            print(WELCOME)
        return 0
    return run(arguments.command, arguments)


def _with_files(argv: Sequence[str], child: Parser | None) -> Iterator[str]:
    """The files that there are in the place of a pattern, kit-*.toml: no shell of Windows does it."""
    valued = {o for a in child._actions if a.nargs != 0 for o in a.option_strings} if child else set()
    for before, word in pairwise(("", *argv)):
        is_pattern = set("*?") & set(word) and not word.startswith("-") and before not in valued
        yield from (is_pattern and sorted(glob(word))) or [word]


def _parser(argv: Sequence[str]) -> Parser:
    parser = Parser(
        prog="zwidth",
        description="Which virtual walls a haptic device can render without generating energy, proved.",
        formatter_class=Help,
        allow_abbrev=False,
    )
    parser.add_argument(
        "--version", action="version", version=f"zwidth {__version__}", help="print the version and leave"
    )
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", parser_class=Parser)
    for name, command in COMMANDS.items():
        child = commands.add_parser(
            name,
            help=command.meaning,
            description=command.description,
            epilog=command.epilog,
            formatter_class=Help,
            allow_abbrev=False,
            add_help=False,
        )
        if name in argv:  # the many options of the others need not be built
            configure(name, child)
            parser.set_defaults(**{_CHILD: child})
    return parser


_CHILD = "parser of the command"


def _unknown(unknown: Sequence[str], parser: argparse.ArgumentParser, arguments: argparse.Namespace) -> str:
    """What to say of arguments that no command takes."""
    option = next((u for u in unknown if u.startswith("-")), None)
    if option is None:
        return f"too many arguments: {' '.join(unknown)}; what has a blank in it stands in double quotes"
    name = option.partition("=")[0]
    child = getattr(arguments, _CHILD, parser)
    options = [o for a in child._actions for o in a.option_strings if a.help != argparse.SUPPRESS]
    underscored = name.replace("_", "-")
    if underscored in options:
        return f"there is no option {plain(name)}; did you mean {underscored}?"
    inner = underscored.removeprefix("--transmission.").replace("-", "_")
    if inner != underscored and inner in NOT_OF_IT:
        return f"there is no option {plain(name)}: {NOT_OF_IT[inner]}"
    keys = [option.lstrip("-").replace("-", "_") for option in options]
    hint = suggestion(underscored.lstrip("-").replace("-", "_"), keys, "--{}", f"see {child.prog} --help")
    return f"there is no option {plain(name)}; {hint}"


WELCOME = """\
zwidth says which virtual walls your device can render without giving energy
to the hand: with a proof, or with the motion that takes energy out.

  zwidth tour                                   the story, in a minute
  zwidth check haptic-paddle --stiffness 300    a first proof
  zwidth new device                             the file of your own device
  zwidth examples .                             sample files, put here

zwidth --help lists all commands."""
