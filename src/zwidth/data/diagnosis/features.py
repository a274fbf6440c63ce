"""The evidence as numbers that can be compared between a wheel and a paddle: shares, ratios, logarithms."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from zwidth.data.diagnosis.evidence import TERMS, Evidence


def features(seen: Evidence) -> dict[str, float]:
    """Every number on which a cause may be weighed, as far as the recording says them."""
    v, k, T = seen.vibration, seen.known, seen.loop_period
    found = seen.law
    supply = sum(max(0.0, w) for w in seen.supplied.values())
    lost = seen.lost or 0.0
    scale = max(supply, lost, abs(seen.total)) or 1.0
    numbers: dict[str, float] = {f"{term} share": max(0.0, seen.supplied[term]) / scale for term in TERMS}
    numbers["net"] = seen.total / scale
    numbers["law takes"] = min(0.0, sum(seen.supplied.values())) / scale
    if np.isfinite(seen.counts):
        numbers["log counts"] = np.clip(np.log10(max(seen.counts, 0.1)), -1, 3)
        numbers["few counts"] = 1.0 / (1.0 + (seen.counts / 6.0) ** 2)
    numbers["has mass"] = float(bool(k.mass))
    numbers["pushes wrong way"] = float(seen.apparent_mass < 0)
    if k.mass:
        ratio = seen.apparent_mass / k.mass
        numbers["light"] = max(0.0, 1 - ratio)
        numbers["heavy"] = np.clip(np.log(max(ratio, 1e-2)), 0, 3)
    if seen.moves_as is not None:
        numbers["moves as size"] = np.clip(np.log(abs(seen.moves_as) + 1e-6), -3, 3)
        numbers["moves as angle"] = np.angle(seen.moves_as) / np.pi
    for name, bend in (("bend", seen.bend), ("force bend", seen.force_bend)):
        numbers[f"{name} even"] = np.clip(bend.real, -0.5, 0.5)
        numbers[f"{name} odd"] = np.clip(bend.imag, -0.5, 0.5)
    numbers["standing"] = seen.standing
    numbers["distortion"] = min(seen.distortion, 1.0)
    numbers["irregular"] = 1 - v.regular
    numbers["frequency"] = v.frequency * T
    if seen.drive is not None:
        d = seen.drive
        for name, left in (("delay", d.by_delay), ("damper", d.by_damper), ("rate", d.by_rate)):
            numbers[f"by {name}"] = -np.log10(max(left, 1e-4)) / 4
        numbers["as commanded"] = -np.log10(max(d.by_nothing, 1e-4)) / 4
        numbers["delay samples"] = min(d.delay / T, 10.0) / 10
    if seen.ramps is not None:
        numbers["ramps"] = seen.ramps
    if seen.by_inside is not None:
        numbers["by inside"] = -np.log10(max(seen.by_inside, 1e-6)) / 6
    numbers["no law"] = float(found is None)
    if found is not None:
        numbers["law unexplained"] = np.log10(max(found.unexplained, 1e-6)) / 6
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
    """In the order of names; not a number where the recording does not say."""
    return np.array([numbers.get(name, np.nan) for name in names])
