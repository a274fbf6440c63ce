"""The command `new`: the file of a device, or of what it renders, question by question."""

from __future__ import annotations

import argparse
from pathlib import Path

from zwidth.cli.asking import device, environment
from zwidth.cli.asking.questions import Asker
from zwidth.cli.asking.written import Written
from zwidth.cli.options import Once
from zwidth.cli.output import check_new, print_text, quiet_pipe, say_written
from zwidth.errors import InputError
from zwidth.model.specification.table import quoted, suggestion
from zwidth.showing import printable
from zwidth.writing import writing_whole

_KINDS = {"device": device, "environment": environment}


def configure(parser: argparse.ArgumentParser) -> None:
    """The arguments of `zwidth new`."""
    parser.usage = (
        "%(prog)s device|environment [FILE] [--device FILE] [--KEY VALUE ...] [--no-questions] [--force]"
    )
    parser.add_argument("kind", metavar="KIND", help="device or environment")
    parser.add_argument(
        "file", metavar="FILE", nargs="?", help="what to write (default: my-device.toml, my-environment.toml)"
    )
    parser.add_argument(
        "--device",
        metavar="FILE",
        action=Once,
        help="of an environment: the device that is to render it, a file or a name in the catalogue "
        f"(default: {environment.DEVICE} in this folder, where there is one)",
    )
    parser.add_argument(
        "--no-questions",
        action="store_true",
        help="ask nothing; rate and damping are needed, or unknown",
    )
    parser.add_argument("--force", action="store_true", help="replace a file that exists")
    seen: set[str] = set()
    for name, kind in _KINDS.items():
        group = parser.add_argument_group(name, "an answer in advance; unknown where it is not known")
        for question in kind.QUESTIONS:
            if question.key not in seen:  # both ask for the motion
                help_text = question.ask.partition("?")[0].replace("%", "%%")
                group.add_argument(question.option, metavar="VALUE", action=Once, help=help_text)
            seen.add(question.key)


def run(arguments: argparse.Namespace) -> int:
    """`zwidth new`: 0."""
    if arguments.kind not in _KINDS:
        raise InputError(f"there is no new {quoted(arguments.kind)}; {suggestion(arguments.kind, _KINDS)}")
    path = Path(arguments.file or f"my-{arguments.kind}.toml")
    if path.suffix != ".toml":
        raise InputError(f"the file must end in .toml, got {quoted(str(path))}")
    if arguments.device is not None and arguments.kind != "environment":
        raise InputError("--device names what renders an environment: zwidth new environment --device FILE")
    if arguments.kind == "environment":
        environment.refuse_a_device(path)
    check_new(path, arguments.force)
    every = {question.key for one in _KINDS.values() for question in one.QUESTIONS}
    given = {key: value for key, value in vars(arguments).items() if key in every and value is not None}
    ask = Asker(given, not arguments.no_questions)
    if ask.in_terminal:
        print_text('Enter where you do not know; "back" for the question before.')
    written = ask.until_done(lambda: _described(arguments, ask, path))
    with writing_whole(path) as file:
        file.write(written.text.encode())
    say_written(path)
    with quiet_pipe():
        print(printable("\n".join(written.then)))  # commands are not broken into lines
    return 0


def _described(arguments: argparse.Namespace, ask: Asker, path: Path) -> Written:
    if arguments.kind == "environment":
        return environment.described(ask, path, arguments.device)
    return device.described(ask, path)
