"""
How light may a simulated tool be?
==================================

A tool behind a virtual coupling is stepped with the samples, usually by an explicit
integrator.  Then it must not be too light, the coupling needs a damper and must be
softer; by an implicit integrator every mass is passive.  In another process, with
naive messages, the coupling gets soft quickly; waves keep it.
"""

import matplotlib.pyplot as plt
import numpy as np

import zwidth as zw
from zwidth.model.environment.bodies import Integrator
from zwidth.show import plots

plt.rcParams.update(plots.LOOK)
paddle = zw.catalogue.device("haptic-paddle")
b, T = float(paddle.damping), float(paddle.sample_period)

# %%
# Half of the damping that the spring leaves is in the coupling.

stiffness = np.arange(5, 300, 5)
named: dict[Integrator, tuple[str, str]] = {
    "semi-implicit-euler": ("semi-implicit Euler", "#0072B2"),
    "velocity-verlet": ("Verlet", "#56B4E9"),
    "runge-kutta-4": ("Runge–Kutta", "#E69F00"),
    "forward-euler": ("forward Euler", "#D55E00"),
    "backward-euler": ("backward Euler", "#009E73"),
}


def lightest(k: float, integrator: Integrator) -> float:
    """The lightest passive mass [kg], 0 where none is too light; nan where none is passive."""
    tool = zw.coupling.CoupledBody(k, round((b - k * T / 2) / 2, 6), "1 g", integrator=integrator)
    found = zw.coupling.passive_masses(paddle, tool).smallest
    return np.nan if found is None else found


masses = {name: np.array([lightest(float(k), name) for k in stiffness]) for name in named}

# %%
# In another process: the stiffest coupling before heavy tools, with as much damping in it as the device
# pays for.


def stiffest(samples: int) -> float:
    """K_c [N/m] for so many samples of delay each way, by halving."""
    low, high = 0.0, 2 * b / T
    for _ in range(40):
        k = (low + high) / 2
        need = float(zw.coupling.heavy_body_damping(paddle, k, exchange_delay=samples))
        low, high = (k, high) if need < b - k * T / 2 else (low, k)
    return low


ways = range(11)
naive = [stiffest(d) for d in ways]
by_waves = zw.coupling.CoupledBody(
    290, 0, "0.1 g", integrator="backward-euler", exchange_delay=5, wave_impedance=1
)
kept = zw.coupling.passive_masses(paddle, by_waves)

figure, (left, right) = plt.subplots(1, 2, figsize=(8.6, 3.8), layout="constrained")
for name, (text, colour) in named.items():
    left.plot(stiffness, 1e3 * masses[name], color=colour, label=text)
left.set(
    ylim=(-0.02, 0.6),
    xlabel="coupling stiffness $K_c$ [N/m]",
    ylabel="lightest passive mass [g]",
    title="One process",
)
left.legend()
right.plot(ways, naive, "o-", color="#0072B2", label="force, position and speed as they are")
right.plot(ways, [2 * b / T] * len(ways), "s-", color="#009E73", label="waves, implicit body")
right.set(
    ylim=(0, None), xlabel="samples each way", ylabel="stiffest coupling [N/m]", title="Another process"
)
right.legend()

# %%
# Where a line on the left ends, no mass is passive with a stiffer coupling.

print(f"at 150 N/m: {1e3 * lightest(150.0, 'semi-implicit-euler'):.3f} g by semi-implicit Euler")
print(f"stiffest coupling: {naive[0]:.1f} N/m, one sample away {naive[1]:.1f} N/m")
print(f"implicit, by waves, 290 N/m: {kept.describe()[:22]}")
plt.show()
