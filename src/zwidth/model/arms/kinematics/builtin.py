"""Arms whose geometry is published; their joint friction is not, and must be given.

    hapkit       one link: the handle 65.659 mm from the axis (Stanford Hapkit code)
    two-link     two links of 0.1 m: an example, not a product
    haply-2diy   five-bar pantograph, links 70 and 90 mm (Haply hAPI sketches); motors 38 mm
                 apart, as the sketches of generation 3 have it; older ones have them on one axis
    falcon       three legs at 105°, −15° and −135° (libnifalcon, geometry header): link 60 mm,
                 rod 102.5 mm, hinges 11.25 mm each, r = 40, s = −23.09, c = 14.43, f = −25 mm

Encoder steps: 2π/4880 of the Haply's joints (hAPI sketches); of the Falcon 1280 counts
per turn of a motor that drives a disc of 110 mm by a shaft of 14.25 mm (libnifalcon).
The regions of work are choices of this project, inside the reach of each.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import cos, pi, radians, sin
from types import MappingProxyType
from typing import Any

from zwidth.errors import InputError
from zwidth.model.arms.kinematics.arm import Arm
from zwidth.model.arms.kinematics.chain import PlanarChain
from zwidth.model.arms.kinematics.joint_damping import Damping
from zwidth.model.arms.kinematics.legs import Leg, LeggedArm


def built_in(name: str, *, damping: float | Damping, **numbers: Any) -> Arm:
    """An arm with published geometry.

    Parameters
    ----------
    name
        "hapkit", "two-link", "haply-2diy" or "falcon".
    damping
        Viscous friction of each joint, one number for all, or a matrix as of `Arm` [N·m·s/rad]; no source
        gives it.
    numbers
        Other arguments of the arm: coulomb_friction [N·m], resolution [rad], torque_limit [N·m], or what
        belongs to its geometry, such as `lower` and `upper` [m], `joint_range` [rad] or `pose`, of a chain.
        One number stands for all joints.

    Raises
    ------
    InputError
        If the name is not known, or a number cannot be used.
    """
    if name not in BUILT_IN:
        raise InputError(f"there is no arm {str(name)[:40]!r}; built in are {', '.join(BUILT_IN)}")
    kind, given = BUILT_IN[name]()
    if "pose" in numbers and kind is not PlanarChain:
        raise InputError(
            f"{name} has no pose: the hand holds a point and its joints do not turn the handle; "
            "in pose there are hapkit, two-link and robot descriptions"
        )
    joints = len(given.get("links", given.get("legs", ())))
    merged = {"name": name, **given, "damping": damping, **numbers}
    for key in ("damping", "coulomb_friction", "resolution", "torque_limit"):
        value = merged.get(key, ())
        merged[key] = (value,) * joints if isinstance(value, (int, float)) else value
    return kind(**merged)


def _hapkit() -> tuple[type[Arm], dict[str, Any]]:
    return PlanarChain, {"links": (0.065659,), "joint_range": ((-pi / 4, pi / 4),)}


def _two_link() -> tuple[type[Arm], dict[str, Any]]:
    return PlanarChain, {"links": (0.1, 0.1), "joint_range": ((0.0, pi), (pi / 6, 5 * pi / 6))}


def _haply() -> tuple[type[Arm], dict[str, Any]]:
    plane: dict[str, Any] = {"out": (1.0, 0.0), "up": (0.0, 1.0), "link": 0.07, "rod": 0.09}
    legs = (
        Leg(base=(-0.019, 0.0), bend=1, **plane),  # elbows outwards
        Leg(base=(0.019, 0.0), bend=-1, **plane),
    )
    return LeggedArm, {
        "legs": legs,
        "lower": (-0.05, 0.05),
        "upper": (0.05, 0.12),
        "resolution": 2 * pi / 4880,
    }


def _falcon() -> tuple[type[Arm], dict[str, Any]]:
    return LeggedArm, {
        "legs": tuple(_falcon_leg(radians(angle)) for angle in (105, -15, -135)),
        "lower": (-0.03, -0.03, 0.1),
        "upper": (0.03, 0.03, 0.14),
        "resolution": 2 * pi / 1280 * 14.25 / 110,
    }


def _falcon_leg(turn: float) -> Leg:
    """p′_u = u − r + c and p′_v = v − s + f in the axes of the leg."""
    out, across = (cos(turn), sin(turn), 0.0), (-sin(turn), cos(turn), 0.0)
    u, v = 0.040 - 0.01443, -0.02309 + 0.025
    base = tuple(u * a + v * b for a, b in zip(out, across, strict=True))
    return Leg(base=base, out=out, up=(0.0, 0.0, 1.0), link=0.06, rod=0.1025, offset=0.0225)


BUILT_IN: Mapping[str, Callable[[], tuple[type[Arm], dict[str, Any]]]] = MappingProxyType(
    {"hapkit": _hapkit, "two-link": _two_link, "haply-2diy": _haply, "falcon": _falcon}
)
