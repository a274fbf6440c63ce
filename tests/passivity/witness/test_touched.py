"""Laws with memory that are touched and left: proved on one side of a bound, refuted on the other."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from math import sqrt
from random import Random

import pytest
from strategies import seeds

import zwidth as zw
from zwidth.passivity.check import check_by_closed_forms
from zwidth.passivity.criterion_choice import decide
from zwidth.passivity.linear.contact_pattern_search import Surface, rhythms
from zwidth.passivity.witness.touching import TouchedSetting, refute_touching

T = Fraction(1, 1000)
TINY = Fraction(1, 10**9)


def device(damping, friction=0, step=0, delay=0):
    """A device at 1 kHz, the delay in samples."""
    return zw.Device(
        damping=damping, coulomb_friction=friction, resolution=step, sample_period=T, delay=delay * T, mass=1
    )


def draw(random, low, high):
    """A decimal of four digits, spread over the decades."""
    return Fraction(f"{low * (high / low) ** random.random():.3e}")


def pole(k, b, tau, **more):
    return zw.Wall(k, b, zw.rendering.OnePole(tau), **more)


def energy_out(law, x, held, *, penetration, clamped, anew):
    """Taken out over a motion, the law run in the plainest way, no delay; floats."""
    damping, friction, step = (float(held.exact(k)) for k in ("damping", "coulomb_friction", "resolution"))
    n, d = ([float(c) / law.denominator[0] for c in part] for part in (law.numerator, law.denominator))
    fed, out, rest, total = [], [], None, 0.0
    for here, there in pairwise(x):
        q = step * (here // step) if step else here
        rest = (0.0 if penetration else q) if rest is None else rest
        fed = [(max(q, 0.0) if penetration else q) - rest, *fed][: len(n)]
        y = sum(c * v for c, v in zip(n, fed, strict=False))
        y -= sum(c * v for c, v in zip(d[1:], out, strict=False))
        out = [y, *out][: len(d) - 1]
        f = (y + rest * sum(n) / sum(d)) if q > 0 else 0.0
        if anew and q <= 0:
            fed, out = [], []
        move = there - here
        total -= (max(f, 0.0) if clamped else f) * move + friction * abs(move) + damping / float(T) * move**2
    return total


SOLIDS = {
    "standard linear": (zw.StandardLinearSolid(100, 100, "0.3"), 100, [("3/4", 75)]),
    "Maxwell": (zw.Maxwell(100, "0.3"), 0, [("3/4", 75)]),
    "general": (
        zw.GeneralizedMaxwell(50, [(100, "0.3"), (300, 1)]), 50, [("3/4", 75), ("10/13", "3000/13")],
    ),
    "Tustin": (zw.StandardLinearSolid(10, 100, "0.3", "tustin"), 10, [("5/7", "600/7")]),
    "quick, Tustin": (zw.StandardLinearSolid(10, 1000, "0.3", "tustin"), 10, [("-1/4", 375)]),
}  # fmt: skip
"""A solid, its static stiffness and its parts (pole, stiffness) by hand, T = 1 ms."""


@pytest.mark.parametrize("clamped", [False, True])
@pytest.mark.parametrize("name", SOLIDS)
def test_a_solid_is_proved_at_its_bounds_and_not_below(name, clamped):
    """b = KT/2 + Σ gT/(1 + p) and f_c = ‖h‖₁ Δ/2: a certificate, and none below."""
    law, k, parts = SOLIDS[name]
    law, step = law.replace(clamped=clamped), Fraction(1, 10**4)
    parts = [(Fraction(p), Fraction(g)) for p, g in parts]
    b = k * T / 2 + sum(g * T / (1 + p) for p, g in parts)
    friction = (k + sum(2 * g / (1 + min(p, 0)) for p, g in parts)) * step / 2
    if clamped and len(parts) > 1:  # the first theorem: T Σ g/(1 − p)
        b = k * T / 2 + sum(g * T / (1 - abs(p)) for p, g in parts)
    verdict = check_by_closed_forms(device(b, friction, step), law)
    assert (verdict.outcome, verdict.certificate.kind) == ("passive", "relaxing contact")
    assert verdict.certificate.covered().contact == "made and broken"
    assert verdict.certificate.verify()
    assert verdict.scope.fed_with == "penetration"
    for less in (device(b * (1 - TINY), friction, step), device(b, friction * (1 - TINY), step)):
        found = check_by_closed_forms(less, law)
        assert found.certificate is None or found.certificate.covered().contact == "kept"


@pytest.mark.parametrize(
    ("law", "part"), [(SOLIDS["standard linear"][0], "0.98"), (zw.Wall(100, "0.05"), "0.9")]
)
def test_a_clamped_law_with_a_spring_is_active_below_its_bound(law, part):
    """Deep inside nothing is clamped: what sustained contact asks for is necessary."""
    need = decide(device(1), law).contact_damping
    verdict = check_by_closed_forms(device(need * Fraction(part)), law.replace(clamped=True))
    assert verdict.outcome == "active"
    assert verdict.witness.verify()
    assert verdict.scope.contact == "made and broken"


FILTERS = {
    "slow pole": zw.rendering.OnePole("0.01"),
    "quick pole": zw.rendering.OnePole("0.0004"),
    "window": zw.rendering.Window(5),
    "second order": zw.rendering.VelocityFilter([1], [1, "-1.6", "0.7"]),
}


@pytest.mark.parametrize("delay", [0, 2])
@pytest.mark.parametrize("name", FILTERS)
def test_a_filtered_wall_is_proved_at_the_bound_of_the_multiplier(name, delay):
    """Less damping than KT/2 + |B| Σ|w| is enough, clamped or not; a millionth less is not."""
    for clamped in (False, True):
        law = zw.Wall(10, "0.3", FILTERS[name], clamped=clamped)
        decision = decide(device(1, 1, "0.0001", delay), law)
        need, friction = decision.contact_damping, decision.contact_friction
        if name != "second order":
            assert need < (2 * delay + 1) * 10 * T / 2 + Fraction("0.3")
        verdict = check_by_closed_forms(device(need, friction, "0.0001", delay), law)
        assert (verdict.outcome, verdict.certificate.kind) == ("passive", "multiplier contact")
        assert verdict.certificate.covered().contact == "made and broken"
        assert verdict.certificate.verify()
        less = check_by_closed_forms(device(need * (1 - Fraction(1, 10**6)), friction, "0.0001", delay), law)
        assert less.certificate is None or less.certificate.covered().contact == "kept"


@pytest.mark.parametrize("seed", range(6))
def test_one_pole_in_closed_form(seed):
    """KT/2 + gT/(1 + p) up to p = 1/2, KT/2 + gT/(4p(1 − p²)) beyond."""
    random = Random(seed)
    k, b, tau = draw(random, 1, 1000), draw(random, 0.01, 3), draw(random, 1e-4, 0.3)
    p, g = tau / (T + tau), b / (T + tau)
    need = g / (1 + p) if p <= Fraction(1, 2) else g / (4 * p * (1 - p**2))
    assert decide(device(1), pole(k, b, tau)).contact_damping == k * T / 2 + T * need


@seeds(12)
def test_a_slow_filter_is_active_below_the_bound_of_the_page(seed):
    """b < (B/2)√(T/(T + 2τ)), or < B/((1 + p)√(8(1 + p²))): active, whatever K, f_c and Δ, clamped or not."""
    random = Random(seed)
    b, tau = draw(random, 0.05, 3), draw(random, 1e-3, 0.02)
    p = float(tau / (T + tau))
    bound = float(b) * max(sqrt(float(T / (T + 2 * tau))) / 2, 1 / ((1 + p) * sqrt(8 * (1 + p * p))))
    k = draw(random, 0.001, 0.2) * b / T
    loop = device(Fraction(f"{0.98 * bound:.6g}"), random.choice((0, "0.05")), random.choice((0, "1e-5")))
    verdict = check_by_closed_forms(loop, pole(k, b, tau, clamped=seed % 2 == 0))
    assert verdict.outcome == "active"
    assert verdict.witness.verify()


@pytest.mark.parametrize("delay", [0, 1, Fraction(1, 2)])
@pytest.mark.parametrize("step", [0, "0.00001"])
def test_the_simulator_takes_out_the_same(delay, step):
    """A wall that is passive in kept contact, touched and left by the motion of the verdict."""
    law = pole(10, "0.3", "0.01", clamped=bool(delay))
    loop = device("0.019" if delay else "0.025", "0.01" if step else 0, step, delay)
    verdict = check_by_closed_forms(loop, law)
    assert verdict.outcome == "active"
    assert isinstance(verdict.witness.setting, TouchedSetting)
    hand = zw.operators.WitnessMotion(verdict.witness)
    trace = zw.simulate(loop, law, hand, (hand.intervals + 1) * T)
    assert -float(trace["hand_work"].values[-1]) == pytest.approx(verdict.witness.energy, rel=1e-6)
    assert float(abs(trace.actuator_force).max()) == pytest.approx(verdict.witness.peak_force, rel=1e-9)


def test_kept_contact_of_a_slow_filter_is_no_promise():
    """The wall K = 10, B = 0.3 behind 10 ms on b = 0.025: active, and the limit says why."""
    verdict = zw.check(device("0.025"), pole(10, "0.3", "0.01"))
    assert verdict.outcome == "active"
    assert verdict.scope.contact == "made and broken"
    assert verdict.limit == "contact made and broken"
    assert verdict.required_damping == pytest.approx(0.04821428571428571)


def random_law(random):
    """A law with memory and no delay, what it is fed with."""
    k, b, tau = draw(random, 1, 300), draw(random, 0.02, 2), draw(random, 2e-4, 0.05)
    clamped = random.random() < 0.5
    filters = (zw.rendering.OnePole(tau), zw.rendering.Window(random.randint(2, 8)), FILTERS["second order"])
    if random.random() < 0.5:
        return zw.Wall(k, b, random.choice(filters), clamped=clamped), False
    method = random.choice(("backward", "tustin"))
    solids = (
        zw.StandardLinearSolid(k, b / tau, b, method, clamped),
        zw.Maxwell(b / tau, b, method, clamped),
        zw.GeneralizedMaxwell(k, [(b / tau, b), (k, b / 3)], method, clamped),
    )
    return random.choice(solids), True


def wander(random, x, step):
    """A move: any, over an edge of the encoder, to the surface, or back and forth."""
    size = 10 ** random.uniform(-1, 2) * (step or 1e-4)
    return random.choice(
        (x + random.uniform(-size, size), random.uniform(-size, size), -1e-9, 1e-9 + step, -x)
    )


@seeds(15)
def test_nothing_that_is_proved_is_refuted(seed):
    """At the bound itself: the best motions in a rhythm, and a hand that tries anything, take nothing out."""
    random = Random(seed)
    law, penetration = random_law(random)
    step = random.choice((0, Fraction(1, 10**4)))
    enough = decide(device(1, 1, step), law)
    loop = device(enough.contact_damping, enough.contact_friction, step)
    decision = decide(loop, law)
    assert decision.covers_contact
    assert refute_touching(decision.setting, law) is None
    less = decide(device(enough.contact_damping * Fraction(1, 2)), law)
    surface = Surface(less.loop, penetration, law.clamped)
    motions = [motion for motion, _ in zip(rhythms(surface), range(3), strict=False)]
    walk = [-random.random() * 1e-3]
    for _ in range(300):
        walk.append(wander(random, walk[-1], float(step)))
    motions.append([*walk, walk[0]])
    for x in motions:
        spent = sum(abs(b - a) for a, b in pairwise(x)) ** 2 * float(loop.damping) * 1000
        anew = penetration and random.random() < 0.5
        got = energy_out(decision.loop, x, loop, penetration=penetration, clamped=law.clamped, anew=anew)
        assert got <= 1e-12 * spent


@pytest.mark.parametrize(
    ("key", "limit"),
    [("device.damping", 0.0482142857), ("stiffness", 2 * (0.06 - 0.0432142857) * 1000)],
    ids=["device.damping", "stiffness"],
)
def test_limits_follow(key, limit):
    """The last damping that is proved, and the first stiffness that is not, of a filtered wall."""
    bracket = zw.limit(device("0.06"), pole(10, "0.3", "0.01"), key, tolerance=1e-4)
    assert bracket.hand == "every hand"
    assert bracket.proved_passive == pytest.approx(limit, rel=1e-4)
    assert key == "stiffness" or bracket.proved_active > 0.04
