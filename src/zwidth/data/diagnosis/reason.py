"""From a recording of a thing that shakes to the reason.

    recording → the stretch that vibrates → law, drive, energy of a cycle → how likely each cause → one change

Nothing is named that the file cannot show; then it says what to record.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth.data.diagnosis.cable import STRUCTURE, SURE_AT_LEAST, judged, move_apart
from zwidth.data.diagnosis.causes import CAUSES, follows, is_named, likelihoods
from zwidth.data.diagnosis.change import PASSIVE, Change, change_for
from zwidth.data.diagnosis.drive import Drive
from zwidth.data.diagnosis.evidence import Evidence, gather
from zwidth.data.diagnosis.pairs.recording import holds_two_arms
from zwidth.data.diagnosis.recording import Recording, read
from zwidth.data.diagnosis.result import Diagnosis
from zwidth.data.diagnosis.vibration import find
from zwidth.data.logs import Log
from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.passivity.check import check
from zwidth.quantity.text import shown

if TYPE_CHECKING:
    import xarray as xr

_REGULAR = "a stretch of ten cycles or more in which it shakes, the hand as it was"
_LAW = "the law that was programmed beside the file (stiffness, virtual damping): its force does not show it"
_DEVICE = "the device's numbers (mass, damping, Coulomb friction, rate): name it, or its file, behind the log"


def diagnose(
    recording: Log | str | PathLike[str] | xr.Dataset,
    device: Device | None = None,
    *,
    law: Environment | None = None,
    columns: Mapping[str, str | None] | None = None,
    units: Mapping[str, str] | None = None,
    scale: Mapping[str, object] | None = None,
    **reading: Any,
) -> Diagnosis:
    """Why did it shake?  One recording of a vibrating wall, wheel or joint.

    Parameters
    ----------
    recording
        A log, a file as `read_log` reads it, or a Dataset such as a trace: time, position, and the actuator's
        force: what the law asked for, what the motor gave, best both.
    device
        What is known of the device: without it no number can be checked, and fewer causes be told apart.
    law
        The law that was programmed, such as a `Wall`; it is held beside the force in the recording, and its
        numbers are those that are changed.  Without it the law is looked for in the recording.
    columns, units, scale
        As for `read_log`; `commanded_force` is the force that the law asked for, `actuator_force` the one
        that the motor gave.
    reading
        Further arguments of `read_log`.

    Returns
    -------
    Diagnosis
        The cause, how sure, the frequency, the energy of a cycle, the number to change with its verdict; or
        what to record.

    Raises
    ------
    InputError
        If the recording cannot be read, holds no force of the actuator, or moves otherwise than the device;
        or if the law has no H(z).
    """
    if (
        not isinstance(recording, Log)
        and "position" not in (columns or {})
        and holds_two_arms(recording, sheet=reading.get("sheet"))
    ):
        raise InputError(
            "there are two arms in this recording: ask zwidth.diagnose_pair, or say whose columns are meant "
            'with columns={"position": …}'
        )
    taken = read(recording, columns=columns, units=units, scale=scale, **reading)
    if device is not None and device.motion != taken.motion:
        raise InputError(
            f"{taken.source} holds a {taken.motion} motion and the device is {device.motion}: "
            "which one is meant?"
        )
    force = next(f for f in (taken.commanded, taken.applied) if f is not None)
    vibration = find(taken.position, taken.period, force)
    if vibration is None:
        return _still(taken)
    found = _named(taken, gather(taken, vibration, device, law), device)
    return found if law is None else replace(found, stated=_as_stated(found, device, law))


def _as_stated(found: Diagnosis, device: Device | None, law: Environment) -> tuple[str, ...]:
    """The law as stated beside the force, and what `check` says to the loop as stated."""
    told = None if found.seen is None else found.seen.stated
    said = [] if told is None else [*told.sentences()]
    if device is None:
        return tuple(said)
    outcome = check(device, law).outcome
    if outcome in PASSIVE:
        said.append(f"as stated the loop is {outcome.upper()}: what feeds it is not in what was stated")
    else:
        said.append(f"as stated the loop is {outcome.upper()} by itself")
    return tuple(said)


def _still(taken: Recording) -> Diagnosis:
    return Diagnosis(
        cause=None, confidence=0.0, likely={}, frequency=None, frequency_spread=None, energy_per_cycle=None,
        evidence=(), change=None, record=(_REGULAR,), seen=None, findings=taken.findings, recording=taken,
    )  # fmt: skip


def _named(taken: Recording, seen: Evidence, device: Device | None) -> Diagnosis:
    likely = dict(sorted(likelihoods(seen).items(), key=lambda item: -item[1]))
    first, p = next(iter(likely.items()))
    shown_by: tuple[str, ...] = ()
    if device is not None and move_apart(seen, device):
        seen = replace(seen, moves_as=None)  # that of one body
        cause, shown_by = judged(seen, device)
        first, p = cause or first, SURE_AT_LEAST
        likely = {first: p} if cause else likely
    else:
        piece = device is None or device.transmission is None or first != STRUCTURE
        cause = first if piece and is_named(first, p, seen) else None
    against = doubt(first, seen)
    cause = None if against is not None else cause
    change = change_for(cause, seen, device) if cause is not None and device is not None else None
    return Diagnosis(
        cause=cause,
        confidence=p if cause is not None else 0.0,
        likely=likely,
        frequency=seen.vibration.frequency,
        frequency_spread=seen.vibration.frequency_spread,
        energy_per_cycle=seen.energy,
        evidence=() if cause is None else shown_by or tuple(CAUSES[cause].evidence(seen)),
        change=change,
        record=_record(cause, likely, seen, device, change, against),
        seen=seen,
        findings=taken.findings,
        recording=taken,
    )


def _record(
    cause: str | None,
    likely: Mapping[str, float],
    seen: Evidence,
    device: Device | None,
    change: Change | None,
    against: str | None,
) -> tuple[str, ...]:
    """What would say more: what speaks against any cause, or for the likeliest what would show it."""
    if against is not None:
        return (against,)
    return () if change is not None else tuple(_wanted(cause, likely, seen, device))


def _wanted(
    cause: str | None, likely: Mapping[str, float], seen: Evidence, device: Device | None
) -> list[str]:
    """For the two likeliest, and what every diagnosis is better with."""
    if cause is not None:
        inside = cause in ("delay", "drive damping", "actuator limit")
        unseen = seen.recorded == "command" or (seen.recorded == "motor" and cause == "drive damping")
        one = cause == STRUCTURE and (device is None or device.transmission is None)
        behind = [CAUSES[cause].record] if one or (inside and unseen) else []
        return behind if device is not None else [*behind, _DEVICE]
    wanted = [CAUSES["delay"].record] if len(seen.roles) < 2 else []
    if seen.stated is None and not follows(seen):
        wanted.append(_LAW)
    if device is None:
        wanted.append(_DEVICE)
    wanted += [CAUSES[name].record for name in list(likely)[:2]]
    return list(dict.fromkeys(w for w in wanted if not w.startswith("nothing more")))[:3]


# What in a recording speaks against naming any cause from it: another kind of motion, a unit, a sensor.
#
# The probabilities are of things that shake for one reason and go on to.  What dies out, noise, the hum of
# the mains, or a column in another unit is none of these, whatever is likeliest among them.

_DIES = -0.9
"""Logarithm of the motion's size at the end of the stretch over that at its start."""

