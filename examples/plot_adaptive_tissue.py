"""
What if the tissue changes while the hand is in it?
===================================================

A virtual tissue that follows a measured one is made of solids each of which may be rendered
passively.  Together they are not passive: a hand that goes in while the tissue is soft and
comes out when it is stiff gets back more than it gave, ½ Δμ0 u² more.  An account of what hand
and damping have put in tells how much of the rise is paid for.
"""

import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray

import zwidth as zw
from zwidth.show import plots

plt.rcParams.update(plots.LOOK)
phantom = zw.catalogue.device("phantom")
T, b = 1e-3, 0.27

# %%
# Five strokes of 2 mm.  The tissue is soft while the hand goes in, and stiff while it comes out.

time = T * np.arange(2500)
position = 1e-3 * (0.95 - 1.05 * np.cos(4 * np.pi * time))
inwards = np.gradient(position) > 0
soft, stiff = (100, 50, 5), (400, 100, 10)
for solid in (soft, stiff):
    print(solid, zw.check(phantom, zw.StandardLinearSolid(*solid)).outcome)
wanted = np.where(inwards[:, None], soft, stiff)

# %%
# The naive wall takes each solid as it comes.  The other one pays for what it becomes: while
# the hand is inside, with what has been dissipated; outside, where nothing is stored, it is free.


def naive(solids: NDArray[np.float64]) -> NDArray[np.float64]:
    """μ0 u + μ1 e, e ← a (e + Δu), with the numbers of the moment."""
    e = before = 0.0
    forces = []
    for x, (mu0, mu1, eta) in zip(position, solids, strict=True):
        u = max(x, 0.0)
        e = eta / (eta + mu1 * T) * (e + u - before)
        before = u
        forces.append(mu0 * u + mu1 * e if x > 0 else 0.0)
    return np.array(forces)


def put_in(forces: NDArray[np.float64]) -> NDArray[np.float64]:
    """What hand and damping have put in: Σ f Δx + (b/T) Δx² [J]; below 0 the hand has got energy out."""
    moved = np.diff(position)
    return np.append(0.0, np.cumsum(forces[:-1] * moved + b / T * moved**2))


careful = zw.tissue.AdaptiveSolid(phantom, soft).render(position, wanted)
forces = {"naive": naive(wanted), "adaptive": careful.force}

figure, axes = plt.subplots(3, 1, figsize=(8, 6.4), sharex=True, layout="constrained")
axes[0].plot(time, wanted[:, 0], color="0.6", lw=3, label="wanted")
axes[0].plot(time, careful.stiffness, color="#0072B2", label="adaptive")
axes[0].set(ylabel="μ0 [N/m]")
for (name, force), colour in zip(forces.items(), ("#D55E00", "#0072B2"), strict=True):
    axes[1].plot(time, force, color=colour, label=name)
    axes[2].plot(time, 1e3 * put_in(force), color=colour, label=name)
axes[1].set(ylabel="force [N]")
axes[2].axhline(0, color="0.4", lw=0.8)
axes[2].set(ylabel="put in [mJ]", xlabel="time [s]")
for row in axes[:2]:
    row.legend(loc="upper left", bbox_to_anchor=(1, 1))

# %%
# The number: what five strokes take out.

taken = {name: max(0.0, -put_in(force).min()) for name, force in forces.items()}
print(f"taken out: naive {1e3 * taken['naive']:.2f} mJ, adaptive {1e3 * taken['adaptive']:.2f} mJ")
plt.show()
