"""
What a passivity controller does, and what it does not
======================================================

Hannaford & Ryu (2002) let software count the energy that a wall takes in from the
hand, and add just enough damping where the count falls below zero.  Their simulation
has a wall of 30 kN/m that is reached from 50 mm away.  Mass and sample rate are not
printed: 1 kg and 1 kHz are chosen here, and a hand that pushes with 1 N.
"""

import matplotlib.pyplot as plt
import numpy as np

import zwidth as zw
from zwidth import plots
from zwidth.rendering import PassivityController

plt.rcParams.update(plots.LOOK)
display = zw.Device(mass=1, damping=1, coulomb_friction=0, resolution=0, rate="1 kHz")
wall = zw.Wall(stiffness=30_000)
controlled = zw.render(wall, PassivityController())
push = zw.operators.ConstantForce(1.0)

figure, rows = plt.subplots(4, 2, sharex=True, figsize=(8, 7), layout="constrained")
for column, (title, law) in enumerate({"wall alone": wall, "with the controller": controlled}.items()):
    trace = zw.simulate(display, law, push, 1.2, initial_position=-0.05, initial_velocity=0.2)
    added = trace.commanded_force - wall.stiffness * np.maximum(trace.measured_position, 0)
    shown = {
        "position [mm]": 1e3 * trace.position,
        "force [N]": trace.actuator_force,
        "energy taken in [J]": -trace.actuator_work,
        "controller [N]": added,
    }
    for axes, (name, values) in zip(rows[:, column], shown.items(), strict=True):
        axes.plot(trace.time, values, lw=1.2)
        axes.axhline(0, color="0.6", lw=0.6)
        axes.set_ylabel(name)
    rows[0, column].set_title(title)
    rows[-1, column].set_xlabel("time [s]")
    print(f"{title}: the wall's energy falls to {-1e3 * float(trace.actuator_work.max()):.3g} mJ")

# %%
# The controller acts briefly, as in their Fig. 10, and the energy stays where it should.
# Which force belongs to which move matters: behind a hold, a force acts on the move that
# follows the sample.  The observer as it was published pairs it with the move before.
# For a held spring that counts the leak as dissipation, and sees nothing at all.
#
# A public course has a plant on which this was measured, with 40 Euler steps in each
# sample: the tail of a touch is 1.66 mm peak to peak without a controller and 0.08 mm
# with one of at most 0.8 N·s/m, and the observer falls to −17.6 mJ.

course = zw.Device(
    mass="0.04",
    damping="0.8",
    coulomb_friction=0,
    resolution="61.36 um",
    rate="1 kHz",
    force_limit="2 N",
)
hand = zw.operators.Tracking([0.003], stiffness=400, damping=0)
for name, law in {
    "alone": zw.Wall(2500),
    "published observer": zw.render(zw.Wall(2500), PassivityController(observer="published")),
    "at most 0.8 N·s/m": zw.render(zw.Wall(2500), PassivityController(largest_damping="0.8")),
}.items():
    trace = zw.simulate(course, law, hand, 1.5, initial_position=-0.001)
    tail = np.ptp(trace.position.values[-500:])
    print(f"{name}: tail {1e3 * tail:.2g} mm, energy {-1e3 * float(trace.actuator_work.max()):.3g} mJ")

# %%
# The controller takes the last move for the next one.  A hand that turns back is paid
# twice: it meets a push where it goes out and a pull where it comes in.  On the haptic
# paddle a wall of 300 N/m is passive, proved; with a controller it no longer is.

paddle = zw.catalogue.device("haptic-paddle")
print(f"300 N/m: {zw.check(paddle, zw.Wall(300)).outcome}")
there_and_back = zw.operators.PrescribedMotion(np.tile([0.0, 0.7e-3], 12))
figure, rows = plt.subplots(3, 1, sharex=True, figsize=(6.4, 5), layout="constrained")
for label, law in {
    "wall": zw.Wall(300),
    "with a controller of at most 0.3 N·s/m": zw.render(
        zw.Wall(300), PassivityController(largest_damping="0.3")
    ),
}.items():
    trace = zw.simulate(
        paddle, law, there_and_back, 0.023, amplifier=zw.amplifiers.Ideal(), points_per_sample=8
    )
    rows[0].plot(1e3 * trace.time, 1e3 * trace.position, lw=1.2)
    rows[1].plot(1e3 * trace.time, trace.actuator_force, lw=1.2, label=label)
    rows[2].plot(1e3 * trace.time, 1e6 * (trace.kinetic_energy - trace.hand_work), lw=1.2)
    per_round = float(trace.hand_work[-17] - trace.hand_work[-1]) * 1e6
    print(f"{label}: the hand gets {per_round:.3g} µJ from each round, after friction")
rows[0].set_ylabel("position [mm]")
rows[1].set_ylabel("force [N]")
rows[1].set_ylim(top=0.75)
rows[1].legend(loc="upper right", ncols=2)
rows[2].set_ylabel("hand's gain [µJ]")
rows[2].set_xlabel("time [ms]")

# %%
# What is proved is less: a controller that never adds more damping than α is covered by
# the proof of a damped wall where b ≥ KT/2 + α.  Beyond 2b/T no α is.

bench = zw.compare(
    paddle,
    zw.Wall(150),
    {
        f"α = {a} N·s/m": zw.render(zw.Wall(150), PassivityController(largest_damping=a))
        for a in ("0.07", "0.08")
    },
)
for name, why in bench.evidence.items():
    print(f"{name}: {bench.scores.status.sel(law=name).item()}; {why}")
plt.show()
