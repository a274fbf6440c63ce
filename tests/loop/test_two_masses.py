"""Motor and handle with a transmission between them, against an integration that shares nothing with it."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm

import zwidth as zw
from zwidth.model.operator.operator import LinearHand, Operator, Signals

T = 1e-3
CABLE = zw.Transmission(
    stiffness=0.015 * (2 * np.pi * 60) ** 2,
    damping=0.2,
    handle_mass=0.03,
    handle_damping=0.09,
    handle_coulomb_friction=0.05,
)
MOTOR = zw.Device(mass=0.03, damping=0.06, coulomb_friction=0.02, stiction=0.03, rate=1000, transmission=CABLE)
SMOOTH = MOTOR.replace(
    coulomb_friction=0, stiction=None, transmission=CABLE.replace(handle_coulomb_friction=0, damping=0)
)


@dataclass(frozen=True, kw_only=True)
class Held(Operator):
    """A hand of mass, spring and damper whose anchor goes to and fro, with a push."""

    hand: LinearHand = LinearHand(0.1, 900.0, 0.5)
    swing: float = 1e-3
    push: float = 0.3

    def signals(self, times):
        anchor = self.swing * np.sin(2 * np.pi * 43 * times)
        return Signals(force=np.where(times[:-1] % 0.02 < 0.008, self.push, -self.push), anchor=anchor)

    def describe(self, motion="linear"):
        return "a hand"


def spring(stiffness):
    """On both sides."""
    return zw.PulseTransferFunction(numerator=(stiffness,), denominator=(1,))


def energy_closes(trace):
    """Every joule, at every instant."""
    energy = trace.zwidth.energy
    assert energy.closes
    assert max(np.abs(energy.residual).max(), np.abs(energy.hand_residual).max()) < 1e-13 * energy.moved
    return True


@pytest.mark.parametrize("encoder", ["motor", "handle"])
@pytest.mark.parametrize("damping", [0.0, 0.3, 40.0])
def test_without_dry_friction_it_is_a_matrix_exponential(encoder, damping):
    device = SMOOTH.replace(transmission=CABLE.replace(handle_coulomb_friction=0, damping=damping, encoder=encoder))
    hand = Held(swing=0.0, push=0.0)
    trace = zw.simulate(device, spring(276), hand, 0.3, initial_velocity=0.5)
    k, total = float(CABLE.stiffness), 0.03 + hand.hand.mass
    a = np.zeros((5, 5))  # x₁ v₁ x₂ v₂ f
    a[0, 1] = a[2, 3] = 1
    a[1] = np.array([-k, -0.06 - damping, k, damping, -1]) / 0.03
    a[3] = np.array([k, damping, -k - 900, -0.09 - damping - 0.5, 0]) / total
    step, z, found = expm(a * T), np.array([0, 0.5, 0, 0.5, 0.0]), []
    for _ in range(301):
        z[4] = 276 * z[0 if encoder == "motor" else 2]
        found.append(z)
        z = step @ z
    names = ("motor_position", "motor_velocity", "position", "velocity", "actuator_force")
    for name, column in zip(names, np.transpose(found), strict=True):
        assert trace[name].values == pytest.approx(column, abs=1e-13 * np.abs(column).max(), rel=0), name
    assert energy_closes(trace)


@dataclass
class Bodies:
    """Motor and handle by an integrator with events: x₁ v₁ x₂ v₂, then b₁v₁², b₂v₂², c(v₁ − v₂)², f_c|v|, −f v₁."""

    device: zw.Device
    hand: Held
    sides: list[float] = field(default_factory=lambda: [1.0, 1.0])
    changes: int = 0

    def __post_init__(self):
        own, between = self.device.motor_side, self.device.transmission
        self.mass = np.array([own.mass, float(between.handle_mass) + self.hand.hand.mass], dtype=float)
        self.drag = np.array([own.damping, between.handle_damping], dtype=float)
        self.dry = np.array([own.coulomb_friction, between.handle_coulomb_friction], dtype=float)
        self.held = np.array([own.stiction, between.handle_coulomb_friction], dtype=float)
        self.spring, self.damper = float(between.stiffness), float(between.damping)

    def forces(self, t, z, f, push, anchor):
        """On either body, all but its dry friction."""
        x, v = z[0:4:2], z[1:4:2]
        inside = self.spring * (x[0] - x[1]) + self.damper * (v[0] - v[1])
        _, stiff, drag = self.hand.hand
        from_hand = push + stiff * (np.polyval(anchor, t) - x[1]) + drag * (anchor[0] - v[1])
        return np.array([-f - inside, from_hand + inside]) - self.drag * v

    def slopes(self, t, z, f, push, anchor):
        """z'."""
        v, side = z[1:4:2], np.array(self.sides)
        a = np.where(side == 0, 0, (self.forces(t, z, f, push, anchor) - side * self.dry) / self.mass)
        lost = [*self.drag * v**2, self.damper * (v[0] - v[1]) ** 2, self.dry @ np.abs(v), -f * v[0]]
        return np.array([v[0], a[0], v[1], a[1], *lost])

    def through(self, z, *given):
        """A sample interval."""
        for i in range(2):
            e = self.forces(0, z, *given)[i]
            if z[2 * i + 1] == 0:
                self.sides[i] = np.sign(e) if abs(e) > self.held[i] else 0
        now = 0.0
        while now < T:
            events = [lambda t, z, *g, i=i: self.margin(t, z, i, *g) for i in range(2)]
            for event in events:
                event.terminal, event.direction = True, -1
            found = solve_ivp(
                self.slopes, (now, T), z, "DOP853", args=given, events=events, rtol=1e-12, atol=1e-15, max_step=T / 8
            )  # fmt: skip
            now, z = found.t[-1], found.y[:, -1]
            for i in range(2):
                if found.t_events[i].size:
                    self.changes += 1
                    z[2 * i + 1] = 0.0
                    e = self.forces(now, z, *given)[i]
                    free = self.sides[i] == 0 or abs(e) > self.held[i]
                    self.sides[i] = np.sign(e) if free else 0
        return z

    def margin(self, t, z, i, *given):
        """Falls through 0 where a body stops or starts."""
        if self.sides[i] == 0:
            return self.held[i] - abs(self.forces(t, z, *given)[i])
        return self.sides[i] * z[2 * i + 1]


