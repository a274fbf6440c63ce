"""The arm and the wall of a certificate, as rows of words: what was proved, and of what."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from zwidth.cli.table import plain

_UNITS = {
    "_N_m_s_per_rad": "N·m·s/rad", "_m_per_rad2": "m/rad²", "_m_per_rad": "m/rad",
    "_N_s_per_m": "N·s/m", "_N_per_m": "N/m", "_N_m": "N·m", "_N": "N",
    "_N_m_s_rad": "in N, m, s, rad", "_N_m_rad": "in N, m, rad", "_rad": "rad", "_m": "m",
}  # fmt: skip


def arm_rows(document: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Names and values; of a document that is malformed, what can be shown."""
    for key, value in _items(document.get("wall")):
        if not _is_zero(value):
            yield _named(key, value)
    for key, value in _items(document.get("arm")):
        if isinstance(value, list) and value and isinstance(value[0], Mapping):
            for number, entry in enumerate(value, start=1):
                yield (
                    f"{key.removesuffix('s')} {number}",
                    plain(", ".join(" ".join(_named(k, v)) for k, v in _items(entry)), 300),
                )
        else:
            yield _named(key, value)


def _items(table: object) -> list[tuple[str, Any]]:
    return [(str(k), v) for k, v in table.items()] if isinstance(table, Mapping) else []


def _named(key: str, value: object) -> tuple[str, str]:
    """The name in words, and the value with its unit."""
    suffix = next((s for s in _UNITS if key.endswith(s)), "")
    words = key.removesuffix(suffix).replace("_", " ")
    return plain(words), plain(f"{_text(value)} {_UNITS.get(suffix, '')}".rstrip(), 300)


def _text(value: object) -> str:
    return f"[{', '.join(_text(v) for v in value)}]" if isinstance(value, list) else str(value)


def _is_zero(value: object) -> bool:
    return all(_is_zero(v) for v in value) if isinstance(value, list) else value == "0"
