"""
What a passivity controller does, and what it does not
======================================================

Hannaford & Ryu (2002) let software count the energy that a wall takes in from the
hand, and add just enough damping where the count falls below zero.  Their simulation
has a wall of 30 kN/m that is reached from 50 mm away.  Mass and sample rate are not
printed: 1 kg and 1 kHz are chosen here, and a hand that pushes with 1 N.  Their controller has no
limit; here that has to be asked for by its word.
"""

import matplotlib.pyplot as plt
import numpy as np

import zwidth as zw
from zwidth.model.rendering import PassivityController
from zwidth.show import plots

plt.rcParams.update(plots.LOOK)
display = zw.Device(mass=1, damping=1, coulomb_friction=0, resolution=0, rate="1 kHz")
wall = zw.Wall(stiffness=30_000)
unlimited = zw.render(wall, PassivityController(largest_damping="unlimited"))
push = zw.operators.ConstantForce(1.0)

figure, rows = plt.subplots(4, 2, sharex=True, figsize=(8, 7), layout="constrained")
for column, (title, law) in enumerate({"wall alone": wall, "with the controller": unlimited}.items()):
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
    "published observer": zw.render(
        zw.Wall(2500), PassivityController(observer="published", largest_damping="unlimited")
    ),
    "at most b, 0.8 N·s/m": zw.render(zw.Wall(2500), PassivityController()),
    "the same, afterwards": zw.render(zw.Wall(2500), PassivityController(observer="past")),
}.items():
    trace = zw.simulate(course, law, hand, 1.5, initial_position=-0.001)
    tail = np.ptp(trace.position.values[-500:])
    print(f"{name}: tail {1e3 * tail:.2g} mm, energy {-1e3 * float(trace.actuator_work.max()):.3g} mJ")

# %%
# A course says that the controller "absorbs exactly the net energy output (if any) measured" so far.
# With the observer of the past it does, for a hand that keeps its speed: what the wall gave in
# one sample is owed at its end, and absorbed by the end of the next.

ideal = zw.Device(mass="0.036", damping="0.15", coulomb_friction=0, resolution=0, rate="1 kHz")
steady = 2e-3 - 3e-4 * np.arange(10)
law = zw.render(zw.Wall(2000), PassivityController(observer="past", largest_damping="unlimited"))
leaving = zw.operators.PrescribedMotion(np.concatenate([[-1e-3], steady]))
trace = zw.simulate(ideal, law, leaving, 0.01)
gave = -2000 * np.maximum(trace.measured_position.values[:-1], 0) * np.diff(trace.position)
print("given by the wall in a sample [mJ]:", np.round(1e3 * gave[1:8], 3))
print("owed at its end [mJ]:              ", np.round(1e3 * trace.actuator_work.values[2:9], 3))

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
# Without a limit there is no end to it: a small move asks for a large force, which is held over a
# large move.  With the limit that is the default, b of the device, the controller gives out no more
# than the device's damping takes, whatever the hand does.

millimetre, micrometre = 1e-3, 1e-6
zigzag = np.tile([0.0, millimetre, millimetre + micrometre], 39)
bound = (2000 / 2 + 0.15 / 1e-3) * np.sum(np.diff(zigzag) ** 2)
for name, law in {
    "wall": zw.Wall(2000),
    "no limit": zw.render(zw.Wall(2000), PassivityController(largest_damping="unlimited")),
    "at most b": zw.render(zw.Wall(2000), PassivityController()),
}.items():
    trace = zw.simulate(ideal, law, zw.operators.PrescribedMotion(zigzag), 0.116)
    print(f"zigzag, {name}: {float(trace.actuator_work.max()):.3g} J come out; {bound:.3g} J at most with b")

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
