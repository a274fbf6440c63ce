"""The laws that are compared, each with defaults that follow from the device."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import pi

from zwidth.device.device import Device
from zwidth.environment.environment import Environment
from zwidth.environment.velocity import OnePole, Window
from zwidth.environment.wall import Wall
from zwidth.errors import InputError
from zwidth.quantity.exact import Exact
from zwidth.rendering import PassivityController, VirtualCoupling, render

Law = Callable[[Device, Wall], Environment]

CUTOFF = 100.0
"""Of the velocity filter [Hz]."""


def _damped(device: Device, wall: Wall, **how: object) -> Wall:
    """The wall with virtual damping K T/2: half a sample ahead."""
    period = device.exact("sample_period")
    return wall.replace(damping=wall.stiffness.fraction * period / 2, **how)  # type: ignore[union-attr]


def _coupled(device: Device, wall: Wall) -> Environment:
    """Behind a coupling that the device renders passively, as stiff as 2b/T allows."""
    limit = 2 * device.exact("damping") / device.exact("sample_period")
    return VirtualCoupling(stiffness=limit, damping=0, environment=wall)


LAWS: Mapping[str, Law] = {
    "wall": lambda device, wall: wall,
    "virtual-damping": _damped,
    "one-pole-damping": lambda d, w: _damped(d, w, velocity_filter=OnePole(1 / (2 * pi * CUTOFF))),
    "window-damping": lambda d, w: _damped(d, w, velocity_filter=Window(8)),
    "virtual-coupling": _coupled,
    "passivity-controller-published": lambda d, w: render(w, PassivityController(observer="published")),
    "passivity-controller": lambda d, w: render(w, PassivityController()),
    "passivity-controller-limited": lambda d, w: render(
        w, PassivityController(largest_damping=d.exact("damping") or 1, resets=True, ceiling=0)
    ),
}
"""By name, in the order in which they are shown."""


def standard_laws(device: Device, wall: Environment) -> dict[str, Environment]:
    """Every law of the bench for a wall on a device.

    Parameters
    ----------
    device
        Every number certain.
    wall
        What is to be rendered.

    Raises
    ------
    InputError
        If it is no wall, or a number is an interval.
    """
    if not isinstance(wall, Wall):
        raise InputError(f"the bench compares how a wall is rendered, got {wall.describe()}")
    if not wall.is_certain or any(not isinstance(v, Exact) for v in (device.damping, device.sample_period)):
        raise InputError("the bench simulates one loop: give numbers, no intervals")
    return {name: law(device, wall) for name, law in LAWS.items()}
