"""Motions from rest: the energy by hand.  K = 2 N/m and T = 1 s, the force of a sample held until the next.

0 → 1 → 0            2 − 2b − 2 f_c
a sample late, 0 → 1 → 1 → 0, the same
a quarter late       the old force for ¼ T, in which the hand makes a quarter of its way: 3/2 − 2b − 2 f_c
N times 1 further and back at once     N² + N − b (N + N²) − 2 N f_c
"""

from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module
from itertools import pairwise
from random import Random
from typing import Any

from . import Case, Fraction, accepted, loop, plain, put, refused, without


def motion(positions: Any, energy: Any, numerator: Any = (2,), denominator: Any = (1,), **device: Any) -> Any:
    """b = ½ N·s/m if nothing else is said."""
    return {
        "kind": "motion",
        "loop": loop(numerator, denominator, **{"damping_N_s_per_m": "1/2", **device}),
        "positions_m": list(positions),
        "energy_J": energy,
    }


def taken(name: str, energy: Any, told: Any, **facts: Any) -> Any:
    """A motion whose energy is told rightly."""
    return accepted(
        name, put(told, {"energy_J": energy}), "the motion extracts", energy, **{"shows": "active", **facts}
    )


def repeated(told: Any, *parts: tuple[int, int, int]) -> Any:
    return put(told, {"repeats": [{"first": a, "last": b, "times": n} for a, b, n in parts]})


THERE, BACK = motion([0, 1, 0], 1), "leaves the wall"
QUARTER = put(motion([0, 1, 0], "1/2", delay_s="1/4"), {"switch_positions_m": ["1/4", "3/4"]})
FREE = {"unilateral": False}
STEPS = motion([0, 1, 2, 0], 4, **FREE)
"""−(0 + 2) + 2 · 4 − b (1 + 1 + 4) − 4 f_c = 3"""


def climb(rounds: int, **device: Any) -> Any:
    """1 further in each round, and back at once."""
    return repeated(motion([0, 1, 1 - rounds], 0, **{**FREE, **device}), (0, 1, rounds))


# 1/(1 − ζ/2): the forces 0, 1, 3/2
FILTER = motion([0, 1, 1, 0], "1/2", [1, 0], [1, "-1/2"], **FREE)
# Δ = 2: at −1/1000 the reading is −2 and the force −4; H(1) Δ²/8 = 1 J is in the spring at rest
HALF = motion([0, "-1/1000", "249/1000"], 0, resolution_m=2, damping_N_s_per_m=0, unilateral=False)
NONE = "no more than the"


LATE_OUT = [0, 9, 8], [(1, 2, 13)], [2], [1], {"unilateral": True, "delay_s": 2}
"""Out of the wall at last, long after every force has begun to fall by as much."""
AT_FIRST_OUT = [0, -5, 3, 3, -4], [(1, 4, 4)], [2], [1], {"unilateral": True}
"""Each round begins outside, and all forces that are left in the end are of inside."""
FINER = [0, 2, 0, 0, 0, 1, 2, 2, 2], [(4, 8, 3)], [1], [2], {"unilateral": False}
"""A first force that is no whole number, in the first round, after which all have grown by as much."""


def rounds_are_what_they_are_one_by_one() -> str:
    """Motions with parts that are repeated, beside the same motions written out."""
    verify = import_module("zwidth.checker").verify
    for x, listed, n, d, entries in (LATE_OUT, AT_FIRST_OUT, FINER, *_any_rounds()):
        told = put(motion(x, 0, n, d, coulomb_friction_N="1/3"), {f"loop.{k}": v for k, v in entries.items()})
        whole = written_out(x, listed)
        several = [repeated(told, *listed), put(told, {"positions_m": whole})]
        if entries.get("delay_s") == "1/4":
            switches = [(3 * a + b) / Fraction(4) for a, b in pairwise(x)]
            several[0]["switch_positions_m"] = switches
            several[1]["switch_positions_m"] = [(3 * a + b) / Fraction(4) for a, b in pairwise(whole)]
        energies = [verify(plain(document)).energy for document in several]
        if energies[0] is None or energies[0] != energies[1]:
            return f"{x} through {n}/{d}, {listed}, {entries}: {energies}"
    return ""


