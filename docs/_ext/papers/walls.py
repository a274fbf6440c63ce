"""Abbott & Okamura 2005: the conditions and their figures; the experiments are in `touches`."""

from __future__ import annotations

import numpy as np

import zwidth as zw
from papers.row import Row, close, drawn, row
from papers.touches import experiments
from zwidth.passivity.formulas.abbott_okamura import edge_crossing, fast_press, linear_worst_case, worst_case

TITLE = "Effects of position quantization and sampling rate on virtual-wall passivity (Abbott & Okamura 2005)"

SOURCE = (
    "Slips: (16) and (17) print Λ for Δ; the index of the compression prints ẋ₂² for ẋ²; "
    '"Fig. 8 shows that system passivity may be a good predictor" means Fig. 9.'
)

PADDLE = zw.catalogue.device("haptic-paddle")
COARSE = PADDLE.replace(resolution="2.24 mm")


def rows() -> list[Row]:
    """Figure by figure; numbers of the text stand with the figure that they belong to."""
    return [*_model(), *_bound(), *_counterexamples(), *_discussion(), *_device(), *experiments(), _stretch()]


def _model() -> list[Row]:
    hands = (zw.operators.Finger(), zw.operators.Dowel(), zw.operators.MaliciousTouch())
    traces = [zw.simulate(PADDLE, zw.Wall(300), hand, 1.0) for hand in hands]
    out = max(trace.zwidth.energy.extracted for trace in traces)
    inside = [trace.measured_position.values for trace in traces]
    forces = [trace.commanded_force.values for trace in traces]
    step = float(PADDLE.exact("force_resolution"))
    off = (
        max(float(np.abs(f - 300 * np.maximum(x, 0)).max()) for f, x in zip(forces, inside, strict=True))
        / step
    )
    short = [(t.position.values - t.measured_position.values) / 22.4e-6 for t in traces]
    low, high = min(map(np.min, short)), max(map(np.max, short))
    return [
        row("Fig. 1", "a wall that is passive is stable in every passive hand",
            f"300 N/m in a finger, a dowel and a malicious touch: {1e3 * out:.2g} mJ taken out", out == 0),
        row("Fig. 2, (2)", "force held over a sample, K times the position that the encoder reads, no pull",
            f"the simulated force is beside that by {off:.3f} steps of the converter at most",
            off < 0.500001),
        row("Fig. 3", "the encoder reads low by some part of Δ",
            f"by {low:.3f} to {high:.3f} Δ in these touches", low >= -1e-9 and high <= 1 + 1e-9),
    ]  # fmt: skip


def _bound() -> list[Row]:
    fine, coarse = (float(zw.check(d, zw.Wall(100)).max_stiffness) for d in (PADDLE, COARSE))
    dry = float(PADDLE.exact("coulomb_friction") * 2 / PADDLE.exact("resolution"))
    nominal = PADDLE.replace(resolution="0.001")
    steps = [k * 1e-4 for k in range(1, 41)]
    release, press = ([float(worst_case(nominal, 200, s * x)) for x in steps] for s in (1, -1))
    lines = [float(linear_worst_case(nominal, 200, s * x)) for s in (1, -1) for x in steps]
    above = all(j >= line for j, line in zip([*release, *press], lines, strict=True))
    larger = all(abs(a) >= abs(b) for a, b in zip(release, press, strict=True))
    beyond = [float(worst_case(PADDLE, 770, s * 1.1e-3)) for s in (1, -1)]
    return [
        row("(3)", "passive if and only if K ≤ min(2b/T, 2f_c/Δ): 300 and 10 700 N/m; encoder 100 times "
            "coarser: 107 N/m", f"{fine:.4g} and {dry:.5g} N/m; coarser: {coarse:.4g} N/m",
            close(fine, 300) and round(dry, -2) == 10_700 and round(coarse) == 107),
        row("Fig. 4", "below 2b/T: J* lies above its lines; that of release is the larger",
            f"200 N/m, encoder of 1 mm: {'so' if above and larger else 'not so'} at {len(lines)} steps "
            f"({drawn('worst_case')})", above and larger),
        row("Fig. 5", "beyond 2b/T: for a large enough step J* is negative both ways",
            f"770 N/m, 1.1 mm: {1e6 * beyond[0]:.0f} µJ out, {1e6 * beyond[1]:.0f} µJ in "
            f"({drawn('worst_case')})",
            max(beyond) < 0),
    ]  # fmt: skip


