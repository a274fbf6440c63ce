"""MuJoCo, a slide joint with damping and frictionloss: `mujoco_frictionloss.py INTEGRATOR STEPS_PER_SAMPLE`.

The friction constraint is hardened: its impedance is next to 1 and its time constant,
with the guard against short ones off, one step.  As it is by default, the error does not
become smaller with the step.
"""

from __future__ import annotations

import sys

import mujoco
from task import COULOMB, DAMPING, MASS, PERIOD, START, hand_forces, report, wall_force

MODEL = """
<mujoco>
  <option gravity="0 0 0" integrator="{integrator}" timestep="{step!r}"><flag refsafe="disable"/></option>
  <worldbody>
    <body>
      <joint name="handle" type="slide" axis="1 0 0" damping="{damping!r}" frictionloss="{coulomb!r}"
             solimpfriction="0.9999 0.9999 0.001 0.5 2" solreffriction="{step!r} 1"/>
      <geom type="sphere" size="0.01" mass="{mass!r}" contype="0" conaffinity="0"/>
    </body>
  </worldbody>
</mujoco>
"""


def simulate(samples: int, model: mujoco.MjModel, steps: int) -> list[float]:
    """The positions at the sample instants [m]."""
    data = mujoco.MjData(model)
    x, push = data.qpos, data.qfrc_applied
    x[0] = START
    positions = [START]
    for hand in hand_forces(samples):
        push[0] = hand - wall_force(x[0])
        mujoco.mj_step(model, data, steps)
        positions.append(x[0])
    return positions


if __name__ == "__main__":
    integrator, steps = sys.argv[1], int(sys.argv[2])
    text = MODEL.format(
        integrator=integrator, step=PERIOD / steps, damping=DAMPING, coulomb=COULOMB, mass=MASS
    )
    model = mujoco.MjModel.from_xml_string(text)
    report(lambda samples: simulate(samples, model, steps), 10_000 if steps == 1 else 2000)
