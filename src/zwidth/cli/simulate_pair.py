"""`zwidth simulate` of two arms that follow each other."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from zwidth.cli.options import given, overrides
from zwidth.errors import InputError
from zwidth.model.pairs import Pair
from zwidth.model.specification.load import option_keys, pair_of
from zwidth.model.specification.read import PAIR_TABLES
from zwidth.model.specification.table import Table
from zwidth.quantity.glossary import GLOSSARY

if TYPE_CHECKING:
    from zwidth.loop.trace import AnyTrace, Trace


def simulated_pair(arguments: argparse.Namespace, tables: Mapping[str, Table]) -> Trace:
    """The trace of the pair, and of what holds it, that tables and command line describe."""
    from zwidth.cli.simulation_tables import (
        FOLLOWER,
        build_follower,
        build_touch,
        follower_parameters,
        operator_parameters,
        simulation_parameters,
    )
    from zwidth.loop.simulate import simulated
    from zwidth.show.with_bar import with_bar

    pair = pair_with_options(arguments, tables)
    typed = given(arguments, [p.key for p in (*operator_parameters(), *simulation_parameters())])
    touch = build_touch(tables.get("operator"), tables.get("simulation"), typed, pair.motion)
    of_follower = given(arguments, [p.key for p in follower_parameters()])
    follower = build_follower(tables.get(FOLLOWER), of_follower, pair.motion)
    if touch.duration is None:
        raise InputError("no duration is given: set --duration, for example --duration '2 s'")
    return with_bar(simulated, "samples")(pair, touch.operator, follower, touch.duration, **touch.options)


def pair_with_options(arguments: argparse.Namespace, tables: Mapping[str, Table]) -> Pair:
    """The pair of the tables, with what the command line says of its coupling."""
    for name in ("environment", "law"):
        if name in tables or (name == "law" and arguments.law):
            raise InputError(
                f"two arms meet each other, not a virtual wall: leave out the {name}; what the follower "
                "really meets is for zwidth simulate, --follower-operator wall"
            )
    coupling, words = option_keys(), overrides(arguments)
    foreign = sorted(set(words) - set(coupling))
    if foreign:
        raise InputError(
            f"--{foreign[0].replace('_', '-')} does not say of which arm: write it in [leader] or [follower]"
        )
    arms = {name: tables[name] for name in ("device", *PAIR_TABLES) if name in tables}
    return pair_of(arms, words)


def pair_measures(trace: AnyTrace) -> dict[str, Any]:
    """What a trace of a pair is measured by, a unit in every key."""
    from zwidth.loop.energy import PairLedger
    from zwidth.loop.traces.scores import static_stiffness, tracking_error

    motion = str(trace.attrs["motion"])
    felt, apart = static_stiffness(trace.sel(arm="leader")), tracking_error(trace)
    return {
        GLOSSARY["stiffness"].key_for(motion).replace("stiffness", "felt_stiffness"): felt,
        GLOSSARY["position"].key_for(motion).replace("position", "tracking_error"): apart,
        "energy": PairLedger(trace).to_dict(),
    }
