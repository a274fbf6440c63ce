"""The linear part of the loop, seen from the wall: what its force does to the position it is computed from.

    x = −G f,    f = φ(x)

For a device in a tied hand G is exact at the samples: mass M = m + m_h, damping B = b + c, spring k,
the force held and late by (d + α) T,

    G(z) = z⁻ᵈ (P₀(z) + z⁻¹ P₁(z)) / (z² − tr Φ z + det Φ)
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment import PulseTransferFunction
from zwidth.model.operator.operator import LinearHand, Operator
from zwidth.passivity.linear.exact_algebra import is_schur
from zwidth.passivity.scope import unit_key
from zwidth.quantity.exact import Exact
from zwidth.quantity.glossary import GLOSSARY, unit_suffix
from zwidth.quantity.text import exact_text


@dataclass(frozen=True)
class Plant:
    """G(z) in descending powers of z, rounded; its T [s], None where the coefficients do not say.

    `source` is what a certificate says of it: exact coefficients, or device and hand.
    """

    numerator: NDArray[np.float64]
    denominator: NDArray[np.float64]
    source: dict[str, Any]
    period: float | None

    def response(self, angles: NDArray[np.float64]) -> NDArray[np.complex128]:
        """G(e^{jθ})."""
        z = np.exp(1j * angles)
        found: NDArray[np.complex128] = np.polyval(self.numerator + 0j, z) / np.polyval(self.denominator, z)
        return found

    def response_at(self, angle: float) -> complex:
        """G(e^{jθ}) at one θ."""
        return complex(self.response(np.array([angle]))[0])


def given_plant(system: PulseTransferFunction) -> Plant:
    """G(z) as typed: stable and strictly proper."""
    top, bottom = ([Exact(c).fraction for c in part] for part in (system.numerator, system.denominator))
    while top and top[0] == 0:
        top = top[1:]
    if not top or len(top) >= len(bottom):
        raise InputError(
            "G(z) must have fewer zeros than poles: else force and position of a sample depend on each other"
        )
    scale = np.lcm.reduce([int(c.denominator) for c in bottom])
    if not is_schur([int(c * int(scale)) for c in reversed(bottom)]):
        raise InputError("G(z) has a pole on or outside the unit circle: without the wall it is not stable")
    source = {"plant": {"numerator": [str(c) for c in top], "denominator": [str(c) for c in bottom]}}
    period = None if system.sample_period is None else float(system.sample_period)
    return Plant(np.array(top, dtype=float), np.array(bottom, dtype=float), source, period)


def touched_plant(device: Device, hand: LinearHand | Operator) -> Plant:
    """The device in a hand that is a mass, a spring and a damper to a resting anchor."""
    loop = _numbers(device, hand.hand if isinstance(hand, Operator) else hand)
    mass, damping = loop["mass"] + loop["hand_mass"], loop["damping"] + loop["hand_damping"]
    period, late = loop["sample_period"], loop["delay"] / loop["sample_period"]
    if damping <= 0:
        raise InputError("b + c must be > 0, got 0: a motion outside the wall would never come to rest")
    flow = np.array([
        [0.0, 1.0, 0.0],
        [-float(loop["hand_stiffness"] * period**2 / mass), -float(damping * period / mass), 1.0],
        [0.0, 0.0, 0.0],
    ])  # fmt: skip
    whole, part = int(late), float(late % 1)
    step, rest = expm(flow), expm(flow * (1 - part))[:2, 2]
    early = step[:2, 2] - rest
    unit = float(period**2 / mass)

    def moved(force: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.array([force[0], step[0, 1] * force[1] - step[1, 1] * force[0]])

    own = np.array([1.0, -np.trace(step[:2, :2]), np.linalg.det(step[:2, :2])])
    top = moved(rest) if not part else np.append(moved(rest), 0.0) + np.append(0.0, moved(early))
    bottom = np.append(own, np.zeros(whole + (part > 0)))
    return Plant(unit * top, bottom, {"loop": _document(loop, device.motion)}, float(period))


def _numbers(device: Device, hand: LinearHand) -> dict[str, Fraction]:
    if device.mass is None:
        raise InputError("the device needs a mass: a hand with inertia moves as it allows; give mass=…")
    if not device.is_certain:
        raise InputError("absolute stability is decided for certain numbers; give each parameter one value")
    for name in ("coulomb_friction", "resolution"):
        if device.exact(name) != 0:
            raise InputError(
                f"{name} is {float(device.exact(name)):g}, and here the loop is linear but for the wall: "
                "give 0; zw.check covers encoder and friction"
            )
    own = ("mass", "damping", "sample_period", "delay")
    numbers = {name: device.exact(name) for name in own}
    hands = {f"hand_{name}": Exact(getattr(hand, name)).fraction for name in hand._fields}
    if min(hands.values()) < 0:
        raise InputError("mass, stiffness and damping of the hand must be ≥ 0: it is passive")
    return {**numbers, **hands}


def _document(loop: dict[str, Fraction], motion: str) -> dict[str, str]:
    def key(name: str) -> str:
        if not name.startswith("hand_"):
            return unit_key(name, motion)
        return f"{name}_{unit_suffix(GLOSSARY[name[5:]].unit_for(motion))}"

    return {key(name): exact_text(value) for name, value in loop.items()}
