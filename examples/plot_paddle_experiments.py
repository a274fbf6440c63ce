"""
What did the paddle of the paper do, and does the model do it too?
==================================================================

Abbott & Okamura (2005) tried their bound on a Haptic Paddle: a typical and a
malicious touch, a wooden dowel, an encoder made 100 times coarser, a slower
loop.  Here each experiment is simulated, and what the paper says stands
beside what the simulation gives.
"""

from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from numpy.typing import NDArray

import zwidth as zw
from zwidth.show import plots

plt.rcParams.update(plots.LOOK)
hands = zw.operators
paddle = zw.catalogue.device("haptic-paddle")
coarse = paddle.replace(resolution="2.24 mm")  # 100 of its counts
slow = coarse.replace(sample_period="3 ms")


def touch(device: zw.Device, stiffness: float, hand: hands.Operator, duration: float = 2.0) -> xr.Dataset:
    return zw.simulate(device, zw.Wall(stiffness), hand, duration)


def measured(trace: xr.Dataset) -> dict[str, float]:
    return zw.traces.compare_traces(trace).rows.popitem()[1]


# %%
# The first mode: 2b/T = 300 N/m.  The typical touch and the malicious one, fast
# and tuned to the wall, on 300 and on 770 N/m; then the dowel.

typical, malicious, dowel = hands.TypicalTouch(), hands.MaliciousTouch(), hands.Dowel()
first = {
    "typical, 300 N/m": touch(paddle, 300, typical),
    "malicious, 300 N/m": touch(paddle, 300, malicious),
    "typical, 770 N/m": touch(paddle, 770, typical),
    "malicious, 770 N/m": touch(paddle, 770, malicious),
    "dowel, 770 N/m": touch(paddle, 770, dowel),
}
print(zw.traces.compare_traces(first))

# %%
# The second mode: 2f_c/Δ = 107 N/m with the coarse encoder.  The malicious touch
# is now the softest: a push of 0.135 N, barely above the friction of 0.12 N.

soft = hands.SoftTouch()
second = {k: touch(coarse, k, soft, 3.0) for k in (240, 120, 90, 80)}
slower = {k: touch(slow, k, soft, 3.0) for k in (240, 120, 80)}


def buzz(trace: xr.Dataset) -> tuple[int, float]:
    """Force changes per second in the last second, and the swing there [µm]."""
    count = round(1 / trace.attrs["sample_period_s"])
    force, x = trace.actuator_force.values[-count:], trace.position.values[-count:]
    return int(np.count_nonzero(np.diff(force))), 1e6 * float(np.ptp(x))


for stiffness, trace in second.items():
    changes, swing = buzz(trace)
    print(f"{stiffness} N/m: {changes} force changes per second, {swing:.2g} µm")

# %%
# Where does each mode begin?  A push of constant force F over an encoder edge
# buzzes if it gets over it, F > f_c, and is thrown back, K Δ − F > f_c.  So a
# softer push buzzes earlier, and none below 2f_c/Δ.  The dowel's limit is found by
# trying every stiffness.

candidates = np.arange(250.0, 801.0, 10.0)


def dowel_limit(device: zw.Device) -> float:
    batch = zw.simulation.simulate_batch(
        device, zw.Wall(1), dowel, 4.0, vary={"environment.stiffness": candidates}
    )
    return float(candidates[np.argmax(batch.swing.values > 1e-3)])


def soft_limit(device: zw.Device, force: float) -> float:
    k = np.arange(80.0, 161.0, 1.0)
    hand = hands.SoftTouch(force=force)
    batch = zw.simulation.simulate_batch(device, zw.Wall(1), hand, 3.0, vary={"environment.stiffness": k})
    return float(k[np.argmax(batch.stops.values > 60)])


fine_limit, coarse_limit = dowel_limit(paddle), dowel_limit(coarse)
forces = (0.125, 0.135, 0.15)
limits = [soft_limit(coarse, force) for force in forces]
slow_limits = [soft_limit(slow, force) for force in forces]
slower_by = [100 * (a / b - 1) for a, b in zip(slow_limits, limits, strict=True)]
passive = zw.check(coarse, zw.Wall(90))

