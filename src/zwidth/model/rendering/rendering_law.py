"""One law more between the environment and the actuator, a step per sample.

    f ← step(x, f)        x the reading, f the force so far
    x ← step(x)           for a law that comes before the environment

`rendered.Rendered` puts them in a row.  Each is a frozen data class with its law in
its docstring, and a compiled `step` that the simulator runs.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar, NamedTuple

from zwidth.model.device.amplifier import current_rise
from zwidth.model.device.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.quantity.exact import Exact
from zwidth.quantity.parameter import Parametric
from zwidth.quantity.text import told_quantity


class LoopContext(NamedTuple):
    """What a law is told once, before the loop runs: what the hand holds, and what it meets.

    `single` is True where the machine keeps its numbers in 24 bits, not in 53.
    """

    device: Device
    environment: Environment
    single: bool = False

    @property
    def period(self) -> float:
        """T [s]."""
        return float(self.device.exact("sample_period"))

    @property
    def stiffness(self) -> float:
        """Of the environment per depth, the hand at rest; 0 where it has no such number [N/m; N·m/rad]."""
        return float(getattr(self.environment, "stiffness", 0.0))


@dataclass(frozen=True, kw_only=True)
class SteppedLaw(Parametric, ABC):
    """What a compiled step runs: the numbers that it reads, and those that it remembers."""

    state_size: ClassVar[int]
    """Numbers that it remembers."""

    @abstractmethod
    def numbers(self, at: LoopContext) -> list[float]:
        """The parameters of the step, defaults filled in from the device."""

    def initial_state(self, reading: float) -> list[float]:
        """What it remembers after the hand has been at a reading for ever."""
        return [reading] + [0.0] * (self.state_size - 1)

    @abstractmethod
    def describe(self, motion: str = "linear") -> str:
        """The law with its numbers, in a few words."""


@dataclass(frozen=True, kw_only=True)
class RenderingLaw(SteppedLaw):
    """A law that changes the force of an environment, or the reading before it."""

    code: ClassVar[float]
    """Which step the compiled chain takes; its own for each law."""

    bounds_the_force: ClassVar[bool] = False
    """True for force bounding: last in a row, it keeps to what the device pays for, whatever came before."""

    def most_damping(self, device: Device, spring: Exact | None) -> Fraction | None:
        """α where what it adds is never more than α |Δx|/T; None where it is not so bounded.

        A wall with that much virtual damping, of either sign, covers the law then.  `spring` is K where the
        force that comes in is that of the wall's spring; None where a law before has changed it.
        """
        return None

    def theorem(self, at: LoopContext) -> Theorem | None:
        """Why no hand takes energy out with this law last in the row, by a proof on paper; None without one.

        What the proof counts of the device is in it; whether that is enough says `Theorem.unmet`.  No
        certificate comes with it: what can be checked by a machine says `check`.
        """
        return None


# A proof on paper that a law is passive, and what of the device it counts.
#
# What a proof does not count, a device may not have: `unmet` compares the two, so that a promise is
# made on the numbers of the record and not on a sentence.
#
# The converter rounds to its nearest step, so a force errs by ΔF/2 at most.  That gives out at most
# (ΔF/2) |Δx| in a move, which as much Coulomb friction takes: docs, "Laws that bound the force".


@dataclass(frozen=True, kw_only=True)
class Theorem:
    """Why no hand takes energy out, by a proof on paper, and under what.

    Parameters
    ----------
    statement
        What is proved, in a few words.
    counts_encoder
        True if it holds behind the device's encoder, with counts of any size.
    counts_delay
        True if it holds with the device's delay.
    counts_force_steps
        True if it holds with a converter that rounds to the nearest step, where the device has
        `coulomb_friction`.
    counts_force_limit
        True if it holds with an actuator that gives no more than its limit.
    counts_current_rise
        True if it holds for a current that takes time to rise.
    coulomb_friction
        f_c that the device needs [N; N·m], ≥ 0.
    """

    statement: str
    counts_encoder: bool = False
    counts_delay: bool = False
    counts_force_steps: bool = False
    counts_force_limit: bool = False
    counts_current_rise: bool = False
    coulomb_friction: Fraction = Fraction(0)

    def unmet(self, device: Device) -> tuple[str, ...]:
        """What of the device's record is outside the proof, in words; nothing where the promise holds."""
        record = (
            (self.counts_encoder, device.exact("resolution") > 0, "an encoder with counts"),
            (self.counts_delay, device.exact("delay") > 0, "a delay"),
            (self.counts_force_steps, device.force_resolution is not None, "the converter's steps"),
            (self.counts_force_limit, device.force_limit is not None, "the force limit"),
            (self.counts_current_rise, current_rise(device).ok is False, "a current that rises slowly"),
        )
        lacking = [f"{what}, not counted by the proof" for counts, there, what in record if there > counts]
        has = device.exact("coulomb_friction")
        if has < self.coulomb_friction:
            less, taken = (told_quantity(f, "force", device.motion) for f in (has, self.coulomb_friction))
            lacking.append(
                f"Coulomb friction of {less}, less than the {taken} that the converter's steps take"
            )
        return tuple(lacking)

    def holds_on(self, device: Device) -> bool:
        """True where the device has nothing that the proof does not count."""
        return not self.unmet(device)

    def reason(self, device: Device) -> str:
        """Why it holds, or why the promise is withheld, in a sentence."""
        unmet = self.unmet(device)
        return f"withheld: the device has {' and '.join(unmet)}" if unmet else self.statement


def half_a_step(device: Device) -> Fraction:
    """ΔF/2, the most by which the converter errs; 0 where its step is not known [N; N·m]."""
    return Fraction(0) if device.force_resolution is None else device.exact("force_resolution") / 2
