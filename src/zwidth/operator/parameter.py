"""An operator that is a few numbers: each with its unit, its meaning and its bound.

The command line builds its options from them and the messages name them, so a
number is described once, where it is declared.
"""

from __future__ import annotations

from dataclasses import MISSING, dataclass, field, fields, replace
from typing import Any, Self

from zwidth.errors import InputError
from zwidth.operator.operator import Operator
from zwidth.quantity.glossary import Quantity
from zwidth.quantity.units import parse_number


def parameter(
    quantity: Quantity, default: float | None = None, *, bound: str = "", why: str = "", kw_only: bool = True
) -> Any:
    """A number of an operator as a data class field.

    Parameters
    ----------
    quantity
        Its name, symbol, units and meaning.
    default
        In SI; None where it must be given.
    bound
        "> 0", "≥ 0", "≤ 0" or "" for any finite number.
    why
        Why the physics wants the bound, and what to try.
    kw_only
        False where it may be given without its name.
    """
    metadata = {
        "quantity": quantity,
        "unit": quantity.unit,
        "rotary_unit": quantity.rotary_unit,
        "meaning": quantity.meaning,
        "bound": bound,
        "why": why,
    }
    given: Any = MISSING if default is None else default
    return field(default=given, metadata=metadata, kw_only=kw_only)


@dataclass(frozen=True, kw_only=True)
class ParametricOperator(Operator):
    """An operator whose fields are numbers in SI, or texts with a unit, such as "3 N"."""

    def __post_init__(self) -> None:
        for f in fields(self):
            if "quantity" in f.metadata:
                object.__setattr__(self, f.name, _read(getattr(self, f.name), f.name, f.metadata))

    @classmethod
    def parameters(cls) -> dict[str, Quantity]:
        """The numbers it takes, by the name of the argument."""
        return {f.name: f.metadata["quantity"] for f in fields(cls) if "quantity" in f.metadata}

    @property
    def start_is_chosen(self) -> bool:
        """True where `start` is not its default."""
        starts = [f.default for f in fields(self) if f.name == "start"]
        return self.initial_position != (starts[0] if starts else 0.0)

    def starting_at(self, position: float) -> Self:
        """The same hand, whose touch begins here [m; rad], or at the surface if that is inside."""
        changes: dict[str, Any] = {"start": min(position, 0.0)} if hasattr(self, "start") else {}
        return replace(self, **changes)

    def describe_parameters(self, motion: str = "linear") -> str:
        """The numbers with their units, in linear or rotary units."""
        return ", ".join(
            f"{name.replace('_', ' ')} {getattr(self, name):.6g} {quantity.unit_for(motion)}"
            for name, quantity in self.parameters().items()
        )


def _read(value: Any, name: str, metadata: Any) -> float:
    number = _number(value, name, metadata)
    bound = metadata["bound"]
    if bound and not _BOUNDS[bound](number):
        raise InputError(f"{name} must be {bound} {metadata['unit']}, got {number:g}: {metadata['why']}")
    return number


def _number(value: Any, name: str, metadata: Any) -> float:
    try:
        return float(parse_number(value, metadata["unit"], name))
    except InputError:
        if not isinstance(value, str) or metadata["unit"] == metadata["rotary_unit"]:
            raise
        try:
            return float(parse_number(value, metadata["rotary_unit"], name))
        except InputError:
            pass
        raise


_BOUNDS = {"> 0": lambda v: v > 0, "≥ 0": lambda v: v >= 0, "≤ 0": lambda v: v <= 0}
