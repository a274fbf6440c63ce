"""
A drawer: a world of many parts behind one coupling
===================================================

A tool knocks against a drawer, the drawer slides on dry friction, pulls a counterweight over a lever and
ends in a stop.  Whatever is built so gives out no energy of its own: the coupling alone must fit the device.
"""

import matplotlib.pyplot as plt
import numpy as np

import zwidth as zw
from zwidth.model.scene import Contact, CoulombFriction, Damper, Lever, Mass, SceneRun, Spring
from zwidth.show import plots

plt.rcParams.update(plots.LOOK)
drawer = zw.Scene(
    [
        Mass("tool", "50 g"),
        Contact("tool", "drawer", "2 N/mm", "1 N*s/m", "5 mm"),
        Mass("drawer", "0.4 kg"),
        CoulombFriction("drawer", "ground", "0.3 N"),
        Lever("drawer", "counterweight", -0.5),
        Mass("counterweight", "0.2 kg"),
        Spring("counterweight", "ground", "20 N/m"),
        Damper("counterweight", "ground", "0.5 N*s/m"),
        Contact("drawer", "ground", "5 N/mm", "3 N*s/m", "20 mm"),
    ],
    port="tool",
)
figure, axes = plt.subplots(figsize=(8, 3.6), layout="constrained")
plots.draw_scene(axes, drawer)
plt.show()

# %%
# The coupling decides: 800 N/m and 0.05 N·s/m need b = K T/2 + B.

device = zw.Device(damping="0.5 N*s/m", rate="1 kHz", resolution=0, delay=0, mass="0.1 kg")
verdict = zw.check(device, zw.VirtualCoupling("800 N/m", "0.05 N*s/m", drawer))
print(verdict)
print(f"needed: {verdict.needs[0].needed:.2f} N·s/m of {verdict.needs[0].has:.2f}")

# %%
# The tool is pushed 30 mm in within half a second and drawn back: it meets the drawer after 5 mm, takes it
# along to its stop, and leaves it there, for friction holds the drawer against the counterweight's spring.

time = np.arange(1000) * 1e-3
way = 0.03 * np.sin(np.pi * np.minimum(time, 1 - time)) ** 2
run = SceneRun(drawer, "1 ms")
force, places = [], []
for move in np.diff(way, prepend=0):
    force.append(run.step(float(move)))
    places.append(run.positions["drawer"])
account = run.account()
figure, (top, below) = plt.subplots(2, 1, sharex=True, figsize=(8, 4.8), layout="constrained")
top.plot(time, 1e3 * way, label="tool")
top.plot(time, 1e3 * np.array(places), label="drawer")
top.set(ylabel="position [mm]")
top.legend()
below.plot(time, force)
below.set(xlabel="time t [s]", ylabel="force on the tool [N]")
plt.show()

# %%
# Every joule of the hand is in an element.

print(account.to_dataframe())
into = float(account.work.sum())
print(f"into the elements {1e3 * into:.4f} mJ, from the hand {1e3 * account.attrs['port_work_J']:.4f} mJ")
