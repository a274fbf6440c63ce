"""Ports of two axes, Herm F ≥ σ by the sums of the principal minors, and motions of two axes.

A constant [[2, 1], [1, 2]] has the least eigenvalue 1: e₁ = 4 − 2σ and e₂ = (2 − σ)² − 1.
"""

from __future__ import annotations

from typing import Any

from . import TINY, Fraction, accepted, put, refused, without
from .linear import signs
from .positive_real import BURST, DISCRETE, OUTPUT, POLYNOMIAL, WORK, smooth


def ports(
    numerators: Any,
    denominator: Any,
    level: Any = 0,
    time: str = "continuous",
    index: str = "input",
    **more: Any,
) -> Any:
    system = {"time": time, "numerators": numerators, "denominator": denominator}
    return {"index": index, "level": level, "system": system, **more}


def proved(minors: Any, resolvent: Any, offset: Any, *of: Any, **more: Any) -> Any:
    """Minors as (power, positivity), the resolvent as N and D."""
    listed = [{"power": power, "positivity": positivity} for power, positivity in minors]
    numerators, denominator = resolvent
    proof = {
        "offset": offset,
        "minors": listed,
        "resolvent": {"numerators": numerators, "denominator": denominator},
    }
    return ports(*of, kind="positive real matrix", proof=proof, **more)


NONE = signs(square=())
ONE = signs()
# [[2, 1], [1, 2]] at σ = 1: Π = [[1, 1], [1, 1]], e₁ = 2, e₂ = 0; M = Π + g: g = 1 gives [[2, 1], [1, 2]],
# inverse [[2, −1], [−1, 2]]/3
CONSTANT = proved(
    [(0, ONE), (0, NONE)], ([[[2], [-1]], [[-1], [2]]], [3]), 1, [[[2], [1]], [[1], [2]]], [1], 1
)
# [[2, 3], [1, 2]]: only the mean of 3 and 1 counts, 2: least 0
SKEW = proved([(0, ONE), (0, NONE)], ([[[3], [-3]], [[-1], [3]]], [6]), 1, [[[2], [3]], [[1], [2]]], [1], 0)
# (s + 2)/(s + 1) and (s + 3)/(s + 1), σ = 1: N − D = 1 and 2: Π = diag(1, 2) for D = s + 1: Re(1 · (1 −
# jω)) = 1: e₁ = 3, e₂ = 2,
# times (1 + c), and its square; M = diag(s + 2, s + 3) with g = 1: D M⁻¹ = (s + 1)/(s + 2), (s + 1)/(s + 3)
DIAGONAL = proved(
    [(0, signs(at_minus_one=1)), (0, signs(at_minus_one=2))],
    ([[[1, 4, 3], []], [[], [1, 3, 2]]], [1, 5, 6]), 1,
    [[[1, 2], []], [[], [1, 3]]], [1, 1], 1,
)  # fmt: skip
# z/(z − ½) on both axes, σ = 2/3: (1 + c)/6 on each: e₁ = (1 + c)/3, e₂ = (1 + c)²/36; g = 1: M = z + (z −
# ½)/3 = (4z − ½)/3
STEPS = proved(
    [(0, signs(at_minus_one=1)), (0, signs(at_minus_one=2))],
    ([[[3, "-3/2"], []], [[], [3, "-3/2"]]], [4, "-1/2"]), 1,
    [[[1, 0], []], [[], [1, 0]]], [1, "-1/2"], "2/3", **DISCRETE,
)  # fmt: skip
# the same, turned: F = (z − ½)/z on both axes, least ½ at 1; N = z − ½, D = z: z − ½ − z/2 = (z − 1)/2; (1
# − c)/2 each
TURNED = proved(
    [(0, signs(at_one=1)), (0, signs(at_one=2))],
    ([[[2, 0], []], [[], [2, 0]]], [3, -1]), 1,
    [[[1, 0], []], [[], [1, 0]]], [1, "-1/2"], "1/2", **OUTPUT, **DISCRETE,
)  # fmt: skip
ALL = {"constant": CONSTANT, "skew": SKEW, "continuous": DIAGONAL, "discrete": STEPS, "output": TURNED}
MINORS, RESOLVENT = "do not multiply to the sum", "is not that of the port"


