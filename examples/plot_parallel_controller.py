"""
A light mass in a stiff hand, and a parallel passivity controller
=================================================================

A display of admittance reads the hand's force and moves as a virtual body would.  It has the
opposite trouble of a wall: what is hard to render is not what is stiff but what is
light.  Here 50 g in a hand of 2000 N/m, with a sensor that reads the mean force of each millisecond.
"""

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr

import zwidth as zw
from zwidth.model.rendering import ParallelController
from zwidth.show import plots

plt.rcParams.update(plots.LOOK)
hand = zw.operators.Tracking(np.minimum(np.arange(4000) * 2e-5, 0.02), stiffness=2000, damping=0.2)


def touch(mass: str, controller: ParallelController | None = None) -> xr.Dataset:
    return zw.simulation.simulate_admittance(
        zw.simulation.VirtualBody(mass), hand, 4, sample_period="0.001", controller=controller
    )


traces = {
    "no controller": touch("0.05"),
    "published observer": touch(
        "0.05", ParallelController(observer="published", largest_mobility="unlimited")
    ),
    "sampled observer, no limit": touch("0.05", ParallelController(largest_mobility="unlimited")),
    "sampled observer": touch("0.05", ParallelController()),
}
figure, rows = plt.subplots(2, 1, sharex=True, figsize=(7, 5), layout="constrained")
for (name, trace), style in zip(traces.items(), ("-", "--", "-", "-"), strict=True):
    rows[0].plot(trace.time, 1e3 * trace.position, style, lw=1.2, label=name)
    rows[1].plot(trace.time, 1e6 * trace.hand_work, style, lw=1.2, label=name)
    rest = np.abs(trace.velocity[-200:]).max()
    print(f"{name}: energy {float(trace.hand_work.min()):.3g} J, last speed {float(rest):.2g} m/s")
rows[0].set(ylabel="position [mm]", ylim=(-10, 50), xlim=(0, 1.2))
rows[1].set(ylabel="taken from the hand [µJ]", xlabel="time [s]", ylim=(-300, 300))
rows[1].axhline(0, color="0.6", lw=0.6)
rows[1].legend()

# %%
# Without a controller the display gives out energy without end.  As it was published, the
# observer pairs a force with the velocity that follows it; for a body that is stepped implicitly
# it then counts what the body stores and loses, and the controller never acts.  Paired with
# the force that the velocity met, it acts.
#
# It takes the last force for the next one.  Without a limit it does harm where forces change within
# a sample: 10 g diverge faster with it, and a hand that turns in each sample doubles its gain in each.
# With T/(2M) at most, the default, both masses come to rest: more comes out at first, and then no more.

for name, controller in {
    "no controller": None,
    "no limit": ParallelController(largest_mobility="unlimited"),
    "controller": ParallelController(),
}.items():
    light = touch("0.01", controller)
    fastest, end = float(np.abs(light.velocity).max()), float(light.time[-1])
    print(
        f"10 g, {name}: {fastest:.2g} m/s at most, after {end:g} s {float(abs(light.velocity[-1])):.2g} m/s"
    )
print(f"stable masses: {zw.stability.stable_virtual_masses(2000, '0.2', '0.001')}")
point = zw.stability.stable_virtual_masses(2000, "0.2", "0.001", sensor="point")
assert point is not None
print(f"with a point sensor: above {1e3 * point[0]:g} g")
plt.show()
