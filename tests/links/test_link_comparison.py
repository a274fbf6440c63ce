"""Ports beside each other: scores, table, picture, command, and a loop that keeps its forces back."""

from __future__ import annotations

import json
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

import zwidth as zw
from zwidth.cli.main import main
from zwidth.links import LinkComparison, Schedule, WavePort, held_back
from zwidth.quantity.spoken import answers_in

NAMES = {
    "waves with a ledger": "passive",
    "waves without a ledger": "active",
    "textbook waves": "active",
    "positions, last one held": "undecided",
    "time-domain passivity": "undecided",
    "two layers": "undecided",
}

ARM = {"mass": "50 g", "damping": "0.15 N*s/m", "coulomb_friction": "0.05 N", "resolution": "22.4 um"}
DEVICE = zw.Device(**ARM, rate="1 kHz", delay=0)
WHEEL = zw.Device(
    mass="0.03", damping="0.05", coulomb_friction="0.05", rate="1000", delay="0.0014", motion="rotary"
)
ROW = {"outcome": "passive", "taken": 0.0, "tracking_error": 0.02, "apart": 0.001, "felt_stiffness": 2.1}


@pytest.fixture
def file(tmp_path: Path) -> str:
    """The device in words."""
    told = "".join(f'{key} = "{value}"\n' for key, value in ARM.items())
    (tmp_path / "arm.toml").write_text(f'[device]\n{told}rate = "1 kHz"\ndelay = 0\n', encoding="utf-8")
    return str(tmp_path / "arm.toml")


@pytest.fixture(scope="module")
def compared() -> LinkComparison:
    return zw.links.compare(DEVICE, schedule=Schedule(delay="20 ms", jitter="10 ms", loss=0.5, burst=4))


def test_every_kind_of_port_has_its_row(compared: LinkComparison) -> None:
    scores = compared.scores
    found = dict(zip(scores["port"].values.tolist(), scores["outcome"].values.tolist(), strict=True))
    assert found == NAMES
    assert float(scores["taken"].sel(port="waves with a ledger")) == 0
    assert float(scores["taken"].sel(port="textbook waves")) > 1e-3
    assert scores["felt_stiffness"].attrs["units"] == "N/m"


def test_it_is_written_and_drawn(compared: LinkComparison, tmp_path: Path) -> None:
    assert "waves with a ledger" in str(compared)
    rows = {**compared.rows, "quiet": {**ROW, "outcome": "active"}}
    for outcome, known in (("active", "without delay one of them does"), ("undecided", "is not proved")):
        of_nothing = any(row["outcome"] == outcome and row["taken"] == 0 for row in rows.values())
        assert (f"{outcome} with 0: none of the hands" in str(replace(compared, rows=rows))) == of_nothing
        assert not of_nothing or known in str(replace(compared, rows=rows))
    compared.save(tmp_path / "links.json")
    ports = json.loads((tmp_path / "links.json").read_text())["ports"]
    assert set(ports) == set(NAMES)
    assert set(ports["two layers"]) >= {"taken_J", "tracking_error_m", "felt_stiffness_N_per_m"}
    compared.plot(tmp_path / "links.png")
    assert (tmp_path / "links.png").exists()


