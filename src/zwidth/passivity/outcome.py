"""What may come of a question, and by which word, colour and exit status each is told.

passive             a proof, with contact made and broken at will, or as was asked
passive in contact  a proof of hands that stay inside alone, where nothing else was asked
passive without encoder steps
                    a proof of an arm, or of a scene, that is read without steps, where this one has them
theorem             a proof on paper, reckoned in doubles, without a certificate
active              a motion that takes energy out, or a proof that there is one
undecided           neither
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Literal, NamedTuple

Outcome = Literal[
    "passive", "passive in contact", "passive without encoder steps", "theorem", "active", "undecided"
]


class Told(NamedTuple):
    """How an outcome is told.

    Parameters
    ----------
    status
        The exit status of a command.  2 is bad input.
    terminal, colour
        Its colour in a terminal, and in a page.
    """

    status: int
    terminal: str
    colour: str


TOLD: Mapping[str, Told] = MappingProxyType(
    {
        "passive": Told(0, "green", "#2a7d4f"),
        "passive in contact": Told(4, "blue", "#1f5fa8"),
        "passive without encoder steps": Told(4, "blue", "#1f5fa8"),
        "theorem": Told(4, "blue", "#1f5fa8"),
        "active": Told(1, "red", "#b3261e"),
        "undecided": Told(3, "yellow", "#8a6d00"),
    }
)
"""By outcome."""

COLOUR: Mapping[str, str] = MappingProxyType(
    {outcome: told.colour for outcome, told in TOLD.items()}
    | {"stable": TOLD["passive"].colour, "unstable": TOLD["active"].colour}
)
"""By outcome, in a page; of a hand that is known too."""
