"""The main verb end to end: published numbers, both sides of every limit, systems, intervals, advice."""

from __future__ import annotations

import json
from fractions import Fraction

import control
import pytest
import scipy.signal

import zwidth as zw
from zwidth import checker
from zwidth.model.rendering import OnePole, VelocityFilter, Window
from zwidth.passivity import value_iteration_fallback as gap
from zwidth.passivity.advice import in_lines
from zwidth.passivity.certificate import verify_document
from zwidth.passivity.witness.motion import Motion
from zwidth.quantity.text import shown, shown_at_least, to_json

PADDLE = zw.Device(
    mass=0.036, damping=0.15, coulomb_friction=0.12, resolution=22.4e-6, sample_period=1e-3, name="paddle"
)
COARSE, IDEAL = PADDLE.replace(resolution=22.4e-4), PADDLE.replace(resolution=0)
TIMED = PADDLE.replace(sample_period=(0.0005, 0.001))
ROUGH = zw.Device(damping="0.6", coulomb_friction=0, resolution="0.0005", sample_period="0.001")
BILLIONTH = Fraction(1, 10**9)


def assert_evidence(verdict):
    if verdict.is_proved:
        assert verdict.certificate.verify()
        assert verdict.scope.contact in ("kept", verdict.certificate.covered().contact)
        assert verdict.witness is None
    else:
        assert verdict.outcome == "active"
        assert verdict.witness.verify()
        assert verdict.witness.energy > 0
        assert verdict.certificate is None
    return verdict


def kept(device, law):
    return zw.check(device, law, contact="kept")


def test_paddle_at_its_limit():
    """300 N/m on the paddle is 2b/T exactly: passive, with margin zero, and the claim says so."""
    verdict = assert_evidence(zw.check(PADDLE, zw.Wall(stiffness=300.0, damping=0.0)))
    assert verdict.is_proved
    assert verdict.margins["damping"] == 0
    assert verdict.max_stiffness == 300
    assert verdict.required_damping == 0.15
    assert verdict.critical_frequency == 500
    assert verdict.limit == "sampling against viscous damping"
    assert verdict.mode is None
    assert "equality included" in verdict.claim


def test_a_law_at_the_edge_of_stability_is_said_to_be_beyond_damping():
    """Integral action: the need has no bound at its pole; of a leak it has one."""
    verdict = zw.check(PADDLE, zw.PulseTransferFunction([20, 10], [1, -1]))
    assert verdict.outcome == "active"
    assert verdict.required_damping is None
    assert verdict.critical_frequency == 0
    assert verdict.limit == "marginally stable environment, for which no damping is enough"
    assert dict(verdict.rows())["required device damping"] == "no amount is proved enough"
    bounded = zw.check(PADDLE, zw.PulseTransferFunction([20, 10], [1, "-0.99"]))
    assert bounded.required_damping is not None
    assert "marginally" not in bounded.limit


def test_paddle_beyond_its_limit():
    """770 N/m on the paddle is active: a motion, its joules, and what to change."""
    verdict = assert_evidence(zw.check(PADDLE, zw.Wall(770)))
    assert verdict.outcome == "active"
    assert verdict.max_stiffness == 300
    assert verdict.required_damping == pytest.approx(0.385, rel=1e-15)
    assert verdict.mode == "closed-loop instability"
    x, t = verdict.witness.positions, verdict.witness.sample_period
    assert (x[0], t) == (0, 1e-3)
    found = {a.parameter: a.to for a in verdict.advice}
    assert found["stiffness"] == 300
    assert found["damping"] == 0.385
    assert found["rate"] == pytest.approx(770 / 0.3, rel=1e-6)
    assert found["coulomb_friction"] is None


