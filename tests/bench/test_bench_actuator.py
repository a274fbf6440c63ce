"""A promise on the bench counts the amplifier: converter steps, force limit, what else the device states."""

import itertools
import time
from fractions import Fraction

import numpy as np
import pytest

import zwidth as zw
from zwidth.model.rendering import DualRate, EnergyBounding, ForceBounding, PassiveLeap, PassivityController
from zwidth.study.bench.adversary import _player, _taken, attack
from zwidth.study.bench.motions import fixed_motions
from zwidth.study.bench.standing import standing

PADDLE = zw.catalogue.device("haptic-paddle")
PROMISES = ("passive", "theorem")


def made(step="0.01", friction="0", **more):
    """b = 0.5 N·s/m at 1 kHz, an ideal encoder, a converter with steps."""
    numbers = {"mass": "0.05", "damping": "0.5", "resolution": 0, "sample_period": "0.001", "delay": 0}
    return zw.Device(**{**numbers, "coulomb_friction": friction, "force_resolution": step, **more})


def known_of(device, law, fastest=10.0):
    """Its standing, after the adversary."""
    return standing(device, law, attack(device, law, fastest=fastest))


def taken(device, law, positions):
    """The most that a motion has taken out at any sample [J], counted here."""
    period = device.exact("sample_period")
    trace = zw.simulate(device, law, zw.operators.PrescribedMotion(positions), (len(positions) - 1) * period)
    moves, forces = np.diff(positions), trace["actuator_force"].values[: len(positions) - 1]
    friction = float(device.exact("coulomb_friction")) * np.abs(moves)
    drag = float(device.exact("damping") / period) * moves**2
    return float(np.cumsum(-forces * moves - friction - drag).max())


LAWS = {
    "leap": lambda k: zw.render(zw.Wall(k), PassiveLeap()),
    "dual": lambda k: zw.render(zw.Wall(k), DualRate(samples=1)),
    "controller": lambda k: zw.render(zw.Wall(k), PassivityController(largest_damping="0.02")),
    "wall": zw.Wall,
}
"""What is proved of an ideal actuator for K = 900 N/m."""


@pytest.mark.parametrize("step", ["0.1", "0.01", "0.001"])
@pytest.mark.parametrize("name", LAWS)
def test_no_promise_where_nothing_pays_for_the_steps(name, step):
    """Without Coulomb friction a converter with steps of any size is refuted."""
    device, law = made(step), LAWS[name](900)
    found = known_of(device, law)
    assert found.status == "active"
    assert known_of(made(None), law).status in PROMISES
    onset = float(step) / 2 / 900
    if name == "leap":
        leap = np.array([0, 1.001, 1.001 - 18 * 0.1, 1.001 - 18 * 0.1]) * onset
        assert taken(device, law, leap) > 0


@pytest.mark.parametrize("name", LAWS)
def test_half_a_step_of_friction_pays_and_less_does_not(name):
    """f_c = ΔF/2 is proved, a billionth less is not; less by a fiftieth, or a fourth, is refuted."""
    law = LAWS[name](900)
    paid = known_of(made(friction="0.005"), law)
    assert paid.status == ("theorem" if name in ("leap", "dual") else "passive")
    assert paid.scope.force_steps
    below = known_of(made(friction="0.004999999995"), law)
    assert below.status == "undecided"
    assert below.withheld
    if name != "leap":
        less = "0.0038" if name == "dual" else "0.0049"
        assert known_of(made(friction=less), law).status == "active"


def test_the_encoder_and_the_steps_are_paid_for_together():
    """f_c ≥ K Δ/2 + ΔF/2, behind an encoder: 0.0095 N here."""
    counts = {"resolution": "0.00001"}
    assert known_of(made(friction="0.0095", **counts), zw.Wall(900)).status == "passive"
    assert known_of(made(friction="0.0094", **counts), zw.Wall(900)).status not in PROMISES


