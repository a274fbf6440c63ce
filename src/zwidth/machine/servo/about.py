"""What was served, for those who read a recording later."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import Any

from zwidth.errors import InputError
from zwidth.loop.trace import own_version
from zwidth.machine.servo.connection import Connection, Placement
from zwidth.machine.servo.safety import Safety
from zwidth.model.device.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.model.specification.write import written


def about(
    device: Device, environment: Environment, connection: Connection, placement: Placement, safety: Safety
) -> dict[str, Any]:
    """Texts and numbers, units in the keys."""
    x = "rad" if device.motion == "rotary" else "m"
    return {
        "zwidth_version": own_version(),
        "started": datetime.now(UTC).isoformat(timespec="seconds"),
        "device": device.name,
        "motion": device.motion,
        "connection": connection.describe(),
        "law": environment.describe(device.motion),
        "specification": specification(device, environment),
        f"origin_{x}": placement.origin,
        "sense": placement.sense,
        "safety": {name: None if value is None else float(value) for name, value in vars(safety).items()},
    }


def specification(device: Device, environment: Environment) -> str:
    """The loop in TOML; "" where a specification has no words for it."""
    try:
        return written(device, environment)
    except InputError:
        return ""
