"""
Does a longer velocity window buy virtual damping?
==================================================

Virtual damping B needs a velocity, and a velocity is a difference of positions
over a window of N samples.  A longer window asks less damping of the device for
each unit of B, but where it is tightest moves down: it turns a buzz at 500 Hz
into a shake at 35 Hz, which a hand feels all the more.
"""

import matplotlib.pyplot as plt

import zwidth as zw
from zwidth.show import plots

plt.rcParams.update(plots.LOOK)
device = zw.Device(damping=2, coulomb_friction=0, resolution=0, rate=1000, delay=0)

# %%
# A damper of B = 1 N·s/m alone, so that the curve is the damping asked of the
# device per unit of B.  The marked tops are exact, not read off the curve.

figure, axes = plt.subplots(figsize=(6.4, 4), layout="constrained")
found = []
for samples, colour, style in ((1, "#0072B2", "-"), (5, "#D55E00", "--"), (20, "#009E73", "-.")):
    damper = zw.Wall(stiffness=0, damping=1, velocity_filter=zw.rendering.Window(samples))
    verdict = zw.check(device, damper, contact="kept")
    need, frequency = verdict.required_damping or 0.0, verdict.critical_frequency or 0.0
    found.append((samples, need, frequency))
    axes.plot(
        *verdict.curve(1000), style, color=colour, label=f"N = {samples}: {need:.3f} at {frequency:.0f} Hz"
    )
    axes.plot([frequency], [need], "o", color=colour, clip_on=False, zorder=5)
axes.axhline(0, color="#777777", lw=0.6)
axes.set(
    xlim=(0, 500), ylim=(-1.05, 1.9), xlabel="frequency ω/2π [Hz]", ylabel="required damping b per unit of B"
)
axes.set_title("Windows of N samples at 1 kHz")
axes.legend(loc="upper left")

# %%
# The numbers.

for samples, need, frequency in found:
    print(f"N = {samples:2d}: b ≥ {need:.3f} B, tightest at {frequency:.0f} Hz")
plt.show()
