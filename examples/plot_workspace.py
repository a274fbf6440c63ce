"""
Which joint of a pantograph should be damped?
=============================================

A hand at the end of an arm feels the friction of the joints through the
Jacobian: in some places and directions much of it, in others little.  A wall
needs K T/2 everywhere, in every direction, so that the joints must have ::

    δ_m ⪰ Jᵀ (K T/2) J

The Haply 2diy with one joint that turns more easily than the other, read as if its encoders had no steps:
"""

import matplotlib.pyplot as plt

import zwidth as zw
from zwidth.show import plots

plt.rcParams.update(plots.LOOK)
wall, rate = zw.Wall(500), 1000
arm = zw.arms.built_in("haply-2diy", damping=(0.001, 0.004), resolution=0)
before = zw.workspace(arm, wall, rate=rate)
print(before.claim)

# %%
# What one joint alone would need, what both would need, and the arm with that much more in the first joint.

damped = arm.replace(damping=(0.001 + before.additions[0], 0.004))
after = zw.workspace(damped, wall, rate=rate)
print(after.claim)

# %%
# Strokes show the direction in which the margin is smallest; black is where it ends.

figure, axes = plt.subplots(1, 2, figsize=(10, 3.3), layout="constrained")
plots.draw_workspace(axes[0], before)
plots.draw_workspace(axes[1], after)
axes[0].set_title(f"as it is: {before.outcome}")
axes[1].set_title(f"the first joint damped: {after.outcome}")

# %%
# The number: what the first joint needs, and what each would need if both got the same.

print(
    f"{before.additions[0] * 1000:.3g} mN·m·s/rad more in the first joint, "
    f"or {before.addition_to_all * 1000:.3g} in both"
)
plt.show()
