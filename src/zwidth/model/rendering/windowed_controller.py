"""Passivity controller with a short memory: what was lost long ago cannot hide what comes out now.

Observer, S what the environment's spring stores; d_k is what the last move has lost, exact behind a hold:

    d_k = f_{k−1} Δx_k − (S_k − S_{k−1}),   S = ½ K max(0, x)²
    D ← D − min(max(d_{k−N}, 0), max(D, 0)) + d_k

Controller, with a floor v₀ under the speed and a clamp:

    lack = −(D + S)
    f ← f + α Δx/T,   α = min(lack T/max(Δx², (v₀ T)²), s α_max)    where lack > 0

With nothing forgotten D + S is the energy that the hand has put in.  What is forgotten was lost: never
a debt, nor what the spring will give back, nor so much that D falls below 0.  f_{k−1} is the force that
was held, so the observer counts what the clamp let through, not what was asked for.  K is that of a wall
or of a solid at rest; of other environments it is 0, and what they store is forgotten with the rest.

The rules, with 30 samples, 10 mm/s and 0.9, are those of the controller for two arms in sai-primitives
(Stanford, public code); written down for one axis behind a hold for this project.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import sqrt
from typing import ClassVar

from zwidth.errors import InputError
from zwidth.model.device.device import Device
from zwidth.model.rendering.passivity_controller import largest_damping as or_the_devices
from zwidth.model.rendering.passivity_controller import spring_of
from zwidth.model.rendering.reading import below, count
from zwidth.model.rendering.rendering_law import LoopContext, RenderingLaw
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.parameter import PLAIN, Certain, CertainOrNone, Count, exact, part, plain
from zwidth.quantity.text import shown

WINDOWED_CONTROLLER = 2.0

LONGEST = 1000
"""Samples of a window at most."""

SLOWEST = {"linear": 0.01, "rotary": sqrt(0.001)}
"""v₀ where none is given [m/s; rad/s]."""

_PERIOD, _MOST, _FLOOR, _HALF_STIFFNESS, _WINDOW = range(5)
_BEFORE, _LOST, _HEAD, _RING = range(4)


def _samples(window: RealLike, name: str) -> int:
    why = "it is how long what was lost may pay for what comes out"
    samples = count(name, window, why)
    if samples > LONGEST:
        raise InputError(f"{name} is {LONGEST} samples at most, got {samples}: {why}; take a shorter one")
    return samples


@dataclass(frozen=True, kw_only=True)
class WindowedController(RenderingLaw):
    """``f ← f + α Δx/T``, ``α = min(lack T/max(Δx², (v₀ T)²), s α_max)``; what was lost is forgotten.

    Of every hand, without counts: the controller gives out (s α_max/T) Σ Δx² at most, by default less
    than the device's damping takes.  It makes no wall passive that is not.

    Parameters
    ----------
    window
        N, samples after which what was lost is forgotten, 1 to 1000.
    slowest
        v₀ > 0, slower moves are damped as if they were as fast as this [m/s; rad/s]; None: 0.01 m/s,
        0.0316 rad/s.
    share
        s, part of α_max that is used, above 0 and at most 1.
    largest_damping
        α_max [N·s/m; N·m·s/rad]; None: b of the device, which pays for it;
        less K (T/2 + delay) for a spring wall that is passive by itself.

    Raises
    ------
    InputError
        If a number is out of its bounds; when it is simulated, if `largest_damping` was not given and the
        device has no damping.

    Notes
    -----
    sai-primitives, POPCBilateralTeleoperation (M. Jorda): window, floor, clamp and credit for stored energy.
    """

    code: ClassVar[float] = WINDOWED_CONTROLLER

    window: Count = part(
        "quantity",
        _samples,
        30,
        meaning="N, samples after which what was lost is forgotten, by default 30",
        quantity=PLAIN,
    )
    slowest: CertainOrNone = exact(
        "speed",
        None,
        "> 0",
        "it is a floor under a speed",
        "v₀, floor under the speed, by default 0.01 m/s; 0.0316 rad/s",
    )
    share: Certain = exact(
        plain("share", "s, part of the largest damping that is used, by default 0.9"),
        "0.9",
        "> 0",
        "it is the part of the largest damping that is used",
    )
    largest_damping: CertainOrNone = exact(
        "virtual_damping",
        None,
        "> 0",
        "it limits what the controller adds; leave it out for b of the device",
        "α_max, by default b of the device",
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.share > 1:
            raise InputError(
                f"share must be ≤ 1, got {self.share:g}: beyond it the damping would exceed its own "
                "limit; give a larger largest_damping"
            )

    @property
    def state_size(self) -> int:  # type: ignore[override]  # as many as the window is long
        """The last reading, D, where the oldest loss is, and N losses."""
        return _RING + self.window

    def numbers(self, at: LoopContext) -> list[float]:
        slowest = SLOWEST[at.device.motion] if self.slowest is None else float(self.slowest)
        return [
            at.period,
            below(self.most_damping(at.device, spring_of(at.environment))),
            slowest * at.period,
            at.stiffness / 2 if at.environment.rests_on_spring else 0.0,
            float(self.window),
        ]

    def most_damping(self, device: Device, spring: Exact | None) -> Fraction:
        """s α_max."""
        alpha = or_the_devices(self.largest_damping, device, spring)
        assert alpha is not None  # this law has no word for no limit
        return self.share.fraction * alpha

    def describe(self, motion: str = "linear") -> str:
        slowest = SLOWEST[motion] if self.slowest is None else float(self.slowest)
        of = self.with_unit("largest_damping", motion) or "b of the device"
        return (
            f"windowed passivity controller ({self.window} samples, floor "
            f"{shown(slowest, self._unit('slowest', motion), 3)}, at most {float(self.share):g} of {of})"
        )


@compiled
def windowed_controller_step(
    p: Array, i: int, s: Array, j: int, x: float, force: float, applied: float
) -> float:
    """One sample; p from i and s from j on are this law's, `applied` is the force that was held."""
    stiffness, before, head = p[i + _HALF_STIFFNESS], s[j + _BEFORE], int(s[j + _HEAD])
    inside, was_inside = max(x, 0.0), max(before, 0.0)
    stored = stiffness * inside * inside
    moved = x - before
    lost = applied * moved - (stored - stiffness * was_inside * was_inside)
    total = s[j + _LOST]
    total += lost - min(max(s[j + _RING + head], 0.0), max(total, 0.0))
    s[j + _BEFORE], s[j + _LOST], s[j + _RING + head] = x, total, lost
    s[j + _HEAD] = float((head + 1) % int(p[i + _WINDOW]))
    lack = -(total + stored)
    if lack <= 0.0 or moved == 0.0:
        return force
    square = max(moved * moved, p[i + _FLOOR] * p[i + _FLOOR])
    period = p[i + _PERIOD]
    return force + min(lack * period / square, p[i + _MOST]) * moved / period
