"""
What does an arm store while torques are held, late?
====================================================

Torques on a robot arm are commanded by samples, wait, and are held.  Lemma 2 of Miller, Colgate
and Freeman gives the energy of arm, hold and delay together, W, and an upper bound of what it may
become.  Here both are followed along a motion of two links that are swung by random steps of torque.
"""

import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

import zwidth as zw
from zwidth.show import plots

plt.rcParams.update(plots.LOOK)
T, delay, samples = 0.002, 1, 100
damping = np.array([[0.03, 0.007], [0.007, 0.02]])  # N·m·s/rad

# %%
# Two links in a horizontal plane: inertia that depends on the elbow, viscous joints, no gravity.


def inertia(elbow: float) -> NDArray[np.float64]:
    c = 0.006 * np.cos(elbow)
    return np.array([[0.021 + 2 * c, 0.005 + c], [0.005 + c, 0.005]])


def motion(t: float, state: NDArray[np.float64], torque: NDArray[np.float64]) -> NDArray[np.float64]:
    elbow, v = state[1], state[2:]
    coriolis = 0.006 * np.sin(elbow) * np.array([-v[1] * (2 * v[0] + v[1]), v[0] ** 2])
    return np.concatenate([v, np.linalg.solve(inertia(elbow), torque - coriolis - damping @ v)])


# %%
# Each torque is commanded at the end of a sample and acts, held, after one sample of delay.

torques = np.repeat(np.random.default_rng(1).normal(0, 0.12, (10, 2)), 10, axis=0)
path = [np.array([0.2, 0.9, 0.0, 0.0])]
for k in range(samples):
    held = torques[k - delay - 1] if k > delay else np.zeros(2)
    moved = solve_ivp(motion, (0, T), path[-1], "DOP853", args=(held,), rtol=1e-11, atol=1e-12)
    path.append(moved.y[:, -1])
states = np.array(path)
energy = np.array([s[2:] @ inertia(s[1]) @ s[2:] / 2 for s in states])

# %%
# W never grows by more than yᵀu − yᵀΛy.  What it stays below is the change of velocity within the samples.

stored = zw.coupling.loop_storage(torques, states[:, :2], energy, damping, T, delay * T)
allowed = float(stored["storage"][0]) + (stored["supply"] - stored["dissipation"]).cumsum()
lost = float(stored["slack"].sum()) * T
mean = np.diff(states[:, :2], axis=0) / T
heat = float(np.einsum("ki,ij,kj->", mean, damping, mean)) * T + lost
print(f"the lemma loses {1e3 * lost:.3g} mJ of {1e3 * heat:.3g} mJ of heat in the joints")

time = np.arange(samples + 1) * T * 1e3
figure, (above, below) = plt.subplots(2, 1, figsize=(6.4, 5), sharex=True, layout="constrained")
above.plot(time[1:], 1e3 * T * allowed, color="#BBBBBB", lw=5, label="W(0) + Σ (yᵀu − yᵀΛy), times T")
above.plot(time, 1e3 * T * stored["storage"], color="#0072B2", label="W T: arm, hold and delay")
above.plot(time, 1e3 * energy, color="#D55E00", label="the arm alone")
above.set(ylabel="energy [mJ]")
above.legend()
below.plot(time[1:], 1e6 * T * stored["slack"].cumsum(), color="black")
below.set(xlabel="time [ms]", ylabel="between the two [µJ]")
plt.show()
