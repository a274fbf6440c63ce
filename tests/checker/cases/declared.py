"""What is declared of every kind: its JSON Schema as it is shipped, and how a document is shown, `shown.txt`.

    python -m zwidth.checker.schema
    (cd tests/checker && python -m cases.declared)

write both anew.
"""

from __future__ import annotations

from importlib import import_module
from itertools import zip_longest
from pathlib import Path
from pkgutil import iter_modules

import zwidth

from . import Case, plain

HERE = Path(__file__).parent


def shown() -> list[str]:
    """The rows of the first document of each kind that is accepted, and of the first that turns."""
    verify = import_module("zwidth.checker").verify
    lines, seen = [], set()
    for name in sorted(module.name for module in iter_modules([str(HERE)]) if module.name != "declared"):
        for case in import_module(f"{__package__}.{name}").CASES:
            kind = "" if case.refusal or callable(case.document) else case.document["kind"], name == "rotary"
            if kind[0] and kind not in seen:
                seen.add(kind)
                rows = verify(plain(case.document)).rows
                lines += [f"{kind[0]}, {case.name}", *("  " + " | ".join(map(str, row)) for row in rows)]
    return lines


def schemas_are_those_that_are_shipped() -> str:
    """Of every kind, and of corners, to the byte."""
    schema = import_module("zwidth.checker.schema")
    for kind in (*import_module("zwidth.checker.kinds").KINDS, "corners"):
        file = Path(zwidth.__file__).with_name("checker") / "schemas" / f"{kind.replace(' ', '-')}.json"
        if schema.text_of(kind).encode() != file.read_bytes():
            return f"the schema of {kind}"
    return ""


def rows_are_those_that_were_shown() -> str:
    """The first line that is not as in the file."""
    told, now = (HERE / "shown.txt").read_text(encoding="utf-8").splitlines(), shown()
    pairs = zip_longest(told, now, fillvalue="")
    return next((f"{said!r}, now {line!r}" for said, line in pairs if said != line), "")


CASES = [
    Case("schemas are those that are shipped", schemas_are_those_that_are_shipped, ""),
    Case("rows", rows_are_those_that_were_shown, ""),
]

if __name__ == "__main__":
    (HERE / "shown.txt").write_text("\n".join(shown()) + "\n", encoding="utf-8")
