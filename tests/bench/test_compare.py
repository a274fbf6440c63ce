"""The bench: scores from traces whose value is known, its verdicts, its faces."""

import json

import numpy as np
import pytest
import xarray as xr
from json_page import json_page

import zwidth as zw
from zwidth.loop.traces import measures as scores
from zwidth.model import rendering
from zwidth.study.bench import standard_laws
from zwidth.study.bench.adversary import attack

PADDLE = zw.catalogue.device("haptic-paddle")


@pytest.fixture(scope="module")
def stiff():
    """A wall seven times stiffer than the paddle renders passively."""
    return zw.compare(PADDLE, zw.Wall(2000))


def made(position, force, period=0.001):
    """A trace with the columns that scores look at."""
    x, f = np.asarray(position, float), np.asarray(force, float)
    time = np.arange(x.size) * period
    velocity = np.gradient(x, period)
    work = np.concatenate([[0.0], np.cumsum(-f[:-1] * np.diff(x))])
    names = {"position": x, "velocity": velocity, "actuator_force": f, "actuator_work": work}
    return xr.Dataset({k: ("time", v) for k, v in names.items()}, coords={"time": time})


def test_scores_of_known_traces():
    """A ramp into a spring, a sine on top of a push, a hand that bounces."""
    x = np.concatenate([np.full(100, -1e-3), np.full(900, 2e-3)])
    f = np.where(x > 0, 500 * x, 0)
    assert scores.static_stiffness(made(x, f)) == pytest.approx(500)
    assert scores.penetration(made(x, f)) == pytest.approx(2e-3)
    assert scores.bounces(made(x, f)) == 0
    assert scores.rms_force(made(x, f)) == pytest.approx(1.0)
    time = np.arange(1000) * 1e-3
    buzz = f + 0.3 * np.sin(2 * np.pi * 100 * time) + 0.5 * np.sin(2 * np.pi * 10 * time)
    assert scores.chatter(made(x, buzz)) == pytest.approx(0.3 / np.sqrt(2), rel=1e-6)
    assert scores.peak_force(made(x, -2 * f)) == pytest.approx(2.0)
    jumping = np.where(np.sin(2 * np.pi * 5 * time + 0.1) > 0, 1e-3, -1e-3)
    assert scores.bounces(made(jumping, 0 * time)) == 5
    assert scores.settling_time(made(jumping, 0 * time)) == np.inf
    drag = 0.4 * np.gradient(np.sin(20 * time), 1e-3)
    assert scores.free_damping(made(np.sin(20 * time) - 2, drag)) == pytest.approx(0.4, rel=0.02)
    out = made([0, 1, 0, 1, 0], [0, 2, 0, 3, 0])
    assert scores.generated_energy(out) == pytest.approx(5)


def test_the_bench_says_what_check_says(stiff):
    """A proof is never beside a motion that gains; the wall alone is active, the coupling passive."""
    status = dict(zip(stiff.scores["law"].values, stiff.scores["status"].values, strict=True))
    assert status["wall"] == "active"
    assert status["virtual-coupling"] == "passive"
    for name, law in standard_laws(PADDLE, zw.Wall(2000)).items():
        if status[name] == "passive":
            assert not stiff.attacks[name].extracts
        if law.linear:
            assert status[name] in (zw.check(PADDLE, law).outcome, "active")


SCORES = """
    wall active 1954 31.3 315 6.92
    virtual-damping active 1953 0.025 0.0997 3.29
    virtual-coupling passive 259 0 6.2 none
    passivity-controller active 1954 11.7 128 5.22
    passivity-controller-unlimited active 1954 0.171 0.0898 32.0
    rate-term active 1957 0.157 0.488 3.45
    force-bounding passive 1681 3.94 24.2 none
    force-bounding-ideal undecided 494 0.718 6.33 none
    energy-bounding undecided 305 0 6.5 none
    hysteresis active 2237 1.82 84.7 3.83
    braking-pulse active 1984 0 0 15.7
    event-transient active 1958 1.67 0 22.1
"""
"""Law, status, felt [N/m], given out [mJ], to a dowel [mJ], adversary [mJ a round]."""


