"""What a diagnosis looks at: time, position, and the force as the law asked for it, as the motor gave it.

The reader of logs knows one column of the actuator's force. Here the two that a file may have are kept apart:

    commanded   what the law computed from the newest sample, before any delay
    applied     what the motor gave, from its current

because what lies between them, a delay, a limit, a damper inside the drive, is among the causes.  Where the
file has the position that was aimed at, the law is of the error, and a target that moves is seen to.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from os import PathLike
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from zwidth.data.logs import Log
from zwidth.data.logs.columns import is_target, role_of_force
from zwidth.data.logs.read import log_of, opened
from zwidth.data.logs.survey import Still
from zwidth.data.logs.table import LEFT_OUT, Block, Motion, Table, listed, whole_runs
from zwidth.errors import InputError
from zwidth.quantity.text import shown

if TYPE_CHECKING:
    import xarray as xr

    from zwidth.native.compiled import Array

COMMANDED = "commanded_force"
"""The key of the law's own force among `columns`, `units` and `scale`."""

TARGET = "target_position"
"""The key of the position that the law aims at."""

MOST_SAMPLES = 400_000
"""Looked at, of the longest run: the last ones."""


@dataclass(frozen=True, kw_only=True)
class Recording:
    """One run without a gap, in SI units."""

    source: str
    motion: Motion
    period: float
    """[s] between two rows; the loop's own sample period may be another."""
    resolution: float
    """[m; rad] step of the encoder, 0 where none is seen."""
    time: Array
    position: Array
    """[s], [m; rad]."""
    commanded: Array | None
    applied: Array | None
    """[N; N·m] positive against increasing position, as a spring pushes; None where there is no such
    column."""
    findings: tuple[str, ...]
    """What was odd in the file, and what was supposed."""
    target: Array | None = None
    """[m; rad] the position that the law aims at; None where there is no such column."""


def read(
    recording: Log | str | PathLike[str] | xr.Dataset,
    *,
    columns: Mapping[str, str | None] | None = None,
    units: Mapping[str, str] | None = None,
    scale: Mapping[str, object] | None = None,
    **reading: Any,
) -> Recording:
    """Read whatever holds a recording; see `zwidth.diagnose`."""
    if isinstance(recording, Log):
        if columns or units or scale or reading:
            raise InputError("a log has been read already: give columns, units and scale to read_log")
        return _recording(recording, None, recording, ())
    sheet = reading.pop("sheet", None)
    told = Told(dict(columns or {}), units or {}, scale or {}, reading)
    names: list[str] = []
    try:
        if not isinstance(recording, str | PathLike):
            names = [str(name) for name in recording.variables]
            return _read(names, "the Dataset", lambda **given: Log.from_arrays(recording, **given), told)
        with opened(recording, sheet, columns) as table:
            names = list(table.units)
            return read_of_table(table, told)
    except _Forceless as error:
        raise InputError(f"{error}{_two_arms(names)}") from None


class _Forceless(InputError):
    """No one column is the actuator's force: there may be two arms."""


class Told(NamedTuple):
    """What is said of a file, as of `read_log`; `reading` is all that goes on to it as it is."""

    columns: Mapping[str, str | None]
    units: Mapping[str, str]
    scale: Mapping[str, object]
    reading: Mapping[str, Any]

    def arguments(
        self, columns: Mapping[str, str | None], own: Callable[[Mapping[str, Any]], dict[str, Any]]
    ) -> dict[str, Any]:
        """To read a log of these columns, with what its own is of the units and of the scales."""
        tables = {"units": own(self.units), "scale": own(self.scale)}
        return {"columns": columns, **{k: table for k, table in tables.items() if table}, **self.reading}


def read_of_table(table: Table, told: Told) -> Recording:
    """The same of the table of a file that is open."""
    given = table.means.get("actuator_force")
    told = told._replace(columns=({} if given is None else {"actuator_force": given}) | dict(told.columns))
    return _read(list(table.units), table.source, lambda **given: log_of(table, **given), told)