def test_other_numbers_of_the_paddle():
    """2f_c/Δ ≈ 10 700 N/m binds with damping enough for it alone; a fit without f_c, b = 0.41, says 820."""
    verdict = zw.check(PADDLE.replace(damping=20), zw.Wall(300))
    assert verdict.max_stiffness == pytest.approx(2 * 0.12 / 22.4e-6, rel=1e-15)
    assert verdict.max_stiffness == pytest.approx(10_700, rel=2e-3)
    assert verdict.limit == "quantization against Coulomb friction"
    assert zw.check(PADDLE.replace(damping=0.41), zw.Wall(300)).max_stiffness == 820


def test_coarse_encoder():
    """With counts 100 times as large the limit is ≈ 107 N/m and what is felt is active tactile."""
    verdict = assert_evidence(zw.check(COARSE, zw.Wall(150)))
    assert verdict.max_stiffness == pytest.approx(107.142857, rel=1e-8)
    assert verdict.mode == "active tactile"
    assert verdict.limit == "quantization against Coulomb friction"
    exact = Fraction("0.24") / Fraction("22.4e-4")
    assert assert_evidence(zw.check(COARSE, zw.Wall(exact))).is_proved
    assert assert_evidence(zw.check(COARSE, zw.Wall(exact * (1 + BILLIONTH)))).outcome == "active"


@pytest.mark.parametrize(
    ("k", "b", "needed"), [(150, 0.02, 0.095), (150, 0.2, 0.275), (1000, 0.05, 0.55), (1000, 0.5, 1.0)]
)
def test_walls_that_open_loop_tests_accept(k, b, needed):
    """Four damped walls on m = 0.1, b = 0.1, 1 kHz: three are active although device and wall are passive."""
    device = zw.Device(mass=0.1, damping=0.1, sample_period=1e-3)
    verdict = assert_evidence(zw.check(device, zw.Wall(k, b)))
    assert verdict.outcome == ("passive" if needed < 0.1 else "active")
    assert verdict.required_damping == pytest.approx(needed, rel=1e-14)


CLASSES = {
    "spring": zw.Wall(1),
    "damped wall": zw.Wall(1, 0.05),
    "negative virtual damping": zw.Wall(1, -0.04),
    "window": zw.Wall(1, 0.06, Window(5)),
    "one pole": zw.Wall(1, 0.01, OnePole(0.01)),
    "filter": zw.Wall(1, 0.02, VelocityFilter([0.3, 0.1], [1, -0.6])),
    "solid, backward": zw.StandardLinearSolid(1, 20, 0.1),
    "solid, Tustin": zw.StandardLinearSolid(1, 20, 0.1, "tustin"),
    "solid, zero-order hold": zw.StandardLinearSolid(1, 20, 0.1, "zoh"),
    "Prony": zw.GeneralizedMaxwell(1, [(20, 0.1), (9, 1)], "matched"),
    "coupling": zw.VirtualCoupling(1, 0.02, zw.Wall(500, 0.01)),
}


@pytest.mark.parametrize("delay", ["0", "0.001", "0.0022"])
@pytest.mark.parametrize("name", CLASSES)
def test_both_sides_of_the_largest_stiffness(name, delay):
    """Passive with a certificate at max_stiffness, a billionth above not proved, a hundredth above active."""
    device, law = IDEAL.replace(delay=delay), CLASSES[name]
    top = kept(device, law).max_stiffness
    if top is None:
        assert not kept(device, law.replace(stiffness=0)).is_proved
        return
    at, above, clearly = (
        kept(device, law.replace(stiffness=zw.Exact(Fraction(repr(top)) * factor)))
        for factor in (1, 1 + BILLIONTH, Fraction("1.01"))
    )
    assert assert_evidence(at).is_proved
    assert not above.is_proved
    if above.outcome == "active":
        assert_evidence(above)
    assert assert_evidence(clearly).outcome == "active"