def test_a_theorem_says_as_data_what_it_counts():
    """What a device states beyond it is named; with nothing beyond it holds."""
    wall = zw.Wall(900)
    for stage, friction in (
        (EnergyBounding(), 0),
        (PassiveLeap(), Fraction(1, 200)),
        (DualRate(samples=3), Fraction(1, 200)),
    ):
        theorem = stage.theorem(zw.rendering.rendering_law.LoopContext(made(), wall))
        assert theorem.counts_force_steps
        assert theorem.counts_force_limit
        assert not any((theorem.counts_encoder, theorem.counts_delay, theorem.counts_current_rise))
        assert theorem.coulomb_friction == friction
        enough = made(friction="0.005")
        assert theorem.holds_on(enough)
        assert theorem.reason(enough) == theorem.statement
        for more, said in (
            ({"resolution": "0.00001"}, "an encoder"),
            ({"delay": "0.001"}, "a delay"),
            ({"motor_inductance": "0.001", "supply_voltage": 12, "current_limit": 3}, "rises slowly"),
        ):
            assert said in theorem.reason(enough.replace(**more))
            assert not theorem.holds_on(enough.replace(**more))
    limit = zw.rendering.rendering_law.LoopContext(made(), zw.Wall(1000))
    beyond = zw.rendering.rendering_law.LoopContext(made(), zw.Wall("1000.0000001"))
    assert PassiveLeap().theorem(limit) is not None
    assert PassiveLeap().theorem(beyond) is None
    assert DualRate(samples=2, slope="1000.0000001").theorem(limit) is None


def test_energy_and_force_bounding_know_the_steps():
    """Half a step is kept below their bound: no friction is asked for, and none of the motions gains."""
    for stage, status in ((EnergyBounding(), "theorem"), (ForceBounding(), "passive")):
        law = zw.render(zw.Wall(3000), stage)
        assert known_of(made("0.05"), law).status == status


def test_a_current_that_rises_slowly_withholds_every_proof():
    """It takes 0.25 ms of a sample of 1 ms; a fifth of a sample is taken as instant."""
    device, bounding = made(friction="0.005"), zw.render(zw.Wall(900), ForceBounding())
    slow = device.replace(motor_inductance="0.001", supply_voltage=12, current_limit=3)
    for law in (bounding, *(LAWS[name](900) for name in ("wall", "dual", "controller"))):
        assert known_of(device, law).status in PROMISES
        found = known_of(slow, law)
        assert found.status == "undecided"
        assert found.withheld
    assert zw.formulas.check_bounding(slow, bounding).outcome == "undecided"
    assert zw.formulas.check_bounding(device, bounding).outcome == "passive"


def test_the_force_limit_counts_in_a_refutation_too():
    """301 N/m are active by a motion that asks for 150 N; an actuator of 16.5 N is not shown to be."""
    assert zw.check(PADDLE, zw.Wall(301)).outcome == "active"
    found = known_of(PADDLE, zw.Wall(301))
    assert found.status == "undecided"
    assert "For an ideal actuator" in found.evidence
    strong = PADDLE.replace(force_limit=None, force_resolution=None)
    assert known_of(strong, zw.Wall(301)).status == "active"


def scaled(device, length, force, period):
    """The device in other units."""
    unit = {"mass": force * period**2 / length, "damping": force * period / length, "resolution": length}
    unit |= {"sample_period": period, "delay": period}
    unit |= dict.fromkeys(("coulomb_friction", "force_limit", "force_resolution"), force)
    given = {key: device.exact(key) * by for key, by in unit.items() if getattr(device, key) is not None}
    return zw.Device(**given)


@pytest.mark.parametrize(
    "device",
    [
        made("0.01"),
        made("0.02", friction="0.007", force_limit="3"),
        made("0.002", friction="0.013", resolution="0.000031", force_limit="7"),
    ],
)
def test_a_loop_and_its_twin_in_other_units_get_one_answer(device):
    """Lengths × 3.7, forces × 0.21, times × 1.9: the same status, gains × 3.7 · 0.21."""
    length, force, period = Fraction("3.7"), Fraction("0.21"), Fraction("1.9")
    twin = scaled(device, length, force, period)
    stiffness = 2345 if device.force_limit is None else 900
    wall, other = zw.Wall(stiffness), zw.Wall(stiffness * force / length)
    damping = Fraction("0.02"), Fraction("0.02") * force * period / length
    alike = [(stage, stage) for stage in (DualRate(samples=1), PassiveLeap(), EnergyBounding())]
    alike.append(tuple(PassivityController(largest_damping=each) for each in damping))
    pairs = [(wall, other), *((zw.render(wall, here), zw.render(other, there)) for here, there in alike)]
    for law, same in pairs:
        found, again = attack(device, law), attack(twin, same, fastest=10 * length / period)
        assert found.extracts == again.extracts
        if found.extracts:
            assert again.gain == pytest.approx(found.gain * float(force * length), rel=1e-6)
        assert standing(device, law, found).status == standing(twin, same, again).status


