"""
Two arms over a bad link
========================

Half of the packets are lost, in bursts, and the rest comes 20 to 30 ms late.  Ports of six kinds join
the same two arms, all as stiff as each other: which follow, and from which can two hands take energy?
"""

import matplotlib.pyplot as plt
import numpy as np

import zwidth as zw
from zwidth.show import plots
from zwidth.show.plots import draw_links

plt.rcParams.update(plots.LOOK)

arm = zw.Device(
    name="an arm",
    mass="50 g",
    damping="0.15 N*s/m",
    coulomb_friction="20 mN",
    resolution="22.4 um",
    rate="1 kHz",
    delay=0,
)
link = zw.links.Schedule(delay="20 ms", jitter="10 ms", loss=0.5, burst=4)
print(zw.links.check(zw.links.WavePort(arm)))

found = zw.links.compare(arm, schedule=link)
print(found)
draw_links(plt.figure(figsize=(9.6, 6), layout="constrained"), found)
plt.show()

# %%
# Waves of the textbook, sampled as they stand, need no hand: a push of 50 ms sets arms of 0.1 kg going that
# are joined by waves of 5 N·s/m, and they do not stop.

heavy = arm.replace(mass="0.1 kg", coulomb_friction=0, resolution=0)
push = zw.operators.RecordedForce(np.r_[np.full(50, 0.1), np.zeros(1950)])
for late in (2, 5, 10, 20):
    fastest = {}
    for kind in (zw.links.NaiveWaves, zw.links.WavePort):
        port = kind(heavy, impedance=5)
        trace = zw.links.simulate(port, port, zw.links.Schedule(delay=late / 1000), push, None, 2)
        fastest[kind] = float(np.abs(trace["velocity"].values).max())
    print(f"{late} samples late: " + ", ".join(f"{kind.title} {v:.2g} m/s" for kind, v in fastest.items()))
