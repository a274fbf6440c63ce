"""How a command line is read: options as data, help that fits the terminal, what messages call an option."""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple, TypeAlias

from zwidth.cli.output import columns, width_of, wrapped
from zwidth.errors import InputError
from zwidth.quantity.spoken import ANGLES, note

_USAGE = re.compile(r'\[[^\]]*\]|-\S+ "[^"]*"|-\S+ [^\s\[-]\S*|\S+')
"""What of a usage line stays together: what stands in brackets, and an option with its value."""

_OPTION = re.compile(r"""--?[a-z][\w.-]* (?:'[^']*'|"[^"]*")|--?[a-z][\w.-]* [^\s-]\S*|\S+""")
"""The same of a command line."""

_ON = " \\"
"""Where it ends a line, a shell reads on in the next."""


class Help(argparse.RawDescriptionHelpFormatter):
    """The help of every command, in the columns of a report."""

    def __init__(self, prog: str) -> None:
        super().__init__(prog, width=columns())

    def _format_usage(self, usage: str | None, *rest: object) -> str:
        text = super()._format_usage(usage, *rest)  # type: ignore[arg-type]
        if usage is None:
            return text
        hanging = " " * len(f"usage: {self._prog} ")
        lines = (_filled(line, _USAGE, self._width, hanging) for line in text.strip("\n").split("\n"))
        return "\n".join("\n".join(line) for line in lines) + "\n\n"

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        """Sentences as paragraphs, whatever lines they stand in; examples that a shell can read."""
        return "\n".join(f"{indent}{line}" for line in _told(_paragraphs(text), width - len(indent)))

    def _split_lines(self, text: str, width: int) -> list[str]:
        return [*wrapped(" ".join(text.split()), width)]


def _told(paragraphs: Iterable[str], width: int) -> Iterator[str]:
    for text in paragraphs:
        yield from command_lines(text, width) if text[:9] == "  zwidth " else wrapped(text, width)


def command_lines(line: str, width: int) -> Iterator[str]:
    """A command line in lines of at most `width` columns that a shell reads as one."""
    return _filled(line, _OPTION, width, " " * 6, _ON)


def _paragraphs(text: str) -> Iterator[str]:
    """Lines that belong together in one; what is set in is a line of its own."""
    so_far = ""
    for line in text.split("\n"):
        if so_far and line and not line.startswith(" ") and not so_far.startswith(" "):
            so_far += f" {line}"
            continue
        if so_far:
            yield so_far
        so_far = line
        if not line:
            yield ""
    yield so_far


def _filled(line: str, together: re.Pattern[str], width: int, hanging: str, on: str = "") -> Iterator[str]:
    """The line in several of at most `width` columns, each but the last ended by `on`, the others set in."""
    so_far = line[: len(line) - len(line.lstrip())]
    if width_of(line) <= width:
        yield line
        return
    room, blank = width - len(on), ""
    for piece in together.findall(line):
        joined = f"{so_far}{blank}{piece}"
        if blank and width_of(joined) > room:
            yield so_far + on
            joined = hanging + piece
        so_far, blank = joined, " "
    yield so_far


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


FIRST = (
    *("mass", "damping", "coulomb_friction", "resolution", "rate", "delay", "force_limit"),
    *("type", "stiffness", "virtual_damping", "link_delay", "duration"),
    *("operator", "operator.force", "operator.speed", "connection", "connection.port", "safety.force"),
)
"""The parameters that a first question needs; the others stand under `--help all`."""


class Helping(argparse.Action):
    """`--help`: the options that a first question needs; `--help all`: every one, by subject."""

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: Any,
        option_string: str | None = None,
    ) -> None:
        """Print it and leave."""
        if values not in (None, "all"):
            raise InputError(f"after {option_string} stands all, or nothing, got {values[:40]!r}")
        rare = [] if values else [a for a in parser._actions if getattr(a, "rare", False)]
        more = sum(action.help != argparse.SUPPRESS for action in rare)
        for action in rare:
            action.help = argparse.SUPPRESS
        for group in parser._action_groups:  # its title goes with the last of its options
            if all(action.help == argparse.SUPPRESS for action in group._group_actions):
                group.description = None
        if more:
            told = f"{more} more options, by subject: {parser.prog} --help all"
            parser.epilog = "\n\n".join(filter(None, (told, parser.epilog)))
        parser.print_help()
        parser.exit()


