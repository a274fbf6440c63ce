"""Motor and hand on a cable: a polynomial that lies below the criterion, and one frequency where that is < 0.

T = 1.  Without a law the criterion is q(x) = det(cosh √K − x); it is (cosh √(2/7) − x)² with m = k = 1,
c = 3, b₁ = 0 and b₂ = 4/15, whose n = 49/15 (λ + 2/7)².  With a law it has no closed form: its coefficients,
and the stiffness at which it is 0 at a frequency, are those of sums over frequencies, added up one by one.
At rest the hand feels k H/(k + H).  Where the held loop begins to swing is found by exponentials of matrices.
"""

from __future__ import annotations

from typing import Any

from . import TINY, Fraction, accepted, edge, loop, put, refused, without
from .linear import NOTHING, signs

HAIR = Fraction(2, 10**9)


def cable(
    mass: Any = 10, stiffness: Any = 10, inside: Any = 0, outside: Any = 10, encoder: str = "motor"
) -> dict[str, Any]:
    """What stands between motor and hand."""
    numbers = {"mass_kg": mass, "stiffness_N_per_m": stiffness, "damping_N_s_per_m": inside}
    return {**numbers, "handle_damping_N_s_per_m": outside, "encoder": encoder}


def proof(below: Any, law: Any, between: Any, positivity: Any = None, damping: Any = 1, **device: Any) -> Any:
    """A document of b₁ = 1."""
    told = loop(*law, damping_N_s_per_m=damping, **device)
    given = {"below": list(below), "positivity": positivity or signs(below)}
    return {"kind": "transmission", "loop": told, "transmission": between, "proof": given}


def violation(law: Any, between: Any, why: Any, damping: Any = 1, **device: Any) -> Any:
    """A frequency, or a word."""
    told = loop(*law, damping_N_s_per_m=damping, **device)
    found = {"kind": why} if isinstance(why, str) else {"kind": "criterion", "cosine": why}
    return {"kind": "transmission violation", "loop": told, "transmission": between, "proof": found}


def tight(name: str, coefficients: Any, law: Any, between: Any, **device: Any) -> tuple[Any, Any]:
    """Just below the criterion, and just above at x = 1 or −1."""
    first, *rest = map(Fraction, coefficients)
    true, false = ([first + move, *rest] for move in (-HAIR, HAIR))
    made = (proof(below, law, between, **device) for below in (true, false))
    return edge(name, *made, "not below", "nonnegative at every frequency", shows="passive")


def pair(name: str, limit: str, cosine: str, between: Any, law: Any = ((1,), (1,)), **device: Any) -> Any:
    """At a hair more than a limit it is violated, at a hair less it is not."""
    gains = (Fraction(limit) * (1 + TINY), Fraction(limit) * (1 - TINY))
    true, false = (
        violation(([gain * Fraction(c) for c in law[0]], law[1]), between, Fraction(cosine), **device)
        for gain in gains
    )
    return edge(name, true, false, "not violated", shows="active")


EQUAL = cable(1, 1, 3, Fraction(4, 15))
COSH = Fraction(1146291063)  # cosh √(2/7) = 1.146291063112…
SQUARE = [COSH**2 / Fraction(10**18), -2 * COSH / 10**9, 1]
FREE = proof(SQUARE, ([0], [1]), EQUAL, signs(square=[-COSH, 10**9]), damping=0)
SPRING = tight("a spring", ["0.2472990581", "-1.0368940847", "1.0942067217"], ([2], [1]), cable())
PROVED = SPRING[0].document
ABOVE = violation(([3], [1]), cable(), Fraction(47, 100))
TOO_STIFF, UNSTABLE, STATIC = "too stiff", "unstable", "negative static stiffness"

