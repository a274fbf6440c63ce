"""What files describe: a loop, or two arms and what joins them.

Two arms and what joins them, from TOML files and the command line.

    [leader]                    [follower]                  [coupling]
    catalogue = "touch"         damping = "0.4 N*s/m"       stiffness = "100 N/m"
    damping = "0.2 N*s/m"       rate = "1 kHz"              damping = "0.1 N*s/m"
    rate = "1 kHz"                                          link_delay = "2 ms"

One file with these tables, or one or two devices; of one device both arms are made.  As in an
[environment], `virtual_damping` may be written for `damping`; on the command line it must.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment import Environment
from zwidth.model.kind import bracketed
from zwidth.model.pairs import Pair
from zwidth.model.rendering.friction_compensation import FrictionCompensation
from zwidth.model.specification.environments import build_environment
from zwidth.model.specification.laws import with_laws
from zwidth.model.specification.read import (
    PAIR_TABLES,
    WITH_LAWS,
    build_device,
    keep_axis,
    question_unit,
    read_tables,
    specified_device,
)
from zwidth.model.specification.table import COMMAND_LINE, Table, located
from zwidth.model.specification.values import read
from zwidth.quantity.parameter import Parameter, parameters_of, read_number

_LINKS = {"link_delay": "there", "link_delay_back": "back"}

_LAW = {f"compensation_{name}": own for name, own in parameters_of(FrictionCompensation).items()}
_ITS_LAW = {
    f"follower_{key}": own._replace(
        quantity=own.quantity._replace(meaning=f"{own.meaning}, on the follower's side where it is another")
    )
    for key, own in _LAW.items()
}

KEYS: Mapping[str, Parameter] = MappingProxyType(
    {name: own for name, own in parameters_of(Pair).items() if name not in _LINKS.values()}
    | {key: parameters_of(Pair)[name] for key, name in _LINKS.items()}
    | _LAW
    | _ITS_LAW
)
"""The keys of a [coupling] table: the arguments of `Pair`, each way of its delay by a name of its own, and of
a `FrictionCompensation` each number."""

_ALIASES = {"virtual_damping": "damping", "follower_virtual_damping": "follower_damping"}


def option_keys() -> dict[str, Parameter]:
    """The keys under their names on the command line, where `damping` is a device's."""
    there = {key: name for name, key in _ALIASES.items()}
    return {there.get(key, key): own for key, own in KEYS.items()}


def load_pair(sources: Sequence[Path | str], overrides: Mapping[str, str] | None = None) -> Pair:
    """Read one or two devices, by file or name, or one file with [leader], [follower] and [coupling].

    The overrides are values of the coupling, as typed: {"stiffness": "100", "virtual_damping": "0.1"}.
    """
    if not sources:
        raise InputError(
            "no arm is given: name one or two devices, or a file with [leader], [follower] and [coupling]"
        )
    if len(sources) > 2:
        raise InputError(f"a pair has two arms, got {len(sources)} sources")
    files = [read_tables([source], ("device", *PAIR_TABLES)) for source in sources]
    if len(files) == 2:
        return _of_two(files, overrides or {})
    return pair_of(files[0], overrides)


def _of_two(files: Sequence[Mapping[str, Table]], overrides: Mapping[str, str]) -> Pair:
    arms = []
    for tables in files:
        other = next((table for key, table in tables.items() if key != "device"), None)
        if other is not None:
            raise InputError(f"{other.label}: a file with more than a [device] is given alone")
        arms.append(build_device(tables["device"]))
    return _joined(arms[0], arms[1], Table(COMMAND_LINE, {}), overrides)


def pair_of(tables: Mapping[str, Table], overrides: Mapping[str, str] | None = None) -> Pair:
    """The pair that the tables of one file describe."""
    arms = [tables[name] for name in ("leader", "follower") if name in tables]
    if "device" in tables and arms:
        raise InputError(
            f"{arms[0].label}: a file gives [leader] and [follower], or one [device] for both arms, not both"
        )
    if len(arms) == 1:
        missing = "follower" if "leader" in tables else "leader"
        raise InputError(
            f"{arms[0].label}: there is no [{missing}]; where both arms are alike, write one [device]"
        )
    if not arms and "device" not in tables:
        raise InputError(
            f"{tables['coupling'].label}: there is no arm beside it; add [leader] and [follower], or one "
            "[device] for both"
        )
    for name in ("leader", "follower"):
        if name in tables and not {"name", "catalogue"} & set(tables[name].values):
            tables[name].values["name"] = name
    devices = [build_device(table) for table in arms or [tables["device"]]]
    coupling = tables.get("coupling") or Table(COMMAND_LINE, {})
    return _joined(devices[0], devices[-1], coupling, overrides or {})


