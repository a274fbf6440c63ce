"""What a report says to change, and what a refusal says to give, is taken as it is printed."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from zwidth.cli.start.examples import copy_to

ACTIVE = (
    "check paddle.toml wall.toml",
    "check wheel.toml bumpstop.toml --virtual-damping '1 N*m*s/rad'",
    "check haptic-paddle --stiffness '2 kN/m'",
    "pair arms.toml --stiffness '5 kN/m'",
)
IN_FILES = {"pair": {"damping"}}
"""By command, what is no option of it: the damping of an arm is in its file."""


@pytest.fixture(autouse=True)
def _files(run):
    """The samples, and gains without a voltage."""
    copy_to(Path(), force=False)
    Path("so101.json").write_text('{"position_p_coefficient": 32}', encoding="utf-8")


@pytest.mark.parametrize("line", ACTIVE)
def test_each_change_of_a_report_mends_the_loop(line, run):
    """The number as its sentence has it, behind the option that is named as its parameter is."""
    told = run(f"{line} --json", 1).json["advice"]
    would_do = [own for own in told if own["to"] is not None and own["kind"] == "change"]
    assert would_do
    for own in would_do:
        if own["parameter"] not in IN_FILES.get(line.split()[0], ()):
            option = f"--{own['parameter'].replace('_', '-')}"
            value = re.search(r" to ([-\d.e]+ \S+)$", own["text"])[1]
            before = re.sub(rf" {option} ('[^']*'|\S+)", "", line)
            run(f"{before} {option} '{value}'", 0)


REFUSED = (
    "simulate haptic-paddle --stiffness 300",
    "simulate wheel.toml bumpstop.toml",
    "simulate arms.toml",
    "simulate haptic-paddle --stiffness 300 --operator hands-off --duration 0.1",
    "simulate wheel.toml bumpstop.toml --operator hands-off --duration 0.1",
    "plan haptic-paddle",
    "plan wheel.toml",
    "sweep haptic-paddle",
    "workspace two-link",
    "gains so101.json --both",
    "emit touch --stiffness 100 --travel '-50 .. 50 mm' -o law",
)
GIVEN = re.compile(r"""(--[a-z][\w.-]*)(?:, such as)? ('[^']*'|"[^"]*"|\w+=[\d:]+|[\d.]+\b|[a-z-]+(?= --))""")


@pytest.mark.parametrize("line", REFUSED)
def test_a_refused_line_runs_with_what_the_refusal_says_to_give(line, run):
    """With each of its alternatives, and with what a second refusal says."""
    run(line, 2)
    lines = [line]
    while lines:
        told = run(line := lines.pop(), None)
        if told.status == 2:
            asked = " ".join(told.err.split())
            ways = [GIVEN.findall(way) for way in asked.split(" or ")]
            more = ["".join(f" {o} {v}" for o, v in way if f" {o} " not in line) for way in ways]
            assert any(more), (line, asked)
            lines += [line + options for options in more if options]
