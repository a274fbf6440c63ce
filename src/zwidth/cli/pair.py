"""The command `pair`: are two arms that follow each other passive?"""

from __future__ import annotations

import argparse

from zwidth.cli.decision import exit_status
from zwidth.cli.known_hands import hand_parameters, known_hands
from zwidth.cli.options import add_all, add_in_full, add_output, coupling_parameters, given
from zwidth.cli.output import print_json, say_written, targets
from zwidth.model.specification.load import load_pair


def configure(parser: argparse.ArgumentParser) -> None:
    """The arguments of `zwidth pair`."""
    parser.usage = (
        "%(prog)s [SOURCE ...] --stiffness K [--link-delay TIME] [--PARAMETER VALUE ...] [--all] [--json] "
        "[--plot FILE] [-o FILE] [--force]"
    )
    parser.add_argument(
        "sources",
        metavar="SOURCE",
        nargs="*",
        help="one device for both arms, or leader and follower: each of the catalogue, or a TOML file with a "
        "[device] table; or one file with [leader], [follower] and [coupling]",
    )
    add_in_full(
        add_output(parser, "the verdict", "the plots", "verdict and evidence as JSON, for zwidth verify")
    )
    coupling = parser.add_argument_group("coupling", "override what [coupling] says, or replace it")
    add_all(coupling, coupling_parameters())
    hands = parser.add_argument_group("hands", "leave out what any hand may hold")
    add_all(hands, hand_parameters())


def run(arguments: argparse.Namespace) -> int:
    """`zwidth pair`: the status says the outcome."""
    from zwidth.passivity.check import check

    plot, save = targets(arguments.plot, arguments.save, arguments.force)
    pair = load_pair(arguments.sources, given(arguments, [p.key for p in coupling_parameters()]))
    verdict = check(pair, **known_hands(arguments, pair.motion))
    if save is not None:
        verdict.save(save)
    if plot is not None:
        verdict.plot(plot)
    if arguments.json:
        print_json(verdict.to_json())
    else:
        from zwidth.cli.pair_report import print_pair

        print_pair(verdict, arguments.in_full)
        say_written(save, plot)
    return exit_status(verdict.outcome)