@pytest.mark.parametrize("delay", ["0", "0.0014"])
@pytest.mark.parametrize("scale", ["0.35", "4.1"])
def test_gain_of_a_law_without_a_stiffness(delay, scale):
    """max_gain is the last factor on H(z) that is proved; a billionth more is refuted."""
    device = zw.Device(damping="0.35", sample_period="0.002", delay=delay)
    law = zw.PulseTransferFunction([40, -13], [1, "-0.3", "0.4"]).scaled(Fraction(scale))
    gain = Fraction(repr(zw.check(device, law).max_gain))
    below, above = law.scaled(gain * (1 - BILLIONTH)), law.scaled(gain * (1 + BILLIONTH))
    assert assert_evidence(zw.check(device, below)).is_proved
    assert assert_evidence(zw.check(device, above)).outcome == "active"
    assert zw.check(device, law).max_stiffness is None


NUMERATOR, DENOMINATOR = [320.0, -150.0], [1.0, -0.25]
STATE_SPACE = ([[0.25]], [[1.0]], [[320 * 0.25 - 150]], [[320.0]])
SYSTEMS = {
    "control, transfer function": lambda dt: control.tf(NUMERATOR, DENOMINATOR, dt),
    "control, state space": lambda dt: control.ss(*STATE_SPACE, dt),
    "scipy, transfer function": lambda dt: scipy.signal.TransferFunction(NUMERATOR, DENOMINATOR, dt=dt),
    "scipy, state space": lambda dt: scipy.signal.StateSpace(*STATE_SPACE, dt=dt),
    "scipy, zeros and poles": lambda dt: scipy.signal.ZerosPolesGain([150 / 320], [0.25], 320, dt=dt),
}


@pytest.mark.parametrize("kind", SYSTEMS)
def test_systems_of_other_packages(kind):
    """Of python-control or scipy.signal: the law of its coefficients, at its own sample period alone."""
    expected = zw.check(PADDLE, zw.PulseTransferFunction(NUMERATOR, DENOMINATOR))
    verdict = zw.check(PADDLE, SYSTEMS[kind](0.001))
    assert verdict.outcome == expected.outcome
    assert verdict.required_damping == expected.required_damping
    assert verdict.margins == expected.margins
    with pytest.raises(zw.InputError, match="sample"):
        zw.check(PADDLE, SYSTEMS[kind](0.0005))


@pytest.mark.parametrize("thing", [3.0, "wall", None, {"stiffness": 300}, control.tf([1], [1, 1])])
def test_what_is_no_environment_is_refused(thing):
    """A continuous system without a discretization, too; and arguments the wrong way round."""
    with pytest.raises(zw.InputError):
        zw.check(PADDLE, thing)
    with pytest.raises(zw.InputError, match="Device"):
        zw.check(zw.Wall(300), PADDLE)


def test_json_of_a_passive_verdict():
    """All promised keys, units in them, and a certificate inside that verifies after the trip."""
    document = json.loads(zw.check(PADDLE, zw.Wall(300)).to_json())
    promised = {"outcome", "claim", "scope", "assumptions", "limit", "critical_frequency_Hz", "certificate"}
    assert set(document) >= promised | {"advice", "required_damping_N_s_per_m"}
    assert document["margins"] == {"damping_N_s_per_m": 0.0, "coulomb_friction_N": pytest.approx(0.11664)}
    assert document["max_stiffness_N_per_m"] == 300
    assert verify_document(document).valid
    for entry in document["advice"]:
        assert {"parameter", "from", "to", "unit"} <= set(entry)


def test_json_of_an_active_verdict(tmp_path):
    """The witness has its positions from rest at the surface, its period and its joules."""
    verdict = zw.check(PADDLE, zw.Wall(770))
    verdict.save(tmp_path / "verdict.json")
    document = json.loads((tmp_path / "verdict.json").read_text(encoding="utf-8"))
    witness = document["witness"]
    assert float(witness["positions_m"][0]) <= 0
    assert witness["sample_period_s"] == 0.001
    assert witness["energy_J"] == pytest.approx(verdict.witness.energy, rel=1e-12)
    assert verify_document(document).energy > 0


