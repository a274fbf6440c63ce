"""The values of one parameter that is varied: a range, a range of equal ratios, or a list.

    100:3000:50      50 values from 100 to 3000, evenly spaced
    0:5 ms:20        the unit may stand once
    1:1000:20 log    each the same number of times the one before
    0, 1 ms, 2.5 ms  a list

Each value is a double, and means the decimal that Python prints for it, as everywhere.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from zwidth.errors import InputError
from zwidth.model.specification.table import quoted
from zwidth.quantity.exact import Exact
from zwidth.quantity.text import shown
from zwidth.quantity.units import parse_number

MOST_VALUES = 1_000_000
"""Of one parameter; more are a mistake in the numbers."""

_WRITTEN = "100:3000:50, 1:1000:20 log, or a list 0, 1 ms, 2 ms"


@dataclass(frozen=True)
class Axis:
    """One parameter and its values.

    `name`, `unit`: of the parameter; SI.
    `values`: in this order, no two the same.
    """

    name: str
    unit: str
    values: tuple[float, ...]

    @property
    def array(self) -> NDArray[np.float64]:
        """The values."""
        return np.array(self.values)

    def told(self, value: float) -> str:
        """The parameter at one value, "delay = 1 ms"."""
        return f"{self.name} = {shown(value, self.unit, 12)}"


def axis(name: str, given: object, unit: str) -> Axis:
    """Read the values of a parameter.

    `name`, `unit`: of the parameter; what has no unit of its own is in this one.
    `given`: a text as above, (start, stop, count), (start, stop, count, "log"), or a list of values.
    """
    values = _values(name, given, unit)
    if not values:
        raise InputError(f"{name}: there is no value to take; write {_WRITTEN}")
    if len(values) > MOST_VALUES:
        raise InputError(f"{name}: at most {MOST_VALUES} values, got {len(values)}")
    seen: set[float] = set()
    for value in values:
        if value in seen:
            raise InputError(f"{name} has the value {shown(value, unit, 12)} twice; each loop is asked once")
        seen.add(value)
    return Axis(name, unit, values)


def _values(name: str, given: object, unit: str) -> tuple[float, ...]:
    if isinstance(given, str):
        return _typed(name, given, unit)
    if isinstance(given, tuple) and len(given) in (3, 4):
        start, stop, count = given[:3]
        return _range(name, start, stop, count, unit, log=_is_log(name, given[3:]))
    if isinstance(given, Iterable):
        return tuple(float(parse_number(_plain(value), unit, name)) for value in given)
    raise InputError(
        f"{name} is varied over a text such as {_WRITTEN}; over (start, stop, count); or over a list"
    )


def _plain(value: Any) -> Any:
    return value.item() if isinstance(value, np.generic) else value


def _is_log(name: str, rest: tuple[object, ...]) -> bool:
    if rest not in ((), ("log",)):
        raise InputError(f'{name}: after start, stop and count may come "log", got {rest[0]!r}')
    return bool(rest)


def _typed(name: str, text: str, unit: str) -> tuple[float, ...]:
    if ":" not in text:
        return tuple(float(value) for value in _numbers(name, text.split(","), unit))
    parts = [part.strip() for part in text.split(":")]
    if len(parts) != 3:
        raise InputError(f"{name}: a range is start:stop:count, got {quoted(text)}; write {_WRITTEN}")
    count, _, rest = parts[2].partition(" ")
    start, stop = _numbers(name, parts[:2], unit)
    if rest.strip() not in ("", "log"):
        raise InputError(
            f"{name}: after the count of {quoted(text)} may come log alone; a unit belongs to start and "
            "stop, as in 0:5 ms:20"
        )
    return _range(name, start, stop, count, unit, log=bool(rest.strip()))


def _numbers(name: str, parts: list[str], unit: str) -> list[Exact]:
    """The numbers of a text; the unit of the last is that of those before it, if they all have none."""
    bare = [not any(map(str.isalpha, _mantissa(part))) for part in parts]
    own = _unit_of(parts[-1])
    if own and all(bare[:-1]):
        parts = [*(f"{part} {own}" for part in parts[:-1]), parts[-1]]
    elif not own and not all(bare):
        raise InputError(f"{name}: the unit belongs after the last of the numbers, or after every one")
    return [parse_number(part.strip(), unit, name) for part in parts]


def _mantissa(part: str) -> str:
    """A number without the e of its exponent."""
    return part.lower().replace("e-", "").replace("e+", "") if any(map(str.isdigit, part)) else part


def _unit_of(part: str) -> str:
    text = part.strip()
    end = next((i for i in range(len(text), 0, -1) if _is_number(text[:i])), 0)
    return text[end:].strip()


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _range(name: str, start: Any, stop: Any, count: Any, unit: str, *, log: bool) -> tuple[float, ...]:
    low, high = (parse_number(_plain(end), unit, name).fraction for end in (start, stop))
    try:
        number = int(count)
        whole = number == float(count)
    except (TypeError, ValueError, OverflowError):
        whole = False
    if not whole or not 2 <= number <= MOST_VALUES:
        raise InputError(
            f"{name}: the count is a whole number from 2 to {MOST_VALUES}, got {quoted(str(count))}; for one "
            "value give it as an option of its own"
        )
    if low >= high:
        raise InputError(
            f"{name} runs from its smaller to its larger end, got {float(low):g} … {float(high):g}; "
            "swap the ends"
        )
    if log and low <= 0:
        raise InputError(f"{name}: a range of equal ratios begins above 0, got {float(low):g}")
    if log:
        return tuple(float(value) for value in _ratios(low, high, number))
    return tuple(float(low + (high - low) * i / (number - 1)) for i in range(number))


def _ratios(low: Fraction, high: Fraction, count: int) -> list[Any]:
    """Six digits each, as a person would write them down: the same on every machine."""
    ratio = float(high / low)
    inner = [Exact(f"{float(low) * ratio ** (i / (count - 1)):.6g}") for i in range(1, count - 1)]
    return [low, *inner, high]


class Column(NamedTuple):
    """One entry of every answer.

    `meaning`: in a few words.
    `unit`: of a number; "" of words, and of what is true or false.
    `words`: those that it may be; () of a number.  A word is kept as its place among them, from 1 on: 0 is
        none.
    `several`: whether several of the words may hold at once: each is then a bit.
    """

    meaning: str
    unit: str = ""
    words: tuple[str, ...] = ()
    several: bool = False

    @property
    def kind(self) -> str:
        """The type of what is kept."""
        if not self.words:
            return "float64" if self.unit else "bool"
        return "uint16" if self.several else "uint8"

    def kept(self, value: Any) -> float | int:
        """What is kept of a value: of a number, a word, or several words."""
        if not self.words:
            return float("nan") if value is None and self.unit else float(value or 0)
        if self.several:
            return sum(1 << self.words.index(word) for word in value)
        return self.words.index(value) + 1 if value else 0

    def shown(self, kept: NDArray[Any]) -> NDArray[Any]:
        """Numbers as they are, and words again."""
        if not self.words:
            return kept
        if not self.several:
            return np.asarray(np.array(["", *self.words])[kept])
        found = {
            code: "; ".join(word for bit, word in enumerate(self.words) if code >> bit & 1)
            for code in np.unique(kept).tolist()
        }
        shown = np.full(kept.shape, "", dtype=f"<U{max(1, *map(len, found.values()))}")
        for code, text in found.items():
            shown[kept == code] = text
        return shown

    def told(self) -> dict[str, str]:
        """What is said of the numbers or words beside them."""
        return {"long_name": self.meaning} | ({} if self.words or not self.unit else {"units": self.unit})

    def about(self) -> dict[str, Any]:
        """The same of what is kept, words in the way of the CF conventions."""
        told: dict[str, Any] = self.told()
        if not self.words:
            return told
        told["flag_meanings"] = " ".join(word.replace(" ", "_") for word in self.words)
        if self.several:
            return told | {"flag_masks": [1 << bit for bit in range(len(self.words))]}
        return told | {"flag_values": list(range(1, len(self.words) + 1))}


Columns = Mapping[str, Column]

REFUSED = "refused"

OF_EVERY_SWEEP: Columns = {REFUSED: Column("True of a loop that cannot be: its numbers exclude one another")}
"""What is kept beside the answers."""