def _counterexamples() -> list[Row]:
    press, cross = fast_press(PADDLE, 301), edge_crossing(COARSE, 120)
    counts = round(float(press.positions[1]) / 22.4e-6)
    replayed = [
        _gain(PADDLE, 301, press.positions, float(press.energy)),
        _gain(COARSE, 120, cross.positions, float(cross.energy)),
    ]
    return [
        row("section III-C, first example", "K > 2b/T: some n encoder counts in one sample and back take "
        "energy out",
            f"301 N/m: n = {counts}, at {press.peak_speed:.0f} m/s; {1e6 * float(press.energy):.2g} µJ, "
            f"{replayed[0]:.6f} of it by simulation", replayed[0] > 0.999 and counts > 10_714,
            "n must exceed f_c/(Δ (K/2 − b/T))"),
        row("section III-C, second example", "K > 2f_c/Δ: a small step over an edge and back takes energy "
        "out",
            f"coarse encoder, 120 N/m: {1e6 * float(cross.energy):.2g} µJ, {replayed[1]:.6f} of it by "
            f"simulation ({drawn('buzz_or_bounce')})", replayed[1] > 0.999),
    ]  # fmt: skip


def _gain(device: zw.Device, stiffness: float, positions: object, energy: float) -> float:
    """What the hand gets from the motion in a simulation, over what the formula says."""
    x = [float(p) for p in positions]  # type: ignore[attr-defined]
    hand = zw.operators.PrescribedMotion(x)
    trace = zw.simulate(device, zw.Wall(stiffness), hand, 2e-3, amplifier=zw.amplifiers.Ideal())
    end = trace.isel(time=-1)
    return float(end.kinetic_energy - end.hand_work) / energy


def _discussion() -> list[Row]:
    dry = zw.check(PADDLE.replace(coulomb_friction=0), zw.Wall(1)).outcome
    light, heavy = (
        float(zw.check(PADDLE.replace(mass=m), zw.Wall(1)).max_stiffness) for m in ("1 g", "10 kg")
    )
    speeds = np.linspace(0, 1, 500)
    sticky = 0.12 + 0.15 * speeds + 0.08 * np.exp(-speeds / 0.01) + 0.1 * speeds**2
    above = bool((sticky >= 0.12 + 0.15 * speeds).all())
    passive = zw.check(PADDLE, zw.Wall(300)).outcome
    return [
        row("section III-D", "without Coulomb friction no wall behind an encoder is passive", f"1 N/m: {dry}",
            dry == "active"),
        row("section III-D", "the mass plays no part in the bound", f"1 g: {light:g}, 10 kg: {heavy:g} N/m",
            light == heavy),
        row("Fig. 6", "friction that is nowhere less than f_c + b v, such as stiction, leaves the wall "
        "passive",
            f"stiction of 0.20 N and friction that grows with v² take {'no less' if above else 'less'} at "
            f"{len(speeds)} speeds than the line with which 300 N/m is {passive}", above and passive ==
            "passive"),
    ]  # fmt: skip


def _device() -> list[Row]:
    numbers = {
        k: float(v.value)
        for k, v in zw.catalogue.entry("haptic-paddle").values.items()
        if v.value is not None
    }
    step = 300 * numbers["resolution"] / numbers["force_resolution"]
    slope = numbers["supply_voltage"] / numbers["motor_inductance"]
    rise = 1e3 * numbers["current_limit"] / slope
    viscous = 2 * 0.41 / numbers["sample_period"]
    wrong = zw.check(PADDLE, zw.Wall(round(viscous))).outcome
    return [
        row("Fig. 7, section IV-B", "at 300 N/m force is 13 times finer than position; current rises by 21 "
        "800 A/s, "
            "0.15 ms to the full 3.3 A", f"{step:.1f} times; {slope:.0f} A/s, {rise:.3f} ms",
            round(step) == 13 and round(slope, -2) == 21_800 and round(rise, 2) == 0.15),
        row("section IV-B", "fitted without Coulomb friction, b = 0.41 N·s/m would promise 820 N/m, nearly "
        "three "
            "times too much", f"{viscous:.0f} N/m, which is {wrong} on the paddle "
            f"({drawn('identify_a_device', 'the same on a simulated log')})", wrong == "active"),
    ]  # fmt: skip


def _stretch() -> Row:
    T, count = 1e-3, 20
    ways = (np.linspace(0, 1, count + 1), np.clip(np.linspace(0, 2, count + 1), 0, 1))
    bare = PADDLE.replace(resolution=0)
    lost = []
    for way in ways:
        hand = zw.operators.PrescribedMotion(1e-3 * way - 0.01)
        end = zw.simulate(bare, zw.Wall(1), hand, count * T).isel(time=-1)
        lost.append((float(end.viscous_loss), float(end.coulomb_loss)))
    share = lost[0][0] / lost[1][0]
    return row(
        "Fig. 12, appendix", "a motion stretched over its rest loses T'/T of the viscous loss, as much by "
        "Coulomb "
        "friction", f"rest for half of the time: {share:.6f} of the one, {lost[0][1] / lost[1][1]:.6f} of "
        "the other",
        close(share, 0.5, 1e-6) and close(*(c for _, c in lost), 1e-6),
        "[with two words changed](theory/available-storage.md#the-least-that-friction-takes)",
    )  # fmt: skip
