"""What a log says about a finger; and what it cannot be: signs, units, forces that do not agree.

A finger is a mass on a spring and a damper, all three > 0.  Numbers below 0 are of no finger, and neither
is a stiffness a thousand times that of one: fingers and wrists have some hundred newtons per metre (500 N/m,
Gillespie & Cutkosky 1996, as told by others), a whole arm some thousands at the most.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from zwidth.data.identification.device.estimate import Estimate
from zwidth.data.identification.device.findings import Bounds
from zwidth.data.identification.finger.fit import TERMS, Fit, Lag
from zwidth.data.identification.finger.means import Pieces
from zwidth.data.logs import Finding, Log
from zwidth.errors import InputError
from zwidth.model.operator.fingers import Finger
from zwidth.quantity.text import from_to, in_words, shown
from zwidth.showing import Part, Shown, Table

BY_ACTUATOR = "stiffness by the actuator"

FINGER = Bounds(
    "finger",
    (*TERMS, BY_ACTUATOR),
    ("stiffness", BY_ACTUATOR),
    "no sign that is turned round makes a finger of it: was the force of the hand recorded late, as a load "
    "cell's filter makes it (k times the lateness is taken from the damping), is the device heavier or more "
    "damped than it is said to be, or is another force at work that is not in the log?",
)

SOFTEST, STIFFEST = 2.0, 5e4
"""Between them lies the stiffness of every finger, hand and arm [N/m]."""

APART = 2.0
"""Times by which two stiffnesses of one finger may differ while the device's friction is not known."""

USUAL = {"position": (1e-5, 0.05), "hand_force": (0.01, 100.0), "actuator_force": (0.01, 100.0)}
"""How far it goes about while a finger is shaken [m], [N]."""


def refuse_scale(log: Log, pieces: Pieces, stiffness: Estimate) -> None:
    """Refuse a stiffness that is no finger's, unless the device turns."""
    low, high = stiffness.interval()
    if log.motion == "rotary" or (high >= SOFTEST and low <= STIFFEST):
        return
    raise InputError(
        f"{log.source}: stiffness comes out as {stiffness}; that of fingers, hands and arms is "
        f"{from_to(SOFTEST, STIFFEST, 'N/m')}: {_ranges(pieces)}; most likely a unit is off "
        'by 1000, mm read as m or mN as N: state it with units={"position": "mm"}, or with scale'
    )


def _ranges(pieces: Pieces) -> str:
    """How far each column goes, the unlikely ones named."""
    columns = {"position": pieces.position, "hand_force": pieces.hand, "actuator_force": pieces.actuator}
    said = []
    for name, values in columns.items():
        if values is None:
            continue
        size = float(np.median(np.ptp(values, axis=1)))
        least, most = USUAL[name]
        odd = "" if least <= size <= most else ", which is unlikely"
        unit = "m" if name == "position" else "N"
        said.append(f"the {name.replace('_', ' ')} goes over {shown(size, unit, 3)} in a piece{odd}")
    return ", ".join(said)


def refuse_disagreement(log: Log, hand: Estimate, actuator: Estimate, friction_known: bool) -> None:
    """Refuse two forces that are not of one finger, by its stiffness by each. Where the device's Coulomb
    friction is not known, it was left out of the second."""
    apart = 1.0 if friction_known else APART
    (low, high), (least, most) = hand.interval(0.999), actuator.interval(0.999)
    if low <= apart * most and least <= apart * high:
        return
    raise InputError(
        f"{log.source}: the two forces are not of one finger: its stiffness is {hand} by the hand's force "
        f"and {actuator} by the actuator's: a unit or a scale is not as stated, the load cell is at "
        "the end of its range, or something else pushes too; check both with a known weight, or leave one "
        'out with columns={"hand_force": None} and the device given'
    )


class LoadCellError(InputError):
    """The load cell is not to be believed; the actuator's force may still tell the finger."""


def late(log: Log, lag: Lag) -> LoadCellError:
    """What is said of a load cell that is late."""
    return LoadCellError(
        f"{log.source}: the force of the hand is recorded late, by "
        f"{from_to(lag.least, lag.most, 's', 2)}: a late force takes damping and mass from the finger; give "
        "the device and log the actuator's force, which tell the finger without the load cell; or take the "
        "filter of the load cell away, or shift its samples"
    )


