"""Slow hands: Coulomb friction that is left over makes up for damping that is missing.

    f_c + b u ≥ f_0 + b_0 u  for all 0 ≤ u ≤ v     exactly if    f_c ≥ f_0  and  f_c − f_0 ≥ (b_0 − b) v

Of a move D in a time t during which the force is held, friction takes at least f_c |D| + (b/t) D², as much as
(f_0, b_0) would where |D|/t ≤ v.  So what covers every hand with (f_0, b_0) covers these hands with (f_c, b).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..contact.damped_wall import contact
from ..document.reading import Invalid, get, in_its_unit, number, read_loop, with_no_more_than
from .proofs import PROOFS

_EVERY_HAND = {"contact": contact, "spring": PROOFS["spring"]}
"""Proofs that cover contact made and broken by every hand."""


def slow_hands(document: Mapping[str, Any]) -> str:
    p = read_loop(document)
    enough, loop = get(document, "enough"), get(document, "loop")
    if not isinstance(enough, Mapping) or not all(isinstance(key, str) for key in enough):
        raise Invalid("enough must be an object: what covers every hand")
    with_no_more_than(enough, 3)
    kind = get(enough, "kind")
    if kind not in _EVERY_HAND:
        raise Invalid(f"enough for every hand is shown by {' or '.join(_EVERY_HAND)}")
    stronger = dict(loop)
    for name in ("damping", "coulomb_friction"):
        stronger[_key(loop, name)] = enough[_key(enough, name)]
    damping, friction = (number(enough[_key(enough, n)]) for n in ("damping", "coulomb_friction"))
    key = _key(document, "largest_speed", ("m_per_s", "rad_per_s"))
    speed, unit = number(document[key]), "rad/s" if "rad" in key else "m/s"
    if speed < 0:
        raise Invalid("the largest speed must be ≥ 0")
    left_over = p.coulomb_friction - friction
    if left_over < 0 or left_over < (damping - p.damping) * speed:
        raise Invalid("at this speed the friction left over is less than the damping that is missing")
    with_no_more_than(document, 6 if kind == "contact" else 5)
    law = {"law": get(document, "law")} if kind == "contact" else {}
    _EVERY_HAND[kind]({"loop": stronger, **law})
    return (
        f"for hands of up to {float(speed):.6g} {unit}, over each time in which one force is held, "
        "Coulomb friction makes up for the damping that is missing, contact made and broken"
    )


def _key(table: Mapping[str, Any], name: str, units: tuple[str, ...] = ()) -> str:
    """The one key of a quantity, its unit right."""
    keys = [key for key in table if key == name or key.startswith(f"{name}_")]
    if len(keys) != 1:
        raise Invalid(f"{name} must be given once")
    if not units:
        return in_its_unit(keys[0], name)
    if keys[0].removeprefix(f"{name}_") not in units:
        raise Invalid(f"the unit of {name} must be {' or '.join(units)}: {keys[0][:60]}")
    return keys[0]
