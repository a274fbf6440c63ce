"""A motion with rounds through a law of readings, the energy by hand; T = Δ = 1, K = 2 taps of readings.

0 → 1 → 0 gains 2 − 2b − 2 f_c in each round.
"""

from __future__ import annotations

from typing import Any

from . import TINY, Fraction, accepted, put, refused, without

LOOP = {
    "damping_N_s_per_m": "1/2",
    "coulomb_friction_N": 0,
    "resolution_m": 1,
    "sample_period_s": 1,
    "delay_s": 0,
}


def motion(positions: Any, part: tuple[int, int, int], law: Any = None, **device: Any) -> Any:
    """A spring with a surface if nothing else is said."""
    first, last, times = part
    return {
        "kind": "contact motion",
        "loop": {**LOOP, **device},
        "law": {"surface": "position", "clamped": False, "taps_N_per_m": [2], **(law or {})},
        "positions_m": list(positions),
        "repeats": {"first": first, "last": last, "times": times},
        "energy_J": 0,
    }


def taken(name: str, energy: Any, told: Any, words: str = "the motion extracts", **facts: Any) -> Any:
    told = put(told, {"energy_J": energy})
    return accepted(name, told, words, energy, **{"shows": "active", **facts})


def law(told: Any, **entries: Any) -> Any:
    return put(told, {f"law.{key}": value for key, value in entries.items()})


def curved(*points: Any, models: Any = ((0, 0),), **more: Any) -> Any:
    """0 → 1 → 0 with a friction curve, (speed, force)."""
    told = without(THERE, "loop.damping_N_s_per_m", "loop.coulomb_friction_N")
    curve = {"friction_curve_m_per_s_N": list(points), "friction_models_N_N_s_per_m": list(models)}
    return put(told, {f"loop.{key}": value for key, value in {**curve, **more}.items()})


THERE = motion([0, 1, 0], (0, 2, 3))
FAR = motion([0, 3, 1, 3, 0], (1, 3, 2))
"""Once 3 there, and twice 3 → 1 → 3: 6 · 2 − 2 · 2 = 8 in a round, at last 6 · 3."""
QUARTER = put(motion([0, 0, 1, 0], (0, 3, 3), delay_s="1/4"), {"switch_positions_m": [0, "1/4", "3/4"]})
# a spring and B (1 − ζ), 3 q − 1 q': at 1 after 0 the force is 3
DAMPED = law(THERE, taps_N_per_m=[3, -1])
OUT = motion([-1, 1, -1], (0, 2, 3), {"taps_N_per_m": [3, -1]})
POINTS = {"taps_N_per_m": [], "points_m_N": [[0, 0], [2, 4], [4, 0]]}
BOTH = {"surface": "none"}
RELAXING = {"relaxing": {"pole": "1/2", "stiffness_N_per_m": 4}}
STEPS = {"force_step_N": "3/2"}
LIMIT = {"force_limit_N": "3/2"}
GAIN = "more with each round"
HOLD = motion([0, 0, 1, 1, 0], (0, 4, 3))
PRESSED = motion([0, 3, 0, -1, 0, 1, 1, 0], (2, 7, 3), delay_s=1)

# rounds 2 → 3 → 2: 9 − 1 − 2 b − 2 f_c = 5 in each, 1 + b + f_c on the way in; ½ (½)² stored at 1 − Δ/2
HELD = law(
    motion([1, 2, 3, 2], (1, 3, 3), coulomb_friction_N=1),
    surface="none",
    taps_N_per_m=[],
    points_m_N=[[-1, -1], [1, 1], [2, 1], [3, 9]],
)


def beside(height: Any, **entries: Any) -> Any:
    """The same with a force to smaller x over 2 m there: so much lower lies what is behind."""
    hill = [[-4, 0], [-3, height], [-2, 0]]
    return law(HELD, points_m_N=[*hill, [0, 0], [1, 1], [2, 1], [3, 9]], **entries)