def drawn(motion: Any, *of: Any, **more: Any) -> Any:
    return ports(*of, kind="matrix extraction", motion=motion, **more)


def taken(name: str, energy: Any, told: Any, words: str = "", **facts: Any) -> Any:
    return accepted(name, told, words, energy, **{"shows": "index below", **facts})


# u = D φ, y = N φ with D = z: u = φ; y₁ is φ₂ a sample late, y₂ that of φ₁ turned
LATE = drawn({"kind": "sequence", "latent": [[1, 0], [0, 1]]}, [[[0], [1]], [[-1], [0]]], [1, 0], **DISCRETE)
# [[1, 3], [−3, 1]]/s: for φ = (1 − cos t)(cos 2t, sin 2t) the lines at ω have u = jω φ, y = G s φ
CIRCLE = drawn({**BURST, "cosine": [1, 0], "sine": [0, 1]}, [[[1], [3]], [[-3], [1]]], [1, 0])
# φ = (t, 2t): D = s + 1: u = (1 + t)(1, 2); y = [[−1, 0], [1, −1]] φ = (−t, −t): −∫ 3 t (1 + t)
PUSH = drawn({**POLYNOMIAL, "coefficients": [[3], [6]]}, [[[-1], []], [[1], [-1]]], [1, 1])
# Re G = 1 + 300 (c − 4/5)(c − 1) of a port of one axis, below 0 near c = 9/10; told as the constant 1
DIPS = proved([(0, ONE)], ([[[1]]], [1]), 1, [[[391, -540, 150]]], [1, 0, 0], 0, **DISCRETE)

