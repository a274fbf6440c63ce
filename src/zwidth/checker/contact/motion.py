"""Motions through contact made and broken, re-run: through a law, or with the forces of laws in a chain."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise

from ..document.fields import Number, Read, Record, document, numbers
from ..document.number import FORCE, LENGTH, SPEED
from ..document.refusal import Invalid, spend
from ..loop.motion import REPEAT, TOLD, switch_positions
from .law import LAW, LOSSES, TOLD_LAW, Law, Losses, law_of, losses_of

# The bounds on the hand that a motion is said to keep: how deep, how far outside, how fast.
#
# x ≤ depth,    x ≥ −outside,    |Δx| ≤ speed · t    over each time t in which one force is held

BOUNDS = Record(
    {
        "speed": Number(SPEED, least=0, default=None),
        "depth": Number(LENGTH, default=None),
        "outside": Number(LENGTH, default=None),
    },
    default=None,
)


def require_within(
    bounds: Read | None, losses: Losses, x: Sequence[Fraction], switches: Sequence[Fraction]
) -> None:
    """Where bounds are stated, every position and every move keeps to them."""
    if bounds is None:
        return
    if bounds.speed is not None and not _slow(losses, x, switches, bounds.speed):
        raise Invalid("the motion does not keep to its speed")
    for name, most, side in (("depth", bounds.depth, 1), ("outside", bounds.outside, -1)):
        if most is not None and any(side * place > most for place in (*x, *switches)):
            raise Invalid(f"the motion does not keep to its {name}")


def _slow(losses: Losses, x: Sequence[Fraction], switches: Sequence[Fraction], speed: Fraction) -> bool:
    if losses.part == 1:
        return all(abs(b - a) <= speed * losses.period for a, b in pairwise(x))
    early, late = speed * losses.period * losses.part, speed * losses.period * (1 - losses.part)
    turns = zip(pairwise(x), switches, strict=True)
    return all(abs(m - a) <= early and abs(b - m) <= late for (a, b), m in turns)


# A motion against laws in a chain re-counted: positions and the forces that were held, exactly.
#
#     energy out = −Σ f Δx − Σ c(Δx)
#
# The forces are those that the document lists.  That the law gives them is not checked here:
# this needs the law.


MOST_POSITIONS = 100_000
ROW_MOTION = document(
    {
        "loop": LOSSES,
        "law": TOLD_LAW,
        "bounds": BOUNDS,
        **TOLD,
        "repeats": REPEAT,
        "positions": numbers(LENGTH, least=2, most=MOST_POSITIONS, shown=False),
        "forces": numbers(FORCE, least=1, most=MOST_POSITIONS, shown=False),
    }
)


def row_motion_energy(told: Read) -> tuple[Fraction, Fraction]:
    """Energy the hand takes out over the motion, and by one more round of its cycle [J].

    `repeats` names the part that is done `times` times; it must return to where it began.
    """
    losses = losses_of(told.loop)
    if losses.part < 1:
        raise Invalid("laws in a chain are checked for delays of whole samples")
    x, forces = told.positions, told.forces
    if len(forces) != len(x) - 1:
        raise Invalid("there must be one force for each move")
    require_within(told.bounds, losses, x, ())
    first, last, times = closed_cycle(told.repeats, x)

    def taken(begin: int, end: int) -> Fraction:
        moves = ((forces[k], x[k + 1] - x[k]) for k in range(begin, end))
        return -sum((f * d + losses.lost(d, losses.part) for f, d in moves), Fraction(0))

    gain = taken(first, last)
    return taken(0, first) + times * gain + taken(last, len(x) - 1), gain


def closed_cycle(part: Read, x: list[Fraction]) -> tuple[int, int, int]:
    """First and last sample of the part that is repeated, and how often; it returns to where it began."""
    first, last, times = part.first, part.last, part.times
    if not first < last < len(x) or x[first] != x[last]:
        raise Invalid("the repeated part must lie in the motion and return to where it began")
    return first, last, times


# A motion re-run through a law with contact made and broken: the energy it takes out, exactly.


MOST_SAMPLES = 2_000_000
FINEST = 2**80
"""An average is kept to so many parts of a count; what that may cost in energy is taken off."""
_SAMPLE = 400
"""Steps of work."""
CONTACT_MOTION = document(
    {
        "loop": LOSSES,
        "law": LAW,
        "bounds": BOUNDS,
        **TOLD,
        "repeats": REPEAT,
        "positions": numbers(LENGTH, least=2, most=MOST_POSITIONS, shown=False),
        "switch_positions": numbers(LENGTH, most=MOST_POSITIONS, default=None, shown=False),
    }
)


def contact_motion_energy(told: Read) -> tuple[Fraction, Fraction]:
    """Energy the hand takes out over the motion, and by one more round of its cycle [J].

    The motion begins at rest, with the reading 0 or less where the law gives no force; on a spring by points
    that acts at every position where Coulomb friction holds the force, and what that stores at
    x − Δ/2 is taken off.  It ends wherever it ends.  `repeats` names the part that is done `times` times; it
    must return to where it began.  It keeps to the bounds that are stated.
    """
    losses, law, x = losses_of(told.loop), law_of(told.law), told.positions
    given = switch_positions(told, losses.part < 1)
    switches = given if losses.part < 1 else x[1:]
    require_within(told.bounds, losses, x, switches)
    first, last, times = closed_cycle(told.repeats, x)
    taps = law.memory + 1
    start = losses.resolution * (x[0] // losses.resolution)
    anywhere = law.surface == "none" and bool(law.points)
    held = max(friction for friction, _ in losses.models) if anywhere else Fraction(0)
    if (start > 0 and not anywhere) or abs(law.force([start] * taps)) > held:
        raise Invalid("the motion must begin at rest where the law gives no force, or friction holds it")

    resting = Fraction(0) if law.surface == "penetration" else start
    state = _State([start] * (taps + losses.delay + 1), [resting] * (losses.delay + 1))

    def run(begin: int, end: int) -> Fraction:
        out = Fraction(0)
        for k in range(begin, end):
            older, newer = state.read(losses.resolution * (x[k] // losses.resolution), law, losses, taps)
            early, late = switches[k] - x[k], x[k + 1] - switches[k]
            out -= older * early + losses.lost(early, losses.part)
            if losses.part < 1:
                out -= newer * late + losses.lost(late, 1 - losses.part)
        return out

    energy = run(0, first) - (law.stored(x[0] - losses.resolution / 2) if anywhere else 0)
    done, before, gain = 0, None, Fraction(0)
    while done < times and before != state:
        if (done + 1) * (last - first) > MOST_SAMPLES:
            raise Invalid("the law takes too long to settle to the cycle")
        spend(_SAMPLE * (last - first))
        before = state.copy()
        gain = run(first, last)
        energy += gain
        done += 1
    energy += gain * (times - done)
    if before != state:
        raise Invalid("the law has not settled to the cycle: there are too few rounds to tell its gain")
    energy += run(last, len(x) - 1)
    return energy - times * _uncertainty(law, losses, x), gain - _uncertainty(law, losses, x)


class _State:
    """What the loop remembers: readings, and averages kept to FINEST parts of a count."""

    def __init__(self, readings: list[Fraction], averages: list[Fraction]) -> None:
        self.readings, self.averages = readings, averages

    def copy(self) -> _State:
        return _State(list(self.readings), list(self.averages))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _State) and (
            (self.readings, self.averages) == (other.readings, other.averages)
        )

    __hash__ = None  # type: ignore[assignment]

    def read(self, reading: Fraction, law: Law, losses: Losses, taps: int) -> tuple[Fraction, Fraction]:
        """Take a reading; the two forces that act in the interval that follows."""
        self.readings = [reading, *self.readings[:-1]]
        older, newer = (
            law.force(self.readings[age : age + taps], self.averages[age])
            for age in (losses.delay, max(losses.delay - 1, 0))
        )
        fine = losses.resolution / FINEST
        after = law.averaged(self.averages[0], reading)
        self.averages = [round(after / fine) * fine, *self.averages[:-1]]
        return older, newer


def _uncertainty(law: Law, losses: Losses, x: list[Fraction]) -> Fraction:
    """Energy that the rounding of averages may feign in one passage through the positions [J]."""
    if law.relaxing is None:
        return Fraction(0)
    pole, stiffness = law.relaxing
    path = sum((abs(b - a) for a, b in pairwise(x)), Fraction(0))
    return abs(stiffness) * path * losses.resolution / FINEST / (1 - pole)
