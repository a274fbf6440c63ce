"""
How stiff may a wall be if I know the hand?
===========================================

A passive wall is safe in every hand; on the haptic paddle that ends at 300 N/m.
A stiffer one may still come to rest in a given hand, which adds a little mass and takes
energy out.  This page draws which walls are stable in a hand that is known, as long as
contact is kept, and what one sample of delay costs.
"""

import matplotlib.pyplot as plt

import zwidth as zw
from zwidth.show import plots

plt.rcParams.update(plots.LOOK)

device = zw.catalogue.device("haptic-paddle")
hands = {
    "no hand": (None, "#0072B2"),
    "dowel": (zw.operators.Dowel(force=1), "#CC79A7"),
    "finger": (zw.operators.Finger(), "#D55E00"),
}

# %%
# Nobody's hand is one set of numbers.  These walls are proved for every hand of up to 20 g, 1000 N/m and
# 3 N·s/m, without delay; 0.4 % above them one of these hands is shaken.

person = zw.stability.HandImpedance(mass=(0, 0.02), stiffness=(0, 1000), damping=(0, 3))
robust = zw.maps.robust_boundary(device, person, (3, 69), points=12)

# %%
# Each curve holds the walls with poles on the unit circle; below it all disturbances die out.
# Solid without delay, dashed with one sample; dots: the range of hands.

figure, axes = plt.subplots(figsize=(6.2, 4.4), layout="constrained")
for name, (hand, colour) in hands.items():
    for delay, style in ((0, "-"), (0.001, "--")):
        found = zw.maps.stability_boundary(device, hand, delay, points=2000)
        edge = found.isel(point=found["bounds"].values & (found["stiffness"].values > 0))
        text = name if delay == 0 else None
        axes.plot(edge["virtual_damping"], edge["stiffness"] / 1000, style, color=colour, label=text)
axes.plot(robust["virtual_damping"], robust["guaranteed"] / 1000, "k.", label="every hand in a range")
axes.set_xlim(0, 95)
axes.set_ylim(0, 35)
axes.set_xlabel("virtual damping B [N·s/m]")
axes.set_ylabel("stiffness K [kN/m]")
axes.legend(loc="upper right")

# %%
# The number, for a wall with a little virtual damping. The finger's damper does what
# the device lacks; the dowel, which has none, allows next to nothing more than an empty handle.

limits = [
    f"{name} {zw.stability.coupled_stability(device, zw.Wall(100, 0.5), hand).max_stiffness:.0f} N/m"
    for name, (hand, _) in hands.items()
]
print(f"with B = 0.5 N·s/m: {', '.join(limits)}")
plt.show()
