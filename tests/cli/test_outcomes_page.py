"""The page of outcomes: each of its commands ends as its row says."""

import re
import shlex
from pathlib import Path

import pytest

from zwidth.cli.main import main
from zwidth.passivity.scope import TOLD

PAGE = (Path(__file__).parents[2] / "docs" / "outcomes.md").read_text(encoding="utf-8")
ROWS = re.findall(r"^\| ([^|]+?) \|.*\| `zwidth ([^`]+)` \| (\d) \|$", PAGE, re.M)
BADGES = {"both sides of a limit": "BRACKETED", "bad input": ""}


def test_the_page_has_every_outcome_and_status():
    assert set(TOLD) <= {row[0] for row in ROWS}
    assert {row[2] for row in ROWS} == set("01234")


@pytest.mark.parametrize(("outcome", "command", "status"), ROWS, ids=[row[1][:60] for row in ROWS])
def test_a_command_of_the_page(outcome, command, status, capsys):
    ended = main(shlex.split(command))
    assert ended == int(status)
    printed = capsys.readouterr().out.strip()
    assert printed.startswith(BADGES.get(outcome, outcome.upper()))
