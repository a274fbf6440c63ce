"""From a recording of two arms that shake to the reason, how sure it is, and what to change.

recording → the stretch that vibrates → both laws → energy of a cycle → how likely each cause → one change
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth.data.diagnosis.causes import SURE
from zwidth.data.diagnosis.pairs.change import PairChange, change_for
from zwidth.data.diagnosis.pairs.energy import PAIR_CAUSES, PairEvidence, gather, vibrates
from zwidth.data.diagnosis.pairs.recording import ARMS, PairRecording, read_pair
from zwidth.data.diagnosis.result import Answer, key_with_unit, rows_of_energy, rows_of_likely
from zwidth.data.diagnosis.vibration import nothing
from zwidth.errors import InputError
from zwidth.lazy import above
from zwidth.model.pairs import Pair
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.text import shown

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure


@dataclass(frozen=True, kw_only=True, repr=False)
class PairDiagnosis(Answer[PairChange, PairEvidence, PairRecording]):
    """Why two arms shook that follow each other: `cause` is one of `zwidth.data.diagnosis.PAIR_CAUSES`, or
    None where the data do not say, and `confidence` how often such a finding is right, among simulated pairs
    that shake for one reason."""

    @property
    def claim(self) -> str:
        """The answer in one sentence."""
        if self.seen is None:
            return nothing(self.recording.follower.time)
        at = f"{shown(self.frequency, 'Hz', 3)}"
        if self.cause is None:
            return f"Both arms shake at {at}; the data do not say why."
        return f"Both arms shake at {at} because {PAIR_CAUSES[self.cause]}."

    def rows(self) -> Iterator[tuple[str, str]]:
        """Every number that was measured, with its name."""
        if (seen := self.seen) is None:
            return
        v = seen.vibration
        length = "rad" if seen.rotary else "m"
        yield "frequency", f"{shown(v.frequency, 'Hz', 4)} ± {shown(v.frequency_spread, 'Hz', 2)}"
        for arm, size in zip(ARMS, seen.amplitudes, strict=True):
            yield f"{arm} swings", f"± {shown(size, length, 3)}"
        yield from rows_of_energy(seen.energy, seen.supplied, seen.lost)
        for arm, law in zip(ARMS, seen.laws, strict=True):
            if law is not None:
                yield f"{arm}: stiffness", shown(law.stiffness, _unit("stiffness", seen), 4)
                yield f"{arm}: link delay", shown(law.link_delay, "s", 3)
                yield f"{arm}: explained", shown(1 - law.unexplained, "%")
        yield from rows_of_likely(self.likely)

    def _measured(self, seen: PairEvidence) -> dict[str, Any]:
        document: dict[str, Any] = {
            "sample_period_s": seen.loop_period,
            "supplied_J": dict(seen.supplied),
            "friction_takes_J": seen.lost,
        }
        stiffness, damping = (
            key_with_unit(name, _unit(name, seen)) for name in ("stiffness", "virtual_damping")
        )
        for k, (arm, law) in enumerate(zip(ARMS, seen.laws, strict=True)):
            document[arm] = {
                f"amplitude_{'rad' if seen.rotary else 'm'}": seen.amplitudes[k],
                "delay_s": seen.delays[k],
                "law": None
                if law is None
                else {
                    stiffness: law.stiffness,
                    damping: law.damping,
                    f"local_{damping}": law.local_damping,
                    key_with_unit("compensation", "N*m" if seen.rotary else "N"): law.compensation,
                    "link_delay_s": law.link_delay,
                    "unexplained": law.unexplained,
                },
            }
        return document

    def _written(self, change: PairChange) -> str:
        from zwidth.model.specification.write import written_pair

        return written_pair(change.pair)

    def _figure(self) -> Figure:
        figure: Figure = above("plots").pair_figure(self.recording, self.seen, self.claim)
        return figure


def _unit(name: str, seen: PairEvidence) -> str:
    return GLOSSARY[name].unit_for("rotary" if seen.rotary else "linear")


# How likely each reason is for two arms to shake.
#
# The energy of a cycle comes apart into terms W_i (`energy`), and
#
#     p_i = W_i^γ / Σ_j W_j^γ        over what they give beyond what pays for them
#
# with γ fitted to simulated pairs that shake for one reason (`benchmarks/diagnosis_pairs.py`).  Viscous
# friction and terms that take pay for what grows with the square of the motion, Coulomb friction pays for its
# compensation, as far as the devices are known; p is the mean over what an owner may be wrong by.  Where
# nothing is left over, something that is not in the file feeds the motion, and nothing is named.

STEEPNESS = 6.1
"""γ."""

STATED = (0.85, 1.0, 1.15)
"""What friction takes, over what the stated numbers say: owners may be wrong by so much."""

MOST_UNEXPLAINED = 0.01
"""Share of a force's variance that its law may leave over."""