@pytest.mark.parametrize(
    ("stiffness", "start", "motor", "handle"),
    [(276, 0.2, 0.02, 0.05), (60, 0.0, 0.05, 0.5), (1000, 0.0, 0.25, 0.02), (60, 0.01, 0.3, 0.3)],
)
def test_with_dry_friction_it_is_what_an_integrator_with_events_finds(stiffness, start, motor, handle):
    """Each side stops, sticks and starts by itself, and every loss is the integral of its power."""
    hand, samples = Held(), 60
    device = MOTOR.replace(
        coulomb_friction=motor,
        stiction=1.3 * motor,
        transmission=CABLE.replace(handle_coulomb_friction=handle),
    )
    bodies = Bodies(device, hand, [float(np.sign(start))] * 2)
    trace = zw.simulate(device, spring(stiffness), hand, samples * T, initial_velocity=start)
    signals = hand.signals(np.arange(samples + 1) * T)
    z = np.array([0, start, 0, start, 0, 0, 0, 0, 0.0])
    rows = [z]
    for (a, b), push in zip(pairwise(signals.anchor), signals.force, strict=True):
        z = bodies.through(z, stiffness * z[0], push, [(b - a) / T, a])
        rows.append(z)
    x1, v1, x2, v2, lost_1, lost_2, inside, dry, actuator = np.transpose(rows)
    expected = {
        "motor_position": x1,
        "motor_velocity": v1,
        "position": x2,
        "velocity": v2,
        "motor_viscous_loss": lost_1,
        "viscous_loss": lost_1 + lost_2,
        "transmission_loss": inside,
        "coulomb_loss": dry,
        "actuator_work": actuator,
    }
    for name, values in expected.items():
        assert trace[name].values == pytest.approx(values, abs=2e-9 * np.abs(values).max(), rel=0), name
    assert bodies.changes >= trace.attrs["stops"] >= 4
    assert energy_closes(trace)
