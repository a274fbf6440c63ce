"""A row as a message of a stream: as JSON, and as ROS 2 serializes it.

JSON keeps the names of the columns, units in them; what is no number is left out.  In a message of ROS 2
names have small letters alone: ``force_N`` is ``force_n`` there, and stands as it is in a comment.

Numbers of 8 bytes follow each other without a gap, after four bytes that say so, 00 01 00 00: little-endian
CDR (OMG, DDS Interoperability Wire Protocol 2.2, 10.2).
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from zwidth.native.compiled import Array

_ENCAPSULATION = (0, 1, 0, 0)


def json_schema(columns: Sequence[str]) -> bytes:
    """The JSON schema of a row."""
    schema: dict[str, Any] = {
        "title": "zwidth row",
        "type": "object",
        "properties": {name: {"type": "number"} for name in columns},
    }
    return json.dumps(schema).encode()


def json_messages(columns: Sequence[str], rows: Array) -> Iterator[bytes]:
    """Each row as JSON."""
    for row in rows.tolist():
        known = {name: value for name, value in zip(columns, row, strict=True) if math.isfinite(value)}
        yield json.dumps(known).encode()


def ros2_schema(columns: Sequence[str]) -> bytes:
    """The definition of a row as a message of ROS 2."""
    return "".join(f"float64 {_ros2_name(name)}  # {name}\n" for name in columns).encode()


def ros2_messages(rows: Array) -> Iterator[bytes]:
    """Each row as ROS 2 serializes it."""
    count, width = rows.shape
    octets = np.empty((count, len(_ENCAPSULATION) + 8 * width), np.uint8)
    octets[:, : len(_ENCAPSULATION)] = _ENCAPSULATION
    octets[:, len(_ENCAPSULATION) :] = np.ascontiguousarray(rows, "<f8").view(np.uint8).reshape(count, -1)
    return (row.tobytes() for row in octets)


def _ros2_name(name: str) -> str:
    """Small letters, digits, and single underscores between them."""
    return re.sub("[^a-z0-9]+", "_", name.lower()).strip("_")