# %%
# The paper's statements, one by one.


def yes(agrees: bool) -> str:
    return "agrees" if agrees else "DIFFERS"


rows = {name: measured(trace) for name, trace in first.items()}
buzzes = {k: buzz(trace) for k, trace in second.items()}
slow_buzzes = {k: buzz(trace) for k, trace in slower.items()}
stops = {name: row["stops"] for name, row in rows.items()}
swings = {name: 1e3 * row["last_swing"] for name, row in rows.items()}
earlier = 100 * (fine_limit - coarse_limit) / fine_limit
table = [
    (
        "300 N/m: no sustained vibration, typical or malicious",
        f"swing at the end {swings['typical, 300 N/m']:.2g} and {swings['malicious, 300 N/m']:.2g} mm",
        yes(max(swings["typical, 300 N/m"], swings["malicious, 300 N/m"]) < 0.01),
    ),
    (
        "300 N/m: not overdamped, several bounces under the malicious touch",
        f"{stops['malicious, 300 N/m']:.0f} stops and turns; typical {stops['typical, 300 N/m']:.0f}",
        yes(stops["malicious, 300 N/m"] > 3 > stops["typical, 300 N/m"]),
    ),
    (
        "770 N/m: the finger cannot sustain, but is more underdamped",
        f"{stops['malicious, 770 N/m']:.0f} stops and turns, swing at the end "
        f"{swings['malicious, 770 N/m']:.2g} mm",
        yes(
            stops["malicious, 770 N/m"] > stops["malicious, 300 N/m"] and swings["malicious, 770 N/m"] < 0.01
        ),
    ),
    (
        "770 N/m: a typical touch is well behaved",
        f"{stops['typical, 770 N/m']:.0f} stops and turns; at 300 N/m {stops['typical, 300 N/m']:.0f}",
        yes(stops["typical, 770 N/m"] <= stops["typical, 300 N/m"] + 1),
    ),
    (
        "770 N/m: through a wooden dowel, clearly active",
        f"swing {swings['dowel, 770 N/m']:.3g} mm, growing; the hand got out "
        f"{1e3 * rows['dowel, 770 N/m']['energy_extracted']:.3g} mJ",
        yes(rows["dowel, 770 N/m"]["energy_extracted"] > 0),
    ),
    (
        "coarse encoder: buzz at 240 and 120 N/m, none at 80",
        ", ".join(f"{k}: {buzzes[k][0]} force changes/s" for k in (240, 120, 80)),
        yes(buzzes[240][0] > 100 and buzzes[120][0] > 100 and buzzes[80][0] == 0),
    ),
    (
        "coarse encoder: more energy in the buzz of the stiffer wall",
        f"swing {buzzes[240][1]:.2g} µm against {buzzes[120][1]:.2g} µm",
        yes(buzzes[240][1] > buzzes[120][1]),
    ),
    (
        "coarse encoder: 90 N/m at the boundary, with effort it buzzes",
        f"none: zwidth check says {passive.outcome}; a push of 0.125 N buzzes from {limits[0]:.0f} N/m",
        yes(passive.outcome != "passive"),
    ),
    (
        "an encoder 100 times coarser moves the first mode by about 5 %",
        f"dowel from {fine_limit:.0f} N/m, coarse {coarse_limit:.0f} N/m: {earlier:.0f} %",
        yes(abs(earlier) < 10),
    ),
    (
        "T = 3 ms moves the second mode by about 10 %",
        f"{', '.join(f'{k:.0f}' for k in slow_limits)} N/m against {', '.join(f'{k:.0f}' for k in limits)}: "
        f"{max(map(abs, slower_by)):.0f} %",
        yes(all(5 < abs(by) < 15 for by in slower_by)),
    ),
    (
        "T = 3 ms: lower frequency, larger amplitude",
        f"{slow_buzzes[120][0]} force changes/s and {slow_buzzes[120][1]:.2g} µm, "
        f"before {buzzes[120][0]} and {buzzes[120][1]:.2g} µm",
        yes(slow_buzzes[120][0] < buzzes[120][0] and slow_buzzes[120][1] > buzzes[120][1]),
    ),
]
for statement, simulated, verdict in table:
    print(f"{verdict:8} {statement}\n         simulated: {simulated}")