_REGULAR_ENOUGH = 0.7
"""Share of the variance in frequency and harmonics, by the degrees of freedom, that a vibration has."""

_IRREGULAR = {"velocity-weakening friction": 0.4, "differenced velocity": -np.inf, "encoder buzz": -np.inf}
"""The same of what jumps: between counts, from sample to sample, or where it sticks."""

_WANDERS = 5.0
"""Times the frequency, as far as it is known: what jumps now and then has none."""

_ANOTHER_UNIT = 100.0
_GAIN = 1.3
_ALIKE = 1e-2
"""Share of a motor's force that a multiple of its command may leave over."""

_MAINS = (50.0, 60.0, 100.0, 120.0)
"""[Hz]"""

_NEAR = 0.15
"""[Hz] of the mains, to which it is kept."""


def doubt(cause: str, seen: Evidence) -> str | None:
    """What to look at or to record before this cause is named; None where nothing speaks against it."""
    vibration = seen.vibration
    if (aimed := seen.aimed) is not None and aimed > _MOVES:
        return (
            "a stretch in which the target stands still: here it moves at the same "
            f"{shown(vibration.frequency, 'Hz', 3)}, {shown(aimed, '%', 3)} as far: the motion is commanded"
        )
    if vibration.of_force:
        return "every sample of the loop: the force jumps to and fro, and the motion in these rows does not"
    if vibration.growth < _DIES:
        return "a stretch in which it goes on: in this one it dies out by itself"
    uneven = vibration.frequency_spread > _WANDERS * vibration.frequency
    if uneven or vibration.regular_by_chance < _IRREGULAR.get(cause, _REGULAR_ENOUGH):
        return "a stretch in which it goes to and fro evenly: in this one it is more noise than vibration"
    d = seen.drive
    if d is not None and _is_multiple(d):
        return (
            f"both forces in one unit: the motor's is {d.gain:.3g} times the command, as of a scale or a "
            "motor constant that is another one"
        )
    size = 1.0 if seen.moves_as is None else abs(seen.moves_as)
    if not 1 / _ANOTHER_UNIT < size < _ANOTHER_UNIT:
        return f"units and mass once more: to move so takes {size:.2g} times the force in the file"
    if _may_be_commanded(cause, seen):
        left = 1.0 if seen.law is None else min(1.0, seen.law.unexplained)
        return (
            "the law that was programmed beside the file, and the position that it aims at where that moves "
            f"(target_position): a spring and a damper about one place leave {shown(left, '%', 2)} of the "
            "force unexplained, as in a motion that is commanded"
        )
    mains = min(_MAINS, key=lambda at: abs(at - vibration.frequency))
    if cause == "structural resonance" and abs(mains - vibration.frequency) < _NEAR:
        return f"the same with the motor off: {shown(mains, 'Hz', 3)} may be hum of the mains in a sensor"
    return None


