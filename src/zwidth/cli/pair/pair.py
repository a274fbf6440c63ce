"""The command `pair`: are two arms that follow each other passive?"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping

from zwidth.cli.decision import exit_status
from zwidth.cli.options import IN_FULL, coupling_parameters, given, output
from zwidth.cli.output import give_out, printed, targets
from zwidth.cli.parsing import Parameter
from zwidth.cli.simulate.tables import FOLLOWER, OPERATOR
from zwidth.errors import InputError
from zwidth.model.operator.hand_impedance import HandImpedance
from zwidth.model.specification.load import load_pair
from zwidth.model.specification.table import located, quoted
from zwidth.model.specification.values import read
from zwidth.quantity.parameter import parameters_of


def run(arguments: argparse.Namespace) -> int:
    """`zwidth pair`: the status says the outcome."""
    from zwidth.passivity.check import check

    plot, save = targets(arguments.plot, arguments.save, arguments.force)
    pair = load_pair(arguments.sources, given(arguments, [p.key for p in coupling_parameters()]))
    verdict = check(pair, **known_hands(arguments, pair.motion))
    report = printed("pair.pair_report:print_pair", verdict, arguments.in_full)
    give_out(verdict, save, plot, arguments.json, report)
    return exit_status(verdict.outcome)


NOBODY, IMPEDANCE = "nobody", "impedance"

_SIDES: Mapping[str, str] = {"leader": OPERATOR, "follower": FOLLOWER}


def hand_parameters() -> Iterator[Parameter]:
    for side, option in _SIDES.items():
        kinds = f"{NOBODY}, or {IMPEDANCE} with the numbers below"
        yield Parameter(option, "TYPE", f"a known hand on the {side}: {kinds} (default: any hand)")
        for name, own in parameters_of(HandImpedance).items():
            unit, rotary = own.unit_for("linear"), own.unit_for("rotary")
            more = f"{name} {own.meaning} on the {side}, or an interval [{unit}; rotary {rotary}]"
            yield Parameter(f"{option}.{name}", own.quantity.symbol, more)


USAGE = (
    "[SOURCE ...] --stiffness K [--link-delay TIME] [--PARAMETER VALUE ...] [--all] [--json] "
    "[--plot FILE] [-o FILE] [--force]"
)
OPTIONS = (
    {
        "sources=SOURCE*": "one device for both arms, or leader and follower: each of the catalogue, or a "
        "TOML file with a [device] table; or one file with [leader], [follower] and [coupling]"
    },
    "output",
    {**output("the verdict", "the plots", "verdict and evidence as JSON, for zwidth verify"), **IN_FULL},
    "coupling: override what [coupling] says, or replace it",
    coupling_parameters,
    "hands: leave out what any hand may hold",
    hand_parameters,
)


def known_hands(arguments: argparse.Namespace, motion: str) -> dict[str, HandImpedance | None]:
    """What holds the leader or the follower, None for nobody; without those that any hand may hold."""
    typed = given(arguments, [p.key for p in hand_parameters()])
    return {
        side: _hand(option, {k: v for k, v in typed.items() if k.partition(".")[0] == option}, motion)
        for side, option in _SIDES.items()
        if any(key.partition(".")[0] == option for key in typed)
    }


def _hand(option: str, typed: Mapping[str, str], motion: str) -> HandImpedance | None:
    kind, flag = typed.get(option), f"--{option.replace('_', '-')}"
    if kind is None:
        raise InputError(f"{flag} says what the numbers are of: {flag} {IMPEDANCE}")
    if kind not in (NOBODY, IMPEDANCE):
        raise InputError(f"{flag}: {quoted(kind)} is no known hand; it is {NOBODY} or {IMPEDANCE}")
    numbers = {key.partition(".")[2]: value for key, value in typed.items() if key != option}
    if kind == NOBODY and numbers:
        raise InputError(f"{flag} {NOBODY} has no {min(numbers)}: {flag} {IMPEDANCE} is a hand that has")
    own = parameters_of(HandImpedance)
    with located(flag):
        known = {name: read(value, name, own[name], motion) for name, value in numbers.items()}
        return HandImpedance(**known) if known else None