# %%
# Two statements differ, and both are about the boundary of the buzz.  At 90 N/m the model is
# passive, proved, so that no touch whatever buzzes; the paper's paddle did, with
# effort, and the paper suspects its friction model.  A buzz that ends between 80 and
# 90 N/m would need a friction of K Δ/2 at the edge:

needed = [k * 2.24e-3 / 2 for k in (80, 90)]
print(f"friction at the edge: {needed[0]:.3f} to {needed[1]:.3f} N, in the place of the fitted 0.12 N")

# %%
# And the paper's boundary moves with T, which neither 2f_c/Δ nor (F + f_c)/Δ contains.  In the
# model nothing makes it: not the finger's own spring, not a late force, not more or
# less damping, mass or friction.  What T changes is how large the buzz is.

step = np.arange(95.0, 161.0, 0.5)
SPRING = {"stiffness": 500.0, "speed": 0.002, "start": -0.001}  # reaches the edge with F
ways: dict[str, tuple[hands.Operator, dict[str, Any]]] = {
    "a push alone": (soft, {}),
    "a finger of 500 N/m": (hands.Finger(force=0.135 + 500 * 2.24e-3, **SPRING), {}),
    "a finger without damping": (hands.SoftTouch(damping=0.0), {}),
    "force 0.15 ms late, as the slowest rise": (soft, {"delay": "0.15 ms"}),
    "force 1 ms late": (soft, {"delay": "1 ms"}),
    "b doubled": (soft, {"damping": 0.3}),
    "m doubled": (soft, {"mass": 0.072}),
    "f_c = 0.10 N": (soft, {"coulomb_friction": 0.10}),
}


def begins(device: zw.Device, hand: hands.Operator, swing: float) -> float:
    """The softest wall on which the last second still swings by so much [N/m]."""
    batch = zw.simulation.simulate_batch(device, zw.Wall(1), hand, 3.0, vary={"environment.stiffness": step})
    found = batch.swing.values > swing
    return float(step[np.argmax(found)]) if found.any() else np.nan


for name, (hand, change) in ways.items():
    begin = [
        [begins(device.replace(**change), hand, swing) for device in (coarse, slow)] for swing in (1e-8, 1e-6)
    ]
    by = [100 * (late / soon - 1) for soon, late in begin]
    print(f"{name:40} {begin[0][0]:5.1f} N/m, at 3 ms {by[0]:+.0f} %; felt from 1 µm on {by[1]:+.0f} %")

# %%
# So if a hand feels only what swings by 1 µm and more, the boundary that it reports is 0 to 12 %
# *lower* at 3 ms, because the buzz there is larger.  The paper does not say in which direction
# its 10 % goes.
#
# The paper's own suspicion does better.  Let asperities bend: friction is a spring until it
# has bent by δ, and slips at f_c.  A small swing then only bends them and loses
# nothing.  At 3 ms the wall throws the handle back for longer, the swing is larger, and
# friction is more of what was fitted.


tried = np.arange(70.0, 131.0)
pushes, bends = np.array(forces), np.array([0.3e-6, 0.5e-6, 1e-6, 2e-6])


def changes_of_force(period: float) -> NDArray[np.float64]:
    """Of the last second of two, on every wall by every bend and push; semi-implicit Euler, 50 µs."""
    mass, drag, friction, count, dt = 0.042, 1.85, 0.12, 2.24e-3, 5e-5  # handle and finger
    shape = len(tried), len(bends), len(pushes)
    x, (v, z, wall, found) = np.full(shape, count - 5e-5), np.zeros((4, *shape))
    walls, bend = tried[:, None, None], bends[:, None]
    for i in range(40_000):
        if i % round(period / dt) == 0:
            before, wall = wall, np.maximum(0.0, walls * count * np.floor(x / count))
            found += (i >= 20_000) & (wall != before)
        v += dt / mass * (pushes * min(i * dt / 0.5, 1.0) - wall - friction / bend * z - drag * v)
        x += v * dt
        z = np.minimum(np.maximum(z + v * dt, -bend), bend)
    return np.asarray(found)


