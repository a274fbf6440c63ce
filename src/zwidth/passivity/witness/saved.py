"""The motion of a saved witness, read back."""

from __future__ import annotations

from collections.abc import Mapping
from decimal import Decimal
from fractions import Fraction
from typing import Any

from zwidth.errors import InputError
from zwidth.passivity.witness.motion import Motion, Repeat

KINDS = ("motion", "contact motion", "row motion")


def saved_motion(document: object, name: str) -> Motion:
    """The motion in a witness, an active verdict or a limit, as `zwidth check` and `zwidth limit` save them.

    Parameters
    ----------
    document
        As `read_document` gives it.
    name
        Of the file, for messages.
    """
    found: Any = document
    if isinstance(found, Mapping) and isinstance(found.get("witness"), Mapping):
        found = found["witness"]
    if not isinstance(found, Mapping) or found.get("kind") not in KINDS:
        raise InputError(
            f"{name} holds no motion that takes energy out: save one with zwidth check … -o FILE, of a loop "
            "that is active, or with zwidth limit"
        )
    try:
        positions = _column(found, "positions_m", "positions_rad")
        switches = _column(found, "switch_positions_m", "switch_positions_rad")
        parts = found.get("repeats", ())
        parts = [parts] if isinstance(parts, Mapping) else parts  # one part, or a list of them
        repeats = tuple(Repeat(int(r["first"]), int(r["last"]), int(r["times"])) for r in parts)
    except (TypeError, ValueError, KeyError, ZeroDivisionError) as error:
        raise InputError(f"{name} holds a motion that cannot be read: {error}") from None
    if len(positions) < 2:
        raise InputError(f"{name} holds a motion of fewer than two positions")
    return Motion(positions, switches, repeats)


def _column(document: Mapping[str, Any], *names: str) -> tuple[Fraction, ...]:
    values = next((document[name] for name in names if name in document), ())
    return tuple(_fraction(value) for value in values)


def _fraction(value: object) -> Fraction:
    if not isinstance(value, (int, str, Decimal)):
        raise ValueError(f"{value!r} is no number")
    return Fraction(value)
