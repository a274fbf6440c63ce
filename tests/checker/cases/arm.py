"""Arms: δ − JᵀRJ ≻ 0 at one place or in a region, R = (2d + 1) KT/2 + A.

`arms.json` has arms at one place, with the damping of the first joint or leg, or the first entry of the
matrix of those that damp each other, at which the matrix is singular there:
from Jacobians by differences in 40 digits, of homogeneous matrices, and of a leg's angle by arcs.
"""

from __future__ import annotations

import json
from importlib import import_module
from math import cos, sin
from pathlib import Path
from typing import Any

from . import TINY, Case, Fraction, accepted, plain, put, refused, without

ARMS = json.loads(Path(__file__).with_name("arms.json").read_text(encoding="utf-8"))
LESS = "the damping is not enough"
LONGER = 1 + Fraction(1, 10**6)


def first_damping(document: Any) -> str:
    """Where the damping of the first joint or leg stands."""
    arm = document["arm"]
    if matrix := [key for key in arm if key.startswith("damping")]:
        return f"arm.{matrix[0]}.0.0"
    part = "joints" if "joints" in arm else "legs"
    key = next(key for key in arm[part][0] if key.startswith("damping"))
    return f"arm.{part}.0.{key}"


def damped(name: str, by: Any = 1) -> Any:
    """An arm of the file with its damping, times a factor."""
    document = ARMS[name]["document"]
    return put(document, {first_damping(document): Fraction(ARMS[name]["needed"]) * Fraction(by)})


def widened(document: Any, by: str) -> Any:
    """With so much to either side of every coordinate."""
    arm, entries = document["arm"], dict[str, Any]()
    for i, joint in enumerate(arm.get("joints", [])):
        for side, sign in (("low", -1), ("high", 1)):
            key = next(key for key in joint if key.startswith(side))
            entries[f"arm.joints.{i}.{key}"] = Fraction(joint[key]) + sign * Fraction(by)
    if "legs" in arm:
        for side, sign in (("low_m", -1), ("high_m", 1)):
            entries[f"arm.{side}"] = [Fraction(x) + sign * Fraction(by) for x in arm[side]]
    return put(document, entries)


def of(name: str) -> list[Case]:
    """At one place, and in a small box around it."""
    return [
        accepted(
            name,
            damped(name, 1 + TINY),
            "no motion of the hand",
            shows="passive",
            hands="every",
            contact="both sides",
            encoder="ideal",
            force_limit=False,
            force_steps=False,
            fed_with="",
        ),
        refused(f"{name}, but for a hair", damped(name, 1 - TINY), LESS),
        accepted(f"{name}, around it", widened(damped(name, "1.5"), "0.001")),
        refused(f"{name}, around it with less", widened(damped(name, "0.995"), "0.001"), LESS),
    ]


TURNS = damped("turns", 1 + TINY)
# a link of 0.1 m before a wall along x: J = −0.1 sin q, b = R (0.1 sin 0.9)², R = 1000/1000; sin² 0.9 =
# 0.613601047…
SWEEP = put(
    TURNS,
    {
        "arm.end_m": ["0.1", "0", "0"],
        "arm.joints.0.low_rad": "0.2",
        "arm.joints.0.high_rad": "0.9",
        "arm.joints.0.damping_N_m_s_per_rad": "0.0061367",
    },
)
# K = 1000, B = 0.1, T = 1/500: ‖K‖ + 2 ‖B‖/T = 1100
# N = [[r, 1], [1, 0]], r = 0.3 + 0.2 + 0.1: the larger eigenvalue 0.3 + √1.09 = 1.344031 (times a
# millionth more)
SLIDES = put(TURNS, {
    "loop.torque": "held", "loop.largest_force_N": 1, "arm.end_m": ["0.1", "0", "0"],
    "arm.joints": [
        {**TURNS["arm"]["joints"][0], "damping_N_m_s_per_rad": 9},
        {**ARMS["mixed"]["document"]["arm"]["joints"][1], "translation_m": ["0.3", "0", "0"],
         "low_m": "-0.2", "high_m": "0.1",
         "damping_N_s_per_m": 9},
    ],
})  # fmt: skip
COLUMN, STEP = Fraction("0.1000002"), Fraction(1, 1000)
FRICTION = (1100 * STEP * COLUMN**2 + 2 * LONGER * COLUMN * STEP) / 2
COUNTED = put(SWEEP, {
    "loop.encoder": "counted", "loop.torque": "follows the readings", "loop.largest_force_N": "2",
    "wall.virtual_damping_N_s_per_m": [["0.1"]], "wall.damping_bound_N_s_per_m": [["0.1"]],
    "arm.joints.0.resolution_rad": STEP, "arm.joints.0.coulomb_friction_N_m": FRICTION,
    "arm.joints.0.largest_column_m_per_rad": COLUMN, "arm.joints.0.damping_N_m_s_per_rad": "1",
})  # fmt: skip
# a curvature of 1 and 2 N for half of T: 0.002 more than 1.1 · 0.01 · sin² 0.901 = 0.0067604…
HELD_COUNTED = put(COUNTED, {"loop.torque": "held", "loop.curvature_m_per_rad2": "1"})
HELD = damped("held", 1 + TINY)
MIXED, PLANE, EVERY, GIVEN = (
    damped(name, 1 + TINY) for name in ("mixed", "plane pose", "every rest", "given rest")
)
TWO, THREE = damped("two legs", 1 + TINY), damped("three legs", 1 + TINY)
# a region along x: the first leg needs 0.006627 at its left end, and less to the right
REGION = put(TWO, {
    "arm.low_m": ["0.02", "0.13"], "arm.high_m": ["0.04", "0.13"],
    "arm.legs.1.damping_N_m_s_per_rad": "0.05",
})  # fmt: skip
JOINT, LEG = "arm.joints.0.", "arm.legs.0."
ROTATION = [["0.6", "-0.8", "0"], ["0.8", "0.6", "0"], ["0", "0", "1"]]

