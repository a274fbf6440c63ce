"""Loops with a known hand: matrix exponentials, eigenvalues, periodic motions by Fourier's transform."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction
from itertools import product
from typing import Any, NamedTuple

import numpy as np
from flint import acb, acb_poly, arb, ctx
from mpmath import expm as mp_expm
from mpmath import matrix, mpf, nstr, workdps
from scipy.linalg import expm

from ..opinion import Opinion, agrees, cannot_say, false
from ..plain import entry, exact, exacts, quantity

Document = dict[str, Any]
Rng = np.random.Generator

CLOSE = 1e-6
"""Of the unit circle: where rounding may decide."""

SLACK = 1e-8
LATEST = 60


class Plant(NamedTuple):
    """s⁺ = Φ s − late f(k−d) − later f(k−d−1), x the first of s; or −x/f = N/D, descending in z."""

    step: np.ndarray
    late: np.ndarray
    later: np.ndarray
    whole: int

    def response(self, z: np.ndarray) -> np.ndarray:
        """G = −x/f."""
        size = len(self.step)
        solved = [np.linalg.solve(v * np.eye(size) - self.step, self.late + self.later / v)[0] for v in z]
        return np.array(solved) / z**self.whole


def held(mass: float, damping: float, stiffness: float, period: float, delay: float) -> Plant:
    """M ẍ + D ẋ + k x = −f, the force held for a sample and late; time in samples, the force over M/T²."""
    whole, part = int(delay // period), delay / period % 1
    a = np.zeros((3, 3))
    a[0, 1], a[1, :] = 1.0, (-stiffness * period**2 / mass, -damping * period / mass, period**2 / mass)
    all_of, rest = expm(a), expm(a * (1 - part))
    early = expm(a * part)
    later = rest[:2, :2] @ early[:2, 2]
    return Plant(all_of[:2, :2], rest[:2, 2], later, whole)


def radius(plant: Plant, above: np.ndarray, below: np.ndarray) -> float:
    """The largest |z| of the loop closed by f = N/D x, descending in z, D beginning with 1."""
    order, line = len(below) - 1, plant.whole + 1
    size = len(plant.step) + order + line
    out = np.zeros((size, size))
    m, o = len(plant.step), len(plant.step) + order
    # the law in controller form: w⁺ = x − Σ a w, f = Σ c w + b₀ x
    out[:m, :m] = plant.step
    force = np.zeros(size)
    force[0] = above[0]
    if order:
        force[m:o] = above[1:] - above[0] * below[1:]
        out[m, 0] = 1.0
        out[m, m:o] = -below[1:]
        for i in range(1, order):
            out[m + i, m + i - 1] = 1.0
    acting = [force, *np.eye(size)[o:]]
    out[:m] -= np.outer(plant.late, acting[plant.whole]) + np.outer(plant.later, acting[plant.whole + 1])
    out[o] = force
    for i in range(1, line):
        out[o + i, o + i - 1] = 1.0
    return float(np.abs(np.linalg.eigvals(out)).max())


def _exact_law(loop: Document) -> tuple[list[Fraction], list[Fraction]]:
    above, below = exacts(loop["numerator"]), exacts(loop["denominator"])
    above = [Fraction(0)] * (len(below) - len(above)) + above
    return [c / below[0] for c in above], [c / below[0] for c in below]


def _law(loop: Document) -> tuple[np.ndarray, np.ndarray]:
    above, below = (np.array([float(c) for c in side]) for side in _exact_law(loop))
    return above, below


def _ends(loop: Document, name: str) -> list[float]:
    value = entry(loop, name)
    return [float(exact(v)) for v in value] if isinstance(value, list) else [float(exact(value))]


def _values(loop: Document, rng: Rng) -> Iterator[list[float]]:
    """Corners of the box, and a few inside."""
    sides = [_ends(loop, name) for name in ("mass", "damping", "stiffness")]
    yield from (list(corner) for corner in product(*sides))
    if any(len(side) > 1 for side in sides):
        for _ in range(8):
            yield [float(rng.uniform(side[0], side[-1])) for side in sides]


def _stability(document: Document, rng: Rng) -> Opinion:
    loop = document["loop"]
    period, delay = (float(quantity(loop, n)) for n in ("sample_period", "delay"))
    law, largest = _law(loop), 0.0
    if delay / period > LATEST:
        return cannot_say("the delay is longer than is looked at")
    for mass, damping, stiffness in _values(loop, rng):
        if mass <= 0 or min(damping, stiffness, delay) < 0:
            return false("no device has such numbers")
        largest = max(largest, radius(held(mass, damping, stiffness, period, delay), *law))
    if abs(largest - 1) < CLOSE:
        return _closely(document)
    if document["kind"] == "instability":
        return _said(largest > 1 + CLOSE, largest < 1 - CLOSE, largest)
    return _said(largest < 1 - CLOSE, largest > 1 + CLOSE, largest)


def _closely(document: Document) -> Opinion:
    """With 50 digits, of a loop without intervals."""
    loop = document["loop"]
    if any(isinstance(entry(loop, n), list) for n in ("mass", "damping", "stiffness")):
        return cannot_say("a root is close to the circle within the intervals")
    with workdps(50):
        try:
            largest = _radius_closely(loop)
        except ValueError:  # roots that are not told apart
            return cannot_say("a root is close to the circle")
    if abs(largest - 1) < mpf(10) ** -15:
        return cannot_say(f"a root of the size {nstr(largest, 20)} is too close to the circle")
    unstable = document["kind"] == "instability"
    return (
        agrees() if (largest > 1) == unstable else false(f"the largest root has the size {nstr(largest, 20)}")
    )


def _radius_closely(loop: Document) -> Any:
    """By the roots of the determinant of the loop, from the plant's two coefficients of each part."""
    m, b, k, period = (_mp(quantity(loop, n)) for n in ("mass", "damping", "stiffness", "sample_period"))
    late = quantity(loop, "delay") / quantity(loop, "sample_period")
    whole, part = int(late), _mp(late % 1)
    a = matrix([[0, 1, 0], [-k * period**2 / m, -b * period / m, period**2 / m], [0, 0, 0]])
    step, rest, early = (mp_expm(a * share) for share in (mpf(1), 1 - part, part))
    phi = step[0:2, 0:2]
    now = rest[0:2, 2]
    before = rest[0:2, 0:2] * early[0:2, 2]
    trace, determinant = phi[0, 0] + phi[1, 1], phi[0, 0] * phi[1, 1] - phi[0, 1] * phi[1, 0]
    # x/f = −(C adj(z − Φ) (now + before/z))/(z^d det(z − Φ)), C = (1, 0)
    rows = [[g[0], phi[0, 1] * g[1] - phi[1, 1] * g[0]] for g in (now, before)]
    top = [rows[0][0], rows[0][1] + rows[1][0], rows[1][1]]
    above, below = ([_mp(c) for c in side] for side in _exact_law(loop))
    free = _mp_times([1, -trace, determinant], below) + [mpf(0)] * (whole + 1)
    force = _mp_times(top, above)
    ahead = len(free) - len(force)
    total = [c + (force[i - ahead] if i >= ahead else 0) for i, c in enumerate(free)]
    while len(total) > 1 and abs(total[-1]) < mpf(10) ** -45:
        total.pop()
    with ctx.workdps(60):
        roots = acb_poly([acb(arb(nstr(c, 55))) for c in reversed(total)]).roots(1e-25)
        return max((mpf(abs(z).mid().str(45, radius=False)) for z in roots), default=mpf(0))


