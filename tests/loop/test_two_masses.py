"""Motor and handle with a transmission between them, against roads that share nothing with its plant."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm

import zwidth as zw
from zwidth.model.operator.operator import LinearHand, Operator, Signals

T = 1e-3
STIFFNESS = 0.015 * (2 * np.pi * 60) ** 2
CABLE = zw.Transmission(stiffness=STIFFNESS, damping=0.2, handle_mass=0.03, handle_damping=0.09)
MOTOR = zw.Device(mass=0.03, damping=0.06, rate=1000, transmission=CABLE)


@dataclass(frozen=True)
class Held(Operator):
    """A hand whose anchor goes to and fro, with a push that changes."""

    hand: LinearHand = LinearHand(0.1, 900.0, 0.5)  # noqa: RUF009
    swing: float = 1e-3
    push: float = 0.3

    def signals(self, times):
        force = np.where(times[:-1] % 0.02 < 0.008, self.push, -self.push)
        return Signals(force=force, anchor=self.swing * np.sin(2 * np.pi * 43 * times))

    def describe(self, motion="linear"):
        return "a hand"


def spring(stiffness):
    """On both sides."""
    return zw.PulseTransferFunction(numerator=(stiffness,), denominator=(1,))


def agree(trace, names, rows, within):
    """Each variable, relative to its largest value; and every joule is there."""
    for name, values in zip(names.split(), rows, strict=True):
        assert trace[name].values == pytest.approx(values, abs=within * np.abs(values).max(), rel=0), name
    energy = trace.zwidth.energy
    assert max(np.abs(energy.residual).max(), np.abs(energy.hand_residual).max()) < 1e-13 * energy.moved


@pytest.mark.parametrize("encoder", ["motor", "handle"])
@pytest.mark.parametrize(("damping", "start"), [(0.0, 0.5), (0.3, 0.0), (40.0, -0.5)])
def test_without_dry_friction_it_is_a_matrix_exponential(encoder, damping, start):
    device = MOTOR.replace(transmission=CABLE.replace(damping=damping, encoder=encoder))
    hand, samples = Held(swing=0.0, push=-0.2), 300
    trace = zw.simulate(device, spring(276), hand, samples * T, initial_velocity=start)
    a = np.zeros((6, 6))  # x₁ v₁ x₂ v₂, f and the hand's push
    a[0, 1] = a[2, 3] = 1
    a[1] = np.array([-STIFFNESS, -0.06 - damping, STIFFNESS, damping, -1, 0]) / 0.03
    a[3] = np.array([STIFFNESS, damping, -STIFFNESS - 900, -0.59 - damping, 0, 1]) / 0.13
    step, z, found = expm(a * T), np.array([0, start, 0, start, 0.0, 0.0]), []
    for push in [*hand.signals(np.arange(samples + 1) * T).force, 0.0]:
        z[4:] = 276 * z[0 if encoder == "motor" else 2], push
        found.append(z)
        z = step @ z
    rows = np.transpose(found)[:5]
    agree(trace, "motor_position motor_velocity position velocity actuator_force", rows, 1e-13)


class Bodies:
    """By an integrator with events: x₁ v₁ x₂ v₂, then b₁v₁², b₂v₂², c(v₁ − v₂)², f_c|v|, −f v₁."""

    def __init__(self, hand, dry, held, start):
        self.hand, self.dry, self.held = hand, np.array(dry), np.array(held)
        self.mass, self.drag = np.array([0.03, 0.03 + hand.hand.mass]), np.array([0.06, 0.09])
        self.sides, self.changes = np.full(2, np.sign(start)), 0

    def forces(self, t, z, f, push, speed, anchor):
        """On either body, all but its dry friction."""
        x, v = z[0:4:2], z[1:4:2]
        inside = STIFFNESS * (x[0] - x[1]) + 0.2 * (v[0] - v[1])
        own = push + self.hand.hand.stiffness * (anchor + speed * t - x[1])
        return np.array([-f - inside, own + self.hand.hand.damping * (speed - v[1]) + inside]) - self.drag * v

    def slopes(self, t, z, f, *given):
        """z'."""
        v = z[1:4:2]
        a = (self.sides != 0) * (self.forces(t, z, f, *given) - self.sides * self.dry) / self.mass
        lost = [*self.drag * v**2, 0.2 * (v[0] - v[1]) ** 2, self.dry @ np.abs(v), -f * v[0]]
        return np.array([v[0], a[0], v[1], a[1], *lost])

    def margin(self, i, t, z, *given):
        """Falls through 0 where a body stops or starts."""
        return self.sides[i] * z[2 * i + 1] or self.held[i] - abs(self.forces(t, z, *given)[i])

    def through(self, now, z, *given):
        """To the end of a sample interval, from its beginning or an event."""
        force = self.forces(now, z, *given)
        starts = np.where(np.abs(force) > self.held, np.sign(force), 0)
        self.sides = np.where(z[1:4:2] == 0, starts, self.sides)
        events = [lambda t, z, *given, i=i: self.margin(i, t, z, *given) for i in range(2)]
        for event in events:
            event.terminal, event.direction = True, -1
        tight = {"rtol": 1e-12, "atol": 1e-15, "max_step": T / 8}
        found = solve_ivp(self.slopes, (now, T), z, "DOP853", args=given, events=events, **tight)
        now, z = found.t[-1], found.y[:, -1]
        for i in (i for i in range(2) if found.t_events[i].size):
            self.changes += 1
            z[2 * i + 1] = np.copysign(1e-300, self.forces(now, z, *given)[i]) if self.sides[i] == 0 else 0
            self.sides[i] = np.sign(z[2 * i + 1])
        return z if now == T else self.through(now, z, *given)


