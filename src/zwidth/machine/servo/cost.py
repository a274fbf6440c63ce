"""What lateness costs in stiffness: the largest passive wall at the nominal period, and at a later one.

A step that begins L late holds the force before it for T + L.  The certificates are of a period that does
not vary; the loop whose every period is T + L is one of them, and is what is compared here.  Where the loop
is held up after it has read the position, its force comes L later as well: delay + L.  Both are figures to
judge a machine by, no proof for the served loop.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import inf
from typing import Any

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.passivity.corners import worst_corners
from zwidth.passivity.parameter_limits import has_stiffness, max_stiffness
from zwidth.quantity.exact import Exact, Interval, ends
from zwidth.quantity.glossary import unit_suffix
from zwidth.quantity.text import in_unit
from zwidth.showing import Table

_DIGITS = 9
"""Of seconds: the clock counts nanoseconds."""


@dataclass(frozen=True)
class StiffnessCost:
    """The largest stiffness that is proved passive, all else as given [N/m; N·m/rad].

    inf if every stiffness is, None if none is.
    """

    nominal: float | None
    longer_period: float | None
    """With T + L."""
    later_force: float | None
    """With T + L, and delay + L."""
    lateness: float
    """L [s]."""
    contact: str
    """Of which the proofs are: "made and broken" or "kept"."""
    unit: str

    def to_dict(self) -> dict[str, Any]:
        """The three, a unit in every key; null for none, and for any stiffness."""
        key = f"max_stiffness_{unit_suffix(self.unit)}"
        told = {"nominal": self.nominal, "longer_period": self.longer_period, "later_force": self.later_force}
        return {
            "lateness_s": self.lateness,
            "contact": self.contact,
            key: {name: None if value == inf else value for name, value in told.items()},
            "any_stiffness": [name for name, value in told.items() if value == inf],
        }

    def table(self) -> Table:
        """A row for each."""
        late = f"{1e3 * self.lateness:.3g} ms"
        values = {
            "as given": self.nominal,
            f"every period longer by {late}": self.longer_period,
            f"and every force later by {late}": self.later_force,
        }
        rows = [(name, in_unit(value, self.unit)) for name, value in values.items()]
        return Table(rows=rows, caption=f"largest passive stiffness, contact {self.contact}")


def stiffness_cost(device: Device, environment: Environment, lateness: float) -> StiffnessCost:
    """The largest passive stiffness without and with a lateness.

    Parameters
    ----------
    device, environment
        As for `zwidth.check`.
    lateness
        L [s].
    """
    if not has_stiffness(environment):
        raise InputError(
            f"what lateness costs is told in stiffness, and {environment.describe(device.motion)} has none: "
            "name a wall"
        )
    by = Fraction(round(lateness * 10**_DIGITS), 10**_DIGITS)
    longer = device.replace(sample_period=_more(device.sample_period, by))
    loops = (device, longer, longer.replace(delay=_more(device.delay, by)))
    contact, found = "made and broken", [_largest(each, environment, True) for each in loops]
    if None in found:  # what is proved while contact is kept compares better than what is not proved at all
        contact, found = "kept", [_largest(each, environment, False) for each in loops]
    nominal, longer_period, later_force = found
    unit = device.unit("stiffness")
    return StiffnessCost(nominal, longer_period, later_force, float(by), contact, unit)


def _largest(device: Device, environment: Environment, contact: bool) -> float | None:
    worst, *others = worst_corners(device, environment)
    if others:
        raise InputError(
            "what lateness costs is told for one period, one delay and one wall, and one of them is an "
            "interval: give single values"
        )
    return max_stiffness(*worst, contact)


def _more(value: Exact | Interval, by: Fraction) -> Exact | Interval:
    low, high = ends(value)
    return Exact(low + by) if low == high else Interval(low + by, high + by)