# two links that turn and a slide between them, in space
LINKS = ("revolute", "prismatic", "revolute")
NEAR = 1 + 2 * (LONGER - 1)


def several(turns: int = 0, **entries: Any) -> Any:
    """A chain of three joints with encoders, all of K = 1000 N/m, B = 0.1 N·s/m along every axis:
    ‖K‖ + 2‖B‖/T is 1100.  In pose 100 N·m/rad as well, coupled by 20 N."""
    size = 3 + turns
    point = [[f"{1000 if i < 3 else 100}" if i == j else "0" for j in range(size)] for i in range(size)]
    if turns:
        point[0][4] = point[4][0] = "20"
    damping = [["0.1" if i == j < 3 else "0" for j in range(size)] for i in range(size)]
    names = ("N_m_rad", "N_m_s_rad", "N_m_s_rad") if turns else ("N_per_m", "N_s_per_m", "N_s_per_m")
    keys = ("stiffness", "virtual_damping", "damping_bound")
    wall = {f"{key}_{name}": m for key, name, m in zip(keys, names, (point, damping, damping), strict=True)}
    more = {"turns": 3, "rest": "given"} if turns else {}
    joints = [
        link(kind, needs, bool(turns)) for kind, needs in zip(LINKS, friction(bool(turns)), strict=True)
    ]
    loop = {
        "sample_period_s": "0.002", "delay_samples": 0, "encoder": "counted",
        "torque": "follows the readings", "largest_force_N": 2,
        **({"largest_moment_N_m": 3} if turns else {}),
    }  # fmt: skip
    arm = {"geometry": "chain", "joints": joints, "end_m": ["0.1", "0", "0"]}
    return put({"kind": "arm", "arm": arm, "wall": {**wall, **more}, "loop": loop}, entries)


STEPS = (Fraction(1, 10**4), Fraction(1, 10**4), Fraction(2, 10**4))
COLUMNS, TURNING = (Fraction(1), LONGER, Fraction(1, 5)), (1, 0, 1)


def friction(pose: bool) -> list[Fraction]:
    """What each of the joints needs: half of what misread counts do to the force, and of what they turn."""
    columns = [COLUMNS, tuple(map(Fraction, TURNING))] if pose else [COLUMNS]
    sizes = [[Fraction(1100), Fraction(20)], [Fraction(20), Fraction(100)]] if pose else [[Fraction(1100)]]
    misread = [sum((s * c for s, c in zip(STEPS, r, strict=True)), Fraction(0)) for r in columns]
    wrong = [sum((a * m for a, m in zip(row, misread, strict=True)), Fraction(0)) for row in sizes]
    bends = [[1, 1, Fraction(1, 5)], [1, 0, 0], [Fraction(1, 5), 0, Fraction(1, 5)]]
    # a slide beyond a joint that turns moves the column of that joint, and one before it does not
    bends[1][2] = bends[2][1] = 1
    out = []
    for i in range(3):
        least = sum((c[i] * w for c, w in zip(columns, wrong, strict=True)), Fraction(0))
        least += 2 * sum((s * LONGER * b for s, b in zip(STEPS, bends[i], strict=True)), Fraction(0))
        turned = sum((s * t for s, t in zip(STEPS, TURNING, strict=True)), Fraction(0))
        out.append((least + (3 * Fraction(TURNING[i], 2) * turned if pose else 0)) / 2)
    return out


