"""The proof that a port is passive whatever the link does: a certificate, or a theorem on paper."""

from __future__ import annotations

from fractions import Fraction

from zwidth.links import memory
from zwidth.links.port import Port
from zwidth.links.sure_losses import ROUNDING
from zwidth.links.wave_port import MARGIN
from zwidth.model.device.amplifier import current_rise
from zwidth.passivity.bounding import ROUNDOFF
from zwidth.passivity.certificate import FORMAT, Certificate
from zwidth.passivity.scope import unit_key
from zwidth.quantity.exact import ends
from zwidth.quantity.glossary import GLOSSARY, unit_suffix
from zwidth.quantity.text import exact_text


def slow_actuator(port: Port) -> str:
    """Why a force is not there at once, where the device's record says so; "" where it does not."""
    rise = current_rise(port.device)
    return rise.text if rise.ok is False else ""


def certificate_of(port: Port) -> Certificate | None:
    """That the independent checker accepts; None where the port keeps no ledger, or its actuator is slow."""
    if not port.has_ledger or slow_actuator(port):
        return None
    found = Certificate((_document(port),))
    return found if found.verify() else None


def _document(port: Port) -> dict[str, object]:
    """The doubles that the port reckons with, each as the rational that it is."""
    device, motion = port.device, port.device.motion
    loop = {
        "damping": ends(device.damping)[0],
        "coulomb_friction": ends(device.coulomb_friction)[0],
        "resolution": device.exact("resolution"),
        "sample_period": device.exact("sample_period"),
        "delay": device.exact("delay"),
    }
    damping, force, length = (
        unit_suffix(GLOSSARY[name].unit_for(motion)) for name in ("damping", "force", "position")
    )
    law = {
        f"damping_{damping}": port.numbers[memory.DAMPING],
        f"friction_{force}": port.numbers[memory.COULOMB],
        f"count_{length}": port.numbers[memory.RESOLUTION],
        "period_s": port.numbers[memory.PERIOD],
        "hair": ROUNDING,
        "margin": 1.0 - MARGIN,
    }
    return {
        "format": FORMAT,
        "kind": "wave port",
        "loop": {unit_key(name, motion): exact_text(value) for name, value in loop.items()},
        "law": {
            **{name: exact_text(Fraction(float(value))) for name, value in law.items()},
            "roundoff": exact_text(ROUNDOFF),
        },
    }