CASES = [
    *SPRING,
    *tight(
        "the encoder at the hand, α = 3/8",
        ["0.3734984079", "-1.1469042895", "0.8860797314", "-0.0052858163"],
        ([6], [1]),
        cable(encoder="handle"),
        delay_s="3/8",
    ),
    *tight(
        "a filter, a sample late, friction inside",
        ["3.4338942444", "-10.7259264977", "10.5674557200", "-3.1016248311"],
        ([2, 0], [1, "-1/2"]),
        cable(inside=5),
        delay_s=1,
    ),
    *tight(
        "α = 11/8",
        ["0.3438404952", "-1.1641634148", "0.9094192149", "0.1202064646", "0.0281344373"],
        ([1], [1]),
        cable(),
        delay_s="11/8",
    ),
    *tight(
        "a damped wall",
        ["0.1783008946", "-0.9054544204", "1.1894339967", "-0.0942067217"],
        ([4, -1], [1, 0]),
        cable(),
    ),
    accepted("nothing but its friction, with equal roots", FREE, contact="kept", transmission="as given"),
    refused("a hair more", put(FREE, {"proof.below.0": SQUARE[0] + HAIR}), "not below"),
    refused("nothing that is claimed to be 0", put(FREE, {"proof.positivity": NOTHING}), "do not multiply"),
    refused("a polynomial that falls below 0", proof([1, -2], ([0], [1]), EQUAL, damping=0), "not below"),
    refused("too many coefficients", put(FREE, {"proof.below": [0] * 9}), "higher degree"),
    refused("no coefficients", put(FREE, {"proof.below": []}), "must have 1 to 2000 entries"),
    *(
        refused(f"with another {entry}", put(PROVED, {entry: value}), "not below")
        for entry, value in {
            "transmission.stiffness_N_per_m": 11,
            "transmission.mass_kg": 9,
            "transmission.encoder": "handle",
            "transmission.damping_N_s_per_m": 1,
            "loop.damping_N_s_per_m": "0.99",
            "loop.numerator": ["2.1"],
            "loop.delay_s": "0.1",
        }.items()
    ),
    refused("Coulomb friction", put(PROVED, {"loop.coulomb_friction_N": TINY}), "viscous friction alone"),
    refused("an encoder", put(PROVED, {"loop.resolution_m": TINY}), "ideal encoder"),
    refused(
        "no friction but the motor's", put(PROVED, {"transmission.handle_damping_N_s_per_m": 0}), "is needed"
    ),
    refused(
        "no friction but inside",
        put(PROVED, {"transmission.handle_damping_N_s_per_m": 0, "loop.damping_N_s_per_m": 0}),
        "is needed",
    ),
    refused("a cable like a rod", put(PROVED, {"transmission.stiffness_N_per_m": "1e9"}), TOO_STIFF),
    refused("a rod", put(PROVED, {"transmission.stiffness_N_per_m": "1e900"}), TOO_STIFF),
    refused("no stiffness", put(PROVED, {"transmission.stiffness_N_per_m": 0}), "must be > 0"),
    refused("no mass", without(PROVED, "transmission.mass_kg"), "mass_kg is missing"),
    refused("too late", put(PROVED, {"loop.delay_s": 150}), "too many coefficients and samples"),
    refused(
        "the encoder at another place", put(PROVED, {"transmission.encoder": "hand"}), "must be motor or"
    ),
    *pair("K", "2.2140840532842728", "0.47", cable()),
    *pair("K at the hand, α = 3/8", "6.1716281349778992", "0.65", cable(encoder="handle"), delay_s="3/8"),
    *pair("a filter", "1.202643719197229", "0.76", cable(inside=5), ((2, 0), (1, "-1/2")), delay_s=1),
    *pair("K, α = 11/8", "1.0544621562051493", "0.57", cable(), delay_s="11/8"),
    accepted(
        "an encoder and friction change nothing",
        put(ABOVE, {"loop.resolution_m": 1, "loop.coulomb_friction_N": 9}),
        "with its transmission the criterion is violated at",
        encoder="counted",
        contact="kept",
    ),
    accepted("no surface", put(ABOVE, {"loop.unilateral": False}), contact="both sides"),
    *edge(
        "held still, α = 3/8",
        *(
            violation(([Fraction("1.3779977587625224") * (1 + move)], [1]), cable(), UNSTABLE, delay_s="3/8")
            for move in (TINY, -TINY)
        ),
        "not shown to be unstable",
        shows="active",
    ),
    *edge(
        "no friction behind the motor: b = K T/2",
        *(violation(([2 * (1 + move)], [1]), cable(outside=0), Fraction(-1)) for move in (TINY, 0)),
        "not violated",
        shows="active",
    ),
    refused(
        "nor at the motor", violation(([2], [1]), cable(outside=0), Fraction(-1), damping=0), "not violated"
    ),
    refused(
        "no friction behind the motor, the encoder at the hand",
        violation(([3], [1]), cable(outside=0, encoder="handle"), Fraction(-1)),
        "is needed",
    ),
    accepted("held still it swings", violation(([30], [1]), cable(), UNSTABLE), "the loop is unstable"),
    refused("held still it is at rest", violation(([2], [1]), cable(), UNSTABLE), "not shown to be unstable"),
    accepted(
        "a pole at 2, the encoder at the hand",
        violation(([1, 0], [1, -2]), cable(encoder="handle"), UNSTABLE),
    ),
    accepted(
        "a pole at 1, the encoder at the hand",
        violation(([1, 0], [1, -1]), cable(encoder="handle"), UNSTABLE),
    ),
    refused(
        "a pole inside, the encoder at the hand",
        violation(([1, 0], [1, -1 + TINY]), cable(encoder="handle"), UNSTABLE),
        "not shown to be unstable",
    ),
    # H(z) is 1 or 0: the hand does not feel the mode
    refused(
        "a pole at 2 that cancels", violation(([1, -2], [1, -2]), cable(), UNSTABLE), "have a common factor"
    ),
    refused(
        "a pole at 2 of nothing, the encoder at the hand",
        violation(([0, 0], [1, -2]), cable(encoder="handle"), UNSTABLE),
        "have a common factor",
    ),
    accepted("it pulls", violation(([-TINY], [1]), cable(), STATIC), "at the hand is negative"),
    accepted("it pulls at the hand", violation(([-TINY], [1]), cable(encoder="handle"), STATIC)),
    refused(
        "at rest it does nothing", violation(([-1, 1], [1, 0]), cable(), STATIC), "not shown to be negative"
    ),
    refused(
        "it pushes, both signs turned", violation(([-1], [-1]), cable(), STATIC), "not shown to be negative"
    ),
    # k H/(k + H): beyond −k the motor runs away
    accepted("it pulls nearly as the cable", violation(([-10 + TINY], [1]), cable(), STATIC)),
    refused("it pulls more", violation(([-10 - TINY], [1]), cable(), STATIC), "not shown to be negative"),
    accepted("it pulls more: it runs away", violation(([-10 - TINY], [1]), cable(), UNSTABLE)),
    refused("another kind", violation(([1], [1]), cable(), "by eye"), "proof.kind must be criterion or"),
    refused("c is above 1", violation(([3], [1]), cable(), 1 + TINY), "proof.cosine must be"),
    refused("no cosine", violation(([3], [1]), cable(), "criterion"), "proof.cosine is missing"),
    refused("an entry more", put(ABOVE, {"proof.offset": 1}), "entries"),
    refused("no transmission", without(ABOVE, "transmission"), "transmission is missing"),
]
