"""What a log says about a finger, and what takes it: a hand to simulate, laws that look ahead."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

from zwidth.data.identification.device.estimate import Estimate
from zwidth.data.logs import Finding
from zwidth.errors import InputError
from zwidth.model.operator.fingers import Finger


@dataclass(frozen=True, kw_only=True)
class IdentifiedFinger:
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