def random_loop(rng):
    """A device with steps, a wall that it renders alone, and what is said to be proved of it."""
    b, period, step = 10 ** rng.uniform(-1, 0.5), 10 ** rng.uniform(-3.5, -2.5), 10 ** rng.uniform(-3, -1)
    friction = step * rng.choice([0.0, 0.2, 0.5000001, 0.7])
    limit = None if rng.random() < 0.5 else step * rng.uniform(3, 300)
    device = made(step, friction, damping=b, sample_period=period, force_limit=limit)
    stiffness = 2 * b / period * rng.uniform(0.2, 0.9)
    dual = DualRate(samples=int(rng.integers(1, 4)))
    controller = PassivityController(largest_damping=0.09 * b)
    stages = (PassiveLeap(), dual, controller, EnergyBounding(), ForceBounding())
    stage = stages[int(rng.integers(len(stages)))]
    return device, zw.render(zw.Wall(stiffness), stage), step / stiffness


def random_motion(rng, depth):
    """To and fro beside a step, from the surface or from where the hand is; or slowly in and out at once."""
    begin = depth * rng.choice([0.0, 0.05, 1.0])
    at, size = depth * (rng.integers(0, 3) + 0.5), depth * 10 ** rng.uniform(-1.5, -0.35)
    if rng.random() < 0.6:
        part = at + begin + size * np.array([-1, 1])
    else:
        part = np.append(np.linspace(0, at + size, int(rng.integers(3, 30))), 0.0) - 0.01 * depth
    return np.concatenate([[begin], np.tile(part, int(rng.choice([1, 40]))), [begin]])


@pytest.mark.parametrize("seed", [0, 2])
def test_random_loops_with_steps_have_no_promise_that_a_motion_breaks(seed):
    """Whatever is called passive or a theorem, none of the motions about its steps takes anything out."""
    rng = np.random.default_rng(seed)
    promised = 0
    for _ in range(8):
        device, law, depth = random_loop(rng)
        motions = [random_motion(rng, depth) for _ in range(8)]
        if known_of(device, law).status in PROMISES:
            promised += 1
            size = float(device.exact("force_resolution")) * depth
            assert max(taken(device, law, motion) for motion in motions) <= 1e-9 * size
    assert promised >= 3


@pytest.mark.parametrize("delay", ["0", "0.0013", "0.002"])
def test_rounds_are_what_the_simulator_makes_of_them(delay):
    """Walls and laws that remember, with delays of part of a sample: gain and total of all rounds."""
    device = PADDLE.replace(delay=delay)
    rng = np.random.default_rng(4)
    stages = PassivityController(), ForceBounding(), zw.rendering.Hysteresis(fastest="0.2")
    for law in (zw.Wall(2000), *(zw.render(zw.Wall(2000), stage) for stage in stages)):
        play, motions = _player(device, law), list(fixed_motions(device, 10, law).values())
        for index in rng.choice(len(motions), 4, replace=False):
            quick, slow = play(motions[index], 40), _taken(device, law, motions[index], 40)
            assert quick.gain == pytest.approx(slow.gain, rel=1e-8, abs=1e-15)
            assert quick.total == pytest.approx(slow.total, rel=1e-8, abs=1e-15)


def test_nothing_depends_on_the_time_that_it_takes(monkeypatch):
    """A clock on which an hour passes between two looks: the same answer."""
    law = zw.render(zw.Wall(100), zw.rendering.Dither("0.14"))
    here = zw.compare(PADDLE, zw.Wall(100), {"dither": law})
    hours = itertools.count(0, 3600)
    monkeypatch.setattr(time, "monotonic", lambda: float(next(hours)))
    busy = zw.compare(PADDLE, zw.Wall(100), {"dither": law})
    assert busy.evidence == here.evidence
    assert here.scores["status"].item() == "active"


def test_a_theorem_is_never_called_passive():
    device = PADDLE.replace(resolution=0)
    found = zw.compare(device, zw.Wall(2000), {"energy": zw.render(zw.Wall(2000), EnergyBounding())})
    assert found.scores["status"].item() == "theorem"
    assert found.standings["energy"].proof == "paper"
    advice = found.advice.split(". ", 1)[1]
    for text in (found.evidence["energy"], advice, found.to_json(), found._repr_html_(), repr(found)):
        assert "no certificate" in text or "without a certificate" in text
        assert "passive" not in text.replace("renders 300 N/m passively", "")