CASES = [
    taken(
        "three rounds",
        3,
        THERE,
        "the motion extracts 3 J, and 1 J more with each round",
        hands="every",
        contact="made and broken",
        encoder="counted",
        force_limit=False,
        force_steps=False,
        fed_with="",
    ),
    taken("T = 2", "9/2", put(THERE, {"loop.sample_period_s": 2})),
    taken("friction", "3/2", put(THERE, {"loop.coulomb_friction_N": "1/4"})),
    taken("a coarse reading", "3/2", put(THERE, {"loop.resolution_m": "3/4"})),
    taken("before and after the rounds", 34 - Fraction(9 + 4 * 4 + 9, 2), FAR),
    taken("many rounds", 10**6, put(THERE, {"repeats.times": 10**6})),
    taken("a sample late", 3, put(HOLD, {"loop.delay_s": 1})),
    taken("a quarter late", "3/2", QUARTER),
    taken("a quarter late, friction", "3/4", put(QUARTER, {"loop.coulomb_friction_N": "1/8"})),
    taken(
        "a quarter late, more of the way",
        "7/4",
        put(QUARTER, {"switch_positions_m": [0, "1/4", 1], "loop.damping_N_s_per_m": "17/28"}),
    ),
    taken(
        "one and a quarter late",
        "3/2",
        put(
            QUARTER,
            {
                "loop.delay_s": "5/4",
                "positions_m": [0, 0, 0, 1, 1, 0],
                "switch_positions_m": [0, 0, "1/4", 1, "3/4"],
                "repeats.last": 5,
            },
        ),
    ),
    refused(
        "too few rounds to settle", put(HOLD, {"loop.delay_s": 2, "repeats.times": 1}), "has not settled"
    ),
    # a sample late: to −1 under the force before the round, 6 of the 3, then 2, 2; from 1 under 2 in each;
    # 4 b in each round, 18 b before them
    taken("a first round with a larger force", 1, PRESSED),
    refused("every round as the first", put(PRESSED, {"energy_J": 9}), "the energy is 1 J", 1),
    refused("nothing comes out", put(THERE, {"loop.damping_N_s_per_m": 1}), "none comes out", 0),
    refused(
        "nothing comes out of a round, but of what follows",
        put(FAR, {"loop.damping_N_s_per_m": 1}),
        "none comes out",
    ),
    refused("rounds gain and all does not", motion([0, -9, 0, 1, 0], (2, 4, 3)), "none comes out", -78),
    refused("another energy", put(THERE, {"energy_J": 2}), "the energy is 3 J, not 2 J", 3),
    refused(
        "another sample period beside it",
        put(THERE, {"energy_J": 3, "sample_period_s": 2}),
        "T is 1 s, not 2 s",
    ),
    # the law
    taken("two taps", "9/2", put(DAMPED, {"loop.damping_N_s_per_m": "3/4"})),
    taken("position: 1 after −1 is 4", 18, put(OUT, {"loop.damping_N_s_per_m": "1/4"})),
    taken(
        "penetration: 1 after −1 is 3",
        12,
        put(law(OUT, surface="penetration"), {"loop.damping_N_s_per_m": "1/4"}),
    ),
    taken(
        "without a surface it pulls outside",
        3,
        law(motion([0, -1, 0], (0, 2, 3)), **BOTH),
        contact="both sides",
    ),
    refused("with one it does not", motion([0, -1, 0], (0, 2, 3)), "none comes out", -3),
    refused(
        "clamped without a surface",
        law(motion([0, -1, 0], (0, 2, 3)), surface="none", clamped=True),
        "none comes out",
        -3,
    ),
    taken("the force limit", "3/2", law(THERE, **LIMIT), force_limit=True),
    taken(
        "the force limit, drawn",
        "3/2",
        law(motion([0, -1, 0], (0, 2, 3)), **BOTH, **LIMIT),
        force_limit=True,
        contact="both sides",
    ),
    taken("the force limit is not reached", 3, law(THERE, force_limit_N=2), force_limit=True),
    taken("steps of the converter, down to 1.5", "3/2", law(THERE, **STEPS), force_steps=True),
    taken("steps of the converter, up to 3", 6, law(THERE, taps_N_per_m=["9/4"], **STEPS), force_steps=True),
    taken(
        "steps of the converter, just less",
        "3/2",
        law(THERE, taps_N_per_m=["2.2499"], **STEPS),
        force_steps=True,
    ),
    taken(
        "steps, then the limit",
        3,
        law(THERE, taps_N_per_m=["9/4"], force_step_N="3/2", force_limit_N=2),
        force_steps=True,
        force_limit=True,
    ),
    # points
    taken("points, rising", 3, law(THERE, **POINTS)),
    taken("points, at one of them", 4 * 6 - 12, law(motion([0, 2, 0], (0, 2, 3)), **POINTS)),
    taken(
        "points, falling",
        18 - 9,
        put(law(motion([0, 3, 0], (0, 2, 3)), **POINTS), {"loop.damping_N_s_per_m": "1/6"}),
    ),
    refused("points, beyond the last", law(motion([0, 5, 0], (0, 2, 3)), **POINTS), "none comes out", -75),
    taken(
        "points, before the first, ½ stored",
        "5/2",
        law(
            motion([0, -1, 0], (0, 2, 3)), surface="none", taps_N_per_m=[], points_m_N=[["-1/2", -2], [0, 0]]
        ),
        contact="both sides",
    ),
    taken("begun where friction holds", 15 - Fraction(5, 2) - Fraction(1, 8), HELD, contact="both sides"),
    refused("begun where friction is less", put(HELD, {"loop.coulomb_friction_N": 1 - TINY}), "must begin"),
    refused("begun inside a surface, held", law(HELD, surface="position"), "must begin"),
    refused("taps, begun in a force", law(without(HELD, "law.points_m_N"), taps_N_per_m=[1]), "must begin"),
    taken("begun high up", 15 - Fraction(5, 2) - Fraction(9, 8), beside(1), contact="both sides"),
    refused("no more than was stored", beside(20), "none comes out", Fraction(100, 8) - Fraction(161, 8)),
    refused("what the limit lets out", beside(20, force_limit_N=10), "none comes out", "-21/8"),
    # 1 + ρ Δq: 2 · (1 + ½) at 1 after 0
    taken("a force that grows with the way", 6, law(THERE, rate_per_m="1/2", **POINTS)),
    taken("clamped, where it would pull", 3 * 0 + 3, law(THERE, clamped=True)),
    refused("a force of a way without points", law(THERE, rate_per_m=1), "only a law given by points"),
    refused("relaxing, not settled", law(THERE, **RELAXING), "has not settled"),
    # at 1 from rest 2 + 4 (1 − a): what a is kept to takes 4 · 2/(1 − p)/2⁸⁰ in a passage
    taken(
        "relaxing, p = 0", 15 - Fraction(24, 2**80), law(THERE, relaxing={"pole": 0, "stiffness_N_per_m": 4})
    ),
    taken(
        "relaxing that resets at the surface", 15 - Fraction(48, 2**80), law(THERE, resets=True, **RELAXING)
    ),
    # 1 → 2 → 1 → 0: 2 + 4, then 4 + 4 (2 − ½) = 10, then 2 + 4 (1 − 5/4) = 1
    taken(
        "relaxing, deeper",
        3 * (-6 + 10 + 1 - 2) - Fraction(96, 2**80),
        law(motion([0, 1, 2, 1, 0], (0, 4, 3)), resets=True, **RELAXING),
    ),
    taken(
        "relaxing from −1, fed with the position",
        48 - Fraction(48, 2**80),
        law(motion([-1, 1, -1], (0, 2, 3)), relaxing={"pole": 0, "stiffness_N_per_m": 4}),
    ),
    taken(
        "relaxing from −1, fed with the penetration",
        24 - Fraction(48, 2**80),
        law(
            motion([-1, 1, -1], (0, 2, 3)),
            surface="penetration",
            relaxing={"pole": 0, "stiffness_N_per_m": 4},
        ),
    ),
    refused(
        "relaxing, the rounding of its average not taken off",
        put(law(THERE, resets=True, **RELAXING), {"energy_J": "15.0000001"}),
        "the energy is",
    ),
    # a sample late: at 1, 1, 1 the averages 0, ½, ¾, the forces 6, 4, 3, and the last takes it back: 3 − 2 b
    taken(
        "relaxing, a sample late",
        3 * (3 - 1) - Fraction(48, 2**80),
        law(motion([0, 0, 1, 1, 1, 1, 0], (0, 6, 3), delay_s=1), resets=True, **RELAXING),
    ),
    # at 1 the reading two samples ago is −1, in later rounds 1: 3 · 3/2, 1 · 3/2, 1 · 3/2, less 9/2 b in each
    taken(
        "at rest within a count, remembered for two samples",
        "51/8",
        motion(["-1/2", 1, "-1/2"], (0, 2, 3), {"taps_N_per_m": [2, 0, -1]}, damping_N_s_per_m="1/12"),
    ),
    refused("resets of a law that does not relax", law(THERE, resets=True), "only a law that relaxes"),
    refused("no resets of a law that does not relax", law(THERE, resets=False), "only a law that relaxes"),
    refused("a step of 0", law(THERE, force_step_N=0), "force_step_N must be > 0"),
    refused("a step below 0", law(THERE, force_step_N=-1), "force_step_N must be > 0"),
    refused(
        "a step of a law that relaxes",
        law(THERE, force_step_N=1, **RELAXING),
        "no force_step",
    ),
    refused("a limit of 0", law(THERE, force_limit_N=0), "none comes out"),
    # 1 − ρ at 1 after 2, 2 · 1: with ρ = ½ on the way back 1 · 1, and 4 (1 + 1) at 2 after 0
    taken(
        "a force that grows with the way, back again",
        3 * (8 + 1 - 3),
        law(motion([0, 2, 1, 0], (0, 3, 3)), rate_per_m="1/2", **POINTS),
    ),
    taken(
        "clamped: ρ = 2 would pull on the way back",
        3 * (4 * 5 + 0 - 3),
        law(motion([0, 2, 1, 0], (0, 3, 3)), rate_per_m=2, clamped=True, **POINTS),
    ),
    taken(
        "not clamped: ρ = 2 pulls on the way back",
        3 * (4 * 5 - 2 - 3),
        law(motion([0, 2, 1, 0], (0, 3, 3)), rate_per_m=2, **POINTS),
    ),
    taken(
        "before the first point, 5/12 stored",
        3 - Fraction(5, 12),
        law(
            motion([0, -3, 0], (0, 2, 3)), surface="none", taps_N_per_m=[], points_m_N=[[-1, "-10/3"], [0, 0]]
        ),
        contact="both sides",
    ),
    refused("a limit below 0", law(THERE, force_limit_N=-1), "force_limit_N must be ≥ 0"),
    refused("taps and points", law(THERE, points_m_N=[[0, 0], [1, 1]]), "either taps or points"),
    refused("no taps and no points", law(THERE, taps_N_per_m=[]), "either taps or points"),
    refused("points that go back", law(THERE, taps_N_per_m=[], points_m_N=[[0, 0], [0, 1]]), "must increase"),
    refused("another surface", law(THERE, surface="both"), "surface must be"),
    refused("clamped is a word", law(THERE, clamped="no"), "clamped must be true or false"),
    refused("resets is a word", law(THERE, resets="no"), "resets must be"),
    refused(
        "a relaxing pole of 1",
        law(THERE, relaxing={"pole": 1, "stiffness_N_per_m": 1}),
        "relaxing.pole must be < 1",
    ),
    refused(
        "a relaxing pole below 0",
        law(THERE, relaxing={"pole": "-1/2", "stiffness_N_per_m": 1}),
        "relaxing.pole must be ≥ 0",
    ),
    refused("relaxing beside two taps", law(DAMPED, **RELAXING), "has one tap"),
    refused("relaxing beside points", law(THERE, **POINTS, **RELAXING), "has one tap"),
    refused("a key that is entries", law(THERE, remark=1), "entries"),
    refused("51 taps", law(THERE, taps_N_per_m=[0] * 51), "taps_N_per_m must have 0 to 50 entries"),
    # the device
    *(
        refused(
            f"{key} is {value}",
            put(put(THERE, {"loop.damping_N_s_per_m": 0, "energy_J": 6}), {f"loop.{key}": value}),
            "must be",
        )
        for key, value in (
            ("sample_period_s", 0),
            ("sample_period_s", -1),
            ("resolution_m", 0),
            ("resolution_m", -1),
            ("damping_N_s_per_m", -1),
            ("coulomb_friction_N", -1),
            ("delay_s", "-1/8"),
        )
    ),
    refused("51 samples late", put(THERE, {"loop.delay_s": 51}), "longer than can be checked"),
    # the curve: speed 1 has a force of its own
    taken("a friction curve, at a point", 3, curved([0, 1], [1, "1/2"], [2, 1])),
    taken("a friction curve, between points", 3, curved([0, 1], ["1/2", "1/4"], [2, 1])),
    taken("a friction curve, beyond its points", 3, curved([0, 0], ["1/4", "1/8"], ["1/2", "1/4"])),
    taken("a friction curve, beyond its points, falling", 3, curved([0, 1], ["1/4", "3/4"], ["1/2", "1/2"])),
    taken("a friction curve, before its points", 3, curved([2, "1/2"], [3, 2])),
    taken("a friction curve, slow steps are cheaper", 3, curved([0, 2], [1, 2], [3, "1/2"])),
    taken("a friction curve, fast moves do not stop", "3/4", curved(["1/4", "1/2"], ["5/4", 1])),
    # T = 2: speed ½
    taken("a friction curve, T = 2", 3, curved([0, 1], ["1/2", "1/2"], [1, 9], sample_period_s=2)),
    taken(
        "a friction curve, far from its last point",
        "9/4",
        curved([0, 0], ["1/4", "1/8"], ["3/4", "3/8"], ["7/8", "1/2"]),
    ),
    taken(
        "a friction curve of three, in its middle",
        "15/4",
        curved([0, "1/4"], ["1/2", "1/4"], ["3/2", "1/2"], [3, 2]),
    ),
    refused("a friction curve of one point", curved([0, 1]), "must have 2 to 10000"),
    refused("a friction curve that goes back", curved([1, 1], [1, 2]), "must increase"),
    refused("a friction curve below 0", curved([0, 1], [1, -1]), "are ≥ 0"),
    refused("a speed below 0", curved([-1, 1], [1, 1]), "are ≥ 0"),
    refused(
        "a friction curve and part of a sample",
        put(curved([0, 1], [1, 1]), {"loop.delay_s": "1/4"}),
        "whole samples",
    ),
    accepted(
        "a model below the curve",
        put(curved([0, "1/2"], [2, 1], models=[["1/2", "1/4"]]), {"energy_J": "3/2"}),
    ),
    refused(
        "a model above the curve",
        curved([0, "1/2"], [2, 1], models=[["0.501", "1/4"]]),
        "not below the friction curve",
    ),
    refused(
        "a model above the curve at its end",
        curved([0, "1/2"], [2, 1], models=[["1/2", "0.2501"]]),
        "not below the friction curve",
    ),
    refused(
        "a model steeper than the curve",
        curved([0, "1/2"], [2, 1], models=[[0, "0.2501"]]),
        "not below the friction curve",
    ),
    accepted(
        "a level model below a falling curve",
        put(curved([0, 1], [2, "1/2"], models=[["1/2", 0]]), {"energy_J": 3}),
    ),
    refused(
        "a model that rises below a falling curve",
        curved([0, 1], [2, "1/2"], models=[[0, "1/1000"]]),
        "not below the friction curve",
    ),
    refused(
        "a friction curve without models",
        without(curved([0, 1], [1, 1]), "loop.friction_models_N_N_s_per_m"),
        "friction_models is missing",
    ),
    refused(
        "models without a friction curve",
        put(THERE, {"loop.friction_models_N_N_s_per_m": [[0, 0]]}),
        "friction_models is of no use here",
    ),
    *(
        refused(
            f"a friction curve, and {name}",
            put(curved([0, 1], [1, 1]), {f"loop.{name}_{unit}": 1}),
            f"{name} is of no use here",
        )
        for name, unit in (("damping", "N_s_per_m"), ("coulomb_friction", "N"))
    ),
    *(
        refused(f"neither {name} nor a friction curve", without(THERE, f"loop.{name}_{unit}"), "is missing")
        for name, unit in (("damping", "N_s_per_m"), ("coulomb_friction", "N"))
    ),
    refused("no models", curved([0, 1], [1, 1], models=[]), "must have 1 to 10001 entries"),
    refused("a model below 0", curved([0, 1], [1, 1], models=[[-1, 0]]), "of a model are ≥ 0"),
    # where it begins, and the rounds
    refused("it begins inside", motion([1, 2, 1], (0, 2, 3)), "begin at rest"),
    # 3 rounds of 4 − 2 − 2 b, and 2 − b on the way out
    refused(
        "it begins inside and ends outside",
        put(motion([1, 2, 1, 0], (0, 2, 3)), {"energy_J": "9/2"}),
        "begin at rest",
    ),
    refused(
        "it begins inside, where there is no force",
        law(motion([1, 2, 1], (0, 2, 3)), taps_N_per_m=[], points_m_N=[[1, 0], [2, 4]]),
        "begin at rest",
    ),
    refused("it begins where the law pulls", law(motion([-1, 0, -1], (0, 2, 3)), **BOTH), "begin at rest"),
    taken(
        "it begins outside", 3, put(motion([0, 1, 0, -1, 0], (0, 4, 3)), {"loop.damping_N_s_per_m": "1/4"})
    ),
    *(
        refused(f"rounds of {part}", motion([0, 1, 0], part), "return to where it began")
        for part in ((0, 1, 3), (1, 1, 3), (2, 0, 3), (0, 3, 3))
    ),
    refused("no round", motion([0, 1, 0], (0, 2, 0)), "repeats.times must be ≥ 1"),
    refused(
        "a switch position too many",
        put(QUARTER, {"switch_positions_m": [0, "1/4", "3/4", 0]}),
        "one switch position",
    ),
    refused("no positions", without(THERE, "positions_m"), "positions_m is missing"),
    # bounds
    taken("within its bounds", 3, put(THERE, {"bounds": {"depth_m": 1, "outside_m": 0, "speed_m_per_s": 1}})),
    taken("no bounds", 3, put(THERE, {"bounds": {}})),
    refused("deeper", put(THERE, {"bounds": {"depth_m": "0.999"}}), "does not keep to its depth"),
    refused(
        "further outside",
        put(motion([0, 1, 0, -1, 0], (0, 4, 3)), {"bounds": {"outside_m": "0.999"}}),
        "does not keep to its outside",
    ),
    refused("faster", put(THERE, {"bounds": {"speed_m_per_s": "0.999"}}), "does not keep to its speed"),
    taken(
        "T = 2, as slow", "9/2", put(THERE, {"loop.sample_period_s": 2, "bounds": {"speed_m_per_s": "1/2"}})
    ),
    taken("within its speed, both parts", "3/2", put(QUARTER, {"bounds": {"speed_m_per_s": 1}})),
    refused(
        "faster in the late part",
        put(QUARTER, {"bounds": {"speed_m_per_s": 1}, "switch_positions_m": [0, "1/8", "3/4"]}),
        "does not keep to its speed",
    ),
    refused(
        "faster in the early part",
        put(QUARTER, {"bounds": {"speed_m_per_s": 1}, "switch_positions_m": [0, "1/4", "5/8"]}),
        "does not keep to its speed",
    ),
    refused(
        "deeper between two readings",
        put(QUARTER, {"bounds": {"depth_m": 1}, "switch_positions_m": [0, "1/4", "5/4"]}),
        "does not keep to its depth",
    ),
    refused("a bound that is entries", put(THERE, {"bounds": {"force_N": 1}}), "entries"),
    refused("a speed in a unit of length", put(THERE, {"bounds": {"speed_m": 1}}), "the unit of speed"),
    refused("bounds that are no object", put(THERE, {"bounds": []}), "must be an object"),
    refused(
        "rounds in which nothing moves, of a law that relaxes",
        law(
            put(motion([0, 3, 3, 3, 0], (1, 2, 5)), {"loop.damping_N_s_per_m": 0, "energy_J": 9}),
            taps_N_per_m=[1],
            relaxing={"pole": 0, "stiffness_N_per_m": 1},
            resets=False,
        ),
        "none comes out",
    ),
]
