"""The command `tour`: one paddle, its wall, what goes wrong and what mends it, step by step."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from typing import NamedTuple

from rich.console import Console
from rich.text import Text

from zwidth.cli.output import encodes, print_text, quiet_pipe
from zwidth.cli.page import PICTURE, claimed, items, motion_lines, page, section
from zwidth.model.device import catalogue
from zwidth.model.environment import Wall
from zwidth.passivity.linear_verdict import LinearVerdict
from zwidth.quantity.text import shown

_SOFT, _STIFF, _QUICK = "300", "770", "2.6 kHz"


class Step(NamedTuple):
    """What is told, the command that asks it, and what of its answer is shown."""

    told: str
    command: str
    show: Callable[[Console], None]


OPTIONS = ({"--no-pause": "go on without waiting for Enter"},)


def run(arguments: argparse.Namespace) -> int:
    """`zwidth tour`: 0."""
    terminal = all(stream is not None and stream.isatty() for stream in (sys.stdin, sys.stdout))
    for step in STEPS:
        print_text(f"{step.told}\n\n  $ {step.command}\n")
        with page() as out:
            step.show(out)
        print_text("")
        if terminal and not arguments.no_pause and not _goes_on():
            return 0
    print_text(THEN)
    return 0


def _goes_on() -> bool:
    """Wait for Enter; False where the tour is to end."""
    try:
        with quiet_pipe():
            print("Enter goes on, q ends: ", end="")
        left = input().strip().lower().startswith("q")
    except EOFError:
        left = True
    print_text("")
    return not left


def _verdict(stiffness: str, rate: str | None = None) -> LinearVerdict:
    from zwidth.passivity.check import check

    paddle = catalogue.device("haptic-paddle", **({"rate": rate} if rate else {}))
    verdict = check(paddle, Wall(stiffness))
    assert isinstance(verdict, LinearVerdict)
    return verdict


def _passive(out: Console) -> None:
    verdict = _verdict(_SOFT)
    out.print(claimed(verdict.outcome, verdict.claim))
    largest = shown(verdict.max_stiffness, "N/m", 6)
    out.print(Text(f"largest passive stiffness  {largest}, limited by {verdict.limit}"))


def _active(out: Console) -> None:
    verdict = _verdict(_STIFF)
    out.print(claimed(verdict.outcome, verdict.claim))
    if verdict.witness is not None:
        section(out, "the motion", motion_lines(verdict.witness, encodes(PICTURE)))


def _touched(out: Console) -> None:
    from zwidth.cli.simulate.trace_report import trace_headline
    from zwidth.loop.simulate import simulated
    from zwidth.model.operator import Dowel

    out.print(trace_headline(simulated(catalogue.device("haptic-paddle"), Wall(_STIFF), Dowel(), 2.0)))


def _advice(out: Console) -> None:
    would_do = (advice.text for advice in _verdict(_STIFF).advice if advice.to is not None)
    section(out, "what to change, any one of", items(would_do))


def _mended(out: Console) -> None:
    verdict = _verdict(_STIFF, _QUICK)
    out.print(claimed(verdict.outcome, verdict.claim))


STEPS = (
    Step(
        "A haptic paddle reads its position 1000 times a second, and pushes back like a\n"
        "spring of 300 N/m. Can a hand, however skilled, get energy out of that wall?",
        f"zwidth check haptic-paddle --stiffness {_SOFT}",
        _passive,
    ),
    Step(
        "It cannot, and that is a proof. Of a wall of 770 N/m the answer is a motion of\n"
        "the hand; each time it is made, the wall gives energy to the hand.",
        f"zwidth check haptic-paddle --stiffness {_STIFF}",
        _active,
    ),
    Step(
        "You would feel it as buzzing. It takes no skill: a wooden dowel that leans on\n"
        "the wall bounces higher each time.",
        f"zwidth simulate haptic-paddle --stiffness {_STIFF} --operator dowel --duration 2",
        _touched,
    ),
    Step(
        "Why? The force is held for a millisecond while the hand moves on: going in it is\n"
        "too small, coming out too large. The paddle's own friction must pay for that.\n"
        "The report of the second command says what would do:",
        f"zwidth check haptic-paddle --stiffness {_STIFF}",
        _advice,
    ),
    Step("Take the rate.", f'zwidth check haptic-paddle --stiffness {_STIFF} --rate "{_QUICK}"', _mended),
)

THEN = """\
Now yours:

  zwidth new device       the file of your device, question by question
  zwidth examples .       sample files for every command

In the browser:

  zwidth play             hold a handle, push it into a wall
  zwidth explore          every parameter on a slider, and the verdict beside it

In real time, simulated or on your device; and the proved law as C for a board:

  zwidth serve haptic-paddle --stiffness 250 --watch terminal
  zwidth emit haptic-paddle --stiffness 250 --target arduino -o wall"""
