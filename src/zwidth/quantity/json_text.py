"""Plain data as JSON text: a number is written as exactly as it is known, a file whole or not at all."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from decimal import Context, Decimal
from fractions import Fraction
from pathlib import Path

from zwidth.quantity.text import as_decimal
from zwidth.writing import writing_whole


def save_json(path: str | Path, document: object) -> None:
    """Write a document whole, or not at all."""
    with writing_whole(Path(path)) as file:
        file.write(json_file(document))


def json_file(document: object) -> bytes:
    """A document as `save_json` writes it."""
    return f"{to_json(document)}\n".encode()


def to_json(document: object, indent: int | None = 2) -> str:
    """JSON text in which a Fraction is written digit for digit.

    A rational that is no finite decimal becomes the text "p/q".
    """
    return _text(document, indent, 0)


def _text(value: object, indent: int | None, level: int) -> str:
    if isinstance(value, Fraction):
        decimal = as_decimal(value)
        return json.dumps(f"{value.numerator}/{value.denominator}") if decimal is None else _plain(decimal)
    if isinstance(value, Mapping):
        items = [f"{json.dumps(str(k))}: {_text(v, indent, level + 1)}" for k, v in value.items()]
        return _bracket("{", items, "}", indent, level)
    if isinstance(value, Sequence) and not isinstance(value, str):
        scalar = not any(isinstance(v, (Mapping, list, tuple)) for v in value)
        items = [_text(v, indent, level + 1) for v in value]
        return f"[{', '.join(items)}]" if scalar else _bracket("[", items, "]", indent, level)
    if isinstance(value, float):
        return json.dumps(value if abs(value) < float("inf") else None)
    return json.dumps(value, ensure_ascii=False)


def _bracket(opening: str, items: list[str], closing: str, indent: int | None, level: int) -> str:
    if indent is None or not items:
        return opening + ", ".join(items) + closing
    pad = "\n" + " " * indent * (level + 1)
    return opening + pad + ("," + pad).join(items) + "\n" + " " * indent * level + closing


def _plain(decimal: Decimal) -> str:
    """Decimal text that JSON accepts, without exponent padding surprises."""
    if decimal == 0:
        return "0"
    exact = Context(prec=len(decimal.as_tuple().digits))  # the usual one would round to 28 digits
    text = str(decimal.normalize(exact) if decimal.adjusted() < 25 else decimal)
    return text.replace("E+", "e").replace("E", "e")
