"""The force of a simulated hand whose damper follows an anchor: between its two sides where it jumps.

    f_h = k (x_a − x) + c (ẋ_a − ẋ),      x_a straight from sample to sample

At every sample the anchor changes its speed, and the force jumps by c Δẋ_a m/(m + m_h); a trace has what
comes just after.  Whoever sums such samples for the impulse of the force counts the change half a sample
early, which looks like a mass of c T/2 more: 1.5 g for 3 N·s/m at 1 kHz.  The mean of both sides has no such
mass, and is what a load cell gives, which does not follow a jump.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth.data.logs.block import Finding
from zwidth.data.logs.table import Table

if TYPE_CHECKING:
    from numpy.typing import NDArray


ROUNDING = 1e-9
"""Of the largest force, below which a jump is none."""


def hand_damper(table: Table) -> float:
    """How much a simulated hand's force jumps for a change of its anchor's speed [N·s/m; N·m·s/rad]."""
    if anchor_column(table) is None:
        return 0.0
    own, hand = (_stated(table, (f"{whose}mass_", f"{whose}inertia_")) for whose in ("", "hand_"))
    share = own / (own + hand) if own + hand > 0 else 1.0
    return share * _stated(table, ("hand_damping_",))


def anchor_column(table: Table) -> str | None:
    """The column of the anchor, with its unit in the name where the format keeps it there."""
    return next((name for name in table.units if name.startswith("anchor_position")), None)


def _stated(table: Table, starts: tuple[str, ...]) -> float:
    """What the head of a trace says of a number whose name begins so; 0 where it says nothing."""
    return next((float(v) for key, v in table.attributes.items() if key.startswith(starts)), 0.0)


def between_jumps(table: Table, columns: Mapping[str, NDArray[Any]], damper: float) -> NDArray[Any]:
    """The mean of the hand's force before and after each sample; at both ends of a piece as it was."""
    force = columns["hand_force"].astype(float)
    if "time" not in columns or force.size < 3:
        return force
    speed = np.diff(columns["anchor"]) / np.diff(columns["time"])
    jumps = damper * np.diff(speed)
    if np.abs(jumps).max() <= ROUNDING * np.abs(force).max():
        return force
    force[1:-1] -= jumps / 2
    table.notes["jumps"] = Finding(
        kind="jumps",
        text="the force of this simulated hand jumps at the samples, as the speed of its anchor does: "
        "the mean of before and after is taken, as a load cell would",
    )
    return force
