"""What may come of a question, and by which word, colour and exit status each is told.

passive             a proof, with contact made and broken at will, or as was asked
passive in contact  a proof of hands that stay inside alone, where nothing else was asked
passive without encoder steps
                    a proof of an arm that is read without steps, where this one has them
theorem             a proof on paper, reckoned in doubles, without a certificate
active              a motion that takes energy out, or a proof that there is one
undecided           neither
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Literal, NamedTuple

from zwidth.errors import InputError

Outcome = Literal[
    "passive", "passive in contact", "passive without encoder steps", "theorem", "active", "undecided"
]


class Answer:
    """Something with an outcome: there are more answers than yes and no, so none of them is true or false."""

    outcome: Outcome

    @property
    def passive(self) -> bool:
        """True where the outcome is "passive": a proof, with contact made and broken, or as was asked."""
        return self.outcome == "passive"

    def __bool__(self) -> bool:
        """Refuse to be true or false.

        Raises
        ------
        InputError
            Always: every object is true, and "if verdict:" would read as a proof.
        """
        raise InputError(
            f"this answer is {self.outcome!r}, and an answer is neither true nor false: "
            'ask .passive, which is True for "passive" alone, or compare .outcome'
        )


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
