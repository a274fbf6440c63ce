"""How much a search does: work is counted in the place of time, so that it ends alike on every machine.

One unit is about what one core of an ordinary processor does in a second; what a round of values costs is
counted from the size of its grid.  A busy machine takes longer, and finds the same to the last bit.  Time may
end a search as well where a person asks for it; then it is said that it did.
"""

from __future__ import annotations

import time
from math import inf
from typing import NamedTuple

from zwidth.errors import InputError

EFFORT = 60.0
"""Of a limit, or of the available storage of one loop; about as many seconds."""


class Effort:
    """What was done so far, and when the time is over.

    `seconds`: after which it is [s]; inf: never.
    """

    def __init__(self, seconds: float = inf) -> None:
        self.spent = 0.0
        self.is_cut = False
        self._end = inf if seconds == inf else time.monotonic() + seconds

    def __call__(self) -> float:
        """What was done, as a clock would have the time; inf once the time is over."""
        return inf if self.is_late() else self.spent

    def is_late(self) -> bool:
        """Whether the time is over; where one has asked and it was, the search is cut."""
        if self._end < inf and time.monotonic() >= self._end:
            self.is_cut = True
        return self.is_cut

    def spend(self, work: float) -> None:
        """So much more was done."""
        self.spent += work


class Until(NamedTuple):
    """How far a part of a search may go."""

    effort: Effort  # that of the whole
    most: float  # of it, when this part has to end

    @property
    def is_over(self) -> bool:
        """Whether it has to end."""
        return self.effort() >= self.most


def freely() -> Until:
    """As far as it goes."""
    return Until(Effort(), inf)


def checked_effort(effort: float) -> float:
    """How much may be done."""
    if isinstance(effort, bool) or not isinstance(effort, int | float) or not effort >= 0:
        raise InputError(
            f"effort must be a number ≥ 0, got {effort!r}: it is how much may be tried, 1 being about a "
            "second of one core"
        )
    return float(effort)


def time_limit(seconds: float | None) -> float:
    """The time that a search may take [s]; inf where none is given."""
    if seconds is None:
        return inf
    if not isinstance(seconds, int | float) or not seconds >= 0:
        raise InputError(f"seconds must be a number ≥ 0, got {seconds!r}: it is the time that may pass")
    return float(seconds)
