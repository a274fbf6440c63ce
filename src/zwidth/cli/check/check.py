"""The command `check`: is this device, rendering this environment, passive?"""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING, Any, TypeAlias

from zwidth.cli.decision import NAMES, asked, decided, exit_status, of_one_timing, ranges_of, with_hands
from zwidth.cli.options import CONTACT, IN_FULL, LAW, LOOP, PARAMETERS, contact, output
from zwidth.cli.output import print_found, printed, targets

if TYPE_CHECKING:
    from zwidth.model.specification.read import Specification
    from zwidth.passivity.finite_stiffness import FiniteStiffnessReplay
    from zwidth.passivity.interval_devices import OverRanges
    from zwidth.passivity.stability import Stability
    from zwidth.passivity.stability.active_hand import ToleratedActivity
    from zwidth.passivity.verdict import Verdict

    Report: TypeAlias = FiniteStiffnessReplay | ToleratedActivity | OverRanges


USAGE = (
    "[SOURCE ...] [--law NAMES] [--PARAMETER VALUE ...] [--all] [--json] [--plot FILE] "
    "[--replay] [--hands NAMES] [--active-below FREQUENCY] [--contact KIND] [-o FILE] [--force]"
)
OPTIONS = (
    {"sources=SOURCE*": LOOP, **LAW, **CONTACT},
    "output",
    {
        **output("the verdict", "the plots", "verdict and evidence as JSON, for zwidth verify"),
        **IN_FULL,
        "--replay": "replay the motion by hands of finite stiffness; needs a mass",
        "--hands NAMES": f"say besides whether hands that are known come to rest: {NAMES}; needs a mass",
        "--active-below FREQUENCY": "how active a hand may be below this frequency that is passive above it, "
        "such as 10 Hz",
    },
    *PARAMETERS,
)


def run(arguments: argparse.Namespace) -> int:
    """`zwidth check`: the status says the outcome."""
    plot, save = targets(arguments.plot, arguments.save, arguments.force)
    loop = of_one_timing(asked(arguments).loop)
    active = _tolerated(loop, arguments.active_below)
    hands = with_hands(loop, arguments.hands)
    verdict = decided(loop, contact(arguments))
    ranges = ranges_of(loop, verdict)
    if save is not None:
        verdict.save(save, _reports(hands, active_hand=active, ranges=ranges))
    if plot is not None:
        verdict.plot(plot)
    replayed = _replayed(verdict) if arguments.replay else None
    report = printed(
        "check.report:print_verdict", verdict, replayed, active, arguments.in_full, ranges, hands
    )
    in_full = partial(_in_full, verdict, hands, real_hand=replayed, active_hand=active, ranges=ranges)
    print_found(arguments.json, in_full, report, save, plot)
    return exit_status(verdict.outcome)


def _replayed(verdict: Verdict) -> FiniteStiffnessReplay:
    from zwidth.passivity.finite_stiffness import replay

    return replay(verdict)


def _tolerated(loop: Specification, below: str | None) -> ToleratedActivity | None:
    if below is None:
        return None
    from zwidth.passivity.stability.active_hand import tolerated_activity
    from zwidth.quantity.units import parse_number

    return tolerated_activity(loop.device, loop.environment, parse_number(below, "Hz", "active_below"))


def _in_full(verdict: Verdict, hands: Mapping[str, Stability], **reports: Report | None) -> str:
    from zwidth.quantity.text import to_json

    return to_json({**verdict.to_dict(), **_reports(hands, **reports)})


def _reports(hands: Mapping[str, Stability], **reports: Report | None) -> dict[str, Any]:
    found = {name: report.to_dict() for name, report in reports.items() if report is not None}
    return found | ({"known_hands": {name: one.to_dict() for name, one in hands.items()}} if hands else {})
