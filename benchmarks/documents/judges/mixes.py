"""Corners of which every mix is proved too: one device, one denominator, and random mixes passive."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np

from ..opinion import Opinion, agrees, false, first
from ..plain import law_of, plain_loop
from . import loops

Document = dict[str, Any]
Rng = np.random.Generator

CLAIM = "every mix of their laws"
MIXES = 3
KINDS = ("spring", "linear", "quantized", "contact")
"""Kinds of which only the loop is judged, so that a mix can be."""


def between(corners: list[Document], rng: Rng, reason: str) -> Opinion:
    """What lies between the corners, where the checker says anything of it."""
    if CLAIM not in reason:
        return agrees()
    kinds = {corner["kind"] for corner in corners}
    if len(kinds) > 1 or not kinds <= {*KINDS}:
        return false(f"mixes of {', '.join(sorted(kinds))}")
    devices = [
        (replace(plain_loop(c["loop"]), numerator=()), c["loop"]["unilateral"], _weights(c)) for c in corners
    ]
    if any(device != devices[0] for device in devices):
        return false("mixes of laws of several devices, denominators or weights")
    return first(*(_mix(corners, rng) for _ in range(MIXES)))


def _weights(corner: Document) -> Any:
    """As numbers, whatever way they are written."""
    told = corner["law"]["weights"] if corner["kind"] == "contact" else []
    return Fraction(told["pole"]) if isinstance(told, dict) else [Fraction(w) for w in told]


def _mix(corners: list[Document], rng: Rng) -> Opinion:
    """One law between them, any or on an edge."""
    shares = [int(s) for s in rng.integers(0, 1000, len(corners))]
    if len(corners) > 2 and rng.random() < 0.5:
        shares[int(rng.integers(len(corners)))] = 0
    whole = sum(shares) or len(corners)
    parts = [Fraction(s, whole) if sum(shares) else Fraction(1, whole) for s in shares]
    laws = [law_of(corner["loop"]) for corner in corners]
    mixed = [
        sum(p * c for p, c in zip(parts, column, strict=True))
        for column in zip(*(n for n, _ in laws), strict=True)
    ]
    loop = {**corners[0]["loop"], "numerator": mixed, "denominator": laws[0][1]}
    kind = corners[0]["kind"]
    found = loops.JUDGES[kind]({**corners[0], "loop": loop}, rng)
    return found._replace(why=f"a mix, {[str(p) for p in parts]}: {found.why}")
