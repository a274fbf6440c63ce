"""How large the house may be: rooms, folders, names.  Every number only goes down.

Whoever makes something smaller lowers its number in the same change.  Whoever has to raise one writes in
docs/inside.md, under "What this project does not do", what was weighed against it and left out.
"""

from __future__ import annotations

from collections import Counter
from pathlib import Path

from test_circles import imports

import zwidth as zw

SOURCE = Path(zw.__file__).parent
FILES = [path for ending in ("py", "pyi") for path in SOURCE.rglob(f"*.{ending}")]

LINES = {
    "beside the rooms": 1140,
    "checker": 10458,
    "cli": 10510,
    "data": 22692,
    "links": 2321,
    "loop": 6979,
    "machine": 17397,
    "model": 17709,
    "native": 1578,
    "passivity": 28343,
    "quantity": 2074,
    "show": 8992,
    "study": 5549,
}
"""Of source, at most, in each room."""

IN_ALL = 135742
PHYSICS = 65563
"""Lines of quantity, model, loop, passivity and checker."""

FILES_IN_ALL, IN_A_FOLDER = 671, 25

ALONE = 135
"""Files that one other file alone imports."""

NAMES = 60
"""That `zwidth` offers."""


def lines() -> Counter[str]:
    """Of each room, and of what stands beside them."""
    found: Counter[str] = Counter()
    for path in FILES:
        room = path.relative_to(SOURCE).parts
        found[room[0] if len(room) > 1 else "beside the rooms"] += path.read_bytes().count(b"\n")
    return found


def test_no_room_grows() -> None:
    """Each has its number: no less than it has, and little more, so that what was won stays won."""
    found = lines()
    assert found.keys() == LINES.keys()
    assert {room: n for room, n in found.items() if not 0.98 * LINES[room] - 20 <= n <= LINES[room]} == {}


def test_the_house_does_not_grow() -> None:
    """Neither as a whole, nor what the proofs stand on, nor the number of its files."""
    found = lines()
    physics = sum(found[room] for room in ("quantity", "model", "loop", "passivity", "checker"))
    assert found.total() <= IN_ALL
    assert physics <= PHYSICS
    assert len(FILES) <= FILES_IN_ALL


def test_no_folder_is_too_full() -> None:
    """A person sees at one look what is in it."""
    files = Counter(path.parent for path in FILES if path.suffix == ".py")
    assert {str(folder): count for folder, count in files.items() if count > IN_A_FOLDER} == {}


def test_few_files_have_one_reader() -> None:
    """What one other file alone imports is most often a part of it."""
    taken = Counter(other for others in imports().values() for other in others)
    assert sum(count == 1 for count in taken.values()) <= ALONE


def test_few_names_are_offered() -> None:
    """The first page of a reference."""
    assert len(zw.__all__) <= NAMES