def _any_rounds() -> Iterator[tuple[Any, Any, Any, Any, dict[str, Any]]]:
    """Positions, repeated parts, law and device, at random."""
    random = Random(4)
    laws = (([2], [1]), ([3, -1], [1, 0]), ([1, 1], [2, -1]), ([2, 0], [1, "-1/2"]), ([1, -1], [1, -1]))
    for _ in range(250):
        (n, d), late = random.choice(laws), random.choice(("0", "0", "1", "1/4"))
        one_sided = n == [2] and d == [1] and random.random() < 0.8
        x = [0, *(random.randrange(-1 if one_sided else -3, 5) for _ in range(random.randrange(2, 7)))]
        first = random.randrange(len(x) - 1)
        last = random.randrange(first + 1, len(x))
        if random.random() < 0.3:
            x[last] = x[first]
        listed = [(first, last, random.choice((1, 2, 5, 9)))]
        if last + 1 < len(x) and random.random() < 0.3:
            listed.append((last, len(x) - 1, 3))
        entries = {"unilateral": one_sided, "delay_s": late, "resolution_m": random.choice((0, 0, 1, 2))}
        yield x, listed, n, d, entries


def written_out(x: Any, parts: Any) -> Any:
    """The positions of all rounds, one after the other."""
    out, ahead, before = [], 0, 0
    for first, last, times in parts:
        out += [v + ahead for v in x[before:first]]
        for _ in range(times):
            out += [v + ahead for v in x[first:last]]
            ahead += x[last] - x[first]
        ahead -= x[last] - x[first]
        before = last
    return [*out, *(v + ahead for v in x[before:])]


COARSE = motion([0, 3, 0], 2, resolution_m=3, **FREE)
"""Half a count of its spring is 2 · 3²/8; 18 − 18 b comes out."""

HALF_A_COUNT = repeated(
    motion([0, 2, 2, 3, -1], 0, [1, 0, 0], [2, 0, -1], resolution_m=2, damping_N_s_per_m=0, **FREE), (1, 3, 2)
)
"""1/(2 − ζ²), Δ = 2, each round 1 further.  The readings are 0, 2, 2, 2, 2, 4, the forces 0, 1, 1, 3/2,
3/2, 11/4: in the first round all of them grow by 1, in the second they do not.  4 · 11/4 − 1 − 3/2 comes out.
"""

