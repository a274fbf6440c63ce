"""Drake, a diagram of its C++ blocks: `drake_diagram.py ACCURACY SLIP`.

Its blocks have no Coulomb friction, hence f_c sat(v/v_s) with the slip speed v_s
[m/s].  Nor is there a floor; it is made of adders, ⌊q⌋ = ((q − 1/2) + c) − c with a c so
large that doubles beside it are whole.  ACCURACY is that of its third-order Runge-Kutta
method with error control, or "fixed" for steps of T of the second-order one.
"""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator
from pydrake.systems.framework import Diagram, DiagramBuilder
from pydrake.systems.primitives import (
    Adder,
    ConstantVectorSource,
    Demultiplexer,
    Gain,
    LinearSystem,
    LogVectorOutput,
    Saturation,
    Sine,
    ZeroOrderHold,
)
from task import COULOMB, DAMPING, MASS, PERIOD, RESOLUTION, START, STIFFNESS, report

WHOLE = 1.5 * 2.0**52


def loop(slip: float) -> tuple[Diagram, LinearSystem, Any]:
    """(diagram, device, log of the state)."""
    builder = DiagramBuilder()
    add, connect = builder.AddSystem, builder.Connect

    def constant(value: float) -> ConstantVectorSource:
        return add(ConstantVectorSource([value]))

    def join(target: Adder, *sources: Any) -> None:
        for i, source in enumerate(sources):
            connect(source.get_output_port(0), target.get_input_port(i))

    slide = [[0, 1], [0, -DAMPING / MASS]]
    device = add(LinearSystem(slide, [[0], [1 / MASS]], [[1, 0], [0, -COULOMB / slip]], [[0], [0]]))
    parts = add(Demultiplexer(2))
    friction = add(Saturation([-COULOMB], [COULOMB]))
    connect(device.get_output_port(), parts.get_input_port())
    connect(parts.get_output_port(1), friction.get_input_port())

    count = add(Gain(1 / RESOLUTION, 1))
    rounded = add(Adder(3, 1))
    floor = add(Adder(2, 1))
    inside = add(Saturation([0.0], [np.inf]))
    wall = add(Gain(-STIFFNESS * RESOLUTION, 1))
    connect(parts.get_output_port(0), count.get_input_port())
    join(rounded, count, constant(-0.5), constant(WHOLE))
    join(floor, rounded, constant(-WHOLE))
    connect(floor.get_output_port(), inside.get_input_port())
    connect(inside.get_output_port(), wall.get_input_port())

    applied = add(Adder(3, 1))
    held = add(ZeroOrderHold(PERIOD, 1))
    force = add(Adder(2, 1))
    join(applied, wall, constant(1.0), add(Sine(0.5, 2 * np.pi * 5, 0.0, 1)))
    connect(applied.get_output_port(), held.get_input_port())
    join(force, held, friction)
    connect(force.get_output_port(), device.get_input_port())
    log = LogVectorOutput(device.get_output_port(), builder, PERIOD)
    return builder.Build(), device, log


def main(accuracy: str, slip: float) -> None:
    """Build, run, print."""
    diagram, device, log = loop(slip)

    def simulate(samples: int) -> list[float]:
        simulator = Simulator(diagram)
        if accuracy == "fixed":
            ResetIntegratorFromFlags(simulator, "runge_kutta2", PERIOD).set_fixed_step_mode(True)
        else:
            ResetIntegratorFromFlags(simulator, "runge_kutta3", 0.1).set_target_accuracy(float(accuracy))
        context = simulator.get_mutable_context()
        device.GetMyMutableContextFromRoot(context).SetContinuousState([START, 0.0])
        simulator.Initialize()
        simulator.AdvanceTo((samples + 0.5) * PERIOD)
        return log.FindLog(context).data()[0]

    report(simulate, 2000)


if __name__ == "__main__":
    main(sys.argv[1], float(sys.argv[2]))
