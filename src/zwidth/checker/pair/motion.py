"""Motions of both hands re-run: the energy that they take out, in rational arithmetic.

With compensation of friction the tanh in it is known between two numbers: what counts is the one with which
less comes out.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from ..document.fields import List, Read, document, numbers
from ..document.number import LENGTH, MOST_BITS, common_scale
from ..document.refusal import Invalid, only_if, spend
from ..loop.motion import MOST_SAMPLES, REPEAT, TOLD, require_apart
from .coupling import BITS, PAIR, Side, sides_of, tanh_between

PAIR_MOTION = document(
    {
        "loop": PAIR,
        **TOLD,
        "leader_positions": numbers(LENGTH, least=2, most=MOST_SAMPLES, shown=False),
        "follower_positions": numbers(LENGTH, least=2, most=MOST_SAMPLES, shown=False),
        "leader_switch_positions": numbers(LENGTH, most=MOST_SAMPLES, default=None, shown=False),
        "follower_switch_positions": numbers(LENGTH, most=MOST_SAMPLES, default=None, shown=False),
        "repeats": List(REPEAT, most=MOST_SAMPLES, default=(), shown=False),
    }
)


def pair_stored_at_start(told: Read) -> Fraction:
    """K_l (Δ_l + Δ_f)²/8: what the spring between two readings may hold where both arms are at 0."""
    leader, follower = told.loop.leader, told.loop.follower
    steps: Fraction = leader.resolution + follower.resolution
    felt: Fraction = leader.stiffness + leader.reflection * follower.stiffness
    return felt * steps**2 / 8


def pair_motion_energy(told: Read) -> Fraction:
    """Energy that both hands take out over a motion from rest, both arms at 0 [J]."""
    sides = sides_of(told.loop)
    paths = told.leader_positions, told.follower_positions
    if len(paths[0]) != len(paths[1]) or paths[0][0] or paths[1][0]:
        raise Invalid("both arms must start at rest at 0 and move for as many samples")
    require_apart(told.repeats, len(paths[0]))
    often = told.loop.own_readings
    if any((part.last - part.first) % often or part.first % often for part in told.repeats):
        raise Invalid("a repeated part must begin and end with a sample that both arms send")
    turns = [
        _turns(side, path, given)
        for side, path, given in zip(
            sides, paths, (told.leader_switch_positions, told.follower_switch_positions), strict=True
        )
    ]
    per_unit = common_scale(
        [*(v for path in (*paths, *turns) for v in path), *(side.resolution for side in sides)], MOST_BITS
    )
    taps = common_scale([c for side in sides for c in (*side.own, *side.other, *side.echo)])

    def whole(values: Sequence[Fraction]) -> list[int]:
        return [int(v * per_unit) for v in values]

    arms = [
        _Arm(side, whole(path), whole(turn), per_unit, taps, told.loop.sample_period)
        for side, path, turn in zip(sides, paths, turns, strict=True)
    ]
    _run(arms, told.repeats, often)
    return -sum((arm.lost(taps, often) for arm in arms), Fraction(0))


def _turns(side: Side, path: list[Fraction], given: list[Fraction] | None) -> list[Fraction]:
    """Positions at the instant in each interval when the force changes; none where it does not."""
    only_if(bool(side.part), given, "switch positions")
    if given is not None and len(given) != len(path) - 1:
        raise Invalid("there must be one switch position in each interval")
    return given or []


class _Arm:
    """One side in whole numbers: what it read, the forces on their way, and the sums of its work."""

    def __init__(
        self, side: Side, x: list[int], turns: list[int], per_unit: int, taps: int, period: Fraction
    ) -> None:
        self.side, self.x, self.turns, self.per_unit, self.period = side, x, turns, per_unit, period
        self.count = int(side.resolution * per_unit)
        parts = (side.own, side.other, side.echo)
        self.own, self.other, self.echo = ([int(c * taps) for c in part] for part in parts)
        self.read = [0, 0]  # the newest first
        self.sent: list[int] = []  # of those, what the other side may still need; made by `_run`
        self.told = 0  # what the other's readings add to the force, until it hears again
        self.forces = [0] * (side.whole + 2)
        self.moves = [0] * len(self.forces)  # by which its friction is compensated, as late as the forces
        self.bounds: dict[int, tuple[int, int]] = {}
        self.ahead = 0
        self.work = self.path = self.early = self.late = 0
        self.helped = self.pushed = 0  # what C and F of the compensation give, but for their size
        self.bits = max(v.bit_length() for v in x)

    def look(self, k: int) -> None:
        """Take the reading of sample k."""
        here = self.x[k] + self.ahead
        self.read = [self.count * (here // self.count) if self.count else here, self.read[0]]

    def send(self) -> None:
        """Send it."""
        self.sent = [self.read[0], *self.sent[:-1]]

    def hear(self, partner: _Arm) -> None:
        """Take what has arrived of the other."""
        heard = partner.sent[self.side.age : self.side.age + 2]
        back = self.sent[self.side.echo_age :]
        parts = (*self.other, *self.echo), (*heard, *back)
        self.told = sum(c * v for c, v in zip(*parts, strict=True))

    def push(self) -> None:
        """Compute the force and send it on its way."""
        mine = sum(c * v for c, v in zip(self.own, self.read, strict=True))
        self.forces = [mine + self.told, *self.forces[:-1]]
        if self.side.law is not None:
            self.moves = [self.sent[0] - self.sent[1], *self.moves[:-1]]

    def move(self, k: int) -> None:
        """Go on to sample k + 1 under the forces that act meanwhile."""
        late, d = self.x[k + 1] - self.x[k], self.side.whole
        if self.turns:
            early, late = self.turns[k] - self.x[k], self.x[k + 1] - self.turns[k]
            self.work += self.forces[d + 1] * early
            self.path += abs(early)
            self.early += early * early
            self._help(self.moves[d + 1], early)
        self.work += self.forces[d] * late
        self.path += abs(late)
        self.late += late * late
        self._help(self.moves[d], late)

    def _help(self, move: int, way: int) -> None:
        """What compensation gives on a way, tanh rounded to the side of less."""
        if not move:
            return
        self.helped += move * way
        along = way if move > 0 else -way
        if abs(move) not in self.bounds:
            self.bounds[abs(move)] = self._tanh(abs(move))
        low, high = self.bounds[abs(move)]
        self.pushed += (low if along > 0 else high) * along

    def _tanh(self, move: int) -> tuple[int, int]:
        """Of the speed of a move over v_s."""
        assert self.side.law is not None
        speed = self.side.law.compensation_speed
        return (
            tanh_between(Fraction(move, self.per_unit) / (self.period * speed)) if speed else (1 << BITS,) * 2
        )

    def advance_by(self, part: Read) -> int:
        """How far a round leads."""
        first: int = self.x[part.first]
        last: int = self.x[part.last]
        return last - first

    @property
    def sums(self) -> tuple[int, int, int, int, int, int]:
        """All that is summed up."""
        return self.work, self.path, self.early, self.late, self.helped, self.pushed

    def lost(self, taps: int, often: int) -> Fraction:
        """What its hand gave, friction included, as often as it counts [J]."""
        side, unit = self.side, Fraction(1, self.per_unit)
        squares = self.early / side.part + self.late / (1 - side.part) if side.part else Fraction(self.late)
        work = unit**2 * (Fraction(self.work, taps) + side.damping * often / self.period * squares)
        given = Fraction(0)
        if side.law is not None:
            dry = side.law.compensated_coulomb_friction * Fraction(self.pushed, 1 << BITS)
            given = unit**2 * side.law.compensated_damping / self.period * self.helped + unit * dry
        return side.weight * (work + side.coulomb_friction * unit * self.path - given)


def _run(arms: Sequence[_Arm], repeats: Sequence[Read], often: int) -> None:
    """Sample by sample, and repeated parts in closed form once nothing older is remembered."""
    for arm in arms:
        arm.sent = [0] * (arm.side.echo_age + 2)  # both links there and back, of one age for both arms
    before = 0
    for part in repeats:
        _forward(arms, before, part.first, often)
        _rounds(arms, part, often)
        before = part.last
    _forward(arms, before, len(arms[0].x) - 1, often)


def _forward(arms: Sequence[_Arm], start: int, stop: int, often: int) -> None:
    for k in range(start, stop):
        reading = [arm for arm in arms if k % (often // arm.side.often) == 0]
        for arm in reading:
            arm.look(k)
        if k % often == 0:
            for arm in arms:
                arm.send()
            for arm, partner in zip(arms, arms[::-1], strict=True):
                arm.hear(partner)
        for arm in reading:
            arm.push()
        for arm in arms:
            arm.move(k)
            force = arm.forces[0].bit_length()
            spend(24 + len(arm.sent) + len(arm.forces), force, arm.bits)


def _rounds(arms: Sequence[_Arm], part: Read, often: int) -> None:
    """All rounds of a part.

    Once the round before the last is older than whatever is remembered, every further round has the forces
    of the last one and a constant more, as the laws are linear in readings that go on by as much each time.
    """
    length = part.last - part.first
    memory = max(often * len(arm.sent) + len(arm.forces) for arm in arms)
    advances = [arm.advance_by(part) for arm in arms]
    for done in range(1, part.times + 1):
        before = [arm.sums for arm in arms]
        _forward(arms, part.first, part.last, often)
        for arm, advance in zip(arms, advances, strict=True):
            arm.ahead += advance
        even = all(
            not arm.count or advance % arm.count == 0 for arm, advance in zip(arms, advances, strict=True)
        )
        left = part.times - done
        if left and even and (done - 1) * length >= memory:
            _skip(arms, advances, before, left)
            break
    for arm, advance in zip(arms, advances, strict=True):
        arm.ahead -= advance  # the list after the part stands one advance ahead already


def _skip(
    arms: Sequence[_Arm], advances: Sequence[int], before: Sequence[tuple[int, ...]], left: int
) -> None:
    """So many rounds more; compensation, which knows moves alone, gives the same in each."""
    for arm, advance, its, (work, path, early, late, helped, pushed) in zip(
        arms, advances, advances[::-1], before, strict=True
    ):
        push = (sum(arm.own) + sum(arm.echo)) * advance + sum(arm.other) * its
        spend(
            12 + len(arm.sent) + len(arm.forces),
            left.bit_length() + advance.bit_length(),
            arm.work.bit_length(),
        )
        arm.work += left * (arm.work - work) + push * advance * (left * (left + 1) // 2)
        arm.path += left * (arm.path - path)
        arm.early += left * (arm.early - early)
        arm.late += left * (arm.late - late)
        arm.helped += left * (arm.helped - helped)
        arm.pushed += left * (arm.pushed - pushed)
        arm.ahead += left * advance
        arm.read = [v + left * advance for v in arm.read]
        arm.sent = [v + left * advance for v in arm.sent]
        arm.forces = [f + left * push for f in arm.forces]
