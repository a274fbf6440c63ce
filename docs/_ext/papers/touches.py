"""Abbott & Okamura 2005, figures 8 to 11: their experiments, simulated."""

from __future__ import annotations

import numpy as np

import zwidth as zw
from papers.row import Row, drawn, row

PADDLE = zw.catalogue.device("haptic-paddle")
COARSE = PADDLE.replace(resolution="2.24 mm")
SLOW = COARSE.replace(sample_period="3 ms")
SHOWN = drawn("paddle_experiments")


def experiments() -> list[Row]:
    """The first mode, then the second."""
    return [*_bounce(), *_buzz(), *_decoupled()]


def _touch(stiffness: float, hand: object) -> tuple[int, float]:
    """(stops and turns, swing in the last quarter [mm])."""
    trace = zw.simulate(PADDLE, zw.Wall(stiffness), hand, 2.0)
    return int(trace.attrs["stops"]), 1e3 * float(np.ptp(trace.position.values[-500:]))


def _bounce() -> list[Row]:
    typical, malicious = zw.operators.TypicalTouch(), zw.operators.MaliciousTouch()
    soft = [_touch(300, hand) for hand in (typical, malicious)]
    hard = [_touch(770, hand) for hand in (typical, malicious)]
    dowel = zw.simulate(PADDLE, zw.Wall(770), zw.operators.Dowel(), 2.0)
    out = dowel.zwidth.energy.extracted
    return [
        row("Fig. 8", "300 N/m: neither a typical nor a malicious touch sustains a vibration; it takes "
        "several "
            "bounces to die out", f"{soft[0][0]} and {soft[1][0]} stops and turns, at the end a swing of "
            f"{max(s for _, s in soft):.1g} mm ({SHOWN})", soft[1][0] > 3 and max(s for _, s in soft) < 0.01),
        row("Fig. 9", "770 N/m: the finger cannot sustain it, but it is more underdamped; a dowel shows "
        "that the wall "
            "is active", f"{hard[1][0]} stops and turns, then a swing of {hard[1][1]:.1g} mm; the dowel "
            "takes out "
            f"{1e3 * out:.3g} mJ ({SHOWN})", hard[1][0] > soft[1][0] and hard[1][1] < 0.01 and out > 0),
    ]  # fmt: skip


def _changes(device: zw.Device, stiffness: float) -> tuple[int, float]:
    """(changes of force in the last second, swing there [µm]) under a push of 0.135 N."""
    trace = zw.simulate(device, zw.Wall(stiffness), zw.operators.SoftTouch(), 3.0)
    count = round(1 / trace.attrs["sample_period_s"])
    force, x = trace.actuator_force.values[-count:], trace.position.values[-count:]
    return int(np.count_nonzero(np.diff(force))), 1e6 * float(np.ptp(x))


def _buzz() -> list[Row]:
    found = {k: _changes(COARSE, k) for k in (240, 120, 90, 80)}
    told = ", ".join(f"{k} N/m: {found[k][0]}" for k in (240, 120, 80))
    why = "f_c may be less at the edge than the fitted one"
    return [
        row("Fig. 10", "encoder 100 times coarser: 240 and 120 N/m buzz, the stiffer one with more energy; "
        "80 N/m "
            "does not", f"changes of force per second: {told}; swings {found[240][1]:.2g} and "
            f"{found[120][1]:.2g} µm ({SHOWN})",
            min(found[240][0], found[120][0]) > 100 and found[80][0] == 0 and found[240][1] > found[120][1]),
        row("Fig. 11", "90 N/m is about the boundary: with effort it buzzes",
            f"90 N/m: {found[90][0]} changes of force per second; {zw.check(COARSE, zw.Wall(90)).outcome}",
            found[90][0] > 0, f"{why}: [what could explain it](theory.md#the-buzz-boundary-at-3-ms)"),
    ]  # fmt: skip


def _begins(device: zw.Device) -> float:
    """The softest wall that buzzes under a push of 0.135 N [N/m]."""
    k = np.arange(106.0, 122.0, 1.0)
    vary = {"environment.stiffness": k}
    batch = zw.simulation.simulate_batch(device, zw.Wall(1), zw.operators.SoftTouch(), 3.0, vary=vary)
    return float(k[np.argmax(batch.stops.values > 60)])


def _decoupled() -> list[Row]:
    stiffness = np.arange(540.0, 661.0, 10.0)
    vary = {"environment.stiffness": stiffness}
    limits = []
    for device in (PADDLE, COARSE):
        batch = zw.simulation.simulate_batch(device, zw.Wall(1), zw.operators.Dowel(), 4.0, vary=vary)
        limits.append(float(stiffness[np.argmax(batch.swing.values > 1e-3)]))
    change = 100 * abs(1 - limits[1] / limits[0])
    before, after = _changes(COARSE, 120), _changes(SLOW, 120)
    buzz = [_begins(device) for device in (COARSE, SLOW)]
    return [
        row("section IV-C", "the coarse encoder moves the first mode by about 5 %",
            f"dowel: from {limits[0]:.0f} to {limits[1]:.0f} N/m, {change:.0f} %", change < 10),
        row("section IV-C", "at 3 ms the boundary of the buzz moves by about 10 %",
            f"a push of 0.135 N: from {buzz[0]:g} N/m at 1 ms, {buzz[1]:g} N/m at 3 ms", buzz[0] != buzz[1],
            "[what could explain it](theory.md#the-buzz-boundary-at-3-ms)"),
        row("section IV-C", "at 3 ms the buzz is of lower frequency and larger",
            f"{after[0]} changes of force per second and {after[1]:.2g} µm, at 1 ms {before[0]} and "
            f"{before[1]:.2g} µm", after[0] < before[0] and after[1] > before[1]),
    ]  # fmt: skip
