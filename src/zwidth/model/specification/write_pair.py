"""Two arms and what joins them as the TOML text that `load_pair` reads, digit for digit."""

from __future__ import annotations

from zwidth.errors import InputError
from zwidth.model.pairs import Pair
from zwidth.model.specification.pairs import KEYS, pair_of
from zwidth.model.specification.read import PAIR_TABLES, tables_of
from zwidth.model.specification.write import device_table, lines, quantity_text
from zwidth.quantity.exact import as_parameter
from zwidth.quantity.parameter import parameters_of


def written_pair(pair: Pair) -> str:
    """A pair as a specification in TOML."""
    tables = [
        ("[leader]", device_table(pair.leader)),
        ("[follower]", device_table(pair.follower)),
        ("[coupling]", _coupling(pair)),
    ]
    text = "\n".join(line for head, row in tables for line in (head, *lines(row), ""))
    if pair_of(tables_of(text, "specification", PAIR_TABLES)) != pair:
        raise InputError("a specification cannot say all of this pair")
    return text


def _coupling(pair: Pair) -> dict[str, object]:
    values: dict[str, object] = {}
    given = {"there": "link_delay", "back": "link_delay_back"}
    for name, own in parameters_of(Pair).items():
        value = getattr(pair, name)
        if value is not None and (value != 0 or name == "stiffness"):
            values[given.get(name, name)] = quantity_text(value, own.quantity.unit_for(pair.motion))
    for prefix, law in (("", pair.compensation), ("follower_", pair.follower_compensation)):
        for name in parameters_of(type(law)) if law is not None else ():
            unit = KEYS[f"compensation_{name}"].quantity.unit_for(pair.motion)
            values[f"{prefix}compensation_{name}"] = quantity_text(as_parameter(getattr(law, name)), unit)
    return values
