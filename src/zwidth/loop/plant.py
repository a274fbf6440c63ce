"""The numbers and the state of one loop, as the step functions see them.

The plant is device and hand moving together:

    M v̇ = G(t) − D v − k (x − x_a(t)) − f_c sgn v,   M = m + m_h,   D = b + c

Everything is float64 in flat arrays, so that thousands of loops lie side by side.
"""

from __future__ import annotations

from typing import NamedTuple


class Plant(NamedTuple):
    """What does not change during a simulation, in SI units.

    `lag` is the time constant of the amplifier, 0 for none; `slew` the fastest
    change of the actuator force, 0 for any.
    """

    mass: float
    hand_mass: float
    damping: float
    coulomb: float
    stiction: float
    stiffness: float
    hand_damping: float
    lag: float
    slew: float


class Drive(NamedTuple):
    """What acts on the plant during one stretch, from its beginning at t = 0.

    `force` F, `slack` x_a − x, `speed` ẋ_a; then the external force at rest,

        F_e = external + rate t + transient (1 − e^{−t/lag})

    and `ramp`, the part of −rate that is the actuator's own change df_a/dt.
    """

    force: float
    slack: float
    speed: float
    external: float
    rate: float
    ramp: float
    transient: float


# The state.  DIRECTION is the sign of the velocity, 0 at rest; FORCE the actuator force now, GOAL the
# force it goes to.  From HAND_WORK on: the energies since the start [J].
POSITION, VELOCITY, DIRECTION, FORCE, GOAL = range(5)
HAND_WORK, ACTUATOR_WORK, VISCOUS, COULOMB, SOURCE_WORK, HAND_LOSS = range(5, 11)
STOPS = 11
"""How often the mass came to rest or turned round."""
FAULT = 12
"""Not 0 if the step functions gave up: too many events in one stretch."""
INSIDE, SATURATED = 13, 14
"""How many samples were taken inside the surface; for how many the command went beyond the force limit."""
STATE_SIZE = 15
