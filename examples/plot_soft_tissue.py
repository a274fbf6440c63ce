"""
How stiff may virtual soft tissue be?
=====================================

Tissue that relaxes, a standard linear solid, is easier to render than a spring
with a damper beside it (Kelvin–Voigt).  This is figure 4 of "A passivity
criterion for real-time haptic simulation of viscoelastic soft tissues"
recomputed: a PHANToM with b = 0.27 N·s/m, a series spring of μ1 = 10 N/m.
The largest parallel stiffness by backward Euler is ::

    μ0 ≤ 2b/T − 2 μ1 η1/(2 η1 + μ1 T),      K ≤ 2 (b − |B|)/T  for Kelvin–Voigt

Every point is computed twice, by these formulas and by the exact engine.  What the
paper measured lies ten times higher: :doc:`plot_motorized_guide`.
"""

from math import nan

import matplotlib.pyplot as plt

import zwidth as zw
from zwidth.show import plots

plt.rcParams.update(plots.LOOK)
b, branch = 0.27, 10
phantom = zw.catalogue.device("phantom")


def solid(eta: float, period: float) -> tuple[float, float]:
    """(formula, exact engine) of the standard linear solid [N/m]."""
    formula = 2 * b / period - 2 * branch * eta / (2 * eta + branch * period)
    law = zw.StandardLinearSolid(stiffness=100, branch_stiffness=branch, branch_damping=eta)
    return formula, zw.check(phantom.replace(sample_period=period), law).max_stiffness or nan


def kelvin_voigt(damping: float, period: float) -> tuple[float, float]:
    """(formula, exact engine) of the spring and damper [N/m]; nan where no stiffness is passive."""
    formula = 2 * (b - damping) / period
    law = zw.Wall(stiffness=100, damping=damping)
    exact = zw.check(phantom.replace(sample_period=period), law).max_stiffness or nan
    return (formula, exact) if formula >= 0 else (nan, exact)


# %%
# (a) against the damping of the environment at 1 ms; (b) against the sample
# period at 0.5 N·s/m.  There a Kelvin–Voigt wall has no passive stiffness at
# all: its damping alone asks for more than the device has.

dampings = [round(0.01 * k, 2) for k in range(1, 28)]
periods = [round(0.0005 + 0.0001 * k, 5) for k in range(46)]
curves = {
    "a": ([solid(eta, 0.001) for eta in dampings], [kelvin_voigt(damping, 0.001) for damping in dampings]),
    "b": ([solid(0.5, period) for period in periods], [kelvin_voigt(0.5, period) for period in periods]),
}

figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.8), layout="constrained")
for axes, name, x in ((left, "a", dampings), (right, "b", [1000 * period for period in periods])):
    relaxing, stiff = curves[name]
    every = len(x) // 8
    axes.plot(x, [formula for formula, _ in relaxing], color="#0072B2", label="standard linear solid")
    axes.plot(x[::every], [exact for _, exact in relaxing[::every]], "o", color="#0072B2", mfc="white", ms=4)
    if any(formula >= 0 for formula, _ in stiff):
        axes.plot(x, [formula for formula, _ in stiff], "--", color="#D55E00", label="Kelvin–Voigt")
        axes.plot(x[::every], [exact for _, exact in stiff[::every]], "o", color="#D55E00", mfc="white", ms=4)
    axes.set(ylim=(0, None), ylabel="largest passive stiffness [N/m]")
    axes.legend(loc="lower left" if name == "a" else "upper right")
left.set(xlim=(0, 0.27), xlabel="damping of the environment [N·s/m]", title="(a) T = 1 ms")
right.set(xlim=(0.5, 5), xlabel="sample period T [ms]", title="(b) 0.5 N·s/m; Kelvin–Voigt: none")

# %%
# The number: how well the two roads agree (circles: exact engine).

pairs = [pair for relaxing, stiff in curves.values() for pair in (*relaxing, *stiff) if pair[0] > 0]
worst = max(abs(formula - exact) / formula for formula, exact in pairs)
print(f"largest relative difference over {len(pairs)} points: {worst:.1e}")
plt.show()
