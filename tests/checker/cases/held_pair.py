"""Two arms of which a known hand holds one, T = 1 s: what the other arm has to damp.

The need, and the friction for encoders, were computed in 40 digits by another road: the matrix exponential of
arm and hand, the answers of both laws to a wave solved for, the largest need by golden section; ‖h‖₁ by
running both arms, and so the energy of the motions.
"""

from __future__ import annotations

from importlib import import_module
from itertools import product
from typing import Any

from . import TINY, Case, Fraction, accepted, put, refused, without
from .pair import arm, loop


def held(told: Any, mass: Any, damping: Any, stiffness: Any, which: str = "follower") -> Any:
    """What moves there: arm and hand together."""
    moving = {"mass_kg": mass, "damping_N_s_per_m": damping, "stiffness_N_per_m": stiffness}
    return {"kind": "held pair", "loop": told, "held": {"arm": which, **moving}}


def gains(document: Any, cosine: Any) -> Any:
    return {**document, "kind": "held pair violation", "proof": {"cosine": cosine}}


def with_damping(document: Any, value: Any) -> Any:
    """Of the free arm."""
    free = "leader" if document["held"]["arm"] == "follower" else "follower"
    return put(document, {f"loop.{free}.damping_N_s_per_m": value})


def twice_as_quick(document: Any) -> Any:
    """In half the time: all damping by 2, masses by 4; forces and stiffness as they are."""

    def quicker(told: Any) -> Any:
        by = {"_s": 2, "_N_s_per_m": 2, "_kg": 4}
        return {
            key: quicker(value)
            if isinstance(value, dict)
            else Fraction(value) / next((n for end, n in by.items() if key.endswith(end)), 1)
            if key not in ("arm", "cosine", "kind", "energy_J")
            else value
            for key, value in told.items()
        }

    return {**document, "loop": quicker(document["loop"]), "held": quicker(document["held"])}


def other_way_round(document: Any) -> Any:
    """The leader held."""
    told, free = document["loop"], document["held"]
    turned = {**told, "leader": told["follower"], "follower": told["leader"]}
    return {**document, "loop": turned, "held": {**free, "arm": "leader"}}


NOBODY = held(loop(arm(0, "0.4"), arm("0.5", "0.4")), 3, "0.5", 0)
HAND = held(
    loop(
        arm(0, "0.4", virtual_damping_N_s_per_m="0.2", link_delay_s=1),
        arm("0.3", "0.5", virtual_damping_N_s_per_m="0.2", link_delay_s=2),
    ),
    "2.5",
    "1.5",
    "0.3",
)
LATE = held(
    loop(
        arm(0, "0.2", link_delay_s=1, delay_s="0.25"),
        arm(1, "0.2", local_damping_N_s_per_m="0.1", delay_s="1.5"),
    ),
    4,
    1,
    "0.1",
)
SENT = held(
    loop(arm(0, 0, reflection=1, link_delay_s=1), arm(1, "0.3", virtual_damping_N_s_per_m="0.1")),
    2,
    1,
    "0.05",
)
LATER = held(
    loop(
        arm(0, "0.2", link_delay_s=1, delay_s=2),
        arm(2, "0.2", local_damping_N_s_per_m="-0.1", delay_s="0.5"),
    ),
    4,
    2,
    0,
)
NEEDS = {
    "nobody": (NOBODY, "0.3273028516748552861392855", "0.8434555597"),
    "a hand": (HAND, "0.3964112827702556432329583", "-1"),
    "late": (LATE, "0.3270301564412990161429068", "0.931436151707"),
    "a force that is sent": (SENT, "0.4215163957507880009703742", "0.654476953017"),
    "late by two": (LATER, "0.5210488270831630702289079", "0.935821270603"),
}
POSITIVE, GAINS = "is not positive", "not shown to be negative"
ENOUGH = {name: with_damping(told, Fraction(need) * (1 + TINY)) for name, (told, need, _) in NEEDS.items()}
SHORT = {name: with_damping(told, Fraction(need) * (1 - TINY)) for name, (told, need, _) in NEEDS.items()}


