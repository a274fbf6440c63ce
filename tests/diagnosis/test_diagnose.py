"""Things that shake for one reason, simulated: the diagnosis, whether its change helps, a stated law."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from two_arms import written

import zwidth as zw
from zwidth.data.diagnosis import CAUSES
from zwidth.data.diagnosis.recording import Told, read_of_table
from zwidth.data.diagnosis.stated import compare
from zwidth.data.logs.table import Table, in_pieces

PERIOD = 0.001
RNG = np.random.default_rng(3)


def log_of(path: Path, trace: Any, *forces: str) -> Path:
    columns = {"time_s": trace["time"].values, "position_m": trace["measured_position"].values}
    return written(path, columns | {f"{name}_N": trace[name].values for name in forces})


BOTH = ("commanded_force", "actuator_force")


def released(device: zw.Device, law: Any, seconds: float = 1.5) -> Any:
    """Let go off the middle of a law that acts on both sides, nobody's hand on it."""
    nobody = zw.operators.ConstantForce(force=0.003)
    trace = zw.simulate(device, law, nobody, seconds, initial_position=0.02)
    return trace.assign(actuator_force=trace.actuator_force + RNG.normal(0, 0.002, trace.sizes["time"]))


def centring(stiffness: float, damping: float = 0.0, window: int = 1) -> zw.PulseTransferFunction:
    """K + B (1 − z⁻ᴺ)/(N T) on both sides."""
    gain = damping / (window * PERIOD)
    return zw.PulseTransferFunction([stiffness + gain, *[0] * (window - 1), -gain], [1, *[0] * window])


def paddle(**other: Any) -> zw.Device:
    numbers = {
        "mass": 0.06, "damping": 0.12, "coulomb_friction": 0.004, "resolution": 5e-6, "sample_period": PERIOD
    }  # fmt: skip
    return zw.Device(**(numbers | {"force_limit": 30} | other))


FAULTS = {
    "sampling": (paddle(), paddle(), centring(900)),
    "delay": (paddle(delay=0.003), paddle(), centring(150)),
    "differenced velocity": (paddle(), paddle(), centring(150, 25, 10)),
    "friction compensation": (
        paddle(coulomb_friction=0.05),
        paddle(coulomb_friction=0.05),
        zw.render(centring(150), zw.FrictionCompensation(coulomb=0.3, speed=0.002)),
    ),
}
"""The cause; the device as it is, as its owner knows it, and the law."""


@pytest.mark.parametrize("cause", FAULTS)
def test_a_fault_is_named_and_its_change_is_passive(cause, tmp_path):
    true, known, law = FAULTS[cause]
    found = zw.diagnose(log_of(tmp_path / "log.csv", released(true, law), *BOTH), known)
    assert found.cause == cause
    assert found.confidence >= 0.6
    assert found.evidence
    assert found.energy_per_cycle > 0
    assert found.change.to < found.change.current
    verdict = zw.check(found.change.device, found.change.environment)
    assert verdict.outcome == found.change.verdict.outcome
    assert verdict.outcome in ("passive", "passive in contact")


def test_the_thing_is_quiet_with_the_stiffness_that_is_advised(tmp_path):
    found = zw.diagnose(log_of(tmp_path / "log.csv", released(paddle(), centring(900)), *BOTH), paddle())
    assert found.change.parameter == "stiffness"
    softer = released(paddle(), centring(found.change.to))
    speed = np.abs(softer["velocity"].values)
    assert speed[-200:].max() < 0.8 * speed[:200].max()
    assert np.abs(released(paddle(), centring(900))["velocity"].values[-200:]).max() > 0.5


def test_the_command_alone_does_not_show_what_lies_behind_it(tmp_path):
    trace = released(paddle(delay=0.002), centring(150))
    found = zw.diagnose(log_of(tmp_path / "log.csv", trace, "commanded_force"), paddle())
    assert found.cause in (None, "delay")
    assert found.change is None
    assert "motor's own force" in found.record[0]


def test_one_command_of_an_unknown_device_is_of_two_causes(tmp_path):
    """The same file, to the last digit, from a late force and from a damper inside the drive: not told.

    x = X cos ωt and f = K x satisfy the motion of both loops, m ẍ + b ẋ + K x(t − τ) = 0 with one mass, and
    m' ẍ + b' ẋ + K x + B v(t − σ) = 0 with another.  The mass, or the motor's force, would tell.
    """
    stiffness, w, late, old = 150.0, 2 * np.pi * 9.0, 0.004, 0.035
    mass, damping = stiffness * np.cos(w * late) / w**2, stiffness * np.sin(w * late) / w
    drives = 3.0
    heavier = (stiffness + drives * w * np.sin(w * old)) / w**2
    other = -drives * np.cos(w * old)
    s = 1j * w
    assert min(mass, damping, heavier, other) > 0
    assert abs(mass * s**2 + damping * s + stiffness * np.exp(-s * late)) < 1e-9
    assert abs(heavier * s**2 + other * s + stiffness + drives * s * np.exp(-s * old)) < 1e-9
    assert heavier > 1.5 * mass
    t = np.arange(2000) * PERIOD
    x = np.round(0.01 * np.cos(w * t) / 5e-6) * 5e-6
    columns = {"time_s": t, "position_m": x, "commanded_force_N": stiffness * x}
    found = zw.diagnose(written(tmp_path / "log.csv", columns))
    assert found.cause is None
    assert "motor's own force" in found.record[0]
    assert "the device's numbers" in found.record[1]


