"""Documents at the edge of what they prove, as plain data: true ones that must be accepted, false ones
refused.

One file for each kind of document, each with its `CASES`.  Most are true by equality, or false by a part in
10⁹; the bound stands beside them, worked out by hand where it has a closed form.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from copy import deepcopy
from fractions import Fraction
from importlib import import_module
from pkgutil import iter_modules
from typing import Any, NamedTuple

TINY = Fraction(1, 10**9)


class Case(NamedTuple):
    """A document, and what the checker has to say of it."""

    name: str
    document: Any
    """Or a check of the checker's arithmetic, which returns what is wrong."""
    refusal: str
    """A phrase of the reason; "" if the document is to be accepted."""
    words: str = ""
    """A phrase of what is said of an accepted one."""
    energy: Fraction | None = None
    scope: Mapping[str, Any] | None = None


def accepted(name: str, document: Any, words: str = "", energy: Any = None, **scope: Any) -> Case:
    """A true document: `scope` are the fields of its scope that matter, `energy` what the motion
    takes out.
    """
    return Case(name, document, "", words, None if energy is None else Fraction(energy), scope)


def refused(name: str, document: Any, phrase: str, energy: Any = None) -> Case:
    """A false document, and a phrase of the reason why."""
    return Case(name, document, phrase, energy=None if energy is None else Fraction(energy))


def loop(numerator: Any = ("0",), denominator: Any = ("1",), **device: Any) -> dict[str, Any]:
    """A loop of T = 1 s behind a surface; what is not named is 0."""
    zeros = ("damping_N_s_per_m", "coulomb_friction_N", "resolution_m", "delay_s")
    law = {"numerator": list(numerator), "denominator": list(denominator), "unilateral": True}
    return {**dict.fromkeys(zeros, "0"), "sample_period_s": "1", **law, **device}


def put(document: Any, entries: Mapping[str, Any]) -> Any:
    """A copy with some entries replaced or added, named as in "loop.damping_N_s_per_m" or "pieces.0.low"."""
    changed = deepcopy(document)
    for path, value in entries.items():
        inner, last = _inner(changed, path)
        inner[last] = value
    return changed


def without(document: Any, *paths: str) -> Any:
    """A copy that lacks some entries."""
    changed = deepcopy(document)
    for path in paths:
        inner, last = _inner(changed, path)
        del inner[last]
    return changed


def _inner(document: Any, path: str) -> tuple[Any, Any]:
    *way, last = (int(key) if key.isdigit() else key for key in path.split("."))
    for key in way:
        document = document[key]
    return document, last


def edge(name: str, true: Any, false: Any, phrase: str, words: str = "", **facts: Any) -> tuple[Case, Case]:
    """A document that is true by equality, and one false by little."""
    return accepted(name, true, words, **facts), refused(f"{name}, but for a hair", false, phrase)


def plain(value: Any) -> Any:
    """As it stands in a file: exact numbers as text; a check is left as it is."""
    if callable(value):
        return value
    return json.loads(json.dumps(value, default=str))


def files() -> list[str]:
    """The names of the files in this folder."""
    return [module.name for module in iter_modules(__path__)]


def cases_of(file: str) -> Iterator[Case]:
    """Of one file, each named after it."""
    cases = import_module(f"{__name__}.{file}").CASES
    names = [case.name for case in cases]
    if len(set(names)) < len(names):
        raise ValueError(f"two cases of one name in {file}: {sorted(names)}")
    for case in cases:
        yield case._replace(name=f"{file}: {case.name}", document=plain(case.document))


def all_cases() -> list[Case]:
    """Of every file in this folder."""
    return [case for file in files() for case in cases_of(file)]


def failure(case: Case, verify: Callable[[Any], Any]) -> str:
    """What the checker says wrongly of a case; "" if it is right."""
    try:
        if callable(case.document):
            return str(case.document())
        found = verify(case.document)
    except Exception as error:
        return f"{type(error).__name__}: {error}"[:300]
    if found.valid is not (not case.refusal):
        return f"accepted: {found.reason}" if found.valid else f"refused: {found.reason}"
    if (case.refusal or case.words) not in found.reason:
        return f"said: {found.reason}"
    if case.energy is not None and found.energy != case.energy:
        return f"energy {found.energy}, not {case.energy}"
    if not found.valid:
        return "" if found.scope is None else "a refused document is about nothing"
    told = {name: getattr(found.scope, name, None) for name in case.scope or {}}
    return "" if told == dict(case.scope or {}) else f"scope {told}"