def counted(friction: Any) -> Any:
    """Encoders: one count of the free arm, 0.3 of the held one."""
    return put(
        ENOUGH["late"],
        {
            "loop.leader.resolution_m": 1,
            "loop.follower.resolution_m": "0.3",
            "loop.leader.coulomb_friction_N": friction,
        },
    )


def moved(document: Any, damping: Any, friction: Any, path: Any, energy: Any) -> Any:
    """The free arm along a path."""
    told = put(with_damping(document, damping), {"loop.leader.coulomb_friction_N": friction})
    return {**told, "kind": "held pair motion", "positions_m": path, "energy_J": energy}


def polynomials_are_exact() -> str:
    """In powers of w, of ζ and of u, of whole numbers without a radius; at a point of the felt."""
    felt = import_module("zwidth.checker.pair.felt")
    enclosed = import_module("zwidth.checker.exact.enclosed").Enclosed

    def known(*values: int, radius: int = 0) -> list[Any]:
        return [enclosed(8, 256 * v, (), radius) for v in values]

    def at(p: Any, x: Any) -> Any:
        return sum((_read(c) * x**i for i, c in enumerate(p)), 0 * x)

    def _read(c: Any) -> Fraction:
        return Fraction(c) if isinstance(c, int) else Fraction(c.middle, 256)

    a, b, row = known(3, -5, 2, 7), known(4, 1, -6), [2, 0, -1, 4]
    zeta = Fraction(3, 7)
    w = 1 - zeta
    late = felt._delayed(known(5, -2, 3), 4)
    pairs = {
        "in w": (at(felt.in_w(row), w), at(row, zeta)),
        "times": (at(felt.times(a, row), w), at(a, w) * at(row, w)),
        "in ζ": (at(felt.in_zeta(a), zeta), at(a, w)),
        "late": (at(late, w), zeta**4 * (5 * (1 / zeta - 1) ** 2 - 2 * (1 / zeta - 1) + 3)),
        "sum": (at(felt._sum(b, a), w), at(a, w) + at(b, w)),
        "sum turned": (at(felt._sum(a, b), w), at(a, w) + at(b, w)),
    }
    u = Fraction(2, 5)  # ζ = (3 + 4j)/5, w = (2 − 4j)/5
    powers = [(Fraction(1), Fraction(0))]
    for _ in range(3):
        x, y = powers[-1]
        powers.append(((2 * x + 4 * y) / 5, (2 * y - 4 * x) / 5))

    def on_circle(p: Any) -> tuple[Fraction, Fraction]:
        parts = [(_read(c) * x, _read(c) * y) for c, (x, y) in zip(p, powers, strict=False)]
        return sum((x for x, _ in parts), Fraction(0)), sum((y for _, y in parts), Fraction(0))

    for one, other in ((a, b), (b, a), (a, a)):
        (x, y), (s, t) = on_circle(one), on_circle(other)
        found = felt.real_part(one, other, 8)
        pairs[f"real part {len(one)} {len(other)}"] = (at(found, u), x * s + y * t)
        pairs[f"radius {len(one)} {len(other)}"] = (Fraction(sum(c.reach for c in found)), Fraction(0))
        total = felt.at(found, 1 - u)
        pairs[f"at {len(one)} {len(other)}"] = (Fraction(total.middle, 256), (x * s + y * t) * 5**7)
    for sign, more in product((-1, 1), repeat=2):  # what is unknown is within the radius that is found
        bounds = felt.real_part(known(3, -5, 2, 7, radius=8), known(4, 1, -6, radius=8), 8)
        moved = [[c.middle + s * 8 for c in p] for p, s in ((a, sign), (b, more))]
        (x, y), (s, t) = (on_circle([enclosed(8, m) for m in p]) for p in moved)
        off = abs(x * s + y * t - at(bounds, u))
        if off > sum((Fraction(c.radius, 256) * u**i for i, c in enumerate(bounds)), Fraction(0)):
            return f"off by {off}"
    return next((name for name, (found, right) in pairs.items() if found != right), "")


