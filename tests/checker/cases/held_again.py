"""What the checker finds of two arms of which a hand holds one, counted a second time; boxes of hands."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from fractions import Fraction
from importlib import import_module
from itertools import pairwise
from math import floor
from random import Random
from typing import Any

from . import TINY, Case, put
from .counted_again import some
from .held_pair import ENOUGH, HAND, MOVED, held, with_damping
from .pair import arm
from .pairs_again import _springs, document, part

ROUNDS = 8


@contextmanager
def in_place(**values: Any) -> Iterator[Any]:
    """Other functions in the place of those of held pairs."""
    module = part("held")
    before = {name: getattr(module, name) for name in values}
    try:
        vars(module).update(values)
        yield module
    finally:
        vars(module).update(before)


def _pair(random: Random) -> dict[str, Any]:
    period = some(random, 1, 2)
    told: dict[str, Any] = {"sample_period_s": period, "own_readings": 1}
    for name in ("leader", "follower"):
        told[name] = arm(
            some(random, 0, 1),
            some(random, 1, 2),
            delay_s=period * random.choice([0, 1, Fraction(1, 4), Fraction(4, 3)]),
            virtual_damping_N_s_per_m=some(random, -1, 1),
            local_damping_N_s_per_m=some(random, 0, 1),
            link_delay_s=period * random.choice([0, 1, Fraction(3, 2)]),
            reflection=random.choice([0, 0, 1]),
        )
        told[name]["own_readings"] = 1
    return told


def motions_beside_a_mass() -> str:
    """Of a held arm that is free to fly: x and v go on by f T²/2M and f T/M while a force f is held."""
    random = Random(1)
    motion = part("held")
    for _ in range(ROUNDS):
        pair, mass, which = _pair(random), some(random, 2, 9), random.randrange(2)
        names = ("leader", "follower")
        pair[names[which]]["damping_N_s_per_m"] = 0
        free = pair[names[1 - which]]
        free["coulomb_friction_N"] = some(random, 0, 1)
        path = [Fraction(0), *(some(random, -2, 2, 1) for _ in range(random.randrange(3, 8)))]
        told = held(pair, mass, 0, 0, names[which])
        told = {**{key: told[key] for key in ("loop", "held")}, "positions_m": path, "energy_J": 0}
        found = motion.held_motion_energy(document(motion.HELD_MOTION, told))
        right = _taken(pair, which, mass, path)
        if not 0 <= right - found <= abs(right) * TINY**2:
            return f"{float(right)}, not {float(found)}, of {told}"
    return ""


def _taken(pair: Any, which: int, mass: Fraction, path: Sequence[Fraction]) -> Fraction:
    period, names = pair["sample_period_s"], ("leader", "follower")
    late = [Fraction(pair[name]["delay_s"]) / period for name in names]
    forces: list[list[Fraction]] = [[], []]
    places: list[list[Fraction]] = [[], []]
    at, speed = Fraction(0), Fraction(0)
    for k, here in enumerate(path):
        places[which].append(at)
        places[1 - which].append(here)
        for i in (0, 1):
            own, other, echo, (age, way) = _springs(pair, i)
            parts = ((own, i, 0), (other, 1 - i, age), (echo, i, way))
            forces[i].append(
                sum(
                    (
                        c * places[of][k - old - j]
                        for taps, of, old in parts
                        for j, c in enumerate(taps)
                        if k - old - j >= 0
                    ),
                    Fraction(0),
                )
            )
        for force, of in _parts(forces[which], k, late[which]):
            at, speed = (
                at + speed * of * period - force * (of * period) ** 2 / (2 * mass),
                (speed - force * of * period / mass),
            )
    free, total = pair[names[1 - which]], Fraction(0)
    for k, (here, there) in enumerate(pairwise(path)):
        move = there - here
        total -= sum(force * of * move for force, of in _parts(forces[1 - which], k, late[1 - which]))
        total -= free["damping_N_s_per_m"] * move**2 / period + free["coulomb_friction_N"] * abs(move)
    return total


def _parts(forces: Sequence[Fraction], k: int, late: Fraction) -> list[tuple[Fraction, Fraction]]:
    """The forces that act from sample k on, and in what part of it."""
    whole, share = floor(late), late % 1
    return [
        (forces[k - d] if k >= d else Fraction(0), of) for d, of in ((whole + 1, share), (whole, 1 - share))
    ]


def nothing_acts_at_first() -> str:
    """A first move that is not rubbed takes nothing, to the last bit."""
    motion = part("held")
    for end in (1, -1):
        told = {**with_damping(MOVED, 0), "positions_m": [0, end]}
        told = put(told, {"loop.leader.coulomb_friction_N": 0})
        del told["kind"]
        if motion.held_motion_energy(document(motion.HELD_MOTION, told)) != 0:
            return f"a move to {end}"
    return ""


def _held(told: Any) -> Any:
    return part("held").held_of(
        document(part("held").HELD_PAIR, {key: told[key] for key in ("loop", "held")})
    )


def nothing_is_added_beyond_the_degree() -> str:
    """The criterion has more places than powers: what is not reached is exactly 0."""
    module = part("held")
    for name, told in ENOUGH.items():
        one = _held(told)
        if not module._criterion(one, module.port_of(one))[-1].is_zero:
            return name
    return ""


def the_held_arm_alone() -> str:
    """Its readings over 1: both times ζ to as many powers, descending in z − 1."""
    one = _held(ENOUGH["late"])
    alone, taps = part("held")._alone(one), one.taps[2]
    z = Fraction(5, 3)
    sides = [sum(c * (z - 1) ** i for i, c in enumerate(reversed(row))) for row in alone[1:]]
    right = [sum(c * z ** (len(taps) - 1 - i) for i, c in enumerate(row)) for row in (taps, [one.scale])]
    return "" if sides == right else f"{sides}, not {right}"


BOX = put(
    with_damping(HAND, 1),
    {"held.mass_kg": [2, 3], "held.damping_N_s_per_m": [1, 2], "held.stiffness_N_per_m": [0, 1]},
)


def boxes_cover_all() -> str:
    """Each is halved until it is shown; the middle of one that is not is looked at by itself."""
    refusal = import_module("zwidth.checker.document.refusal").Invalid
    shown: list[Any] = []

    def require(held_: Any, largest: Fraction = Fraction(1, 2), middle: bool = True) -> None:
        size = max(high - low for low, high in held_.motion[:3])
        if size > largest or not (middle or size):
            raise refusal("too large")
        if size:
            shown.append(held_.motion)

    one = _held(BOX)
    with in_place(_require=require) as module:
        count = module._covered(one)
        volumes = [(a[1] - a[0]) * (b[1] - b[0]) * (c[1] - c[0]) for a, b, c, *_ in shown]
        if count != len(set(shown)) or sum(volumes) != 1:
            return f"{count} boxes, {len(set(shown))} of them unlike, {float(sum(volumes))}"
        inside = all(
            low <= a and b <= high
            for motion in shown
            for (a, b), (low, high) in zip(motion[:3], one.motion[:3], strict=True)
        )
        if not inside:
            return "boxes of other hands"
    for largest, middle, said in (
        (Fraction(0), True, "was not confirmed"),
        (Fraction(0), False, "too large"),
    ):
        with in_place(_require=lambda h, x=largest, m=middle: require(h, x, m)) as module:
            try:
                module._covered(one)
            except refusal as error:
                if said not in str(error):
                    return str(error)
            else:
                return "a box that nothing shows"
    return ""


def without_steps_no_sum_is_asked_for() -> str:
    """Of the answer to an impulse."""
    with in_place(one_norm=None) as module:
        module._require(_held(ENOUGH["a hand"]))
    return ""


CHECKS = [
    motions_beside_a_mass, nothing_acts_at_first, nothing_is_added_beyond_the_degree, the_held_arm_alone,
    boxes_cover_all, without_steps_no_sum_is_asked_for,
]  # fmt: skip
CASES = [Case(check.__name__.replace("_", " "), check, "") for check in CHECKS]