_MOVES = 0.05
"""Of the motion, at its frequency, by which a target moves that drives it."""

_PLANNED = 8.0
"""[Hz] up to which joints are led by hands and planners, many samples a cycle."""

_SAMPLES = 20

_OF_ONE_PLACE, _OF_A_LAW = 5e-3, 0.1
"""Share of the force that the law leaves over where it aims at one place; the second is that of `follows`."""

_ALONG_A_SINE = 5e-4
"""The same of a compensation of friction: what moves along a sine takes such a force by its own friction."""

_FEEDS = 0.7
"""Share of the energy that a drive must add to be what feeds a motion, whatever asks for it."""


def _may_be_commanded(cause: str, seen: Evidence) -> bool:
    """Whether the force is so little that of a law about one place that a moving target may explain it."""
    left = 1.0 if seen.law is None else seen.law.unexplained
    in_drive = seen.recorded == "both" and cause in ("drive damping", "delay", "actuator limit")
    if in_drive and seen.supplied[cause] >= _FEEDS * abs(seen.energy):
        return False
    slow = seen.vibration.frequency < min(_PLANNED, 1 / (_SAMPLES * seen.loop_period))
    if slow and seen.aimed is None:
        return left > (_ALONG_A_SINE if cause == "friction compensation" else _OF_ONE_PLACE)
    return left > _OF_A_LAW and not (cause == "structural resonance" or in_drive)


def _is_multiple(d: Drive) -> bool:
    """Whether the motor's force is another multiple of the command, better than anything else would do."""
    other = min(d.by_delay, d.by_damper, d.by_rate)
    return d.by_gain < min(_ALIKE, other / 4) and not 1 / _GAIN < d.gain < _GAIN