def _read(names: list[str], source: str, log: Callable[..., Log], told: Told) -> Recording:
    """A log for each force that there is, of the same rows."""
    roles = _roles(names, source, told.columns)
    if not roles:
        raise _Forceless(
            f"{source}: no column is known to be the actuator's force, and without it nobody can say where "
            f'the energy of a vibration comes from; say which with columns={{"{COMMANDED}": …}} for what the '
            'law asks for, or columns={"actuator_force": …} for what the motor gives; there are '
            f"{', '.join(names)}{without_effort(names)}"
        )
    logs = {role: log(**_arguments(role, column, told)) for role, column in roles.items()}
    target, of_target = _target(names, log, told)
    first = next(iter(logs.values()))
    supposed = tuple(
        f'"{column}" is taken as the force that the law asked for'
        for role, column in roles.items()
        if role == "force"
    )
    asked, given = logs.get(COMMANDED) or logs.get("force"), logs.get("actuator_force")
    return _recording(first, asked, given, (*supposed, *of_target), target)


def _target(
    names: list[str], log: Callable[..., Log], told: Told
) -> tuple[Log | float | None, tuple[str, ...]]:
    """The log whose position is that of the target, or where it stands still, and what is said of it."""
    columns = told.columns
    likely = [name for name in names if is_target(name) and name not in columns.values()]
    if TARGET not in columns and len(likely) > 1:
        return None, (f'{listed(likely)} may each be the target: say which with columns={{"{TARGET}": …}}',)
    column = columns[TARGET] if TARGET in columns else next(iter(likely), None)
    if column is None:
        return None, ()
    chosen = {k: v for k, v in columns.items() if k not in (COMMANDED, TARGET)}
    chosen |= {"position": column, "actuator_force": None, "hand_force": None}

    def own(table: Mapping[str, Any]) -> dict[str, Any]:
        position = table.get(TARGET, table.get("position"))
        time = {k: v for k, v in table.items() if k == "time"}
        return time if position is None else {**time, "position": position}

    try:
        return log(**told.arguments(chosen, own)), (f'"{column}" is taken as the position that is aimed at',)
    except Still:
        return 0.0, (f'"{column}", the position that is aimed at, stands still',)
    except InputError as error:
        if TARGET in columns:
            raise
        return None, (f'"{column}" may be a target and is left out: {error}',)


def _roles(names: list[str], source: str, wanted: Mapping[str, str | None]) -> dict[str, str]:
    """The column of each force: as the user said, or as it is called; "force" of one that might be either."""
    found: dict[str, list[str]] = {}
    for name in names:
        if name not in wanted.values() and (role := role_of_force(name)) is not None:
            found.setdefault(role, []).append(name)
    roles: dict[str, str] = {}
    for role in (COMMANDED, "actuator_force"):
        if role in wanted:
            column = wanted[role]
            if column is not None:
                roles[role] = column
        elif len(found.get(role, ())) == 1:
            roles[role] = found[role][0]
        elif found.get(role) and not any(wanted.get(other) for other in (COMMANDED, "actuator_force")):
            raise _Forceless(
                f"{source}: {', '.join(found[role])} may each be the {role.replace('_', ' ')}; "
                f'say which with columns={{"{role}": "{found[role][0]}"}}'
            )
    if not roles and len(found.get("force", ())) == 1:
        roles["force"] = found["force"][0]
    return roles


_SIDES = (("left", "right"), ("action", "observation"))
"""Names of two arms that do not say which of them leads."""


def _two_arms(names: list[str]) -> str:
    """What to do where there may be two arms in a file."""
    several = any(all(any(side in name.lower() for name in names) for side in pair) for pair in _SIDES)
    return (
        ". If these are two arms, one following the other, say whose each is: "
        'columns={"leader_position": …}, columns={"follower_position": …}, and the forces alike'
        if several
        else ""
    )


