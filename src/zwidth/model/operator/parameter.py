"""An operator that is a few numbers: each with its unit, its meaning and its bound.

The command line builds its options from them and the messages name them, so a
number is described once, where it is declared.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import Any, ClassVar, Self

from zwidth.model.operator.operator import Operator
from zwidth.quantity.glossary import Quantity
from zwidth.quantity.parameter import Parametric, parameters_of
from zwidth.quantity.text import told


@dataclass(frozen=True, kw_only=True)
class ParametricOperator(Parametric, Operator):
    """An operator whose fields are numbers in SI, or texts with a unit, such as "3 N"."""

    called: ClassVar[str] = ""
    """What it is in a word or two, as a line about it begins."""

    motion: ClassVar[str] = ""
    """ "rotary" of a hand on a device that turns, "linear" of one on a handle that moves; "" of either."""

    @classmethod
    def parameters(cls) -> dict[str, Quantity]:
        """The numbers it takes, by the name of the argument."""
        return {name: own.quantity for name, own in parameters_of(cls).items() if own.is_number}

    @property
    def start_is_chosen(self) -> bool:
        """True where `start` is not its default."""
        starts = [f.default for f in fields(self) if f.name == "start"]
        return self.initial_position != (starts[0] if starts else 0.0)

    def starting_at(self, position: float) -> Self:
        """The same hand, whose touch begins here [m; rad], or at the surface if that is inside."""
        changes: dict[str, Any] = {"start": min(position, 0.0)} if hasattr(self, "start") else {}
        return replace(self, **changes)

    def describe(self, motion: str = "linear") -> str:
        """What it is and its numbers, on one line, in linear or rotary units."""
        return f"{self.called}, {self.describe_parameters(motion)}"

    def describe_parameters(self, motion: str = "linear") -> str:
        """The numbers with their units, in linear or rotary units."""
        return ", ".join(
            f"{name.replace('_', ' ')} {told(getattr(self, name), quantity.unit_for(motion))}"
            for name, quantity in self.parameters().items()
        )
