"""An answer as one row: a pandas Series or an xarray Dataset of numbers without dimensions.

Names are the keys of its plain data, those of a table inside after a point: `margins.damping_N_s_per_m`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from math import nan
from typing import Any

from zwidth.quantity.glossary import GLOSSARY, unit_suffix

_LEFT_OUT = ("format", "assumptions", "advice")
"""Not of one number or word: in the attributes, or in `to_dict`."""


def flat(stated: Mapping[str, Any]) -> dict[str, Any]:
    """What is stated, without tables inside tables; lists of words on a line, None as it is."""
    return dict(_rows({key: value for key, value in stated.items() if key not in _LEFT_OUT}))


def _rows(table: Mapping[str, Any], before: str = "") -> Iterator[tuple[str, Any]]:
    for key, value in table.items():
        if isinstance(value, Mapping):
            yield from _rows(value, f"{before}{key}.")
        elif not isinstance(value, (list, tuple)):
            yield f"{before}{key}", value
        elif not any(isinstance(item, (Mapping, list, tuple)) for item in value):
            yield f"{before}{key}", ", ".join(map(str, value))


def to_series(stated: Mapping[str, Any]) -> Any:
    """One row of a pandas DataFrame."""
    import pandas as pd

    return pd.Series(flat(stated), dtype=object)


def to_dataset(stated: Mapping[str, Any]) -> Any:
    """Variables without dimensions, units in their attributes; what is not known is nan."""
    import xarray as xr

    variables = {key: _variable(key, value) for key, value in flat(stated).items()}
    kept = {"format": stated["format"], "assumptions": "\n".join(stated["assumptions"])}
    return xr.Dataset(variables, attrs=kept)


def _variable(key: str, value: Any) -> tuple[tuple[()], Any, dict[str, str]]:
    if isinstance(value, (str, bool)):
        return (), value, {}
    return (), nan if value is None else float(value), _attributes(key)


def _attributes(key: str) -> dict[str, str]:
    ends = [end for end in _units() if key.endswith(f"_{end}")]
    return {"units": _units()[max(ends, key=len)]} if ends else {}


@cache
def _units() -> Mapping[str, str]:
    """The units of the glossary by what keys end in."""
    units = {unit for q in GLOSSARY.values() for unit in (q.unit, q.rotary_unit) if unit != "1"}
    return {unit_suffix(unit): unit for unit in units}
