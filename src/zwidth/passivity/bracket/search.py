"""The two values of a bracket, sought by closed forms; loops and work are counted."""

from __future__ import annotations

import time
from collections.abc import Callable
from math import inf, log2, sqrt
from typing import Any, NamedTuple

from zwidth.errors import InputError
from zwidth.model.environment.environment import Environment
from zwidth.passivity.bracket.bracket import Bracket, Parameter
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.check import check
from zwidth.passivity.scope import Contact, Scope
from zwidth.passivity.storage.chain_document import ChainStorage
from zwidth.passivity.storage.gain import Gain
from zwidth.passivity.storage.hand_bounds import HandBounds
from zwidth.passivity.storage.storage_function import StorageFunction
from zwidth.passivity.storage.value_iteration import Effort
from zwidth.passivity.witness.violation import Violation
from zwidth.passivity.witness.witness import Witness
from zwidth.quantity.exact import Exact
from zwidth.quantity.text import shown

Holds = Callable[[Exact, float], bool]
"""Whether a claim is shown at a value with no more work than that."""


class Found(NamedTuple):
    """Two values and their evidence."""

    passive: Exact | None
    active: Exact | None
    certificate: Certificate | None
    witness: Gain | Witness | None
    scope: Scope
    violation: Violation | None = None
    every: bool = False


def is_stepped(law: Environment) -> bool:
    """True of a scene without H(z), which the coupling before it decides."""
    return law.starts_at_rest and not law.has_transfer_function


_LOOP = 0.01  # what one loop is counted as at least: closed forms decide a hundred in a second

MADE: Contact = "made and broken"
NOTHING = Found(None, None, None, None, Scope())


class Search:
    """Looks for the two values, counting loops and work."""

    def __init__(
        self,
        parameter: Parameter,
        tolerance: float,
        effort: Effort,
        most: float,
        progress: Callable[[int, int], None] | None,
    ) -> None:
        self.parameter, self.tolerance = parameter, tolerance
        self.effort, self.most, self.progress = effort, most, progress
        self.start = time.monotonic()
        self.evaluations = 0
        self.refused: dict[Exact, str] = {}
        """Why nothing decides a value."""
        self.in_contact = False
        """Whether a value is proved for a hand that stays inside, and for no other."""
        self.first = Exact(parameter.now or 1.0)

    def by_closed_forms(self, contact: Contact = MADE) -> Found:
        """What the closed forms of `check` show of every hand."""
        verdicts: dict[Exact, Any] = {}
        kept = contact == "kept"

        def verdict(value: Exact) -> Any:
            if value not in verdicts:
                self.count()
                try:
                    verdicts[value] = check(*self.parameter.change(value), contact=contact, iterate=False)
                except InputError as error:  # a delay of more samples than a proof has room for
                    if value == self.first:
                        raise
                    self.refused[value], verdicts[value] = str(error), None
            return verdicts[value]

        def proved(value: Exact, _: float) -> bool:
            outcome = getattr(verdict(value), "outcome", "")
            self.in_contact |= outcome == "passive in contact"
            return outcome == "passive"

        def refuted(value: Exact, _: float) -> bool:
            found = verdict(value)
            broken = kept and getattr(found, "scope", NOTHING.scope).contact == MADE
            return getattr(found, "outcome", "") == "active" and not broken

        least = self.parameter.least
        every = least is not None and self.parameter.proves_more(verdict(least))
        if every or (least == 0 and proved(least, inf) and proved(self.first, inf)):
            passive, active = least, None
        else:
            sides = self.sides(proved, refuted)
            approach(*sides, self.tolerance / 4, inf, self.effort)
            passive, active = (side.good for side in sides)
        good = None if passive is None else verdict(passive)
        bad = None if active is None else verdict(active)
        known = next((each for each in (good, bad) if each is not None), verdict(self.first))
        proof = None if good is None else good.certificate
        motion, violation = (None, None) if bad is None else (bad.witness, bad.violation)
        scope = known.scope
        if bad is not None and bad.scope.transmission == "as given":  # what holds for any holds for this one
            scope = scope.replace(transmission="as given")
        return Found(passive, active, proof, motion, scope, violation, every)

    def beyond(self, found: Found) -> str:
        """Why no value further on was decided, or what to ask besides."""
        name = self.parameter.name.removeprefix("device.")
        turns = self.parameter.least is not None and name != "transmission.handle_damping"
        if turns and found.passive is not None and not found.every:
            return f"a larger one is not always safer: zwidth sweep --vary {name}=LOW:HIGH:COUNT asks at many"
        if found.every or None not in (found.passive, found.active):
            return ""
        if found.passive is None and self.in_contact:
            return 'of a hand that stays inside more is proved: --contact kept, in Python contact="kept"'
        if not self.refused:
            return ""
        value = min(self.refused, key=lambda each: abs(log2(each / self.first)))
        return f"the search ended at {shown(float(value), self.parameter.unit, 6)}: {self.refused[value]}"

    def bracket(
        self,
        found: Found,
        every_hand: tuple[Exact | None, Exact | None],
        bounds: HandBounds | None = None,
        storage: StorageFunction | ChainStorage | None = None,
    ) -> Bracket:
        """What was found, as it is given back."""
        return Bracket(
            self.parameter.name,
            self.parameter.unit,
            _plain(found.passive),
            _plain(found.active),
            found.certificate,
            found.witness,
            found.scope,
            (_plain(every_hand[0]), _plain(every_hand[1])),
            self.evaluations,
            time.monotonic() - self.start,
            storage,
            bounds,
            found.violation,
            self.beyond(found),
            self.effort.is_cut,
            found.every,
        )

    def sides(self, proved: Holds, refuted: Holds) -> tuple[Side, Side]:
        """What is sought on either side: a proof as far as it goes, and a motion from beyond."""
        onward = -1 if self.parameter.more_is_safer else 1
        return Side(proved, onward, self.first), Side(refuted, -onward, self.first)

    def is_close(self, passive: Exact | None, active: Exact | None) -> bool:
        """True where the two are as near to each other as is wanted."""
        if passive is None or active is None:
            return False
        return abs(active - passive) <= self.tolerance * max(active, passive)

    def share(self, part: float) -> float:
        """How much will be done when a part of what is left is."""
        done = self.effort()
        return done + part * max(self.most - done, 0.0)

    def count(self) -> None:
        """One loop more is looked at."""
        self.evaluations += 1
        self.effort.spend(_LOOP)
        self.report(0)

    def report(self, _: int) -> None:
        """Say how far it is; a round of values has passed."""
        if self.progress is not None:
            self.progress(self.evaluations, max(30, self.evaluations + 1))