_DRY = "friction compensation"


def likelihoods(seen: PairEvidence) -> dict[str, float]:
    """p of each cause, the mean over what friction may take; empty where no term ever gives more."""
    mean = dict.fromkeys(PAIR_CAUSES, 0.0)
    for viscous in STATED:
        for dry in STATED:
            gives = _beyond(seen, viscous, dry)
            most = max(gives.values())
            if most > 0:
                odds = {name: (max(0.0, work) / most) ** STEEPNESS for name, work in gives.items()}
                for name, p in odds.items():
                    mean[name] += p / sum(odds.values()) / len(STATED) ** 2
    return mean if any(mean.values()) else {}


MOST_BEHIND = 0.1
"""Share of a motor's force that a delay or a limit of rate behind its command may leave over."""


def is_named(cause: str, p: float, seen: PairEvidence) -> bool:
    """Whether a cause is likely enough and the file shows it.  Where a motor cannot follow, how much that
    gives depends on how far the arms swing: what else gives more at this swing is not named then."""
    limited = any(rate is not None for rate in seen.rates)
    alone = not limited or cause == "actuator limit"
    return p >= SURE and alone and seen.behind < MOST_BEHIND and followed(seen)


def followed(seen: PairEvidence) -> bool:
    """Whether both forces are known as laws of both arms, and nothing unseen need feed the motion: the forces
    of the motors are in the file, or at least it is known what friction takes."""
    known = all(law is not None and law.unexplained < MOST_UNEXPLAINED for law in seen.laws)
    return known and (seen.rubs is not None or None not in seen.delays)


def _beyond(seen: PairEvidence, viscous_share: float, dry_share: float) -> dict[str, float]:
    """[J] of each term beyond what pays for it: viscous friction, and the terms that take, for all that grow
    with the motion's square; Coulomb friction for the force along the motion."""
    viscous, dry = seen.rubs or (0.0, 0.0)
    gives = {name: work for name, work in seen.supplied.items() if work > 0 and name != _DRY}
    pays = viscous_share * viscous - sum(
        work for name, work in seen.supplied.items() if work < 0 and name != _DRY
    )
    share = max(0.0, 1 - pays / sum(gives.values())) if gives else 0.0
    return {name: share * work for name, work in gives.items()} | {
        _DRY: seen.supplied[_DRY] - dry_share * dry
    }


_REGULAR = "a stretch of ten cycles or more in which both arms shake, the hands as they were"
_DEVICE = "the numbers of both arms (damping, Coulomb friction, rate): name them, or files, behind the log"
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
    virtual = _unit("virtual_damping", seen)
    given = sum(max(0.0, work) for work in seen.supplied.values())
    yield f"{_TERM[cause]} gives {shown(seen.supplied[cause] / given, '%', 2)} of what goes in in a cycle"
    links = [law.link_delay for law in (leader, follower)]
    if cause == "link delay":
        yield (
            f"the leader acts on a reading of the other that is {shown(links[0], 's', 3)} older than its "
            f"own, the follower on one {shown(links[1], 's', 3)} older"
        )
    elif cause == "damping":
        yield (
            f"B = {shown(leader.damping, virtual, 3)} acts on a speed of the other arm that "
            f"is {shown(max(links), 's', 3)} old, "
            f"{np.degrees(seen.vibration.angular * max(links)):.0f}° of the motion"
        )
    elif cause == "local damping":
        yield f"D = {shown(leader.local_damping, virtual, 3)} of each arm's own speed"
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
        yield f"K T/2 = {shown(0.5 * leader.stiffness * seen.loop_period, _unit('damping', seen), 3)}"


_TERM = {name: f"the {name}" for name in PAIR_CAUSES} | {
    "sampling": "the hold of the spring",
    "damping": "the damper between the arms",
}
