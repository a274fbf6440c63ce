"""Two arms that shake for one reason: what the diagnosis says, from every kind of file."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from two_arms import PERIOD, arms, moved, written

import zwidth as zw
from zwidth.data.diagnosis import PAIR_CAUSES
from zwidth.data.diagnosis.pairs.energy import arm_law
from zwidth.data.diagnosis.pairs.recording import holds_two_arms, read_pair
from zwidth.model.specification.load import load_pair
from zwidth.model.specification.write import written_pair

LATE_LINK = {"link": 4, "viscous": 0.05, "limit": 3.0}
RNG = np.random.default_rng(5)
UNITS = {"position": "rad", "actuator_force": "N*m"}

FAULTS: dict[str, tuple[dict[str, Any], dict[str, float]]] = {
    "link delay": (LATE_LINK, {"damping": 0.05}),
    "sampling": ({"stiffness": 60.0, "viscous": 0.008}, {"damping": 0.008}),
    "delay": ({"late": 3, "viscous": 0.04, "limit": 3.0}, {"damping": 0.04}),
    "damping": ({"link": 4, "damping": 1.2, "viscous": 0.12}, {"damping": 0.12}),
    "friction compensation": ({"compensation": 0.03, "viscous": 0.03}, {"damping": 0.03}),
}
"""How it is, and what its owner knows."""


@pytest.fixture(scope="module")
def shaken() -> dict[str, np.ndarray]:
    """Two arms that a link makes shake that is 4 ms late."""
    return moved(**LATE_LINK)


@pytest.mark.parametrize("cause", FAULTS)
def test_the_reason_is_named(cause, tmp_path):
    how, known = FAULTS[cause]
    found = zw.diagnose_pair(written(tmp_path / "arms.csv", moved(**how)), arms(**known))
    assert found.cause == cause
    assert found.confidence > 0.8
    assert set(found.likely) == set(PAIR_CAUSES)
    assert any(word in found.evidence[0] for word in (cause.split()[-1], "hold", "damper"))
    for fitted in found.seen.laws:
        assert fitted.stiffness == pytest.approx(how.get("stiffness", 20.0), rel=1e-3)
        assert fitted.link_delay == pytest.approx(PERIOD * how.get("link", 0))


def test_the_change_is_proved_and_makes_the_arms_quiet(shaken, tmp_path):
    found = zw.diagnose_pair(written(tmp_path / "arms.csv", shaken), arms(damping=0.05))
    assert found.change.parameter == "stiffness"
    assert found.change.to < found.change.current
    found.save(tmp_path / "mended.toml")
    pair = load_pair([tmp_path / "mended.toml"])
    assert pair == found.change.pair
    assert zw.check(pair).outcome == "passive" == found.to_dict()["change"]["outcome"]
    softer = moved(**(LATE_LINK | {"stiffness": found.change.to}))
    between = (each["leader_position_rad"] - each["follower_position_rad"] for each in (softer, shaken))
    quiet, loud = (np.ptp(distance[-300:]) for distance in between)
    assert quiet < 0.2 * loud
    found.plot(tmp_path / "why.svg")
    assert (tmp_path / "why.svg").stat().st_size > 1000
    assert "leader: stiffness" in dict(found.rows())


def test_what_is_not_in_the_file_is_not_named(tmp_path):
    """A delay behind the command: by the command alone, less goes in than friction takes."""
    columns = moved(late=3, viscous=0.04, limit=3.0)
    command = {name: values for name, values in columns.items() if "motor" not in name}
    found = zw.diagnose_pair(written(tmp_path / "arms.csv", command), arms(damping=0.04))
    assert found.cause is None
    assert found.change is None
    assert any("motor's own" in words for words in found.record)


def test_arms_that_are_moved_slowly_do_not_shake(tmp_path):
    """They say how long was looked, and what could have been seen."""
    t = np.arange(600) * PERIOD
    columns = {"time_s": t, "leader_position_rad": 0.05 * t, "follower_position_rad": 0.045 * t}
    columns |= {f"{arm}_torque_N_m": sign * 0.1 * t for arm, sign in (("leader", 1), ("follower", -1))}
    found = zw.diagnose_pair(written(tmp_path / "arms.csv", columns))
    assert found.cause is None
    assert "600 ms" in found.claim
    assert "8.3 Hz" in found.claim


def test_lists_in_parquet_as_a_robot_learning_dataset_has_them(shaken, tmp_path):
    rows = shaken["time_s"].size

    def joints(values: np.ndarray) -> pa.Array:
        both = np.stack([np.zeros(rows), values], axis=1)
        return pa.FixedSizeListArray.from_arrays(pa.array(both.ravel()), 2)

    columns = {
        "action": joints(shaken["leader_position_rad"]),
        "observation.state": joints(shaken["follower_position_rad"]),
        "action.effort": joints(shaken["leader_motor_torque_N_m"]),
        "observation.effort": joints(shaken["follower_motor_torque_N_m"]).cast(pa.list_(pa.float64())),
        "timestamp": shaken["time_s"].astype(np.float32),
        "frame_index": np.arange(rows),
        "episode_index": np.zeros(rows, int),
    }
    pq.write_table(pa.table(columns), tmp_path / "episode.parquet")
    names = {
        "leader_position": "action[1]",
        "follower_position": "observation.state[1]",
        "leader_actuator_force": "action.effort[1]",
        "follower_actuator_force": "observation.effort[1]",
    }
    found = zw.diagnose_pair(tmp_path / "episode.parquet", columns=names, units=UNITS)
    assert found.cause == "link delay"
    assert found.frequency == pytest.approx(9.5, rel=0.02)
    bare = {side: column for side, column in names.items() if "position" in side}
    without = tmp_path / "without.parquet"
    pq.write_table(pa.table({k: v for k, v in columns.items() if "effort" not in k}), without)
    for path, count in ((without, 1), (tmp_path / "episode.parquet", 2)):
        with pytest.raises(zw.InputError) as told:  # two efforts in a list: which of them is whose
            zw.diagnose_pair(path, columns=bare, units=UNITS)
        asked = re.findall(r'columns=\{"(\w+)"', str(told.value))
        assert asked[0] == "leader_actuator_force"
        assert not any(name.count("leader") + name.count("follower") > 1 for name in asked)
        assert ("without efforts" in str(told.value)) == (count == 1)
    one = {"position": "action[2]", "actuator_force": "action.effort[0]"}
    with pytest.raises(zw.InputError, match=r"action\[0\]"):
        zw.diagnose(tmp_path / "episode.parquet", columns=one)


@pytest.mark.parametrize("storage", ["MCAP", "SQLITE3"])
def test_a_bag_with_the_joint_states_of_both_arms(storage, shaken, tmp_path):
    from rosbags.rosbag2 import StoragePlugin, Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    time_type, header = store.types["builtin_interfaces/msg/Time"], store.types["std_msgs/msg/Header"]
    joint, none = store.types["sensor_msgs/msg/JointState"], np.empty(0)
    with Writer(tmp_path / "bag", version=9, storage_plugin=StoragePlugin[storage]) as writer:
        names = {arm: f"/{arm}/joint_states" for arm in ("leader", "follower")}
        topics = {a: writer.add_connection(n, joint.__msgtype__, typestore=store) for a, n in names.items()}
        for k, t in enumerate(shaken["time_s"]):
            for arm, connection in topics.items():
                now = 1_700_000_000_000_000_000 + round(t * 1e9) + (arm == "follower") * 90_000
                x, f = (shaken[f"{arm}_{name}"][k] for name in ("position_rad", "motor_torque_N_m"))
                stamp = header(stamp=time_type(*divmod(now, 10**9)), frame_id="")
                message = joint(stamp, ["elbow"], np.array([x]), none, np.array([f]))
                writer.write(connection, now, store.serialize_cdr(message, joint.__msgtype__))
    found = zw.diagnose_pair(tmp_path / "bag", units=UNITS)
    assert found.cause == "link delay"
    topic = names["leader"]
    leader = {"position": f"{topic}.position[elbow]", "actuator_force": f"{topic}.effort[elbow]"}
    one = zw.diagnose(tmp_path / "bag", columns=leader, units=UNITS)
    assert one.frequency == pytest.approx(found.frequency, rel=0.02)


def test_what_is_missing_is_asked_for_of_its_arm(shaken, tmp_path):
    bare = {name: values for name, values in shaken.items() if "follower" not in name or "position" in name}
    sides = {k.replace("leader", "left").replace("follower", "right"): v for k, v in shaken.items()}
    slider = zw.Device(mass=0.1, damping=1, coulomb_friction=0, sample_period=PERIOD)
    path = written(tmp_path / "arms.csv", shaken)
    for ask, message in (
        (
            lambda: zw.diagnose_pair(written(tmp_path / "bare.csv", bare)),
            r'the follower: .*actuator\'s force.*"follower_commanded_force"',
        ),
        (lambda: zw.diagnose(path), "diagnose_pair"),
        (lambda: zw.diagnose_pair(zw.samples.path("shaking.csv")), "no columns of a leader"),
        (lambda: zw.diagnose_pair(path, zw.Pair(slider, slider, stiffness=1)), "which is meant"),
        (lambda: zw.diagnose(written(tmp_path / "sides.csv", sides)), "If these are two arms"),
    ):
        with pytest.raises(zw.InputError, match=message):
            ask()


def test_the_law_of_an_arm():
    own, other = (np.cumsum(RNG.normal(size=800)) * 1e-3 for _ in range(2))
    late = ((own, 1), (own, 2), (other, 4), (other, 5))
    back = [np.concatenate([np.full(n, x[0]), x[: x.size - n]]) for x, n in late]
    v, its = (back[0] - back[1]) / PERIOD, (back[2] - back[3]) / PERIOD
    force = 31.0 * (back[0] - back[2]) + 0.2 * (v - its) + 0.05 * v - 0.3 * np.sign(v)
    lags = [k * PERIOD for k in range(4)]
    found = arm_law(own, other, force, PERIOD, PERIOD, lags, [k * PERIOD for k in range(6)])
    assert (found.lag, found.link_delay) == pytest.approx((PERIOD, 3 * PERIOD))
    gains = found.stiffness, found.damping, found.local_damping, found.compensation
    assert gains == pytest.approx((31.0, 0.2, 0.05, 0.3), rel=1e-4)
    assert found.unexplained < 1e-6


def test_a_pair_is_written_as_it_is_read(tmp_path):
    pair = arms().replace(
        stiffness="12.5 N*m/rad",
        damping="0.01 N*m*s/rad",
        local_damping="-0.003 N*m*s/rad",
        follower_stiffness=20,
        compensation=zw.FrictionCompensation(coulomb="0.004 N*m", speed="0.2 rad/s"),
    )
    (tmp_path / "pair.toml").write_text(written_pair(pair), encoding="utf-8")
    again = load_pair([tmp_path / "pair.toml"])
    assert again == load_pair([tmp_path / "pair.toml"])
    assert (again.stiffness, again.follower_stiffness, again.compensation) == (
        pair.stiffness, pair.follower_stiffness, pair.compensation,
    )  # fmt: skip


@pytest.mark.parametrize(
    "names",
    [
        ("time_s", "q_leader [rad]", "tau_leader [Nm]", "q_follower [rad]", "tau_follower [Nm]"),
        ("t [s]", "pos_master_rad", "torque_cmd_master_Nm", "pos_slave_rad", "torque_cmd_slave_Nm"),
        ("Time (s)", "Leader angle (rad)", "Leader torque (Nm)", "follower/q_rad", "follower/torque_Nm"),
    ],
)
def test_columns_of_an_arm_by_usual_names(shaken, names, tmp_path):
    """The arm stands before the name or behind it, the unit after both."""
    columns = {"time_s": shaken["time_s"]}
    columns |= {k: values for k, values in shaken.items() if k != "time_s" and "motor" not in k}
    path = tmp_path / "arms.csv"
    table = np.column_stack([*columns.values()])
    np.savetxt(path, table, fmt="%.7g", delimiter=",", header=",".join(names), comments="")
    assert holds_two_arms(path)
    taken = read_pair(path)
    for arm, recording in zip(("leader", "follower"), taken.arms, strict=True):
        assert recording.motion == "rotary"
        assert recording.position == pytest.approx(shaken[f"{arm}_position_rad"])
        assert recording.commanded == pytest.approx(shaken[f"{arm}_commanded_torque_N_m"], abs=1e-5)
