"""Motor and handle with a transmission between them, against roads that share nothing with its plant."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm

import zwidth as zw
from zwidth.model.operator.operator import LinearHand, Operator, Signals

T, STIFFNESS = 1e-3, 0.015 * (2 * np.pi * 60) ** 2
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


def touch(device, stiffness, hand, duration, **how):
    """Of a spring on both sides."""
    law = zw.PulseTransferFunction(numerator=(stiffness,), denominator=(1,))
    return zw.simulate(device, law, hand, duration, **how)


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
    hand, times = Held(swing=0.0, push=-0.2), np.arange(301) * T
    a = np.zeros((6, 6))  # x₁ v₁ x₂ v₂, f and the hand's push
    a[0, 1] = a[2, 3] = 1
    a[1] = np.array([-STIFFNESS, -0.06 - damping, STIFFNESS, damping, -1, 0]) / 0.03
    a[3] = np.array([STIFFNESS, damping, -STIFFNESS - 900, -0.59 - damping, 0, 1]) / 0.13
    step, z, found = expm(a * T), np.array([0, start, 0, start, 0.0, 0.0]), []
    for push in [*hand.signals(times).force, 0.0]:
        z[4:] = 276 * z[0 if encoder == "motor" else 2], push
        found.append(z)
        z = step @ z
    names = "motor_position motor_velocity position velocity actuator_force"
    trace = touch(device, 276, hand, 0.3, initial_velocity=start)
    agree(trace, names, np.transpose(found)[:5], 1e-13)


def integrated(hand, dry, held, start, intervals):
    """By an integrator with events: (x₁ v₁ x₂ v₂, work of b₁, b₂, c, f_c and −f), how many there are."""
    mass, drag, changes = np.array([0.03, 0.03 + hand.mass]), np.array([0.06, 0.09]), 0
    rows, sides = [np.array([0, start, 0, start, 0, 0, 0, 0, 0.0])], np.full(2, np.sign(start))

    def forces(t, z, f, push, speed, anchor):  # but for dry friction
        x, v = z[0:4:2], z[1:4:2]
        inside = STIFFNESS * (x[0] - x[1]) + 0.2 * (v[0] - v[1])
        own = push + hand.stiffness * (anchor + speed * t - x[1]) + hand.damping * (speed - v[1])
        return np.array([-f - inside, own + inside]) - drag * v

    def slopes(t, z, f, *given):
        v = z[1:4:2]
        a = (sides != 0) * (forces(t, z, f, *given) - sides * dry) / mass
        lost = *drag * v**2, 0.2 * (v[0] - v[1]) ** 2, dry @ abs(v), -f * v[0]
        return np.array([v[0], a[0], v[1], a[1], *lost])

    def margin(i, t, z, *given):  # of a side until it stops or starts
        return sides[i] * z[2 * i + 1] if sides[i] else held[i] - abs(forces(t, z, *given)[i])

    events = [lambda *given, i=i: margin(i, *given) for i in range(2)]
    for event in events:
        event.terminal, event.direction = True, -1
    how = {"method": "DOP853", "events": events, "rtol": 1e-12, "atol": 1e-15, "max_step": T / 8}
    for k, *others in intervals:
        now, z, given = 0.0, rows[-1], (k * rows[-1][0], *others)
        while now < T:
            e = forces(now, z, *given)
            sides = np.where(z[1:4:2] == 0, np.where(abs(e) > held, np.sign(e), 0), sides)
            found = solve_ivp(slopes, (now, T), z, args=given, **how)
            now, z = found.t[-1], found.y[:, -1]
            for i in (i for i in range(2) if found.t_events[i].size):
                changes, start = changes + 1, np.sign(forces(now, z, *given)[i])
                sides[i], z[2 * i + 1] = (start, 1e-300 * start) if sides[i] == 0 else (0, 0)
        rows.append(z)
    return np.transpose(rows), changes


@pytest.mark.parametrize(
    ("stiffness", "start", "motor", "handle"),
    [(276, 0.2, 0.02, 0.05), (60, 0.0, 0.05, 0.5), (1000, 0.0, 0.25, 0.02), (60, 0.01, 0.3, 0.3)],
)
def test_with_dry_friction_it_is_what_an_integrator_with_events_finds(stiffness, start, motor, handle):
    """Each side stops, sticks and starts by itself, and every loss is the integral of its power."""
    hand, rough = Held(), CABLE.replace(handle_coulomb_friction=handle)
    device = MOTOR.replace(coulomb_friction=motor, stiction=1.3 * motor, transmission=rough)
    push, anchor, _, _ = hand.signals(np.arange(61) * T)
    intervals = zip([stiffness] * 60, push, np.diff(anchor) / T, anchor, strict=False)
    dry, held = np.array([motor, handle]), np.array([1.3 * motor, handle])
    rows, changes = integrated(hand.hand, dry, held, start, intervals)
    rows[5] += rows[4]
    names = "motor_position motor_velocity position velocity motor_viscous_loss viscous_loss "
    trace = touch(device, stiffness, hand, 0.06, initial_velocity=start)
    agree(trace, names + "transmission_loss coulomb_loss actuator_work", rows, 2e-9)
    assert changes >= trace.attrs["stops"] >= 4


@pytest.mark.parametrize("amplifier", ["Ideal", "VoltageLimited", "FirstOrderLag"])
def test_a_prescribed_handle_is_the_anchor_of_a_motor_on_its_cable(amplifier):
    """To the plant of one mass, whose hand is the cable."""
    power = {"force_limit": 2, "current_limit": 1, "supply_voltage": 12, "motor_inductance": 2e-3}
    device = MOTOR.replace(coulomb_friction=0.3, stiction=0.4, delay=0.4e-3, **power)
    drive = getattr(zw.amplifiers, amplifier)(*[4e-4] * (amplifier == "FirstOrderLag"))
    cable = Held(LinearHand(0.0, STIFFNESS, 0.2), push=0.0)
    path = zw.operators.PrescribedMotion(cable.signals(np.arange(81) * T).anchor)
    how = {"amplifier": drive, "points_per_sample": 3}
    one, two = touch(device.motor_side, 900, cable, 0.08, **how), touch(device, 900, path, 0.08, **how)
    assert one.attrs["stops"] > 4
    rows = [one[name].values for name in ("position", "viscous_loss", "coulomb_loss", "actuator_work")]
    agree(two, "motor_position motor_viscous_loss motor_coulomb_loss actuator_work", rows, 1e-12)


def test_a_hand_takes_energy_that_the_motor_swings_out_on_its_cable(tmp_path):
    """Below 2 b₁/T the same knock comes to rest; what one mass would promise is no promise."""
    cable = CABLE.replace(damping=0, handle_coulomb_friction=0.01)
    device, hand = MOTOR.replace(coulomb_friction=0.01, transmission=cable), LinearHand(0.3, 3000.0, 0.5)
    swings, rests = (touch(device, k, Held(hand, 0.0, 0.0), 8, initial_velocity=1.2) for k in (276, 110))
    assert swings.zwidth.energy.active
    assert 0.2 < -np.diff(swings.hand_work.values[[-1001, -1]])[0] < 0.3  # in the last second
    assert np.ptp(rests.motor_position.values[-1000:]) == np.ptp(rests.position.values[-1000:]) == 0
    agree(swings, "", [], 0)
    swings.zwidth.save(tmp_path / "it.csv")
    assert zw.traces.load_trace(tmp_path / "it.csv").identical(swings)


@pytest.mark.parametrize("unknown", [{"stiffness": None}, {"handle_mass": None}, {"damping": (0, 1)}])
def test_what_is_not_known_is_refused(unknown):
    with pytest.raises(zw.InputError, match=rf"transmission\.{next(iter(unknown))} is "):
        touch(MOTOR.replace(transmission=CABLE.replace(**unknown)), 1, Held(), 1)


@dataclass(frozen=True)
class Led(Operator):
    """A hand that leads the handle to and fro."""

    @property
    def kinematic(self):
        return True

    def signals(self, times):
        return Signals(position=2e-3 * (1 + np.sin(2 * np.pi * 3 * times)))

    def describe(self, motion="linear"):
        return "a path"


@pytest.mark.parametrize("delay", [0, 4e-4])
@pytest.mark.parametrize("dry", [0, 0.02])
@pytest.mark.parametrize(
    "hand", [Held(), Held(hand=LinearHand(0.1, 400.0, 0.0), swing=0.0), Led()], ids=["held", "still", "led"]
)
def test_a_stretch_that_comes_again_is_what_the_series_make_of_it(hand, dry, delay):
    """With a second instant in each sample the series are all there is: the motion is the same."""
    rough = CABLE.replace(handle_coulomb_friction=dry)
    device = MOTOR.replace(coulomb_friction=dry, resolution=1e-5, delay=delay, transmission=rough)
    how = {} if hand.kinematic else {"initial_velocity": 0.1}
    once, again = (zw.simulate(device, zw.Wall(100), hand, 0.5, points_per_sample=n, **how) for n in (1, 2))
    names = "position motor_position velocity motor_velocity hand_work viscous_loss transmission_loss"
    agree(once, names, [again[name].values[::2] for name in names.split()], 1e-11)


@pytest.mark.parametrize("drag", [0.0, 1e-3, 0.3, 3e2])
def test_every_joule_is_there_however_little_or_much_is_damped(drag):
    """Long runs: a table repeats its rounding, and is used only where damping takes that away."""
    rough = CABLE.replace(damping=drag, handle_damping=drag, handle_coulomb_friction=1e-4)
    device = MOTOR.replace(damping=drag, transmission=rough)
    trace = touch(device, 0.1, Held(hand=LinearHand(0.1, 300.0, 0.0)), 20, initial_velocity=0.2)
    agree(trace, "time", [trace.time.values], 1e-13)
