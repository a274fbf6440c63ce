"""What was odd in a recording of a tissue, in sentences; and what is of no tissue, refused."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import sqrt

import numpy as np

from zwidth.data.logs import Finding
from zwidth.data.logs.steps import grid_of
from zwidth.data.logs.stops import at_ends
from zwidth.data.tissue.faults import Faults
from zwidth.data.tissue.model import Record
from zwidth.errors import InputError
from zwidth.native.compiled import Array
from zwidth.quantity.text import quantity_unit

SOFTEST, STIFFEST = 5.0, 5e4
"""Between them lies what a probe feels of soft tissue, phantoms included [N/m]."""

DEEPEST, SHALLOWEST = 0.5, 2e-5
"""Between them lies how deep a probe goes [m]."""

SHARE = 0.5
"""Of what is left, which the steps of the position may make before it is said."""

POOR, GOOD = 0.5, 0.8
"""Of the variance, explained below which a sign is doubted, and above which the other one is believed."""


def unlikely_units(stiffness: float, depth: float) -> Iterator[str]:
    """Why a stiffness at once, or a depth, is hardly that of a tissue."""
    if not SOFTEST <= stiffness <= STIFFEST:
        yield (
            f"a stiffness at once of {stiffness:.3g} N/m is hardly that of soft tissue under a probe, "
            f"{SOFTEST:g} to {STIFFEST:g} N/m: most likely a unit is off by 1000, mm for m or mN for N"
        )
    if depth > DEEPEST or 0 < depth < SHALLOWEST:
        yield (
            f"positions up to {depth:.3g} are hardly metres inside a tissue: most likely their unit is "
            "another"
        )


def coarse(position: Array, stiffness: float, rms: float) -> Iterator[str]:
    """Why intervals are too narrow: most of what the fit leaves [N; N·m] may be the position's steps."""
    grid = grid_of(position)
    if grid is not None and stiffness * grid.step / sqrt(12.0) > SHARE * rms > 0:
        yield (
            f"the position is read in steps of {grid.step:.3g}, and most of what the fit leaves may come "
            "from them: the intervals take the position for exact and are too narrow; move further, or read "
            "it more finely"
        )


def refuse_sign(record: Record, left: Array, size: float, again: Callable[[Record], Array]) -> None:
    """Refuse a record that is of a tissue only with the other sign, by what a fit of each leaves."""
    spread = float(np.var(record.output)) / size**2
    if spread == 0 or float(np.mean(left**2)) < (1 - POOR) * spread:
        return
    if float(np.mean(again(record._replace(force=-record.force)) ** 2)) < (1 - GOOD) * spread:
        raise InputError(
            "no tissue pulls the probe in: with the sign of the force turned round, or that of the position, "
            "the record is of one; give positions that are positive inside the tissue and forces that are "
            "positive out of it"
        )


def findings(
    record: Record,
    faults: Faults,
    zero: Array,
    late: float,
    stops: tuple[float, float],
    left_out: int,
    motion: str,
) -> Iterator[Finding]:
    """What was found, and what was done about it.

    `zero` is that at the start, then further on [N; N·m]; the force is `late` [s]; `left_out` samples at the
    ends of the sensor's range do not count.
    """
    unit = quantity_unit(record.response, motion)
    ends = at_ends(stops, unit)
    if ends:
        text = (
            f"the force stays at {ends}: the sensor is at an end of its range; {left_out} samples do "
            "not count"
        )
        yield Finding(kind="saturated", text=text, samples=left_out)
    if record.begins:
        places = ", ".join(f"{record.time[b]:.4g} s" for b in record.begins[:3])
        text = (
            f"{len(record.begins)} holes, before t = {places}{' …' if len(record.begins) > 3 else ''}: what "
            "the branches held after each was fitted"
        )
        yield Finding(kind="hole", text=text)
    if faults.drift:
        text = (
            f"the zero drifts: from {zero[0]:.3g} {unit} at the start by {zero[-1]:.3g} {unit}; "
            "fitted besides"
        )
        yield Finding(kind="drift", text=text)
    elif faults.offset:
        text = f"the zero is off by {zero[0]:.3g} {unit}; fitted besides"
        yield Finding(kind="offset", text=text)
    if faults.late:
        yield _lateness(faults.late, late)


def _lateness(kind: str, late: float) -> Finding:
    if late < 0:
        text = (
            f"the force looks {-1e3 * late:.3g} ms early: the position is recorded late, or the model has "
            "too few elements; fitted as a delay"
        )
        return Finding(kind="force early", text=text)
    how = "a delay" if kind == "delay" else "a filter of the first order with this time constant"
    text = (
        f"the force is recorded {1e3 * late:.3g} ms late, or the model has too few elements; fitted as {how}"
    )
    return Finding(kind="force late", text=text)