def _mp(x: Any) -> Any:
    return mpf(x.numerator) / mpf(x.denominator)


def _mp_times(a: list[Any], b: list[Any]) -> list[Any]:
    out = [mpf(0)] * (len(a) + len(b) - 1)
    for i, x in enumerate(a):
        for j, y in enumerate(b):
            out[i + j] += x * y
    return out


def _said(right: bool, wrong: bool, largest: float) -> Opinion:
    if wrong:
        return false(f"the largest root has the size {largest:.9g}")
    return agrees() if right else cannot_say(f"a root of the size {largest:.12g} is too close to the circle")


def _plant(document: Document) -> Plant:
    if "plant" in document:
        above, below = exacts(document["plant"]["numerator"]), exacts(document["plant"]["denominator"])
        order = len(below) - 1
        above = [0 * below[0]] * (order - len(above)) + above
        n, d = ([float(c / below[0]) for c in side] for side in (above, below))
        # observer form: the first of s is x
        step = np.zeros((order, order))
        step[:, 0] = -np.array(d[1:])
        step[np.arange(order - 1), np.arange(1, order)] = 1.0
        return Plant(step, np.array(n), np.zeros(order), 0)
    loop = document["loop"]
    m, b, mh, c, k, period, delay = (
        float(quantity(loop, n))
        for n in ("mass", "damping", "hand_mass", "hand_damping", "hand_stiffness", "sample_period", "delay")
    )
    return held(m + mh, b + c, k, period, delay)


