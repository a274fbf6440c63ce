"""Laws in a chain in a certificate or a witness, and whether they give what it says.

The checker knows no law: it takes the table of states, or the forces of a motion, as they stand in
the document.  `same_law` steps a law again, by the simulator's own functions, and compares to the bit;
`law_of` does so with the law that the document gives the parameters of.
"""

from __future__ import annotations

import base64
import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from math import ceil, isfinite
from typing import Any

from zwidth.errors import InputError
from zwidth.loop.kernel import after_reading, scratch
from zwidth.model.device.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.transfer_function import as_environment
from zwidth.model.specification.write import parsed
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.scope import unit_key
from zwidth.passivity.storage.chain_table import ChainLaw, DoesNotClose, Table, chain_law, tabulate
from zwidth.passivity.storage.domain import Domain, losses_of
from zwidth.passivity.storage.storage_function import StorageFunction, loop_document, packed

STORAGE, MOTION = "row storage", "row motion"

MOST_WORK = 10_000_000
"""Readings that a law is stepped through for somebody else's document, times the numbers that it remembers:
some ten seconds of the dearest, windows of 1000 readings that are fitted at each length."""

_A_REST = 1000  # what it costs to find what is remembered by a hand that has rested at one count, likewise

MOST_WAITING = 10_000
"""Samples of delay, likewise: each keeps a force."""


def _raw(value: Any) -> Any:
    """The numbers of a packed text, as bytes; anything else as it is."""
    return zlib.decompress(base64.b64decode(value)) if isinstance(value, str) else value


def law_document(law: ChainLaw) -> dict[str, Any]:
    """What the law is, in words and parameters: the table and the forces are its data."""
    return {
        "description": law.description,
        **({"specification": law.specification} if law.specification else {}),
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
    """Laws in a chain, reading by reading, from a hand that has rested at a count for ever."""

    def __init__(self, law: ChainLaw, rest: int) -> None:
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
    """True if laws in a chain give, to the bit, the table or the forces that a document holds.

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
            f"a document of laws in a chain is of kind {STORAGE} or {MOTION}, got {str(kind)[:40]!r}"
        )
    counted = document["law"]
    limited, stepped = (bool(counted[f"counts_force_{k}"]) for k in ("limit", "resolution"))
    if kind == STORAGE:
        grid = document["domain"]
        low, high = int(grid["lowest_count"]), int(grid["highest_count"])
        law = chain_law(device, environment, low, force_limit=limited, force_resolution=stepped)
        domain = Domain(low, high, ceil(Fraction(str(grid["largest_move_counts"]))))
        try:
            table = tabulate(law, domain, most=int(document["table"]["states"]))
        except DoesNotClose:  # it has more states than the table
            return False
        return all(_raw(v) == _raw(document["table"].get(k)) for k, v in table_document(table).items())
    return _same_motion(document, device, environment, limited, stepped)


def law_of(document: Mapping[str, Any]) -> str | None:
    """Environment and laws that a document is of, in words made from its parameters, stepped again.

    None where it gives no parameters, or where stepping its law again would take long.

    Parameters
    ----------
    document
        As of `same_law`.

    Raises
    ------
    InputError
        If its parameters are no specification, or are those of another loop or of another law.
    """
    text = document["law"].get("specification")
    if not text:
        return None
    found = parsed(text, "the specification in it")
    device, environment = found.device, as_environment(found.environment)
    if not _same_loop(document["loop"], device):
        raise InputError("its specification is of a loop with other numbers")
    if _work(document, device, environment) > MOST_WORK:
        return None
    if not same_law(document, device, environment):
        raise InputError("stepped again, the law of its specification gives other forces than it lists")
    return environment.describe(device.motion)


def _work(document: Mapping[str, Any], device: Device, environment: Environment) -> int:
    """Readings that a law has to be stepped through, times the numbers that it remembers."""
    law = chain_law(device, environment, 0)
    remembered = len(law.starts[0])
    if document["kind"] == MOTION:
        return remembered * len(document[columns(device.motion)[0]])
    grid = document["domain"]
    reach = ceil(Fraction(str(grid["largest_move_counts"])))
    steps = int(document["table"]["states"]) * (2 * reach + 1)
    return remembered * steps - _A_REST * min(int(grid["lowest_count"]), 0)


def _same_loop(told: Mapping[str, Any], device: Device) -> bool:
    """Whether a device has the numbers of a loop; friction and damping too where no curve is used."""
    if device.exact("delay") > MOST_WAITING * device.exact("sample_period"):
        return False
    own = loop_document(losses_of(device), device.motion)
    curve = any(key.startswith("friction_curve") for key in told)
    clock = ("resolution", "sample_period", "delay")
    compared = [key for key in own if not curve or key.startswith(clock)]
    return all(key in told and Fraction(str(told[key])) == Fraction(own[key]) for key in compared)


def _same_motion(
    document: Mapping[str, Any], device: Device, environment: Environment, limited: bool, stepped: bool
) -> bool:
    """Whether the forces are the law's, and it remembers after a round what it did before it."""
    positions, held = columns(device.motion)
    x = [Fraction(str(v)) for v in document[positions]]
    counts = [int(p // device.exact("resolution")) for p in x]
    law = chain_law(device, environment, counts[0], only=True, force_limit=limited, force_resolution=stepped)
    if counts[0] not in law.resting:
        return False
    run = Run(law, counts[0])
    part = document["repeats"]
    ends = {int(part["first"]): b"", int(part["last"]): b""}
    for k, (n, force) in enumerate(zip(counts, [*document[held], None], strict=True)):
        given = run.force(n)
        if force is not None and not (isfinite(given) and Fraction(given) == Fraction(str(force))):
            return False
        if k in ends:
            ends[k] = run.memory
    return len(set(ends.values())) == 1


@dataclass(frozen=True)
class ChainStorage(StorageFunction):
    """The available storage of laws in a chain, from above."""

    law: ChainLaw  # the laws as the simulator runs them

    def certificate(self) -> Certificate:
        """The proof as data: the table of the law, the losses, the grid, V."""
        table = table_document(self.iteration.grid.table)
        return Certificate((self._document(STORAGE, law_document(self.law), table=table),))
