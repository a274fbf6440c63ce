"""The evidence as numbers that can be compared between a wheel and a paddle: shares, ratios, logarithms."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from zwidth.diagnosis.evidence import TERMS, Evidence


def features(seen: Evidence) -> dict[str, float]:
    """Every number on which a cause may be weighed; 0 where the recording does not say."""
    v, k, T = seen.vibration, seen.known, seen.loop_period
    found = seen.law
    supply = sum(max(0.0, w) for w in seen.supplied.values())
    lost = seen.lost or 0.0
    scale = max(supply, lost, abs(seen.total)) or 1.0
    numbers: dict[str, float] = {f"{term} share": max(0.0, seen.supplied[term]) / scale for term in TERMS}
    numbers["net"] = seen.total / scale
    numbers["law takes"] = min(0.0, sum(seen.supplied.values())) / scale
    numbers["log counts"] = (
        np.clip(np.log10(max(seen.counts, 0.1)), -1, 3) if np.isfinite(seen.counts) else 3.0
    )
    numbers["few counts"] = 1.0 / (1.0 + (seen.counts / 6.0) ** 2) if np.isfinite(seen.counts) else 0.0
    ratio = 0.0
    if k.mass:
        ratio = seen.apparent_mass / k.mass
    numbers["has mass"] = float(bool(k.mass))
    numbers["light"] = max(0.0, 1 - ratio) if k.mass else 0.0
    numbers["pushes wrong way"] = float(seen.apparent_mass < 0)
    numbers["heavy"] = np.clip(np.log(max(ratio, 1e-2)), 0, 3) if k.mass else 0.0
    numbers["standing"] = seen.standing
    numbers["distortion"] = min(seen.distortion, 1.0)
    numbers["irregular"] = 1 - v.regular
    numbers["frequency"] = v.frequency * T
    numbers["both forces"] = float(seen.drive is not None)
    if seen.drive is not None:
        d = seen.drive
        for name, left in (("delay", d.by_delay), ("damper", d.by_damper), ("rate", d.by_rate)):
            numbers[f"by {name}"] = -np.log10(max(left, 1e-4)) / 4
        numbers["ramps"] = d.ramps
        numbers["as commanded"] = -np.log10(max(d.by_nothing, 1e-4)) / 4
        numbers["delay samples"] = min(d.delay / T, 10.0) / 10
    numbers["law unexplained"] = np.log10(max(found.unexplained, 1e-6)) / 6 if found else 0.0
    numbers["no law"] = float(found is None)
    if found is not None:
        numbers["lag samples"] = min(found.lag / T, 10.0) / 10
        numbers["limited"] = found.limited
        if k.damping:
            demand = 0.5 * abs(found.stiffness) * T
            numbers["log spring demand"] = np.clip(np.log10((demand + 1e-12) / k.damping), -2, 2)
            numbers["log damper demand"] = np.clip(np.log10((abs(found.damping) + 1e-12) / k.damping), -3, 3)
        if k.coulomb and seen.resolution:
            step = 0.5 * abs(found.stiffness) * seen.resolution
            numbers["log encoder demand"] = np.clip(np.log10((step + 1e-12) / k.coulomb), -2, 2)
            numbers["log compensation"] = np.clip(
                np.log10((max(found.compensation, 0) + 1e-12) / k.coulomb), -2, 2
            )
    if seen.lost:
        numbers["missing"] = np.clip((seen.lost - seen.total) / scale, -1, 2)
    return {name: float(value) for name, value in numbers.items()}


def vector(numbers: Mapping[str, float], names: tuple[str, ...]) -> np.ndarray:
    """In the order of names; 0 where there is none."""
    return np.array([numbers.get(name, 0.0) for name in names])
