"""The README's commands work as they are typed, one after the other, in a folder with the sample files."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

from zwidth.cli.main import _parser, main
from zwidth.cli.parsing import joined

ROOT = Path(__file__).resolve().parent.parent

RUN = ("--plan", "identify", "verify", "workspace arm.urdf", "check")
"""What is run here; the rest is read, or run in tests/documentation, or by the tests of its command."""


def commands() -> list[str]:
    """The lines of the README that begin with zwidth, as typed."""
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```sh\n(.*?)```", text, re.DOTALL)
    lines = [line for block in blocks for line in block.splitlines()]
    return [line for line in lines if line.startswith("zwidth ") and "--help" not in line]


def test_there_are_commands():
    assert len(commands()) > 30


def test_each_command_works_as_typed(tmp_path, monkeypatch, capsys):
    """Its options exist, and the files that it reads are samples, or were written by a line above."""
    monkeypatch.chdir(tmp_path)
    assert main(["examples", "."]) == 0
    there = {path.name for path in tmp_path.iterdir()}
    for line in commands():
        argv = shlex.split(line, comments=True)[1:]
        _, unknown = _parser(argv).parse_known_args(joined(argv))
        assert not unknown, line
        written = {argv[k + 1] for k, word in enumerate(argv) if word in ("-o", "--plot")}
        read = {word for word in argv if re.fullmatch(r"[a-z][\w-]*\.\w{3,5}", word)} - written
        assert read <= there, line
        there |= written
        if read | written and any(mark in line for mark in RUN) and "--replay" not in line:
            status = main(argv)
            assert status in (0, 1, 3, 4), f"{line}\n{capsys.readouterr().err}"