CASES = [
    refused("a minor that agrees at a few points", DIPS, "do not multiply"),
    *(
        case
        for name, told in ALL.items()
        for case in (
            accepted(
                name,
                told,
                "index is at least",
                shows="index at least",
                hands="every",
                contact="both sides",
                encoder="ideal",
                force_limit=False,
                force_steps=False,
                fed_with="",
            ),
            refused(f"{name}, a hair more", put(told, {"level": Fraction(told["level"]) + TINY}), MINORS),
            refused(
                f"{name}, another first minor",
                put(told, {"proof.minors.0.positivity": signs([3, 1])}),
                MINORS,
            ),
            refused(
                f"{name}, another last minor", put(told, {"proof.minors.1.positivity": signs([3, 1])}), MINORS
            ),
            refused(f"{name}, another offset", put(told, {"proof.offset": 2}), RESOLVENT),
            refused(
                f"{name}, another resolvent",
                put(
                    told,
                    {
                        "proof.resolvent.denominator": [
                            x * 2 if isinstance(x, int) else "1"
                            for x in told["proof"]["resolvent"]["denominator"]
                        ]
                    },
                ),
                RESOLVENT,
            ),
        )
    ),
    refused("a level of less, with the signs of more", put(CONSTANT, {"level": 0}), MINORS),
    refused("minors below 0", put(CONSTANT, {"level": 3, "proof.minors.1.positivity": NONE}), MINORS),
    refused("e₁ < 0", put(CONSTANT, {"system.numerators": [[[-2], [1]], [[1], [-2]]], "level": -1}), MINORS),
    # |d|² = 1 for d = 1: any power of it
    accepted("a power of |d|²", put(CONSTANT, {"proof.minors.0.power": 2})),
    # 3 (s + 2)/(s + 2) on both axes: e₁ = 6 |d|², e₂ = 9 |d|⁴
    accepted(
        "a common factor of |d|²",
        proved(
            [(1, ONE), (2, ONE)], ([[[1], []], [[], [1]]], [4]), 1, [[[3, 6], []], [[], [3, 6]]], [1, 2], 0
        ),
    ),
    refused(
        "another power of |d|²",
        proved(
            [(1, ONE), (1, ONE)], ([[[1], []], [[], [1]]], [4]), 1, [[[3, 6], []], [[], [3, 6]]], [1, 2], 0
        ),
        MINORS,
    ),
    refused(
        "a factor that is not positive",
        put(DIAGONAL, {"proof.minors.0.positivity": signs([1, 1])}),
        "is not positive where",
    ),
    refused(
        "no factor",
        put(DIAGONAL, {"proof.minors.0.positivity": signs([])}),
        "positivity.factor must have 1 to 2000 entries",
    ),
    refused("one minor", put(CONSTANT, {"proof.minors": CONSTANT["proof"]["minors"][:1]}), "every size"),
    # −1/s on both axes: Π = 0, M = −1 + g s: D M⁻¹ = s/(g s − 1)
    refused(
        "a root outside",
        proved(
            [(0, NONE), (0, NONE)],
            ([[[1, 0], []], [[], [1, 0]]], [1, -1]),
            1,
            [[[-1], []], [[], [-1]]],
            [1, 0],
            0,
        ),
        "a root lies outside",
    ),
    accepted(
        "an integrator",
        proved(
            [(0, NONE), (0, NONE)],
            ([[[1, 0], []], [[], [1, 0]]], [1, 1]),
            1,
            [[[1], []], [[], [1]]],
            [1, 0],
            0,
        ),
    ),
    # −1/(z − 2): Re = (2 − c)/(5 − 4c): times |d|² 2 − c; M = −1 + z − 2 = z − 3
    refused(
        "a root outside the circle",
        proved(
            [(0, signs([2, -1])), (0, signs([1], [2, -1]))],
            ([[[1, -2], []], [[], [1, -2]]], [1, -3]),
            1,
            [[[-1], []], [[], [-1]]],
            [1, -2],
            0,
            **DISCRETE,
        ),
        "a root lies outside",
    ),
    # N = −g D: M = 0, and 0 times anything is π D with π = … no π
    refused(
        "no resolvent",
        proved([(0, ONE), (0, ONE)], ([[[0], []], [[], [0]]], [1]), 1, [[[-1], []], [[], [-1]]], [1], 0),
        MINORS,
    ),
    refused("offset 0", put(CONSTANT, {"proof.offset": 0}), "proof.offset must be > 0"),
    refused("offset below 0", put(CONSTANT, {"proof.offset": -1}), "proof.offset must be > 0"),
    *(
        refused(
            f"a resolvent {name}", put(DIAGONAL, {"proof.resolvent.numerators": rows}), "not that of the port"
        )
        for name, rows in (
            ("of 0", [[[], []], [[], []]]),
            ("with more beside the diagonal", [[[1, 4, 3], [1]], [[], [1, 3, 2]]]),
        )
    ),
    refused(
        "a resolvent that is not proper",
        put(CONSTANT, {"proof.resolvent.numerators": [[[2, 2], [-1]], [[-1], [2]]]}),
        "must be a proper matrix",
    ),
    refused(
        "a resolvent of one axis",
        put(CONSTANT, {"proof.resolvent.numerators": [[[2]]]}),
        "must be a proper matrix",
    ),
    refused(
        "a resolvent over 0", put(CONSTANT, {"proof.resolvent.denominator": [0]}), "must be a proper matrix"
    ),
    refused("D is 0", put(CONSTANT, {"system.denominator": [0]}), "denominator is zero"),
    refused("more zeros than poles", put(STEPS, {"system.denominator": [1]}), "more zeros than poles"),
    refused(
        "a matrix that is not square", put(CONSTANT, {"system.numerators": [[[2], [1]]]}), "as many columns"
    ),
    refused(
        "no rows", put(CONSTANT, {"system.numerators": []}), "system.numerators must have 1 to 12 entries"
    ),
    refused(
        "a matrix of fewer columns", put(CONSTANT, {"system.numerators": [[[2]], [[1]]]}), "as many columns"
    ),
    refused(
        "a row that is a number", put(CONSTANT, {"system.numerators": [1, 2]}), "numerators[0] must be a list"
    ),
    refused("a sequence at its level", put(LATE, {"level": "-1/2"}), "none comes out"),
    taken("a sequence, a level of a half", 2, put(LATE, {"level": "1/2"})),
    taken("a sequence, a level", 3, put(LATE, {"level": 1})),
    taken("a sequence, fractions", "3/4", put(LATE, {"level": 1, "motion.latent": [["1/2", 0], [0, "1/2"]]})),
    taken("a polynomial", 3 * (Fraction(9, 2) + 9), PUSH),
    # 5 ∫ (1 + t)² = 5 · 21
    taken("a polynomial, a level", 3 * (Fraction(9, 2) + 9) + 105, put(PUSH, {"level": 1})),
    # at ω: u = jω (1, −j), y = (1 − 3j, −3 − j): Re uᴴy = −6ω, |u|² = 2ω²
    taken("a burst", 18 * WORK, CIRCLE),
    taken("a burst, a level", Fraction(193, 10) * WORK, put(CIRCLE, {"level": "1/10"})),
    taken(
        "a burst of power 3",
        Fraction(5 * 924, 64) * WORK,
        drawn(
            {**BURST, "cycles": 4, "power": 3, "cosine": [1, 0], "sine": [0, 2]},
            [[[-1], []], [[], [-1]]],
            [1],
        ),
    ),
    # twice the port of order 2 of one axis, weights 1 and 2² of φ
    taken(
        "a burst of order 2",
        5 * smooth(2),
        drawn(
            {
                "kind": "burst",
                "step_rad_per_s": "1/2",
                "cycles": 3,
                "power": 2,
                "cosine": [1, 0],
                "sine": [0, 2],
            },
            [[[1, 0, -1], []], [[], [1, 0, -1]]],
            [1, 1, 1],
            2,
        ),
    ),
    refused("a burst, turned the other way", put(CIRCLE, {"motion.sine": [0, -1]}), "none comes out"),
    refused(
        "two axes and three lists", put(LATE, {"motion.latent": [[1], [1], [1]]}), "one list for every axis"
    ),
    refused(
        "an order of 201", put(LATE, {"system.denominator": [1, *[0] * 201]}), "order is 201, more than 200"
    ),
    refused("two axes and one list", put(LATE, {"motion.latent": [[1]]}), "one list for every axis"),
    refused("axes of two lengths", put(LATE, {"motion.latent": [[1, 0], [1]]}), "of one length"),
    refused("a burst of one axis", put(CIRCLE, {"motion.cosine": [1]}), "two numbers for every axis"),
    refused("a burst of one axis, its sine", put(CIRCLE, {"motion.sine": [1]}), "two numbers for every axis"),
    *(
        refused(
            f"a burst of {len(cosine)} and {len(sine)} numbers",
            put(CIRCLE, {"motion.cosine": cosine, "motion.sine": sine}),
            "two numbers for every axis",
        )
        for cosine, sine in (([1], [1]), ([1, 0, 0], [0, 1]), ([1, 0, 0], [0, 1, 0]))
    ),
    refused("no pace", put(CIRCLE, {"motion.step_rad_per_s": 0}), "step_rad_per_s must be > 0"),
    refused("fewer cycles than its power", put(CIRCLE, {"motion.cycles": 1}), "more cycles than its power"),
    refused(
        "a power of 401", put(CIRCLE, {"motion.power": 401, "motion.cycles": 402}), "power must be ≤ 400"
    ),
    refused("a burst that is not smooth", put(CIRCLE, {"motion.power": 0}), "more cycles than its power"),
    refused(
        "a polynomial that does not begin at rest", put(PUSH, {"motion.lowest_power": 0}), "begin at rest"
    ),
    refused("a polynomial of no time", put(PUSH, {"motion.duration_s": 0}), "motion.duration_s must be > 0"),
    refused(
        "a sequence in time",
        put(CIRCLE, {"motion": {"kind": "sequence", "latent": [[1], [1]]}}),
        "is moved by a burst",
    ),
    *(
        refused(f"without {key}", without(CONSTANT, key), "is missing")
        for key in (
            "system.numerators",
            "system.denominator",
            "proof.offset",
            "proof.minors",
            "proof.resolvent",
            "proof.minors.0.power",
            "proof.minors.0.positivity",
            "proof.resolvent.denominator",
            "proof.resolvent.numerators",
            "level",
            "index",
        )
    ),
]
