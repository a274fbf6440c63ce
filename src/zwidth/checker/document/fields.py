"""What a document of a kind consists of, declared once: names, units, signs, bounds.

A document is read into what is declared, and anything else is refused: an entry too many or too few, at any
depth, a unit other than the one declared, linear and rotary units side by side, a number out of its bounds.
What was read is all that a proof sees, and all that is shown of it.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from operator import ge, gt, le, lt
from types import SimpleNamespace
from typing import Any, NamedTuple

from .number import LONGEST_NUMBER, NONE, PATTERN, Unit, about, exactly, in_words, number
from .refusal import Invalid, spend

LINEAR, ROTARY = "linear", "rotary"
SHOWN_AT_MOST = 12
"""Numbers of a list."""
MOST_LETTERS = 60
"""Of the words that say what a document is."""
RATIONAL = {"type": "string", "pattern": PATTERN, "maxLength": LONGEST_NUMBER}
"""A number as text, in JSON Schema: `$defs/rational` of every schema."""
_REQUIRED = object()


class Read(SimpleNamespace):
    """An object of a document, each entry by its name without its unit."""


class Row(NamedTuple):
    """One entry as it is shown: what it is called, what it is, and its unit.

    `told` is True of words, which no proof reads.
    """

    name: str
    text: str
    unit: str
    told: bool


class Field(ABC):
    """One entry: its key ends in `unit`; without a `default` it must be there; what is of the proof alone,
    and not of what is proved, is not `shown`."""

    def __init__(self, *, unit: Unit = NONE, default: Any = _REQUIRED, shown: bool = True) -> None:
        self.unit, self.default, self.shown = unit, default, shown

    @property
    def required(self) -> bool:
        """True if it may not be left out."""
        return self.default is _REQUIRED

    def key(self, name: str, motion: str) -> str:
        """Its key in a document."""
        unit = self.unit.of(motion)
        return f"{name}_{unit}" if unit else name

    @abstractmethod
    def read(self, value: Any, at: str, motion: str) -> Any:
        """The value, refused if it is not as declared; `at` says where it stands."""

    @abstractmethod
    def schema(self, motion: str) -> dict[str, Any]:
        """The same as JSON Schema."""

    def keys(self, motion: str) -> Iterator[str]:
        """All keys within."""
        yield from ()

    def rows(self, name: str, value: Any, motion: str) -> Iterator[Row]:
        """How it is shown."""
        yield Row(name.replace("_", " "), self.text(value, motion), in_words(self.unit.of(motion)), False)

    def text(self, value: Any, motion: str) -> str:
        """A value for people, without its unit."""
        return str(value)


class Number(Field):
    """A rational number within bounds."""

    def __init__(
        self,
        unit: Unit = NONE,
        *,
        least: int | None = None,
        above: int | None = None,
        most: int | None = None,
        below: int | None = None,
        default: Any = _REQUIRED,
        shown: bool = True,
    ) -> None:
        super().__init__(unit=unit, default=default, shown=shown)
        self.least, self.above, self.most, self.below = least, above, most, below

    def read(self, value: Any, at: str, motion: str) -> Fraction:
        try:
            found = number(value)
        except Invalid as error:
            raise Invalid(f"{at}: {error}") from None
        for bound, keeps, sign in self._bounds():
            if not keeps(found, bound):
                raise Invalid(f"{at} must be {sign} {bound}, got {about(found)}")
        return found

    def _bounds(self) -> Iterator[tuple[int, Callable[[Any, Any], bool], str]]:
        if self.least is not None:
            yield self.least, ge, "≥"
        if self.above is not None:
            yield self.above, gt, ">"
        if self.most is not None:
            yield self.most, le, "≤"
        if self.below is not None:
            yield self.below, lt, "<"

    def schema(self, motion: str) -> dict[str, Any]:
        bounds = {
            "minimum": self.least,
            "exclusiveMinimum": self.above,
            "maximum": self.most,
            "exclusiveMaximum": self.below,
        }
        stated = {name: bound for name, bound in bounds.items() if bound is not None}
        return {"anyOf": [{"type": "number", **stated}, {"$ref": "#/$defs/rational"}]}

    def text(self, value: Fraction, motion: str) -> str:
        return exactly(value)


class Whole(Number):
    """A whole number within bounds."""

    def read(self, value: Any, at: str, motion: str) -> Any:
        found = super().read(value, at, motion)
        if found.denominator != 1:
            raise Invalid(f"{at} must be a whole number, got {about(found)}")
        return int(found)

    def schema(self, motion: str) -> dict[str, Any]:
        number_, text = super().schema(motion)["anyOf"]
        return {"anyOf": [{**number_, "type": "integer"}, text]}


class Flag(Field):
    """True or false."""

    def __init__(self, *, default: Any = _REQUIRED, shown: bool = True) -> None:
        super().__init__(default=default, shown=shown)

    def read(self, value: Any, at: str, motion: str) -> bool:
        if not isinstance(value, bool):
            raise Invalid(f"{at} must be true or false")
        return value

    def schema(self, motion: str) -> dict[str, Any]:
        return {"type": "boolean"}

    def text(self, value: bool, motion: str) -> str:
        return "yes" if value else "no"


class Choice(Field):
    """One of some words, or numbers that stand for them."""

    def __init__(self, *words: Any, default: Any = _REQUIRED, shown: bool = True) -> None:
        super().__init__(default=default, shown=shown)
        self.words = words

    def read(self, value: Any, at: str, motion: str) -> Any:
        if isinstance(value, bool) or not isinstance(value, (str, int)) or value not in self.words:
            raise Invalid(f"{at} must be {' or '.join(map(str, self.words))}")
        return value

    def schema(self, motion: str) -> dict[str, Any]:
        return {"enum": list(self.words)}


class Words(Field):
    """What people are told, and no proof reads."""

    def __init__(self, most: int, *, default: Any = _REQUIRED, shown: bool = True) -> None:
        super().__init__(default=default, shown=shown)
        self.most = most

    def read(self, value: Any, at: str, motion: str) -> str:
        if not isinstance(value, str) or len(value) > self.most:
            raise Invalid(f"{at} must be text of at most {self.most} letters")
        return value

    def schema(self, motion: str) -> dict[str, Any]:
        return {"type": "string", "maxLength": self.most}

    def rows(self, name: str, value: Any, motion: str) -> Iterator[Row]:
        yield Row(name, str(value), "", True)


class Packed(Field):
    """Numbers of one size, deflated, in base 64: unpacked where it is known how many there must be."""

    def __init__(self) -> None:
        super().__init__(shown=False)

    def read(self, value: Any, at: str, motion: str) -> str:
        if not isinstance(value, str):
            raise Invalid(f"{at} must be text: numbers, deflated, in base 64")
        return value

    def schema(self, motion: str) -> dict[str, Any]:
        return {"type": "string", "contentEncoding": "base64"}


class List(Field):
    """So many of one sort."""

    def __init__(
        self,
        of: Field,
        *,
        unit: Unit = NONE,
        least: int = 0,
        most: int = 2000,
        default: Any = _REQUIRED,
        shown: bool = True,
    ) -> None:
        super().__init__(unit=unit, default=default, shown=shown)
        self.of, self.least, self.most = of, least, most

    def read(self, value: Any, at: str, motion: str) -> list[Any]:
        if not isinstance(value, Sequence) or isinstance(value, (str, bytes)):
            raise Invalid(f"{at} must be a list")
        if not self.least <= len(value) <= self.most:
            raise Invalid(f"{at} must have {self.least} to {self.most} entries, got {len(value)}")
        return [self.of.read(v, f"{at}[{k}]", motion) for k, v in enumerate(value)]

    def schema(self, motion: str) -> dict[str, Any]:
        sizes = {"minItems": self.least, "maxItems": self.most}
        return {"type": "array", "items": self.of.schema(motion), **sizes}

    def keys(self, motion: str) -> Iterator[str]:
        yield from self.of.keys(motion)

    def rows(self, name: str, value: Any, motion: str) -> Iterator[Row]:
        if isinstance(self.of, (Number, List)):
            yield from super().rows(name, value, motion)
            return
        for place, entry in enumerate(value, start=1):
            yield Row(f"{name.removesuffix('s')} {place}", self.of.text(entry, motion), "", False)

    def text(self, value: Sequence[Any], motion: str) -> str:
        more = ", …" if len(value) > SHOWN_AT_MOST else ""
        return f"[{', '.join(self.of.text(v, motion) for v in value[:SHOWN_AT_MOST])}{more}]"


def numbers(
    unit: Unit = NONE, *, least: int = 0, most: int = 2000, default: Any = _REQUIRED, shown: bool = True
) -> List:
    """A list of numbers."""
    return List(Number(), unit=unit, least=least, most=most, default=default, shown=shown)


def pairs(unit: Unit, *, least: int, most: int, default: Any = _REQUIRED) -> List:
    """A list of lists of two numbers."""
    return List(numbers(least=2, most=2), unit=unit, least=least, most=most, default=default)


class Between(Field):
    """A number, or the smaller and the larger end of an interval; read as both ends."""

    def __init__(self, unit: Unit, *, least: int | None = None, above: int | None = None) -> None:
        super().__init__(unit=unit)
        self.end = Number(least=least, above=above)

    def read(self, value: Any, at: str, motion: str) -> tuple[Fraction, Fraction]:
        ends = value if isinstance(value, list) else [value, value]
        if len(ends) != 2:
            raise Invalid(f"{at} must be a number, or both ends of an interval")
        low, high = (self.end.read(end, at, motion) for end in ends)
        if low > high:
            raise Invalid(f"{at} must begin at the smaller end of the interval")
        return low, high

    def schema(self, motion: str) -> dict[str, Any]:
        one = self.end.schema(motion)
        return {"anyOf": [one, {"type": "array", "items": one, "minItems": 2, "maxItems": 2}]}

    def text(self, value: tuple[Fraction, Fraction], motion: str) -> str:
        low, high = map(exactly, value)
        return low if low == high else f"{low} to {high}"


class Record(Field):
    """An object with these entries and no others.

    `named`: its name stands before each of its rows, as there is another one with the same entries.
    """

    def __init__(
        self,
        fields: Mapping[str, Field],
        *,
        default: Any = _REQUIRED,
        shown: bool = True,
        named: bool = False,
    ) -> None:
        super().__init__(default=default, shown=shown)
        self.fields, self.named = dict(fields), named

    def extended(self, **more: Field) -> Record:
        """The same with more entries."""
        return Record({**self.fields, **more}, default=self.default, shown=self.shown, named=self.named)

    def read(self, value: Any, at: str, motion: str) -> Read:
        if not isinstance(value, Mapping):
            raise Invalid(f"{at or 'a document'} must be an object")
        spend(100 + 20 * len(self.fields))
        place = f"{at}." if at else ""
        by_key = {field.key(name, motion): name for name, field in self.fields.items()}
        self._require_known(value, place, motion)
        found = {}
        for key, name in by_key.items():
            field = self.fields[name]
            if key in value:
                found[name] = field.read(value[key], place + key, motion)
            elif field.required:
                raise Invalid(f"{place}{key} is missing")
            else:
                found[name] = field.default
        return Read(**found)

    def _require_known(self, told: Mapping[str, Any], place: str, motion: str) -> None:
        """Refuse what is not declared, a quantity in another unit by itself."""
        keys = {field.key(name, motion): name for name, field in self.fields.items()}
        unknown = [str(key)[:60] for key in told if key not in keys]
        for key in unknown:
            for right, name in keys.items():
                if right != name and (key == name or key.startswith(f"{name}_")):
                    raise Invalid(f"the unit of {name} must be that of {right}, got {place}{key}")
        if unknown:
            listed = ", ".join(f"{place}{key}" for key in unknown[:4])
            raise Invalid(f"entries that no proof of this kind has: {listed}")

    def schema(self, motion: str) -> dict[str, Any]:
        properties = {field.key(name, motion): field.schema(motion) for name, field in self.fields.items()}
        required = [field.key(name, motion) for name, field in self.fields.items() if field.required]
        return {
            "type": "object",
            "properties": properties,
            "required": required,
            "additionalProperties": False,
        }

    def keys(self, motion: str) -> Iterator[str]:
        for name, field in self.fields.items():
            yield field.key(name, motion)
            yield from field.keys(motion)

    def rows(self, name: str, value: Any, motion: str) -> Iterator[Row]:
        before = f"{name}: " if self.named else ""
        for inner, field in self.fields.items():
            found = getattr(value, inner)
            if field.shown and (field.required or found != field.default):
                for row in field.rows(inner, found, motion):
                    yield row._replace(name=before + row.name)

    def text(self, value: Any, motion: str) -> str:
        rows = self.rows("", value, motion)
        return ", ".join(f"{row.name} {row.text} {row.unit}".rstrip() for row in rows)


class OneOf(Field):
    """An object whose entry `tag` says which others it has."""

    def __init__(
        self, tag: str, cases: Mapping[Any, Record], *, default: Any = _REQUIRED, shown: bool = True
    ) -> None:
        super().__init__(default=default, shown=shown)
        self.tag = tag
        self.cases = {word: record.extended(**{tag: Choice(word)}) for word, record in cases.items()}

    def read(self, value: Any, at: str, motion: str) -> Read:
        if not isinstance(value, Mapping) or self.tag not in value:
            raise Invalid(f"{at} must be an object with {self.tag}")
        word = Choice(*self.cases).read(value[self.tag], f"{at}.{self.tag}", motion)
        found: Read = self.cases[word].read(value, at, motion)
        return found

    def schema(self, motion: str) -> dict[str, Any]:
        return {"oneOf": [case.schema(motion) for case in self.cases.values()]}

    def keys(self, motion: str) -> Iterator[str]:
        for case in self.cases.values():
            yield from case.keys(motion)

    def rows(self, name: str, value: Any, motion: str) -> Iterator[Row]:
        yield from self.cases[getattr(value, self.tag)].rows(name, value, motion)

    def text(self, value: Any, motion: str) -> str:
        return self.cases[getattr(value, self.tag)].text(value, motion)


class Either(Field):
    """One of two sorts; `is_first` tells of a value which."""

    def __init__(
        self,
        first: Field,
        second: Field,
        is_first: Callable[[Any], bool],
        *,
        default: Any = _REQUIRED,
        shown: bool = True,
    ) -> None:
        super().__init__(default=default, shown=shown)
        self.first, self.second, self.is_first = first, second, is_first

    def read(self, value: Any, at: str, motion: str) -> Any:
        if not isinstance(value, (Mapping, list, tuple)):
            raise Invalid(f"{at} must be a list or an object")
        return (self.first if self.is_first(value) else self.second).read(value, at, motion)

    def schema(self, motion: str) -> dict[str, Any]:
        return {"oneOf": [self.first.schema(motion), self.second.schema(motion)]}

    def keys(self, motion: str) -> Iterator[str]:
        yield from self.first.keys(motion)
        yield from self.second.keys(motion)

    def rows(self, name: str, value: Any, motion: str) -> Iterator[Row]:
        yield from self._sort(value).rows(name, value, motion)

    def _sort(self, value: Any) -> Field:
        """The one by which a value was read."""
        return self.second if _is_of(self.second, value) else self.first


def _is_of(field: Field, value: Any) -> bool:
    if isinstance(field, Record):
        return isinstance(value, Read) and vars(value).keys() == field.fields.keys()
    return not isinstance(value, Read)


def document(fields: Mapping[str, Field]) -> Record:
    """What a document consists of, besides its kind and words for those who sort documents."""
    return Record({"format": Words(MOST_LETTERS, default=None, shown=False), **fields})