def test_json_of_a_rotary_device():
    knob = zw.Device(damping=0.002, coulomb_friction=0.004, resolution=0.0015, rate=2000, motion="rotary")
    passive = json.loads(zw.check(knob, zw.Wall(2)).to_json())
    assert passive["outcome"] == "passive"
    assert passive["max_stiffness_N_m_per_rad"] == pytest.approx(16 / 3, rel=1e-12)
    assert set(passive["margins"]) == {"damping_N_m_s_per_rad", "coulomb_friction_N_m"}
    assert "required_damping_N_m_s_per_rad" in passive
    active = zw.check(knob, zw.Wall(11))
    document = json.loads(active.to_json())
    assert "positions_rad" in document["witness"]
    assert verify_document(document).valid
    units = {a.parameter: a.unit for a in active.advice}
    assert (units["damping"], units["stiffness"], units["resolution"]) == ("N*m*s/rad", "N*m/rad", "rad")


def test_friction_bounds_of_a_damped_wall_with_an_encoder():
    """f_c ≥ (K + 2B/T)Δ/2 is proved, less than straddling gains is refuted, and between them it is said."""
    device, law = ROUGH, zw.Wall(400, "0.03")
    enough = (400 + 2 * Fraction("0.03") * 1000) * Fraction("0.0005") / 2
    assert enough == Fraction("0.115")
    proved = assert_evidence(zw.check(device.replace(coulomb_friction=enough), law))
    assert proved.is_proved
    assert proved.certificate.kind == "contact"
    assert proved.margins["coulomb_friction"] == 0
    short = zw.check(device.replace(coulomb_friction=enough * (1 - BILLIONTH)), law)
    assert short.outcome in ("active", "undecided")
    necessary = Fraction(short.decision.necessary_friction)
    assert 0 < necessary <= enough * (1 + BILLIONTH)
    less = zw.check(device.replace(coulomb_friction=necessary * Fraction("0.999")), law)
    assert assert_evidence(less).outcome == "active"


def test_undecided_between_the_bounds(monkeypatch):
    """With a one-pole filter there is a gap between the proved bounds: undecided, and both are named."""
    device, law = ROUGH, zw.Wall(100, "0.1", OnePole("0.02"))
    monkeypatch.setattr(gap, "EFFORT", 0.2)  # more would not decide it either
    decision = zw.check(device, law).decision
    low, high = decision.necessary_friction, float(decision.sufficient_friction)
    assert low < high * 0.999
    verdict = zw.check(device.replace(coulomb_friction=(low + high) / 2), law)
    assert verdict.outcome == "undecided"
    assert verdict.certificate is None
    assert verdict.witness is None
    assert shown(low, "N") in verdict.claim
    assert shown_at_least(high, "N") in verdict.claim
    assert zw.check(device.replace(coulomb_friction=high * 1.001), law).is_proved
    assert assert_evidence(zw.check(device.replace(coulomb_friction=low * 0.4), law)).outcome == "active"


SOLID = (50, 80), (20, 90), (0.01, 0.5)
INTERVALS = {
    "device all passive": (
        PADDLE.replace(damping=(0.2, 0.4), coulomb_friction=(0.1, 0.2)), zw.Wall(380), "passive"
    ),
    "at the worst end": (PADDLE.replace(damping=(0.15, 0.4)), zw.Wall(300), "passive"),
    "wall all passive": (PADDLE, zw.Wall((100, 200), (-0.05, 0.05)), "passive"),
    "timing, spring": (TIMED.replace(delay=(0, "0.0002")), zw.Wall(150), "passive"),
    "filter and timing": (
        TIMED.replace(resolution=0), zw.Wall((50, 80), (0.01, 0.1), OnePole((0.001, 0.004))), "passive"
    ),
    "window and timing": (TIMED, zw.Wall((50, 80), (0.01, 0.05), Window(4)), "passive"),
    "any H(z) and timing": (TIMED, zw.PulseTransferFunction([90, -20], [1, "-0.3"]), "passive"),
    "every part of a solid": (TIMED.replace(resolution=0), zw.StandardLinearSolid(*SOLID), "passive"),
    "every part of a solid, Tustin": (IDEAL, zw.StandardLinearSolid(*SOLID, "tustin"), "passive"),
    "every part of a solid, mixed": (IDEAL, zw.StandardLinearSolid((200, 280), *SOLID[1:]), "undecided"),
    "timing, damped": (TIMED, zw.Wall(100, 0.1), "passive"),
    "solid": (PADDLE, zw.StandardLinearSolid((10, 150), 20, 0.1), "passive"),
    "device all active": (PADDLE.replace(damping=(0.1, 0.2)), zw.Wall(500), "active"),
    "wall all active": (IDEAL, zw.Wall((500, 900), (0.01, 0.1)), "active"),
    "mixed damping": (PADDLE.replace(damping=(0.1, 0.2)), zw.Wall(290), "undecided"),
    "mixed stiffness": (PADDLE, zw.Wall((200, 400)), "undecided"),
    "mixed period": (PADDLE.replace(sample_period=(0.0005, 0.002)), zw.Wall(250), "undecided"),
}  # fmt: skip


