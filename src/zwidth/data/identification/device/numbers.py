"""What a log says about a device: numbers, what they promise, and the device to check.

Pictures, tables and files are made from these and stand above: `Identified` has them too.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

from zwidth.data.identification.device.estimate import MOST_CONFIDENCE, Directions, Estimate
from zwidth.data.logs import Finding
from zwidth.errors import InputError
from zwidth.model.device.device import Device
from zwidth.model.device.transmission import Transmission
from zwidth.model.environment.environment import Environment
from zwidth.quantity.answered import answered
from zwidth.quantity.exact import Interval, as_parameter, ends

if TYPE_CHECKING:
    import xarray as xr

    from zwidth.data.identification.device.two_masses import TwoMasses
    from zwidth.loop.trace import Trace
    from zwidth.model.device.friction import FrictionCurve

BINS = 6
"""Of speed, each way."""


@dataclass(frozen=True, kw_only=True)
class IdentifiedNumbers:
    """A device as a log shows it."""

    _BESIDES = (
        ("format", '`"zwidth identification 1"`'),
        ("log", "`samples`, `runs`, `duration_s`, `channels`; only from the command line"),
        ("confidence", "of the intervals"),
        (
            "mass_kg, damping_N_s_per_m, coulomb_friction_N, slow_N, spring_N_per_m, force_lag_s",
            "what was fitted, `slow` what friction is more at rest: `value`, `standard_error`, "
            "`shift` (what the method may be off), `degrees_of_freedom`, `interval`",
        ),
        (
            "damping_inward_N_s_per_m, damping_outward_N_s_per_m",
            "of motion into the wall, and out of it, likewise; walls rest on the lesser",
        ),
        (
            "seen_inward_m_per_s, seen_outward_m_per_s",
            "speed that 32 strokes, or a quarter of them, went beyond: friction at higher speeds is "
            "not known",
        ),
        (
            "slope_inward_N_s_per_m, slope_outward_N_s_per_m",
            "slope of friction at the smaller of the two, likewise; no more damping is promised than "
            "its lower end",
        ),
        (
            "stiffest_by_damping_N_per_m, stiffest_by_coulomb_friction_N_per_m",
            "2b/T and 2f_c/Δ: `value`, `interval`",
        ),
        ("advice, assumptions", "how to know it better; what the numbers take for granted"),
        (
            "passive_for, check",
            "with an environment: for how much of what the data allow it is passive; the verdict at "
            "the confidence",
        ),
    )

    estimates: Mapping[str, Estimate] = answered(
        "by parameter: damping, coulomb_friction, mass unless it was given, and what else was fitted: spring "
        "[N/m], force_lag [s], and slow, what friction is more at rest [N]; N·m and rad if rotary",
        only_shown=True,
    )
    directions: Directions = answered("damping into the wall and out of it", only_shown=True)
    fastest: tuple[float, float] = answered(
        "speed that 32 strokes, or a quarter of them, went beyond, into the wall and out of it: of friction "
        "beyond it the data say nothing",
        quantity="friction_speed",
        only_shown=True,
    )
    slopes: Directions = answered(
        "slope of friction at that speed, in each direction, if friction is bent", only_shown=True
    )
    mass: float | None = answered(
        "a mass that was stated; else it is fitted", key="given_mass", quantity="mass", optional=True
    )
    sample_period: float = answered("T of the log", quantity="sample_period")
    resolution: float = answered("Δ of the log", quantity="resolution")
    motion: Literal["linear", "rotary"] = answered('"linear" or "rotary"')
    source: str = answered("the log")
    explained: float = answered("r² of the pulses' mean forces")
    force_noise: float = answered(
        "standard deviation of the force, per sample, that the model leaves", quantity="force"
    )
    offset: float = answered(
        "mean of what the force has besides: the sensor's zero, gravity, and half of what friction differs "
        "between the two directions; they cannot be told apart",
        quantity="force",
    )
    viscous_alone: float = answered("damping that a mass–damper model would be given", quantity="damping")
    pulse_length: float = answered("time over which the equation of motion was averaged", unit="s")
    strokes: int = answered("how many the numbers rest on")
    pulses: int = answered("how many of them, inside the strokes")
    findings: tuple[Finding, ...] = answered("what a person should know: `kind` and `text` of each")
    cable: TwoMasses | None = answered(
        "both sides of a cable, belt or gear that gives way; None where one mass explains the log",
        only_shown=True,
        default=None,
    )
    as_one: bool = answered(
        "True where the log cannot show whether motor and handle move as one, as a hand's or a slow one: "
        "what is promised holds if they do",
        only_shown=True,
        default=True,
    )
    seen: Trace = answered(
        "mean speed and friction of up to some ten thousand pulses, for pictures", only_shown=True
    )

    @cached_property
    def points(self) -> xr.Dataset:
        return self.seen.dataset()

    def device(self, confidence: float | None = 0.99, **others: Any) -> Device:
        """A device with less friction than the data show, f_c + b |v| at every speed that they show.

        The lower end of b is that of the direction with less damping, and no more than the lower end of the
        slope at the largest speed seen: friction may rise less, the quicker the motion.  That of f_c is what
        the friction curve of the data leaves above b |v|.  Both hold together with the stated confidence, for
        motions up to `speed`, which the device carries as its `friction_speed`.  Where friction is surely
        bent, the two are those of the line below the curve that proves the stiffest wall.

        Parameters
        ----------
        confidence
            Between 0 and 1; None: the best guesses instead of intervals.
        others
            Further arguments of `Device`, such as name or force_limit.
        """
        if self.shows("wrong model"):
            why = next(str(finding) for finding in self.findings if finding.kind == "wrong model")
            raise InputError(f"{why}; no device has them, and walls that they allow take energy out")
        given: dict[str, Any] = {
            "sample_period": self.sample_period,
            "resolution": self.resolution,
            "motion": self.motion,
            "name": f"identified from {self.source}",
        }
        if self.mass is not None:
            given["mass"] = self.mass
        if "mass" in self.estimates:
            given["mass"] = _parameter(self.estimates["mass"], confidence)
        given |= self._friction(confidence)
        given["friction_speed"] = self.speed
        if self.cable is not None:
            between: dict[str, Any] = {
                name: _parameter(each, confidence) for name, each in self.cable.between.items()
            }
            for name in ("stiffness", "handle_mass"):
                if ends(as_parameter(between[name]))[0] <= 0:
                    del between[name]  # unknown: as with the mass
            given["transmission"] = Transmission(**between)
        if "mass" in given and ends(as_parameter(given["mass"]))[0] <= 0:
            del given["mass"]  # the data do not rule out 0, which no device has; no criterion needs it
        return Device(**{**given, **others})

    @property
    def speed(self) -> float:
        """The largest speed at which the friction of both directions was seen [m/s; rad/s]."""
        return min(self.fastest)

    def least_damping(self, confidence: float) -> float:
        """The slope that friction has at least, each way and up to `speed`; 0 where it may fall."""
        if self.cable is not None:
            return self.cable.least_damping(_checked(confidence))
        if self.shows("not one mass"):
            return 0.0
        mean = self.estimates["damping"].interval(_checked(confidence))[0]
        return max(min(mean, self.directions.least(confidence), self.slopes.least(confidence)), 0.0)

    def least_coulomb_friction(self, confidence: float) -> float:
        """What friction is at least above `least_damping` times the speed, in the mean of both directions."""
        low = self.estimates["coulomb_friction"].interval(_checked(confidence))[0]
        if self.cable is not None:
            return max(low, 0.0)
        curve = self.friction_curve(confidence)
        return max(min(low, float(curve.largest_coulomb_friction(curve.largest_damping))), 0.0)

    def best_damping(self) -> float:
        """The best guess of what a wall rests on: the lesser, where directions or slopes surely differ."""
        if self.cable is not None:
            return self.cable.damping.value
        found = [self.estimates["damping"].value]
        if self.shows("damping by direction"):
            found.append(self.directions.weaker.value)
        if self.shows("bent friction"):
            found.append(self.slopes.weaker.value)
        return max(min(found), 0.0)

    def _friction(self, confidence: float | None) -> dict[str, float | Interval]:
        """Damping and, where it was fitted, Coulomb friction: best guesses, or intervals."""
        if self.cable is not None:
            own = {n: _parameter(self.estimates[n], confidence) for n in ("damping", "coulomb_friction")}
            if confidence is not None:
                ends_ = ends(as_parameter(own["damping"]))
                own["damping"] = Interval(min(float(ends_[0]), self.least_damping(confidence)), ends_[1])
            return own
        dry = "coulomb_friction" in self.estimates
        if confidence is None:
            if self.shows("bent friction"):
                return {**self._best_below(0.5)}
            names = ("coulomb_friction",) if dry else ()
            return {"damping": self.best_damping(), **{n: max(self.estimates[n].value, 0.0) for n in names}}
        low = {"damping": self.least_damping(confidence)}
        if dry:
            low["coulomb_friction"] = self.least_coulomb_friction(confidence)
        if self.shows("bent friction"):
            low = self._best_below(confidence)
        highs = {name: self.estimates[name].interval(confidence)[1] for name in low}
        return {name: Interval(end, max(highs[name], end)) for name, end in low.items()}

    def _best_below(self, confidence: float) -> dict[str, float]:
        """The line below the friction curve that proves the stiffest wall."""
        model = self.friction_curve(confidence).best(self.sample_period, self.resolution)
        return {name: float(value) for name, value in model._asdict().items()}

    def shows(self, kind: str) -> bool:
        """True where there is a finding of this kind."""
        return any(finding.kind == kind for finding in self.findings)

    def confidence(
        self, environment: Environment | Any, *, contact: str = "made and broken", **others: Any
    ) -> float:
        """For how much of what the data allow the loop is passive, at least: 0 to 0.999999.

        The largest confidence at which `check` says passive of the whole `device(confidence)`.

        Parameters
        ----------
        environment
            What the device is to render.
        contact
            As for `check`: "kept" asks about a hand that never leaves the wall.
        others
            Further arguments of `Device`, such as delay.
        """
        from zwidth.passivity.check import check_by_closed_forms  # the game would be played at every step
        from zwidth.passivity.transmission import seen_at_motor

        def passive(confidence: float) -> bool:
            device = self.device(confidence or None, **others)
            device = device if self.cable is None else seen_at_motor(device)
            return check_by_closed_forms(device, environment, contact=contact).outcome == "passive"

        return _largest(passive)

    def friction_curve(self, confidence: float = 0.95, bins: int = BINS) -> FrictionCurve:
        """A friction curve below the data: what friction is at least, in the mean of both directions.

        Its points are lower bounds of the mean friction in bins of speed, at the mean speed of each; one at
        rest, by a parabola through the slower half of the pulses.  A pair of speeds, one each
        way, makes a point, and those count that a line may touch from below.  The last chord, beyond the
        largest speed, has the slope `least_damping`.  `FrictionCurve.best` finds the model f_c + b |v|
        below it that proves the stiffest wall. Assumed are, beside `FrictionCurve.assumption`: the mass;
        and that within a bin of speed friction is nearly a parabola.

        Parameters
        ----------
        confidence
            How often all the bounds hold together, between 0 and 1.
        bins
            How many bins of speed each way, 2 or more, each with as many pulses; fewer are taken where the
            strokes are few.
        """
        from zwidth.data.identification.device.curve import curve_below

        return curve_below(self.seen, confidence, bins, self.least_damping(confidence))


def _parameter(estimate: Estimate, confidence: float | None) -> float | Interval:
    if confidence is None:
        return max(estimate.value, 0.0)
    low, high = estimate.interval(_checked(confidence))
    return Interval(max(low, 0.0), max(high, 0.0))


def _checked(confidence: float) -> float:
    if not 0 < confidence <= MOST_CONFIDENCE:
        raise InputError(
            f"confidence must be > 0 and ≤ {MOST_CONFIDENCE}, got {confidence!r}: it is how often the stated "
            "interval holds the truth; take 0.99, or None for the best guess"
        )
    return confidence


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
