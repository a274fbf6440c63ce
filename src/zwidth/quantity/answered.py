"""What a result says, declared once: where its class has it, as what is given is.

    @dataclass(frozen=True, repr=False)
    class Served(Documented):
        _FORMAT = "zwidth served 1"
        missed: int = answered("not taken: the loop came a period late", key="missed_samples", row="missed")
        energy: float = answered("given to the handle", unit="J", row="the actuator gave the handle")

        @property
        @answers("of samples, how many were missed", row="share missed")
        def share(self) -> float: ...

Its plain data, the rows of its report, the tables of docs/json.md and its parameters in docs/api.md are made
of that.  Fields come first, then what is computed, in the order in which they stand.  What a class puts into
its plain data besides stands in its `_BESIDES`, by key: the same tables have it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import field
from fractions import Fraction
from functools import cache, cached_property
from math import isfinite
from pathlib import PurePath
from types import MappingProxyType
from typing import Any, NamedTuple, TypeVar, cast

from zwidth.quantity.glossary import GLOSSARY, unit_suffix
from zwidth.quantity.text import shown

F = TypeVar("F", bound=Callable[..., Any])


class Told(NamedTuple):
    """What is known of one thing that a result says.

    Parameters
    ----------
    meaning
        What it is: in the documentation.
    key
        Its name in plain data, the unit left out; "" for that of the field.
    unit, quantity
        Its unit; or the quantity of the glossary whose unit it has, by the motion of the result.
    row
        What people read beside it, of a tuple beside each of its entries; None where no report has it.
    digits
        Of a number in a row.
    names
        Of the entries of a tuple, in plain data.
    stands_as
        What of it plain data has, in its place: an attribute by each key.
    optional
        Left out of plain data where it is None, "", () or False.
    finite
        None in plain data, it or an entry of it, where that is infinite or no number.
    only_shown
        No part of plain data.
    quantities
        The entries of a mapping are quantities of the glossary: their units stand in the keys.
    """

    meaning: str
    key: str = ""
    unit: str = ""
    quantity: str = ""
    row: str | tuple[str, ...] | None = None
    digits: int = 4
    names: tuple[str, ...] = ()
    stands_as: Mapping[str, str] = MappingProxyType({})
    optional: bool = False
    finite: bool = False
    only_shown: bool = False
    quantities: bool = False

    def unit_for(self, motion: str) -> str:
        """The SI unit for a "linear" or a "rotary" device; "" where it has none."""
        return GLOSSARY[self.quantity].unit_for(motion) if self.quantity else self.unit

    def key_for(self, name: str, motion: str) -> str:
        """Its key in plain data, the unit included."""
        unit = self.unit_for(motion)
        return f"{self.key or name}_{unit_suffix(unit)}" if unit not in ("", "1") else self.key or name


def answered(meaning: str, *, default: Any = ..., **about: Any) -> Any:
    """A field of a data class that is a result; see `Told` for what may be said of it."""
    metadata = {"told": Told(meaning, **about)}
    return field(metadata=metadata) if default is ... else field(default=default, metadata=metadata)


def known(meaning: str, **about: Any) -> Any:
    """The same of a field that plain data has no part of."""
    return answered(meaning, only_shown=True, **about)


def answers(meaning: str = "", **about: Any) -> Callable[[F], F]:
    """The same of a property, below `@property` or `@cached_property`; by default what its docstring says."""

    def declare(function: F) -> F:
        said = " ".join((function.__doc__ or "").partition("\n\n")[0].split()).removesuffix(".")
        said = said[0].lower() + said[1:] if said[1:2].islower() else said  # "T of the loop" begins with T
        function.told = Told(meaning or said, **about)  # type: ignore[attr-defined]
        return function

    return declare


def declared(result: object) -> Mapping[str, Told]:
    """What a result, or a class of results, says, by name."""
    return _declared(result if isinstance(result, type) else type(result))


@cache
def _declared(kind: Any) -> Mapping[str, Told]:
    found = {
        name: one.metadata["told"]
        for name, one in getattr(kind, "__dataclass_fields__", {}).items()
        if "told" in one.metadata
    }
    for owner in reversed(kind.__mro__):
        for name, value in vars(owner).items():
            function: Any = value.fget if isinstance(value, property) else getattr(value, "func", None)
            if isinstance(value, (property, cached_property)) and hasattr(function, "told"):
                found[name] = function.told
    return found


@cache
def _in_data(kind: Any, motion: str) -> list[tuple[str, str, Told]]:
    told = _declared(kind).items()
    return [(name, one.key_for(name, motion), one) for name, one in told if not one.only_shown]


def data_of(result: object) -> dict[str, Any]:
    """What is declared, as plain data: the unit of each in its key."""
    found: dict[str, Any] = {}
    kind, motion = cast("Any", type(result)), motion_of(result)
    for name, key, one in _in_data(kind, motion):
        value = getattr(result, name)
        if one.optional and (value is None or value is False or value in ("", ())):
            continue
        if one.finite:
            value = finite(value)
        if one.stands_as:
            found |= {key: plain(getattr(value, own, None)) for key, own in one.stands_as.items()}
        else:
            found[key] = plain(value, one.names, motion if one.quantities else "")
    return found


def motion_of(result: object) -> str:
    """ "linear" or "rotary": of what a result is about, where it has a scope."""
    return str(getattr(getattr(result, "scope", result), "motion", "linear"))


def plain(value: Any, names: Sequence[str] = (), motion: str = "") -> Any:
    """A value as plain data: entries of a tuple by names that they have, quantities with a motion's units."""
    if names and value is not None:
        return {name: plain(one) for name, one in zip(names, value, strict=True)}
    if isinstance(value, Mapping):
        return {
            GLOSSARY[name].key_for(motion) if motion and name in GLOSSARY else name: plain(one, (), motion)
            for name, one in value.items()
        }
    if hasattr(value, "to_dict"):
        return value.to_dict()
    if declared(value):
        return data_of(value)
    if isinstance(value, (list, tuple)):
        return [plain(one) for one in value]
    if isinstance(value, Fraction):
        return float(value)
    return str(value) if isinstance(value, PurePath) else value


def finite(value: Any) -> Any:
    """A number, or each of a tuple; None where it is ∞ or nan, which JSON has not."""
    if isinstance(value, tuple):
        return tuple(map(finite, value))
    return value if value is None or isfinite(value) else None


def rows_of(result: object) -> Iterator[tuple[str, str]]:
    """What people read: each that has a row, in words and with its unit; a number that is None is "none"."""
    motion = motion_of(result)
    for name, one in declared(result).items():
        if one.row is None:
            continue
        value, unit = getattr(result, name), one.unit_for(motion)
        if isinstance(one.row, tuple):
            yield from (
                (row, shown(part, unit, one.digits)) for row, part in zip(one.row, value, strict=True)
            )
        else:
            yield one.row, shown(value, unit, one.digits) if unit else str(value)