def without_effort(names: Iterable[str]) -> str:
    """What can be done with an episode of LeRobot that has no effort, behind a message that asks for one."""
    return (
        ". An episode of LeRobot without efforts cannot be diagnosed: record the motors' currents beside it, "
        "or have its gains proved without a recording, by zwidth gains FILE"
        if any(name.startswith("observation.state") for name in names)
        else ""
    )


def _arguments(role: str, column: str, told: Told) -> dict[str, Any]:
    """How to read the log in which the actuator's force is that column."""
    chosen = {k: v for k, v in told.columns.items() if k not in (COMMANDED, TARGET)}
    key = COMMANDED if role == "force" else role

    def own(table: Mapping[str, Any]) -> dict[str, Any]:
        others = (COMMANDED, TARGET, "actuator_force", "hand_force")
        kept = {k: v for k, v in table.items() if k not in others}
        return kept | ({"actuator_force": table[key]} if key in table else {})

    return told.arguments({**chosen, "actuator_force": column, "hand_force": None}, own)


def _recording(
    log: Log,
    commanded: Log | None,
    applied: Log | None,
    supposed: tuple[str, ...],
    target: Log | float | None = None,
) -> Recording:
    if log is applied and "actuator_force" not in log.channels:
        raise InputError(
            f"{log.source} holds no force of the actuator, and without it nobody can say where the energy "
            'of a vibration comes from; read it with columns={"actuator_force": …}'
        )
    longest = _longest(log)
    if log.runs > 1:
        looked = f"run {longest.run + 1} of {log.runs} is looked at, the longest: {LEFT_OUT}"
        if any(finding.kind == "episodes" for finding in log.findings):
            looked += '; sheet="0" and so on chooses an episode'
        supposed = (looked, *supposed)
    own = [None if each is None else _longest(each) for each in (commanded, applied)]
    rows = [f"{block.time.size} rows from {shown(block.time[0], 's')}" for block in own if block is not None]
    if len(set(rows)) > 1:
        raise InputError(_APART.format(*rows))
    asked, given = (None if block is None else block.actuator_force for block in own)
    if asked is not None and given is not None and _against(asked, given):
        given = -given
        supposed = (*supposed, _AGAINST)
    return Recording(
        source=log.source,
        motion=log.motion,
        period=log.sample_period,
        resolution=log.resolution,
        time=longest.time,
        position=longest.position,
        commanded=asked,
        applied=given,
        findings=(*supposed, *(finding.text for finding in log.findings if finding.kind != "no hand force")),
        target=None if target is None else _at(longest, log.runs, target),
    )


def _at(run: Block, runs: int, target: Log | float) -> Array:
    """[m; rad] the target in a run, of so many, with each of which time may start again: rows that one column
    lacks are not missing in another.  Where it stands does not count."""
    if not isinstance(target, Log):
        return np.full_like(run.time, target)
    blocks = [block for block in target.blocks() if target.runs != runs or block.run == run.run]
    known = np.concatenate([block.time for block in blocks])
    return np.asarray(np.interp(run.time, known, np.concatenate([block.position for block in blocks])))


_APART = (
    "the two forces are not recorded side by side: the longest stretch without a gap has {} of the command "
    "and {} of the motor's force, and what lies between them is found row by row; record both at every "
    'sample, or leave the sparser one out: columns={{"actuator_force": None}}, '
    'columns={{"commanded_force": None}}'
)

_AGAINST = "the motor's force is the command with the other sign: both are taken to count alike"
_ALIKE = 0.1
"""Share of its variance by which a force may differ from the other's negative."""


def _against(asked: Array, given: Array) -> bool:
    """Whether one of two forces counts the other way."""
    spread = float(np.var(given))
    return bool(spread and np.var(given + asked) < _ALIKE * spread)


def _longest(log: Log) -> Block:
    run = max(whole_runs(log.blocks()), key=lambda block: block.time.size)
    return run.part(slice(-MOST_SAMPLES, None))
