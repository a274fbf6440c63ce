"""The thesis on guaranteed stability in haptic display."""

from __future__ import annotations

import numpy as np

import zwidth as zw
from papers.row import Row, close, drawn, row
from zwidth.model.rendering import BrakingPulse

TITLE = "Guaranteed stability in haptic display (thesis, Northwestern University, chapters 1 and 2)"

SOURCE = (
    "Most likely J.-C. Tsai, 1996. Slips: (2.1) has lost the braces of Re{·}; B > 0 is written, and abs(B) "
    "used in (2.4)."
)

PADDLE = zw.catalogue.device("haptic-paddle", resolution=0, coulomb_friction=0)


def rows() -> list[Row]:
    """Figure by figure and equation by equation."""
    return [*_held_spring(), *_wall(), *_levitated(), *_braking(), *_coupled()]


def _held_spring() -> list[Row]:
    T, k = 1e-3, 500.0
    bare = zw.Device(mass="0.05", damping=0, sample_period="0.001")
    rng = np.random.default_rng(2)
    given = []
    for _ in range(20):
        x = np.r_[0.0, rng.uniform(0, 5e-3, 12), 0.0]
        trace = zw.simulate(bare, zw.Wall(k), zw.operators.PrescribedMotion(x), T * (len(x) - 1))
        given.append(float(trace.actuator_work[-1]))
    undamped = zw.check(PADDLE.replace(damping=0), zw.Wall(1))
    return [
        row("Fig. 1", "a virtual spring stores or generates energy and never dissipates any",
            f"20 random closed motions on {k:g} N/m: each takes out {1e3 * min(given):.2g} mJ or more "
            f"({drawn('staircase')})", min(given) > 0),
        row("section 1.1", "passivity is hopeless without physical damping",
            f"b = 0 and 1 N/m: {undamped.outcome}; largest passive stiffness "
            f"{float(undamped.max_stiffness):g} N/m", undamped.max_stiffness == 0),
    ]  # fmt: skip


def _wall() -> list[Row]:
    T, k, b = 1e-3, 200.0, 0.05
    verdict = zw.check(PADDLE, zw.Wall(200, "0.05"))
    frequencies, needs = (np.array(v) for v in verdict.curve(200))
    off = float(np.abs(needs - (k * T / 2 - b * np.cos(2 * np.pi * frequencies * T))).max())
    stiff = zw.check(PADDLE, zw.Wall(1000, "0.05")).outcome
    rates = (1000, 2000, 4000)
    most = [float(zw.check(PADDLE.replace(rate=r), zw.Wall(10, "0.05")).max_stiffness) for r in rates]
    edges = [
        [zw.check(PADDLE.replace(rate=r), zw.Wall(0, B)).outcome for B in ("0.15", "0.151")] for r in rates
    ]
    return [
        row("Fig. 2.1, (2.1), (2.3)", "the wall asks for b > KT/2 − B cos ωT at each frequency",
            f"200 N/m, 0.05 N·s/m, 200 frequencies: at most {off:.1g} N·s/m beside it", off < 1e-12),
        row("(2.2)", "the wall is discrete-time passive, and yet the sampled loop is passive for some "
        "values only",
            f"1000 N/m, 0.05 N·s/m on the paddle: {stiff}", stiff == "active"),
        row("(2.4)", "b > KT/2 + abs(B)", f"asked for: {float(verdict.required_damping):.4g} N·s/m",
            close(float(verdict.required_damping), k * T / 2 + b)),
        row("conclusion 1 of (2.4)", "some physical dissipation is essential", "as in section 1.1", True),
        row("conclusion 2 of (2.4)", "the achievable stiffness is proportional to the rate",
            f"B = 0.05 N·s/m at 1, 2, 4 kHz: {most[0]:g}, {most[1]:g}, {most[2]:g} N/m",
            close(most[1], 2 * most[0]) and close(most[2], 4 * most[0])),
        row("conclusion 3 of (2.4)", "the achievable virtual damping does not depend on the rate",
            f"b = 0.15 N·s/m at 1, 2, 4 kHz: 0.150 N·s/m {edges[0][0]}, 0.151 {edges[0][1]}, at each",
            all(edge == ["passive", "active"] for edge in edges)),
    ]  # fmt: skip


def _levitated() -> list[Row]:
    T, m = 1e-3, 1.0
    device = zw.Device(mass=1, damping=0, coulomb_friction=0, resolution=0, rate=1000, delay="0.001")
    found = zw.maps.stability_boundary(device, None, 0.001, points=2000)
    edge = found.isel(point=found["bounds"].values)
    best = int(edge["stiffness"].values.argmax())
    k, b = float(edge["stiffness"][best]), float(edge["virtual_damping"][best])
    radii = [_radius(part * k, b, m, T) for part in (0.999, 1.001)]
    passive = zw.check(device, zw.Wall(1, 1)).max_stiffness
    return [
        row("Fig. 2.2, (2.5)", "without the unilateral constraint there is a stability region in T²K/2m "
        "and TB/2m",
            f"it reaches up to T²K/2m = {T * T * k / 2 / m:.4f}, at TB/2m = {T * b / 2 / m:.4f}; a "
            "thousandth "
            f"softer or stiffer, the largest pole is {radii[0]:.5f} or {radii[1]:.5f}",
            radii[0] < 1 < radii[1]),
        row("Fig. 2.2", "it cannot be passive, for the device has no damping",
            "no stiffness is passive" if not passive else f"{float(passive):g} N/m are", not passive),
    ]  # fmt: skip


def _radius(k: float, b: float, m: float, T: float) -> float:
    """Of (2.5) on a mass: states x, v and the two readings before."""
    step = np.zeros((4, 4))
    force = -np.array([0, 0, k + b / T, -b / T])
    step[0] = np.array([1, T, 0, 0]) + T * T / 2 / m * force
    step[1] = np.array([0, 1, 0, 0]) + T / m * force
    step[2, 0] = step[3, 2] = 1
    return float(np.abs(np.linalg.eigvals(step)).max())


def _braking() -> list[Row]:
    device = zw.catalogue.device("haptic-paddle")
    wall, tap = zw.Wall(250), zw.operators.TypicalTouch()
    plain, braked = (_first_force(device, law, tap) for law in (wall, zw.render(wall, BrakingPulse())))
    return [
        row("section 2, braking pulse", "a pulse on contact raises the stiffness that is perceived",
            f"a typical touch on 250 N/m meets up to {plain:.2g} N in the first 3 ms, with the pulse "
            f"{braked:.2g} N",
            braked > plain, "of the force; what is perceived is not computed"),
    ]  # fmt: skip


def _first_force(device: zw.Device, law: object, hand: object) -> float:
    """The largest force in the first 3 ms of a contact [N]."""
    trace = zw.simulate(device, law, hand, 1.0)
    force = trace.actuator_force.values
    first = int(np.flatnonzero(trace.measured_position.values > 0)[0])
    return float(force[first : first + 4].max())


def _coupled() -> list[Row]:
    need = zw.coupling.coupling_condition(PADDLE, 200, "0.05").required_damping
    same = zw.check(PADDLE, zw.Wall(200, "0.05")).required_damping
    return [
        row("section 2, virtual coupling", "a discrete-time passive simulation behind a spring K and a "
        "damper B "
            "asks for what a wall of K and B does",
            f"200 N/m, 0.05 N·s/m: {float(need):.4g} as a coupling, {float(same):.4g} N·s/m as a wall "
            f"({drawn('coupling')})", close(float(need), float(same)),
            "without delay; with a delay a mass behind the coupling asks for more"),
    ]  # fmt: skip
