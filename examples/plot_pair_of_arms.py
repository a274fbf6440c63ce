"""
Two arms that follow each other: how stiff, over what link?
===========================================================

A leader and a follower, each a joint of a low-cost arm, joined by a spring over a link of 2 ms
each way.  The verdict says how stiff the coupling may be; a hand on the leader, with nobody and
then with a real wall at the follower, shows what becomes of it.
"""

import matplotlib.pyplot as plt
import xarray as xr

import zwidth as zw
from zwidth.show import plots
from zwidth.show.plots.traces import draw_both, draw_pair_energies

plt.rcParams.update(plots.LOOK)
joint = zw.Device(
    name="a joint",
    motion="rotary",
    mass=0.02,
    damping="0.4 N*m*s/rad",
    coulomb_friction="0.05 N*m",
    resolution="40 urad",
    rate="1 kHz",
    delay=0,
)
pair = zw.Pair(joint, joint, stiffness="100 N*m/rad", delay="2 ms")
verdict = zw.check(pair)
print(verdict)

# %%
# Which dampings are enough, and how much stiffness the delay of the link leaves.

figure, axes = plt.subplots(1, 2, figsize=(7.6, 3.6), layout="constrained")
plots.draw_pair_damping(axes[0], verdict)
plots.draw_pair_link(axes[1], verdict)
plt.show()

# %%
# Twice as stiff as is passive, the arms shake by themselves: a push that never grows
# puts in next to nothing, and what comes out of the coupling goes into motion and heat.

push = zw.operators.ConstantForce(force=0.5)
loose = zw.simulate(pair.replace(stiffness="270 N*m/rad"), push, None, 0.4)


def show(trace: xr.Dataset) -> None:
    """Positions of both arms, and the energy."""
    _, axes = plt.subplots(2, 1, sharex=True, figsize=(8, 4.8), layout="constrained")
    draw_both(axes[0], trace, "position", "position")
    draw_pair_energies(axes[1], trace)
    plt.show()


show(loose)

# %%
# The passive one against a wall that stands there really: the leader feels the spring between the
# arms and the wall behind it, one after the other.

pressed = zw.simulate(pair, push, zw.Wall(2000, 2), 1.0)
print(f"felt: {pressed.zwidth.felt_stiffness:.3g} N·m/rad")
show(pressed)

# %%
# Other ways to join them, side by side: the follower's force sent in the place of its position, both,
# each arm's own part in its drive at 20 kHz, friction compensated.

compared = zw.compare(
    {
        "position–position": pair,
        "position–force": pair.replace(stiffness=0, follower_stiffness=100, reflection=1),
        "four channels": pair.replace(
            stiffness=50, follower_stiffness=50, reflection=1, follower_reflection=1
        ),
        "in the drives": pair.replace(drive_rate="20 kHz"),
        "friction compensated": pair.replace(
            compensation=zw.rendering.FrictionCompensation(coulomb="0.04 N*m", viscous="0.1 N*m*s/rad")
        ),
    }
)
print(compared)
