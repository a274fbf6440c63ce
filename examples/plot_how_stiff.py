"""
What stiffness is safe for my device?
=====================================

A spring wall on the Haptic Paddle of Abbott & Okamura (2005): b = 0.15 N·s/m of
viscous friction and f_c = 0.12 N of Coulomb friction, an encoder of 22.4 µm,
1 kHz.  Two limits hold at once, 2b/T and 2f_c/Δ.  At 1 kHz the first binds, and
a faster computer helps, until the encoder takes over.
"""

import matplotlib.pyplot as plt

import zwidth as zw
from zwidth.passivity.formulas.abbott_okamura import abbott_okamura_stiffness
from zwidth.show import plots

plt.rcParams.update(plots.LOOK)
paddle = zw.catalogue.device("haptic-paddle")
wall = zw.Wall(stiffness=300)

# %%
# The two limits are formulas; the circles are the largest stiffness that the
# exact engine proves at each rate, without using them.

rates = [300 * 10 ** (k / 20) for k in range(53)]
limits = [abbott_okamura_stiffness(0.15, 0.12, 22.4e-6, 1 / rate) for rate in rates]
proved_at = [500, 1000, 3000, 10_000, 30_000, 100_000]
proved = [zw.check(paddle.replace(rate=rate), wall).max_stiffness or 0 for rate in proved_at]

figure, axes = plt.subplots(figsize=(6.4, 4), layout="constrained")
passive = [min(limit) for limit in limits]
axes.fill_between(rates, 50, passive, color="#009E73", alpha=0.15, lw=0)
axes.plot(rates, [limit.sampling for limit in limits], color="#0072B2", label="2b/T: sampling")
axes.plot(rates, [limit.quantization for limit in limits], "--", color="#D55E00", label="2f$_c$/Δ: encoder")
axes.plot(proved_at, proved, "o", color="black", mfc="white", label="proved by the exact engine")
axes.text(1200, 120, "passive", color="#00664A")
axes.set(xscale="log", yscale="log", xlim=(rates[0], rates[-1]), ylim=(50, 40_000))
axes.set(
    xlabel="sample rate 1/T [Hz]", ylabel="stiffness K [N/m]", title="Haptic Paddle: safe below both lines"
)
axes.legend(loc="lower right")

# %%
# The number: what this paddle renders at its 1 kHz.

verdict = zw.check(paddle, wall)
print(f"largest passive stiffness at 1 kHz: {verdict.max_stiffness:g} N/m ({verdict.limit})")
plt.show()
