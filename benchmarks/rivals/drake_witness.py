"""Drake, a system in Python with a witness function: every stop is isolated in time.

Mode 0 sticks; modes ±1 slide with that sign of the velocity, which is the witness.
"""

from __future__ import annotations

import math
from typing import Any

from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import (
    DiagramBuilder,
    LeafSystem,
    UnrestrictedUpdateEvent,
    WitnessFunctionDirection,
)
from pydrake.systems.primitives import LogVectorOutput
from task import COULOMB, DAMPING, MASS, PERIOD, START, hand_force, report, wall_force

FORCE, MODE = 0, 1


class Loop(LeafSystem):
    """Device, wall and hand."""

    def __init__(self) -> None:
        super().__init__()
        state = self.DeclareContinuousState(1, 1, 0)
        self.DeclareDiscreteState(2)
        self.DeclareStateOutputPort("state", state)
        self.DeclarePeriodicUnrestrictedUpdateEvent(PERIOD, 0.0, self.sample)
        self.stops = self.MakeWitnessFunction(
            "stop",
            WitnessFunctionDirection.kCrossesZero,
            self.velocity,
            UnrestrictedUpdateEvent(system_callback=Loop.stop),
        )

    def velocity(self, context: Any) -> float:
        """The witness."""
        return context.get_continuous_state_vector().GetAtIndex(1)

    def sample(self, context: Any, state: Any) -> None:
        """A new force; it may tear the mass loose."""
        x, v = context.get_continuous_state_vector().CopyToVector()
        force = hand_force(round(context.get_time() / PERIOD)) - wall_force(x)
        self.set(state, force, v)

    def stop(self, context: Any, _event: Any, state: Any) -> None:
        """The velocity is 0."""
        state.get_mutable_continuous_state().get_mutable_vector().SetAtIndex(1, 0.0)
        self.set(state, context.get_discrete_state_vector().GetAtIndex(FORCE), 0.0)

    def set(self, state: Any, force: float, v: float) -> None:
        """The force and whether, and which way, the mass slides."""
        sticks = v == 0.0 and abs(force) <= COULOMB
        mode = 0.0 if sticks else math.copysign(1.0, v if v != 0.0 else force)
        state.get_mutable_discrete_state().set_value([force, mode])

    def DoGetWitnessFunctions(self, context: Any) -> list[Any]:
        """The velocity is watched while the mass slides."""
        return [self.stops] if context.get_discrete_state_vector().GetAtIndex(MODE) else []

    def DoCalcTimeDerivatives(self, context: Any, derivatives: Any) -> None:
        """(v, v̇)."""
        force, mode = context.get_discrete_state_vector().value()
        v = self.velocity(context)
        a = (force - DAMPING * v - COULOMB * mode) / MASS if mode else 0.0
        derivatives.get_mutable_vector().SetFromVector([v, a])


def main() -> None:
    """Build, run, print."""
    builder = DiagramBuilder()
    loop = builder.AddSystem(Loop())
    log = LogVectorOutput(loop.get_output_port(), builder, PERIOD)
    diagram = builder.Build()

    def simulate(samples: int) -> list[float]:
        simulator = Simulator(diagram)
        simulator.get_mutable_integrator().set_target_accuracy(1e-9)
        context = simulator.get_mutable_context()
        context.SetAccuracy(1e-9)  # of the isolation in time
        loop.GetMyMutableContextFromRoot(context).SetContinuousState([START, 0.0])
        simulator.Initialize()
        simulator.AdvanceTo((samples + 0.5) * PERIOD)
        return log.FindLog(context).data()[0]

    report(simulate, 2000)


if __name__ == "__main__":
    main()