@pytest.mark.parametrize("name", INTERVALS)
def test_intervals(name):
    """Passive for all values, active for all, or undecided; ends and samples of the box agree."""
    device, law, expected = INTERVALS[name]
    verdict = zw.check(device, law, contact="kept")
    assert verdict.outcome == expected
    if expected == "passive":
        assert all(checker.verify(d).valid for d in verdict.certificate.documents)
        assert verify_document(json.loads(verdict.to_json())).valid
    outcomes = {zw.check(*corner, contact="kept").outcome for corner in box(device, law)}
    assert outcomes == ({"passive", "active"} if expected == "undecided" else {expected})


def box(device, law):
    loops = [(device, law)]
    for which, key in [*((0, k) for k in vars(device)), *((1, k) for k in vars(law))]:
        value = getattr((device, law)[which], key)
        if isinstance(value, zw.Interval):
            low, high = value.low.fraction, value.high.fraction
            values = [low + share * (high - low) for share in map(Fraction, ("0", "0.37", "0.81", "1"))]
            loops = [
                tuple(part.replace(**{key: v}) if i == which else part for i, part in enumerate(loop))
                for loop in loops
                for v in values
            ]
    return loops


LATE = PADDLE.replace(delay="0.0001")
UNPROVED = {
    "timing of a filter with a delay": (TIMED.replace(delay="0.0002"), zw.Wall(80, 0.02, OnePole("0.003"))),
    "filter with a delay": (LATE, zw.Wall(80, 0.02, OnePole((0.001, 0.002)))),
    "branch with a delay": (LATE, zw.StandardLinearSolid(10, (20, 30), 0.1)),
    "a Prony series": (IDEAL, zw.GeneralizedMaxwell(10, [((20, 30), 0.1), (9, 1)])),
}


@pytest.mark.parametrize("name", UNPROVED)
def test_intervals_without_a_proof_between(name):
    """Where corners prove nothing for what is between, passive corners are not called passive."""
    verdict = zw.check(*UNPROVED[name])
    assert verdict.outcome == "undecided"
    assert verdict.certificate is None
    assert "between" in verdict.claim


def test_too_many_intervals_are_refused():
    device = PADDLE.replace(delay=(0, "0.0001"), sample_period=("0.0005", "0.001"))
    branches = [((20, 30), ("0.1", "0.2")), ((9, 10), (1, 2))]
    with pytest.raises(zw.InputError, match="corners"):
        zw.check(device, zw.GeneralizedMaxwell((1, 2), branches))


def test_hidden_unstable_mode_is_not_passive():
    hidden = zw.PulseTransferFunction([200, -260], [1, "-1.3"])
    verdict = zw.check(PADDLE, hidden)
    assert verdict.outcome == "undecided"
    assert "share a root" in verdict.claim
    decaying = zw.PulseTransferFunction([200, -100], [1, "-0.5"])
    assert assert_evidence(zw.check(PADDLE, decaying)).is_proved


