"""A law that somebody states, beside a force: the same, another gain, another law, the motor's alone."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import zwidth as zw
from zwidth.data.diagnosis.stated import compare

PERIOD = 0.001
RNG = np.random.default_rng(8)


def paddle(**other: Any) -> zw.Device:
    """A light paddle with little friction and a motor of 30 N."""
    numbers = {
        "mass": 0.06,
        "damping": 0.12,
        "coulomb_friction": 0.004,
        "resolution": 5e-6,
        "force_limit": 30,
    }
    return zw.Device(**(numbers | {"sample_period": PERIOD} | other))


def logged(path: Path, trace: Any, *forces: str) -> Path:
    """A file of a trace, with the forces that its owner records."""
    columns = {"time_s": trace["time"].values, "position_m": trace["measured_position"].values}
    columns |= {f"{name}_N": trace[name].values for name in forces}
    header = ",".join(columns)
    np.savetxt(
        path, np.stack([*columns.values()], axis=1), fmt="%.7f", delimiter=",", header=header, comments=""
    )
    return path


def held(values: np.ndarray, samples: int) -> np.ndarray:
    """The same, so many samples later."""
    return np.concatenate([np.full(samples, values[0]), values[: values.size - samples]])


def test_a_force_is_held_beside_a_law() -> None:
    """Spring, filtered damper and compensation against their recursion; a lag, and a gain that is another."""
    x = np.cumsum(RNG.normal(size=1200)) * 1e-5
    speed = np.diff(x, prepend=x[0]) / PERIOD
    smooth, slow = np.zeros_like(x), 0.004
    for k in range(1, x.size):
        smooth[k] = (slow * smooth[k - 1] + (x[k] - x[k - 1])) / (slow + PERIOD)
    asked = 240 * (x - x[0]) + 3 * smooth - 0.02 * np.tanh(speed / 0.01)
    wall = zw.Wall(240, 3, velocity_filter=zw.rendering.OnePole(slow))
    law = zw.render(wall, zw.FrictionCompensation(coulomb=0.02, speed=0.01))
    lags = [k * PERIOD for k in range(4)]
    same = compare(law, x, 0.3 + held(asked, 2), PERIOD, PERIOD, lags, of_command=True)
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


def test_with_its_law_the_motors_force_alone_shows_what_lies_between(tmp_path: Path) -> None:
    """3 ms late: the command is computed, and the delay seen; check calls the loop as stated passive."""
    law = zw.PulseTransferFunction([150.0], [1.0])
    nobody = zw.operators.ConstantForce(force=0.003)
    trace = zw.simulate(paddle(delay=0.003), law, nobody, 1.5, initial_position=0.02)
    path = logged(tmp_path / "log.csv", trace, "actuator_force")
    found = zw.diagnose(path, paddle(), law=law)
    assert found.cause == "delay"
    assert found.seen is not None
    assert found.seen.recorded == "both"
    assert found.seen.delay == pytest.approx(0.003, abs=1e-4)
    assert "computed from the law" in found.stated[0]
    assert "PASSIVE" in found.stated[1]
    assert found.to_dict()["stated"]["holds"]


def test_a_force_that_is_off_or_at_its_limit_is_that_of_many_laws(tmp_path: Path) -> None:
    """A wall of 12 N/mm and a motor of 5 N: not told, and the law asked for; with it, sampling."""
    hand = zw.operators.ConstantForce(force=2.0)
    wall = zw.Wall("12 N/mm")
    trace = zw.simulate(paddle(force_limit=5), wall, hand, 2.0, initial_position=-0.01)
    cut = trace.assign(commanded_force=trace.actuator_force)  # the controller logs what it gave to the motor
    path = logged(tmp_path / "log.csv", cut, "commanded_force", "actuator_force")
    alone = zw.diagnose(path, paddle())
    assert alone.cause is None
    assert any("law that was programmed" in wanted for wanted in alone.record)
    found = zw.diagnose(path, paddle(), law=wall)
    assert found.cause == "sampling"
    assert found.change is not None
    assert (found.change.parameter, found.change.current) == ("stiffness", 12000)
    assert "ACTIVE" in found.stated[-1]


def test_a_law_that_cannot_be_held_beside_is_refused() -> None:
    """A controller behind the wall, a contact without H(z): one message each."""
    log = zw.samples.path("shaking.csv")
    with pytest.raises(zw.InputError, match="friction-compensation of Coulomb friction alone"):
        zw.diagnose(log, law=zw.render(zw.Wall(20), zw.rendering.PassivityController()))
    with pytest.raises(zw.InputError, match=r"H\(z\)"):
        zw.diagnose(log, law=zw.HuntCrossley(stiffness=20, exponent=1.5, dissipation=0))
