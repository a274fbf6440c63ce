"""From a recording of two arms that shake to the reason.

recording → the stretch that vibrates → both laws → energy of a cycle → how likely each cause → one change
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth.data.diagnosis.pairs.causes import PAIR_CAUSES, is_named, likelihoods
from zwidth.data.diagnosis.pairs.change import change_for
from zwidth.data.diagnosis.pairs.energy import PairEvidence, gather, vibrates
from zwidth.data.diagnosis.pairs.recording import ARMS, PairRecording, read_pair
from zwidth.data.diagnosis.pairs.result import PairDiagnosis
from zwidth.errors import InputError
from zwidth.model.pairs import Pair
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.text import shown

if TYPE_CHECKING:
    import xarray as xr

_REGULAR = "a stretch of ten cycles or more in which both arms shake, the hands as they were"
_DEVICE = "the numbers of both arms (damping, Coulomb friction, rate) beside the file: DEVICE"
_FORCES = "of both arms the force that is commanded and the motor's own, at every sample of the loop"
_SLOW = "the same at a smaller swing: here a motor's force changes no faster than {rate}, and cannot follow"
_PLAIN = "both arms with no force but the coupling's: without gravity compensation, away from stops"


def diagnose_pair(
    recording: str | PathLike[str] | xr.Dataset,
    pair: Pair | None = None,
    *,
    columns: Mapping[str, str | None] | None = None,
    units: Mapping[str, str] | None = None,
    scale: Mapping[str, object] | None = None,
    **reading: Any,
) -> PairDiagnosis:
    """Why did two arms shake that follow each other?  One recording of both.

    Parameters
    ----------
    recording
        A file as `read_log` reads it, or a trace of a pair: time, and of each arm position and force.  A
        column is known by `leader_` or `follower_` before a name that is known of any log.
    pair
        What is known of both arms; of its coupling nothing is taken, that is found in the recording.
    columns, units, scale
        As for `diagnose`, of both arms, or of one where the key begins with `leader_` or `follower_`.
    reading
        Further arguments of `read_log`.

    Returns
    -------
    PairDiagnosis
        The cause, how sure, the frequency, the energy of a cycle, the number to change with its verdict; or
        what to record.

    Raises
    ------
    InputError
        If an arm cannot be read, has no force, or moves otherwise than its device.
    """
    taken = read_pair(recording, columns=columns, units=units, scale=scale, **reading)
    if pair is not None and pair.motion != taken.leader.motion:
        raise InputError(
            f"{taken.source} holds {taken.leader.motion} motions and the devices are {pair.motion}: "
            "which is meant?"
        )
    found = vibrates(taken)
    if found is None:
        return _answer(taken, None, record=(_REGULAR,))
    seen = gather(taken, *found, None if pair is None else (pair.leader, pair.follower))
    likely = dict(sorted(likelihoods(seen).items(), key=lambda item: -item[1]))
    first, p = next(iter(likely.items()), ("", 0.0))
    if not is_named(first, p, seen):
        return _answer(taken, seen, likely=likely, record=tuple(_record(seen, pair)))
    change = None if pair is None else change_for(first, seen, pair)
    return _answer(
        taken, seen, cause=first, confidence=p, likely=likely, change=change,
        evidence=tuple(_evidence(first, seen)), record=(_DEVICE,) if pair is None else (),
    )  # fmt: skip


def _answer(taken: PairRecording, seen: PairEvidence | None, **other: Any) -> PairDiagnosis:
    given: dict[str, Any] = {
        "cause": None, "confidence": 0.0, "likely": {}, "evidence": (), "change": None, "record": ()
    }  # fmt: skip
    findings = [
        f"{name}: {text}" for name, arm in zip(ARMS, taken.arms, strict=True) for text in arm.findings
    ]
    vibration = None if seen is None else seen.vibration
    return PairDiagnosis(
        frequency=None if vibration is None else vibration.frequency,
        frequency_spread=None if vibration is None else vibration.frequency_spread,
        energy_per_cycle=None if seen is None else seen.energy,
        seen=seen,
        findings=tuple(findings),
        recording=taken,
        **(given | other),
    )


def _record(seen: PairEvidence, pair: Pair | None) -> Iterator[str]:
    if limits := [rate for rate in seen.rates if rate is not None]:
        yield _SLOW.format(rate=shown(min(limits), "N*m/s" if seen.rotary else "N/s", 3))
    if any(law is None for law in seen.laws) or any(delay is None for delay in seen.delays):
        yield _FORCES
    if pair is None:
        yield _DEVICE
    yield _PLAIN


def _evidence(cause: str, seen: PairEvidence) -> Iterator[str]:
    leader, follower = seen.laws
    assert leader is not None
    assert follower is not None
    units = {name: GLOSSARY[name].unit_for("rotary" if seen.rotary else "linear") for name in _UNITS}
    given = sum(max(0.0, work) for work in seen.supplied.values())
    yield f"{_TERM[cause]} gives {100 * seen.supplied[cause] / given:.0f} % of what goes in in a cycle"
    links = [law.link_delay for law in (leader, follower)]
    if cause == "link delay":
        yield (
            f"the leader acts on a reading of the other that is {shown(links[0], 's', 3)} older than its "
            f"own, the follower on one {shown(links[1], 's', 3)} older"
        )
    elif cause == "damping":
        yield (
            f"B = {shown(leader.damping, units['virtual_damping'], 3)} acts on a speed of the other arm that "
            f"is {shown(max(links), 's', 3)} old, "
            f"{np.degrees(seen.vibration.angular * max(links)):.0f} deg of the motion"
        )
    elif cause == "local damping":
        yield f"D = {shown(leader.local_damping, units['virtual_damping'], 3)} of each arm's own speed"
    elif cause == "friction compensation":
        force = shown(leader.compensation, "N*m" if seen.rotary else "N", 3)
        yield f"the force holds {force} along the motion"
    elif cause == "actuator limit":
        limited = ((arm, rate) for arm, rate in zip(ARMS, seen.rates, strict=True) if rate is not None)
        for arm, rate in limited:
            most = shown(rate, "N*m/s" if seen.rotary else "N/s", 3)
            yield f"the {arm}'s motor changes its force by no more than {most}"
    elif cause == "delay":
        late = [delay for delay in seen.delays if delay is not None]
        yield f"a force comes up to {shown(max(late, default=0.0), 's', 3)} after its arm's own reading"
    else:
        yield f"K T/2 = {shown(0.5 * leader.stiffness * seen.loop_period, units['damping'], 3)}"


_UNITS = ("stiffness", "damping", "virtual_damping")
_TERM = {name: f"the {name}" for name in PAIR_CAUSES} | {
    "sampling": "the hold of the spring",
    "damping": "the damper between the arms",
}
