"""Null-space springs: Coulomb friction f_c,i ≥ k |((P − P₀) e)_i|, and what is left of the joints' damping.

`null_space.json` has arms with the friction that the bound of each joint asks for, and the damping of joints
that are damped alike at which nothing is left at the rest: by singular values of tensors laid out as
matrices, in doubles.  The checker's own norms are up to a part in 2000 larger, never smaller.
"""

from __future__ import annotations

import json
from importlib import import_module
from math import cos, sin
from pathlib import Path
from typing import Any

from . import Case, Fraction, accepted, plain, put, refused, without

ARMS = json.loads(Path(__file__).with_name("null_space.json").read_text(encoding="utf-8"))
LARGER, HAIR = Fraction("1.002"), Fraction("0.999999")
LESS = "the damping is not enough"


def rubbing(name: str, by: Fraction, joints: list[int] | None = None) -> Any:
    """An arm with the friction that it needs, in some joints times a factor."""
    told = ARMS[name]
    return put(
        told["document"],
        {
            f"arm.joints.{i}.coulomb_friction_N_m": Fraction(f)
            * (by if joints is None or i in joints else LARGER)
            for i, f in enumerate(told["friction_N_m"])
        },
    )


def alike(document: Any, damping: Any) -> Any:
    """Its joints damped alike."""
    joints = range(len(document["arm"]["joints"]))
    return put(document, {f"arm.joints.{i}.damping_N_m_s_per_rad": damping for i in joints})


def damped(name: str, by: Fraction) -> Any:
    """All as the norms ask for, times a factor."""
    told = ARMS[name]
    return alike(told["document"], Fraction(told["damping_N_m_s_per_rad"]) * by)


def moves(name: str, joint: int) -> bool:
    told = ARMS[name]["document"]["arm"]["joints"][joint]
    return bool(told["low_rad"] != told["high_rad"])


def of(name: str) -> list[Case]:
    """Friction and damping, a little more and a little less than is needed."""
    count = len(ARMS[name]["friction_N_m"])
    return [
        accepted(name, rubbing(name, LARGER), "the null-space spring", shows="passive", hands="every",
                 contact="both sides", encoder="ideal", force_limit=False, force_steps=False, fed_with=""),
        *(
            refused(f"{name}, less friction of joint {i + 1}", rubbing(name, HAIR, [i]),
                    f"Coulomb friction of joint {i + 1}")
            for i in range(count) if moves(name, i)
        ),
    ]  # fmt: skip


POINT, PLANE, HELD, DAMPER = (
    ARMS[name]["document"]
    for name in ("a point in space", "in pose in the plane", "a joint that is held", "a damper and a delay")
)
JOINT = "arm.joints.0."
# of a damper alone: d_n (1 + η), and what the wall asks for
DAMPER_AFAR = put(ARMS["a point, far from the rest"]["document"],
                  {"spring.stiffness_N_m_per_rad": 0, "spring.damping_N_m_s_per_rad": 1})  # fmt: skip
# one joint before a wall along x: nothing is left to the spring, and R (0.4 sin q + 0.3 cos q)² to the wall,
# R = 10; 1.59094 at q = 0.28 and 1.14536 at the rest
ONE = put(POINT, {
    "arm.joints": POINT["arm"]["joints"][:1], "arm.end_m": ["0.4", "0.3", "0"],
    "wall.stiffness_N_per_m": [["20000"]],
    **{f"wall.{key}_N_s_per_m": [["0"]] for key in ("virtual_damping", "damping_bound")},
    "spring.rest_rad": ["0.1"], "spring.distance_rad": "0.18",
})  # fmt: skip
IN_SPACE = ARMS["in pose in space"]["document"]
GIVEN = put(IN_SPACE, {
    "arm.joints": [{**IN_SPACE["arm"]["joints"][0], "rest_rad": "0.2"}], "spring.rest_rad": ["0.1"],
    "wall.rest": "given",
})  # fmt: skip
TILTED = POINT["arm"]["joints"][2]["rotation"]
SLIDE = {
    "kind": "prismatic", "rotation": POINT["arm"]["joints"][0]["rotation"], "translation_m": ["0", "0", "0"],
    "low_m": "0", "high_m": "1", "damping_N_s_per_m": "9", "coulomb_friction_N": "9",
}  # fmt: skip


def the_surplus_is_that_of_the_middle() -> str:
    """Of one joint: its damping less what the wall asks for at the rest."""
    found = import_module("zwidth.checker").verify(plain(alike(ONE, 2))).surplus
    right = 2 - 10 * (0.4 * sin(0.1) + 0.3 * cos(0.1)) ** 2
    return "" if len(found) == 1 and abs(found[0][0] - right) < 1e-12 else f"{found}, not {right}"


