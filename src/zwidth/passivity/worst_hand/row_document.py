"""Laws in a row in a certificate or a witness, and whether they give what it says.

The checker knows no law: it takes the table of states, or the forces of a motion, as they stand in
the document.  `same_law` steps the law again, by the simulator's own functions, and compares to the bit.
"""

from __future__ import annotations

import base64
import zlib
from collections.abc import Mapping
from fractions import Fraction
from math import ceil
from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth.errors import InputError
from zwidth.loop.every_reading import after_reading, scratch
from zwidth.passivity.document import unit_key
from zwidth.passivity.worst_hand.board import Domain
from zwidth.passivity.worst_hand.row_law import RowLaw, row_law
from zwidth.passivity.worst_hand.row_table import Table, tabulate

if TYPE_CHECKING:
    from zwidth.device.device import Device
    from zwidth.environment.environment import Environment

STORAGE, MOTION = "row storage", "row motion"


def packed(values: Any, kind: str = "<i8") -> str:
    """Numbers as text: little-endian, compressed."""
    raw = np.ascontiguousarray(values).astype(kind).tobytes()
    return base64.b64encode(zlib.compress(raw, 6)).decode("ascii")


def _raw(value: Any) -> Any:
    """The numbers of a packed text, as bytes; anything else as it is."""
    return zlib.decompress(base64.b64decode(value)) if isinstance(value, str) else value


def law_document(law: RowLaw) -> dict[str, Any]:
    """What is in the game, in words: the table and the forces are its data."""
    return {
        "description": law.description,
        "counts_force_limit": law.limited,
        "counts_force_resolution": law.stepped,
    }


def table_document(table: Table) -> dict[str, Any]:
    """States, where each reading leads, and the forces, as data."""
    return {
        "states": table.states,
        "starts": table.starts.tolist(),
        "counts": packed(table.counts),
        "successors": packed(table.successors),
        "forces": packed(table.forces, "<f8"),
    }


def columns(motion: str) -> tuple[str, str]:
    """The keys of positions and forces, "linear" or "rotary"."""
    length, force = (unit_key(name, motion).split("_")[-1] for name in ("position", "force_limit"))
    return f"positions_{length}", f"forces_{'N_m' if motion == 'rotary' else force}"


class Run:
    """Laws in a row, reading by reading, from a hand that has rested at a count for ever."""

    def __init__(self, law: RowLaw, rest: int) -> None:
        self._law, self._row = law, law.starts[rest]

    def force(self, count: int) -> float:
        """What acts after this reading [N; N·m]."""
        after_reading(self._law.packed, self._row, self._law.waiting, count, scratch())
        return float(self._row[-self._law.waiting])

    @property
    def memory(self) -> bytes:
        """All that is remembered."""
        return self._row.tobytes()


def same_law(document: Mapping[str, Any], device: Device, environment: Environment) -> bool:
    """True if laws in a row give, to the bit, the table or the forces that a document holds.

    Parameters
    ----------
    document
        A certificate of kind "row storage", or a witness of kind "row motion", that the checker accepts.
    device, environment
        The loop of which it is said to speak.

    Raises
    ------
    InputError
        If it is no such document.
    """
    kind = document.get("kind")
    if kind not in (STORAGE, MOTION):
        raise InputError(
            f"a document of laws in a row is of kind {STORAGE} or {MOTION}, got {str(kind)[:40]!r}"
        )
    counted = document["law"]
    limited, stepped = (bool(counted[f"counts_force_{k}"]) for k in ("limit", "resolution"))
    if kind == STORAGE:
        board = document["domain"]
        low, high = int(board["lowest_count"]), int(board["highest_count"])
        law = row_law(device, environment, low, force_limit=limited, force_resolution=stepped)
        domain = Domain(low, high, ceil(Fraction(str(board["largest_move_counts"]))))
        table = tabulate(law, domain, most=int(document["table"]["states"]))
        return all(_raw(v) == _raw(document["table"].get(k)) for k, v in table_document(table).items())
    return _same_motion(document, device, environment, limited, stepped)


def _same_motion(
    document: Mapping[str, Any], device: Device, environment: Environment, limited: bool, stepped: bool
) -> bool:
    """Whether the forces are the law's, and it remembers after a round what it did before it."""
    x, forces = ([Fraction(str(v)) for v in document[key]] for key in columns(device.motion))
    counts = [int(p // device.exact("resolution")) for p in x]
    law = row_law(device, environment, counts[0], force_limit=limited, force_resolution=stepped)
    if counts[0] not in law.resting:
        return False
    run = Run(law, counts[0])
    seen = [(Fraction(run.force(n)), run.memory) for n in counts]
    part = document["repeats"]
    round_closes = seen[int(part["first"])][1] == seen[int(part["last"])][1]
    return round_closes and [force for force, _ in seen[:-1]] == forces
