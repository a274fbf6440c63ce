"""What every result is: a sentence, its numbers, what it rests on, and evidence that anyone can check."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from math import inf, nan
from typing import TYPE_CHECKING, Any, ClassVar

from zwidth.checker import EVIDENCE, verify
from zwidth.errors import InputError
from zwidth.passivity.scope import COLOUR, Scope
from zwidth.passivity.wording import lines
from zwidth.quantity.answered import data_of, rows_of
from zwidth.quantity.documented import Documented
from zwidth.quantity.glossary import GLOSSARY, unit_suffix
from zwidth.showing import Headline, Lines, Part, Table


def evidence_of(result: object) -> dict[str, Any]:
    """The proofs and motions that a result holds, as plain data."""
    found = {name: getattr(result, name, None) for name in EVIDENCE}
    return {getattr(part, "_KEY", name): part.saved() for name, part in found.items() if part is not None}


def share_left(asked: float | None, most: float | None) -> float | None:
    """Of the most that is borne the share that is not asked for, 1 − asked/most; None where either is.

    1 where nothing is asked, −∞ where nothing is borne.
    """
    if asked is None or most is None:
        return None
    return 1.0 if asked <= 0 else 1 - asked / most if most > 0 else -inf


def least(margins: Iterable[float | None]) -> float | None:
    """The margin of several answers that all must hold; None where one is not known."""
    found = [*margins]
    return None if None in found else min((margin for margin in found if margin is not None), default=None)


class Result(Documented):
    """Something found.  It describes itself once: a terminal, a notebook and a file are made of that."""

    @property
    def assumptions(self) -> tuple[str, ...]:
        """What it covers and takes for granted, line by line."""
        return ()

    def describe(self) -> str:
        """It in a sentence."""
        raise NotImplementedError

    def says(self) -> str:
        """It in a sentence."""
        return self.describe()

    def rows(self) -> Iterable[tuple[str, str]]:
        """The main numbers as (name, text) for a report."""
        return rows_of(self)

    def advised(self) -> Iterable[Part]:
        """What to change, or what is left."""
        return ()

    def report(self) -> Iterable[Part]:
        """The sentence, the numbers, what to change, and what is taken for granted."""
        yield self._headline()
        rows = list(self.rows())
        if rows:
            yield Table(rows=rows)
        yield from self.advised()
        assumed = self.small_print()
        if assumed:
            yield Lines(assumed, "assumptions")

    def small_print(self) -> tuple[str, ...]:
        """What a report says last."""
        return self.assumptions

    def _headline(self) -> Part:
        return self.describe()

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.describe()}>"


class Evidence(Result):
    """A proof or a motion, which the independent checker accepts or rejects by itself."""

    def verify(self) -> bool:
        """True when the independent checker accepts it."""
        return verify(self.to_dict()).valid

    def _headline(self) -> Part:
        return f"{self.describe()}: {'accepted' if self.verify() else 'rejected'} by the checker"


class Answer(Result):
    """The answer to a question: there are more than yes and no, so none of them is true or false.

    `outcome`: what came of the question, in a word; `claim`: the same in a sentence; `scope`: what it is
    about; `certificate`: the proof; None where there is none; `witness`: the motion against it; None where
    there is none.  Of a loop `violation` too.
    """

    _YES: ClassVar[str]
    """The property that is True where the answer is yes."""

    if TYPE_CHECKING:

        @property
        def outcome(self) -> str: ...
        @property
        def claim(self) -> str: ...
        @property
        def scope(self) -> Scope: ...

    @property
    def assumptions(self) -> tuple[str, ...]:
        """What the claim covers and takes for granted, line by line."""
        return tuple(self._assumptions())

    def _assumptions(self) -> Iterable[str]:
        return lines(self.scope, self.outcome)

    @property
    def margin(self) -> float | None:
        """1 − asked/most: of the most that is proved, the share that is left; it has no unit.

        ≥ 0 where the outcome is a proof, 0 at its limit, 1 where nothing is asked; else < 0, −1 where twice
        as much is asked as is proved.  None where the most is not known, or something else decides.
        """
        left, proved = self._left(), self.outcome not in ("active", "unstable", "undecided")
        return left if left is not None and (left >= 0) == proved else None

    def _left(self) -> float | None:
        """`share_left` of what this class asks, and of the most of it that is proved."""
        return None

    def __bool__(self) -> bool:
        """Refuse to be true or false."""
        raise InputError(
            f"this answer is {self.outcome!r}, and an answer is neither true nor false: "
            f"ask .{self._YES}, which is True for a proof alone, or compare .outcome"
        )

    def describe(self) -> str:
        """Outcome and claim."""
        return f"{self.outcome}: {self.claim}"

    def numbers(self) -> dict[str, Any]:
        """The main numbers as plain data, a unit in every key of a physical quantity."""
        return data_of(self)

    def evidence(self) -> dict[str, Any]:
        """Proofs and motions as plain data."""
        return evidence_of(self)

    def stated(self) -> dict[str, Any]:
        """Outcome, scope, assumptions and numbers as plain data, units in the keys; the evidence left out."""
        return {
            "format": self._FORMAT,
            "outcome": self.outcome,
            "claim": self.claim,
            "scope": self.scope.to_dict(),
            "assumptions": list(self.small_print()),
            **self.numbers(),
        }

    def to_pandas(self) -> Any:
        """What is stated as a pandas Series, units in its labels: a row of a table of many answers.

        Assumptions, advice and evidence are in `to_dict`.
        """
        return to_series(self.stated())

    def to_xarray(self) -> Any:
        """The same as an xarray Dataset without dimensions, its units in the attributes too."""
        return to_dataset(self.stated())

    def to_dict(self) -> dict[str, Any]:
        """What is stated, and the evidence, as plain data, units in the keys."""
        return {**self.stated(), **self.evidence()}

    def _headline(self) -> Part:
        return Headline(self.outcome, COLOUR[self.outcome], self.claim)


class PassivityAnswer(Answer):
    """Whether a hand can take energy out of a loop."""

    _YES = "passive"

    @property
    def passive(self) -> bool:
        """True where the outcome is "passive": a proof, with contact made and broken, or as was asked."""
        return self.outcome == "passive"


# An answer as one row: names are the keys of its plain data, those of a table inside after a point, such as
# `margins.damping_N_s_per_m`.


_LEFT_OUT = ("format", "assumptions", "advice")
"""Not of one number or word: in the attributes, or in `to_dict`."""


def flat(stated: Mapping[str, Any]) -> dict[str, Any]:
    """What is stated, without tables inside tables; lists of words on a line, None as it is."""
    return dict(_rows({key: value for key, value in stated.items() if key not in _LEFT_OUT}))


def _rows(table: Mapping[str, Any], before: str = "") -> Iterator[tuple[str, Any]]:
    for key, value in table.items():
        if isinstance(value, Mapping):
            yield from _rows(value, f"{before}{key}.")
        elif not isinstance(value, (list, tuple)):
            yield f"{before}{key}", value
        elif not any(isinstance(item, (Mapping, list, tuple)) for item in value):
            yield f"{before}{key}", ", ".join(map(str, value))


def to_series(stated: Mapping[str, Any]) -> Any:
    """One row of a pandas DataFrame."""
    import pandas as pd

    return pd.Series(flat(stated), dtype=object)


def to_dataset(stated: Mapping[str, Any]) -> Any:
    """Variables without dimensions, units in their attributes; what is not known is nan."""
    import xarray as xr

    variables = {key: _variable(key, value) for key, value in flat(stated).items()}
    kept = {"format": stated["format"], "assumptions": "\n".join(stated["assumptions"])}
    return xr.Dataset(variables, attrs=kept)


def _variable(key: str, value: Any) -> tuple[tuple[()], Any, dict[str, str]]:
    if isinstance(value, (str, bool)):
        return (), value, {}
    return (), nan if value is None else float(value), _attributes(key)


def _attributes(key: str) -> dict[str, str]:
    ends = [end for end in _units() if key.endswith(f"_{end}")]
    return {"units": _units()[max(ends, key=len)]} if ends else {}


@cache
def _units() -> Mapping[str, str]:
    """The units of the glossary by what keys end in."""
    units = {unit for q in GLOSSARY.values() for unit in (q.unit, q.rotary_unit) if unit != "1"}
    return {unit_suffix(unit): unit for unit in units}