CASES = [
    Case("rounds are what they are one by one", rounds_are_what_they_are_one_by_one, ""),
    refused(
        "nothing is stored where H(1) < 0",
        put(motion([0, 0], 0, [-2], resolution_m=3, **FREE), {}),
        "no more than the 0 J stored",
        0,
    ),
    refused(
        "what half a count has stored",
        put(COARSE, {"loop.damping_N_s_per_m": "8/9"}),
        "no more than the 2.25 J stored",
        2,
    ),
    taken("more than half a count has stored", "5/2", put(COARSE, {"loop.damping_N_s_per_m": "31/36"})),
    taken(
        "in and out",
        1,
        THERE,
        hands="every",
        contact="kept",
        encoder="ideal",
        force_limit=False,
        force_steps=False,
        fed_with="",
    ),
    taken("T = 2", "3/2", put(THERE, {"loop.sample_period_s": 2})),
    taken("friction on the way", "1/2", put(THERE, {"loop.coulomb_friction_N": "1/4"})),
    taken(
        "from outside", "1/2", put(THERE, {"positions_m": [-1, 1, 1, 0, 0], "loop.damping_N_s_per_m": "3/10"})
    ),
    taken(
        "it leaves and comes back", 2, put(THERE, {"positions_m": [0, 1, 0, 1, 0]}), contact="made and broken"
    ),
    taken("without a surface", 1, put(THERE, {"loop.unilateral": False}), contact="both sides"),
    taken("out to the other side", 1, put(THERE, {"loop.unilateral": False, "positions_m": [0, -1, 0]})),
    taken("a sample late", 1, put(THERE, {"loop.delay_s": 1, "positions_m": [0, 1, 1, 0]})),
    taken("two samples late", 1, put(THERE, {"loop.delay_s": 2, "positions_m": [0, 1, 1, 1, 0]})),
    refused(
        "late, it gets nothing", put(THERE, {"loop.delay_s": 1}), "extracts -1 J, no more than the 0 J", -1
    ),
    taken("a quarter of a sample late", "1/2", QUARTER),
    taken("a quarter late, friction", "1/4", put(QUARTER, {"loop.coulomb_friction_N": "1/8"})),
    # squares over time: 1/16 · 4 + 9/16 · 4/3 = 1 in, 4/3 out
    taken(
        "one and a quarter late",
        "1/2",
        put(
            QUARTER,
            {"loop.delay_s": "5/4", "positions_m": [0, 1, 1, 0], "switch_positions_m": ["1/4", 1, "3/4"]},
        ),
    ),
    taken("an encoder reads less", "1/2", put(THERE, {"loop.resolution_m": "3/4"}), encoder="counted"),
    taken("three steps", 3, STEPS),
    taken("a filter", "1/2", FILTER),
    taken(
        "a filter that divides", "1/2", put(FILTER, {"loop.numerator": [2, 0], "loop.denominator": [2, -1]})
    ),
    # 1/(2 − ζ) ·2: the same with memory that is no whole number: 3 samples in, forces 0, 1, 3/2, 7/4
    taken("a filter, longer", "3/4", put(FILTER, {"positions_m": [0, 1, 1, 1, 0]})),
    # K + (1 − ζ): the forces 0, 3, 2
    taken("a damper", 1, motion([0, 1, 1, 0], 0, [3, -1], [1, 0], **FREE)),
    # a pole at −1/2, 3/(3 + 3ζ/2): forces 0, 1, 1/2, 3/4
    taken(
        "a pole below 0",
        "1/4",
        put(
            FILTER,
            {"positions_m": [0, 1, 1, 0], "loop.denominator": [1, "1/2"], "loop.damping_N_s_per_m": "1/8"},
        ),
    ),
    taken("rounds that return", 5, repeated(THERE, (0, 2, 5))),
    taken(
        "two parts with rounds",
        8,
        repeated(put(THERE, {"positions_m": [0, 1, 0, 1, 0, 1, 0]}), (0, 2, 5), (4, 6, 2)),
    ),
    taken("one round", 1, repeated(THERE, (0, 2, 1))),
    *(taken(f"{n} rounds that go on", Fraction(n * n + n, 2), climb(n)) for n in (1, 2, 3, 1000, 10**6)),
    taken("rounds that go on, friction", 1250, put(climb(100), {"loop.coulomb_friction_N": 19})),
    taken("rounds that go on, inside", 5050, put(climb(100), {"loop.unilateral": True})),
    # 198 · 100 − 2 Σ (k − 1) − b (100 + 10 000)
    taken("rounds that go on, a sample late", 5048, put(climb(100), {"loop.delay_s": 1})),
    taken("an encoder, rounds that go on", 5050, put(climb(100), {"loop.resolution_m": "1/2"})),
    taken(
        "an encoder coarser than a round",
        5048,  # 198 · 100 − 2 · 4851 − b (100 + 10 000)
        put(climb(100), {"loop.resolution_m": 3}),
    ),
    accepted("an energy within a part in 10⁹", put(THERE, {"energy_J": "1.000000001"}), energy=1),
    accepted("an energy within a part in 10⁹, less", put(THERE, {"energy_J": "0.999999999"}), energy=1),
    refused("an energy that is too large", put(THERE, {"energy_J": "1.0000000011"}), "the energy is", 1),
    refused("an energy that is too small", put(THERE, {"energy_J": "0.9999999989"}), "the energy is", 1),
    refused("no energy told", without(THERE, "energy_J"), "energy_J is missing"),
    accepted("a sample period beside it", put(THERE, {"sample_period_s": 1})),
    refused("another sample period beside it", put(THERE, {"sample_period_s": 2}), "T is 1 s, not 2 s"),
    refused("nothing comes out", put(THERE, {"loop.damping_N_s_per_m": 1, "energy_J": 0}), NONE, 0),
    refused("it begins inside", put(THERE, {"positions_m": ["1/1000", 1, 0]}), "start at rest outside"),
    refused(
        "it begins inside, within the first count",
        put(THERE, {"positions_m": ["1/1000", 1, 0], "loop.resolution_m": "1/4"}),
        "start at rest outside",
    ),
    refused(
        "it begins in a spring that is pressed", put(STEPS, {"positions_m": [1, 0]}), "start at rest at x = 0"
    ),
    refused(
        "it begins in a spring that is drawn", put(STEPS, {"positions_m": [-1, 0]}), "start at rest at x = 0"
    ),
    refused(
        "it begins in another count",
        put(STEPS, {"positions_m": ["1/2", 1, 2, 0], "loop.resolution_m": "1/2"}),
        "start at rest at x = 0",
    ),
    refused("one position", put(THERE, {"positions_m": [0]}), "positions_m must have 2 to 4000000 entries"),
    refused(
        "a law with memory is left",
        put(FILTER, {"loop.unilateral": True, "positions_m": [0, 1, 0, 1, 0]}),
        BACK,
    ),
    taken("a law with memory, not left", "1/2", put(FILTER, {"loop.unilateral": True})),
    refused(
        "a switch position too many",
        put(QUARTER, {"switch_positions_m": ["1/4", "3/4", 0]}),
        "one switch position in each",
    ),
    refused(
        "a switch position too few",
        put(QUARTER, {"switch_positions_m": ["1/4"]}),
        "one switch position in each",
    ),
    refused("no switch positions", without(QUARTER, "switch_positions_m"), "switch_positions is missing"),
    refused("no positions", without(THERE, "positions_m"), "positions_m is missing"),
    refused("repeats that are no list", put(THERE, {"repeats": {}}), "repeats must be a list"),
    *(
        refused(f"rounds of {part}", repeated(THERE, part), "repeated parts must lie")
        for part in ((1, 1, 2), (2, 1, 2), (0, 3, 2))
    ),
    refused(
        "parts that overlap",
        repeated(put(THERE, {"positions_m": [0, 1, 0, 1, 0]}), (0, 2, 2), (1, 3, 2)),
        "one after the other",
    ),
    accepted(
        "parts that touch",
        put(repeated(put(THERE, {"positions_m": [0, 1, 0, 1, 0]}), (0, 2, 2), (2, 4, 2)), {"energy_J": 4}),
        energy=4,
    ),
    refused("no round", repeated(THERE, (0, 2, 0)), "repeats[0].times must be ≥ 1"),
    # stored: H(1) Δ²/8 with Δ = 2, K = 2: 1 J.  From the edge of a count, −ε → 1: at −ε the reading is −2
    refused("no more than what half a count stores", put(HALF, {"energy_J": 1}), "no more than the 1 J", 1),
    taken(
        "more than what half a count stores",
        "1.004",
        put(HALF, {"positions_m": [0, "-1/1000", "1/4"]}),
        encoder="counted",
    ),
    refused(
        "twice the stiffness stores twice as much",
        put(
            HALF, {"loop.numerator": [4], "positions_m": [0, "-1/1000", "1/4"], "loop.coulomb_friction_N": 1}
        ),
        "no more than the 2 J",
    ),
    refused(
        "what half a count stores, D scaled",
        put(HALF, {"loop.numerator": [4], "loop.denominator": [2], "energy_J": 1}),
        "no more than the 1 J",
        1,
    ),
    # the force 2 of 1 acts for a quarter of the next sample: 3/2 + 2 · 1/4
    taken(
        "a quarter late, the old force at first",
        2,
        put(
            QUARTER,
            {
                "positions_m": [0, 1, 0, "-1/2"],
                "switch_positions_m": ["1/4", "3/4", "-1/4"],
                "loop.damping_N_s_per_m": 0,
            },
        ),
        contact="made and broken",
    ),
    # 1/(1 − ζ/2 − ζ²/4): the forces 0, 1, 3/2, 2
    taken(
        "a filter of two poles",
        1,
        put(
            FILTER,
            {
                "positions_m": [0, 1, 1, 1, 0],
                "loop.numerator": [1, 0, 0],
                "loop.denominator": [1, "-1/2", "-1/4"],
            },
        ),
    ),
    taken(
        "a filter of two zeros",
        1,
        put(
            FILTER,
            {
                "positions_m": [0, 1, 1, 1, 0],
                "loop.numerator": [1, "1/2", "1/2"],
                "loop.denominator": [1, 0, 0],
            },
        ),
    ),
    # spring behind a surface, touched from outside: nothing is stored; with a law of memory it is
    refused(
        "a law with memory behind a surface",
        motion([0, 2, "39/20"], "3/20", [1, 1], [1, 0], resolution_m=2, damping_N_s_per_m=0),
        "no more than the 1 J",
    ),
    taken(
        "a spring behind a surface stores nothing",
        "1/5",
        motion([0, 2, "39/20"], 0, resolution_m=2, damping_N_s_per_m=0),
    ),
    # rounds in closed form, once the loop has settled: the energies by going through all of them
    taken(
        "a force that is late to the first round",
        5,
        repeated(motion([0, 1, 0, -1, 0], 5, [1], damping_N_s_per_m=0, delay_s=1, **FREE), (0, 4, 3)),
    ),
    taken(
        "a memory that is late to the first round",
        4,
        repeated(motion([0, -1, -2, -1], 4, [0, 0, 1], [1, 0, 0], damping_N_s_per_m=0, **FREE), (1, 3, 5)),
    ),
    taken(
        "a force that is late to the first round, and pushes",
        5,
        repeated(motion([0, -1, 0, 1, 0], 5, [1], damping_N_s_per_m=0, delay_s=1, **FREE), (0, 4, 3)),
    ),
    taken(
        "a memory that is late to the first round, and grows",
        4,
        repeated(motion([0, 1, 2, 1], 4, [0, 0, 1], [1, 0, 0], damping_N_s_per_m=0, **FREE), (1, 3, 5)),
    ),
    taken(
        "rounds inwards that begin outside",
        18,
        repeated(motion([0, 1, 2, 2, -1, 2, 3, 3], 18, [1], damping_N_s_per_m=0), (3, 7, 4)),
    ),
    taken(
        "rounds inwards of a memory that has not settled",
        30,
        repeated(
            motion([0, 1, 2, 2, 2, 3, -5], 30, [0, 0, 1], [1, 0, 0], damping_N_s_per_m=0, **FREE), (4, 5, 6)
        ),
    ),
    taken(
        "rounds outwards that end outside",
        20,
        repeated(motion([0, 4, 5, 3, 4, 2], 20, [1], [1], damping_N_s_per_m=0, delay_s=0), (3, 5, 6)),
    ),
    taken(
        "rounds inwards of a memory that moves faster",
        102,
        repeated(
            motion([0, 1, 2, 4, 6, 7, -7], 102, [0, 0, 1], [1, 0, 0], damping_N_s_per_m=0, delay_s=0, **FREE),
            (4, 5, 6),
        ),
    ),
    taken(
        "rounds inwards of a memory of which one part has settled",
        75,
        repeated(
            motion([0, 1, 2, 3, 5, 6, -6], 75, [0, 0, 1], [1, 0, 0], damping_N_s_per_m=0, delay_s=0, **FREE),
            (4, 5, 6),
        ),
    ),
    taken(
        "rounds inwards of forces of which one has settled",
        54,
        repeated(motion([0, 1, 3, 4, -6], 54, [1], [1], damping_N_s_per_m=0, delay_s=1, **FREE), (2, 3, 6)),
    ),
    # 5 rounds of 2 − 2 b, and then from 0 to −1 under the force 2 of the last 1: 2 − b
    taken(
        "a late force is left over after rounds that return",
        "13/2",
        repeated(motion([0, 0, 1, 1, 0, -1], 0, delay_s=1, **FREE), (0, 4, 5)),
    ),
    # 1/(1 − ζ): the forces 0, 1, 3, 6, 10, 15; 15 · 2 − 20 − b (5 + 4)
    taken(
        "rounds that go on, of a law that sums up",
        "11/2",
        repeated(motion([0, 1, 2, 0], 0, [1, 0], [1, -1], **FREE), (0, 1, 4)),
    ),
    taken("rounds of half a count", "17/2", HALF_A_COUNT),
    refused("the second round as the first", put(HALF_A_COUNT, {"energy_J": 9}), "the energy is 8.5 J"),
    taken(
        "from rest within the first count",
        1,
        motion(["1/2", "3/2", "1/2"], 1, resolution_m=1, **FREE),
    ),
]
