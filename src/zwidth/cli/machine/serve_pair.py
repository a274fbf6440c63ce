"""`zwidth serve` of two arms that follow each other: a pair from a file, each arm with its connection.

    [leader]   [follower]   [coupling]          as of `zwidth pair`
    [connection]            [follower_connection]
    [operator]              [follower_operator]

An arm without a connection is simulated, the leader in its usual hand, a finger or hands
on a wheel, the follower in nobody's.
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from zwidth.cli.machine.serve_tables import (
    CONNECTION,
    OPERATOR,
    SAFETY,
    connection_parameters,
    merged,
    reached,
    safety_parameters,
    told,
)
from zwidth.cli.options import given
from zwidth.cli.simulate.simulate import pair_with_options
from zwidth.errors import InputError
from zwidth.model.specification.table import Table

if TYPE_CHECKING:
    from zwidth.machine.servo import PairServoReport
    from zwidth.model.pairs import Pair

FOLLOWER_CONNECTION, FOLLOWER_OPERATOR = "follower_connection", "follower_operator"

_DURATION = "10 s"


def served_pair(arguments: argparse.Namespace, tables: Mapping[str, Table]) -> PairServoReport:
    """The report of the pair that tables and command line describe, served."""
    from zwidth.machine.servo import PairServo, Placement
    from zwidth.machine.servo.safety import read_safety

    if arguments.watch or arguments.save or arguments.commands:
        raise InputError(
            "a pair has no live graphs, recording or changes yet: leave out --watch, --save and --commands"
        )
    pair = pair_with_options(arguments, tables)
    duration = arguments.duration or _DURATION
    # both are described before either is reached
    (leader, at), (follower, other_at) = (
        _side(pair, leads, arguments, tables, duration) for leads in (True, False)
    )
    safety = read_safety(told(arguments, tables, SAFETY, safety_parameters), pair.motion)
    places = (at or Placement(), other_at or Placement())
    with PairServo(pair, leader, follower, safety=safety, placements=places) as servo:
        return servo.run(duration, anyway=arguments.anyway)


def _side(
    pair: Pair, leads: bool, arguments: argparse.Namespace, tables: Mapping[str, Table], duration: str
) -> tuple[Any, Any]:
    """The connection of one arm, and where it is placed; None where it is simulated."""
    from zwidth.machine.servo.devices import Simulated

    name = CONNECTION if leads else FOLLOWER_CONNECTION
    typed = given(arguments, [p.key for p in connection_parameters()]) if leads else {}
    connection, place = reached(merged(tables.get(name), typed, name), pair.motion)
    hand = _hand(pair, leads, arguments, tables, connection is None)
    if connection is not None:
        return connection, place
    device = pair.leader if leads else pair.follower
    return Simulated(device=device, hand=hand, duration=duration), None


def _hand(
    pair: Pair, leads: bool, arguments: argparse.Namespace, tables: Mapping[str, Table], simulated: bool
) -> Any:
    from zwidth.cli.simulate.tables import build_hand, operator_parameters
    from zwidth.model.operator import HandsOff, usual_hand

    name = OPERATOR if leads else FOLLOWER_OPERATOR
    typed = given(arguments, [p.key for p in operator_parameters()]) if leads else {}
    if name not in tables and not typed:
        return usual_hand(pair.leader) if leads else HandsOff()
    if not simulated:
        raise InputError(f"[{name}] holds a simulated arm; a real one is held by a person: drop it")
    return build_hand(merged(tables.get(name), typed, name), pair.leader if leads else pair.follower, name)
