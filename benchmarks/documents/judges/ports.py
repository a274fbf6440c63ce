"""Ports: the Hermitian part on a sweep and in the right half plane, motions in the time domain."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any

import numpy as np

from ..opinion import Opinion, agrees, cannot_say, false
from ..plain import exact, exacts

Document = dict[str, Any]
Rng = np.random.Generator

SLACK = 1e-8
POINTS = 400
MOST_CYCLES = 100_000


def _system(document: Document) -> tuple[np.ndarray, np.ndarray, bool]:
    """Numerators (m, m, n) and denominator in descending powers, and whether time is continuous."""
    system = document["system"]
    rows = system.get("numerators") or [[system["numerator"]]]
    below = [float(c) for c in exacts(system["denominator"])]
    longest = max(len(below), *(len(q) for row in rows for q in row))
    padded = [[[0.0] * (longest - len(q)) + [float(c) for c in exacts(q)] for q in row] for row in rows]
    return np.array(padded), np.array([0.0] * (longest - len(below)) + below), system["time"] == "continuous"


def _port(document: Document, z: np.ndarray) -> np.ndarray:
    """F at some places (k, m, m): G, or its inverse."""
    above, below, _ = _system(document)
    return _value(above, below, document["index"], z)


def _value(above: np.ndarray, below: np.ndarray, index: str, z: np.ndarray) -> np.ndarray:
    powers = z[:, None] ** np.arange(above.shape[-1] - 1, -1, -1)
    top, bottom = np.einsum("kn,ijn->kij", powers, above), powers @ below
    if index == "input":
        return top / bottom[:, None, None]
    return bottom[:, None, None] * np.linalg.inv(top)


def _rounding(document: Document, z: np.ndarray, rng: Rng) -> float:
    """How far F moves at a place where its coefficients move by some more than rounding."""
    above, below, _ = _system(document)
    here, most = _value(above, below, document["index"], z), 0.0
    for _ in range(8):
        moved = [side * (1 + 1e-14 * rng.standard_normal(side.shape)) for side in (above, below)]
        most = max(most, float(np.abs(_value(*moved, document["index"], z) - here).sum()))
    return most


def _places(document: Document, rng: Rng) -> np.ndarray:
    """On the edge of the region, near it and far inside, around the sizes of the roots."""
    above, below, continuous = _system(document)
    roots = np.concatenate([np.roots(below), *(np.roots(q) for row in above for q in row)])
    roots = roots[np.isfinite(roots) & (roots != 0)]
    if not continuous:
        theta = np.concatenate([np.linspace(0, np.pi, POINTS // 2), rng.uniform(0, np.pi, POINTS // 2)])
        theta = np.concatenate([theta, np.abs(np.angle(roots))])
        out = 1 + 10.0 ** rng.uniform(-9, 1, len(theta))
        return np.concatenate(
            [np.exp(1j * theta), out * np.exp(1j * theta), roots[np.abs(roots) > 1] * 1.0001]
        )
    scale = np.abs(roots) if len(roots) else np.ones(1)
    omega = np.geomspace(scale.min() * 1e-4, scale.max() * 1e4, POINTS)
    omega = np.concatenate([[0.0], omega, np.abs(roots.imag), scale])
    deep = omega * 10.0 ** rng.uniform(-9, 1, len(omega))
    return np.concatenate([1j * omega, deep + 1j * omega, deep, roots[roots.real > 0] * 1.0001])


def _positive(document: Document, rng: Rng) -> Opinion:
    """Herm F ≥ σ wherever it was looked at."""
    level, places = float(exact(document["level"])), _places(document, rng)
    with np.errstate(all="ignore"):
        try:
            f = _port(document, places)
        except np.linalg.LinAlgError:
            return cannot_say("the inverse has a pole at one of the places")
        usable = np.isfinite(f).all(axis=(1, 2))
        places, f = places[usable], f[usable]
        least = np.linalg.eigvalsh((f + np.conj(np.swapaxes(f, 1, 2))) / 2)[:, 0]
    if not len(f):
        return cannot_say("F is nowhere finite")
    size = np.abs(f).sum(axis=(1, 2)) + abs(level)
    worst = int(np.argmax((level - least) / size))
    if least[worst] < level - SLACK * size[worst]:
        if level - least[worst] < _rounding(document, places[worst : worst + 1], rng):
            return cannot_say("rounding hides what the Hermitian part is")
        return false(f"the Hermitian part is {least[worst]:.9g} < {level:.9g} at {places[worst]:.6g}")
    return agrees()


def _sides(document: Document) -> tuple[list[list[list[Fraction]]], list[list[list[Fraction]]]]:
    """(D, N), ascending: u = D φ, y = N φ."""
    system = document["system"]
    rows = system.get("numerators") or [[system["numerator"]]]
    n = [[exacts(q)[::-1] for q in row] for row in rows]
    below = exacts(system["denominator"])[::-1]
    d = [[below if i == j else [Fraction(0)] for j in range(len(n))] for i in range(len(n))]
    return (d, n) if document["index"] == "input" else (n, d)


def _taken(document: Document, rng: Rng) -> Opinion:
    motion = document["motion"]
    matrix = "numerators" in document["system"]
    level, sides = exact(document["level"]), _sides(document)
    if motion["kind"] == "burst":
        if exact(motion["cycles"]) > MOST_CYCLES:
            return cannot_say("a burst of so many cycles is not summed up")
        got, size = _burst(motion, sides, float(level), matrix)
    elif motion["kind"] == "polynomial":
        phi = [exacts(a) for a in (motion["coefficients"] if matrix else [motion["coefficients"]])]
        tau, lowest = exact(motion["duration_s"]), int(exact(motion["lowest_power"]))
        if tau <= 0 or lowest < max(len(q) for side in sides for row in side for q in row) - 1:
            return cannot_say("whether it begins at rest was not looked at")
        got, size = _polynomial(phi, tau, lowest, sides, level), 0.0
    else:
        phi = [exacts(a) for a in (motion["latent"] if matrix else [motion["latent"]])]
        got, size = _sequence(phi, sides, level), 0.0
    if abs(got) <= 1e-9 * size:
        return cannot_say("rounding hides what is taken out")
    return agrees() if got < 0 else false(f"the motion puts in {float(got):.6g} above the level")


def _burst(motion: Document, sides: Any, level: float, matrix: bool) -> tuple[float, float]:
    """∫ uᵀy − σ uᵀu over one period, summed over samples: its lines are fewer than these."""
    step, cycles, power = (float(exact(motion[k])) for k in ("step_rad_per_s", "cycles", "power"))
    alpha, beta = (
        (np.array([float(exact(v)) for v in motion[k]]) if matrix else w)
        for k, w in (("cosine", np.ones(1)), ("sine", np.zeros(1)))
    )
    lines = int(cycles + power) + 1
    count = 4 * lines
    t = 2 * np.pi * np.arange(count) / count
    window = (1 - np.cos(t)) ** int(power)
    phi = window * (np.outer(alpha, np.cos(cycles * t)) + np.outer(beta, np.sin(cycles * t)))
    spectrum, omega = np.fft.rfft(phi), 1j * step * np.arange(count // 2 + 1)
    u, y = (
        np.fft.irfft(
            np.array(
                [
                    sum(
                        np.polyval([float(c) for c in q[::-1]], omega) * s
                        for q, s in zip(row, spectrum, strict=True)
                    )
                    for row in side
                ]
            ),
            count,
        )
        for side in sides
    )
    return float((u * y - level * u * u).sum()), float(
        (np.abs(u * y) + abs(level) * u * u).sum()
    ) + 1e-6 * float(np.abs(u).max() * np.abs(y).max())


def _derived(a: list[Fraction]) -> list[Fraction]:
    return [k * c for k, c in enumerate(a)][1:]


def _polynomial(phi: Any, tau: Fraction, lowest: int, sides: Any, level: Fraction) -> Fraction:
    """With time in units of τ: the k-th derivative is over τᵏ."""
    total = Fraction(0)
    axes = [[Fraction(0)] * lowest + a for a in phi]
    for first, second in zip(*sides, strict=True):
        u, y = ([_applied(q, a, tau) for q, a in zip(row, axes, strict=True)] for row in (first, second))
        u, y = (_summed(signals) for signals in (u, y))
        for i, a in enumerate(u):
            if a:
                total += sum(
                    a * (b - level * c) * tau / (i + j + 1) for j, (b, c) in enumerate(_paired(y, u))
                )
    return total


def _paired(y: list[Fraction], u: list[Fraction]) -> list[tuple[Fraction, Fraction]]:
    size = max(len(y), len(u))
    return list(zip(*(s + [Fraction(0)] * (size - len(s)) for s in (y, u)), strict=True))


def _summed(signals: list[list[Fraction]]) -> list[Fraction]:
    size = max(map(len, signals))
    return [sum((s[k] for s in signals if k < len(s)), Fraction(0)) for k in range(size)]


def _applied(q: list[Fraction], a: list[Fraction], tau: Fraction) -> list[Fraction]:
    terms, at = [], a
    for k, c in enumerate(q):
        terms.append([c * v / tau**k for v in at])
        at = _derived(at)
    return _summed(terms)


def _sequence(phi: Any, sides: Any, level: Fraction) -> Fraction:
    """From rest: what the latter of u and y would be before the motion begins is 0."""
    order = max(len(q) for side in sides for row in side for q in row) - 1
    length, total = max(map(len, phi)), Fraction(0)
    for first, second in zip(*sides, strict=True):
        u, y = ([Fraction(0)] * (length + order) for _ in range(2))
        for signal, row in ((u, first), (y, second)):
            for q, a in zip(row, phi, strict=True):
                for i, c in enumerate(q):
                    for k, v in enumerate(a):
                        if c and v:
                            signal[k + order - i] += c * v
        total += sum(
            (a * b - level * a * a for a, b in zip(u[:length], y[:length], strict=True)), Fraction(0)
        )
    return total


JUDGES: dict[str, Callable[[Document, Rng], Opinion]] = {
    "positive real": _positive,
    "positive real matrix": _positive,
    "extraction": _taken,
    "matrix extraction": _taken,
}