def radii_are_those_of_powers() -> str:
    """Of one power of w and another: |Re wⁱ w̄ᵏ| ≤ (2u)ⁿ, or |i − k| 2ⁿ uⁿ⁺¹ where i + k is odd."""
    circle = import_module("zwidth.checker.pair.felt")
    enclosed = import_module("zwidth.checker.exact.enclosed").Enclosed
    for i, k in product(range(4), repeat=2):
        a, b = ([enclosed(8, 0)] * n + [enclosed(8, 256, (), r)] for n, r in ((i, 3), (k, 0)))
        half, odd = divmod(i + k, 2)
        right = [0] * 8
        right[half + odd] = 3 * 2**half * (abs(i - k) if odd else 1)
        found = [c.radius for c in circle.real_part(a, b, 8)]
        if found != right:
            return f"w^{i}, w^{k}: {found}"
    return ""


def a_polynomial_stays_above_zero_at_every_end() -> str:
    """Where slopes cancel they count together, a radius by itself; for 0 ≤ u ≤ 2 and no further."""
    circle = import_module("zwidth.checker.pair.felt")
    enclosed = import_module("zwidth.checker.exact.enclosed").Enclosed
    refusal = import_module("zwidth.checker.document.refusal").Invalid

    def holds(*depth: tuple[int, tuple[int, ...], int]) -> bool:
        try:
            circle.require_above_zero([enclosed(8, *parts) for parts in depth])
        except refusal:
            return False
        return True

    rows = [
        (((210, (), 0), (-100, (), 0)), True),  # > 0 up to u = 2
        (((190, (), 0), (-100, (), 0)), False),
        (((1, (), 0), (100, (), 0), (0, (), 0), (0, (), 0)), True),
        (((-1, (), 0), (100, (), 0)), False),
        (((6, (), 0), (-20, (), 0), (20, (), 0)), True),  # least at u = 1/2, where it is 1
        (((4, (), 0), (-20, (), 0), (20, (), 0)), False),
        (((100, (99,), 0), (0, (-99,), 0)), True),  # 100 + 99 ε (1 − u)
        (((100, (101,), 0), (0, (-101,), 0)), False),
        (((100, (40, 40), 0), (0, (), 9)), True),
        (((100, (40, 40), 0), (0, (), 10)), False),
        (((100, (-40, 61), 0),), False),
        (((100, (40, -61), 0),), False),
        (((100, (), 99),), True),
        (((100, (), 100),), False),
    ]
    return next((str(depth) for depth, right in rows if holds(*depth) is not right), "")


def sums_of_impulse_responses() -> str:
    """1/(1 − ζ/2) has 2, and 3 (1 + ζ)/(2 + ζ) has 3/2 + 3/4 + 3/8 + …"""
    one_norm = import_module("zwidth.checker.pair.felt").one_norm
    enclosed = import_module("zwidth.checker.exact.enclosed").Enclosed

    def known(*values: Any) -> list[Any]:
        return [enclosed(64, int(v * 2**64)) for v in values]

    for top, bottom, right in (((1,), (1, Fraction(-1, 2)), 2), ((3, 3), (2, 1), 3)):
        found = one_norm(known(*top), known(*bottom))
        if not right <= found <= right * (1 + TINY):
            return f"{float(found)} in the place of {right}"
    return ""


FRICTION = Fraction("0.3130708513820214770908369")
UNLIKE = put(
    ENOUGH["a hand"],
    {
        "loop.leader.resolution_m": 1,
        "loop.follower.resolution_m": "0.3",
        "loop.leader.coulomb_friction_N": Fraction("0.758951418048486108999938") * (1 + TINY),
    },
)
"""What each arm is told by the other is weighed by another spring."""
BOX = put(
    with_damping(HAND, "0.3968"),
    {
        "held.mass_kg": ["2.49", "2.51"],
        "held.damping_N_s_per_m": ["1.4", "1.41"],
        "held.stiffness_N_per_m": ["0.3", "0.31"],
    },
)
"""Of its corners the heavy one that damps least, with the softer spring, needs most: 0.39666344."""

