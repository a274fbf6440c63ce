"""The command `completion`: what makes a shell complete the words of zwidth, and the answers to the shell.

At the Tab key the shell runs `zwidth` itself, with `_ARGCOMPLETE` in its environment; argcomplete then reads
the line typed so far and answers from the parser of that command.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable, Collection, Mapping, Sequence
from importlib import import_module
from pathlib import Path
from types import MappingProxyType

from zwidth.cli.output import quiet_pipe
from zwidth.errors import InputError
from zwidth.missing import suggestion
from zwidth.model.specification.table import quoted

SHELLS = ("bash", "zsh", "fish")


OPTIONS = ({"shell=SHELL?": ", ".join(SHELLS)},)


def run(arguments: argparse.Namespace) -> int:
    """`zwidth completion`: 0."""
    if arguments.shell is None:
        yours = Path(os.environ.get("SHELL", "")).name
        shell = yours if yours in SHELLS else SHELLS[0]
        raise InputError(f"for which shell, {', '.join(SHELLS)}? For {shell}: zwidth completion {shell}")
    if arguments.shell not in SHELLS:
        raise InputError(
            f"there is no completion for {quoted(arguments.shell)}; {suggestion(arguments.shell, SHELLS)}"
        )
    with quiet_pipe():
        print(_script(arguments.shell))
    return 0


def _script(shell: str) -> str:
    """What the shell reads, and above it where to put it.

    A shell of zsh takes it from a folder of completions too, where the first line has to stand first; bash
    reads that line as a comment that says nothing.
    """
    from argcomplete.shell_integration import shellcode

    code = shellcode(["zwidth"], shell=shell).lstrip()
    first, _, rest = code.partition("\n")
    if not first.startswith("#compdef"):
        return f"{_WHERE[shell]}\n{code}"
    return "\n".join([*([first] if shell == "zsh" else []), _WHERE[shell], rest])


_WHERE: Mapping[str, str] = MappingProxyType(
    {
        "bash": "# Completion of zwidth for bash. Put this line into ~/.bashrc:\n"
        '#   eval "$(zwidth completion bash)"',
        "zsh": "# Completion of zwidth for zsh. Put this line into ~/.zshrc, after compinit:\n"
        '#   eval "$(zwidth completion zsh)"',
        "fish": "# Completion of zwidth for fish. Put this line into ~/.config/fish/config.fish:\n"
        "#   zwidth completion fish | source",
    }
)
"""By shell, where the words come from when it starts."""


def answer(parser_of: Callable[[Sequence[str]], argparse.ArgumentParser]) -> None:
    """Answer the shell, and end the process.

    `parser_of`: makes the parser of a command line; of its words the command is asked for alone.
    """
    import argcomplete

    typed = os.environ.get("COMP_LINE", "").split()[1:]
    argcomplete.autocomplete(
        parser_of(typed),
        always_complete_options=False,
        default_completer=_completed,  # type: ignore[arg-type]  # a function with these arguments will do
    )


def _completed(prefix: str, action: argparse.Action, **_: object) -> list[str]:
    """What a value of this option, or of this argument, may be: known words, and files."""
    name = (action.option_strings or [str(action.metavar)])[-1]
    words = _WORDS[name]() if name in _WORDS and action.metavar != "VALUE" else ()
    ends = _ENDS.get(name, _ENDS.get(str(action.metavar), None))
    found = [word for word in words if word.startswith(prefix)]
    return found if ends is None else [*found, *_files(prefix, ends)]


def _files(prefix: str, ends: tuple[str, ...]) -> list[str]:
    name = prefix.rpartition("/")[2]
    before = prefix[: len(prefix) - len(name)]
    try:
        entries = sorted(os.scandir(before or "."), key=lambda entry: entry.name)
    except OSError:
        return []
    shown = [e for e in entries if e.name.startswith(name) and (name or not e.name.startswith("."))]
    return [
        f"{before}{e.name}{'/' if e.is_dir() else ''}"
        for e in shown
        if e.is_dir() or not ends or e.name.endswith(ends)
    ]


def _devices() -> Collection[str]:
    from zwidth.model.device import catalogue

    return catalogue.names()


def _registered(module: str, name: str) -> Callable[[], Collection[str]]:
    """The names of a registry, which is loaded when they are asked for."""
    return lambda: getattr(import_module(f"zwidth.{module}"), name)


_laws = _registered("model.rendering", "LAWS")
_hands = _registered("model.operator", "OPERATORS")

_WORDS: Mapping[str, Callable[[], Collection[str]]] = MappingProxyType(
    {
        "SOURCE": _devices,
        "NAME": _devices,
        "--catalogue": _devices,
        "ARM": _registered("model.arms", "BUILT_IN"),
        "SHELL": lambda: SHELLS,
        "KIND": lambda: ("device", "environment"),
        "--type": _registered("model.specification.environments", "TYPES"),
        "--law": _laws,
        "--laws": _laws,
        "--operator": _hands,
        "--follower-operator": _hands,
        "--target": _registered("machine.firmware.targets", "TARGETS"),
        "--connection": _registered("machine.servo.devices.registry", "CONNECTIONS"),
        "--of": lambda: ("check", "limit", "simulate", "pair"),
        "--contact": lambda: ("kept", "made-and-broken"),
        "--motion": lambda: ("linear", "rotary"),
    }
)
"""By option, or by what stands for an argument, the words that may follow."""

_ENDS: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "SOURCE": (".toml",),
        "ARM": (".urdf", ".xml", ".mjcf"),
        "--plot": (".png", ".svg", ".pdf"),
        **dict.fromkeys(("FILE", "LOG", "RECORDING", "DIRECTORY", "FOLDER"), ()),
    }
)
"""By the same, how the files end that it takes; empty for any."""
