"""An identified device as a document: every number with its unit in the key."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from zwidth.data.identification.device.limits import advice, limits
from zwidth.data.identification.device.table import BOTH_SIDES
from zwidth.quantity.glossary import GLOSSARY, unit_suffix

if TYPE_CHECKING:
    from zwidth.data.identification.device.estimate import Estimate
    from zwidth.data.identification.device.numbers import IdentifiedNumbers

FORMAT = "zwidth identification 1"

_QUANTITY = {"spring": "stiffness", "force_lag": "delay", "slow": "coulomb_friction"}
"""Whose unit is meant, where the name is not in the glossary."""


def to_dict(identified: IdentifiedNumbers, confidence: float) -> dict[str, Any]:
    """See `Identified.to_dict`."""

    def key(name: str, quantity: str | None = None) -> str:
        unit = GLOSSARY[quantity or _QUANTITY.get(name, name)].unit_for(identified.motion)
        return f"{name}_{unit_suffix(unit)}"

    document: dict[str, Any] = {
        "format": FORMAT,
        "source": identified.source,
        "motion": identified.motion,
        key("sample_period"): identified.sample_period,
        key("resolution"): identified.resolution,
        "confidence": confidence,
    }
    if identified.mass is not None:
        document[key("given_mass", "mass")] = identified.mass
    for name, estimate in identified.estimates.items():
        document[key(name)] = _estimate(estimate, confidence)
    for name in ("inward", "outward"):
        estimate = getattr(identified.directions, name)
        document[key(f"damping_{name}", "damping")] = _estimate(estimate, confidence)
    for name, speed in zip(("inward", "outward"), identified.fastest, strict=True):
        document[key(f"seen_{name}", "friction_speed")] = speed
    for name in ("inward", "outward"):
        estimate = getattr(identified.slopes, name)
        document[key(f"slope_{name}", "damping")] = _estimate(estimate, confidence)
    for limit in limits(identified):
        low, high = limit.interval(confidence)
        document[key(f"stiffest_by_{limit.parameter}", "stiffness")] = {
            "value": limit.value,
            "interval": [low, high],
        }
    return {
        **document,
        "explained": identified.explained,
        key("force_noise", "force"): identified.force_noise,
        key("offset", "force"): identified.offset,
        key("viscous_alone", "damping"): identified.viscous_alone,
        "pulse_length_s": identified.pulse_length,
        "strokes": identified.strokes,
        "pulses": identified.pulses,
        "findings": [{"kind": f.kind, "text": f.text} for f in identified.findings],
        "advice": list(advice(identified, confidence)),
        "assumptions": [BOTH_SIDES],
    }


def _estimate(estimate: Estimate, confidence: float) -> dict[str, Any]:
    return {
        "value": estimate.value,
        "standard_error": estimate.error,
        "shift": estimate.shift,
        "degrees_of_freedom": estimate.degrees,
        "interval": list(estimate.interval(confidence)),
    }
