"""What a device, an environment, a law or a hand is given, described once: where its class has it.

    @dataclass(frozen=True)
    class Spring(Parametric):
        stiffness: Uncertain = parameter("stiffness", bound="≥ 0", why="a negative spring gives out energy")

The constructor, its messages, the keys of a specification, the options of the command line and the
tables of the documentation are made of the fields.  A number is given as one, or as a text with its
unit, such as "3 N/mm"; the annotation says what is kept of it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import MISSING, field, fields
from fractions import Fraction
from functools import cache
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar, Generic, NamedTuple, TypeVar

from zwidth.errors import InputError
from zwidth.quantity.exact import Exact, Interval, RealLike
from zwidth.quantity.glossary import GLOSSARY, Quantity
from zwidth.quantity.text import shown, unit_text
from zwidth.quantity.units import parse, parse_number

T = TypeVar("T")

Given = RealLike | Interval | tuple[RealLike, RealLike]
"""What a person may give for a number that may be uncertain."""

if TYPE_CHECKING:
    Kept = TypeVar("Kept", covariant=True)
    Taken = TypeVar("Taken", contravariant=True)

    class Reads(Generic[Kept, Taken]):
        """A field that takes one type and keeps another, as a type checker understands it."""

        def __get__(self, instance: object, owner: Any = None) -> Kept: ...
        def __set__(self, instance: object, value: Taken) -> None: ...

else:

    class Reads:
        """The type that a field takes."""

        def __class_getitem__(cls, kinds: tuple[Any, Any]) -> Any:
            return kinds[1]


Uncertain = Reads[Exact | Any, Given]  # seldom an interval: whoever gave none reads float(device.damping)
UncertainOrNone = Reads[Exact | Any | None, Given | None]
Certain = Reads[Exact, RealLike]
CertainOrNone = Reads[Exact | None, RealLike | None]
Numbers = Reads[tuple[Exact, ...], Iterable[RealLike]]
Count = Reads[int, RealLike]

NOTHING = Quantity("", "", "", "", "")
"""Of a field that is no number."""

PLAIN = Quantity("", "", "1", "1", "")
"""Of a count."""

Reader = Callable[[Any, str, str], Exact | Interval]

Reading = Callable[[Any, str], Any]
"""From a value as given, and the name of its field, to what is kept."""


class Parameter(NamedTuple):
    """One field of a class: what is known of it wherever it is asked for.

    Parameters
    ----------
    quantity
        Its symbol, units and meaning.
    form
        What it is: a "quantity", "uncertain" where it may be an interval, a "flag", a "word", or a part.
    read
        How the constructor reads it.
    required
        False where it has a default.
    bound, why
        "> 0", "≥ 0", "≤ 0" or "" for any finite number; why the physics wants it, and what to try.
    words
        The words that it may be, the default first; of a quantity, those in the place of a number.
    """

    quantity: Quantity
    form: str
    read: Reading
    required: bool
    bound: str = ""
    why: str = ""
    words: tuple[str, ...] = ()

    @property
    def is_number(self) -> bool:
        """True where it is one number."""
        return self.form in ("quantity", "uncertain")

    @property
    def meaning(self) -> str:
        """What it is, in a few words."""
        return self.quantity.meaning

    def unit_for(self, motion: str) -> str:
        """The SI unit for a "linear" or a "rotary" device; "" where it has none."""
        return self.quantity.unit_for(motion)


class Parametric:
    """A frozen data class that reads its fields when it is made."""

    given_for: ClassVar[tuple[str, str] | None] = None
    """A parameter whose text had the unit of one motion alone, and which: "stiffness", "linear" for 3 N/m."""

    def __post_init__(self) -> None:
        for name, read in _fields(type(self))[1]:  # type: ignore[arg-type]  # a class has a hash
            given = getattr(self, name)
            object.__setattr__(self, name, read(given, name))
            if isinstance(given, (str, list, tuple)) and (motion := _motion_of(given, type(self), name)):
                object.__setattr__(self, "given_for", (name, motion))

    def with_unit(self, name: str, motion: str = "linear") -> str:
        """A number with its unit as a line shows it, "0.3 N·s/m"; "" where it was not given."""
        value = getattr(self, name)
        if value is None:
            return ""
        return shown(value, parameters_of(type(self))[name].unit_for(motion), 6)

    def _unit(self, name: str, motion: str) -> str:
        return unit_text(parameters_of(type(self))[name].unit_for(motion))

    def _keep(self, **values: Any) -> None:
        """Put what was read in the place of what was given."""
        self.__dict__.update(values)

    def _changed(self, **read: Any) -> Any:
        """A copy with some numbers that were read in the place of its own; the others are not read again."""
        kind = type(self)
        copy = object.__new__(kind)
        own = self.__dict__
        copy.__dict__.update({name: own[name] for name in kind.__dataclass_fields__} | read)  # type: ignore[attr-defined]
        return copy


def _motion_of(given: Any, kind: type, name: str) -> str:
    """The motion whose unit a text, or the first in a list, has and the other has not; "" where none."""
    text = next((one for one in ([given] if isinstance(given, str) else given) if isinstance(one, str)), None)
    quantity = parameters_of(kind)[name].quantity
    if text is None or quantity.unit == quantity.rotary_unit:
        return ""
    fits = [motion for motion in ("linear", "rotary") if _has_unit(text, quantity.unit_for(motion))]
    return fits[0] if len(fits) == 1 else ""


def _has_unit(text: str, unit: str) -> bool:
    try:
        parse(text, unit, "it")
    except InputError:
        return False
    return True


def parameters_of(kind: type[Any]) -> Mapping[str, Parameter]:
    """The fields of a data class that are parameters, by name."""
    return _fields(kind)[0]  # type: ignore[arg-type]  # a class has a hash


@cache
def _fields(kind: type) -> tuple[Mapping[str, Parameter], tuple[tuple[str, Reading], ...]]:
    """The same, and beside it how each is read, in a row."""
    found = {f.name: f.metadata["parameter"] for f in fields(kind) if "parameter" in f.metadata}
    return MappingProxyType(found), tuple((name, own.read) for name, own in found.items())


def parameter(
    quantity: Quantity | str,
    default: Any = MISSING,
    *,
    kept: Callable[[Any], Any] | None = None,
    bound: str = "",
    why: str = "",
    meaning: str = "",
    words: tuple[str, ...] = (),
) -> Any:
    """A number as a field of a data class.

    Parameters
    ----------
    quantity
        Its symbol, units and meaning, or the name that the glossary has for it.
    default
        As a person would give it; left out where it must be given.  None: it may be unknown.
    kept
        What is kept of it: `Exact`, `float` or `whole`; an interval is then refused.  None: as it was given.
    bound, why
        As in `Parameter`.
    meaning
        In the place of the quantity's own.
    words
        Words that may be given in the place of a number.
    """
    what = _quantity(quantity)
    what = what._replace(meaning=meaning) if meaning else what
    form = "uncertain" if kept is None else "quantity"

    def read(value: Any, name: str) -> Any:
        if value is None and default is None:
            return None
        if isinstance(value, str) and value in words:
            return value
        number = read_number(value, what, name, uncertain=form == "uncertain", bound=bound, why=why)
        return number if kept is None or kept is Exact else kept(number)

    own = Parameter(what, form, read, default is MISSING, bound, why, words)
    return field(default=default, metadata={"parameter": own})


def exact(
    quantity: Quantity | str, default: Any = MISSING, bound: str = "", why: str = "", meaning: str = ""
) -> Any:
    """`parameter` of a number that is kept as an `Exact`."""
    return parameter(quantity, default, kept=Exact, bound=bound, why=why, meaning=meaning)


def flag(meaning: str, default: Any = MISSING, *, more: str = "") -> Any:
    """True or False as a field of a data class; `meaning` goes on after "True": "to count anew"."""

    def read(value: Any, name: str) -> bool:
        if not isinstance(value, bool):
            raise InputError(f"{name} is True {meaning}, or False; got {value!r}")
        return value

    return part("flag", read, default, meaning=f"true {meaning}{more}")


def word(*words: str) -> Any:
    """One of some words as a field of a data class; the first is the default."""

    def read(value: Any, name: str) -> str:
        return str(one_of(name, value, *words))

    choice = f"{', '.join([f'{words[0]} (default)', *words[1:-1]])} or {words[-1]}"
    return part("word", read, words[0], meaning=choice, words=words)


def part(
    form: str,
    read: Reading,
    default: Any = MISSING,
    *,
    meaning: str,
    quantity: Quantity | str = NOTHING,
    words: tuple[str, ...] = (),
    required: bool | None = None,
) -> Any:
    """Anything else as a field of a data class: a list, an environment, a velocity.

    Parameters
    ----------
    form
        What it is, by the name under which a specification reads it.
    read
        From the value as given, and the name of the field, to what is kept.
    default
        As of `parameter`.
    meaning
        In a few words.
    quantity
        Of the numbers in a list, as of `parameter`.
    words
        As in `Parameter`.
    required
        Whether a specification must give it; None: where there is no default.
    """
    needed = default is MISSING if required is None else required
    own = Parameter(_quantity(quantity)._replace(meaning=meaning), form, read, needed, words=words)
    return field(default=default, metadata={"parameter": own})


def listed(quantity: Quantity | str, default: Any = MISSING, *, meaning: str) -> Any:
    """A list of exact numbers of one quantity as a field of a data class."""
    what = _quantity(quantity)

    def read(value: Any, name: str) -> tuple[Exact, ...] | None:
        return None if value is None and default is None else read_numbers(value, what, name)

    return part("list", read, default, meaning=meaning, quantity=what)


def _quantity(given: Quantity | str) -> Quantity:
    return GLOSSARY[given] if isinstance(given, str) else given


def plain(name: str, meaning: str, symbol: str = "") -> Quantity:
    """A number without a unit that is no quantity of the glossary."""
    return Quantity(name, symbol, "1", "1", meaning)


def one_of(name: str, value: T, *words: T) -> T:
    """The value, if it is one of these words."""
    if value not in words:
        raise InputError(f"{name} is one of {', '.join(map(repr, words))}, got {value!r}")
    return value


def read_number(
    value: Any,
    quantity: Quantity | str,
    name: str,
    *,
    uncertain: bool = False,
    bound: str = "",
    why: str = "",
    motion: str = "",
) -> Any:
    """A number in SI, exact, from a number or a text with a unit; where it may be uncertain also an interval.

    `quantity` may be its name in the glossary; `name` is that of the argument, for the messages; a text has
    the unit of the motion, "linear" or "rotary", or of either where nobody knows: "".
    """
    quantity = _quantity(quantity)
    number = _read(value, quantity, name, parse if uncertain else parse_number, motion)
    low, high = (number.low, number.high) if isinstance(number, Interval) else (number, number)
    if bound and not _BOUNDS[bound](low, high):
        known = motion or quantity.unit == quantity.rotary_unit != "1"
        unit = f" {quantity.unit_for(motion)}" if known else ""
        given = number if isinstance(number, Interval) else f"{number:g}"
        raise InputError(f"{name} must be {bound}{unit}, got {given}: {why}")
    return number


def _read(value: Any, quantity: Quantity, name: str, read: Reader, motion: str) -> Exact | Interval:
    if type(value) in _AS_IT_IS:
        try:
            return Exact(value)
        except InputError:
            pass  # the reader says what it is that is no such number
    try:
        return read(value, quantity.unit_for(motion), name)
    except InputError:
        if motion or quantity.unit == quantity.rotary_unit or not isinstance(value, (str, list, tuple)):
            raise
        try:
            return read(value, quantity.rotary_unit, name)
        except InputError:
            pass
        raise


_BOUNDS: Mapping[str, Callable[[Any, Any], bool]] = MappingProxyType(
    {"> 0": lambda low, high: low > 0, "≥ 0": lambda low, high: low >= 0, "≤ 0": lambda low, high: high <= 0}
)

_AS_IT_IS = (Exact, int, float, Fraction)
"""Types of numbers that need no reading: the most usual ones."""


def read_numbers(value: Any, quantity: Quantity, name: str) -> tuple[Exact, ...]:
    """A list of numbers, as `read_number` reads each."""
    if isinstance(value, str) or not isinstance(value, Iterable):
        raise InputError(f"{name} is a list of numbers, got {value!r}")
    return tuple(read_number(one, quantity, f"{name}[{i}]") for i, one in enumerate(value))