CASES = [
    *(case for name in ARMS for case in of(name)),
    accepted(
        "a damper and a delay, just damped enough", damped("a damper and a delay", Fraction("1.00001"))
    ),
    refused(
        "a damper and a delay, damped too little", damped("a damper and a delay", Fraction("0.9999")), LESS
    ),
    refused("one more sample of delay", put(damped("a damper and a delay", Fraction("1.00001")),
                                            {"loop.delay_samples": 3}), LESS),
    accepted("a damper far from its rest", alike(DAMPER_AFAR, "1.44")),
    refused("a damper far from its rest, without η", alike(DAMPER_AFAR, "1.43"), LESS),
    accepted("no range at all", put(POINT, {
        **{f"arm.joints.{i}.{end}_rad": at for i, at in enumerate(POINT["spring"]["rest_rad"])
           for end in ("low", "high")},
        **{f"arm.joints.{i}.coulomb_friction_N_m": 0 for i in range(3)}})),
    accepted("no friction where nothing moves", put(rubbing("a joint that is held", LARGER),
                                                    {"arm.joints.2.coulomb_friction_N_m": 0})),
    accepted("no damping where nothing moves", put(rubbing("a joint that is held", LARGER),
                                                   {"arm.joints.2.damping_N_m_s_per_rad": 0})),
    accepted("no spring, no friction", put(POINT, {"spring.stiffness_N_m_per_rad": 0, **{
        f"arm.joints.{i}.coulomb_friction_N_m": 0 for i in range(3)}})),
    accepted("ranges narrower than the distance", put(POINT, {
        f"{JOINT}low_rad": "0.1", f"{JOINT}high_rad": "0.11"})),
    refused("a region that is too large", put(POINT, {"spring.distance_rad": "2"}), "too large"),
    refused("a region that is too large by little", put(POINT, {"spring.distance_rad": "0.29"}), "too large"),
    refused("a singular rest", put(PLANE, {"spring.rest_rad": ["0.1", 0, 0, 0]}), "the arm is singular"),
    refused("a rest outside the range", put(POINT, {"spring.rest_rad": ["0.1", "1.01", "0"]}),
            "in the range of joint 2"),
    refused("a rest below the range", put(POINT, {"spring.rest_rad": ["0.1", "0.1", "-1.01"]}),
            "in the range of joint 3"),
    Case("the surplus is that of the middle", the_surplus_is_that_of_the_middle, ""),
    accepted("one joint in a region", alike(ONE, "1.5912")),
    refused("one joint in a region, with less", alike(ONE, "1.5907"), LESS),
    accepted("an orientation of rest that is given", GIVEN, "from the orientation of rest that is given"),
    refused("an orientation of rest where it may be any", put(GIVEN, {"wall.rest": "every orientation"}),
            "rest_rad is of no use"),
    refused("a rest of too many joints", put(POINT, {"spring.rest_rad": ["0.1", "0.3", "-0.4", 0]}),
            "for each joint"),
    refused("friction told to six digits", rubbing("a point in space", HAIR, [0]), "at least 0.00328"),
    refused("a rest of too few joints", put(POINT, {"spring.rest_rad": ["0.1", "0.3"]}), "for each joint"),
    refused("a joint that slides", put(POINT, {"arm.joints.0": SLIDE}), "of joints that turn"),
    refused("no friction told", without(POINT, f"{JOINT}coulomb_friction_N_m"), "friction is missing"),
    refused("encoder steps", put(POINT, {f"{JOINT}resolution_rad": "0.001"}), "is of no use here"),
    refused("a longest column", put(POINT, {f"{JOINT}largest_column_m_per_rad": 1}), "is of no use here"),
    refused("an orientation of rest", put(POINT, {f"{JOINT}rest_rad": 0}), "is of no use here"),
    refused("a distance of 0", put(POINT, {"spring.distance_rad": 0}), "must be > 0"),
    *(
        refused(f"{key} below 0", put(POINT, {f"spring.{key}": "-0.1"}), "must be ≥ 0")
        for key in ("stiffness_N_m_per_rad", "damping_N_m_s_per_rad", "regularization")
    ),
    refused("a softer spring than none", put(POINT, {"wall.stiffness_N_per_m": [["-1", "0"], ["0", "1"]]}),
            "a negative eigenvalue"),
    refused("axes that are askew, in the plane, in pose",
            put(PLANE, {"arm.joints.3.rotation": TILTED}), "about the same axis"),
]  # fmt: skip
