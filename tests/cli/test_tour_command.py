"""`zwidth` alone and `zwidth tour`: what to type next, and the story in short, as the commands tell it."""

import re

import pytest

from zwidth.cli.commands import COMMANDS
from zwidth.cli.start import tour


def test_zwidth_alone_says_what_to_type(run):
    """A few commands, each with a line; no complaint."""
    told = run("")
    named = re.findall(r"^  zwidth (\w+)", told.out, re.MULTILINE)
    assert 3 <= len(named) <= 4
    assert set(named) <= set(COMMANDS)
    assert max(map(len, told.out.splitlines())) <= 80
    assert told.err == ""


def test_the_tour_tells_its_story_and_writes_nothing(run, tmp_path, monkeypatch):
    """Passive, active with its motion, touched, what would do, passive again; no pause where nobody sits."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("builtins.input", lambda *_: pytest.fail("waits for Enter"))
    said = run("tour").out
    badges = re.findall(r"^ (PASSIVE|ACTIVE|GAINED) ", said, re.MULTILINE)
    assert badges == ["PASSIVE", "ACTIVE", "GAINED", "PASSIVE"]
    for part in ("300 N/m, limited by", "extracts 1.427 mJ", "raise the rate from 1 kHz to 2.567 kHz"):
        assert part in said
    assert max(map(len, said.splitlines())) <= 80
    assert list(tmp_path.iterdir()) == []


def test_each_step_shows_what_its_command_finds(run):
    said = run("tour --no-pause").out
    for step in tour.STEPS:
        shown = said.partition(f"$ {step.command}\n")[2].partition("$ ")[0]
        report = run(step.command.removeprefix("zwidth "), None).out
        if badge := re.search(r"^ (PASSIVE|ACTIVE|GAINED) ", shown, re.MULTILINE):
            assert report.startswith(badge.group())
        for number in re.findall(r"[\d.]+ mJ", shown):
            assert number in report


@pytest.mark.parametrize(("answers", "steps"), [([""] * 9, 5), (["", "q"], 2)])
def test_in_a_terminal_it_waits_and_q_ends_it(run, answers, steps, monkeypatch):
    typed = iter(answers)
    monkeypatch.setattr("sys.stdin.isatty", lambda: True, raising=False)
    monkeypatch.setattr("sys.stdout.isatty", lambda: True, raising=False)
    monkeypatch.setattr("builtins.input", lambda *_: next(typed))
    assert run("tour").out.count("$ zwidth") == steps


def test_the_commands_it_ends_with_exist():
    assert set(re.findall(r"zwidth (\w+)", tour.THEN)) <= set(COMMANDS)
