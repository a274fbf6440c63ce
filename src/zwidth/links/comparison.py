"""Ports beside each other over one link: what is proved, how the devices follow, what is felt."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import ceil
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from zwidth.errors import InputError
from zwidth.links.attack import most_taken
from zwidth.links.port import Port
from zwidth.links.schedule import Schedule
from zwidth.links.simulation import check_ends, simulated
from zwidth.links.springs import PositionHold, TimeDomain, TwoLayer
from zwidth.links.verdict import check
from zwidth.links.wave_port import WavePort
from zwidth.links.waves import HeldWaves, NaiveWaves, felt_stiffness
from zwidth.loop.traces.measures import static_stiffness
from zwidth.model.device import Device
from zwidth.model.operator import PrescribedMotion, RecordedForce
from zwidth.quantity.answered import finite
from zwidth.quantity.documented import Documented
from zwidth.quantity.exact import Exact, RealLike, ends
from zwidth.quantity.glossary import GLOSSARY, unit_suffix
from zwidth.quantity.parameter import parameters_of, read_number
from zwidth.quantity.spoken import spoken
from zwidth.quantity.text import shown, unit_text
from zwidth.showing import Part, Table

if TYPE_CHECKING:
    import xarray as xr

    from zwidth.loop.trace import Trace

_FAR = {"linear": 0.02, "rotary": 0.2}
"""How far the leader is led [m; rad]."""
_STROKE, _REST, _PRESS, _RISE = 2.0, 1.0, 4.0, 1.0
"""How long: to and fro, at rest after it; a push, its force rising for a part of it [s]."""
_STILL = 0.1
"""How far a hand may swing that is said to be at rest, of its depth."""
_WEAKEST_FIRST = ("undecided", "theorem", "passive")
"""What two ports are together."""

Ends = tuple[Port, Port]


@dataclass(frozen=True, repr=False)
class LinkComparison(Documented):
    """What became of each kind of port over one link.

    Attributes
    ----------
    rows
        By port what `scores` labels.
    motion
        "linear" or "rotary".
    schedule
        The link.
    touches
        What `traces` makes Datasets of.
    held_back
        For how long the loops of leader and follower are to keep each force back [s]; () where they need not.
    """

    _FORMAT: ClassVar[str] = "zwidth links 1"
    _PICTURE: ClassVar[str] = "plot_links"
    _BESIDES = (
        ("link", "in words"),
        (
            "held_back_s",
            "with `--hold-back`: for how long the loops of leader and follower keep each force back; "
            "missing where they need not",
        ),
        ("ports", "by name, each with what follows"),
        (
            "outcome",
            '`"passive"` over any link, `"theorem"`, the same on paper alone, `"active"` or `"undecided"`',
        ),
        ("taken_J", "what the worst of the hands that were tried take out over this link"),
        (
            "tracking_error_m, apart_m",
            "how far the arms are apart: root mean square of a stroke, and a second after it",
        ),
        (
            "felt_stiffness_N_per_m",
            "of the leader when the follower is clamped; null where it does not come to rest",
        ),
    )

    rows: Mapping[str, Mapping[str, Any]]
    motion: str
    schedule: Schedule
    touches: Mapping[str, Mapping[str, Trace]]
    held_back: tuple[Fraction, ...] = ()

    @cached_property
    def scores(self) -> xr.Dataset:
        """Along `port`: what is known of each, and what was measured.

        `outcome` of each, `taken` by the worst of the hands that were tried over this link, 0 where none
        takes any; `tracking_error`, root mean square of x_l − x_f while the leader is led to and fro and
        nobody holds the follower, and `apart`, |x_l − x_f| a second after; `felt_stiffness` of the leader
        when the follower is clamped.  Units and meanings in the attributes.
        """
        import xarray as xr

        variables = {
            key: ("port", np.array([row[key] for row in self.rows.values()]), about)
            for key, about in self._about().items()
        }
        outcomes = ("port", [row["outcome"] for row in self.rows.values()])
        return xr.Dataset({"outcome": outcomes, **variables}, coords={"port": list(self.rows)})

    @cached_property
    def traces(self) -> Mapping[str, Mapping[str, xr.Dataset]]:
        """By port: `stroke` and `press`."""
        import zwidth.loop.traces.accessor  # noqa: F401 - gives every trace its `.zwidth`

        return {
            name: {touch: trace.dataset() for touch, trace in own.items()}
            for name, own in self.touches.items()
        }

    def _about(self) -> dict[str, dict[str, str]]:
        """Unit and meaning of each number."""
        return {
            key: {"units": GLOSSARY[quantity].unit_for(self.motion), "long_name": meaning}
            for key, (quantity, meaning) in _SCORES.items()
        }

    def to_dict(self) -> dict[str, Any]:
        """The scores by port, a unit in every key of a physical quantity."""
        keys = {key: f"{key}_{unit_suffix(about['units'])}" for key, about in self._about().items()}
        ports = {
            name: {
                "outcome": row["outcome"],
                **{keyed: finite(float(row[key])) for key, keyed in keys.items()},
            }
            for name, row in self.rows.items()
        }
        held = {"held_back_s": [float(time) for time in self.held_back]} if self.held_back else {}
        return {"format": self._FORMAT, "link": self.schedule.describe(), **held, "ports": ports}

    def report(self) -> Iterable[Part]:
        """Which ports are passive over every such link, the link, and a table with a row for each port."""
        about = self._about().values()
        told = [spoken(one["units"]) for one in about]
        heads = [
            ("", "any link", *(one["long_name"] for one in about)),
            ("", "", *(unit_text(unit) for _, unit in told)),
        ]
        rows = []
        for name, row in self.rows.items():
            numbers = [finite(float(row[key])) for key in _SCORES]
            cells = [
                "–" if number is None else f"{factor * number:.3g}"
                for number, (factor, _) in zip(numbers, told, strict=True)
            ]
            rows.append((name, row["outcome"], *cells))
        passive = [cells[0] for cells in rows if cells[1] == "passive"]
        yield f"passive over every link that makes up no packets: {', '.join(passive) or 'none'}"
        yield f"the link of these numbers: {self.schedule.describe()}"
        if self.held_back:
            times = " and ".join(dict.fromkeys(shown(float(time), "s") for time in self.held_back))
            yield (
                f"each force is kept back by {times} more, until a sample ends: of loops that do so alone is "
                "this proved"
            )
        yield ""
        yield Table(heads=heads, rows=rows, lefts=2)
        for outcome, known in _OF_NOTHING.items():
            if any(row["outcome"] == outcome and row["taken"] == 0 for row in self.rows.values()):
                yield f"{outcome} with 0: none of the hands that were tried takes any over this link; {known}"


_OF_NOTHING = {
    "active": "over a link without delay one of them does",
    "undecided": "that no hand does is not proved",
}
"""What is known of a port, by its outcome, where no hand took any energy over the link that was asked."""


_SCORES = {
    "taken": ("energy", "worst hands take"),
    "tracking_error": ("position", "apart, rms"),
    "apart": ("position", "a second after"),
    "felt_stiffness": ("stiffness", "felt, follower clamped"),
}
"""Of each number what it is, and its meaning in a few words."""


def standard_ports(
    leader: Device,
    follower: Device,
    schedule: Schedule,
    impedance: RealLike | None = None,
    smoothing: RealLike = 0,
) -> dict[str, Ends]:
    """Every kind of port for two devices, leader first, as stiff as each other.

    Parameters
    ----------
    leader, follower
        What the ports drive.
    schedule
        The link, whose delay says how stiff waves feel; the springs are as stiff.
    impedance
        w of the waves; None: the smaller damping of the two.
    smoothing
        Of the port with a ledger [s].
    """
    least = min(ends(device.damping)[0] for device in (leader, follower))
    w = least if impedance is None else _impedance(impedance, leader.motion)
    spring = Exact(stiffness_of(w, schedule, leader))
    level = Exact(spring.fraction * Fraction(_FAR[leader.motion]).limit_denominator(1000) ** 2 / 2)
    damping = Exact(least)

    def both(make: Callable[[Device], Port]) -> Ends:
        return make(leader), make(follower)

    return {
        "waves with a ledger": both(lambda d: WavePort(d, impedance=Exact(w), smoothing=smoothing)),
        "waves without a ledger": both(lambda d: HeldWaves(d, impedance=Exact(w))),
        "textbook waves": both(lambda d: NaiveWaves(d, impedance=Exact(w))),
        "positions, last one held": both(lambda d: PositionHold(d, stiffness=spring)),
        "time-domain passivity": both(lambda d: TimeDomain(d, stiffness=spring, largest_damping=damping)),
        "two layers": both(lambda d: TwoLayer(d, stiffness=spring, level=level, filling_damping=damping)),
    }


def _impedance(given: RealLike, motion: str) -> Fraction:
    own = parameters_of(WavePort)["impedance"]
    read = read_number(given, own.quantity, "impedance", bound=own.bound, why=own.why, motion=motion)
    return Exact(read).fraction


def stiffness_of(impedance: Fraction, schedule: Schedule, device: Device) -> Fraction:
    """The stiffness that waves show over a link."""
    period = device.exact("sample_period")
    late = schedule.samples_late(period) + int(device.exact("delay") / period)
    return felt_stiffness(impedance, late, period)


def compare(
    leader: Device,
    follower: Device | None = None,
    schedule: Schedule | None = None,
    *,
    impedance: RealLike | None = None,
    smoothing: RealLike = 0,
    ports: Mapping[str, Ends] | None = None,
    hold_back: bool = False,
    progress: Callable[[int, int], None] | None = None,
) -> LinkComparison:
    """Lead, press and attack two devices that are joined over one link by each kind of port.

    Parameters
    ----------
    leader, follower
        Devices with a mass and one sample period; without a follower both are the same.
    schedule
        What the link does to packets; None: no delay.
    impedance
        w of the waves; None: the smaller damping of the two.
    smoothing
        Of the port with a ledger [s].
    ports
        By name, leader's and follower's, in the place of `standard_ports`.
    hold_back
        True for devices whose delay ends within a sample, in loops that keep each force back until it ends.
    progress
        Told (kinds of port done, kinds in all).

    Raises
    ------
    InputError
        If the devices do not fit together, or have no mass; or ports are given and hold_back.
    """
    link = Schedule() if schedule is None else schedule
    other = leader if follower is None else follower
    held: tuple[Fraction, ...] = ()
    if hold_back and ports is not None:
        raise InputError("hold_back is for the standard ports: give ports of devices with the longer delay")
    if hold_back:
        (leader, near_time), (other, far_time) = (held_back(device) for device in (leader, other))
        held = (near_time, far_time) if near_time or far_time else ()
    kinds = standard_ports(leader, other, link, impedance, smoothing) if ports is None else ports
    rows: dict[str, dict[str, Any]] = {}
    touches = {}
    for done, (name, (near, far)) in enumerate(kinds.items()):
        if progress is not None:
            progress(done, len(kinds))
        check_ends(near, far)
        touches[name] = {"stroke": _stroke(near, far, link), "press": _press(near, far, link)}
        rows[name] = {**_taken(near, far, link), **_measured(touches[name])}
    return LinkComparison(rows, leader.motion, link, touches, held)


def held_back(device: Device) -> tuple[Device, Fraction]:
    """The device in a loop that keeps each force back until a sample ends, and for how long [s].

    With another delay it is another loop: that of the longer one is no bound for that of the shorter, in
    which two forces act in one period.
    """
    delay, period = device.exact("delay"), device.exact("sample_period")
    whole = ceil(delay / period) * period
    return device.replace(delay=Exact(whole)), whole - delay


def _taken(near: Port, far: Port, link: Schedule) -> dict[str, Any]:
    """Over this link; that it is active may be seen over one without any delay alone."""
    if all(port.has_ledger or port.theorem for port in (near, far)):
        found = {check(port).outcome for port in (near, far)}
        return {"outcome": next(word for word in _WEAKEST_FIRST if word in found), "taken": 0.0}
    motion = most_taken(near, far, link)
    taken = 0.0 if motion is None else motion.energy
    active = motion is not None or most_taken(near, far, Schedule()) is not None
    return {"outcome": "active" if active else "undecided", "taken": taken}


def _stroke(near: Port, far: Port, link: Schedule) -> Trace:
    """The leader is led to and fro, smoothly, and held; nobody holds the follower."""
    most = _FAR[near.device.motion]

    def path(t: float) -> float:
        return most * float(np.sin(np.pi * t / _STROKE)) ** 2 if t < _STROKE else 0.0

    return simulated(near, far, link, PrescribedMotion(path), None, _STROKE + _REST)


def _press(near: Port, far: Port, link: Schedule) -> Trace:
    """The leader is pushed slowly harder, to about half the way of a stroke; the follower is clamped."""
    device = near.device
    period = float(device.exact("sample_period"))
    stiffness = float(stiffness_of(ends(device.damping)[0], link, device))
    most = 2 * float(ends(device.coulomb_friction)[1]) + stiffness * _FAR[device.motion] / 2
    push = RecordedForce(most * np.minimum(np.arange(round(_PRESS / period)) * period / _RISE, 1.0))
    clamp = PrescribedMotion(lambda t: 0.0)
    return simulated(near, far, link, push, clamp, _PRESS)


def _measured(traces: Mapping[str, Trace]) -> dict[str, float]:
    apart = np.diff(traces["stroke"]["position"].values, axis=0)[0]
    diverged = "diverged_at_s" in traces["stroke"].attrs
    return {
        "tracking_error": np.inf if diverged else float(np.sqrt(np.mean(apart**2))),
        "apart": np.inf if diverged else float(abs(apart[-1])),
        "felt_stiffness": _felt(traces["press"].sel(arm="leader")),
    }


def _felt(leader: Trace) -> float:
    """nan where it does not come to rest."""
    late = leader["position"].values
    late = late[late.size // 2 :]
    moves = late.std() > _STILL * abs(late.mean())
    return float("nan") if moves or "diverged_at_s" in leader.attrs else static_stiffness(leader)
