"""The energies of one stretch, by closed form.

With Δx the distance, t the time, Q = ∫v² dt, A = ∫ξ dt (ξ from the start of the
stretch), e0 the slack x_a − x at the start and u the speed of the anchor,

    viscous   b Q           Coulomb   f_c |Δx|        actuator   −∫ f_a v dt
    spring on the device    ∫ k e v = k [Δx (e0 − Δx/2) + u (t Δx − A)]
    damper on the device    ∫ c (u − v) v = c (u Δx − Q)
    the hand's own mass     −m_h (v1² − v0²)/2
    anchor, by the muscles  u ∫ (k e + c (u − v)) = u [k (e0 t + u t²/2 − A) + c (u t − Δx)]
    hand's damper           c ∫ (u − v)² = c (u² t − 2 u Δx + Q)
"""

from __future__ import annotations

from zwidth.loop.plant import (
    ACTUATOR_WORK,
    COULOMB,
    HAND_LOSS,
    HAND_WORK,
    SOURCE_WORK,
    VISCOUS,
    Drive,
    Plant,
)
from zwidth.native.compiled import Array, compiled


@compiled
def book(
    state: Array,
    plant: Plant,
    drive: Drive,
    t: float,
    moved: float,
    area: float,
    squares: float,
    pull: float,
    v0: float,
    v1: float,
) -> None:
    """Add the energies of a stretch of sliding to the state; `pull` is ∫ f_a v dt."""
    k, c = plant.stiffness, plant.hand_damping
    slack, speed = drive.slack, drive.speed
    state[VISCOUS] += plant.damping * squares
    state[COULOMB] += plant.coulomb * abs(moved)
    state[ACTUATOR_WORK] -= pull
    spring = k * (moved * (slack - 0.5 * moved) + speed * (t * moved - area))
    damper = c * (speed * moved - squares)
    inertia = 0.5 * plant.hand_mass * (v1 - v0) * (v1 + v0)
    state[HAND_WORK] += drive.force * moved + spring + damper - inertia
    anchor = speed * (k * (slack * t + 0.5 * speed * t * t - area) + c * (speed * t - moved))
    state[SOURCE_WORK] += drive.force * moved + anchor
    state[HAND_LOSS] += c * (speed * speed * t - 2.0 * speed * moved + squares)


@compiled
def book_rest(state: Array, plant: Plant, drive: Drive, t: float) -> None:
    """Add the energies of a stretch at rest: only the anchor moves."""
    k, c, speed = plant.stiffness, plant.hand_damping, drive.speed
    state[SOURCE_WORK] += speed * (k * (drive.slack * t + 0.5 * speed * t * t) + c * speed * t)
    state[HAND_LOSS] += c * speed * speed * t
