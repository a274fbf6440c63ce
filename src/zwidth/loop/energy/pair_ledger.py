"""The energy ledger of a simulated pair: one balance for each arm, and what both hands got out together.

A pair is passive if W_l(t) + w W_f(t) + E(0) ≥ 0 for any two hands and every t, with w = K_l/K_f and E(0)
what the spring between the arms and their motion hold at first.  So two hands that at some instant have

    −W_l(t) − w W_f(t) > E(0)

have got out more than there was: the pair was active under them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth.loop.energy.ledger import ROUNDING, Ledger
from zwidth.showing import Part, Shown, Table

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from zwidth.loop.trace import AnyTrace

    Array = NDArray[np.float64]

ARMS = ("leader", "follower")

_FROM_THE_OTHER = "the hand on the other arm may have put in what comes out here"


@dataclass(frozen=True, eq=False, repr=False)
class PairLedger(Shown):
    """What crossed both ports, what was stored and what was lost, from sample 0 on.

    Parameters
    ----------
    trace
        A trace of a pair as `zwidth.simulate` returns it.
    """

    trace: AnyTrace

    @cached_property
    def arms(self) -> tuple[Ledger, Ledger]:
        """Of leader and follower, each for itself."""
        leader, follower = (Ledger(of_one_arm(self.trace.sel(arm=name))) for name in ARMS)
        return leader, follower

    @property
    def power_ratio(self) -> float:
        """w: how often the follower's energy counts."""
        return float(self.trace.attrs["power_ratio"])

    @cached_property
    def hand_work(self) -> Array:
        """W_l + w W_f at every instant [J]."""
        leader, follower = (part.trace["hand_work"].values for part in self.arms)
        return np.asarray(leader - leader[0] + self.power_ratio * (follower - follower[0]))

    @cached_property
    def coupling(self) -> Array:
        """What both actuators took from the arms, −W_a,l − w W_a,f, at every instant [J].

        Of springs alone without link or hold that is what the spring between the arms holds.
        """
        leader, follower = (part.trace["actuator_work"].values for part in self.arms)
        return np.asarray(leader[0] - leader + self.power_ratio * (follower[0] - follower))

    @property
    def closes(self) -> bool:
        """True when the balances of both arms close to 1e-12 of the energy moved."""
        return all(part.closes for part in self.arms)

    @property
    def moved(self) -> float:
        """The energy moved in both arms [J]."""
        return self.arms[0].moved + self.power_ratio * self.arms[1].moved

    @cached_property
    def got_out(self) -> float:
        """max(−W_l − w W_f) at an instant of the trace [J], gained or stored at first."""
        return float(-self.hand_work.min()) + 0.0  # no negative zero

    @cached_property
    def held_at_start(self) -> float:
        """E(0), the most that the spring between the arms and their motion held at the start [J]."""
        motion = self.trace["kinetic_energy"].values[:, 0]
        stored = float(self.trace.attrs["stored_at_start_J"])
        return stored + float(motion[0] + self.power_ratio * motion[1])

    @property
    def extracted(self) -> float:
        """max(−W_l − w W_f) − E(0) at an instant of the trace [J]."""
        return self.got_out - self.held_at_start + 0.0

    @property
    def active(self) -> bool:
        """True where more came out than the pair held at the start: no passive pair does that."""
        return self.extracted > ROUNDING * (self.moved + self.held_at_start)

    def to_dict(self) -> dict[str, Any]:
        """Totals and residuals, units in the keys."""
        arms = {name: part.to_dict() for name, part in zip(ARMS, self.arms, strict=True)}
        unknown = {"held_at_start_J", "energy_extracted_J"}
        return {
            **{name: {k: v for k, v in own.items() if k not in unknown} for name, own in arms.items()},
            "power_ratio": self.power_ratio,
            "hand_work_J": float(self.hand_work[-1]),
            "coupling_took_J": float(self.coupling[-1]),
            "energy_got_out_J": self.got_out,
            "held_at_start_J": self.held_at_start,
            "energy_extracted_J": self.extracted,
            "energy_moved_J": self.moved,
        }

    def rows(self) -> Iterator[tuple[str, float]]:
        """What people read: each total in words [J]."""
        for name, part in zip(ARMS, self.arms, strict=True):
            totals = part.totals
            yield f"put into the {name}", totals["hand_work"]
            lost = totals["viscous_loss"] + totals["coulomb_loss"]
            yield f"lost in the {name}'s friction", lost
            yield f"kinetic energy gained by the {name}", totals["kinetic_energy"]
        if self.power_ratio != 1:
            yield "of which the follower's count, times", self.power_ratio
        yield "the coupling took", float(self.coupling[-1])
        worst = max(float(np.abs(part.residual).max()) for part in self.arms)
        yield "energy balance error, at most", worst
        yield "both hands got out at most", self.got_out
        if self.held_at_start:
            yield "the pair held at the start, at most", self.held_at_start

    def report(self) -> Iterable[Part]:
        """The rows, below the time that they are of."""
        time = self.trace["time"].values
        rows = [(text, f"{value:.6e}") for text, value in self.rows()]
        yield Table(heads=[(f"energy over {float(time[-1] - time[0]):g} s", "J")], rows=rows, lefts=1)


def of_one_arm(one: AnyTrace) -> AnyTrace:
    """One arm out of a pair's trace, as of a loop of which it is not known what it held at the start."""
    kept = {key: value for key, value in one.attrs.items() if key != "stored_at_start_J"}
    one.attrs = {**kept, "stored_at_start_unknown": _FROM_THE_OTHER}
    return one
