"""All step functions of the package as one text in C, and how each is reached from outside."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import count
from pathlib import Path
from typing import Any

from zwidth.native.expressions import Read, literal
from zwidth.native.names import Defined, Octets, OutsideError, Package, c_name
from zwidth.native.signature import Signature, address, signature_of, taken
from zwidth.native.statements import Function
from zwidth.native.types import ITEMS, REAL, Asked, Cells, Maybe, Nothing, Number, Several, Type, told

PRELUDE = Path(__file__).with_name("prelude.c")
BY_HAND = Path(__file__).with_name("system.c")


class Translation:
    """Of the step functions of a package."""

    def __init__(self, root: Path) -> None:
        self.package = Package(root)
        self._signatures: dict[tuple[str, str], Signature] = {}
        self._several: dict[str, Several] = {}
        self._asked: dict[str, Asked] = {}
        self._tables: dict[tuple[Any, ...], str] = {}
        self._by_hand = BY_HAND.read_text(encoding="utf-8")

    def text(self) -> str:
        """The whole text."""
        bodies, faults = list[str](), list[str]()
        own = list(self.package.step_functions())
        for of in own:
            try:
                name = self.signature(of).name
                if f" {name}(" not in self._by_hand:
                    bodies.append(Function(self, of).written())
            except OutsideError as fault:
                faults.append(str(fault))
        if faults:
            raise OutsideError("\n".join(faults))
        heads = [f"{s.head()};" for s in self._signatures.values()]
        own_names = {self.signature(of).name for of in own}
        entries = [_entry(s) for s in self._signatures.values() if s.name in own_names]
        prelude = PRELUDE.read_text(encoding="utf-8")
        before = [prelude, *self._types(), *self._written_tables(), *heads, self._by_hand]
        return "\n".join([*before, *bodies, *entries, ""])

    def table(self) -> dict[str, Any]:
        """What each function takes and returns; after `text`."""
        return {
            s.name: {"takes": [(name, told(of)) for name, of in s.takes], "returns": told(s.returns)}
            for s in self._signatures.values()
        }

    def sources(self) -> list[Path]:
        """The files that the text was made of, those of the translator among them; after `text`."""
        own = (path for path in sorted(PRELUDE.parent.glob("*")) if path.suffix in (".py", ".c"))
        return [*self.package.read(), *own]

    def signature(self, of: Defined) -> Signature:
        key = of.module.name, of.node.name
        if key not in self._signatures:
            found = signature_of(of, c_name(*key))
            for kind in (*(t for _, t in found.takes), found.returns):
                self._declare(kind)
            self._signatures[key] = found
        return self._signatures[key]

    def several(self, of: Several) -> Several:
        self._declare(of)
        return of

    def _declare(self, of: Type) -> None:
        if isinstance(of, Several):
            for part in of.items:
                self._declare(part)
            self._several.setdefault(of.c, of)
        if isinstance(of, Asked):
            self._asked.setdefault(of.c, of)

    def constants(self, values: tuple[Any, ...]) -> Read:
        item = _item(values)
        name = self._tables.setdefault((item, *values), f"zw_table{len(self._tables)}")
        of = Cells(item)
        return Read(f"(({of.c}){{({ITEMS[item][1]} *){name}, {{{len(values)}, 1, 1, 1}}}})", of)

    def _types(self) -> list[str]:
        several = [
            f"typedef struct {{ {' '.join(f'{part.c} f{n};' for n, part in enumerate(of.items))} }} {name};"
            for name, of in self._several.items()
        ]
        asked = [
            f"typedef {of.returns.c} (*{name})({', '.join(map(taken, of.takes))});"
            for name, of in self._asked.items()
        ]
        return several + asked

    def _written_tables(self) -> list[str]:
        tables = []
        for (item, *values), name in self._tables.items():
            numbers = ", ".join(literal(float(v) if item == "float64" else v).c for v in values)
            tables.append(f"static const {ITEMS[item][1]} {name}[] = {{{numbers}}};")
        return tables


def _item(values: tuple[Any, ...]) -> str:
    if isinstance(values, Octets):
        return "uint8"
    return "int64" if all(isinstance(v, int) for v in values) else "float64"


def _entry(signature: Signature) -> str:
    """How it is reached from outside: numbers and arrays in a row of words; what it returns, too."""
    words, back = ((f"w[{k}]" for k in count()) for _ in range(2))
    given = ", ".join(address(_taken(of, words), of) for _, of in signature.takes)
    call = f"{signature.name}({given})"
    lines = [f"ZW_SEEN void zwx_{signature.name}(zw_word *w) {{"]
    if isinstance(signature.returns, Nothing):
        lines.append(f"    (void)w; {call};")
    else:
        lines.append(f"    {signature.returns.c} r = {call};")
        lines += [f"    {text}" for text in _told("r", signature.returns, back)]
    lines.append("}")
    if isinstance(signature.returns, Number) and [of for _, of in signature.takes] == _EXCHANGED:
        lines.append(f"ZW_SEEN void *const zwp_{signature.name} = (void *){signature.name};")
    return "\n".join(lines)


_EXCHANGED = [Cells("float64"), Cells("uint8"), Cells("uint8")]
"""What a function takes that the loop is given: see `servo.connection`."""


def _taken(of: Type, words: Iterator[str]) -> str:
    if isinstance(of, Number):
        return f"{next(words)}.{'f' if of == REAL else 'i'}"
    if isinstance(of, Maybe):
        return f"(zw_maybe){{{next(words)}.f, {next(words)}.i}}"
    if isinstance(of, Cells):
        first, n = next(words), ", ".join(f"{next(words)}.i" for _ in range(4))
        return f"({of.c}){{{first}.p, {{{n}}}}}"
    if isinstance(of, Asked):
        return f"({of.c}){next(words)}.p"
    assert isinstance(of, Several)
    return f"({of.c}){{{', '.join(_taken(part, words) for part in of.items)}}}"


def _told(name: str, of: Type, words: Iterator[str]) -> list[str]:
    if isinstance(of, Number):
        return [f"{next(words)}.{'f' if of == REAL else 'i'} = {name};"]
    parts = enumerate(of.items) if isinstance(of, Several) else ()
    return [line for n, part in parts for line in _told(f"{name}.f{n}", part, words)]
