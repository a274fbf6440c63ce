"""The law that was programmed, held beside the force in the file.

    f(t) = a + g [H(z) x(t − s) − F tanh(v/v_s)],    cut off where the file's own force ends

F is a compensation of friction, where the law has one.  With g = 1 it is the law as it was stated.  A unit, a
scale or a gain that is another one shows as g; a force that follows no such line is of another law.  Where
the file holds the motor's force alone, what the law asked for is computed from the positions, and what lies
between the two can be accounted for.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple, TypeVar

import numpy as np

from zwidth.data.diagnosis import law
from zwidth.data.diagnosis.law import Law
from zwidth.errors import InputError
from zwidth.model.environment.environment import Environment
from zwidth.model.rendering.friction_compensation import FrictionCompensation
from zwidth.model.rendering.limits import Saturation
from zwidth.model.rendering.rendered import Rendered
from zwidth.quantity.exact import Exact
from zwidth.quantity.text import shown

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from zwidth.model.rendering.rendering_law import RenderingLaw
    from zwidth.native.compiled import Array

Last = TypeVar("Last", Saturation, FrictionCompensation)

FOLLOWED = 0.02
"""Share of a command's variance that its own law may leave over."""

_CLOSE = 1.1
"""A gain beyond this, or below its inverse, is another one."""

ACCOUNTED = 0.1
"""Share of a motor's force that a delay, a damper or a limit of rate behind the law may leave over."""

_BETTER = 0.25
"""Of what the stated law leaves over, what another gain must leave at most to be believed."""

_FEWEST_ROWS = 30
_OFFSETS = 48


@dataclass(frozen=True, kw_only=True)
class Stated:
    """A law as it was stated, beside a force."""

    environment: Environment
    """The law, without its compensation of friction."""
    compensation: float
    compensation_speed: float
    """F [N; N·m], 0 for none; v_s [m/s; rad/s]."""
    stiffness: float
    damping: float
    """K and B that it has by these names [N/m; N·m/rad], [N·s/m; N·m·s/rad]; 0 where it has none."""
    of_command: bool
    gain: float
    """g, 1 where the force is the law's own."""
    lag: float
    """[s] s."""
    unexplained: float
    """Share of the force's variance that the law with this gain leaves over."""
    asked: Array = field(repr=False)
    """[N; N·m] what the law as stated asks for in each row."""
    helped: Array = field(repr=False)
    """[N; N·m] what its compensation of friction is of that."""
    accounted: float = 1.0
    """Share of the motor's force that is left over by the best account of what lies between it and
    `asked`."""

    @property
    def holds(self) -> bool:
        """True where the force is taken as that of the law as stated."""
        if not self.of_command:
            return self.accounted < ACCOUNTED
        return self.gain == 1.0 and self.unexplained < FOLLOWED

    def sentences(self) -> Iterator[str]:
        """How the two differ, for people."""
        force = "the command" if self.of_command else "the motor's force"
        if self.holds and self.of_command:
            late = f", {shown(self.lag, 's', 3)} after its row" if self.lag else ""
            yield f"the command is that of the law as stated{late}, all but {shown(self.unexplained, '%', 2)}"
        elif self.holds:
            yield "the command is computed from the law as stated: the file has the motor's force alone"
        elif self.unexplained < FOLLOWED:
            yield (
                f"{force} is {self.gain:.3g} times that of the law as stated: is a unit, a scale or a gain "
                "another one? The rest is of the force in the file"
            )
        else:
            yield (
                f"{force} is not that of the law as stated, which leaves {shown(self.unexplained, '%', 2)} "
                "of it unexplained; the rest is of the force in the file"
            )

    def as_law(self, force: Array, period: float) -> Law:
        """The law in the place of one that was found; the force is the command."""
        return law.known(
            force,
            stiffness=self.stiffness,
            damping=self.damping,
            compensation=(self.compensation, self.compensation_speed, self.helped),
            lag=self.lag if self.of_command else 0.0,
            unexplained=self.unexplained if self.of_command else 0.0,
            transfer=transfer(self.environment, period),
        )


def _last(laws: list[RenderingLaw], kind: type[Last]) -> Last | None:
    """The last law, taken off, where it is of that kind."""
    last = laws.pop() if laws and isinstance(laws[-1], kind) else None
    return last if isinstance(last, kind) else None


class _Parts(NamedTuple):
    bare: Environment
    helping: FrictionCompensation | None
    limit: float
    """[N; N·m] where it is cut off; infinite where that is the device's, which shows in the file."""


