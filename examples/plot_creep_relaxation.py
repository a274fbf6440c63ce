"""
Which model creeps and relaxes as tissue does?
==============================================

Tissue that is held deformed pushes less after a while, but does not stop; pushed by a
constant force it goes on yielding, but not for ever, and comes back when it is let go.
Figure 2 of "A passivity criterion for real-time haptic simulation of viscoelastic soft
tissues" shows that the standard linear solid does so.  Here it is beside a Kelvin–Voigt
and a Maxwell body of the same springs and dashpots.
"""

import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray

import zwidth as zw
from zwidth.model.environment import Environment
from zwidth.model.environment.relaxing import compliance
from zwidth.show import plots

plt.rcParams.update(plots.LOOK)
MU0, MU1, ETA1 = 300, 200, 40  # N/m, N/m, N·s/m
bodies = {
    "standard linear solid": (zw.StandardLinearSolid(MU0, MU1, ETA1), "#0072B2", "-"),
    "Kelvin–Voigt": (zw.Wall(MU0, ETA1), "#D55E00", "--"),
    "Maxwell": (zw.Maxwell(MU1, ETA1), "#009E73", "-."),
}
time = np.linspace(-0.2, 2.0, 1101)

# %%
# Relaxation: 1 cm at t = 0, held.  The Kelvin–Voigt body answers the step itself with an
# impulse, which no plot shows, and then with its spring alone: it does not relax.  The
# Maxwell body relaxes to nothing.
#
# Creep: 1 N from 0 to 1 s.  Two steps of opposite sign superpose, so that the position is
# J(t) − J(t − 1 s).  The Kelvin–Voigt body does not give way at once; the Maxwell body
# does not stop, nor come back.


def under_a_pulse(body: Environment) -> NDArray[np.float64]:
    return zw.tissue.creep(body, time) - zw.tissue.creep(body, time - 1.0)


figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.8), layout="constrained")
for name, (body, colour, style) in bodies.items():
    left.plot(time, 0.01 * zw.tissue.relaxation(body, time), style, color=colour, label=name)
    right.plot(time, 1e3 * under_a_pulse(body), style, color=colour, label=name)
left.set(xlabel="time [s]", ylabel="force under 1 cm [N]", title="relaxation", ylim=(0, None))
right.set(xlabel="time [s]", ylabel="position under 1 N [mm]", title="creep and return")
right.axvspan(0, 1, color="0.5", alpha=0.1, lw=0)
left.legend()

# %%
# The numbers: creep is slower than relaxation, by 1 + μ1/μ0; and what stays of each
# deformation a second after the force.

for name, (body, *_) in bodies.items():
    print(f"{name:22} {1e3 * under_a_pulse(body)[-1]:7.3f} mm stay")
rate = compliance(bodies["standard linear solid"][0]).modes[0][0]
print(f"relaxation time {ETA1 / MU1:.3f} s, retardation time {1 / rate:.3f} s")
plt.show()