def test_what_the_docs_tell_of_the_bench(stiff):
    """The numbers of docs/laws.md, "What was found", are among these."""
    variables = {"static_stiffness": 1, "generated_energy": 1e3, "dowel_energy": 1e3, "gain": 1e3}
    for name, status, *numbers in map(str.split, SCORES.strip().splitlines()):
        one = stiff.scores.sel(law=name)
        assert one["status"].item() == status
        for number, (variable, factor) in zip(numbers, variables.items(), strict=True):
            value = float(one[variable]) * factor
            if number == "none":
                assert value <= 0
            else:
                assert float(number) == pytest.approx(value, rel=0.006, abs=6e-4), (name, variable)


def test_the_energy_of_a_passive_law_is_said_to_end_in_friction(stiff):
    for told in ([*stiff.in_short()], [*stiff.report()]):
        assert "law gave" in str(told[2])
        assert "friction takes all of it, and the hand gets none" in " ".join(map(str, told))


def test_every_key_of_the_json_is_on_its_page(stiff):
    page = json_page()
    document = json.loads(stiff.to_json())
    keys = {*document, *document["laws"]["wall"]}
    assert not [key for key in keys if f"`{key}`" not in page]


def test_an_attack_is_a_motion_that_takes_energy_out(stiff):
    """Prescribed again: more comes out than ever went in."""
    laws = standard_laws(PADDLE, zw.Wall(2000))
    for name, found in stiff.attacks.items():
        if found.extracts:
            motion = found.motion
            trace = zw.simulate(PADDLE, laws[name], motion, len(motion.positions) * 0.001 - 0.001)
            taken = float(trace["kinetic_energy"][-1] - trace["hand_work"][-1])
            assert taken == pytest.approx(found.total, rel=1e-9)
            assert taken > 0


def test_a_controller_of_limited_damping_is_proved():
    """Where b ≥ K T/2 + α the damped wall's proof covers it; beyond nothing is claimed."""
    law = zw.render(zw.Wall(150), zw.rendering.PassivityController(largest_damping="0.07"))
    more = zw.render(zw.Wall(150), zw.rendering.PassivityController(largest_damping="0.08"))
    found = zw.compare(PADDLE, zw.Wall(150), {"less": law, "more": more})
    assert list(found.scores["status"].values) == ["passive", "undecided"]
    assert "0.07 N·s/m" in found.evidence["less"]
    assert not any(a.extracts for a in found.attacks.values())


def test_force_bounding_is_proved_and_not_broken(stiff):
    """Force bounding that knows of the counts: a certificate, and no motion gains; not where it is late."""
    status = stiff.scores["status"]
    assert status.sel(law="force-bounding").item() == "passive"
    assert "force bounding credits" in stiff.evidence["force-bounding"]
    assert not stiff.attacks["force-bounding"].extracts
    assert float(stiff.scores["static_stiffness"].sel(law="force-bounding")) > 1000
    law = zw.render(zw.Wall(2000), zw.rendering.ForceBounding())
    late = zw.compare(PADDLE.replace(delay="0.0005"), zw.Wall(2000), {"late": law})
    assert late.scores["status"].item() not in ("passive", "theorem")


def test_a_proof_on_paper_alone_is_called_a_theorem():
    """Energy bounding with an ideal encoder."""
    device = PADDLE.replace(resolution=0)
    law = zw.render(zw.Wall(2000), zw.rendering.EnergyBounding())
    found = zw.compare(device, zw.Wall(2000), {"energy": law})
    assert found.scores["status"].item() == "theorem"
    assert "paper" in found.evidence["energy"]