def _joined(leader: Device, follower: Device, coupling: Table, overrides: Mapping[str, str]) -> Pair:
    for key, value in overrides.items():
        coupling.override(key, value, instead_of=[_ALIASES[key]] if key in _ALIASES else [])
    for alias, key in _ALIASES.items():
        coupling.rename(alias, key)
    coupling.check_keys(KEYS, "a coupling")
    if "stiffness" not in coupling.values:
        needed = f"stiffness{bracketed(KEYS['stiffness'], leader.motion)}"
        if coupling.label == COMMAND_LINE:
            raise InputError(f"no spring joins the arms: set --{needed}, or write it in a [coupling] table")
        raise InputError(f"{coupling.label}: {needed} is missing: no spring joins the arms")
    given = {key: _read(coupling, key, leader.motion) for key in coupling.values}
    there = given.pop("link_delay", 0)
    back = given.pop("link_delay_back", there)
    given |= _compensations(given)
    return Pair(leader, follower, **given, delay=(there, back))


def _compensations(given: dict[str, Any]) -> dict[str, Any]:
    """Those of both sides, taken out of what was given; a number that the follower lacks is the leader's."""
    law, its = (
        {name.removeprefix(prefix): given.pop(name) for name in keys if name in given}
        for keys, prefix in ((_LAW, "compensation_"), (_ITS_LAW, "follower_compensation_"))
    )
    found = {"compensation": FrictionCompensation(**law)} if law else {}
    return found | ({"follower_compensation": FrictionCompensation(**{**law, **its})} if its else {})


def _read(table: Table, key: str, motion: str) -> Any:
    own, value = KEYS[key], table.values[key]
    with located(table.where(key)):
        if not own.is_number:
            return read(value, key, own, motion)
        number = read_number(value, own.quantity, key, bound=own.bound, why=own.why, motion=motion)
        if key in _LINKS:
            question_unit(value, number, key)
        return number


class Loaded(NamedTuple):
    """What files describe: a device, and what it renders."""

    device: Device
    environment: Environment | None
    """Behind its laws, if the files have [[law]] tables; None if they have no [environment]."""


def load(*sources: Path | str) -> Loaded | Any:
    """The device and the environment, or the pair of arms, that specifications describe.

    Parameters
    ----------
    sources
        TOML files with [device], [environment] and [[law]] tables, each in one of them; a name of the
        catalogue stands for a [device].  Or one file with a [coupling], and [leader] and [follower] or one
        [device] for both arms.

    Returns
    -------
    Loaded
        Device and environment; of a file with a [coupling], or with a [leader] and a [follower], a `Pair`.

    Raises
    ------
    InputError
        If a file cannot be read, there is no device, or a key or value cannot be used: it says which,
        where it stands and what is allowed.
    """
    if not sources:
        raise InputError("no file is given: name TOML files with a [device], or a device of the catalogue")
    tables = read_tables(sources, (*WITH_LAWS, *PAIR_TABLES))
    if joined := [tables[key] for key in PAIR_TABLES if key in tables]:
        for key in ("environment", "law"):
            if key in tables:
                raise InputError(f"{tables[key].label}: two arms meet each other, and no environment")
        if len(sources) > 1:
            raise InputError(f"{joined[0].label}: a file of two arms that follow each other is read alone")
        return pair_of(tables)
    if "environment" in tables and "device" in tables:
        keep_axis(tables["device"], tables["environment"].values)
    device, laws = specified_device(tables, {}), tables.get("law")
    if "environment" not in tables:
        if laws is not None:
            raise InputError("[[law]] stands behind an environment, and no file has an [environment] table")
        return Loaded(device, None)
    environment = build_environment(tables["environment"], device.motion)
    return Loaded(device, with_laws(environment, laws, None, device.motion))
