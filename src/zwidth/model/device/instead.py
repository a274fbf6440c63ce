"""What to type in the place of what is no device."""

from __future__ import annotations

from zwidth.errors import InputError
from zwidth.model.device import catalogue


def instead_of_device(thing: object) -> str:
    """What was given; and of a text how a device is made of it."""
    if not isinstance(thing, str):
        return f"got {type(thing).__name__}"
    try:
        name = catalogue.entry(thing).name
    except InputError:
        return f"got the text {thing!r}: zw.load({thing!r}).device reads a file, zw.catalogue.device a name"
    return f"got the name {thing!r}: zw.catalogue.device({name!r}) is that device"
