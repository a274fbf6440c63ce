"""
Where does the energy come from?
================================

The picture that every lecture on virtual walls begins with (Colgate, Grafing,
Stanley & Schenkel 1993; Gillespie & Cutkosky 1996): the force is held from
sample to sample, so it lags the hand.  Going in it is too small, coming out too
large, and the triangles between the staircase and the line are energy that
nobody put in.  A guide presses the wall in and draws it out at constant speed;
the simulator's ledger gives the same joules.
"""

import matplotlib.pyplot as plt
import numpy as np

import zwidth as zw
from zwidth.show import plots

plt.rcParams.update(plots.LOOK)
stiffness, period, step, count = 1000.0, 0.001, 0.5e-3, 6  # N/m, s, m per sample, samples in
frictionless = zw.Device(mass=0.05, damping=0, sample_period=period)
path = step * np.concatenate([np.arange(count + 1), np.arange(count - 1, -1, -1)])
motion = zw.operators.PrescribedMotion(path)
trace = zw.simulate(frictionless, zw.Wall(stiffness), motion, 2 * count * period)

# %%
# With a speed v each sample leaks ½ K (v T)²: here 12 samples, in and out.

leak = float(trace.actuator_work[-1])
formula = 2 * count * stiffness * step**2 / 2
print(f"the actuator put in {1e6 * leak:.6g} µJ; 12 triangles of ½ K (vT)² are {1e6 * formula:.6g} µJ")

# %%
# The device's damping takes b v² T in each sample, and K = 2b/T is where both
# are equal.  At that damping the guide gets nothing, at half of it the wall pays:

for part in (1.0, 0.5):
    damped = frictionless.replace(damping=part * stiffness * period / 2)
    # at the very end the guide still holds the moving mass: its kinetic energy is not lost
    end = zw.simulate(damped, zw.Wall(stiffness), motion, 2 * count * period).isel(time=-1)
    net = float(end.hand_work - end.kinetic_energy)
    print(f"b = {part:g} K T/2: the guide put in {1e6 * net:+.4g} µJ in all")

# %%
# An encoder adds its own steps.  Its leak does not depend on the speed: going over
# one edge and back leaks up to K Δ²/2 each way, and only Coulomb friction pays.

quantized = frictionless.replace(resolution=1.3e-3)
coarse = zw.simulate(quantized, zw.Wall(stiffness), motion, 2 * count * period)

figure, axes = plt.subplots(1, 2, sharey=True, figsize=(7.6, 3.6), layout="constrained")
depth = np.linspace(0, step * count, 2001)[1:-1]
for row, run, title in zip(axes, (trace, coarse), ("the hold", "hold and encoder, Δ = 1.3 mm"), strict=True):
    x, force = run.position.values, run.actuator_force.values
    inward, outward = slice(0, count + 1), slice(count, 2 * count + 1)
    held_in = force[inward][np.searchsorted(x[inward], depth, side="right") - 1]
    held_out = force[outward][np.searchsorted(-x[outward], -depth, side="right") - 1]
    row.fill_between(1e3 * depth, held_in, held_out, color="#E69F00", alpha=0.25, lw=0, label="the leak")
    row.plot(
        [0, 1e3 * step * count],
        [0, stiffness * step * count],
        color="#777777",
        lw=1,
        label="the spring meant",
    )
    row.plot(1e3 * depth, held_in, color="#0072B2", label="going in")
    row.plot(1e3 * depth, held_out, color="#D55E00", label="coming out")
    row.set(title=title, xlabel="deflection [mm]")
axes[0].set_ylabel("force [N]")
axes[0].legend()

# %%
# The number: the area of the triangles, from the ledger.

print(f"energy leaked by the hold: {1e3 * leak:.4g} mJ, {leak / formula:.12f} of the formula")
plt.show()
