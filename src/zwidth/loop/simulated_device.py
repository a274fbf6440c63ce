"""A simulated device to step: a force in, a position out, once a sample, from a law of one's own.

The steps are those of `simulate`, and nothing beside them: the force that is given stands in the memory of a
section H(z) = 0 of first order, which adds it to nothing and forgets it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from zwidth.errors import InputError
from zwidth.loop.law import PHASE, RESOLUTION, measured
from zwidth.loop.plant import FAULT, POSITION, STOPS, TOO_MANY_STOPS, VELOCITY
from zwidth.loop.setup import empty_record, prepare
from zwidth.loop.simulate import run_samples
from zwidth.loop.timing import Timing
from zwidth.loop.trace import build_trace
from zwidth.model.device.amplifier import Amplifier
from zwidth.model.device.device import Device
from zwidth.model.environment.environment import Environment, RationalFunction
from zwidth.model.operator.operator import Operator
from zwidth.model.rendering.bounding import ForceBounding
from zwidth.model.rendering.rendered import Rendered
from zwidth.quantity.exact import RealLike
from zwidth.quantity.parameter import read_number
from zwidth.quantity.text import shown

if TYPE_CHECKING:
    import xarray as xr

_GIVEN = 0
"""Where in the memory the force stands."""

_UNKNOWN = "what a force law of your own holds at the start is not known: say it, stored_at_start"


class SimulatedDevice:
    """``m ẍ = f_h − f_a − f_c sgn ẋ − b ẋ``, stepped sample by sample, with your force as the law.

    A simulation of one hand, never a proof about others.  Sample k gives a reading, `measured_position`;
    `step` takes the force for it, holds it as the device does (converter steps, force limit, delay,
    amplifier), moves the device exactly to sample k + 1 and returns what is read there.  There is a force
    for each of the samples 0 … N; that of the last one comes too late to move anything.

    Parameters
    ----------
    device, operator, duration, initial_position, initial_velocity, encoder_phase, amplifier, timing
        As of `zwidth.simulate`. At a sample that `timing` lets be missed the force before stays, and the one
        that is given is not used.
    points_per_sample
        Instants recorded per sample, as of `zwidth.simulate`.
    bounding
        `ForceBounding` behind your force, which then makes the loop passive whatever the force is, on its own
        hypotheses; by default none.
    stored_at_start
        The most that your law may give out from where the touch starts, ≥ 0 [J]: 0 for one that is at rest
        there, outside of everything. None: not known, and then no touch is called active.

    Raises
    ------
    InputError
        As `zwidth.simulate`, or if one of the last two is not of its kind.

    Attributes
    ----------
    samples
        N, the whole samples of the duration.
    """

    def __init__(
        self,
        device: Device,
        operator: Operator,
        duration: RealLike,
        *,
        initial_position: RealLike | None = None,
        initial_velocity: RealLike = 0.0,
        encoder_phase: float = 0.0,
        amplifier: Amplifier | None = None,
        timing: Timing | None = None,
        points_per_sample: int = 1,
        bounding: ForceBounding | None = None,
        stored_at_start: RealLike | None = None,
    ) -> None:
        if bounding is not None and not isinstance(bounding, ForceBounding):
            raise InputError(
                f"bounding is a zwidth.rendering.ForceBounding or None, got {type(bounding).__name__}: other "
                "laws look at the environment, and are yours to compute"
            )
        self._stored = None
        if stored_at_start is not None:
            why = "it is the most that is held"
            self._stored = float(
                read_number(stored_at_start, "energy", "stored_at_start", bound="≥ 0", why=why)
            )
        law = _GivenForce()
        self._setup = prepare(
            device,
            law if bounding is None else Rendered(law, (bounding,)),
            operator,
            duration,
            initial_position=initial_position,
            initial_velocity=initial_velocity,
            encoder_phase=encoder_phase,
            amplifier=amplifier,
            timing=timing,
            points_per_sample=points_per_sample,
        )
        self._commands, self._record, self._work = empty_record(self._setup.frame)
        self._state, self._memory = self._setup.state.copy(), self._setup.memory.copy()
        self._done = 0
        self.samples = self._setup.frame.samples

    @property
    def finished(self) -> bool:
        """True when each of the samples 0 … N has its force."""
        return self._done > self.samples

    @property
    def time(self) -> float:
        """When the sample is taken whose force is wanted next [s]."""
        return float(self._setup.frame.times[min(self._done, self.samples)])

    @property
    def position(self) -> float:
        """x now, as it is [m; rad], positive inside the wall."""
        return float(self._state[POSITION])

    @property
    def velocity(self) -> float:
        """ẋ now, as it is [m/s; rad/s]."""
        return float(self._state[VELOCITY])

    @property
    def measured_position(self) -> float:
        """x_m, what the encoder reads now [m; rad]."""
        law = self._setup.law
        return float(measured(self._state[POSITION], law[RESOLUTION], law[PHASE]))

    def step(self, force: float) -> float:
        """Give the force of this sample and move to the next; returns what is read there.

        Parameters
        ----------
        force
            Positive out of the wall, as −K x of a hand that is pressed back [N; N·m].

        Returns
        -------
        float
            `measured_position` [m; rad].

        Raises
        ------
        InputError
            If the force is not finite, or all samples have theirs.
        """
        if self.finished:
            raise InputError(
                f"all {self.samples + 1} samples have their force: take a longer duration, or ask `finished`"
            )
        self._memory[_GIVEN] = _number(force, f"the force at {shown(self.time, 's', 6)}", "N")
        first = self._done
        run_samples(
            self._setup, first, first + 1, self._state, self._memory, self._work, self._commands, self._record
        )
        if self._state[FAULT] != 0.0:
            raise InputError(TOO_MANY_STOPS)
        self._done += 1
        return self.measured_position

    def run(self, force: Callable[[float], float]) -> xr.Dataset:
        """Step to the end, and give the trace.

        Parameters
        ----------
        force
            Called with `measured_position` once a sample; returns the force [N; N·m]. It may keep a state.

        Raises
        ------
        InputError
            As `step`.
        """
        while not self.finished:
            self.step(force(self.measured_position))
        return self.trace()

    def trace(self) -> xr.Dataset:
        """What happened up to the last sample that has its force, as `zwidth.simulate` returns it.

        Raises
        ------
        InputError
            If no sample has its force yet.
        """
        if not self._done:
            raise InputError("nothing has happened yet: give the force of the first sample, step(force)")
        trace = build_trace(self._setup, self._record, self._done, stops=int(self._state[STOPS]))
        for key in ("stored_at_start_J", "stored_at_start_unknown"):
            trace.attrs.pop(key, None)
        if self._stored is None:
            trace.attrs["stored_at_start_unknown"] = _UNKNOWN
        else:
            trace.attrs["stored_at_start_J"] = self._stored
        return trace.dataset()


@dataclass(frozen=True, kw_only=True)
class _GivenForce(Environment):
    """H(z) = 0/z, whose memory is filled from outside."""

    @property
    def linear(self) -> bool:
        """False: H(z) says nothing about it."""
        return False

    def pulse_transfer_function(self, sample_period: Fraction) -> RationalFunction:
        """0/z: of first order, so that there is a memory."""
        return RationalFunction((Fraction(0), Fraction(0)), (Fraction(1), Fraction(0)))

    def describe(self, motion: str = "linear") -> str:
        """In words."""
        return "a force given sample by sample"


def _number(value: object, what: str, unit: str) -> float:
    try:
        number = float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        raise InputError(f"{what} is a number [{unit}], got {value!r}") from None
    if not np.isfinite(number):
        raise InputError(f"{what} must be finite [{unit}], got {number}")
    return number
