"""Where each number of a pair comes from: the tables of its file, the catalogue, or not given at all."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from zwidth.model.pairs import Pair
from zwidth.model.specification.load import KEYS
from zwidth.model.specification.table import Table
from zwidth.quantity.text import in_words
from zwidth.show.report.provenance import Row, as_written, of_device, of_file


def of_pair(tables: Mapping[str, Table], pair: Pair) -> Iterator[Row]:
    """Of two arms made of the tables of one file, as they were read; of one [device] both are made."""
    arms = [("leader", pair.leader), ("follower", pair.follower)]
    for name, device in arms if "leader" in tables else [("device", pair.leader)]:
        for what, value, where in of_device(tables[name], device):
            yield f"{name}: {what}", value, where
    coupling = tables["coupling"]
    for key, given in coupling.values.items():
        unit = KEYS[key].unit_for(pair.motion) if KEYS[key].is_number else ""
        yield f"coupling: {in_words(key)}", as_written(given, unit), of_file(coupling.label)
