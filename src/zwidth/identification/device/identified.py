"""What a log says about a device: numbers, how well they are known, and a device to check."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from scipy import stats

from zwidth.device.device import Device
from zwidth.environment.environment import Environment
from zwidth.errors import InputError
from zwidth.identification.logs import Finding
from zwidth.quantity.exact import Interval

if TYPE_CHECKING:
    import xarray as xr

MOST_CONFIDENCE = 0.999999
"""Beyond it the tails of Student's t say nothing about real data."""


class Estimate(NamedTuple):
    """A number from data.

    Parameters
    ----------
    value
        The best guess, SI units.
    error
        Its standard error, from the scatter of the strokes.
    shift
        What the method itself may be off, from how much pulses twice as long change it.
    degrees
        Degrees of freedom of Student's t.
    unit
        Of all three.
    """

    value: float
    error: float
    shift: float
    degrees: int
    unit: str

    def interval(self, confidence: float = 0.95) -> tuple[float, float]:
        """Where the truth is, this often: value ∓ (t · error + shift)."""
        reach = float(stats.t.ppf(0.5 + confidence / 2, self.degrees)) * self.error + self.shift
        return self.value - reach, self.value + reach

    def beyond(self, confidence: float) -> bool:
        """True where 0 is outside the interval."""
        low, high = self.interval(confidence)
        return low > 0 or high < 0

    def __str__(self) -> str:
        low, high = self.interval()
        return f"{self.value:.4g} {self.unit} (95 %: {low:.4g} to {high:.4g})"


@dataclass(frozen=True, kw_only=True)
class Identified:
    """A device as a log shows it.

    Parameters
    ----------
    estimates
        By parameter: damping, coulomb_friction, mass unless it was given, and what else was
        fitted: spring [N/m], quadratic [N·s²/m²], force_lag [s]; N·m and rad if rotary.
    mass
        The given one [kg; kg·m²], or None.
    sample_period, resolution
        T [s] and Δ [m; rad] of the log.
    motion
        "linear" or "rotary".
    source
        The log.
    explained
        r² of the pulses' mean forces.
    force_noise
        Standard deviation of the force, per sample, that the model leaves [N; N·m].
    offset
        Mean of what the force has besides: the sensor's zero, gravity, and half of what
        friction differs between the two directions; they cannot be told apart [N; N·m].
    viscous_alone
        Damping that a mass–damper model would be given [N·s/m; N·m·s/rad].
    pulse_length
        Time over which the equation of motion was averaged [s].
    strokes, pulses
        How many the numbers rest on.
    findings
        What a person should know.
    points
        Mean speed and friction of up to some ten thousand pulses, for pictures.
    """

    estimates: Mapping[str, Estimate]
    mass: float | None
    sample_period: float
    resolution: float
    motion: Literal["linear", "rotary"]
    source: str
    explained: float
    force_noise: float
    offset: float
    viscous_alone: float
    pulse_length: float
    strokes: int
    pulses: int
    findings: tuple[Finding, ...]
    points: xr.Dataset

    def device(self, confidence: float | None = 0.99, **others: Any) -> Device:
        """A device whose b and f_c are at least as large as stated, with this confidence for both together.

        Parameters
        ----------
        confidence
            Between 0 and 1; None: the best guesses instead of intervals.
        others
            Further arguments of `Device`, such as name or force_limit.

        Raises
        ------
        InputError
            If the confidence is no such number.
        """
        given: dict[str, Any] = {
            "sample_period": self.sample_period,
            "resolution": self.resolution,
            "motion": self.motion,
            "name": f"identified from {self.source}",
        }
        if self.mass is not None:
            given["mass"] = self.mass
        for name in ("mass", "damping", "coulomb_friction"):
            if name in self.estimates:
                given[name] = _parameter(self.estimates[name], confidence)
        return Device(**{**given, **others})

    def confidence(self, environment: Environment | Any, **others: Any) -> float:
        """For how much of what the data allow the loop is passive, at least: 0 to 0.999999.

        The largest confidence at which `check` says passive of the whole `device(confidence)`.

        Parameters
        ----------
        environment
            What the device is to render.
        others
            Further arguments of `Device`, such as delay.
        """
        from zwidth.passivity.check import check_by_closed_forms  # the game would be played at every step

        def passive(confidence: float) -> bool:
            device = self.device(confidence or None, **others)
            return check_by_closed_forms(device, environment).outcome == "passive"

        return _largest(passive)


def _parameter(estimate: Estimate, confidence: float | None) -> float | Interval:
    if confidence is None:
        return max(estimate.value, 0.0)
    if not 0 < confidence <= MOST_CONFIDENCE:
        raise InputError(
            f"confidence must be > 0 and ≤ {MOST_CONFIDENCE}, got {confidence!r}: it is how often the stated "
            "interval holds the truth; take 0.99, or None for the best guess"
        )
    low, high = estimate.interval(confidence)
    return Interval(max(low, 0.0), max(high, 0.0))


def _largest(passive: Callable[[float], bool]) -> float:
    if passive(MOST_CONFIDENCE):
        return MOST_CONFIDENCE
    if not passive(0.0):
        return 0.0
    low, high = 0.0, MOST_CONFIDENCE
    while high - low > 1e-4:
        middle = (low + high) / 2
        low, high = (middle, high) if passive(middle) else (low, middle)
    return low