def test_largest_stiffness_where_softer_walls_need_more_friction():
    """With B < 0 an encoder asks for (2|B|/T − K)Δ/2 of soft walls: 60 N/m is passive though 1 N/m is not."""
    device = zw.Device(damping="0.5", coulomb_friction="0.03", resolution="0.001", sample_period="0.001")
    assert zw.check(device, zw.Wall(60, "-0.04")).is_proved
    assert zw.check(device, zw.Wall(1, "-0.04")).max_stiffness == 60


def test_energy_out_of_a_spring_at_rest_on_a_count():
    """A spring on both sides of its surface holds up to KΔ²/8 at rest: a motion may have that, once."""
    step = Fraction("0.0008")
    device = zw.Device(damping="0.15", coulomb_friction="0.12", resolution=step, sample_period="0.001")
    verdict = assert_evidence(zw.check(device, zw.PulseTransferFunction([300], [1])))
    assert verdict.is_proved
    setting = verdict.decision.setting
    energy = setting.energy(Motion((Fraction(0), -step / 800, step / 2)))
    assert 0 < energy <= 300 * step**2 / 8
    again = (Fraction(0), *(-step / 800, step / 2) * 2)
    assert setting.energy(Motion(again)) < energy


def test_assumptions_name_what_was_not_given():
    """Parameters taken as zero, the ideal sensor, sustained contact, and intervals are all said."""
    loop = zw.Device(damping="0.3", rate=1000), zw.Wall(100, "0.44", Window(2))
    bare = zw.check(*loop, contact="kept")
    text = "\n".join(bare.assumptions)
    for line in ("Coulomb friction was not given", "resolution was not given", "delay was not given"):
        assert line in text
    assert "ideal position sensor" in text
    assert "contact is kept" in text
    full = "\n".join(zw.check(PADDLE.replace(delay=0), zw.Wall(100)).assumptions)
    assert "not given" not in full
    assert "encoder counts" in full
    assert "contact made and broken" in full
    uncertain = zw.check(PADDLE.replace(damping=(0.2, 0.3)), zw.Wall(100))
    assert "every value within damping" in "\n".join(uncertain.assumptions)
    assert "out of this loop, for any damping within its range: stiffness may go up to" in uncertain.claim
    both = zw.check(PADDLE.replace(damping=(0.2, 0.3)), zw.Wall(zw.Interval(80, 100)))
    assert "for any damping and stiffness within their ranges" in both.claim
    assert both.scope.to_dict()["bounds"]["stiffness_N_per_m"] == [80, 100]
    assert "within damping 0.2 … 0.3 N·s/m, stiffness 80 … 100 N/m; " in both.assumptions[-1]
    coupled = zw.rendering.VirtualCoupling(zw.Interval(80, 90), 0, zw.Wall(zw.Interval(80, 100)))
    assert "within each interval of the environment; " in zw.check(PADDLE, coupled).assumptions[-1]


def test_rounded_coefficients_are_said():
    """A discretization through exponentials has rounded coefficients: an assumption."""
    exact = zw.check(IDEAL, zw.StandardLinearSolid(50, 20, 0.1, "tustin"))
    rounded = zw.check(IDEAL, zw.StandardLinearSolid(50, 20, 0.1, "zoh"))
    assert not any("rounded" in line for line in exact.assumptions)
    assert any("rounded" in line for line in rounded.assumptions)


@pytest.mark.parametrize("discretization", ["backward", "tustin", "zoh", "matched"])
def test_rounding_does_not_make_a_solid_active(discretization):
    """Maxwell branches alone have no static stiffness: no discretization of them is active for H(1) < 0."""
    law = zw.GeneralizedMaxwell(0, [("12.42", "2.993"), ("33.08", "0.2232")], discretization)
    device = zw.Device(damping="2.04", sample_period="0.003447")
    assert assert_evidence(zw.check(device, law)).is_proved