def at_the_stop(log: Log) -> LoadCellError | None:
    """What is said where too little is left without what a load cell at its end stop says."""
    for finding in log.findings:
        if finding.kind == "saturated":
            return LoadCellError(
                f"{log.source}: {finding.text}, and what is left shows too little: shake less strongly, take "
                "a larger load cell, or give the device and log the actuator's force, which tell the finger "
                "without it"
            )
    return None


def unseen_lag(lag: Lag) -> Finding:
    """What the lag that may be there makes of the intervals."""
    return Finding(
        kind="late, or read before the step",
        text="the force of the hand shows the actuator's steps late: either it is read before them, and in "
        f"time, or it is recorded up to {shown(lag.most, 's', 2)} late; the intervals of mass and damping "
        "hold both; to know which, give the device or the actuator's delay",
    )


def widened(fit: Fit, lag: Lag | None) -> np.ndarray:
    """What a lag that may be there takes from mass, damping and stiffness. c τ of mass and k τ of damping, c
    being larger by as much: (c + k τ) τ and k τ."""
    if lag is None or not lag.seen:
        return np.zeros(len(TERMS))
    _, damping, stiffness = np.abs(fit.values)
    return np.array([(damping + stiffness * lag.most) * lag.most, stiffness * lag.most, 0.0])


def apart(hand: Estimate, actuator: Estimate) -> tuple[float, Finding] | None:
    """By how much two dampings of one finger surely differ, and the finding; None where they may not."""
    (low, high), (least, most) = hand.interval(0.999), actuator.interval(0.999)
    if low <= most and least <= high:
        return None
    finding = Finding(
        kind="dampings apart",
        text=f"damping is {hand} by the hand's force and {actuator} by the actuator's: the load cell is a "
        "little late, or the device is not as it is said to be; the intervals hold both",
    )
    return abs(hand.value - actuator.value), finding


@dataclass(frozen=True, kw_only=True, repr=False)
class IdentifiedFinger(Shown):
    """A finger as it held, for some tens of milliseconds at a time.

    Parameters
    ----------
    estimates
        Of mass, damping, stiffness, and force_lag where it is seen.
    instrument
        "perturbation" or "position", see `identify_finger`.
    explained
        r² of the pulses' mean forces, slow motion taken out.
    pulse_length
        Time over which the equation of motion was averaged [s].
    pieces, pulses
        How many the numbers rest on.
    motion
        "linear" or "rotary".
    source
        The log.
    findings
        What a person should know.
    """

    estimates: Mapping[str, Estimate]
    instrument: Literal["perturbation", "position"]
    explained: float
    pulse_length: float
    pieces: int
    pulses: int
    motion: Literal["linear", "rotary"]
    source: str
    findings: tuple[Finding, ...]

    def report(self) -> Iterator[Part]:
        """The numbers, and what a person should know."""
        yield f"A finger, of {self.pulses} pulses in {self.pieces} pieces of {self.source}:"
        yield Table(rows=[(in_words(name), str(estimate)) for name, estimate in self.estimates.items()])
        yield from map(str, self.findings)

    def finger(self, **others: Any) -> Finger:
        """A finger to simulate with, `zwidth.operators.Finger`, of the best guesses.

        Parameters
        ----------
        others
            Its further arguments, such as force or speed.

        Raises
        ------
        InputError
            If the data show no stiffness.
        """
        stiffness = self.estimates["stiffness"].value
        if not stiffness > 0:
            raise InputError(
                f"the stiffness found is not > 0: {self.estimates['stiffness']}; perturb more, or hold firmly"
            )
        return Finger(mass=self._best("mass"), damping=self._best("damping"), stiffness=stiffness, **others)

    @property
    def model(self) -> dict[str, float]:
        """What `HalfSamplePrediction`, `PoleMatched` and `CrossingCorrection` take of a finger."""
        return {f"finger_{name}": self._best(name) for name in ("mass", "stiffness", "damping")}

    def _best(self, name: str) -> float:
        return max(self.estimates[name].value, 0.0)
