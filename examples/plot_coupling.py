"""
Which virtual couplings are safe, whatever lies behind them?
============================================================

A simulation that is built apart from the device, with a spring and a damper in
between, is rendered passively if the coupling is right: whatever environment it
holds, if that is passive in discrete time.  Which couplings those are is known
exactly.  The two-port criterion that is usually taken, with a hold that averages,
allows four to eight times as much, and a hand takes energy out.
"""

from collections.abc import Callable

import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray

import zwidth as zw
from zwidth.show import plots

plt.rcParams.update(plots.LOOK)
paddle = zw.catalogue.device("haptic-paddle")
b, T = float(paddle.damping), float(paddle.sample_period)
late = paddle.replace(delay=T)
Need = Callable[[float, float], float]

# %%
# The need for damping is proportional to the coupling: so the edge of what a device can
# render is found along rays of constant K_c T : 2 B_c, from the need of one coupling on each.


def edge(need: Need) -> NDArray[np.float64]:
    """K_c [N/m] and B_c [N·s/m] at the edge; need(K_c, B_c) in N·s/m."""
    shares = np.linspace(0, 1, 121)
    couplings = [(float(share) / T, float(1 - share) / 2) for share in shares]
    return np.array([[k * b / need(k, d), d * b / need(k, d)] for k, d in couplings]).T


def every(device: zw.Device) -> Need:
    return lambda k, d: zw.coupling.coupling_condition(device, k, d).required_damping or np.inf


def rigid(device: zw.Device) -> Need:
    return lambda k, d: zw.check(device, zw.Wall(k, d)).required_damping or np.inf


def llewellyn(k: float, d: float) -> float:
    return zw.coupling.two_port.llewellyn_damping(k, d, T)


# %%
# Designs: the stiffest, and the nearest to a wall of 200 N/m and 0.2 N·s/m.

wanted = zw.Wall(200, "0.2")
designs = {
    device: (
        zw.coupling.design_coupling(device, margin=0),
        zw.coupling.design_coupling(device, wanted, margin=0),
    )
    for device in (paddle, late)
}
spring = b / every(late)(1.0, 0.0)

# %%
# One coupling that Llewellyn's conditions call unconditionally stable, and the motion that takes energy out.

between = (700, "0.1")
stable = zw.coupling.two_port.impedance_display(paddle, *between).unconditionally_stable
motion = zw.coupling.coupling_condition(paddle, *between).witness
assert motion is not None

figure, (left, right) = plt.subplots(1, 2, figsize=(8.6, 5), layout="constrained")
left.fill(*np.hstack((edge(llewellyn), [[0], [0]])), color="#E69F00", alpha=0.25)
left.plot(*edge(llewellyn), "--", color="#E69F00", label="two-port, averaging hold")
left.fill(*np.hstack((edge(every(paddle)), [[0], [0]])), color="#009E73", alpha=0.5)
left.plot(*edge(every(paddle)), color="#009E73", label="exact, every passive environment")
left.plot(700, 0.1, "X", color="#D55E00", ms=9, label=f"gives out {1e3 * motion.energy:.2g} mJ in 1 mm")
right.plot(*edge(rigid(late)), ":", color="#777777", label="a rigid environment alone")
right.fill(*np.hstack((edge(every(late)), [[0], [0]])), color="#009E73", alpha=0.5)
right.plot(*edge(every(late)), color="#009E73", label="exact, every passive environment")
for axes, device in ((left, paddle), (right, late)):
    for design, mark, name in zip(
        designs[device], "os", ("stiffest", "nearest to 200 N/m, 0.2 N·s/m"), strict=True
    ):
        axes.plot(
            design.stiffness, design.damping, mark, color="#0072B2", label=name, clip_on=False, zorder=5
        )
    axes.set(xlim=(0, None), ylim=(0, None), xlabel="coupling stiffness $K_c$ [N/m]")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.16))
left.set(ylabel="coupling damping $B_c$ [N·s/m]", title="Paddle, without delay")
right.set(title="Paddle, one sample of delay")

# %%
# With a delay a rigid environment is not the worst: a mass behind the coupling is.  And virtual
# damping, which costs stiffness without delay, buys some there.

print(f"two-port says stable: {stable}; the motion extracts {1e3 * motion.energy:.3g} mJ")
print(
    f"stiffest: {designs[paddle][0].stiffness:.0f} N/m, the two-port would allow {8 * b / T:.0f} N/m; "
    f"one sample late: {designs[late][0].stiffness:.1f} N/m, a spring alone {spring:.1f} N/m"
)
plt.show()