def link(kind: str, needs: Fraction, rest: bool) -> dict[str, Any]:
    """About or along its z axis, which stands at right angles to the one before."""
    turn = [["0", "0", "1"], ["1", "0", "0"], ["0", "1", "0"]]
    told = {"kind": kind, "rotation": turn, "translation_m": ["0.1", "0.2", "0"]}
    if kind == "prismatic":
        return {**told, "low_m": "-0.1", "high_m": "0.1", "damping_N_s_per_m": 99, "resolution_m": STEPS[1],
                "coulomb_friction_N": needs}  # fmt: skip
    place = len([k for k in (0, 2) if needs == friction(rest)[k] and k]) * 2
    return {**told, "low_rad": "-0.2", "high_rad": "0.3", "damping_N_m_s_per_rad": 99,
            "resolution_rad": STEPS[place], "coulomb_friction_N_m": needs,
            "largest_column_m_per_rad": COLUMNS[place],
            **({"rest_rad": "0.1"} if rest else {})}  # fmt: skip


CHAIN, POSED = several(), several(3)

# a slide by itself, its hand 2 m off the axis: 1100 Δ/2 for its steps, whatever that distance
SLIDE = put(COUNTED, {
    "arm.end_m": ["2", "0", "0"],
    "arm.joints": [
        {**SLIDES["arm"]["joints"][1], "resolution_m": STEP, "coulomb_friction_N": 550 * STEP * LONGER**2}
    ],
})  # fmt: skip
# the link of 0.1 m in the plane, in pose: 1100 N/m, 20 N and 5 N·m/rad; moments do nothing to what is misread
IN_PLANE = put(PLANE, {
    "arm.end_m": ["0.1", "0", "0"], "arm.joints": [put(COUNTED["arm"]["joints"][0], {
        "coulomb_friction_N_m": STEP * (1100 * COLUMN**2 + 40 * COLUMN + 5 + 2 * LONGER * COLUMN) / 2,
    })],
    "wall.stiffness_N_m_rad": [["1000", "0", "20"], ["0", "1000", "0"], ["20", "0", "5"]],
    **{f"wall.{key}_N_m_s_rad": [["0.1", "0", "0"], ["0", "0.1", "0"], ["0", "0", "0"]]
       for key in ("virtual_damping", "damping_bound")},
    "loop": {**COUNTED["loop"], "largest_moment_N_m": 3},
})  # fmt: skip
# a limit of 0 is one that is told
NO_MOMENT = put(ARMS["held in pose"]["document"], {"loop.largest_moment_N_m": 0})
NO_FORCE = put(HELD, {"loop.largest_force_N": 0})


def turned_in_space(document: Any) -> Any:
    """The same arm of legs, seen by one who stands askew."""
    turn = [[Fraction(x, 3) for x in row] for row in ((2, -1, 2), (2, 2, -1), (-1, 2, 2))]

    def seen(v: Any) -> list[Fraction]:
        return [sum((r * Fraction(x) for r, x in zip(row, v, strict=True)), Fraction(0)) for row in turn]

    arm = document["arm"]
    legs = [{**leg, **{key: seen(leg[key]) for key in ("base_m", "out", "up")}} for leg in arm["legs"]]
    wall = {
        key: [seen(row) for row in zip(*map(seen, rows), strict=True)]
        for key, rows in document["wall"].items()
    }  # R (R A)ᵀ = R A Rᵀ of a symmetric A
    return {
        **document,
        "arm": {**arm, "legs": legs, **{key: seen(arm[key]) for key in ("low_m", "high_m")}},
        "wall": wall,
    }


def the_surplus_is_that_of_the_middle() -> str:
    """b − R (∂x/∂q)² of one joint whose region is not the same on both sides of 0; R = 1."""
    link = put(SWEEP, {"arm.end_m": ["0.1", "0.02", "0"], f"{JOINT}damping_N_m_s_per_rad": 1})
    found = import_module("zwidth.checker").verify(plain(link)).surplus
    right = 1 - (0.1 * sin(0.55) + 0.02 * cos(0.55)) ** 2
    return "" if len(found) == 1 and abs(found[0][0] - right) < 1e-12 else f"{found}, not {right}"


