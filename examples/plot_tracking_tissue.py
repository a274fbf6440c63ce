"""
Can the stiffness of a tissue be tracked while it is touched?
=============================================================

Appendix 2 of "A passivity criterion for real-time haptic simulation of viscoelastic soft
tissues" estimates μ0, μ1 and η1 while a tool touches the tissue, by recursive least squares
on five numbers.  A standard linear solid has three.  The published regression is that of the
solid times (1 + z⁻¹), and with (1 + c z⁻¹) for any c the same motion fits as well: there is a
line of answers, the estimate drifts along it, and equation (32) turns it into any solid.

Without the factor there are three numbers for three.  But the force is measured with noise,
and it stands on both sides of the equation: least squares is biased.  Instruments, numbers
that are like the force but know nothing of its noise, take the bias away.
"""

import matplotlib.pyplot as plt
import numpy as np

import zwidth as zw
from zwidth.show import plots

plt.rcParams.update(plots.LOOK)
T = 1e-3
time = T * np.arange(40_000)
position = 0.006 + 1e-3 * (3 * np.sin(4.4 * time) + np.sin(19.5 * time) + 0.5 * np.sin(71 * time))

# %%
# A tissue of 300 N/m beside 150 N/m that relaxes in 0.1 s; after 20 s its μ0 is 450 N/m.
# Forces of some 3 N are measured with 10 mN of noise.

before, after = (
    zw.tissue.force_response(zw.StandardLinearSolid(k, 150, 15), time, position) for k in (300, 450)
)
force = np.where(time < 20, before, after) + np.random.default_rng(1).normal(0, 0.01, time.size)

forgetting = 0.9995
start = (200, 200, 20)
tracks = {
    method: zw.tissue.RecursiveSolid(T, start, method=method, forgetting=forgetting, noise=0.01).track(
        position, force
    )
    for method in ("least-squares", "instrumental")
}
five = zw.tissue.track_five_parameters(position, force, T, forgetting=forgetting)

# %%
# Both have a memory of 2 s.  The first-order form has the stiffness by either method; the
# branch, which is seen only where the hand is quick, tells them apart.

figure, axes = plt.subplots(2, 1, figsize=(8, 5.6), sharex=True, layout="constrained")
truths = (np.where(time < 20, 300, 450), np.full(time.size, 15.0))
for row, name, truth in zip(axes, ("stiffness", "branch_damping"), truths, strict=True):
    row.plot(time, truth, color="0.6", lw=3, label="the tissue")
    row.plot(time[::20], five[name][::20], color="#D55E00", lw=0.8, label="five parameters, as published")
    for (method, track), colour in zip(tracks.items(), ("#009E73", "#0072B2"), strict=True):
        row.plot(time[::20], getattr(track, name)[::20], color=colour, lw=1.2, label=f"three, {method}")
axes[0].set(ylim=(-600, 900), ylabel="μ0 [N/m]")
axes[1].set(ylim=(-5, 30), ylabel="η1 [N·s/m]", xlabel="time [s]")
figure.legend(*axes[0].get_legend_handles_labels(), loc="outside upper left", ncols=2)


# %%
# The numbers: the mean of each estimate over the last 10 s; and how long after the change the
# instruments have the new stiffness within 5 %, for good.

print(f"{'':24}{'μ0':>8}{'μ1':>8}{'η1':>8}   (450, 150, 15)")
for method, track in tracks.items():
    print(f"{'three, ' + method:24}" + "".join(f"{part[-10_000:].mean():8.1f}" for part in track[:3]))
names = ("stiffness", "branch_stiffness", "branch_damping")
print(f"{'five parameters':24}" + "".join(f"{np.median(five[name][-10_000:]):8.1f}" for name in names))
wrong = np.abs(tracks["instrumental"].stiffness / 450 - 1) > 0.05
print(f"found again {T * np.flatnonzero(wrong)[-1] - 20:.1f} s after the change")
plt.show()
