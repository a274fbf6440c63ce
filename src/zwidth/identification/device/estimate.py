"""A number from data, how well it is known, and the two directions of damping.

    value ∓ (t · error + shift)

t is of Student, for the degrees of freedom that the scatter of the strokes leaves.
"""

from __future__ import annotations

from typing import NamedTuple

from scipy import stats

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


class Directions(NamedTuple):
    """Damping in each direction.

    A wall takes back no more than friction takes out in the direction in which there is less of it: a hand
    may be quick that way and slow the other.  Of Coulomb friction only the mean of both directions counts,
    what it differs by does no work to and fro.

    Parameters
    ----------
    inward, outward
        b of motion into the wall, and out of it [N·s/m; N·m·s/rad].
    difference
        Half of what the first has more.
    """

    inward: Estimate
    outward: Estimate
    difference: Estimate

    @property
    def weaker(self) -> Estimate:
        """The lesser of the two."""
        return min(self.inward, self.outward, key=lambda estimate: estimate.value)

    def least(self, confidence: float) -> float:
        """Below which neither is, this often: whichever is the weaker is above its own lower end."""
        return min(self.inward.interval(confidence)[0], self.outward.interval(confidence)[0])
