"""A joint that follows a target has no fault; a target that stands still takes nothing away."""

import numpy as np
import pytest
from two_arms import written

import zwidth as zw
from zwidth.data.diagnosis import vibration
from zwidth.data.logs.columns import is_target

PERIOD, SAMPLES = 0.004, 2000
TURNS = np.arange(SAMPLES) * PERIOD * 1.8


def eased(s):
    s = np.clip(s, 0, 1)
    return s**3 * (10 - 15 * s + 6 * s**2)


THERE_AND_BACK = 1 - np.abs(1 - 2 * (TURNS % 1))
TARGETS = {
    "sine": 0.3 * np.sin(2 * np.pi * TURNS),
    "to and fro": 0.6 * eased(THERE_AND_BACK) - 0.3,
    "pick and place": 0.6 * eased(1.6 * THERE_AND_BACK - 0.3) - 0.3,
    "at one speed": 0.6 * THERE_AND_BACK - 0.3,
    "steps": np.where(TURNS % 1 < 0.5, 0.2, -0.2),
}
JOINT = zw.Device(
    motion="rotary", mass=0.15, damping=0.6, coulomb_friction=0.4, resolution=2e-5, sample_period=PERIOD
)


def followed(target, stiffness=200.0, braking=8.0, late=0, friction=(0.6, 0.4)):
    """Position and both torques of a joint under K (r − x) − D v, friction taken off implicitly."""
    x, v, before, asked = target[0], 0.0, target[0], [0.0] * (late + 1)
    rows = []
    for r in target:
        read = round(x / 2e-5) * 2e-5
        asked = [stiffness * (r - read) - braking * (read - before) / PERIOD, *asked[:-1]]
        rows.append((read, asked[0], asked[-1]))
        before = read
        for _ in range(10):
            v += PERIOD / 10 * (asked[-1] - friction[0] * v) / 0.15
            v = np.sign(v) * max(abs(v) - PERIOD / 10 * friction[1] / 0.15, 0)
            x += PERIOD / 10 * v
    return dict(
        zip(("position_rad", "commanded_torque_N_m", "motor_torque_N_m"), np.array(rows).T, strict=True)
    )


def log_of(path, columns, *names):
    chosen = {name: columns[name] for name in ("position_rad", *names)}
    return written(path, {"time_s": np.arange(SAMPLES) * PERIOD} | chosen)


FORCES = [["commanded_torque_N_m"], ["motor_torque_N_m"], ["commanded_torque_N_m", "motor_torque_N_m"]]


@pytest.mark.parametrize("device", [None, JOINT], ids=["no device", "device"])
@pytest.mark.parametrize("kind", TARGETS)
def test_a_motion_that_is_commanded_has_no_cause(kind, device, tmp_path):
    columns = followed(TARGETS[kind]) | {"target_position_rad": TARGETS[kind]}
    columns["motor_torque_N_m"] = columns["motor_torque_N_m"] + np.random.default_rng(1).normal(
        0, 0.02, SAMPLES
    )
    for forces in FORCES:
        alone = zw.diagnose(log_of(tmp_path / "alone.csv", columns, *forces), device)
        assert alone.cause is None
        known = zw.diagnose(log_of(tmp_path / "known.csv", columns, *forces, "target_position_rad"), device)
        assert known.cause is None
        assert "the target stands still" in known.record[0]
        assert known.seen.aimed > 0.3


def test_the_target_is_that_of_the_run_that_is_looked_at(tmp_path):
    """Of two in one file, whose times each begin at 0, the longer one; which it is is told."""
    time = {"time_s": np.arange(SAMPLES) * PERIOD}
    before, now = (
        time | followed(TARGETS[k]) | {"target_position_rad": TARGETS[k]} for k in ("steps", "sine")
    )
    both = {name: np.concatenate([before[name][:1500], values]) for name, values in now.items()}
    one, two = (zw.diagnose(written(tmp_path / f"{len(c['time_s'])}.csv", c), JOINT) for c in (now, both))
    assert two.findings[0] == "run 2 of 2 is looked at, the longest: the others are left out"
    assert two.record == one.record
    assert two.seen.aimed == pytest.approx(one.seen.aimed, rel=1e-6)


@pytest.mark.parametrize("target", ["still", "slow"])
def test_a_late_force_is_named_about_a_target_that_does_not_shake(target, tmp_path):
    """Three samples late the loop shakes by itself, wherever it is led to."""
    aim = np.full(SAMPLES, 0.2) if target == "still" else 0.2 * np.sin(2 * np.pi * 0.15 * TURNS / 1.8)
    aim[:25] -= 0.1
    columns = followed(aim, 40.0, 0.0, 3, (0.3, 0.02)) | {"goal": aim}
    assert np.ptp(columns["position_rad"][-200:] - aim[-200:]) > 0.1
    found = zw.diagnose(
        log_of(tmp_path / "log.csv", columns, *FORCES[2], "goal"),
        JOINT.replace(damping=0.3, coulomb_friction=0.02),
        columns={"target_position": "goal"},
        units={"target_position": "rad"},
    )
    assert found.cause == "delay"
    assert found.seen.aimed < 0.05
    assert found.seen.law.stiffness == pytest.approx(40, rel=0.01)


@pytest.mark.parametrize("frequency", [0.5, 0.9, 1.3, 1.48, 1.5, 1.55, 1.6, 1.7, 1.8, 2.0, 2.5, 4.0])
@pytest.mark.parametrize("seconds", [12, 20])
def test_no_frequency_is_overlooked(frequency, seconds):
    t = np.arange(0, seconds, 0.004)
    found = vibration.find(0.1 * np.sin(2 * np.pi * frequency * t + 0.3), 0.004)
    assert found.frequency == pytest.approx(frequency, rel=0.02)


@pytest.mark.parametrize("frequency", [30, 7, 4])
def test_a_buzz_under_the_motion_of_a_hand_is_found(frequency):
    """Three seconds in twenty of slow strokes."""
    t = np.arange(0, 20, 0.002)
    buzz = np.where((t > 11) & (t < 14), 0.06 / frequency * np.sin(2 * np.pi * frequency * t), 0)
    found = vibration.find(0.2 * np.sin(2 * np.pi * 0.21 * t) + buzz, 0.002)
    assert found.frequency == pytest.approx(frequency, rel=0.05)
    assert 10.9 <= t[found.rows.start] < t[found.rows.stop - 1] <= 14.1


@pytest.mark.parametrize(
    ("yes", "names"),
    [
        (
            True,
            "target_position q_des setpoint cmd_pos desired_position_mm goal_position[3] Sollwinkel x_ref",
        ),
        (False, "target_velocity torque_cmd position desired_force target_torque reference_speed_rpm"),
    ],
)
def test_names_of_targets(yes, names):
    assert all(is_target(name) is yes for name in names.split())


def test_one_column_is_one_quantity(tmp_path):
    path = log_of(tmp_path / "log.csv", followed(TARGETS["sine"]), *FORCES[0])
    with pytest.raises(zw.InputError, match="as the position and as the actuator_force"):
        zw.diagnose(path, columns={"position": "position_rad", "actuator_force": "position_rad"})
