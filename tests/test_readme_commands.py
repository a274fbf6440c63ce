"""The README's commands work as they are typed, one after the other, in a folder with the sample files."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest

from zwidth.cli.main import _parser, main
from zwidth.cli.options import joined
from zwidth.specification.read import load_device

ROOT = Path(__file__).resolve().parent.parent

NOT_RUN = (
    "serve",
    "doctor",
    "replay",
    "compare",
    "links",
    "new",
    "tour",
    "simulate arms",
    "--replay",
    "10 s",
    "gains",
)
"""What asks, waits for hardware or for a clock, or takes long; the tests of these commands run them."""


def commands() -> list[str]:
    """The lines of the README that begin with zwidth, as typed."""
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```sh\n(.*?)```", text, re.DOTALL)
    return [line for block in blocks for line in block.splitlines() if line.startswith("zwidth ")]


def test_there_are_commands() -> None:
    assert len(commands()) > 30


def test_each_command_works_as_typed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Those that are not run have options that exist, and files that are there by then."""
    monkeypatch.chdir(tmp_path)
    written: set[str] = {"touch.mcap"}  # by a command that is not run
    for line in commands():
        argv = shlex.split(line, comments=True)[1:]
        saved = {argv[k + 1] for k, word in enumerate(argv) if word in ("-o", "--plot")}
        if any(mark in line for mark in NOT_RUN):
            _, unknown = _parser(argv).parse_known_args(joined(argv))
            assert not unknown, line
            files = {word for word in argv if re.fullmatch(r"\w[\w-]*\.\w{3,5}", word)} - saved
            assert all(Path(name).exists() or name in written for name in files), line
        elif "arm.urdf" not in line or _reads_descriptions():
            status = main(argv)
            told = capsys.readouterr()
            assert status in (0, 1, 3, 4), f"{line}\n{told.err}"
        written |= saved
    assert load_device(["knob.toml"], {}).motion == "rotary"  # what is served on hardware can be read


def _reads_descriptions() -> bool:
    try:
        import pinocchio  # noqa: F401
    except ImportError:
        return False
    return True
