"""
How much damping has my device?
===============================

A hand moves the haptic paddle about; a load cell and the encoder record it.  The obvious way
to b and f_c is to smooth the position, differentiate it twice and fit a line, as Abbott &
Okamura (2005) did.  But how much should one smooth?  The answer changes with the choice: what
is smoothed is no longer the motion that the force belongs to, least of all where it turns.  None
of the choices finds the damping that the device really has.

Means over smooth pulses need no derivative and no choice, and say how far they can be
trusted.
"""

import matplotlib.pyplot as plt
import numpy as np

import zwidth as zw
from zwidth.data.identification.device.published import identify_published
from zwidth.show import plots

plt.rcParams.update(plots.LOOK)

# %%
# One minute of a wandering hand.  The load cell of ±10 N has 0.1 N of noise and a zero that drifts by
# 0.1 N.

paddle = zw.catalogue.device("haptic-paddle")
rng = np.random.default_rng(4)
time = 1e-3 * np.arange(60_001)
waves = zip(rng.normal(size=12), rng.uniform(0.3, 3, 12), rng.uniform(0, 6.28, 12), strict=True)
path = np.sum([a * np.sin(2 * np.pi * f * time + p) for a, f, p in waves], axis=0)
path = 0.02 * path / path.std() - 1
hand = zw.operators.Tracking(path, stiffness=40, damping=0)
trace = zw.simulate(paddle, zw.Wall(1), hand, 60, initial_position=path[0])  # the wall is a metre away
force = trace["hand_force"].values + rng.normal(0, 0.1, time.size) + 0.1 * np.sin(time / 20)
log = zw.Log.from_arrays(
    time=time,
    position=trace["measured_position"].values,
    hand_force=force,
    resolution="22.4 um",
)

# %%
# Both methods, and a mass–damper model by the first.

found = zw.identify(log)
passes = np.unique(np.geomspace(1, 400, 14).round().astype(int))
published = [identify_published(log, passes=int(n)) for n in passes]
viscous = [identify_published(log, passes=int(n), model="viscous") for n in passes]
low, high = found.estimates["damping"].interval(0.95)

figure, axis = plt.subplots(figsize=(7.5, 4.4), layout="constrained")
axis.axhspan(low, high, color="#0072B2", alpha=0.25, label="means over pulses, 95 %")
axis.axhline(0.15, color="0.4", lw=1, label="the truth")
axis.plot(passes, [one.damping for one in published], "o-", color="#D55E00", ms=4, label="differentiated")
axis.plot(passes, [one.damping for one in viscous], "s--", color="#E69F00", ms=4, label="without $f_c$")
axis.set(xscale="log", ylim=(0, 0.55), xlabel="passes of the moving average", ylabel="damping b [N·s/m]")
axis.legend(loc="upper left", ncols=2)

# %%
# Which wall would each allow?  The largest passive stiffness is 2b/T.

best = min(published, key=lambda one: abs(one.damping - 0.15))
plt.show()
print(
    f"2b/T = 300 N/m; means over pulses: {2e3 * low:.0f} to {2e3 * high:.0f}; "
    f"differentiated: {2e3 * min(p.damping for p in published):.0f} to "
    f"{2e3 * max(p.damping for p in published):.0f}; nearest with {best.passes} passes"
)
