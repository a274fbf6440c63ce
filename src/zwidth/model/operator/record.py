"""Values given one per sample: checked once, kept read-only, compared by value."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth.errors import InputError
from zwidth.model.operator.operator import Operator

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from zwidth.model.operator.operator import Signal


def as_record(values: ArrayLike, what: str, unit: str) -> Signal:
    """One finite number per sample, as a read-only array of its own."""
    try:
        record = np.array(values, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise InputError(
            f"{what} [{unit}] is one number per sample, such as [0.0, 0.5, 1.0]; "
            f"got a {type(values).__name__} that is not"
        ) from None
    if record.ndim != 1:
        raise InputError(
            f"{what} [{unit}] is one number per sample, in one row; got {record.ndim} dimensions, "
            f"shape {record.shape}: give one column"
        )
    if record.size == 0:
        raise InputError(f"{what} [{unit}] is one number per sample; got none")
    if not np.isfinite(record).all():
        first = int(np.flatnonzero(~np.isfinite(record))[0])
        raise InputError(
            f"{what} [{unit}] must be finite, got {record[first]} at index {first}: no hand gives that; "
            "cut the record there or fill the gap"
        )
    record.setflags(write=False)
    return record


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class RecordedOperator(Operator):
    """An operator that holds arrays: equal when their values are."""

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return self._key() == other._key()

    def __hash__(self) -> int:
        return hash((type(self), self._key()))

    def __repr__(self) -> str:
        inside = ", ".join(f"{f.name}={_shown(getattr(self, f.name))}" for f in fields(self))
        return f"{type(self).__name__}({inside})"

    def _key(self) -> tuple[Any, ...]:
        # -0.0 + 0.0 is 0.0: equal values have equal bytes
        values = (getattr(self, f.name) for f in fields(self))
        return tuple((v + 0.0).tobytes() if isinstance(v, np.ndarray) else v for v in values)


def _shown(value: Any) -> str:
    return f"<{value.size} values>" if isinstance(value, np.ndarray) else repr(value)