def test_the_command_says_the_same(file: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["links", file, "--delay", "2 ms", "--loss", "0.2", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["link"] == "2 ms each way, 20% lost"
    assert set(found["ports"]) == set(NAMES)


@pytest.mark.parametrize(
    ("more", "said"),
    [(["--loss", "1"], "below 1"), (["--delay", "3 m"], "delay"), (["--impedance", "0"], "> 0")],
)
def test_bad_input_is_said(file: str, capsys: pytest.CaptureFixture[str], more: list[str], said: str) -> None:
    assert main(["links", file, *more]) == 2
    assert said in capsys.readouterr().err


def test_other_laws_are_told_from_theorems() -> None:
    """A verdict is no truth value; what is no theorem says what was tried."""
    device = zw.Device(damping=0.15, coulomb_friction=0.1, rate=1000, delay=0)
    verdict = zw.links.check(zw.links.PositionHold(device, stiffness=1))
    assert verdict.outcome == "undecided"
    assert not verdict.passive
    naive = zw.links.check(zw.links.NaiveWaves(device))
    assert naive.outcome == "active"
    assert naive.to_dict()["motion"]["energy_J"] > 0
    assert "no packets" in "\n".join(naive.assumptions)


def test_a_rotary_device_has_its_own_units() -> None:
    numbers = {"mass": "2e-5 kg*m^2", "damping": "1e-3 N*m*s/rad", "coulomb_friction": "2 mN*m"}
    device = zw.Device(**numbers, rate=1000, delay="1 ms", motion="rotary")
    link = Schedule(delay="10 ms")
    ports = {"waves": (WavePort(device), WavePort(device))}
    found = zw.links.compare(device, schedule=link, ports=ports)
    assert found.scores["felt_stiffness"].attrs["units"] == "N*m/rad"
    assert float(found.scores["felt_stiffness"].sel(port="waves")) == pytest.approx(1e-3 / 0.012, rel=0.01)
    assert "w = 1 mN·m·s/rad" in ports["waves"][0].describe()


def test_ports_that_do_not_fit_are_refused() -> None:
    one = zw.Device(mass=0.05, damping=0.1, rate=1000, delay=0)
    with pytest.raises(zw.InputError, match="one sample period"):
        zw.links.compare(one, one.replace(rate=500))
    with pytest.raises(zw.InputError, match="standard ports"):  # those of one's own have their own devices
        zw.links.compare(WHEEL, ports={}, hold_back=True)
    with pytest.raises(zw.InputError, match=r"a port of zwidth\.links"):
        zw.links.simulate(one, one, Schedule(), None, None, 1)


@pytest.mark.parametrize("seed", range(4))
def test_hands_of_flesh_take_nothing_out_either(seed: int) -> None:
    leader = DEVICE.replace(mass=0.03, damping=0.2, delay="1 ms")
    follower = leader.replace(mass=0.2, damping=0.1, coulomb_friction=0, resolution=0, delay=0)
    ports = WavePort(leader, impedance=0.5), WavePort(follower, impedance=0.5)
    link = Schedule(delay="3 ms", jitter="8 ms", loss=0.4, burst=5, duplicates=0.2, seed=seed)
    hands = zw.operators.ConstantForce(0.3), zw.operators.ConstantForce(-0.2)
    trace = zw.links.simulate(*ports, link, *hands, 1, encoder_phase=(0.3, 0.0))
    work = trace["hand_work"].values.sum(axis=0)
    assert work.min() >= -1e-12
    assert work[-1] > 1e-3


def test_a_force_that_is_kept_back_acts_after_whole_samples() -> None:
    late, held = held_back(WHEEL)
    assert (late.exact("delay"), held) == (Fraction(2, 1000), Fraction(6, 10000))
    assert held_back(late) == (late, 0)
    WavePort(late)
    with pytest.raises(zw.InputError, match="--hold-back"):
        WavePort(WHEEL)


def test_the_answer_says_that_forces_are_kept_back() -> None:
    link = Schedule()
    held = LinkComparison({"waves": ROW}, "rotary", link, {}, (Fraction(6, 10000), Fraction(0)))
    assert held.to_dict()["held_back_s"] == [0.0006, 0.0]
    assert any("kept back by 600 µs and 0 s more" in str(part) for part in held.report())
    plain = LinkComparison({"waves": ROW}, "rotary", link, {})
    assert "held_back_s" not in plain.to_dict()
    assert not any("kept back" in str(part) for part in plain.report())


def test_scores_are_told_in_the_angle_that_was_asked_for() -> None:
    found = LinkComparison({"waves": ROW}, "rotary", Schedule(), {})
    with answers_in("deg"):
        text = str(found)
    for part in ("deg", "1.15", "0.0573", "N·m/deg", "0.0367"):
        assert part in text
    assert "rad" not in text
    assert found.to_dict()["ports"]["waves"]["tracking_error_rad"] == 0.02
