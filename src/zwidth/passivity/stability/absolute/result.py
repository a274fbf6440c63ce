"""How stiff a one-sided wall may be for a known hand: proved from below, refuted from above."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import Any

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment import PulseTransferFunction
from zwidth.model.operator.hand_impedance import HandImpedance, as_hand
from zwidth.model.operator.operator import LinearHand, Operator
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.result import Result, evidence_of
from zwidth.passivity.scope import Hands, Scope
from zwidth.passivity.stability.absolute.criteria import (
    CRITERIA,
    Criterion,
    LinearLimit,
    largest_slope,
    linear_limit,
    proved,
)
from zwidth.passivity.stability.absolute.motion import PeriodicMotion, smallest_motion
from zwidth.passivity.stability.absolute.plant import Plant, given_plant, touched_plant
from zwidth.quantity.answered import answered, answers, known
from zwidth.quantity.exact import Exact
from zwidth.showing import Table

_MOST = 1e9
"""Over |G(1)|: slopes are sought up to here where a linear spring never makes the loop unstable."""


@dataclass(frozen=True)
class Proved:
    """The largest slope that one criterion proves, with its certificate; 0 and None where it proves none."""

    criterion: Criterion
    slope: Exact
    certificate: Certificate | None


@dataclass(frozen=True, repr=False)
class AbsoluteStability(Result):
    """What `absolute_stability` found."""

    _FORMAT = "zwidth absolute stability 1"

    proved: tuple[Proved, ...] = known(
        "by criterion: circle, Tsypkin, Jury–Lee, Zames–Falb for any wall, Zames–Falb for odd ones"
    )
    linear_limit: LinearLimit = answered(
        "K at which a linear spring vibrates, and θ = ωT of the vibration: no slope beyond it can be proved",
        stands_as={"linear_limit": "slope"},
    )
    pressing: PeriodicMotion | None = known(
        "the periodic motion of the smallest slope found with a one-sided wall, for a hand that presses: it "
        "rests inside the surface; None where none was found"
    )
    resting: PeriodicMotion | None = known("the same for a hand that rests off the wall")
    plant: Plant = known("G, rounded")

    @property
    @answers()
    def scope(self) -> Scope:
        """One plant of a known hand and device, with any spring of the class, touched and left at will."""
        hands = Hands(impedance="the plant G(z)")
        return Scope(hands=hands, contact="made and broken", sampling="constant", transmission="")

    def slope(self, criterion: Criterion) -> Exact:
        """The largest K that the criterion proves."""
        return next(row.slope for row in self.proved if row.criterion == criterion)

    @property
    def largest(self) -> Exact:
        """The largest slope proved for a one-sided wall; the odd multipliers do not count."""
        return max(row.slope for row in self.proved if row.criterion != "Zames–Falb, odd")

    @property
    def refuted(self) -> float:
        """The smallest slope refuted: the linear limit, or a periodic motion below it."""
        return min(self.linear_limit.slope, *(motion.slope for motion in self._motions), inf)

    @property
    def gap(self) -> float:
        """What lies open between proof and refutation, (K_refuted − K_proved)/K_proved."""
        return self.refuted / self.largest - 1 if self.largest else inf

    @property
    def certificate(self) -> Certificate | None:
        """The proofs, one for each wall."""
        proofs = [d for row in self.proved if row.certificate for d in row.certificate.documents]
        return Certificate(_of_different_walls(proofs)) if proofs else None

    @property
    def witness(self) -> Certificate | None:
        """The periodic motions that refute."""
        against = [d for motion in self._motions for d in motion.certificate.documents]
        return Certificate(tuple(against)) if against else None

    @property
    def _motions(self) -> list[PeriodicMotion]:
        return [motion for motion in (self.pressing, self.resting) if motion is not None]

    def describe(self) -> str:
        """What is proved by which criterion, and what is refuted."""
        slopes = "; ".join(f"{row.criterion} {float(row.slope):.6g}" for row in self.proved)
        return f"proved: {slopes}; refuted: {self.refuted:.6g}"

    def rows(self) -> list[tuple[str, str]]:
        """The slopes of criteria, linear limit and motions."""
        rows = [(str(row.criterion), f"{float(row.slope):.7g}") for row in self.proved]
        rows.append(("linear limit", f"{self.linear_limit.slope:.7g}"))
        for name, motion in (("pressing", self.pressing), ("resting", self.resting)):
            found = "none found" if motion is None else f"{motion.slope:.7g}, {motion.period} samples"
            rows.append((f"motion, {name}", found))
        return rows

    def to_dict(self) -> dict[str, Any]:
        """Slopes, motions and certificates of both as plain data."""
        return {
            **super().to_dict(),
            "slopes": {row.criterion: float(row.slope) for row in self.proved},
            "motions": [{k: v for k, v in m._asdict().items() if k != "source"} for m in self._motions],
            **evidence_of(self),
        }

    def __str__(self) -> str:
        return str(Table(rows=self.rows()))


def absolute_stability(
    plant: PulseTransferFunction | Device,
    hand: LinearHand | HandImpedance | Operator | None = None,
    *,
    reach: int = 20,
    motions: bool = True,
) -> AbsoluteStability:
    """The largest slope K of a memoryless wall, 0 ≤ φ' ≤ K, for which the loop always comes to rest.

    Parameters
    ----------
    plant
        A device of certain numbers without Coulomb friction and encoder counts; or G(z), from the wall's
        force to −x, stable and strictly proper.
    hand
        With a device: mass, spring and damper to a resting anchor, as ``operators.LinearHand(mass, stiffness,
        damping)``, a `HandImpedance` of certain numbers, or an operator with such a hand.  The anchor may be
        anywhere.
    reach
        Farthest tap of the Zames–Falb multipliers, 1 … 100 samples before and after.
    motions
        False leaves the periodic motions out; they take most of the time.

    Returns
    -------
    AbsoluteStability
        What each criterion proves, each certificate accepted by the independent checker, and what refutes.

    Raises
    ------
    InputError
        If the plant is not stable by itself, or a number is missing or out of its bound.
    """
    if not isinstance(reach, int) or not 1 <= reach <= 100:
        raise InputError(f"reach is a whole number of 1 … 100 samples, got {reach!r}")
    found = _plant(plant, hand)
    limit = linear_limit(found)
    rows = tuple(_row(found, criterion, reach, limit.slope) for criterion in CRITERIA)
    best = max(float(row.slope) for row in rows if row.criterion != "Zames–Falb, odd")
    wanted = motions and best > 0
    pressing, resting = (smallest_motion(found, best, g) if wanted else None for g in (-1.0, 1.0))
    return AbsoluteStability(rows, limit, pressing, resting, found)


def _plant(
    plant: PulseTransferFunction | Device, hand: LinearHand | HandImpedance | Operator | None
) -> Plant:
    if isinstance(plant, PulseTransferFunction):
        if hand is not None:
            raise InputError("a plant given as G(z) holds its hand already; leave hand out")
        return given_plant(plant)
    if not isinstance(plant, Device):
        raise InputError(f"expected a Device or a PulseTransferFunction, got {type(plant).__name__}")
    if hand is None:
        raise InputError("which hand? For every passive hand at once see zw.check; here it is a known one")
    known = _linear(hand)
    found = touched_plant(plant, known)
    if known.stiffness <= 0:
        raise InputError(
            "the hand needs a spring, stiffness > 0: else the device rests anywhere off the wall"
        )
    return found


def _linear(hand: LinearHand | HandImpedance | Operator) -> LinearHand:
    """Mass, spring and damper of a hand, each one number."""
    if isinstance(hand, LinearHand):
        return hand
    known = as_hand(hand)
    numbers = (known.mass, known.stiffness, known.damping)
    certain = [value for value in numbers if isinstance(value, Exact)]
    if len(certain) < len(numbers):
        raise InputError(
            "absolute stability is decided for one hand, and a number of this one is an interval; choose a "
            "value in it, or see robust_boundary"
        )
    return LinearHand(*certain)


def _of_different_walls(proofs: list[dict[str, Any]]) -> tuple[dict[str, Any], ...]:
    """One proof for each wall: of two criteria that come to the same slope, the first."""
    walls = {(proof["nonlinearity"], proof["slope"]): proof for proof in reversed(proofs)}
    return tuple(walls.values())[::-1]


def _row(plant: Plant, criterion: Criterion, reach: int, limit: float) -> Proved:
    still = abs(plant.response_at(0.0)) or 1.0
    found = largest_slope(plant, criterion, reach, min(limit, _MOST / still))
    exact = None if found is None else proved(plant, criterion, found)
    if exact is None:
        return Proved(criterion, Exact(0), None)
    return Proved(criterion, Exact(exact[0]), Certificate((exact[1],)))