def test_rest_is_no_vibration(tmp_path):
    trace = released(paddle(damping=1.5), centring(300))
    found = zw.diagnose(log_of(tmp_path / "log.csv", trace.isel(time=slice(200, None)), *BOTH), paddle())
    assert found.cause is None
    assert found.seen is None or found.confidence == 0
    assert found.record


def test_a_trace_is_a_recording():
    found = zw.diagnose(released(paddle(delay=0.003), centring(150)), paddle())
    assert found.cause == "delay"
    assert next(iter(found.likely)) == "delay"
    assert sum(found.likely.values()) == pytest.approx(1)
    assert set(found.likely) == set(CAUSES)


def test_what_was_found_is_kept_as_json_as_a_loop_and_as_a_picture(tmp_path):
    found = zw.diagnose(zw.samples.path("shaking.csv"), zw.load(zw.samples.path("wheel.toml")).device)
    document = found.to_dict()
    assert document["cause"] == "delay"
    assert document["law"]["stiffness_N_m_per_rad"] == pytest.approx(20, rel=1e-3)
    assert document["delay_s"] == pytest.approx(0.004)
    found.save(tmp_path / "mended.toml")
    loop = zw.load(tmp_path / "mended.toml")
    assert zw.check(loop.device, loop.environment).outcome == document["change"]["outcome"]
    with pytest.raises(zw.InputError, match="exists"):
        found.save(tmp_path / "mended.toml")
    found.plot(tmp_path / "why.svg")
    assert (tmp_path / "why.svg").stat().st_size > 1000


@pytest.mark.parametrize(
    ("forces", "message"),
    [(["hand_force_N"], "actuator's force"), (["commanded_force_N", "cmd_force_N"], "may each be")],
)
def test_a_file_without_the_force_it_takes_is_refused(tmp_path, forces, message):
    k = np.arange(60)
    columns = {"time_s": k * PERIOD} | dict.fromkeys(["position_mm", *forces], np.sin(k))
    with pytest.raises(zw.InputError, match=message):
        zw.diagnose(written(tmp_path / "log.csv", columns))


def test_forces_that_are_not_recorded_side_by_side_are_told_apart_from_a_fault(tmp_path):
    """A stretch in which one of them is missing: the rows of the two do not belong together."""
    trace = released(paddle(), centring(900), 0.4)
    trace.actuator_force[150:155] = np.nan
    path = log_of(tmp_path / "gap.csv", trace, *BOTH)
    with pytest.raises(zw.InputError, match=r"401 rows from 0 s of the command and 246 rows from 155 ms"):
        zw.diagnose(path, paddle())
    assert zw.diagnose(path, paddle(), columns={"actuator_force": None}).seen.recorded == "command"


def test_both_forces_of_a_served_loop_are_known():
    """What the law wished for and what was given, by the names that a recording of `zwidth serve` has."""
    columns = {name: np.arange(600) * 1e-3 for name in ("time_s", "position_m", "wished_force_N", "force_N")}
    columns["position_m"] = np.round(1e6 * np.sin(60 * columns["time_s"])) * 1e-8
    table = Table(
        source="run.mcap",
        units=dict.fromkeys(columns),
        read=lambda names: in_pieces("run.mcap", columns, names),
        means={"time": "time_s", "position": "position_m", "hand_force": None, "actuator_force": "force_N"},
    )
    taken = read_of_table(table, Told({}, {}, {}, {}))
    assert taken.commanded is not None
    assert taken.applied is not None
    assert not any("taken as the force" in finding for finding in taken.findings)


def test_a_force_is_held_beside_a_law():
    x = np.cumsum(RNG.normal(size=1200)) * 1e-5
    speed = np.diff(x, prepend=x[0]) / PERIOD
    smooth, slow = np.zeros_like(x), 0.004
    for k in range(1, x.size):
        smooth[k] = (slow * smooth[k - 1] + (x[k] - x[k - 1])) / (slow + PERIOD)
    asked = 240 * (x - x[0]) + 3 * smooth - 0.02 * np.tanh(speed / 0.01)
    wall = zw.Wall(240, 3, velocity_filter=zw.rendering.OnePole(slow))
    law = zw.render(wall, zw.FrictionCompensation(coulomb=0.02, speed=0.01))
    lags = [k * PERIOD for k in range(4)]
    same = compare(law, x, 0.3 + np.append(asked[[0, 0]], asked[:-2]), PERIOD, PERIOD, lags, of_command=True)
    assert same.holds
    assert (same.lag, same.gain) == (pytest.approx(2 * PERIOD), 1.0)
    assert np.ptp(same.asked - asked) == pytest.approx(0, abs=1e-9)
    half = compare(law, x, 0.45 * asked, PERIOD, PERIOD, lags, of_command=True)
    assert not half.holds
    assert half.gain == pytest.approx(0.45, rel=1e-6)
    assert "0.45 times" in next(half.sentences())
    other = compare(law, x, RNG.normal(size=x.size), PERIOD, PERIOD, lags, of_command=True)
    assert not other.holds
    assert "is not that of the law" in next(other.sentences())