class Parameter(NamedTuple):
    """One parameter as an option: its key, what stands for its value, its help."""

    key: str
    metavar: str
    help: str

    @property
    def option(self) -> str:
        """The option's name, `--coulomb-friction`."""
        return "--" + self.key.replace("_", "-")


Options: TypeAlias = Iterable[str | Mapping[str, str] | Callable[[], Iterable[Parameter] | Mapping[str, str]]]
"""What a command takes, in the order of its help.

A text begins a group, "title" or "title: what it is of".  A mapping has options and what each means:

    "--all"             a flag
    "--rate RATE"       a value, given once
    "--law NAMES..."    a value that may be given several times
    "-o FILE"           --save too; "-o FILE!" must be there
    "log=LOG"           what has no name of an option; LOG? may be missing, LOG* any number, LOG+ at least one
    "--rate 1/T > sample_rate"   another name in the result
    "(--rounds N)"      one that `--help all` alone names

A function makes such a mapping, or parameters, once the command is used.
"""


def add_options(parser: argparse.ArgumentParser, options: Options) -> None:
    group: Any = parser
    for part in options:
        if isinstance(part, str):
            title, _, about = part.partition(": ")
            group = parser.add_argument_group(title, about or None)
            continue
        found = part() if callable(part) else part
        if isinstance(found, Mapping):
            for words, meaning in found.items():
                _add(group, words, meaning.replace("%", "%%"))
        else:
            for own in found:
                meaning = own.help.replace("%", "%%")
                action = group.add_argument(
                    own.option, dest=dest_of(own.key), metavar=own.metavar, action=Once, help=meaning
                )
                action.rare = own.key not in FIRST


def dest_of(key: str) -> str:
    """Where the value of a parameter stands; a blank keeps it apart from every other argument."""
    return f"parameter {key}"


def _add(group: Any, words: str, meaning: str) -> None:
    rare, words = words.startswith("("), words.strip("()")
    words, _, dest = words.partition(" > ")
    name, _, metavar = words.partition(" ")
    more = {"dest": dest} if dest else {}
    if not name.startswith("-"):
        dest, _, metavar = name.partition("=")
        count = metavar[-1] if metavar[-1] in "?*+" else None
        action = group.add_argument(dest, metavar=metavar.rstrip("?*+"), nargs=count, help=meaning)
    elif not metavar:
        action = group.add_argument(name, action="store_true", help=meaning, **more)
    elif metavar.endswith("..."):
        action = group.add_argument(name, metavar=metavar[:-3], action="append", help=meaning, **more)
    else:
        names = ("-o", "--save") if name == "-o" else (name,)
        needed = {"required": True} if metavar.endswith("!") else {}
        action = group.add_argument(
            *names, metavar=metavar.rstrip("!"), action=Once, help=meaning, **more, **needed
        )
    action.rare = rare


def heed_angles(arguments: argparse.Namespace) -> None:
    """Answer in the angles that were asked for."""
    if arguments.angles is not None:
        if arguments.angles not in ANGLES:
            raise InputError(f"--angles is one of {', '.join(ANGLES)}, got {arguments.angles[:40]!r}")
        note(arguments.angles, 2)


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
        message = _in_message(message, key, option)
        other = _ALSO.get(option)
        if other is not None and f"--{other}" not in options:
            message = _in_message(message, other, option)
    return message


def _in_message(message: str, key: str, option: str) -> str:
    if "_" in key:
        return re.sub(rf"(?<![\w.-]){re.escape(key)}(?![\w-])", option, message)
    begins = rf"^((?:[^:\s]+(?: line)?: )?){re.escape(key)}(?= (?:is|must|may)\b|: )"
    return re.sub(begins, rf"\g<1>{option}", message)
