"""The lecture on the stability of kinesthetic haptic devices."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

import zwidth as zw
from papers.row import Row, close, drawn, row
from zwidth.loop.traces.measures import noticeable_differences
from zwidth.model.rendering import CrossingCorrection, HalfSamplePrediction, PassivityController
from zwidth.passivity.formulas.abbott_okamura import edge_crossing
from zwidth.passivity.formulas.diolaiti import admissible_speed, plane_point
from zwidth.show.plots.planes import has_plane

TITLE = "Lecture 10 of ME 327, Design and Control of Haptic Systems (Stanford University, spring 2020)"

SOURCE = (
    'Slides, "Kinesthetic haptic devices: stability"; they have titles and no numbers. '
    "The condition at ω = 0 is to be read as a limit, and it is sufficient only where H is stable."
)

PADDLE = zw.catalogue.device("haptic-paddle")
IDEAL = PADDLE.replace(resolution=0)
COARSE = PADDLE.replace(resolution="2.24 mm")


def rows() -> list[Row]:
    """Slide by slide."""
    return [*_conditions(), *_leaks(), *_plane(), *_remedies(), *_bouncing(), *_coupling()]


def _conditions() -> list[Row]:
    wall, T = zw.Wall(200, "0.05"), 1e-3
    need = float(zw.check(IDEAL, wall).required_damping)
    z = np.exp(1j * np.linspace(0.001, np.pi, 4000))
    h = 200 + 0.05 * (z - 1) / (T * z)
    written = float((T / 2 / (1 - z.real) * ((1 - 1 / z) * h).real).max())
    both = [float(zw.check(IDEAL, zw.Wall(200, b)).required_damping) for b in ("0.05", "-0.05")]
    return [
        row("sampled-data system example", "passive if and only if b exceeds a supremum over frequencies",
            f"H = 200 N/m and 0.05 N·s/m at 1 kHz: {need:.4g} N·s/m by `zw.check`, "
            f"{written:.4g} by the formula as written, on 4000 frequencies", close(need, written, 1e-6)),
        row("sampled-data system example", "of a virtual wall: b > KT/2 + abs(B)",
            f"B = ±0.05 N·s/m: {both[0]:.4g} and {both[1]:.4g} N·s/m",
            close(both[0], 0.15) and close(*both), "b = KT/2 + abs(B) is enough"),
    ]  # fmt: skip


def _leaks() -> list[Row]:
    k, step, count, T = 800.0, 2e-4, 9, 1e-3
    path = step * np.concatenate([np.arange(count + 1), np.arange(count - 1, -1, -1)])
    hand = zw.operators.PrescribedMotion(path)
    bare = zw.Device(mass="0.036", damping=0, sample_period="0.001")
    out = float(zw.simulate(bare, zw.Wall(k), hand, 2 * count * T).actuator_work[-1])
    part = out / (2 * count * k * step**2 / 2)
    limits = [float(zw.check(d, zw.Wall(100)).max_stiffness) for d in (PADDLE, COARSE)]
    paid = zw.simulate(bare.replace(damping=str(k * T / 2)), zw.Wall(k), hand, 2 * count * T).isel(time=-1)
    net = float(paid.hand_work - paid.kinetic_energy) / out
    gain = float(edge_crossing(COARSE, "107.2").energy)
    still = zw.check(COARSE, zw.Wall("107.1")).outcome
    return [
        row("detail of energy leak due to sampling", "the held staircase leaks ½K(vT)² in each sample",
            f"{part:.9f} of it, by simulation ({drawn('staircase')})", close(part, 1, 1e-9)),
        row("position quantization", "K ≤ min(2b/T, 2f_c/Δ)",
            f"the paddle of Abbott & Okamura: {limits[0]:.4g} N/m; its encoder 100 times coarser: "
            f"{limits[1]:.4g} N/m", close(limits[0], 300) and close(limits[1], 2 * 0.12 / 2.24e-3)),
        row("conceptual derivation, damping and sampling", "½K(vT)² ≤ b v² T: at K = 2b/T both are equal",
            f"what is left over after pressing and releasing: {abs(net):.1g} of the leak", abs(net) < 1e-9),
        row("conceptual derivation, Coulomb friction and quantization", "½KΔ² ≤ f_c Δ",
            f"coarse encoder: 107.1 N/m is {still}; on 107.2 N/m a step over an edge gains "
            f"{1e9 * gain:.2g} nJ", still == "passive" and gain > 0),
    ]  # fmt: skip


def _plane() -> list[Row]:
    beta, sigma = plane_point(PADDLE, 770)
    T, step = (float(PADDLE.exact(name)) for name in ("sample_period", "resolution"))
    speeds = [float(admissible_speed(PADDLE, 770, start)) * T / step for start in ("surface", "inside")]
    names = list(zw.catalogue.names())
    placed = sum(_has_place(name) for name in names)
    return [
        row("dimensionless stability plane", "β = b/(KT) and σ = f_c/(KΔ), both at least ½; below, a largest "
            "admissible velocity ξ̇",
            f"770 N/m: β = {float(beta):.3f}, σ = {float(sigma):.2f}, {plane_point(PADDLE, 770).region}; "
            "ξ̇ = "
            f"{speeds[0]:.2f} for a hand that starts at the surface, {speeds[1]:.2f} from anywhere "
            f"({drawn('plane')})", speeds[0] > speeds[1] > 0),
        row("where do commercial haptic devices stand?", "a diagram of devices (Diolaiti et al. 2006)",
            f"{placed} of the catalogue's {len(names)} devices has a place: of the others b, T, f_c or Δ is "
            "not published", None, "the numbers behind the diagram are not given"),
    ]  # fmt: skip


def _has_place(name: str) -> bool:
    try:
        return bool(has_plane(zw.catalogue.device(name)))
    except zw.InputError:
        return False


def _remedies() -> list[Row]:
    verdict = zw.check(PADDLE, zw.Wall(770))
    rate = next(a.text for a in verdict.advice if "rate" in a.text)
    faster, damped = PADDLE.replace(rate="2567 Hz"), PADDLE.replace(damping="0.385")
    outcomes = [zw.check(d, zw.Wall(770)).outcome for d in (faster, damped)]
    display = zw.Device(mass=1, damping=1, coulomb_friction=0, resolution=0, rate="1 kHz")
    wall = zw.Wall(30_000)
    laws = (wall, zw.render(wall, PassivityController(largest_damping="unlimited")))
    out = [
        1e3 * float(zw.simulate(display, law, zw.operators.ConstantForce(1.0), 1.2,
                                initial_position=-0.05, initial_velocity=0.2).actuator_work.max())
        for law in laws
    ]  # fmt: skip
    return [
        row("approach #1: respect the existing Z-width", "lower the stiffness until the wall is passive",
            f"770 N/m is {verdict.outcome}; the largest passive is {float(verdict.max_stiffness):.4g} N/m",
            zw.check(PADDLE, zw.Wall(verdict.max_stiffness)).outcome == "passive"),
        row("approach #2: change your hardware", "more damping, a higher rate, a finer encoder",
            f"for 770 N/m: {rate} or b to 0.385 N·s/m; both are then {outcomes[0]}",
            outcomes == ["passive", "passive"], "a finer encoder alone does nothing here"),
        row("approach #3: passivity observer and controller (Hannaford & Ryu 2002, Fig. 10)",
            "it acts briefly, and keeps the wall's energy positive",
            f"30 kN/m: {out[0]:.3g} mJ given out without, {max(out[1], 0):.2g} mJ with it "
            f"({drawn('passivity_controller')})", out[0] > 1 > out[1],
            "in this touch. Another hand takes energy out of the loop with the controller"),
    ]  # fmt: skip


def _bouncing() -> list[Row]:
    ball = zw.Device(mass=0.35, damping=0, sample_period=0.010)
    finger = zw.operators.Tracking([0.004], stiffness=500, damping=0, mass=0.006)
    known = {"finger_mass": 0.006, "finger_stiffness": 500, "finger_position": 0.004}
    wall = zw.Wall(5000)
    runs = {
        "original": (wall, 0.4),
        "prediction": (zw.render(wall, HalfSamplePrediction(**known)), 1.0),
        "correction": (zw.render(wall, CrossingCorrection(**known)), 1.0),
    }
    last = {}
    for name, (law, seconds) in runs.items():
        x = zw.simulate(
            ball, law, finger, seconds, initial_position=-0.02, points_per_sample=40
        ).position.values
        last[name] = -x[np.flatnonzero((x[1:-1] < x[:-2]) & (x[1:-1] <= x[2:])) + 1][-1] / 0.02
    said = {"original": "each bounce is higher than the last", "prediction": "the growth is bounded",
            "correction": "the rest is removed"}  # fmt: skip
    fits = {
        "original": last["original"] > 1,
        "prediction": last["prediction"] < 1,
        "correction": close(last["correction"], 1, 0.01),
    }
    return [
        row(f"bouncing ball simulation, {name} (Gillespie & Cutkosky 1996)", said[name],
            f"last bounce over the start: {last[name]:.3g} "
            f"({drawn('bouncing_ball' if name == 'original' else 'prediction')})", fits[name])
        for name in runs
    ]  # fmt: skip


def _coupling() -> list[Row]:
    best = zw.coupling.design_coupling(PADDLE, margin=0)
    lost = abs(noticeable_differences(300, 770))
    exact = Fraction(3, 20) * 2000
    return [
        row("approach #4: virtual coupling", "a spring and a damper between device and simulation keep any "
            "passive simulation passive",
            f"stiffest on the paddle: {float(best.stiffness):.4g} N/m, {float(best.damping):.4g} N·s/m "
            f"({drawn('coupling')})", close(float(best.stiffness), float(exact))),
        row("key point", "to be passive you are likely to lose some fidelity",
            f"300 in the place of 770 N/m is {lost:.1f} just-noticeable differences", lost > 1),
    ]  # fmt: skip
