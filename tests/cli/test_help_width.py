"""Help and messages fit the terminal, and what stands together there can be copied."""

import os
import re
import shlex
import subprocess
import sys

import pytest

from zwidth.cli.commands import COMMANDS
from zwidth.cli.output import width_of, wrapped


@pytest.mark.parametrize("width", [60, 80, 100])
@pytest.mark.parametrize("command", ["", *COMMANDS])
def test_help_fits_and_every_example_is_whole(command, width, monkeypatch, run):
    """No line is too long; a shell that reads an example has the words of the table of commands."""
    monkeypatch.setenv("COLUMNS", str(width))
    out = run(f"{command} --help{' all' * bool(command)}").out
    assert max(map(width_of, out.splitlines())) <= width
    if command:
        _, examples, shown = out.rpartition("example")
        wanted = COMMANDS[command].epilog.rpartition("example")[2] if examples else ""
        texts = [
            [shlex.split(line) for line in text.replace("\\\n", "").splitlines()[1:]]
            for text in (shown, wanted)
        ]
        assert not examples or texts[0] == texts[1]


_OPTION = re.compile(r"^  (?:-\w[^,]*, )?(--?[a-z][\w.-]*)", re.MULTILINE)


@pytest.mark.parametrize("command", COMMANDS)
def test_the_help_begins_with_what_a_first_question_needs(command, run):
    """At most 30 options; `--help all` has these and as many more as it is said to have."""
    first, every = (run(f"{command} --help{more}").out.split("\nexample")[0] for more in ("", " all"))
    few, many = (set(_OPTION.findall(text)) for text in (first, every))
    assert len(few) <= 30
    assert few <= many
    told = re.search(r"^(\d+) more options, by subject: zwidth (\w+) --help all$", first, re.MULTILINE)
    assert (int(told[1]) if told else 0) == len(many - few)


def test_after_help_stands_all_or_nothing(run):
    """Another word is refused, not ignored."""
    assert "stands all, or nothing, got 'drive'" in run("check --help drive", status=2).err


@pytest.mark.parametrize("command", COMMANDS)
def test_no_name_and_no_value_of_the_help_is_in_two(command, monkeypatch, run):
    """In a narrow terminal it has the words that it has in a wide one, and each quoted value in one line."""
    shown = []
    for width in ("60", "100"):
        monkeypatch.setenv("COLUMNS", width)
        shown.append(run(f"{command} --help all").out.replace("\\\n", ""))
    narrow, wide = shown
    assert sorted(narrow.split()) == sorted(wide.split())
    quotations = re.findall(r"(?<!\w)'[^'\n]+'", wide)
    assert [narrow.count(one) for one in quotations] == [wide.count(one) for one in quotations]


def test_what_is_quoted_stays_in_one_line():
    """Unless no line could hold it; an apostrophe opens nothing."""
    assert list(wrapped("write --rate '1 kHz' then", 17)) == ["write --rate", "'1 kHz' then"]
    assert list(wrapped('give the "N m" of it', 13)) == ["give the", '"N m" of it']
    assert list(wrapped("the hands' own and arms' one", 14)) == ["the hands' own", "and arms' one"]
    assert list(wrapped("'much too long for it'", 12)) == ["'much too", "long for it'"]


@pytest.mark.parametrize("width", [40, 80])
def test_a_message_fits_the_terminal(width, tmp_path):
    """In lines that say what the message says, the name in one of them."""
    (tmp_path / "d.toml").write_text('[device]\nmass = "a very odd mass"\nrate = 1000\n', encoding="utf-8")
    command = [sys.executable, *["-m", "zwidth", "check", "d.toml", "--stiffness", "100"]]
    environment = {**os.environ, "PYTHONIOENCODING": "utf-8", "COLUMNS": str(width)}
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, encoding="utf-8", env=environment)
    lines = done.stderr.splitlines()
    assert done.returncode == 2
    assert len(lines) > 1
    assert max(map(width_of, lines)) <= width
    assert '"a very odd mass"' in done.stderr
