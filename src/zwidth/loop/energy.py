"""The joules of a trace, what crosses the port, is stored, is lost: two balances that must close.

    device   ΔE_k + ΔE_t = W_h + W_a − E_b − E_c − E_ct
    hand     W_s = W_h + ΔE_s + E_d + ΔE_m

ΔE_t and E_ct are of the spring and the damper of a transmission, 0 of a device without one.
W_h is what the hand puts into the device through the port.  A loop is passive
if W_h(t) + E(0) ≥ 0 for every hand and every t (Colgate & Schenkel 1997), with

    E(0) = ½ m v² + E_s

what the loop holds at first: the device in its motion, the law in what a hand put in to bring it there
(`stored_at_start_J` of the trace, a bound that every passive loop keeps).  So a hand that at some instant has

    −W_h(t) > E(0)

has got out more than there was: the loop was active under it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from math import isnan, nan
from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth.errors import InputError
from zwidth.quantity.text import shown
from zwidth.showing import Part, Shown, Table

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from zwidth.loop.trace import AnyTrace

    Array = NDArray[np.float64]


ROUNDING = 1e-12
"""Of the energy moved: what is less is no energy."""

_INSIDE = ("transmission_energy", "transmission_loss")
"""Only of a device with a transmission."""

_ROWS = {
    "hand_work": "the hand put into the device",
    "actuator_work": "the actuator put into the device",
    "viscous_loss": "lost in viscous friction",
    "coulomb_loss": "lost in Coulomb friction",
    "kinetic_energy": "kinetic energy gained",
    "transmission_energy": "spring of the transmission gained",
    "transmission_loss": "lost in the transmission's damper",
    "hand_source_work": "the muscles put into the hand",
    "hand_spring_energy": "spring of the hand gained",
    "hand_damper_loss": "lost in the hand's damper",
    "hand_kinetic_energy": "kinetic energy of the hand's mass gained",
}


@dataclass(frozen=True, eq=False, repr=False)
class Ledger(Shown):
    """What crossed the port, what was stored and what was lost, from sample 0 on.

    Parameters
    ----------
    trace
        A trace as `zwidth.simulate` returns it.
    """

    trace: AnyTrace

    def _change(self, name: str) -> Array:
        values = self.trace[name].values
        return np.asarray(values - values[0], dtype=np.float64)

    @property
    def _names(self) -> list[str]:
        return [name for name in _ROWS if name not in _INSIDE or name in self.trace]

    @cached_property
    def residual(self) -> Array:
        """W_h + W_a − E_b − E_c − E_ct − ΔE_k − ΔE_t at every instant [J]: 0 but for rounding."""
        c = self._change
        given = c("hand_work") + c("actuator_work")
        given = given - c("viscous_loss") - c("coulomb_loss") - c("kinetic_energy")
        for name in _INSIDE:
            if name in self.trace:
                given = given - c(name)
        return given

    @cached_property
    def hand_residual(self) -> Array:
        """W_s − W_h − ΔE_s − E_d − ΔE_m at every instant [J]: 0 but for rounding."""
        c = self._change
        kept = c("hand_spring_energy") + c("hand_damper_loss") + c("hand_kinetic_energy")
        return c("hand_source_work") - c("hand_work") - kept

    @cached_property
    def moved(self) -> float:
        """The energy moved: every variable's largest change, summed [J]; the measure of a residual."""
        return float(sum(np.abs(self._change(name)).max() for name in self._names))

    @property
    def closes(self) -> bool:
        """True when both balances close to 1e-12 of the energy moved."""
        worst = max(np.abs(self.residual).max(), np.abs(self.hand_residual).max())
        return bool(worst <= ROUNDING * self.moved)

    @cached_property
    def got_out(self) -> float:
        """max(−W_h) at an instant of the trace [J], gained or stored at first."""
        return float(-self._change("hand_work").min()) + 0.0  # no negative zero

    @property
    def unknown(self) -> str:
        """Why it is not known how much the law held at the start; "" where it is."""
        if "stored_at_start_J" in self.trace.attrs:
            return ""
        return str(self.trace.attrs.get("stored_at_start_unknown", "this trace does not say"))

    @cached_property
    def held_at_start(self) -> float:
        """E(0), the most that the loop held at the start [J]; nan where no bound is known."""
        stored = float(self.trace.attrs.get("stored_at_start_J", nan))
        return stored + float(self.trace["kinetic_energy"].values[0])

    @cached_property
    def extracted(self) -> float:
        """max(−W_h) − E(0) at an instant of the trace [J]; nan where no bound E(0) is known."""
        return self.got_out - self.held_at_start + 0.0

    @property
    def active(self) -> bool:
        """True where more came out than the loop held at the start: no passive loop does that."""
        return self.extracted > ROUNDING * (self.moved + self.held_at_start)

    @property
    def totals(self) -> dict[str, float]:
        """The change of each energy from the first instant to the last [J]."""
        return {name: float(self._change(name)[-1]) for name in self._names}

    def to_dict(self) -> dict[str, Any]:
        """Totals and residuals, units in the keys."""
        result: dict[str, Any] = {f"{name}_J": value for name, value in self.totals.items()}
        result["energy_got_out_J"] = self.got_out
        result["held_at_start_J"] = None if self.unknown else self.held_at_start
        result["energy_extracted_J"] = None if self.unknown else self.extracted
        result["largest_residual_J"] = float(np.abs(self.residual).max())
        result["largest_hand_residual_J"] = float(np.abs(self.hand_residual).max())
        result["energy_moved_J"] = self.moved
        return result

    def rows(self) -> list[tuple[str, float]]:
        """What people read: each total in words [J]; the hand's own only where it has any."""
        totals = self.totals
        own = any(totals[name] for name in ("hand_spring_energy", "hand_damper_loss", "hand_kinetic_energy"))
        told = [name for name in totals if own or not name.startswith("hand_") or name == "hand_work"]
        rows = [(_ROWS[name], totals[name]) for name in told]
        worst = float(max(np.abs(self.residual).max(), np.abs(self.hand_residual).max()))
        rows += [("energy balance error, at most", worst), ("the hand got out at most", self.got_out)]
        if isnan(self.held_at_start) or not self.held_at_start:
            return rows
        return [*rows, ("the loop held at the start, at most", self.held_at_start)]

    def report(self) -> Iterable[Part]:
        """The rows, below the time that they are of."""
        seconds = float(self.trace["time"].values[-1] - self.trace["time"].values[0])
        rows = [(text, f"{value:.6e}") for text, value in self.rows()]
        yield Table(heads=[(f"energy over {shown(seconds, 's', 6)}", "J")], rows=rows, lefts=1)


def ledger(trace: AnyTrace) -> Ledger:
    """The ledger of a trace."""
    missing = [name for name in _ROWS if name not in _INSIDE and name not in trace]
    if missing:
        raise InputError(f"this Dataset is no trace: it lacks {', '.join(missing)}")
    return Ledger(trace)


# The ledger of a pair.  It is passive if W_l(t) + w W_f(t) + E(0) ≥ 0 for any two hands and every t, with
# w = K_l/K_f and E(0) what the spring between the arms and their motion hold at first.  So two hands that at
# some instant have
#
#     −W_l(t) − w W_f(t) > E(0)
#
# have got out more than there was: the pair was active under them.


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
        yield Table(heads=[(f"energy over {shown(time[-1] - time[0], 's', 6)}", "J")], rows=rows, lefts=1)


def of_one_arm(one: AnyTrace) -> AnyTrace:
    """One arm out of a pair's trace, as of a loop of which it is not known what it held at the start."""
    kept = {key: value for key, value in one.attrs.items() if key != "stored_at_start_J"}
    one.attrs = {**kept, "stored_at_start_unknown": _FROM_THE_OTHER}
    return one
