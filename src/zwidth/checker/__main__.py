"""The checker by itself, with Python and nothing else:

    python -m zwidth.checker FILE

says VALID or NOT VALID and what was shown; exit status 0 where everything holds, 1 where something does
not, 2 where the file cannot be read.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import NoReturn

from .document.file import Unreadable
from .verdict import answer, headline, judge_file, not_checked, rows


def main(arguments: Sequence[str]) -> int:
    """Check one file."""
    if len(arguments) != 1 or arguments[0].startswith("-"):
        print(__doc__, file=sys.stderr)
        return 2
    try:
        found = judge_file(arguments[0])
    except Unreadable as error:
        print(f"{arguments[0]}: {error}", file=sys.stderr)
        return 2
    if (whole := answer(found)) is not None:
        print("  ".join(whole))
    for part in found.parts:
        print("  ".join(headline(part)))
        for row in rows(part):
            print(f"  {row.name:20} {row.text} {row.unit if row.name == 'energy extracted' else ''}".rstrip())
    if told := not_checked(found):
        print(f"told, not checked: {told}")
    return 0 if found.valid else 1


def command() -> NoReturn:
    """Check the file that the command line names."""
    sys.exit(main(sys.argv[1:]))


if __name__ == "__main__":
    command()
