"""Slow hands: Coulomb friction that is left over makes up for damping that is missing.

    f_c + b u ≥ f_0 + b_0 u  for all 0 ≤ u ≤ v     exactly if    f_c ≥ f_0  and  f_c − f_0 ≥ (b_0 − b) v

Of a move D in a time t during which the force is held, friction takes at least f_c |D| + (b/t) D², as much as
(f_0, b_0) would where |D|/t ≤ v.  So what covers every hand with (f_0, b_0) covers these hands with (f_c, b).
"""

from __future__ import annotations

from ..contact.damped_wall import WALL, contact
from ..document.fields import Choice, Number, Read, Record, document, only_if
from ..document.number import down
from ..document.refusal import Invalid
from ..document.unit import DAMPING, FORCE, SPEED
from ..loop.loop import LOOP
from ..loop.spring import spring

_ENOUGH = Record(
    {
        "kind": Choice("spring", "contact"),
        "damping": Number(DAMPING, least=0),
        "coulomb_friction": Number(FORCE, least=0),
    },
    shown=False,
)
"""What covers every hand, with contact made and broken."""

SLOW_HANDS = document(
    {
        "loop": LOOP,
        "law": Record(WALL.fields, default=None),
        "largest_speed": Number(SPEED, least=0),
        "enough": _ENOUGH,
    }
)


def slow_hands(told: Read) -> str:
    """Say what was proved."""
    enough, loop = told.enough, told.loop
    left_over = loop.coulomb_friction - enough.coulomb_friction
    if left_over < 0 or left_over < (enough.damping - loop.damping) * told.largest_speed:
        raise Invalid("at this speed the friction left over is less than the damping that is missing")
    stronger = Read(**{**vars(loop), "damping": enough.damping, "coulomb_friction": enough.coulomb_friction})
    if only_if(enough.kind == "contact", told.law, "law"):
        contact(Read(loop=stronger, law=told.law))
    else:
        spring(Read(loop=stronger))
    unit = "rad/s" if told.units == "rotary" else "m/s"
    return (
        f"for hands of up to {down(told.largest_speed)} {unit}, over each time in which one force is held, "
        "Coulomb friction makes up for the damping that is missing, contact made and broken"
    )
