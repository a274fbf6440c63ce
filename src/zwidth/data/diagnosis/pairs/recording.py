"""Both arms of one file: the columns of the leader's and of the follower's side, each read as a recording.

    leader_position_rad, follower/motor_torque, Leader angle (rad), q_follower [rad], master_torque_cmd, …

What stands before the name or behind it says whose it is; what is left is known as of any log.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth.data.diagnosis.recording import COMMANDED, Recording, Told, read_of_table, without_effort
from zwidth.data.logs.columns import recognise, role_of_force
from zwidth.data.logs.read import opened
from zwidth.data.logs.table import Table, Values, in_pieces, listed
from zwidth.errors import InputError

if TYPE_CHECKING:
    import xarray as xr

ARMS = ("leader", "follower")
_WORDS = {"leader": "leader|master", "follower": "follower|slave"}
_OF = {
    arm: re.compile(
        rf"^/?(?:{words})[_./ -]+(?=\S)|(?<=\w)[_. -](?:{words})(?=$|_\w+$|\s*[\[(])", re.IGNORECASE
    )
    for arm, words in _WORDS.items()
}
"""What says whose a column is: before its name, or behind it and before its unit."""


@dataclass(frozen=True, kw_only=True)
class PairRecording:
    """The same rows of both arms."""

    leader: Recording
    follower: Recording

    @property
    def source(self) -> str:
        return self.leader.source

    @property
    def arms(self) -> tuple[Recording, Recording]:
        return self.leader, self.follower


def holds_two_arms(
    recording: str | PathLike[str] | xr.Dataset,
    columns: Mapping[str, str | None] | None = None,
    sheet: str | None = None,
) -> bool:
    """Whether columns of both arms are in a recording, by their names or as the user says."""
    if not isinstance(recording, str | PathLike):
        return "arm" in recording.dims or _of_both(list(map(str, recording.variables)), columns)
    with opened(recording, sheet, columns) as table:
        return _of_both(list(table.units), columns)


def read_pair(
    recording: str | PathLike[str] | xr.Dataset,
    *,
    columns: Mapping[str, str | None] | None = None,
    units: Mapping[str, str] | None = None,
    scale: Mapping[str, object] | None = None,
    **reading: Any,
) -> PairRecording:
    """Both arms; keys may carry `leader_` or `follower_`, a key without is of both."""
    sheet = reading.pop("sheet", None)
    told = Told(columns or {}, units or {}, scale or {}, reading)
    if not isinstance(recording, str | PathLike):
        return _both(_of_dataset(recording), told)
    with opened(recording, sheet, columns) as table:
        return _both(table, told)


def _both(table: Table, told: Told) -> PairRecording:
    """Both arms by one clock: that of the leader's position, where each has its own."""
    columns = told.columns
    if not _of_both(list(table.units), columns):
        raise InputError(
            f"{table.source}: there are no columns of a leader and of a follower; say which with "
            'columns={"leader_position": …} and so on, or name them so'
        )
    sides = [_of_arm(table, arm, columns) for arm in ARMS]
    roles = (COMMANDED, "actuator_force")
    if not any(any(map(chosen.get, roles)) or any(map(role_of_force, own)) for own, chosen in sides):
        raise InputError(
            f"{table.source}: no column is known to be a force of either arm, and without it nobody can say "
            'where the energy of a vibration comes from; say which with columns={"leader_actuator_force": …} '
            'and columns={"follower_actuator_force": …}, or with commanded_force for what a law asks for; '
            f"there are {listed(table.units)}{without_effort(table.units)}"
        )
    original, chosen = sides[0]
    named = {**chosen, "hand_force": None, "actuator_force": None}
    named.pop("commanded_force", None)
    clock = original[recognise(dict.fromkeys(original), named, table.source)["position"]]
    return _paired(*(_arm(table, arm, clock, told) for arm in ARMS))


def _of_both(names: list[str], columns: Mapping[str, str | None] | None) -> bool:
    said = [*names, *(columns or {})]
    return all(any(_OF[arm].search(name) for name in said) for arm in ARMS)


def _of_arm(
    table: Table, arm: str, columns: Mapping[str, str | None]
) -> tuple[dict[str, str], dict[str, str | None]]:
    """The columns of one arm and of none, by their names without the arm's; those the user chose of it."""
    other = ARMS[1 - ARMS.index(arm)]
    original = {}
    for name in table.units:
        if _OF[arm].search(name):
            original[_OF[arm].sub("", name, count=1)] = name
        elif not _OF[other].search(name):
            original.setdefault(name, name)
    chosen: dict[str, str | None] = _own(columns, arm)
    original |= {name: name for name in chosen.values() if name is not None and name in table.units}
    return original, chosen


def _arm(table: Table, arm: str, clock: str, told: Told) -> Recording:
    original, chosen = _of_arm(table, arm, told.columns)

    def read(names: tuple[str, ...]) -> Iterator[tuple[Values, ...]]:
        wanted = list(dict.fromkeys((clock, *(original[name] for name in names))))
        places = [wanted.index(original[name]) for name in names]
        for piece in table.read(tuple(wanted)):
            yield tuple(piece[k] for k in places)

    view = replace(
        table, units={name: table.units[was] for name, was in original.items()}, read=read, means={}
    )
    try:
        own = Told(chosen, _own(told.units, arm), _own(told.scale, arm), told.reading)
        return read_of_table(view, own)
    except InputError as error:
        text = _NO_COLUMN.sub(f"{arm}_", str(error))
        raise InputError(f"the {arm}: {text}") from None


_NO_COLUMN = re.compile(r'(?<=columns=\{")(?=\w+": […"])')
"""Where a message asks for a column of the arm."""


def _own(given: Mapping[str, Any], arm: str) -> dict[str, Any]:
    both = {key: v for key, v in given.items() if not key.startswith(tuple(f"{each}_" for each in ARMS))}
    return both | {key.removeprefix(f"{arm}_"): v for key, v in given.items() if key.startswith(f"{arm}_")}


def _of_dataset(data: xr.Dataset) -> Table:
    columns = {"time": np.asarray(data["time"].values)}
    units: dict[str, str | None] = {"time": "s"}
    for name in ("measured_position", "commanded_force", "actuator_force"):
        for arm in ARMS:
            column = f"{arm}_{name}"
            values = data[name].sel(arm=arm) if "arm" in data.dims else data[column]
            columns[column] = np.asarray(values.values)
            units[column] = values.attrs.get("units")
    return Table(
        source="the Dataset", units=units, read=lambda names: in_pieces("the Dataset", columns, names)
    )


def _paired(leader: Recording, follower: Recording) -> PairRecording:
    if leader.motion != follower.motion:
        raise InputError(
            f"{leader.source}: a {leader.motion} leader and a {follower.motion} follower have no common "
            "spring"
        )
    if leader.time.size != follower.time.size or leader.time[0] != follower.time[0]:
        raise InputError(
            f"{leader.source}: the longest stretch without a gap is another one of the leader than of the "
            "follower; leave out rows that are not finite in either of them"
        )
    return PairRecording(leader=leader, follower=follower)
