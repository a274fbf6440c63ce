"""Hands that are known, by name, for `zwidth map` and `zwidth check`; of each whether it is shaken."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from zwidth.errors import InputError
from zwidth.model.specification.table import quoted, suggestion

if TYPE_CHECKING:
    from zwidth.model.specification.read import Specification
    from zwidth.passivity.stability import Stability

NAMES = "none, finger, dowel; of a rotary device none, hands-on"
"""Of the hands, for a help."""

ABOUT = "of each hand alone, as long as it keeps contact; dry friction and encoder steps left out"


def named_hands(typed: str, motion: str) -> dict[str, Any]:
    """The hands of a list of names."""
    from zwidth.study.maps.request import standard_hands

    known, names = standard_hands(motion), [name.strip() for name in typed.split(",")]
    for name in names:
        if name not in known:
            raise InputError(f"there is no hand {quoted(name)}; {suggestion(name, list(known))}")
    return {name: known[name] for name in names}


def with_hands(loop: Specification, typed: str | None) -> dict[str, Stability]:
    """Of each hand whether it comes to rest against what is rendered; nothing where none is named."""
    if typed is None:
        return {}
    from zwidth.passivity.stability import coupled_stability

    hands = named_hands(typed, loop.device.motion)
    return {name: coupled_stability(loop.device, loop.environment, hand) for name, hand in hands.items()}


def hand_rows(found: Mapping[str, Stability]) -> Iterator[tuple[str, str]]:
    """What is said of each, and of what it is said."""
    for name, of_one in found.items():
        yield name, _said(of_one)
    yield "", ABOUT


def _said(found: Stability) -> str:
    from zwidth.quantity.text import told_quantity

    most = found.max_stiffness
    up_to = f"up to {told_quantity(most, 'stiffness', found.scope.motion, 4)}" if most else ""
    if found.outcome == "stable":
        return f"comes to rest{', ' if up_to else ''}{up_to}"
    rest = f"; comes to rest {up_to}" if up_to else ""
    if found.outcome == "undecided":
        return f"not decided{rest}"
    return (
        f"is shaken, at {found.frequency:.4g} Hz{rest}" if found.frequency else f"does not come to rest{rest}"
    )