def test_a_passive_wall_is_never_attacked_with_success():
    """At 99 % of the limit of each, springs on ten devices."""
    rng = np.random.default_rng(1)
    for _ in range(10):
        b, f, step = 10 ** rng.uniform(-1.5, 0.5), 10 ** rng.uniform(-2, 0), 10 ** rng.uniform(-5, -3.5)
        device = zw.Device(mass=0.1, damping=b, coulomb_friction=f, resolution=step, sample_period=0.001)
        stiffness = 0.99 * min(2 * b / 0.001, 2 * f / step)
        assert not attack(device, zw.Wall(stiffness)).extracts
        assert attack(device, zw.Wall(4 * stiffness)).gain > attack(device, zw.Wall(stiffness)).gain


def test_its_faces(stiff, tmp_path):
    text = repr(stiff)
    assert "wall, 2000 N/m on haptic-paddle" in text
    assert "force-bounding" in stiff.advice
    assert "300 N/m passively" in stiff.advice
    assert "<table>" in stiff._repr_html_()
    stiff.plot(tmp_path / "laws.svg")
    assert "virtual-damping" in (tmp_path / "laws.svg").read_text(encoding="utf-8")
    assert all("units" in v.attrs for k, v in stiff.scores.data_vars.items() if k != "status")


@pytest.mark.parametrize(
    ("device", "wall", "options", "said"),
    [
        (PADDLE, zw.Maxwell(100, 1), {}, "how a wall is rendered"),
        (PADDLE.replace(mass=None), zw.Wall(100), {}, "mass"),
        (PADDLE.replace(damping=(1, 2)), zw.Wall(100), {}, "interval"),
        (PADDLE, zw.Wall((100, 200)), {}, "interval"),
        (PADDLE, zw.Wall(100), {"laws": {}}, "nothing to compare"),
        (zw.rotary(inertia=1e-4, damping="0.001", rate=1000), zw.Wall(1), {}, "--handle-radius"),
    ],
)
def test_what_it_refuses(device, wall, options, said):
    with pytest.raises(zw.InputError, match=said):
        zw.compare(device, wall, **options)


def test_a_proof_of_sustained_contact_alone_is_not_called_passive():
    """The touches make and break contact: what covers only a hand that stays is undecided here."""
    late, law = PADDLE.replace(delay="0.0004"), zw.Wall(120, damping="0.03")
    assert zw.check(late, law).outcome == "passive in contact"
    found = zw.compare(late, zw.Wall(20), {"slow": law})
    assert found.scores["status"].item() == "undecided"
    assert "not covered" in found.evidence["slow"]


def test_advice_counts_the_delay():
    """A wall that is passive without a delay and not with it: no advice to do without a law."""
    late = PADDLE.replace(delay="0.001")
    assert zw.check(PADDLE, zw.Wall(250)).outcome == "passive"
    advice = zw.compare(late, zw.Wall(250), {"wall": zw.Wall(250)}).advice
    assert "The device alone renders 100 N/m passively" in advice


def test_the_game_settles_what_the_adversary_does_not():
    """Dither to and fro: a hand in step with it gains from f_c on, in no motion that the adversary tries."""
    laws = {name: zw.render(zw.Wall(100), rendering.Dither(name)) for name in ("0.11", "0.14")}
    laws["timed"] = zw.render(zw.Wall(100), rendering.Damper("0.05", rendering.TickTime()))
    found = zw.compare(PADDLE, zw.Wall(100), laws)
    assert not any(attack.extracts for attack in found.attacks.values())
    assert list(found.scores["status"].values) == ["undecided", "active", "undecided"]
    assert "on either side take no energy out, proved; others may" in found.evidence["0.11"]
    assert "value iteration finds more" in found.evidence["0.14"]
    assert found.evidence["timed"].endswith("it remembers too much to be tabulated")


def test_what_was_stored_at_the_start_is_not_given_out():
    """2 J of work, of which 1.5 J were in the spring when the touch began."""
    trace = made([0.0, -1.0, -2.0], [1.0, 1.0, 1.0])
    assert scores.generated_energy(trace) == pytest.approx(2.0)
    loaded = trace.assign_attrs(stored_at_start_J=1.5)
    assert scores.generated_energy(loaded) == pytest.approx(0.5)
