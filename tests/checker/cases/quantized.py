"""As linear, and ‖h‖₁ Δ/2 ≤ f_c, where

    ‖H‖₁ ≤ Σ |r|/(1 − |p|) + ‖R E‖₁/(|e₀| − ‖S E − e₀‖₁)    of H = Σ r/(1 − p ζ) + R/S, any polynomial E

‖1/(1 − ζ/2)‖₁ = 2, by a mode, by E = 1 + ζ/2 as (3/2)/(1 − 1/4), or by one power more as (7/4)/(1 − 1/8).
"""

from __future__ import annotations

from typing import Any

from . import TINY, accepted, edge, put, refused, without
from .linear import AT_MINUS_ONE, FILTER, PARTLY, SPRING


def norm(modes: Any = (), top: Any = (0,), bottom: Any = (1,), inverse: Any = (1,)) -> dict[str, Any]:
    """Modes as (pole, residue)."""
    return {
        "modes": [{"pole": pole, "residue": residue} for pole, residue in modes],
        "rest_numerator": list(top),
        "rest_denominator": list(bottom),
        "inverse": list(inverse),
    }


def quantized(document: Any, bound: Any, resolution: Any, friction: Any) -> Any:
    """A linear document with a norm."""
    entries = {
        "kind": "quantized",
        "proof.norm": bound,
        "loop.resolution_m": resolution,
        "loop.coulomb_friction_N": friction,
    }
    return put(document, entries)


def pair(name: str, document: Any, bound: Any, resolution: Any, friction: Any) -> Any:
    """The friction that is needed, and less."""
    return edge(
        name,
        quantized(document, bound, resolution, friction),
        quantized(document, bound, resolution, friction - TINY),
        "below ‖h‖₁ Δ/2",
        encoder="counted",
    )


POWERS = ["1", "1/2"]
BY_MODE = norm([("1/2", 1)])
FILTERED = quantized(FILTER, BY_MODE, 1, 1)

CASES = [
    accepted(
        "a spring",
        quantized(SPRING, norm(top=[3]), 2, 3),
        "Coulomb friction covers",
        shows="passive",
        hands="every",
        contact="kept",
        encoder="counted",
        force_limit=False,
        force_steps=False,
        fed_with="",
    ),
    *pair("a spring, 2 f_c = K Δ", SPRING, norm(top=[3]), 2, 3),
    *pair("a mode", FILTER, BY_MODE, 1, 1),
    *pair("a denominator", FILTER, norm(top=[1], bottom=[1, "-1/2"], inverse=POWERS), 1, 1),
    *pair("an inverse that is scaled", FILTER, norm(top=[1], bottom=[1, "-1/2"], inverse=[-3, "-3/2"]), 1, 1),
    *pair(
        "an inverse of three terms",
        FILTER,
        norm(top=[1], bottom=[1, "-1/2"], inverse=["1", "1/2", "1/4"]),
        1,
        1,
    ),
    *pair(
        "mode and denominator, half of each",
        FILTER,
        norm([("1/2", "1/2")], ["1/2"], ["1", "-1/2"], POWERS),
        1,
        1,
    ),
    *pair("a residue below 0", FILTER, norm([("1/2", -1)], [2], [1, "-1/2"], POWERS), 1, 3),
    # 1/(1 + ζ/2): q = 2b (5/4 + c) − 1/2, with the least value b/2 − 1/2 at c = −1
    *pair(
        "a pole below 0",
        put(
            FILTER,
            {"loop.denominator": ["1", "1/2"], "loop.damping_N_s_per_m": 1, "proof.positivity": AT_MINUS_ONE},
        ),
        norm([("-1/2", 1)]),
        1,
        1,
    ),
    *pair("α = 3/8", PARTLY, norm(top=[1]), 2, 1),
    accepted("an ideal encoder needs no friction", quantized(SPRING, norm(top=[3]), 0, 0), encoder="ideal"),
    refused(
        "an inverse that is none",
        put(FILTERED, {"proof.norm": norm(top=[1], bottom=[1, "-1/2"], inverse=[0, 1])}),
        "does not bound",
    ),
    refused(
        "an inverse that leaves nothing",
        put(FILTERED, {"proof.norm": norm(top=[1], bottom=[1, "-1/2"], inverse=[1, -1, "-1/4"])}),
        "does not bound",
    ),
    refused(
        "an inverse that leaves exactly nothing",
        put(FILTERED, {"proof.norm": norm(top=[0], bottom=[1, 1])}),
        "does not bound",
    ),
    refused(
        "a mode that does not decay",
        put(FILTERED, {"proof.norm": norm([(1, 1)])}),
        "proof.norm.modes[0].pole must be",
    ),
    refused(
        "a mode that does not decay, below 0",
        put(FILTERED, {"proof.norm": norm([(-1, 1)])}),
        "proof.norm.modes[0].pole must be",
    ),
    refused(
        "a mode that grows", put(FILTERED, {"proof.norm": norm([(2, 1)])}), "proof.norm.modes[0].pole must be"
    ),
    refused("the norm of another law", put(FILTERED, {"proof.norm": norm([("1/2", "1/2")])}), "do not sum"),
    refused("the norm of another pole", put(FILTERED, {"proof.norm": norm([("1/3", 1)])}), "do not sum"),
    refused("a rest that is left out", put(FILTERED, {"proof.norm": norm([("1/2", 1)], [1])}), "do not sum"),
    refused("the law is false", put(FILTERED, {"loop.damping_N_s_per_m": 3 - TINY}), "do not multiply"),
    refused("unstable", put(FILTERED, {"loop.denominator": [1, -1]}), "do not multiply"),
    refused("modes that are no list", put(FILTERED, {"proof.norm.modes": {}}), "modes must be a list"),
    refused(
        "61 modes", put(FILTERED, {"proof.norm.modes": [{"pole": 0, "residue": 0}] * 61}), "must have 0 to 60"
    ),
    accepted(
        "60 modes",
        put(quantized(SPRING, norm(top=[3]), 2, 3), {"proof.norm.modes": [{"pole": 0, "residue": 0}] * 60}),
    ),
    refused("no norm", without(FILTERED, "proof.norm"), "norm is missing"),
    accepted("no rest", put(FILTERED, {"proof.norm.rest_numerator": []})),
]
