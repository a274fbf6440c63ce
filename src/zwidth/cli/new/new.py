"""The command `new`: the file of a device, or of what it renders, question by question."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path

from zwidth.cli.new import device, environment
from zwidth.cli.new.questions import Asker, Written
from zwidth.cli.output import print_text, quiet_pipe, say_written
from zwidth.errors import InputError
from zwidth.missing import suggestion
from zwidth.model.specification.table import quoted
from zwidth.showing import printable
from zwidth.writing import check_target, writing_whole

_KINDS = {"device": device, "environment": environment}


def _answers(name: str) -> Callable[[], dict[str, str]]:
    """The answers in advance that a kind takes; the motion, which both ask for, is of the first."""

    def options() -> dict[str, str]:
        before = set() if name == "device" else {question.key for question in device.QUESTIONS}
        found: dict[str, str] = {}
        for question in _KINDS[name].QUESTIONS:
            if question.key not in before:
                found.setdefault(f"{question.option} VALUE", question.ask.partition("?")[0])
        return found

    return options


USAGE = "device|environment [FILE] [--device FILE] [--KEY VALUE ...] [--no-questions] [--force]"
OPTIONS = (
    {
        "kind=KIND": "device or environment",
        "file=FILE?": "what to write (default: my-device.toml, my-environment.toml)",
        "--device FILE": "of an environment: the device that is to render it, a file or a name in the "
        f"catalogue (default: {environment.DEVICE} in this folder, where there is one)",
        "--no-questions": "ask nothing; rate and damping are needed, or unknown",
        "--force": "replace a file that exists",
    },
    "device: an answer in advance; unknown where it is not known",
    _answers("device"),
    "environment: an answer in advance; unknown where it is not known",
    _answers("environment"),
)


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
    check_target(path, arguments.force, "--force")
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