def _absolute(document: Document, rng: Rng) -> Opinion:
    """The inequality on a fine grid, and linear springs of smaller slopes, which are walls too."""
    plant, slope = _plant(document), float(exact(document["slope"]))
    if plant.whole > LATEST:
        return cannot_say("the delay is longer than is looked at")
    taps = {int(exact(t["place"])): float(exact(t["weight"])) for t in document["taps"]}
    center, q1, q2 = (float(exact(document[n])) for n in ("center", "convexity", "smoothness"))
    outweighs = sum(abs(h) for h in taps.values()) >= center * (1 + SLACK)
    if outweighs or min(q1, q2) < 0 or slope <= 0 or 0 in taps:
        return false("no such multiplier is allowed")
    if document["nonlinearity"] == "monotone" and any(h < 0 for h in taps.values()):
        return false("a negative tap for a wall that need not be odd")
    bare = float(np.abs(np.linalg.eigvals(plant.step)).max())
    if bare > 1 + CLOSE:
        return false(f"G is unstable: a root of the size {bare:.9g}")
    # a spring as stiff as the slope is one of the walls
    one = np.ones(1)
    for share in (1.0, 0.9, 0.3, 0.05):
        found = radius(plant, slope * share * one, one)
        if found > 1 + CLOSE:
            return false(f"a linear spring of {share:g} of the slope has a root of the size {found:.9g}")
    theta = np.unique(np.concatenate([np.linspace(0, np.pi, 600), np.geomspace(1e-6, 1, 200)]))
    z = np.exp(1j * theta)
    g = plant.response(z)
    m = center - sum(h * z**-i for i, h in taps.items()) + 0 * z
    moved = (z - 1) * g
    left = (m * (1 + slope * g)).real + q1 * slope * ((1 - 1 / z) * g).real
    left += q2 * slope * (moved.real - slope / 2 * np.abs(moved) ** 2)
    size = center * (1 + slope * np.abs(g)) + (q1 + q2) * slope * np.abs(g) * (1 + slope * np.abs(moved))
    worst = int(np.argmin(left / size))
    if left[worst] < -SLACK * size[worst]:
        return false(f"the inequality fails by {-left[worst] / size[worst]:.3g} at ωT = {theta[worst]:.6g}")
    return agrees()


def _vibration(document: Document, rng: Rng) -> Opinion:
    """x = −G f over one period: a circulant matrix by the discrete Fourier transform."""
    plant, inside = _plant(document), np.array(document["inside"], dtype=float)
    slope, gap, n = float(exact(document["slope"])), float(exact(document["gap"])), len(inside)
    if slope <= 0 or len(set(document["inside"])) < 2:
        return false("no wall, or no motion")
    try:
        g = plant.response(np.exp(2j * np.pi * np.arange(n) / n))
        pole = np.abs(g).max() > 1e9 * np.median(np.abs(g))
    except np.linalg.LinAlgError:
        pole = True
    if pole:
        return cannot_say("G has a pole at a multiple of the motion's frequency")
    pulse = np.fft.ifft(g).real
    circulant = np.array([[pulse[(i - j) % n] for j in range(n)] for i in range(n)])
    pushed = circulant * (slope * inside)
    matrix = np.eye(n) + pushed
    if not np.isfinite(matrix).all() or np.linalg.cond(matrix) > 1e9:
        return cannot_say("the motion is not determined well")
    off = np.linalg.solve(matrix, pushed @ np.full(n, gap)) - gap
    size = np.abs(off).max() + abs(gap)
    wrong = np.where(inside > 0, -off, off)
    if wrong.max() > 1e-6 * size:
        return false(
            f"sample {int(wrong.argmax())} is on the other side by {wrong.max() / size:.3g} of the motion"
        )
    return agrees() if wrong.max() < -1e-9 * size else cannot_say("a sample is too close to the surface")


JUDGES: dict[str, Callable[[Document, Rng], Opinion]] = {
    "stability": _stability,
    "instability": _stability,
    "absolute stability": _absolute,
    "vibration": _vibration,
}