def _plain(value: float | None) -> float | None:
    return None if value is None else float(value)


# Two claims sought from two sides of a limit, the work shared fairly between them.  Each side asks at one
# value after the other: on from the farthest at which its claim was shown, and then between it and the
# nearest at which it was not.  An answer is evidence by itself, so that a law which is safe, unsafe and safe
# again loses only the best bracket.


_FARTHEST = 60  # doublings from the first guess after which there is no limit
_AHEAD = 0.5  # work by which the first side may be ahead of the other: it tells the other where to begin


Clock = Callable[[], float]
"""What has been done so far, as `effort` counts it."""


class Side:
    """One claim, and how far it has been shown.

    `holds`: whether the claim was shown at a value with no more than what is given, of all that is done;
    `towards`: 1 if it is the harder to show the larger the value, −1 if the smaller; `origin`: the first
    guess; `good`: the farthest value at which it is known already.
    """

    def __init__(
        self, holds: Callable[[Exact, float], bool], towards: int, origin: Exact, good: Exact | None = None
    ) -> None:
        self.holds, self.towards, self.origin, self.good = holds, towards, origin, good
        self.bad: Exact | None = None
        self.spent = 0.0
        self._ahead = 0

    def begin(self) -> None:
        """Seek anew with sharper means: what failed before may be shown now."""
        self.bad, self._ahead = None, 0

    def ask(self, value: Exact, other: Side, most: float, clock: Clock) -> None:
        """Try the claim at a value, with a part of the work that is left, that there is some for others."""
        self._ahead += (self.good is None) != (self._nearest(other.good) is None)
        begun = clock()
        left = max(most - begun, 0.0)
        if self.holds(value, begun + left / (2 if self.good is None else 4)):
            self.good = value
        else:
            self.bad = value
        self.spent += clock() - begun

    def next(self, other: Side, fine: float) -> Exact | None:
        """Where to ask; None if nothing is to be gained by it."""
        good, bad = self.good, self._nearest(other.good)
        if good is not None and bad is not None:
            if abs(bad - good) <= fine * max(bad, good):
                return None
            value = _decimal(sqrt(good * bad))
            return None if value in (good, bad) else value
        if good is None and self.bad is None and other.bad is not None:
            return other.bad
        known = bad if good is None else good
        if known is None:
            return self.origin
        onward = -self.towards if good is None else self.towards
        factor = min((1.0 + 4 * fine) ** (2.0 ** min(self._ahead, 10)), 4.0)
        value = _decimal(known * factor**onward)
        return value if abs(log2(value / self.origin)) <= _FARTHEST else None

    def _nearest(self, other: Exact | None) -> Exact | None:
        """The value that is known to be beyond: here it was not shown, or its contrary was."""
        known = [value for value in (self.bad, other) if value is not None]
        return min(known, key=lambda value: self.towards * value) if known else None


def approach(first: Side, second: Side, fine: float, most: float, clock: Clock) -> None:
    """Let both sides ask until neither gains, or so much is done; the one that has had less goes next."""
    for side in (first, second):
        side.begin()
    while clock() < most:
        own, others = first.next(second, fine), second.next(first, fine)
        behind = first.spent <= second.spent + _AHEAD
        if own is not None and (behind or others is None):
            first.ask(own, second, most, clock)
        elif others is not None:
            second.ask(others, first, most, clock)
        else:
            return


def _decimal(value: float) -> Exact:
    """A value of six digits, as a person would write it down."""
    return Exact(f"{value:.6g}")