def test_with_its_law_the_motors_force_alone_shows_what_lies_between(tmp_path):
    """3 ms late: the command is computed, and the delay seen; check calls the loop as stated passive."""
    law = zw.PulseTransferFunction([150.0], [1.0])
    path = log_of(tmp_path / "log.csv", released(paddle(delay=0.003), law), "actuator_force")
    found = zw.diagnose(path, paddle(), law=law)
    assert found.cause == "delay"
    assert found.seen.recorded == "both"
    assert found.seen.delay == pytest.approx(0.003, abs=1e-4)
    assert "computed from the law" in found.stated[0]
    assert "PASSIVE" in found.stated[1]
    assert found.to_dict()["stated"]["holds"]


def cut_off(path, wall, limit):
    """The log of a wall against which a motor can do so much, as a controller logs what it gave to it."""
    hand = zw.operators.ConstantForce(force=0.4 * limit)
    trace = zw.simulate(paddle(force_limit=limit), wall, hand, 2.0, initial_position=-0.01)
    return log_of(path, trace.assign(commanded_force=trace.actuator_force), *BOTH)


def test_a_force_that_is_off_or_at_its_limit_is_that_of_many_laws(tmp_path):
    """A wall of 40 N/mm and a motor of 5 N: not told, and the law asked for; with it, sampling."""
    wall = zw.Wall("40 N/mm")
    path = cut_off(tmp_path / "log.csv", wall, 5)
    alone = zw.diagnose(path, paddle())
    assert alone.cause is None
    assert any("law that was programmed" in wanted for wanted in alone.record)
    found = zw.diagnose(path, paddle(), law=wall)
    assert found.cause == "sampling"
    assert (found.change.parameter, found.change.current) == ("stiffness", 40000)
    assert "ACTIVE" in found.stated[-1]


def test_a_few_rows_between_two_limits_tell_the_law(tmp_path):
    found = zw.diagnose(cut_off(tmp_path / "log.csv", zw.Wall("12 N/mm"), 5), paddle())
    assert found.cause == "sampling"
    assert found.seen.law.stiffness == pytest.approx(12000, rel=1e-6)


def test_a_damper_that_shakes_by_a_count_or_two_is_named(tmp_path):
    """Its estimate is none or one count, for which the motor is too weak."""
    device = paddle(mass=0.3, damping=2.5, coulomb_friction=0.006, force_limit=3.3)
    hand = zw.operators.ConstantForce(force=1.55)
    trace = zw.simulate(device, zw.Wall(2000, 600), hand, 3.0, initial_velocity=0.03)
    found = zw.diagnose(log_of(tmp_path / "log.csv", trace, *BOTH), device)
    assert found.seen.counts < 2
    assert found.cause == "differenced velocity"
    assert found.seen.law.damping == pytest.approx(600, rel=1e-6)
    assert found.seen.pulse == pytest.approx((600 * 5e-6) ** 2 / (2 * 0.3))
    assert any("each count" in line for line in found.evidence)


def test_a_part_in_which_the_force_alone_jumps_is_found_and_dated(tmp_path):
    """Three seconds of twenty at a wall that is on or off, 100 rows a second, while a hand moves slowly."""
    t = np.arange(2000) * 0.01
    rng = np.random.default_rng(5)
    inside = (t > 12) & (t < 15)
    x = np.where(inside, 0.3, 0.3 - 0.2 * np.sin(0.7 * (t - 12)) ** 2)
    x = np.round((x + 2e-4 * rng.normal(size=t.size)) / 2e-4) * 2e-4
    force = np.where(inside, 0.95 * rng.choice([-1, 1], t.size), 0.0)
    columns = {"time_s": t, "angle_rad": x, "torque_N_m": force}
    found = zw.diagnose(written(tmp_path / "log.csv", columns))
    assert found.cause is None
    assert found.seen.vibration.of_force
    begin, end = (float(text) for text in re.findall(r"from ([\d.]+) s to ([\d.]+) s", found.claim)[0])
    assert begin == pytest.approx(12, abs=0.2)
    assert end == pytest.approx(15, abs=0.2)
    assert "every sample of the loop" in found.record[0]


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ({"device": paddle()}, "rotary"),
        (
            {"law": zw.render(zw.Wall(20), zw.rendering.PassivityController())},
            "friction-compensation of Coulomb friction alone",
        ),
        ({"law": zw.HuntCrossley(stiffness=20, exponent=1.5, dissipation=0)}, r"H\(z\)"),
    ],
)
def test_a_device_or_a_law_of_another_kind_is_refused(asked, message):
    with pytest.raises(zw.InputError, match=message):
        zw.diagnose(zw.samples.path("shaking.csv"), **asked)