def _parts(environment: Environment) -> _Parts:
    if not isinstance(environment, Rendered):
        return _Parts(environment, None, np.inf)
    laws = list(environment.laws)
    cut, helping = _last(laws, Saturation), _last(laws, FrictionCompensation)
    if laws or (helping is not None and helping.viscous):
        raise InputError(
            f"{environment.describe()}: a recording is compared with an environment, behind which may stand "
            "a friction-compensation of Coulomb friction alone and a saturation; without a law, it is looked "
            "for in the file"
        )
    limit = np.inf if cut is None or cut.limit is None else float(cut.limit.fraction)
    return _Parts(environment.environment, helping, limit)


def transfer(environment: Environment, period: float) -> tuple[Array, Array]:
    """H(z) in numbers."""
    if not environment.has_transfer_function:
        raise InputError(
            f"{environment.describe()}: a recording is compared with a law that has an H(z), as a wall has; "
            "without the law, one is looked for in the file"
        )
    h = environment.pulse_transfer_function(Fraction(period).limit_denominator(10**9))
    numerator, denominator = (np.array([float(c) for c in part]) for part in h)
    missing = denominator.size - numerator.size
    return np.concatenate([np.zeros(max(0, missing)), numerator]), denominator


def compare(
    environment: Environment,
    position: Array,
    force: Array,
    row_period: float,
    loop_period: float,
    lags: Sequence[float],
    of_command: bool,
) -> Stated:
    """Hold a law beside a force of the same rows, positive against increasing position."""
    from scipy.signal import lfilter  # scipy takes its time

    times = np.arange(position.size, dtype=np.float64) * row_period
    samples = np.arange(0.0, times[-1] + loop_period / 2, loop_period)
    bare, helping, limit = _parts(environment)
    moved = np.interp(samples, times, position)
    helped = _helped(helping, np.diff(moved, prepend=moved[0]) / loop_period)
    answer = lfilter(*transfer(bare, loop_period), moved - moved[0]) + helped
    ends = max(float(force.min()), -limit), min(float(force.max()), limit)
    spread = float(np.var(force)) or 1.0
    free = np.flatnonzero(law.free(force))

    def left(model: Array) -> float:
        return float(np.mean((force - np.clip(model, *ends)) ** 2)) / spread

    best, scaled = (np.inf, 0.0, 0.0), (np.inf, 0.0, 1.0)
    for lag in lags:
        asked = np.interp(times - lag, samples, answer)
        for offset in _offsets(asked, force, free):
            best = min(best, (left(asked + offset), lag, offset))
        if free.size >= _FEWEST_ROWS and np.ptp(asked[free]):
            gain, offset = np.polyfit(asked[free], force[free], 1)
            if gain > 0:
                scaled = min(scaled, (left(gain * asked + offset), lag, float(gain)))
    other = scaled[0] < _BETTER * best[0] and not 1 / _CLOSE < scaled[2] < _CLOSE
    unexplained, lag, gain = scaled if other else (*best[:2], 1.0)
    return Stated(
        environment=bare,
        compensation=_number(helping, "coulomb"),
        compensation_speed=_number(helping, "speed"),
        stiffness=_number(bare, "stiffness"),
        damping=_number(bare, "damping"),
        of_command=of_command,
        gain=gain,
        lag=lag,
        unexplained=unexplained,
        asked=np.clip(np.interp(times, samples, answer) + best[2], *ends),
        helped=np.interp(times, samples, helped),
    )


def _helped(law: FrictionCompensation | None, speed: Array) -> Array:
    """−F tanh(v/v_s), −F sgn v where v_s is 0."""
    if law is None:
        return np.zeros_like(speed)
    slow = float(law.speed.fraction)
    return np.asarray(-float(law.coulomb.fraction) * (np.tanh(speed / slow) if slow else np.sign(speed)))


def _offsets(asked: Array, force: Array, free: NDArray[np.intp]) -> Array:
    """a to try: as the free rows have it, and for a wall that begins anywhere in the motion."""
    begins = force.min() if abs(force.min()) < abs(force.max()) else force.max()
    tried = begins - np.percentile(asked, np.linspace(0, 100, _OFFSETS))
    return np.append(tried, np.mean(force[free] - asked[free])) if free.size else tried


def _number(of: object, name: str) -> float:
    value = getattr(of, name, None)
    return float(value.fraction) if isinstance(value, Exact) else 0.0