@pytest.mark.parametrize(
    ("stiffness", "start", "motor", "handle"),
    [(276, 0.2, 0.02, 0.05), (60, 0.0, 0.05, 0.5), (1000, 0.0, 0.25, 0.02), (60, 0.01, 0.3, 0.3)],
)
def test_with_dry_friction_it_is_what_an_integrator_with_events_finds(stiffness, start, motor, handle):
    """Each side stops, sticks and starts by itself, and every loss is the integral of its power."""
    hand, samples = Held(), 60
    rough = CABLE.replace(handle_coulomb_friction=handle)
    device = MOTOR.replace(coulomb_friction=motor, stiction=1.3 * motor, transmission=rough)
    trace = zw.simulate(device, spring(stiffness), hand, samples * T, initial_velocity=start)
    bodies = Bodies(hand, (motor, handle), (1.3 * motor, handle), start)
    rows, signals = (
        [np.array([0, start, 0, start, 0, 0, 0, 0, 0.0])],
        hand.signals(np.arange(samples + 1) * T),
    )
    for (a, b), push in zip(pairwise(signals.anchor), signals.force, strict=True):
        rows.append(bodies.through(0.0, rows[-1], stiffness * rows[-1][0], push, (b - a) / T, a))
    found = np.transpose(rows)
    found[5] += found[4]
    names = "motor_position motor_velocity position velocity motor_viscous_loss viscous_loss "
    agree(trace, names + "transmission_loss coulomb_loss actuator_work", found, 2e-9)
    assert bodies.changes >= trace.attrs["stops"] >= 4


@pytest.mark.parametrize("amplifier", ["Ideal", "VoltageLimited", "FirstOrderLag"])
def test_a_prescribed_handle_is_the_anchor_of_a_motor_on_its_cable(amplifier):
    """To the plant of one mass, whose hand is the cable."""
    power = {"force_limit": 2, "current_limit": 1, "supply_voltage": 12, "motor_inductance": 2e-3}
    device = MOTOR.replace(coulomb_friction=0.3, stiction=0.4, delay=0.4e-3, **power)
    drive = getattr(zw.amplifiers, amplifier)(*[4e-4] * (amplifier == "FirstOrderLag"))
    cable = Held(LinearHand(0.0, STIFFNESS, 0.2), push=0.0)
    path = zw.operators.PrescribedMotion(cable.signals(np.arange(81) * T).anchor)
    how = {"duration": 80 * T, "amplifier": drive, "points_per_sample": 3}
    one = zw.simulate(device.motor_side, spring(900), cable, **how)
    assert one.attrs["stops"] > 4
    two = zw.simulate(device, spring(900), path, **how)
    rows = [one[name].values for name in ("position", "viscous_loss", "coulomb_loss", "actuator_work")]
    agree(two, "motor_position motor_viscous_loss motor_coulomb_loss actuator_work", rows, 1e-12)


def test_a_hand_takes_energy_that_the_motor_swings_out_on_its_cable():
    """Below 2 b₁/T the same knock comes to rest; what one mass would promise is no promise."""
    cable = CABLE.replace(damping=0, handle_coulomb_friction=0.01)
    device = MOTOR.replace(coulomb_friction=0.01, transmission=cable)
    hand = Held(LinearHand(0.3, 3000.0, 0.5), swing=0.0, push=0.0)
    swings, rests = (zw.simulate(device, spring(k), hand, 8, initial_velocity=1.2) for k in (276, 110))
    power = -np.diff(swings.hand_work.values[[-1001, -1]])[0]  # over the last second
    assert swings.zwidth.energy.active
    assert 0.2 < power < 0.3
    assert np.ptp(rests.motor_position.values[-1000:]) == np.ptp(rests.position.values[-1000:]) == 0
    agree(swings, "", [], 0)


def test_what_is_not_simulated_is_refused(tmp_path):
    hand = Held()
    for key in ("stiffness", "handle_mass"):
        with pytest.raises(zw.InputError, match=f"transmission.{key}"):
            zw.simulate(MOTOR.replace(transmission=CABLE.replace(**{key: None})), spring(1), hand, 1)
    with pytest.raises(zw.InputError, match="interval"):
        zw.simulate(MOTOR.replace(transmission=CABLE.replace(damping=(0, 1))), spring(1), hand, 1)
    trace = zw.simulate(MOTOR, spring(1), hand, 0.1)
    trace.zwidth.save(tmp_path / "it.csv")
    assert zw.traces.load_trace(tmp_path / "it.csv").identical(trace)
