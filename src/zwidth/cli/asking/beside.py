"""The device that is to render an environment: its motion, its largest force, what it lacks."""

from __future__ import annotations

from zwidth.cli.asking.device_questions import NEEDED
from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.specification.read import load_device, read_tables
from zwidth.model.specification.table import Table

_ANY = {"rate": "1 kHz", "damping": "0"}
"""In the place of what the file lacks: motion and largest force do not depend on it."""


def beside(name: str) -> Device | None:
    """As `device_of`; None where there is none to read."""
    try:
        return device_of(name)
    except InputError:
        return None


def device_of(name: str) -> Device:
    """The device of a file or of the catalogue, whose rate and damping may be made up."""
    return load_device([name], {key: _ANY[key] for key in lacking(name) or ()})


def lacking(name: str) -> list[str] | None:
    """What the file of a device has to say for a proof and does not; None where there is no such file."""
    table = _table(name)
    if table is None:
        return None
    given = {"rate" if key == "sample_period" else key for key in table.values}
    return [] if "catalogue" in given else [key for key in NEEDED if key not in given]


def told_as(name: str) -> str:
    """The motion in which the file of a device has its numbers: of a handle on a lever those of its shaft."""
    table = _table(name)
    return "linear" if table is None else str(table.values.get("motion", "linear"))


def _table(name: str) -> Table | None:
    try:
        return read_tables([name], ("device",)).get("device")
    except InputError:
        return None