soon, late = (tried[np.argmax(changes_of_force(period) > 10, axis=0)] for period in (0.001, 0.003))
print("asperities bend by   push     boundary at 1 ms, at 3 ms")
for i, j in np.ndindex(soon.shape):
    by, both = 100 * (late[i, j] / soon[i, j] - 1), f"{soon[i, j]:.0f}, {late[i, j]:.0f} N/m"
    print(f"{1e6 * bends[i]:4.1f} µm              {pushes[j]} N   {both}: {by:+.0f} %")

# %%
# Asperities that bend by 0.3 to 1 µm move the boundary by 7 to 23 %, to stiffer walls at
# 3 ms, and at 1 ms bring it down to 86 to 109 N/m: *both* statements that differ come from one
# cause.  That is possible, not shown: nobody has measured the paddle below a micrometre.  And
# two plainer causes are as large: a hand that pushes with 25 mN more in one experiment than
# in the other, for (F + f_c)/Δ, and the stiffnesses that were tried, since from 80 to 90 N/m is 12 %.
#
# Friction that bends is not in the model of the bound: with it 2f_c/Δ is no proof of
# passivity any more, since the smallest motions lose nothing.  See :doc:`/theory`.

more = 0.1 * limits[1] * 2.24e-3
print(f"10 % of {limits[1]:.0f} N/m is {1e3 * more:.0f} mN of the push; from 80 to 90 N/m is {100 / 8:.0f} %")

# %%
# What the table rests on: the force of hand and dowel is not printed in the paper and
# is chosen (see :doc:`/operators`).  A dowel pressed with 3 N dies out on 770 N/m,
# one with 4 N grows; grip damping of 0.1 N·s/m quiets it.  The paper's load cell
# sees f_h, drawn here at the bottom as in its figures 10 and 11.

figure, axes = plt.subplots(2, 2, figsize=(8.2, 6.2), layout="constrained")
colours = iter(("#009E73", "#0072B2", "#E69F00", "#D55E00"))
for name in ("typical, 300 N/m", "malicious, 300 N/m", "malicious, 770 N/m", "dowel, 770 N/m"):
    row = axes[0, 0] if "300" in name else axes[0, 1]
    trace, colour = first[name].sel(time=slice(0, 0.8)), next(colours)
    row.plot(trace.time, 1e3 * trace.position, color=colour, lw=1.2, label=name.split(",")[0])
for row, title in zip(axes[0], ("300 N/m: it decays", "770 N/m: the dowel does not"), strict=True):
    row.axhspan(0, row.get_ylim()[1], color="0.5", alpha=0.12, lw=0)
    row.set(title=title, xlabel="time [s]", ylabel="position [mm]")
    row.legend(loc="lower right")
for trace, row, k in ((second[120], axes[1, 0], 120), (second[80], axes[1, 1], 80)):
    part = trace.sel(time=slice(0.9, 1.3))
    row.plot(
        part.time, part.actuator_force, color="#CC79A7", lw=0.9, label="actuator", drawstyle="steps-post"
    )
    row.plot(part.time, part.hand_force, color="#E69F00", lw=1.2, label="hand")
    title = "buzzes" if k == 120 else "is still"
    row.set(
        title=f"coarse encoder, {k} N/m: {title}", xlabel="time [s]", ylabel="force [N]", ylim=(-0.05, 0.4)
    )
    row.legend(loc="upper right")

# %%
# The number: how many of the paper's statements the model reproduces.

agreeing = sum(verdict == "agrees" for *_, verdict in table)
print(f"{agreeing} of {len(table)} statements agree; the others are the boundary at 90 N/m and at 3 ms")
plt.show()
