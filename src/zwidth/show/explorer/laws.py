"""The environment alone, and behind one law after the other: what is proved, and what one hand met."""

from __future__ import annotations

from collections.abc import Sequence

from zwidth.passivity.scope import COLOUR
from zwidth.quantity.glossary import GLOSSARY
from zwidth.show.explorer.computing import Row
from zwidth.show.plots.style import number, scale
from zwidth.showing import Html, element, join, row

NAME = "Laws"

NONE = "Switch laws on under “Laws in the chain”; each acts on what the one before it gives."


def compared_table(rows: Sequence[Row], motion: str) -> Html:
    """A row for each chain."""
    unit = GLOSSARY["force"].unit_for(motion)
    heads = ("chain", "outcome", "energy the hand got out", "largest force", "claim")
    body = (
        row(
            (
                one.name,
                _outcome(one),
                _amount(one.extracted, "J"),
                _amount(one.peak_force, unit),
                one.message or one.claim,
            )
        )
        for one in rows
    )
    table = element("table", element("thead", row(heads, "th")), element("tbody", *body))
    return element(
        "div", table, **{"class": "numbers", "tabindex": "0", "role": "region", "aria-label": "laws compared"}
    )


def _outcome(one: Row) -> Html:
    if not one.outcome:
        return join("no verdict")
    return element(
        "b", one.outcome, style=f"border-left:0.5rem solid {COLOUR[one.outcome]};padding-left:0.4rem"
    )


def _amount(value: float | None, unit: str) -> str:
    if value is None:
        return ""
    factor, shown = scale([value], unit)
    return f"{number(max(value, 0.0) * factor)} {shown}"
