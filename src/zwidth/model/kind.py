"""The types that a table can name: where the class of each is; its keys are the fields of the class."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from importlib import import_module
from types import MappingProxyType
from typing import Any, NamedTuple

from zwidth.quantity.parameter import Parameter, parameters_of


class Kind(NamedTuple):
    """A class that a specification can name, of a package of the model; imported when it is asked for."""

    package: str
    class_name: str
    meaning: str

    @property
    def made(self) -> type[Any]:
        """The class."""
        made: type[Any] = getattr(import_module(f"zwidth.model.{self.package}"), self.class_name)
        return made

    @property
    def keys(self) -> Mapping[str, Parameter]:
        """Its keys, which are the arguments of the class."""
        return parameters_of(self.made)

    def missing(self, given: Iterable[str]) -> list[str]:
        """The keys that must be given and are not."""
        return [key for key, own in self.keys.items() if own.required and key not in given]


def kinds(package: str, meanings: Mapping[str, str]) -> Mapping[str, Kind]:
    """Classes of one package and what they are, by the class's name in small letters: "pole-matched"."""
    return MappingProxyType(
        {
            re.sub(r"\B(?=[A-Z])", "-", name).lower(): Kind(package, name, said)
            for name, said in meanings.items()
        }
    )


def name_of(thing: object, kinds: Mapping[str, Kind]) -> str | None:
    """The name that a specification has for a thing; None where it has none."""
    return next((name for name, kind in kinds.items() if kind.class_name == type(thing).__name__), None)


def bracketed(own: Parameter, motion: str) -> str:
    """The unit of a key as a message shows it behind the key: " [N/m]", "" where it has none."""
    unit = own.unit_for(motion)
    return f" [{unit}]" if unit not in ("", "1") else ""
