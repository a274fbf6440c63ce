"""
What does a fraction of a sample of delay cost?
===============================================

Between reading the encoder and switching the motor a computer needs time, most
often less than a sample.  Rounding that up to a whole sample is safe and gives
away much.  The exact condition for a spring and any delay (d + α) T is ::

    K ≤ (4b/T) / [2d + 1 + 2α + √((2d + 1)² + 8 α (d + 1))]
"""

from math import ceil

import matplotlib.pyplot as plt

import zwidth as zw
from zwidth.passivity.formulas.colgate_schenkel import spring_stiffness
from zwidth.show import plots

plt.rcParams.update(plots.LOOK)
b, period = 0.15, 0.001
paddle = zw.catalogue.device("haptic-paddle")

# %%
# The line is the formula; the circles are what the exact engine proves.

samples = [k / 100 for k in range(301)]
exact = [spring_stiffness(b, period, round(s * 1e-3, 9)) for s in samples]
rounded = [spring_stiffness(b, period, ceil(s) * period) for s in samples]
proved_at = [0, 0.3, 0.5, 0.8, 1, 1.5, 2, 2.7]
proved = [
    zw.check(paddle.replace(delay=round(s * 1e-3, 9)), zw.Wall(stiffness=100)).max_stiffness or 0
    for s in proved_at
]

figure, axes = plt.subplots(figsize=(6.4, 4), layout="constrained")
axes.plot(samples, rounded, "--", color="#D55E00", label="rounded up to whole samples")
axes.plot(samples, exact, color="#0072B2", label="exact")
axes.plot(proved_at, proved, "o", color="black", mfc="white", label="proved by the exact engine")
axes.set(
    xlim=(0, 3), ylim=(0, 320), xlabel="delay [samples of 1 ms]", ylabel="largest passive stiffness K [N/m]"
)
axes.set_title("Haptic Paddle: every part of a sample counts")
axes.legend()

# %%
# The number: 0.3 ms of computation, exactly and rounded up.

late = zw.check(paddle.replace(delay="0.0003"), zw.Wall(stiffness=100))
up = spring_stiffness(b, period, period)
print(f"with 0.3 ms: {late.max_stiffness:.4g} N/m; rounded up to 1 ms: {up:.4g} N/m")
plt.show()