# alone in its hand the follower's loop has the spectral radius 0.924, and 1.065 with D = 3
SHAKEN = held(loop(arm(0, "0.1"), arm("0.5", "0.1", local_damping_N_s_per_m=2)), 1, "0.5", "0.1")

ROUND = [0, 3, 4, 1, -3, -4, -1, 3, 4, 1, -2, -2, 0]
MOTIONS = {
    "a hand": moved(HAND, "0.1", "0.01", [0, 1, -1, 2, -2, 1, 0], "10.7912174467386850853793611568"),
    "late": moved(LATE, "0.02", 0, ROUND, "8.30598966240401990221771646198"),
    "a force that is sent": moved(SENT, "0.02", "0.01", ROUND, "29.1679274015447923701730057924"),
}
MOVED = MOTIONS["a hand"]

CASES = [
    Case("polynomials are exact", polynomials_are_exact, ""),
    Case("radii are those of powers", radii_are_those_of_powers, ""),
    Case("above zero at every end", a_polynomial_stays_above_zero_at_every_end, ""),
    Case("sums of impulse responses", sums_of_impulse_responses, ""),
    *(
        case
        for name, told in MOTIONS.items()
        for case in (
            accepted(f"a motion, {name}", told, "the motion extracts", shows="active"),
            accepted(f"a motion, {name}, turned", other_way_round(told), hands="beside a known one"),
            accepted(f"a motion, {name}, twice as quick", twice_as_quick(told)),
            refused(
                f"a motion, {name}, more",
                put(told, {"energy_J": Fraction(told["energy_J"]) * (1 + 2 * TINY)}),
                "the energy is",
            ),
            refused(
                f"a motion, {name}, less",
                put(told, {"energy_J": Fraction(told["energy_J"]) * (1 - 2 * TINY)}),
                "the energy is",
            ),
        )
    ),
    refused("a motion that takes nothing out", put(with_damping(MOVED, 2), {"energy_J": 0}), "no more than"),
    refused("a motion from elsewhere", put(MOVED, {"positions_m.0": 1}), "at rest at 0"),
    refused("a motion of a box", put(MOVED, {"held.mass_kg": [2, "2.5"]}), "single values"),
    *(
        refused(f"a motion, {key}", put(MOVED, {f"loop.{key}": TINY}), "re-run without encoders")
        for key in ("follower.coulomb_friction_N", "follower.resolution_m", "leader.resolution_m")
    ),
    *(
        case
        for name, (_, _, cosine) in NEEDS.items()
        for case in (
            accepted(f"{name}, enough", ENOUGH[name], "nowhere negative"),
            refused(f"{name}, too little", SHORT[name], POSITIVE),
            accepted(f"{name}, too little and said so", gains(SHORT[name], cosine), "takes energy out"),
            refused(f"{name}, enough and said not", gains(ENOUGH[name], cosine), GAINS),
            accepted(f"{name}, enough, twice as quick", twice_as_quick(ENOUGH[name])),
            refused(f"{name}, too little, twice as quick", twice_as_quick(SHORT[name]), POSITIVE),
        )
    ),
    accepted(
        "what it covers",
        other_way_round(ENOUGH["a hand"]),
        "with the leader held, the work of the hand on the other arm",
        shows="passive",
        hands="beside a known one",
        contact="both sides",
        encoder="ideal",
    ),
    accepted(
        "what a violation covers",
        other_way_round(gains(SHORT["a hand"], -1)),
        "with the leader held",
        shows="active",
        hands="beside a known one",
    ),
    refused("the other one is held", put(ENOUGH["a hand"], {"held.arm": "leader"}), POSITIVE),
    refused("nobody's name", put(NOBODY, {"held.arm": "both"}), "must be leader or follower"),
    accepted("encoders", counted(FRICTION * (1 + TINY)), "nowhere negative", encoder="counted"),
    refused("encoders, too little friction", counted(FRICTION * (1 - TINY)), "below the force error"),
    accepted("encoders of unlike arms", UNLIKE),
    refused(
        "encoders of unlike arms, too little friction",
        put(UNLIKE, {"loop.leader.coulomb_friction_N": Fraction("0.758951418048486108999938") * (1 - TINY)}),
        "below the force error",
    ),
    accepted(
        "a gain that friction does not stop",
        gains(
            put(
                SHORT["late"],
                {
                    "loop.leader.coulomb_friction_N": 9,
                    "loop.follower.coulomb_friction_N": 9,
                    "loop.leader.resolution_m": 1,
                },
            ),
            "0.931436151707",
        ),
    ),
    accepted("a box", BOX, "every such hand"),
    accepted("a small box", put(with_damping(NOBODY, 1), {"held.mass_kg": [3, "3.001"]}), "in 1 box, the"),
    accepted("no damping at all, and said so", gains(NOBODY, "0.8434555597"), "takes energy out"),
    refused("a box, less than a corner needs", with_damping(BOX, "0.39662"), POSITIVE),
    refused("a gain of a box", gains(put(BOX, {"loop.leader.damping_N_s_per_m": 0}), -1), "single values"),
    refused(
        "friction of the held arm",
        put(ENOUGH["a hand"], {"loop.follower.coulomb_friction_N": TINY}),
        "Coulomb friction of the held arm",
    ),
    refused(
        "a hand that drives", put(ENOUGH["a hand"], {"held.damping_N_s_per_m": "0.29"}), "would drive it"
    ),
    refused(
        "a hand that may drive",
        put(ENOUGH["a hand"], {"held.damping_N_s_per_m": ["0.29", "1.5"]}),
        "would drive it",
    ),
    accepted("a hand that damps nothing", put(ENOUGH["nobody"], {"loop.follower.damping_N_s_per_m": "0.5"})),
    refused(
        "a held arm that does not come to rest",
        with_damping(held(loop(arm(0, 1), arm(0, 1)), 1, 0, 0), 100),
        "comes to rest in its hand could not be confirmed",
    ),
    accepted("a held arm whose damper lets it rest", with_damping(SHAKEN, 1000)),
    refused(
        "a held arm that its own damper shakes",
        with_damping(put(SHAKEN, {"loop.follower.local_damping_N_s_per_m": 3}), 1000),
        "comes to rest in its hand could not be confirmed",
    ),
    refused("a drive", put(ENOUGH["nobody"], {"loop.own_readings": 2}), "without drives"),
    refused(
        "friction that is compensated",
        put(
            ENOUGH["nobody"],
            {
                "loop.leader.compensation": {
                    "compensated_coulomb_friction_N": 0,
                    "compensated_damping_N_s_per_m": 1,
                    "compensation_speed_m_per_s": 1,
                }
            },
        ),
        "without compensation of friction",
    ),
    refused("too old", put(NOBODY, {"loop.leader.link_delay_s": 120}), "at most 120"),
    refused("no mass", put(NOBODY, {"held.mass_kg": 0}), "must be > 0"),
    refused("a spring that pushes", put(NOBODY, {"held.stiffness_N_per_m": -1}), "must be ≥ 0"),
    refused("a cosine beyond 1", gains(SHORT["nobody"], 1 + TINY), "must be ≤ 1"),
    *(
        refused(f"without {key}", without(gains(SHORT["nobody"], 0), key), "is missing")
        for key in ("loop", "held", "held.arm", "held.mass_kg", "proof", "proof.cosine")
    ),
    refused("an entry that no proof has", put(NOBODY, {"proof": {}}), "entries"),
]