@pytest.mark.parametrize("delay", ["0", "0.0007"])
def test_budget_adds_up(delay):
    """Hold, law and delay add up to what is required at the critical frequency, where contact lasts."""
    verdict = zw.check(IDEAL.replace(delay=delay), zw.Wall(90, "0.03", OnePole("0.001")))
    account = verdict.budget
    assert account.hold + account.dynamics + account.delay == pytest.approx(account.required, rel=1e-12)
    frequencies, needs = verdict.curve(2000)
    assert max(needs) <= account.required * (1 + 1e-12)
    assert max(needs) == pytest.approx(account.required, rel=1e-5)
    assert frequencies[-1] < 500
    nearest = min(range(2000), key=lambda k: abs(frequencies[k] - account.frequency))
    assert needs[nearest] == pytest.approx(account.required, rel=1e-2)


def test_no_force_is_passive():
    """A wall of zero stiffness, and a law that is zero, ask for nothing."""
    bare = zw.Device(damping=0, rate=1000, resolution="0.001", delay="0.0004")
    for law in (zw.Wall(0), zw.PulseTransferFunction([0], [1, "-0.5"])):
        verdict = assert_evidence(zw.check(bare, law))
        assert verdict.is_proved
        assert verdict.required_damping == 0


@pytest.mark.parametrize("delay", ["0", "0.0004"])
def test_no_damping_is_active(delay):
    """Without viscous damping any spring is active, with Coulomb friction too: a large motion wins."""
    device = zw.Device(damping=0, coulomb_friction="0.2", resolution="0.0001", rate=1000, delay=delay)
    assert assert_evidence(zw.check(device, zw.Wall(40))).outcome == "active"


@pytest.mark.parametrize(("damping", "said"), [("0.0005", True), ("0.01", False)])
def test_the_limit_is_claimed_only_at_the_limit(damping, said):
    """A lossless resonator touches zero at its pole whatever b is: the limit is b = kT/2 alone."""
    resonator = zw.PulseTransferFunction(["0.8", "-1.8", 1], [1, "-1.6", 1])
    verdict = zw.check(zw.Device(damping=damping, rate=1000), resonator)
    assert assert_evidence(verdict).is_proved
    assert ("exactly at its limit" in verdict.claim) is said


def test_what_is_proved_for_whole_samples_alone_is_not_called_a_limit() -> None:
    """A solid a sample late: of delays between samples nothing is known, and the advice says no more."""
    device = zw.Device(
        damping="0.5", coulomb_friction="0.2", resolution="0.0005", sample_period="0.001", delay="0.001"
    )
    verdict = zw.check(device, zw.StandardLinearSolid(10, 2, "0.1"))
    assert verdict.outcome == "passive"
    told = {advice.parameter: advice for advice in verdict.advice}
    assert [key for key, advice in told.items() if advice.is_alone] == ["rate", "delay"]
    assert told["delay"].text == "delay is proved where it is, 1 ms, and for delays of whole samples alone"
    lines = in_lines(verdict.advice, passive=True)
    assert lines.at_limit == "proved where it is, and for delays of whole samples alone: rate, delay"


def test_what_was_looked_for_below_is_not_denied_above() -> None:
    """A lead asks for less damping behind a part of a sample: no lower delay would do, and a higher does."""
    device = zw.Device(damping=0.3, sample_period=1e-3)
    lead = zw.ContinuousTransferFunction([0.33, 150], [0.0005, 1], discretization="tustin")
    verdict = zw.check(device, lead)
    (told,) = [advice for advice in verdict.advice if advice.parameter == "delay"]
    assert verdict.outcome == "active"
    assert told.to is None
    assert told.text == "no lower delay was found that would do alone"
    assert zw.check(device.replace(delay=1e-4), lead).passive


@pytest.mark.parametrize(
    "value", [Fraction(7, 2**90), Fraction(-3, 5**40), 10**40 + Fraction(1, 8), Fraction(1, 3)]
)
def test_a_rational_is_written_digit_for_digit(value):
    """However many digits that takes: a motion may hang on the last one."""
    (written,) = json.loads(to_json([value]), parse_float=str)
    assert Fraction(written) == value
