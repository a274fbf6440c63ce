"""What a loop begins with when another environment, law or kind of device is chosen.

Numbers that the one before had too are kept; a usual one of their unit stands for the others.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType

from zwidth.model.device import Device
from zwidth.model.device.rotary import rotary
from zwidth.model.environment import Wall
from zwidth.model.kind import Kind
from zwidth.model.rendering import LAWS
from zwidth.model.specification.environments import TYPES
from zwidth.model.specification.laws import with_laws
from zwidth.model.specification.read import (
    DEVICE_KEYS,
    WITH_LAWS,
    built,
    keep_axis,
    merged,
    read_tables,
    specified_device,
)
from zwidth.model.specification.table import Table
from zwidth.quantity.spoken import angles_typed
from zwidth.show.explorer.state import State, Values, catalogued, completed, usual

FIRST = "haptic-paddle"
"""The device that an empty page begins with."""

OWN_LINEAR, OWN_ROTARY = "own-linear", "own-rotary"
"""Devices that are in no catalogue, by the name under which they can be chosen."""

_SHAPES: Mapping[str, Mapping[str, object]] = MappingProxyType(
    {
        "generalized-maxwell": {"branches": [[800, 3], [200, 20]]},
        "nonlinear-spring": {"positions": [0, "0.005", "0.01"], "forces": [0, 1, 4]},
        "transfer-function": {"numerator": [1, 200], "denominator": ["0.002", 1], "discretization": "tustin"},
        "pulse-transfer-function": {"numerator": [200, -100], "denominator": [1, "-0.5"]},
        "virtual-coupling": {"environment": {"type": "wall", "stiffness": 1000}},
        "scene": {
            "elements": [
                {"type": "mass", "node": "tool", "mass": "0.05"},
                {"type": "contact", "first": "tool", "second": "ground", "stiffness": 1000},
            ],
            "port": "tool",
        },
    }
)
"""What is no single number; plain numbers are SI, of a linear or of a rotary device."""

_FORCES: Mapping[str, Mapping[str, object]] = MappingProxyType(
    {"hysteresis": {"fastest": usual("m/s")}, "held": {"samples": 2}, "dual-rate": {"samples": 2}}
)
"""Of laws that need one of several numbers, or a count."""


def first() -> State:
    """A device of the catalogue with a wall."""
    device = catalogued(FIRST)
    return State.of(device, Wall(stiffness=_stiffness(device)))


def from_sources(
    sources: Sequence[str], typed: Mapping[str, str] | None = None, laws: Sequence[str] | None = None
) -> State | None:
    """The loop of files, names and parameters, as `zwidth check` reads them; None where none is given.

    Parameters
    ----------
    sources
        TOML files, or a name in the catalogue.
    typed
        Parameters by name, as typed: {"rate": "2 kHz", "stiffness": "770"}.
    laws
        Names of laws in a chain behind the environment.
    """
    typed = dict(typed or {})
    if not (sources or typed or laws):
        return None
    found = read_tables(sources, WITH_LAWS)
    if not (found.keys() & {"device"} or typed.keys() & DEVICE_KEYS):
        found["device"] = Table(FIRST, {"catalogue": FIRST})
    rendered = {key: text for key, text in typed.items() if key not in DEVICE_KEYS}
    if "device" in found:
        keep_axis(
            found["device"], {**(found["environment"].values if "environment" in found else {}), **rendered}
        )
    begun = completed(found["device"], typed) if "device" in found else {}
    if "environment" in found or rendered:
        loop = built(*merged(found, typed), in_range=False)
        device, environment = loop.device, loop.environment
    else:
        device = specified_device(found, typed)
        environment = Wall(stiffness=_stiffness(device))
    law = with_laws(environment, found.get("law"), laws, device.motion)
    return State.of(device, law).with_begun(begun).with_angles(angles_typed())


def own_device(kind: str) -> Device:
    """A device whose numbers are to be set."""
    if kind == OWN_ROTARY:
        return rotary(
            inertia="5e-5 kg*m^2", damping="1e-3 N*m*s/rad", coulomb_friction="5 mN*m", counts_per_turn=4096,
            rate="1 kHz", name="rotary device",
        )  # fmt: skip
    return Device(
        mass="0.1 kg", damping="0.1 N*s/m", coulomb_friction="0.1 N", resolution="20 um", rate="1 kHz",
        name="linear device",
    )  # fmt: skip


def with_device(state: State, device: Device, begun: Mapping[str, str] = MappingProxyType({})) -> State:
    """The same environment on another device; of one that moves otherwise, a wall.

    `begun`: what nobody gave of it, as it begins.
    """
    before = state.loop()
    if device.motion == before.device.motion:
        return replace(state, device=State.of(device, before.environment).device).with_begun(begun)
    return State.of(device, Wall(stiffness=_stiffness(device))).with_begun(begun)


def _stiffness(device: Device) -> str:
    """Of a wall to begin with."""
    return f"{usual(device.unit('stiffness')):g}"


def with_environment(state: State, name: str) -> State:
    """Another environment on the same device, with the numbers that it shares with the one before."""
    motion = state.motion
    had = TYPES[str(state.environment["type"])].keys
    shared = {
        key: value
        for key, value in state.environment.items()
        if key in had and had[key].is_number and key in TYPES[name].keys
        if had[key].unit_for(motion) == TYPES[name].keys[key].unit_for(motion)
    }
    values = _begun(TYPES[name], _SHAPES.get(name, {}), motion, shared)
    return replace(state, environment={"type": name, **values}).settled()


def with_law(state: State, name: str, on: bool) -> State:
    """With a law at its place in the chain, or without it; laws keep the order of the registry."""
    kept = [law for law in state.laws if law["type"] != name]
    if on:
        kept.append({"type": name, **_begun(LAWS[name], _FORCES.get(name, {}), state.motion, {})})
    order = list(LAWS)
    kept.sort(key=lambda law: order.index(str(law["type"])))
    return replace(state, laws=tuple(kept)).settled()


def _begun(kind: Kind, shape: Values, motion: str, before: Values) -> dict[str, object]:
    """A table with every key that a type needs."""
    values = dict(shape)
    for key, own in kind.keys.items():
        if key in before and key not in values:
            values[key] = before[key]
        elif own.required and key not in values:
            values[key] = f"{usual(own.unit_for(motion)):g}"
    return values
