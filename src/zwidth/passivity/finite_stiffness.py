"""A witness in a real hand: how much of what the ideal hand gets out is left.

The hand of the criteria changes its velocity at once, whatever the mass. A real
one is a spring and a damper to where the muscles want the handle,

    f_h = k (x_a(t) − x) + c (ẋ_a(t) − ẋ),   c = 2 ζ √(k m)

with x_a the motion of the witness. It follows up to its bandwidth
f = √(k/m)/2π and gets energy out only if that is high enough: the heavier the
device, the stiffer the hand must be. This is the conservatism that Abbott &
Okamura (2005, section III-D) ascribe to the impulses of their hand.

Both hands are run through the simulator, with the device's own mass and an ideal actuator. What a hand has
got out is max(−W_h) over the motion: it begins at rest at the surface, where nothing is stored.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from math import floor, log10, pi, sqrt
from typing import TYPE_CHECKING, Any, NamedTuple

from zwidth.errors import InputError
from zwidth.passivity.result import Evidence
from zwidth.passivity.scope import unit_key
from zwidth.passivity.verdict import Verdict
from zwidth.passivity.witness.motion import Motion
from zwidth.passivity.witness.witness import Witness
from zwidth.quantity.answered import answered, answers, known
from zwidth.quantity.documented import Documented
from zwidth.quantity.text import in_words, shown, told_quantity
from zwidth.showing import Part, Table

if TYPE_CHECKING:
    from zwidth.loop.trace import Trace
    from zwidth.model.device.device import Device
    from zwidth.model.operator.operator import Operator
    from zwidth.passivity.storage.gain import Gain

SLOWEST = 1.0
"""Bandwidth of the slowest hand that is tried [Hz]."""

QUICKEST = 60.0
"""Bandwidth of the quickest hand that is tried, times T: beyond, it is rigid within a sample."""

_PER_DECADE = 8
_MASSES = (0.25, 1.0, 4.0)
_MOST_SAMPLES = 4000
_AFTER = 30  # samples that the hand stays at the end of the motion
_ROUNDING = 1e-9  # energy that counts as got out, as part of the energy moved


class Reached(NamedTuple):
    """What a hand of one stiffness gets out."""

    stiffness: float
    bandwidth: float
    energy: float


class Threshold(NamedTuple):
    """The softest hand that gets anything out, for one mass; None where none tried does."""

    mass: float
    stiffness: float | None
    bandwidth: float | None


@dataclass(frozen=True, repr=False)
class FiniteStiffnessReplay(Documented):
    """A witness replayed by the ideal hand and by hands of finite stiffness."""

    _FORMAT = "zwidth real hand 1"
    _BESIDES = (
        ("hands", "for each hand tried: `stiffness_N_per_m`, `bandwidth_Hz`, `energy_J`"),
        (
            "thresholds",
            "the slowest hand that gains, for three masses: `mass_kg`, `stiffness_N_per_m`, "
            "`bandwidth_Hz`; null where none does",
        ),
    )

    rounds: int = answered("how often the repeated part of the motion is done here")
    rounds_found: int = answered("the same in the witness")
    claimed: float = answered(
        "energy that the motion, with so many rounds, extracts by exact arithmetic",
        key="energy_claimed",
        unit="J",
    )
    replayed: float = answered(
        "energy that the simulator finds in the same prescribed motion", key="energy_replayed", unit="J"
    )
    damping_ratio: float = answered("ζ of the hand on the device's mass")
    curve: tuple[Reached, ...] = known(
        "stiffness [N/m; N·m/rad], bandwidth [Hz] and energy got out [J] of each hand tried"
    )
    thresholds: tuple[Threshold, ...] = known(
        "the softest hand that gets anything out, for a quarter, once and four times the mass"
    )
    motion: str = known('"linear" or "rotary"')

    @property
    def softest(self) -> Threshold:
        """The softest hand that gets anything out of the device as it is."""
        return self.thresholds[_MASSES.index(1.0)]

    @property
    @answers()
    def best_share(self) -> float:
        """The largest energy of any hand tried, as a part of the ideal one."""
        return max(0.0, *(hand.energy for hand in self.curve)) / self.claimed

    def to_dict(self) -> dict[str, Any]:
        """Plain data, units in the keys."""
        k, m = (unit_key(name, self.motion) for name in ("stiffness", "mass"))
        return {
            **super().to_dict(),
            "hands": [
                {k: h.stiffness, "bandwidth_Hz": h.bandwidth, "energy_J": h.energy} for h in self.curve
            ],
            "thresholds": [{m: t.mass, k: t.stiffness, "bandwidth_Hz": t.bandwidth} for t in self.thresholds],
        }

    def rows(self) -> Iterator[tuple[str, str]]:
        """What a person reads."""
        times = f" (its cycle {self.rounds} of {self.rounds_found:,} times)" if self.rounds_found > 1 else ""
        proved, simulated = shown(self.claimed, "J"), shown(self.replayed, "J")
        yield "ideal hand", f"{proved} by the proof, {simulated} simulated{times}"
        for threshold in self.thresholds:
            if threshold.stiffness is None:
                text = f"gets nothing out, up to {shown(self.curve[-1].bandwidth, 'Hz', 3)}"
            else:
                k = told_quantity(threshold.stiffness, "stiffness", self.motion, 3)
                text = f"must be stiffer than {k}, quicker than {shown(threshold.bandwidth, 'Hz', 3)}"
            yield f"a hand on {told_quantity(threshold.mass, 'mass', self.motion, 3)}", text
        yield "best hand tried", f"{shown(self.best_share, '%', 3)} of the ideal energy"

    def report(self) -> Iterable[Part]:
        """The rows."""
        yield Table(rows=list(self.rows()))


def replay(verdict: Verdict, *, damping_ratio: float = 1.0) -> FiniteStiffnessReplay:
    """Replay the witness of an active verdict by the ideal hand and by hands of finite stiffness.

    Parameters
    ----------
    verdict
        An active verdict of `check`, on a device whose mass is known.
    damping_ratio
        ζ > 0 of the hand's spring and damper on the mass; 1 is critical.

    Raises
    ------
    InputError
        If the verdict has no witness, the mass is unknown, ζ is not > 0, or the motion
        has gained nothing yet in the rounds that are replayed.
    """
    if not isinstance(verdict, Verdict):
        raise InputError(f"replay takes a verdict of zwidth.check, got {type(verdict).__name__}")
    if verdict.witness is None:
        raise InputError(f"this verdict is {verdict.outcome}: it has no motion that could be replayed")
    if not isinstance(verdict.witness, Evidence):
        raise InputError(
            "the motion of a hand on a transmission was found in the simulator: zwidth simulate replays it, "
            "and by hands of your choice"
        )
    if verdict.device.mass is None:
        own = in_words("mass", verdict.device.motion)
        raise InputError(f"{own} is needed to replay a motion by a real hand, and the device has none")
    if not 0 < damping_ratio < float("inf"):
        raise InputError(f"damping_ratio must be > 0, got {damping_ratio}: a hand without damping rings on")
    motion, rounds = _shortened(verdict.witness.motion)
    claimed = _claimed(verdict.witness, motion)
    mass = float(verdict.device.exact("mass"))

    def hand(device: Device) -> Callable[[float], Reached]:
        weight = float(device.exact("mass"))

        def reached(bandwidth: float) -> Reached:
            stiffness = weight * (2 * pi * bandwidth) ** 2
            damping = 2 * damping_ratio * sqrt(stiffness * weight)
            energy = _got_out(verdict, device, motion, stiffness, damping)
            return Reached(stiffness, bandwidth, energy)

        return reached

    tried = _bandwidths(float(verdict.device.exact("sample_period")) * max(1.0, damping_ratio))
    thresholds = (
        _threshold(hand(verdict.device.replace(mass=factor * mass)), tried, factor * mass)
        for factor in _MASSES
    )
    return FiniteStiffnessReplay(
        rounds=rounds,
        rounds_found=verdict.witness.motion.rounds,
        claimed=claimed,
        replayed=_ideal(verdict, motion),
        damping_ratio=damping_ratio,
        curve=tuple(map(hand(verdict.device), tried)),
        thresholds=tuple(thresholds),
        motion=verdict.device.motion,
    )


def _claimed(witness: Witness | Gain, motion: Motion) -> float:
    """Energy that the motion, with its rounds, extracts by exact arithmetic [J]."""
    if isinstance(witness, Witness):
        return float(witness.setting.energy(motion) or 0)
    less = witness.motion.rounds - motion.rounds
    energy = float(witness.exact_energy - less * witness.exact_gain)
    if energy <= 0:
        whole, some = (shown(m.samples * witness.sample_period, "s", 3) for m in (witness.motion, motion))
        raise InputError(
            f"the motion goes on for {whole} before it has gained what the way in costs, and real hands are "
            f"replayed for the first {some} of it: by then none has got anything out. Leave out --replay; of "
            "a loop farther from its limit the motion is shorter"
        )
    return energy


def _shortened(motion: Motion) -> tuple[Motion, int]:
    """The motion with as many rounds as fit into a few thousand samples, one at least."""
    if motion.rounds <= 1 or motion.samples <= _MOST_SAMPLES:
        return motion, motion.rounds
    longest = max(1, sum(part.last - part.first for part in motion.repeats))
    rounds = max(1, min(motion.rounds, _MOST_SAMPLES // longest))
    return motion.repeated(rounds), rounds


def _bandwidths(period: float) -> list[float]:
    count = floor(_PER_DECADE * log10(QUICKEST / period / SLOWEST)) + 1
    return [SLOWEST * 10 ** (i / _PER_DECADE) for i in range(count)]


def _threshold(reached: Callable[[float], Reached], tried: list[float], mass: float) -> Threshold:
    """The slowest of the hands that get energy out, its stiffness to 1 %."""
    first = next((i for i, f in enumerate(tried) if reached(f).energy > 0.0), None)
    if first is None:
        return Threshold(mass, None, None)
    high = tried[first]
    low = tried[first - 1] if first else 0.0
    while high - low > 0.005 * high:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if reached(middle).energy > 0.0 else (middle, high)
    return Threshold(mass, reached(high).stiffness, high)


def _ideal(verdict: Verdict, motion: Motion) -> float:
    """−W_h of the prescribed motion, at rest at its end [J]."""
    from zwidth.model.operator import WitnessMotion

    hand = WitnessMotion(motion)
    trace = _simulated(verdict, verdict.device, hand, hand.intervals + 1)
    return -float(trace["hand_work"].values[-1])


def _got_out(verdict: Verdict, device: Device, motion: Motion, stiffness: float, damping: float) -> float:
    """max(−W_h) of a hand that follows the motion [J]; 0 where it is no more than rounding."""
    from zwidth.loop.energy import ledger
    from zwidth.model.operator import Tracking

    hand = Tracking(motion, stiffness=stiffness, damping=damping)
    book = ledger(_simulated(verdict, device, hand, motion.samples + _AFTER))
    return book.extracted if book.extracted > _ROUNDING * book.moved else 0.0


def _simulated(verdict: Verdict, device: Device, hand: Operator, samples: int) -> Trace:
    from zwidth.loop.simulate import simulated
    from zwidth.model.device.amplifier import Ideal

    period = device.exact("sample_period")
    return simulated(device, verdict.environment, hand, samples * period, amplifier=Ideal())