CASES = [
    *(case for name in ARMS for case in of(name)),
    # a region
    accepted(
        "a sweep",
        SWEEP,
        "with every joint in its range takes energy out, read without encoder steps; the torque follows the ",
    ),
    refused("a sweep with less", put(SWEEP, {f"{JOINT}damping_N_m_s_per_rad": "0.0061355"}), LESS),
    accepted("a sweep to the other side", put(SWEEP, {f"{JOINT}low_rad": "-0.9", f"{JOINT}high_rad": "0.2"})),
    refused(
        "a sweep to the other side with less",
        put(
            SWEEP,
            {
                f"{JOINT}low_rad": "-0.9",
                f"{JOINT}high_rad": "0.2",
                f"{JOINT}damping_N_m_s_per_rad": "0.0061355",
            },
        ),
        LESS,
    ),
    accepted(
        "a sweep past where it is most",
        put(SWEEP, {f"{JOINT}high_rad": "2.9", f"{JOINT}damping_N_m_s_per_rad": "0.010001"}),
    ),
    refused(
        "a sweep past where it is most, with less",
        put(SWEEP, {f"{JOINT}high_rad": "2.9", f"{JOINT}damping_N_m_s_per_rad": "0.009999"}),
        LESS,
    ),
    refused(
        "an angle too many turns from 0",
        put(SWEEP, {f"{JOINT}low_rad": "64", f"{JOINT}high_rad": "64.1"}),
        "too many turns",
    ),
    accepted(
        "an angle of ten turns",
        put(
            TURNS,
            {f"{JOINT}low_rad": "63.9", f"{JOINT}high_rad": "63.9", f"{JOINT}damping_N_m_s_per_rad": "1"},
        ),
    ),
    refused(
        "a slide farther than 2⁶⁴",
        put(TURNS, {"arm.joints": [{**MIXED["arm"]["joints"][1], "low_m": -1 - 2**64, "high_m": 0}]}),
        "a number is too large",
    ),
    # encoders
    accepted(
        "an encoder", COUNTED, "and the torque follows the readings, for forces up to 2 N", encoder="counted"
    ),
    refused(
        "less friction for its encoder",
        put(COUNTED, {f"{JOINT}coulomb_friction_N_m": FRICTION - TINY}),
        "Coulomb friction of joint 1",
    ),
    refused("larger forces", put(COUNTED, {"loop.largest_force_N": "2.001"}), "Coulomb friction of joint 1"),
    refused(
        "larger steps", put(COUNTED, {f"{JOINT}resolution_rad": "0.00100001"}), "Coulomb friction of joint 1"
    ),
    refused(
        "a longer column than it is said",
        put(COUNTED, {f"{JOINT}largest_column_m_per_rad": "0.1"}),
        "longer than it is said",
    ),
    accepted(
        "no range, no steps",
        put(
            COUNTED, {f"{JOINT}low_rad": "0.5", f"{JOINT}high_rad": "0.5", f"{JOINT}coulomb_friction_N_m": 0}
        ),
    ),
    accepted("an encoder, held", HELD_COUNTED, "is held over a period"),
    refused(
        "an encoder, held, with less damping",
        put(HELD_COUNTED, {f"{JOINT}damping_N_m_s_per_rad": "0.00875"}),
        LESS,
    ),
    *(
        refused(f"an encoder, {key} below 0", put(COUNTED, {f"{JOINT}{key}": "-0.001"}), "must be ≥ 0")
        for key in ("resolution_rad", "coulomb_friction_N_m", "largest_column_m_per_rad")
    ),
    *(
        case
        for name, told in (("three joints", CHAIN), ("three joints, in pose", POSED))
        for case in (
            accepted(f"encoders of {name}", told, "follows the readings"),
            *(
                refused(
                    f"encoders of {name}, less friction of {place + 1}",
                    put(
                        told,
                        {f"arm.joints.{place}.{key}": Fraction(told["arm"]["joints"][place][key]) - TINY},
                    ),
                    f"Coulomb friction of joint {place + 1}",
                )
                for place, key in enumerate(
                    ("coulomb_friction_N_m", "coulomb_friction_N", "coulomb_friction_N_m")
                )
            ),
        )
    ),
    accepted("moments are told", POSED, "moments up to 3 N·m"),
    accepted("no moments are told of a point", COUNTED, "for forces up to 2 N; 2 cells"),
    accepted("a slide far from its axis", SLIDE),
    refused(
        "a slide far from its axis, less friction",
        put(SLIDE, {f"{JOINT}coulomb_friction_N": 550 * STEP * LONGER**2 - TINY}),
        "Coulomb friction of joint 1",
    ),
    accepted("an encoder in the plane, in pose", IN_PLANE, "moments up to 3 N·m"),
    refused(
        "an encoder in the plane, in pose, less friction",
        put(
            IN_PLANE,
            {
                f"{JOINT}coulomb_friction_N_m": IN_PLANE["arm"]["joints"][0]["coulomb_friction_N_m"] - TINY,
            },
        ),
        "Coulomb friction of joint 1",
    ),
    refused(
        "three joints, a longer first column",
        put(CHAIN, {"arm.joints.0.largest_column_m_per_rad": "0.25", "arm.joints.0.coulomb_friction_N_m": 9}),
        "longer than it is said",
    ),
    refused(
        "three joints, a first column that is longer where the translation adds to it",
        put(
            CHAIN, {"arm.joints.0.largest_column_m_per_rad": "0.375", "arm.joints.0.coulomb_friction_N_m": 9}
        ),
        "longer than it is said",
    ),
    refused(
        "three joints, a longer last column",
        put(CHAIN, {"arm.joints.2.largest_column_m_per_rad": "0.09", "arm.joints.2.coulomb_friction_N_m": 9}),
        "longer than it is said",
    ),
    *(
        refused(f"{key} of an arm without steps", put(TURNS, {f"{JOINT}{key}": 0}), "is of no use here")
        for key in ("resolution_rad", "coulomb_friction_N_m", "largest_column_m_per_rad", "rest_rad")
    ),
    refused("a rest in every orientation", put(EVERY, {f"{JOINT}rest_rad": 0}), "is of no use here"),
    refused("a rest in the plane, of a joint", put(PLANE, {f"{JOINT}rest_rad": 0}), "is of no use here"),
    refused(
        "a slide along the axis, in the plane",
        put(
            PLANE,
            {
                "arm.joints.0": {
                    **MIXED["arm"]["joints"][1],
                    "rotation": [["1", "0", "0"], ["0", "1", "0"], ["0", "0", "1"]],
                }
            },
        ),
        "about the same axis",
    ),
    refused(
        "three rows for a pose in space",
        put(
            EVERY,
            {
                f"wall.{key}": [row[:3] for row in rows[:3]]
                for key, rows in EVERY["wall"].items()
                if isinstance(rows, list)
            },
        ),
        "rows",
    ),
    *(
        case
        for name, cells, less in (
            ("mixed", 13, 3),
            ("every rest", 13, 3),
            ("given rest", 22, 3),
            ("plane pose", 63, 1),
        )
        for case in (
            accepted(f"{name}, a wide region", widened(damped(name, 5), "0.3"), f"; {cells} cells"),
            refused(f"{name}, a wide region with less", widened(damped(name, less), "0.3"), LESS),
        )
    ),
    Case("the surplus is that of the middle", the_surplus_is_that_of_the_middle, ""),
    *(
        accepted(f"a wall in pose, {name}", damped(name, 1 + TINY), words)
        for name, words in (
            ("plane pose", "up to 900 N/m and 5 N·m/rad, in every orientation of rest"),
            ("every rest", "up to 900 N/m and 5 N·m/rad, in every orientation of rest"),
            ("given rest", "up to 900 N/m and 5 N·m/rad, from the orientation of rest that is given"),
        )
    ),
    # held
    accepted("held, no forces", NO_FORCE, "for forces up to 0 N;"),
    accepted("held in pose, no moments", NO_MOMENT, "for forces up to 1 N and moments up to 0 N·m"),
    refused("a held torque and a delay", put(HELD, {"loop.delay_samples": 1}), "without a delay"),
    refused(
        "a curvature that is less than the bends",
        put(HELD, {"loop.curvature_m_per_rad2": "0.1"}),
        "can bend more",
    ),
    *(
        case
        for length, link in (("0.1019804", ["0.1", "0.02", "0"]), ("0.25", ["0.15", "0.2", "0"]))
        for told in [
            put(
                TURNS,
                {
                    "loop.torque": "held",
                    "loop.largest_force_N": 1,
                    "arm.end_m": link,
                    f"{JOINT}damping_N_m_s_per_rad": 9,
                },
            )
        ]
        for case in (
            accepted(
                f"a curvature of {length}",
                put(told, {"loop.curvature_m_per_rad2": Fraction(length) * (1 + 2 * (LONGER - 1))}),
            ),
            refused(
                f"a curvature of less than {length}",
                put(told, {"loop.curvature_m_per_rad2": Fraction(length) * (1 - (LONGER - 1))}),
                "can bend more",
            ),
        )
    ),
    refused("forces below 0", put(HELD, {"loop.largest_force_N": "-1"}), "largest_force_N must be ≥ 0"),
    # the wall and the loop
    refused(
        "a stiffness with a negative eigenvalue",
        put(MIXED, {"wall.stiffness_N_per_m": [["1", "2", "0"], ["2", "1", "0"], ["0", "0", "1"]]}),
        "negative eigenvalue",
    ),
    accepted(
        "a stiffness of rank 1",
        put(MIXED, {"wall.stiffness_N_per_m": [["4", "2", "0"], ["2", "1", "0"], ["0", "0", "0"]]}),
    ),
    refused(
        "a stiffness of zero and more beside it",
        put(MIXED, {"wall.stiffness_N_per_m": [["0", "1", "0"], ["1", "9", "0"], ["0", "0", "1"]]}),
        "negative eigenvalue",
    ),
    refused(
        "a stiffness that is not symmetric",
        put(MIXED, {"wall.stiffness_N_per_m": [["4", "2", "0"], ["1", "4", "0"], ["0", "0", "1"]]}),
        "not symmetric",
    ),
    refused(
        "a bound below the damping",
        put(
            MIXED, {"wall.virtual_damping_N_s_per_m": [["0.25", "0", "0"], ["0", "0", "0"], ["0", "0", "0"]]}
        ),
        "is too small",
    ),
    refused(
        "a bound below the negative damping",
        put(
            MIXED, {"wall.virtual_damping_N_s_per_m": [["-0.25", "0", "0"], ["0", "0", "0"], ["0", "0", "0"]]}
        ),
        "is too small",
    ),
    refused(
        "matrices of two sizes", put(MIXED, {"wall.virtual_damping_N_s_per_m": [["0"]]}), "differ in size"
    ),
    refused(
        "a stiffness larger than both other matrices",
        put(MIXED, {"wall.virtual_damping_N_s_per_m": [["0"]], "wall.damping_bound_N_s_per_m": [["0"]]}),
        "differ in size",
    ),
    refused(
        "three rows of two columns",
        put(MIXED, {"wall.stiffness_N_per_m": [["1", "0"], ["0", "1"], ["0", "0"]]}),
        "rows, and as many columns",
    ),
    refused(
        "rows of two lengths",
        put(MIXED, {"wall.stiffness_N_per_m": [["1", "0", "0"], ["0", "1"], ["0", "0", "1"]]}),
        "rows, and as many columns",
    ),
    refused(
        "a matrix of four rows",
        put(MIXED, {"wall.stiffness_N_per_m": [["0"] * 4] * 4}),
        "wall.stiffness_N_per_m must have 1 to 3 entries",
    ),
    refused("T is 0", put(MIXED, {"loop.sample_period_s": 0}), "sample_period_s must be > 0"),
    refused("T is below 0", put(MIXED, {"loop.sample_period_s": -1}), "sample_period_s must be > 0"),
    refused("part of a sample", put(MIXED, {"loop.delay_samples": "1/2"}), "whole number"),
    refused("another encoder", put(MIXED, {"loop.encoder": "coarse"}), "encoder must be ideal or counted"),
    refused("another torque", put(MIXED, {"loop.torque": "follows the readings"}), "or is held"),
    refused(
        "the torque follows the arm, its readings counted",
        put(COUNTED, {"loop.torque": "follows the arm"}),
        "or is held",
    ),
    # chains
    refused("another geometry", put(MIXED, {"arm.geometry": "tree"}), "chain or legs"),
    refused("a joint of another kind", put(MIXED, {f"{JOINT}kind": "ball"}), "revolute or prismatic"),
    refused(
        "no rotation",
        put(MIXED, {f"{JOINT}rotation": [["0.6", "-0.8", "0"], ["0.8", "0.6", "0"], ["0", "0", "1.1"]]}),
        "at right angles",
    ),
    refused(
        "a rotation that is off a little",
        put(MIXED, {f"{JOINT}rotation": [["0.6", "-0.8", "0"], ["0.8", "0.60000001", "0"], ["0", "0", "1"]]}),
        "at right angles",
    ),
    *(
        case(
            f"a rotation longer by {by}",
            put(
                TURNS,
                {f"{JOINT}rotation": [["1", "0", "0"], ["0", "1", "0"], ["0", "0", f"1.000000000{by}"]]},
            ),
            words,
        )
        for case, by, words in ((accepted, 4, ""), (refused, 6, "at right angles"))
    ),
    # what is beyond the first joint slides with the second: N = [[r, 1], [1, 0]] of r = 0.3 + 0.2 + 0.1
    *(
        case(
            f"a joint that slides beyond one that turns, a curvature of {curvature}",
            put(SLIDES, {"loop.curvature_m_per_rad2": curvature}),
            words,
        )
        for case, curvature, words in ((accepted, "1.3441", ""), (refused, "1.3439", "can bend more"))
    ),
    refused(
        "a rotation of two rows",
        put(MIXED, {f"{JOINT}rotation": ROTATION[:2]}),
        "rotation must have 3 to 3 entries",
    ),
    refused("low above high", put(TURNS, {f"{JOINT}low_rad": "0.61"}), "low ≤ high"),
    refused(
        "damping below 0",
        put(MIXED, {f"{JOINT}damping_N_m_s_per_rad": "-1"}),
        "damping_N_m_s_per_rad must be ≥ 0",
    ),
    refused(
        "damping of more than 2⁶⁴",
        put(MIXED, {f"{JOINT}damping_N_m_s_per_rad": 1 + 2**64}),
        "a number is too large",
    ),
    accepted(
        "sixteen joints that stand still",
        put(TURNS, {"arm.joints": [{**TURNS["arm"]["joints"][0], "damping_N_m_s_per_rad": 1}] * 16}),
    ),
    refused("no joints", put(MIXED, {"arm.joints": []}), "arm.joints must have 1 to 16 entries"),
    refused(
        "17 joints",
        put(TURNS, {"arm.joints": TURNS["arm"]["joints"] * 17}),
        "arm.joints must have 1 to 16 entries",
    ),
    refused(
        "an end of two coordinates",
        put(MIXED, {"arm.end_m": ["0", "0"]}),
        "arm.end_m must have 3 to 3 entries",
    ),
    # pose
    refused(
        "a mirror",
        put(EVERY, {f"{JOINT}rotation": [["0.6", "0.8", "0"], ["0.8", "-0.6", "0"], ["0", "0", "1"]]}),
        "must not mirror",
    ),
    refused(
        "a mirror that changes every axis for another",
        put(
            EVERY,
            {
                f"{JOINT}rotation": [["0", "1", "0"], ["0", "0", "1"], ["-1", "0", "0"]],
                f"{JOINT}damping_N_m_s_per_rad": 9,
            },
        ),
        "must not mirror",
    ),
    accepted(
        "a rotation that changes every axis for another",
        put(
            EVERY,
            {
                f"{JOINT}rotation": [["0", "1", "0"], ["0", "0", "1"], ["1", "0", "0"]],
                f"{JOINT}damping_N_m_s_per_rad": 9,
            },
        ),
    ),
    refused("two rotations", put(EVERY, {"wall.turns": 2}), "wall.turns must be 1 or 3"),
    refused("another rest", put(EVERY, {"wall.rest": "any"}), "must be every orientation or given"),
    refused("a rest in the plane", put(PLANE, {"wall.rest": "given"}), "rests in every orientation"),
    refused(
        "forces and turns coupled, in every rest",
        put(GIVEN, {"wall.rest": "every orientation"}),
        "one orientation of rest",
    ),
    refused(
        "a joint that slides, in the plane",
        put(PLANE, {"arm.joints.0": MIXED["arm"]["joints"][1]}),
        "about the same axis",
    ),
    refused(
        "an axis that is turned, in the plane",
        put(PLANE, {"arm.joints.0.rotation": [["1", "0", "0"], ["0", "0", "-1"], ["0", "1", "0"]]}),
        "about the same axis",
    ),
    *(
        refused(
            f"an axis that leans by {lean}, in the plane",
            put(PLANE, {"arm.joints.0.rotation": [["1", "0", "0"], ["0", "1", "0"], [lean, "0", "1"]]}),
            "about the same axis",
        )
        for lean in ("1e-10", "-1e-10")
    ),
    refused("no rest", without(GIVEN, f"{JOINT}rest_rad"), "rest_rad is missing"),
    # legs
    refused("legs in pose", {**TWO, "wall": PLANE["wall"]}, "not of pose"),
    refused(
        "two legs, a region of three coordinates",
        put(TWO, {"arm.low_m": ["0.02", "0.09", "0"], "arm.high_m": ["0.02", "0.09", "0"]}),
        "as many legs as its places have coordinates",
    ),
    refused(
        "three legs, a region of two coordinates",
        put(THREE, {"arm.low_m": ["0.02", "0.09"], "arm.high_m": ["0.02", "0.09"]}),
        "as many legs as its places have coordinates",
    ),
    refused("a wall of three coordinates, two legs", {**TWO, "wall": MIXED["wall"]}, "as many coordinates"),
    refused("a wall of two coordinates, three legs", {**THREE, "wall": TWO["wall"]}, "as many coordinates"),
    refused(
        "legs with encoders",
        put(
            TWO,
            {"loop.encoder": "counted", "loop.torque": "follows the readings", "loop.largest_force_N": 1},
        ),
        "are not bounded",
    ),
    *(
        refused(
            f"a leg, {key} of too many coordinates",
            put(TWO, {f"{LEG}{key}": ["1", "0", "0"]}),
            "as many legs",
        )
        for key in ("base_m", "out", "up")
    ),
    accepted("three legs askew", turned_in_space(THREE)),
    refused("three legs askew, but for a hair", turned_in_space(damped("three legs", 1 - TINY)), LESS),
    accepted("where the left end needs most", put(REGION, {f"{LEG}damping_N_m_s_per_rad": "0.00665"})),
    refused(
        "where the left end needs most, with less",
        put(REGION, {f"{LEG}damping_N_m_s_per_rad": "0.0065"}),
        LESS,
    ),
    refused(
        "legs, held",
        put(
            TWO,
            {
                "loop.torque": "held",
                "loop.largest_force_N": 1,
                "loop.curvature_m_per_rad2": 9,
                "loop.delay_samples": 0,
            },
        ),
        "are not bounded",
    ),
    refused(
        "held, without the largest force", without(HELD, "loop.largest_force_N"), "largest_force_N is missing"
    ),
    *(
        refused(
            f"a leg, {key} of length {length}",
            put(TWO, {f"{LEG}{key}": [Fraction(x) * Fraction(length) for x in TWO["arm"]["legs"][0][key]]}),
            "of length 1, at right angles",
        )
        for key in ("out", "up")
        for length in ("1.00000001", "0.99999999")
    ),
    refused(
        "a leg whose axes lean",
        put(TWO, {f"{LEG}up": [Fraction(x) * (1 - TINY) for x in TWO["arm"]["legs"][0]["out"]]}),
        "of length 1, at right angles",
    ),
    refused("one leg", put(TWO, {"arm.legs": TWO["arm"]["legs"][:1]}), "arm.legs must have 2 to 3 entries"),
    *(
        refused(
            f"{end} of too many coordinates",
            put(TWO, {f"arm.{end}_m": ["0.02", "0.09", "0"]}),
            "as many legs",
        )
        for end in ("low", "high")
    ),
    refused("a region turned round", put(TWO, {"arm.low_m": ["0.03", "0.09"]}), "low ≤ high"),
    *(
        refused(f"a leg, {key} is {value}", put(TWO, {f"{LEG}{key}": value}), f"{key} must be")
        for key, value in (
            ("link_m", 0),
            ("rod_m", 0),
            ("link_m", "-0.1"),
            ("rod_m", "-0.1"),
            ("offset_m", "-0.01"),
            ("damping_N_m_s_per_rad", "-1"),
            ("bend", 0),
            ("bend", True),
            ("bend", 2),
        )
    ),
    refused(
        "out of reach",
        put(TWO, {"arm.low_m": ["0.02", "0.3"], "arm.high_m": ["0.02", "0.3"]}),
        "does not reach",
    ),
    refused("without arm.geometry", without(MIXED, "arm.geometry"), "an object with geometry"),
    refused(
        "too near",
        put(THREE, {"arm.low_m": ["0.3", "0.02", "0.15"], "arm.high_m": ["0.3", "0.02", "0.15"]}),
        "does not reach",
    ),
    *(
        refused(f"without {key}", without(told, key), "is missing")
        for told, key in (
            (MIXED, "arm"),
            (MIXED, "wall"),
            (MIXED, "loop"),
            (MIXED, "loop.encoder"),
            (MIXED, "loop.torque"),
            (MIXED, "loop.delay_samples"),
            (MIXED, "arm.end_m"),
            (TWO, "arm.legs"),
            (TWO, "arm.low_m"),
            (HELD, "loop.largest_force_N"),
            (HELD, "loop.curvature_m_per_rad2"),
            (COUNTED, f"{JOINT}largest_column_m_per_rad"),
        )
    ),
]
