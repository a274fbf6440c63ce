"""
Which limit will my device meet first?
======================================

In the plane of β = b/(K T) and σ = f_c/(K Δ) a device is a straight line, and
stiffer walls lie further down and to the left.  It is passive as long as both
are at least ½.  Where the line leaves that region says what a hand will feel
first: through the left side the loop becomes unstable and bounces, through the
bottom, with a coarse encoder and little dry friction, it buzzes.
"""

import matplotlib.pyplot as plt

import zwidth as zw
from zwidth.passivity.formulas.diolaiti import plane_point
from zwidth.show import plots

plt.rcParams.update(plots.LOOK)

# %%
# A wheel, in torque and angle: 0.02 N·m·s/rad and 0.02 N·m of friction, 4096
# counts per turn, 1 kHz.

wheel = zw.Device(
    damping=0.02,
    coulomb_friction=0.02,
    resolution=0.001534,
    rate=1000,
    delay=0,
    motion="rotary",
    name="wheel",
)
figure, axes = plt.subplots(figsize=(5.8, 5), layout="constrained")
plots.draw_plane(axes, wheel, stiffness=30)

# %%
# The number.

verdict = zw.check(wheel, zw.Wall(stiffness=30))
beta, sigma = plane_point(wheel, 30)
print(f"β = {beta:.3f}, σ = {sigma:.3f}: {verdict.outcome}, {verdict.limit}")
print(f"largest passive stiffness: {verdict.max_stiffness:.4g} N·m/rad")
plt.show()
