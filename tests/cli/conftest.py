"""What is printed here does not depend on how the tests were started."""

from __future__ import annotations

import json
import shlex
import signal
from collections.abc import Iterator
from typing import Any, NamedTuple

import pytest

from zwidth.cli.main import main


@pytest.fixture(scope="session", autouse=True)
def ctrl_c_is_heard() -> Iterator[None]:
    """Also where the tests are started in the background of a script, which has them ignore it.

    So would what they start: a signal that is ignored is handed on, a handler is not.
    """
    before = signal.getsignal(signal.SIGINT)
    if before is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


class Result(NamedTuple):
    """What one command line left behind."""

    status: int
    out: str
    err: str

    @property
    def words(self) -> str:
        """The report on one line."""
        return " ".join(self.out.split())

    def says(self, *parts: str) -> None:
        """Each part stands in the report, in whatever lines."""
        for part in parts:
            assert part in self.out or part in self.words, f"{part}\n{self.out}"

    @property
    def json(self) -> Any:
        """The document that was printed."""
        return json.loads(self.out)


@pytest.fixture
def run(capsys, tmp_path, monkeypatch):
    """Runs a line as it is typed behind `zwidth`, here and in an empty folder; it ends with this status."""
    monkeypatch.chdir(tmp_path)

    def runner(line: str, status: int | None = 0) -> Result:
        result = Result(main(shlex.split(line)), *capsys.readouterr())
        assert status in (None, result.status), result
        return result

    return runner


@pytest.fixture
def refused(run):
    """Runs a line that cannot be used: status 2, and nothing but one message, which is returned; a command to
    type stands on a line of its own below it."""

    def runner(line: str) -> str:
        _, out, err = run(line, 2)
        assert (out, err[:8], err.count("\n")) == ("", "zwidth: ", 2 if "type:\n" in err else 1), err
        return err

    return runner


@pytest.fixture
def answer(run):
    """What `zwidth pair` prints with --json; the exit status is that of its outcome."""

    def runner(line: str) -> Any:
        result = run(f"pair {line} --json", None)
        assert result.status == {"passive": 0, "active": 1, "undecided": 3}[result.json["outcome"]]
        return result.json

    return runner
