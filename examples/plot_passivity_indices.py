"""
By how much is a linear system passive?
=======================================

A flexible device: a motor and a handle joined by a spring.  The force acts at the motor, and the velocity is
measured there or, where the encoder sits on the other side, at the handle.  The first is passive whatever
the numbers.  The second is not, and its index says by how much and at which frequency.
"""

import matplotlib.pyplot as plt
import numpy as np
from scipy.signal import TransferFunction

import zwidth as zw
from zwidth.show import plots
from zwidth.show.plots.style import heading

plt.rcParams.update(plots.LOOK)

# %%
# Motor 0.08 kg and 0.3 N·s/m, handle 0.05 kg and 0.2 N·s/m, joined by 4000 N/m and 0.5 N·s/m.

motor, handle, joint, rate = [0.08, 0.3], [0.05, 0.2], [0.5, 4000], [1, 0]
both = np.polyadd(np.polymul(rate, np.polymul(motor, handle)), np.polymul(joint, np.polyadd(motor, handle)))
at_motor = TransferFunction(np.polyadd(np.polymul(rate, handle), joint), both)
at_handle = TransferFunction(joint, both)

found = {"encoder at the motor": at_motor, "encoder at the handle": at_handle}
found = {name: zw.ports.passivity_indices(system) for name, system in found.items()}
for name, indices in found.items():
    print(f"{name}: {'passive' if indices.passive else 'not passive'}")
    for row in indices.rows():
        print("   ", *row)

# %%
# The real part of each, with the least value marked; and a burst by which the second gives out energy.

figure, axes = plt.subplots(1, 3, figsize=(12, 3.4), layout="constrained")
for axis, (name, indices) in zip(axes, found.items(), strict=False):
    plots.draw_index(axis, indices.input)
    heading(axis, name)
    axis.set_ylabel("Re $G$ [m/s per N]")
worst = found["encoder at the handle"].input
burst = worst.refute(0)
assert burst is not None
t, u, y = burst.signals(4000)
axes[2].plot(t, u, color="#777777", lw=1, label="force [N]")
axes[2].plot(t, [100 * v for v in y], color="#0072B2", label="velocity [cm/s]")
axes[2].set(title=f"burst of {burst.frequency:.1f} Hz", xlabel="time [s]")
axes[2].legend(loc="upper left", bbox_to_anchor=(1, 1))

# %%
# The certificate is of the number itself: with that much of the force fed through, the port is passive.

proof = worst.certificate()
assert proof is not None
assert proof.verify()
assert burst.verify()
print(f"short of passive by {-worst.value:.4g} m/s per N at {worst.frequency:.2f} Hz")
plt.show()
