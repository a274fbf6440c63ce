"""A violated criterion proves activity: never undecided, both sides of the limit, the checker attacked."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from math import acos, cos
from random import Random

import mpmath
import plain_loop
import pytest
from polynomials import product

import zwidth as zw
from zwidth.checker import judge
from zwidth.checker.loop.linear import criterion
from zwidth.checker.loop.loop import LOOP, loop_of
from zwidth.checker.loop.violation import criterion_at
from zwidth.passivity.certificate import verify_document
from zwidth.passivity.check import check_by_closed_forms
from zwidth.passivity.witness.motion import Motion

T = Fraction(1, 1000)
BILLIONTH = Fraction(1, 10**9)
DEVICE = zw.Device(mass=0.1, damping="0.1594", sample_period=T)
RADII = ("0.7", "0.95", "0.999", "0.999999", "0.999999999", "1", "1.2")


def device(damping, delay=0, friction=0, resolution=0):
    """A device at 1 kHz."""
    return DEVICE.replace(damping=damping, delay=delay, coulomb_friction=friction, resolution=resolution)


def with_resonance(base, radius, cosine, gain, zero):
    """base + gain (z − zero)/(z² − 2 r c z + r²), exact."""
    numerator, denominator = base
    poles = [Fraction(1), -2 * radius * cosine, radius * radius]
    top, more = product(numerator, poles), product(denominator, [gain, -gain * zero])
    more = [Fraction(0)] * (len(top) - len(more)) + more
    return [x + y for x, y in zip(top, more, strict=True)], product(denominator, poles)


def random_law(random):
    """H(z) of order 1 to 6, one resonance of any sharpness in most of them."""
    denominator = [Fraction(1)]
    for _ in range(random.randint(0, 2)):
        r, c = Fraction(random.randint(0, 95), 100), Fraction(random.randint(-100, 100), 100)
        denominator = product(denominator, [Fraction(1), -2 * r * c, r * r])
    numerator = [Fraction(random.randint(-999, 999), 100) for _ in denominator]
    if len(denominator) > 1 and random.random() < 0.3:
        return numerator, denominator
    radius, cosine = Fraction(random.choice(RADII)), Fraction(random.randint(-99, 99), 100)
    gain = Fraction(random.choice((-1, 1)), 10 ** random.randint(0, 9))
    return with_resonance(
        (numerator, denominator), radius, cosine, gain, Fraction(random.randint(-12, 12), 10)
    )


def lacking(law, delay, damping, cosine):
    """What the device lacks of damping at cos ωT by the definition, in 60 digits [N·s/m]."""
    with mpmath.workdps(60):
        c, b, late = (mpmath.mpf(v.numerator) / v.denominator for v in (cosine, damping, delay / T))
        z = mpmath.mpc(c, mpmath.sqrt(1 - c * c))
        top, bottom = (
            sum(
                mpmath.mpf(v.numerator) / v.denominator * z ** (len(part) - 1 - k) for k, v in enumerate(part)
            )
            for part in law
        )
        h = top / bottom
        whole, part = int(late), late - int(late)
        mixed = (1 - part + part / z) * z**-whole * h
        a = mpmath.mpf(1) / 1000 / 2 * mpmath.re((1 - 1 / z) * mixed) / (1 - c)
        need = (a + mpmath.sqrt(a * a + part * (1 - part) * abs(h) ** 2 / 10**6)) / 2 if part else a
        return float(need - b)


@pytest.mark.parametrize("seed", range(5))
def test_a_random_law_is_never_undecided(seed):
    """At (1 ± 1e-9) of the need, at half of it and at none: proved on one side, a violation on the other."""
    random = Random(f"violation {seed}")
    for _ in range(12):
        law = random_law(random)
        delay = random.choice((Fraction(0), 2 * T, T * Fraction(random.randint(1, 2999), 1000)))
        environment = zw.PulseTransferFunction(*law)
        verdict = check_by_closed_forms(device(1, delay), environment)
        need = verdict.required_damping
        shares = (1 - BILLIONTH, 1 + BILLIONTH, Fraction(1, 2), 0) if need else (1,)
        found = [
            check_by_closed_forms(device(Fraction(repr(need or 1.0)) * share, delay), environment)
            for share in shares
        ]
        if need:
            assert [v.outcome for v in found[:3]] == ["active", "passive", "active"], law
        for v in (verdict, *found):
            assert v.outcome in ("passive", "active"), (law, delay)
            assert (v.violation is not None) == (v.outcome == "active")
            if v.violation is not None and v.violation.refutation.cosine not in (None, 1):
                damping, cosine = v.decision.loop.damping, v.violation.refutation.cosine
                assert lacking(law, delay, damping, cosine) > 0, (law, delay, damping)


UNSTABLE = {
    "solid": (zw.StandardLinearSolid(100, 100, -3), "5"),
    "solid, less damping": (zw.StandardLinearSolid(100, 100, -3), "0.5"),
    "pole outside": (zw.PulseTransferFunction([1, 0], [1, "-1.01"]), "900"),
    "integrator": (zw.PulseTransferFunction([1, 0], [1, -1]), "900"),
    "lossless, wrong sign": (zw.PulseTransferFunction(["-48", "168", "-120"], ["1", "-0.8", "1"]), "0.7"),
    # (z² − 1.2 z + 1)²
    "double pole": (zw.PulseTransferFunction([1, -1], [1, "-2.4", "3.44", "-2.4", 1]), "900"),
}


@pytest.mark.parametrize("delay", ["0", "0.001", "0.0004"])
@pytest.mark.parametrize("name", UNSTABLE)
def test_an_unstable_law_is_active(name, delay):
    law, damping = UNSTABLE[name]
    for friction, resolution in ((0, 0), ("0.3", "0.001")):
        verdict = zw.check(device(damping, delay, friction, resolution), law)
        assert (verdict.outcome, verdict.violation.verify()) == ("active", True)


@pytest.mark.parametrize("delay", ["0", "0.0017"])
def test_a_negative_static_stiffness_is_active(delay):
    """H(1) just below 0 is active at any damping; just above it is not."""
    below, above = (zw.PulseTransferFunction([1, -1 + eps], [1, "-0.5"]) for eps in (-BILLIONTH, BILLIONTH))
    verdict = zw.check(device(50, delay), below)
    assert (verdict.outcome, verdict.violation.to_dict()["proof"]) == (
        "active",
        {"kind": "negative static stiffness"},
    )
    assert zw.check(device(50, delay), above).outcome == "passive"


def test_a_force_that_grows_pays_for_everything():
    """The motion of the theorem, run plainly: step in, hold, let go, with surface, friction and encoder."""
    setting = {"damping": 2.0, "friction": 1.0, "period": 0.001, "resolution": 0.01}
    for numerator, denominator in (([1], [1, -1.001]), ([1, 0], [1, -1]), ([-1, 0], [1, -1])):
        gained = []
        for held in (500, 8000):
            x = [0.0, *[0.5] * held]
            x.append(x[-1] - plain_loop.forces(numerator, denominator, x)[-1] * setting["period"] / 4)
            gained.append(plain_loop.energy_out((numerator, denominator), x, unilateral=True, **setting))
        assert gained[1] > 1000 > gained[0]


LOSSLESS = [48, -168, 120], [1, -0.8, 1]  # 120 (z − 1)(0.4 z − 1)/(z² − 0.8 z + 1): passive from b = 0.06 on


def behind_a_surface(numerator, moves, damping):
    """Energy of a slow way in and moves there, with Coulomb friction and encoder, by the plain loop [J]."""
    x = [6.0 * k / 300 for k in range(301)]
    for move in moves:
        x.append(x[-1] + move)
    assert min(x[1:]) > 0
    setting = {"damping": damping, "friction": 0.3, "period": 0.001, "resolution": 0.001}
    return plain_loop.energy_out((numerator, LOSSLESS[1]), x, unilateral=True, **setting)


def test_a_resonance_of_the_wrong_sign_pays_for_everything():
    """The same of a pole on the circle: moves at its frequency gain with the square of their number."""
    angle, negative = acos(0.4), [-c for c in LOSSLESS[0]]
    law = zw.PulseTransferFunction(negative, LOSSLESS[1])
    assert zw.check(device("0.7"), law).violation.refutation.reason == "unstable environment"
    moves = [cos(angle * k) for k in range(4000)]
    short, long = (behind_a_surface(negative, moves[:n], 0.7) for n in (1000, 4000))
    assert long > 10 * abs(short)


def test_a_violated_frequency_pays_for_everything():
    """The same at the frequency of a violation: a wave w there, x = D w on top of a depth."""
    verdict = zw.check(device("0.03"), zw.PulseTransferFunction(*LOSSLESS))
    angle = acos(verdict.violation.refutation.cosine)
    wave = [0.0, 0.0, *(cos(angle * k) for k in range(10_000)), 0.0, 0.0]
    x = [w - 0.8 * v + u for u, v, w in zip(wave, wave[1:], wave[2:], strict=False)]
    moves = [b - a for a, b in pairwise([0.0, *x])]
    short, long = (behind_a_surface(LOSSLESS[0], moves[:n], 0.03) for n in (1000, 10_000))
    assert long > 0
    assert long > short


def test_a_clamped_law_is_not_covered():
    law = zw.StandardLinearSolid(100, 100, -3, clamped=True)
    assert check_by_closed_forms(device("0.5"), law).violation is None


def test_intervals_need_the_best_corner():
    """Active where even the best value is; a violation at the worst corner alone decides nothing."""
    law = zw.Wall(1000)
    both = check_by_closed_forms(device((Fraction(1, 10), Fraction(2, 10))), law)
    assert (both.outcome, both.violation.verify()) == ("active", True)
    assert (both.violation.setting.loop.damping, both.active_at) == (Fraction(1, 10), {"damping": 0.1})
    assert both.best_corner.setting.loop.damping == Fraction(2, 10)
    document = both.to_dict()
    assert document["active_at"] == {"damping_N_s_per_m": 0.1}
    assert len(judge(document).parts) == 3
    part = check_by_closed_forms(device((Fraction(1, 10), 1)), law)
    assert (part.outcome, part.violation.setting.loop.damping) == ("undecided", Fraction(1, 10))
    assert (part.active_at, part.claim.startswith("Active for some values of its intervals")) == (
        {"damping": 0.1}, True
    )  # fmt: skip


def test_the_motion_is_made_when_it_is_asked_for(monkeypatch):
    """A check makes no motion; the witness does, once, and where none is short enough it is None."""
    made = []
    monkeypatch.setattr("zwidth.passivity.witness.violation.refute_linear", lambda *given: made.append(given))
    verdict = zw.check(DEVICE, zw.Wall(770))
    assert (verdict.outcome, made) == ("active", [])
    assert (verdict.witness, verdict.witness, len(made)) == (None, None, 1)
    document = verdict.to_dict()
    assert "witness" not in document
    assert verify_document(document).valid
    with pytest.raises(zw.InputError, match="motion"):
        zw.replay(verdict)


VIOLATIONS = {
    "criterion": (device("0.3", friction="0.2", resolution="0.0001"), zw.Wall("770", "0.1")),
    "delayed": (device("0.3", "0.0013"), zw.Wall("480", "0.03", zw.rendering.OnePole("0.004"))),
    "negative": (device("0.3"), zw.PulseTransferFunction([1, "-1.2"], [1, "-0.5"])),
    "unstable": (device(900), zw.PulseTransferFunction([1, 0], [1, "-1.01"])),
    "unstable, delayed": (device(900, "0.0004"), zw.PulseTransferFunction([1, 0], [1, "-1.01"])),
}


@pytest.mark.parametrize("name", VIOLATIONS)
def test_honest_violations_are_accepted(name):
    verdict = zw.check(*VIOLATIONS[name])
    assert verdict.violation.verify()
    assert all(part.verification.valid for part in judge(verdict.to_dict()).parts)


def test_a_violation_proves_no_passivity():
    """Not under a verdict that says passive, and not as a corner of one."""
    document = zw.check(*VIOLATIONS["criterion"]).violation.to_dict()
    for claim in (
        {"outcome": "passive", "violation": document},
        {"outcome": "passive", "certificate": document},
        {"outcome": "passive", "certificate": {"kind": "corners", "corners": [document]}},
    ):
        assert not any(part.verification.valid for part in judge(claim).parts)
    assert not verify_document({"kind": "corners", "corners": [document]}).valid
    proof = zw.check(DEVICE, zw.Wall(100)).certificate.to_dict()
    assert not any(p.verification.valid for p in judge({"outcome": "active", "violation": proof}).parts)


def test_two_roads_to_the_criterion():
    """The value at one point is that of the polynomial which the checker multiplies out for proofs."""
    random = Random("two roads")
    for _ in range(30):
        law = random_law(random)
        delay = random.choice((Fraction(0), T, T * Fraction(random.randint(1, 2999), 1000)))
        setting = check_by_closed_forms(device("0.3", delay), zw.PulseTransferFunction(*law)).decision.setting
        document = setting.document(Motion((Fraction(0), Fraction(0))), Fraction(0))
        loop = loop_of(LOOP.read(document["loop"], "loop", "linear"))
        c = Fraction(random.randint(-1000, 1000), 1000)
        polynomial = sum(a * c**k for k, a in enumerate(criterion(loop)))
        power = 2 * len(loop.denominator) + loop.whole + 1
        assert criterion_at(loop, c) == polynomial * c.denominator**power


PADDLE = zw.catalogue.device("haptic-paddle")
SLOW = {
    "solid of 10 s": zw.StandardLinearSolid(310, 20, 200),
    "Prony series to minutes": zw.GeneralizedMaxwell("605.2", [("44.43", "3.623"), ("20.31", 5978)], "zoh"),
    "rounded": zw.GeneralizedMaxwell("22.5", [("291.6", "4.233"), ("115.6", "94.16")], "matched"),
    "damped wall": zw.Wall(100, "0.2"),
}


@pytest.mark.parametrize("delay", ["0", "0.0004", "0.001"])
@pytest.mark.parametrize("name", SLOW)
def test_a_clear_violation_is_shown_by_a_short_motion(name, delay):
    verdict = zw.check(PADDLE.replace(delay=delay), SLOW[name])
    assert verdict.outcome == "active"
    witness = verdict.witness
    assert witness.verify()
    assert witness.motion.samples <= 202
    x = witness.motion.positions
    assert x[0] == x[-1] == 0
    assert min(x[1:-1]) > 0


def test_how_deep_and_fast_a_motion_is_counts_what_it_does_between_samples():
    """A force that comes 0.25 ms after its sample is turned against there: both are of that too."""
    late = zw.Device(damping="0.15", coulomb_friction="0.1", resolution="13.1 um", rate=1000, delay="0.25 ms")
    verdict = zw.check(late, zw.Wall(600_000))
    told = verdict.witness.to_dict()
    turns = [float(x) for x in told["switch_positions_m"]]
    x = [float(x) for x in told["positions_m"]]
    assert verdict.witness.depth == max(turns) > 100 * max(x)
    path = [x[0], *(place for pair in zip(turns, x[1:], strict=True) for place in pair)]
    speeds = [
        abs(b - a) / t for (a, b), t in zip(pairwise(path), [0.25e-3, 0.75e-3] * len(turns), strict=True)
    ]
    assert verdict.witness.peak_speed == pytest.approx(max(speeds), rel=1e-12)
    assert "although it is more than any hand does" in verdict.claim


@pytest.mark.parametrize("delay", ["0", "0.0003", "0.001", "0.004"])
@pytest.mark.parametrize("law", [zw.Wall(2000), zw.Wall(2000, "0.2")])
def test_a_motion_within_the_force_limit_where_there_is_one(delay, law):
    """The longer the delay the less force a motion needs; what is shown is checked, and simulated with the
    limit as without it."""
    loop = zw.Device(damping="0.1", coulomb_friction="0.2", resolution="0.0001", rate=1000, delay=delay)
    limited = loop.replace(mass=1, force_limit=20)
    verdict = check_by_closed_forms(limited, law)
    free = check_by_closed_forms(loop, law).witness
    assert verdict.witness.verify()
    if free.peak_force <= 20:
        assert verdict.witness == free
    elif delay != "0":
        assert verdict.witness.peak_force <= 20
        assert "stays within the actuator's 20 N" in verdict.demand[0]
    if verdict.is_beyond_actuator:
        return
    hand = zw.operators.WitnessMotion(verdict.witness.motion)
    duration = (hand.intervals + 1) * limited.exact("sample_period")
    trace = zw.simulate(limited, law, hand, duration)
    assert -float(trace.hand_work[-1]) == pytest.approx(verdict.witness.energy, rel=1e-9)
