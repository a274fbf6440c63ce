"""What a motion asks of the actuator, against the force that it has."""

from __future__ import annotations

from typing import TYPE_CHECKING

from zwidth.model.device import Device
from zwidth.passivity.witness.witness import Witness
from zwidth.quantity.exact import Exact, Interval, ends
from zwidth.quantity.text import told_quantity

if TYPE_CHECKING:
    from zwidth.passivity.storage.evidence.gain import Gain


def actuator_demand(device: Device, limit: Exact | Interval, witness: Witness | Gain) -> str:
    """Whether the motion asks for more force than the limit of the device's actuator [N; N·m]."""
    most = told_quantity(float(ends(limit)[1]), "force", device.motion)
    needed = told_quantity(_peak_force(witness), "force", device.motion, 4)
    if not is_beyond(limit, witness):
        return f"the motion stays within the actuator's {most}: it asks for {needed}"
    return (
        f"the motion asks for {needed}, more than the actuator's {most}; with that "
        "limit respected no motion is shown, and none is excluded"
    )


def is_beyond(limit: Exact | Interval, witness: Witness | Gain) -> bool:
    """True where the motion asks for more than the limit [N; N·m]."""
    return _peak_force(witness) > float(ends(limit)[1])


def _peak_force(witness: Witness | Gain) -> float:
    if isinstance(witness, Witness):
        return witness.peak_force
    from zwidth.passivity.storage.evidence.playback import peak_force  # loaded by now

    return peak_force(witness)
