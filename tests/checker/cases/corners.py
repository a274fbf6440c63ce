"""Corners: one proof for each, and what lies between where all are one law but for N, behind one device.

The edges of each proof stand in the file of its kind; here is what several of them say together.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

from . import Case, accepted, plain, positive_real, put, refused, without
from .active_hand import REDUCED
from .contact import DAMPED
from .linear import CONSTANT, FILTER, SPRING, linear, signs
from .motion import THERE
from .nonlinear_spring import RISING
from .quantized import norm, quantized
from .relaxing_contact import ONE, POSITION
from .rest import MOVES, RESTS
from .rotary import turned
from .slow_hands import SPRING as SLOW
from .spring import spring
from .storage import STORAGES
from .violation import SPRING as PULLS


def corners(*listed: Any, **more: Any) -> dict[str, Any]:
    """A document of several."""
    return {"kind": "corners", "corners": list(listed), **more}


MIXED, APART = "and every mix of their laws", "nothing is said of what lies between"
EIGHT, SIX = spring(4), spring(4, [6])
COUNTED = {"coulomb_friction_N": 9, "resolution_m": 1}
PLAIN, LESS = SPRING, linear(2, CONSTANT, [2])
SOFTER = put(DAMPED, {"law.stiffness_N_per_m": 3, "loop.numerator": [15, -18, 6]})
# 2b (17/16 − c/2) − 5/4
QUARTER = linear(3, signs(["41/8", -3]), [1, 0], [1, "-1/4"])
OTHER_WEIGHTS = put(DAMPED, {"law.weights": [1], "loop.numerator": [10, -6, 0]})
BY_NORM = [quantized(told, norm(top=[k]), 2, 3) for told, k in ((PLAIN, 3), (LESS, 2))]
EXTRACTION = next(case.document for case in positive_real.CASES if case.energy is not None)
LIMITED, STEPPED = STORAGES["limited"]["document"], STORAGES["stepped"]["document"]


def rows_are_those_of_the_first() -> str:
    """In its units."""
    verify = import_module("zwidth.checker").verify
    own = verify(plain(turned(SIX))).rows
    return "" if verify(plain(corners(turned(SIX), EIGHT))).rows == own else f"not {own}"


CASES = [
    accepted(
        "two springs", corners(EIGHT, SIX), "all 2 corners: ",
        shows="passive", hands="every", contact="made and broken", encoder="ideal",
        force_limit=False, force_steps=False, fed_with="",
    ),
    accepted("what is said of all is said once", corners(EIGHT, SIX), f"stiffness; {MIXED}"),
    accepted("a format", corners(EIGHT, SIX, format="zwidth certificate 1")),
    *(
        accepted(f"every mix, {name}", corners(*told), MIXED)
        for name, told in (
            ("springs", (EIGHT, SIX)),
            ("springs, an encoder", (spring(4, **COUNTED), spring(4, [6], **COUNTED))),
            ("linear", (PLAIN, LESS)),
            ("quantized", BY_NORM),
            ("contact", (DAMPED, SOFTER)),
            ("one denominator, scaled", (EIGHT, spring(4, [12], [2]))),
            ("one denominator, scaled first", (spring(4, [12], [2]), EIGHT)),
            ("one denominator, below 0 first", (spring(4, [-12], [-2]), EIGHT)),
            ("one alone", (EIGHT,)),
        )
    ),
    *(
        accepted(f"no mix, {name}", corners(*told), APART)
        for name, told in (
            ("another damping", (EIGHT, spring(5, [6]))),
            ("another friction", (EIGHT, spring(4, coulomb_friction_N=1))),
            ("another encoder", (spring(4, **COUNTED), spring(4, **{**COUNTED, "resolution_m": "1/2"}))),
            ("another period", (EIGHT, spring(4, [6], sample_period_s="1/2"))),
            ("another delay", (spring(9), spring(9, [3], delay_s="1/10"))),
            ("a surface and none", (PLAIN, put(LESS, {"loop.unilateral": False}))),
            ("another denominator", (FILTER, QUARTER)),
            ("another denominator, in the other order", (QUARTER, FILTER)),
            ("a longer denominator", (EIGHT, spring(4, [6, 0], [1, 0]))),
            ("a shorter denominator", (spring(4, [6, 0], [1, 0]), EIGHT)),
            ("another weight", (DAMPED, OTHER_WEIGHTS)),
            ("two kinds", (EIGHT, PLAIN)),
            ("two kinds, one device", (spring(2, [3]), LESS)),
            ("two kinds, one device, in the other order", (LESS, spring(2, [3]))),
            ("another in the third place", (EIGHT, SIX, spring(5, [4]))),
            ("a slide and a turn", (EIGHT, turned(SIX))),
            ("a turn and a slide", (turned(SIX), EIGHT)),
            ("laws that relax", (ONE, put(ONE, {"loop.damping_N_s_per_m": 3}))),
            ("points", (RISING, put(RISING, {"loop.damping_N_s_per_m": 99}))),
        )
    ),
    # what they cover together
    *(
        accepted(f"together, {name}", corners(*told), **scope)
        for name, told, scope in (
            ("kept and broken", (EIGHT, PLAIN), {"contact": "kept"}),
            ("broken and kept", (PLAIN, EIGHT), {"contact": "kept"}),
            (
                "broken and both sides",
                (put(PLAIN, {"loop.unilateral": False}), EIGHT),
                {"contact": "made and broken"},
            ),
            ("both sides", (put(PLAIN, {"loop.unilateral": False}),), {"contact": "both sides"}),
            ("steps and none", (EIGHT, spring(4, **COUNTED)), {"encoder": "counted"}),
            ("slow hands and every one", (EIGHT, SLOW), {"hands": "bounded"}),
            ("slow hands first", (SLOW, EIGHT), {"hands": "bounded"}),
            ("hands with an activity, and with none", (REDUCED, EIGHT), {"hands": "every"}),
            ("hands with an activity, and slow ones", (REDUCED, SLOW), {"hands": "bounded"}),
            ("hands with an activity", (REDUCED,), {"hands": "activity"}),
            ("a force limit", (LIMITED,), {"force_limit": True, "force_steps": False}),
            ("a force limit and none", (LIMITED, EIGHT), {"force_limit": False}),
            ("steps of force", (STEPPED,), {"force_limit": True, "force_steps": True}),
            ("steps of force and none", (STEPPED, LIMITED), {"force_limit": True, "force_steps": False}),
            ("fed with the penetration", (EIGHT, ONE), {"fed_with": "penetration"}),
            ("fed with the position", (POSITION, EIGHT), {"fed_with": "position"}),
            ("fed with both", (ONE, POSITION), {"shows": None, "fed_with": None}),
            ("rest, and no energy", (EIGHT, RESTS), {"shows": None}),
            ("no rest, and rest", (MOVES, RESTS), {"shows": None}),
        )
    ),
    # no corners
    refused("one that fails", corners(EIGHT, spring(3)), "damping is below"),
    refused("no proof", corners(EIGHT, THERE), "must be a proof"),
    refused("evidence against", corners(EIGHT, PULLS), "must be a proof"),
    refused("energy out of a port", corners(EXTRACTION), "must be a proof"),
    refused("the same in another format", corners(EIGHT, {**EIGHT, "format": "words"}), "given twice"),
    accepted("the same, proved for more", corners(spring(2, [3]), PLAIN)),
    Case("rows", rows_are_those_of_the_first, ""),
    refused("the same twice", corners(EIGHT, SIX, EIGHT), "given twice"),
    refused("the same in other digits", corners(EIGHT, spring("4.0")), "given twice"),
    refused("no list", {"kind": "corners", "corners": {"0": EIGHT}}, "must be a list"),
    refused("none", corners(), "must be a list"),
    refused("no corners", without(corners(EIGHT), "corners"), "must be a list"),
    refused("4097", corners(*[None] * 4097), "must be a list"),
    refused("4096 of nothing", corners(*[None] * 4096), "must be a certificate"),
    refused("a word", corners(EIGHT, "spring"), "must be a certificate"),
    refused("corners of corners", corners(corners(EIGHT)), "kind must be"),
    refused("an entry more", corners(EIGHT, remark="true"), "beside corners"),
]  # fmt: skip
