"""One loop as a command decides it: its verdict, and the status with which the command ends."""

from __future__ import annotations

import argparse
from collections.abc import Container, Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

from zwidth.cli.options import overrides
from zwidth.errors import InputError
from zwidth.missing import suggestion
from zwidth.model.specification.table import quoted

if TYPE_CHECKING:
    from zwidth.model.device import Device
    from zwidth.model.specification.read import Specification
    from zwidth.model.specification.table import Table
    from zwidth.passivity.interval_devices import OverRanges
    from zwidth.passivity.stability import Stability
    from zwidth.passivity.verdict import Verdict


class Asked(NamedTuple):
    """What a command was asked about.

    `loop`: the device, and the environment behind its laws.
    `device_table`, `environment_table`: of which it was made, the parameters of the command line in them.
    `law_table`: the laws of a file; None where it has none.
    """

    loop: Specification
    device_table: Table
    environment_table: Table
    law_table: Table | None


def asked(arguments: argparse.Namespace) -> Asked:
    """The loop of the sources, the parameters and the laws of a command line."""
    from zwidth.model.specification.laws import with_laws
    from zwidth.model.specification.read import WITH_LAWS, Specification, built, merged, read_tables

    tables = read_tables(arguments.sources, WITH_LAWS)
    device_table, environment_table = merged(tables, overrides(arguments))
    given = built(device_table, environment_table)
    rendered = with_laws(given.environment, tables.get("law"), arguments.law, given.device.motion)
    loop = Specification(given.device, rendered, given.ranges)
    return Asked(loop, device_table, environment_table, tables.get("law"))


WORST = {
    **dict.fromkeys(("delay", "sample_period", "resolution", "force_resolution"), 1),
    **dict.fromkeys(("damping", "coulomb_friction", "force_limit"), 0),
}
"""At which end of an interval most energy leaks in, or least is lost.  Of a mass it is neither."""


def of_one_value(loop: Specification, of: Container[str] = WORST) -> Specification:
    """The loop with single values in the place of intervals, and a line to people about it."""
    device = device_of_one_value(loop.device, of)
    ranges = {key: own for key, own in loop.ranges.items() if key not in of}
    return loop if device is loop.device else replace(loop, device=device, ranges=ranges)


def of_one_timing(loop: Specification) -> Specification:
    """The same of rate and delay alone, where the law is decided for one of each."""
    return loop if loop.environment.has_transfer_function else of_one_value(loop, ("delay", "sample_period"))


def device_of_one_value(device: Device, of: Container[str] = WORST) -> Device:
    """The device with the worst ends of its intervals, and a line to people about it."""
    from zwidth.cli.output import print_message
    from zwidth.quantity.exact import Exact, Interval, ends
    from zwidth.quantity.text import in_words, shown

    taken = {
        key: Exact(ends(given)[WORST[key]])
        for key, given in device.parameters().items()
        if key in WORST and key in of and isinstance(given, Interval)
    }
    if not taken:
        return device
    told = ", ".join(f"{in_words(key)} {shown(value, device.unit(key))}" for key, value in taken.items())
    doubt = "; between whole samples a shorter delay may be worse" if "delay" in taken else ""
    print_message(f"of an interval the worst end is taken, for one value is needed: {told}{doubt}")
    return device.replace(**taken)


def exit_status(outcome: str) -> int:
    """What a command returns that ends in an outcome."""
    from zwidth.passivity.scope import TOLD

    return TOLD[outcome].status


def decided(loop: Specification, contact: str = "made and broken") -> Verdict:
    """What `zwidth.check` says, with a word to people who wait while values are iterated."""
    from zwidth.passivity.check import check, check_by_closed_forms
    from zwidth.passivity.value_iteration_fallback import has_gap, with_value_iteration

    device, law, closed = loop.device, loop.environment, None
    if law.has_transfer_function and device.transmission is None:
        closed = check_by_closed_forms(device, law, contact=contact)
        if contact == "kept" or not has_gap(device, law, closed):
            return closed
    from zwidth.progress import falling, progress_bar

    with progress_bar("states") as progress:
        if closed is not None:
            return with_value_iteration(device, law, closed, falling(progress))
        return check(device, law, contact=contact, progress=falling(progress))


def ranges_of(loop: Specification, verdict: Verdict) -> OverRanges | None:
    """What holds over the ranges of a device of the catalogue, where it has some."""
    if not loop.ranges:
        return None
    from zwidth.model.device.catalogue import DeviceInRange
    from zwidth.passivity.interval_devices import over_ranges

    return over_ranges(DeviceInRange(loop.device, loop.ranges), loop.environment, verdict)


NAMES = "none, finger, dowel; of a rotary device none, hands-on"
"""Of the hands, for a help."""

ABOUT = "of each hand alone, as long as it keeps contact; dry friction and encoder steps left out"


def named_hands(typed: str, motion: str) -> dict[str, Any]:
    from zwidth.study.maps.request import standard_hands

    known, names = standard_hands(motion), [name.strip() for name in typed.split(",")]
    for name in names:
        if name not in known:
            raise InputError(f"there is no hand {quoted(name)}; {suggestion(name, list(known))}")
    return {name: known[name] for name in names}


def with_hands(loop: Specification, typed: str | None) -> dict[str, Stability]:
    """Of each hand whether it comes to rest against what is rendered; nothing where none is named."""
    if typed is None:
        return {}
    from zwidth.passivity.stability import coupled_stability

    hands = named_hands(typed, loop.device.motion)
    return {name: coupled_stability(loop.device, loop.environment, hand) for name, hand in hands.items()}


def hand_rows(found: Mapping[str, Stability]) -> Iterator[tuple[str, str]]:
    """What is said of each, and of what it is said."""
    for name, of_one in found.items():
        yield name, _said(of_one)
    yield "", ABOUT


def _said(found: Stability) -> str:
    from zwidth.quantity.text import shown, told_quantity

    most = found.max_stiffness
    up_to = f"up to {told_quantity(most, 'stiffness', found.scope.motion, 4)}" if most else ""
    if found.outcome == "stable":
        return f"comes to rest{', ' if up_to else ''}{up_to}"
    rest = f"; comes to rest {up_to}" if up_to else ""
    if found.outcome == "undecided":
        return f"not decided{rest}"
    if not found.frequency:
        return f"does not come to rest{rest}"
    return f"is shaken, at {shown(found.frequency, 'Hz')}{rest}"
