"""A number from data, how well it is known, and the two directions of damping.

    value ∓ (t · error + shift)

t is of Student, for the degrees of freedom that the scatter of the strokes leaves.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

from scipy.special import stdtrit

from zwidth.data.logs import Finding
from zwidth.quantity.spoken import spoken

_UNITS = {
    "mass": ("kg", "kg m²"),
    "damping": ("N s/m", "N m s/rad"),
    "coulomb_friction": ("N", "N m"),
    "spring": ("N/m", "N m/rad"),
    "stiffness": ("N/m", "N m/rad"),
    "quadratic": ("N s²/m²", "N m s²/rad²"),
    "force_lag": ("s", "s"),
    "asymmetry": ("N s/m", "N m s/rad"),
    "quadratic_asymmetry": ("N s²/m²", "N m s²/rad²"),
    "slow": ("N", "N m"),
}
"""Of each parameter, linear and rotary."""

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
        reach = student(confidence, self.degrees) * self.error + self.shift
        return self.value - reach, self.value + reach

    def beyond(self, confidence: float) -> bool:
        """True where 0 is outside the interval."""
        low, high = self.interval(confidence)
        return low > 0 or high < 0

    def __str__(self) -> str:
        factor, unit = spoken(self.unit)
        low, high = (factor * end for end in self.interval())
        return f"{factor * self.value:.4g} {unit} (95 %: {low:.4g} to {high:.4g})"


def unit_of(parameter: str, motion: str) -> str:
    """The unit of a parameter."""
    return _UNITS[parameter][motion == "rotary"]


def student(confidence: float, degrees: int) -> float:
    """t, standard errors to either side of an interval that holds the truth this often."""
    return float(stdtrit(degrees, 0.5 + confidence / 2))


def perhaps_none(estimates: Mapping[str, Estimate], names: Iterable[str]) -> Iterator[Finding]:
    """Those of the named parameters that may be 0."""
    for name in names:
        if name in estimates and estimates[name].interval(0.95)[0] <= 0:
            word = name.replace("_", " ")
            text = f"the data do not rule out that {word} is 0: {estimates[name]}"
            yield Finding(kind=f"no {word}", text=text)


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
