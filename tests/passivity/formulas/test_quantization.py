"""The quantized spring wall: worst cases, counterexamples and the (β, σ) plane by other roads."""

from __future__ import annotations

from fractions import Fraction
from itertools import accumulate
from math import inf
from random import Random

import pytest
from strategies import seeds

import zwidth as zw
from zwidth.passivity import formulas as q
from zwidth.passivity.linear.loop import linear_loop
from zwidth.passivity.witness.motion import Motion, Repeat
from zwidth.passivity.witness.witness import Setting

KEYS = ("damping", "sample_period", "coulomb_friction", "resolution")
PADDLE = zw.Device(mass="0.036", damping="0.15", coulomb_friction="0.12", resolution="22.4e-6", rate=1000)
IDEAL = PADDLE.replace(resolution=0)


def draw(random, low, high):
    return Fraction(f"{low * (high / low) ** random.random():.3e}")


def drawn(seed):
    """A device of typical numbers, and where more are drawn from."""
    random = Random(seed)
    ends = {"damping": (0.01, 2), "coulomb_friction": (0.001, 1), "resolution": (1e-6, 1e-3)}
    numbers = {key: draw(random, *pair) for key, pair in ends.items()}
    return random, zw.Device(**numbers, sample_period=draw(random, 1e-4, 0.01))


def limits(dev):
    b, t, friction, step = (dev.exact(key) for key in KEYS)
    return 2 * b / t, 2 * friction / step


def gained(dev, stiffness, positions, repeats=()):
    loop = linear_loop(dev, zw.Wall(stiffness))
    setting = Setting(loop, dev.exact("coulomb_friction"), dev.exact("resolution"), True)
    return setting.energy(Motion(tuple(positions), (), repeats))


def per_cycle(dev, stiffness, cycle):
    """Energy of one more round of a closed motion inside the wall."""
    positions = (Fraction(0), *cycle)
    energies = [gained(dev, stiffness, positions, (Repeat(1, len(cycle), n),)) for n in (1, 2)]
    return energies[1] - energies[0]


@seeds(20)
def test_worst_case_is_the_minimum_over_encoder_phases(seed):
    """J from its definition, with the real encoder, is never below J* and comes arbitrarily near."""
    random, dev = drawn(seed)
    k = draw(random, 1, 1e5)
    b, t, friction, step = (dev.exact(key) for key in KEYS)

    def surplus(x0, x1):
        force = k * step * (x0 // step)
        moved = x1 - x0
        lost = friction * abs(moved) + b / t * moved**2
        return k / 2 * (x0**2 - x1**2) + force * moved + lost

    for _ in range(20):
        x0, x1 = (step * Fraction(random.randint(0, 9999), 1000) for _ in range(2))
        assert surplus(x0, x1) >= q.worst_case(dev, k, x0 - x1).fraction
    tiny = step / 10**12
    out = step * Fraction(random.randint(0, 3999), 1000)
    assert surplus(4 * step, 4 * step - out) == q.worst_case(dev, k, out).fraction
    near = 4 * step - tiny
    assert surplus(near, near + out) - q.worst_case(dev, k, -out).fraction == k * tiny * out


@seeds(20)
def test_linear_worst_case(seed):
    """Below J* exactly where K ≤ 2b/T; in and out by one distance loses (2f_c − K Δ) λ."""
    random, dev = drawn(seed)
    distance = draw(random, 1e-6, 1e-2)
    sampling, _ = limits(dev)
    for k, below in ((sampling, True), (sampling * Fraction(9, 10), True), (sampling * 2, False)):
        for displacement in (distance, -distance):
            line = q.linear_worst_case(dev, k, displacement).fraction
            assert (line <= q.worst_case(dev, k, displacement).fraction) == below
        both = sum(q.linear_worst_case(dev, k, s * distance).fraction for s in (1, -1))
        assert both == (2 * dev.exact("coulomb_friction") - k * dev.exact("resolution")) * distance


@seeds(20)
def test_fast_press_gains_what_it_says(seed):
    """Above 2b/T the press gains its closed form of energy; one count less gains none."""
    random, dev = drawn(seed)
    k = limits(dev)[0] * (1 + draw(random, 1e-4, 10))
    press = q.fast_press(dev, k)
    assert press.energy > 0
    assert gained(dev, k, press.positions) == press.energy.fraction
    n = press.positions[1] // dev.exact("resolution")
    if n > 1:
        depth = (n - 1) * dev.exact("resolution")
        assert gained(dev, k, (Fraction(0), depth, Fraction(0))) <= 0
        with pytest.raises(zw.InputError, match="counts is a whole number above"):
            q.fast_press(dev, k, counts=n - 1)


@seeds(20)
def test_edge_straddle_gains_what_it_says(seed):
    random, dev = drawn(seed)
    k = limits(dev)[1] * (1 + draw(random, 1e-4, 10))
    straddle = q.edge_crossing(dev, k)
    assert straddle.energy > 0
    assert per_cycle(dev, k, straddle.positions) == straddle.energy.fraction


def test_paddle_press():
    """K = 301 N/m: more than 10714.28 counts in one sample, 240 m/s."""
    press = q.fast_press(PADDLE, 301)
    assert press.positions[1] // PADDLE.exact("resolution") == 10715
    assert press.peak_speed == pytest.approx(240.016, rel=1e-6)


def test_paddle_in_the_plane():
    """K = 770 N/m: 0.5106 m/s from the surface; 301: 240 m/s."""
    point = q.plane_point(PADDLE, 770)
    assert float(point.viscous) == pytest.approx(0.194805194805, rel=1e-11)
    assert float(point.dry) == pytest.approx(6.957328385900, rel=1e-11)
    assert point.region == "locally stable"
    assert q.admissible_speed(PADDLE, 770, "surface").fraction == Fraction(24, 47)
    assert round(float(q.admissible_speed(PADDLE, 770, "surface")), 4) == 0.5106
    assert q.admissible_speed(PADDLE, 301, "surface").fraction == 240
    assert float(q.admissible_speed(PADDLE, 770)) == pytest.approx(0.473940, rel=1e-5)
    assert float(q.admissible_speed(PADDLE, 301)) == pytest.approx(233.2576, rel=1e-9)
    assert q.admissible_speed(PADDLE, 300) == inf


@pytest.mark.parametrize(
    ("viscous", "dry", "region"),
    [
        ("0.5", "0.5", "globally stable"),
        ("0.7", "0.4999", "limit cycles"),
        ("0.4999", "0.3", "globally unstable"),
        ("0.4999", "0.5", "locally stable"),
        ("0.2", inf, "locally stable"),
        ("0.8", inf, "globally stable"),
    ],
)
def test_regions(viscous, dry, region):
    """The four regions of the plane, their edges on the passive side."""
    dry = dry if dry == inf else zw.Exact(dry)
    assert q.PlanePoint(zw.Exact(viscous), dry).region == region


@seeds(20)
def test_globally_stable_is_passive(seed):
    """The first region is K ≤ min(2b/T, 2f_c/Δ); outside it there is a counterexample."""
    random, dev = drawn(seed)
    k = draw(random, 1, 1e5)
    sampling, quantization = limits(dev)
    region = q.plane_point(dev, k).region
    assert (region == "globally stable") == (k <= min(sampling, quantization))
    assert (region in ("locally stable", "globally unstable")) == (k > sampling)
    if region != "globally stable":
        found = q.fast_press(dev, k) if k > sampling else q.edge_crossing(dev, k)
        assert found.energy > 0


@seeds(20)
def test_admissible_speed_is_safe(seed):
    """No motion that stays at or below it in every sample gains, although the wall is active."""
    random, dev = drawn(seed)
    sampling, quantization = limits(dev)
    if quantization <= sampling:
        dev = dev.replace(coulomb_friction=dev.exact("resolution") * sampling)
        quantization = 2 * sampling
    k = sampling + (quantization - sampling) * Fraction(random.randint(1, 999), 1000)
    speed = q.admissible_speed(dev, k).fraction
    reach = speed * dev.exact("sample_period")
    fractions = (random.choice([-1, 1, -1, 1, Fraction(random.randint(-99, 99), 100)]) for _ in range(60))
    x = tuple(accumulate((f * reach for f in fractions), initial=Fraction(0)))
    assert gained(dev, k, x) <= 0


@seeds(20)
def test_admissible_speed_is_reached(seed):
    """A whole number of counts a sample gains just above the limit and not at it."""
    random, dev = drawn(seed)
    n = random.randint(1, 40)
    b, t, _, step = (dev.exact(key) for key in KEYS)
    k = limits(dev)[0] * (1 + draw(random, 1e-3, 5))
    # Coulomb friction that makes n the largest step inside
    dev = dev.replace(coulomb_friction=(n * step * (k / 2 - b / t)) + k * step / 2)
    assert q.admissible_speed(dev, k).fraction * t == n * step
    tiny = step / 10**25
    start = 3 * step - tiny

    def gain(counts):
        return per_cycle(dev, k, (start, start + counts * step + tiny, start))

    assert gain(n) <= 0 < gain(n + 1)


def test_small_motions_are_the_active_ones():
    """Beyond 2f_c/Δ no speed is slow enough; within 2b/T fast motions still lose."""
    coarse = PADDLE.replace(resolution="22.4e-4")
    point = q.plane_point(coarse, 120)
    assert point.region == "limit cycles"
    assert q.admissible_speed(coarse, 120) == 0


def test_ideal_encoder():
    """Without an encoder both speeds are 2f_c/(K T − 2b) and σ is infinite."""
    assert q.plane_point(IDEAL, 770).dry == inf
    assert q.admissible_speed(IDEAL, 770) == q.admissible_speed(IDEAL, 770, "surface")


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: q.plane_point(PADDLE, 0), "stiffness must be > 0, got 0"),
        (lambda: q.fast_press(PADDLE, 301, counts=10714), r"= 10714\.3, got 10714"),
        (lambda: q.fast_press(PADDLE, 301, counts=20000.5), r"got 20000\.5"),
        (lambda: q.fast_press(PADDLE, 300), "does not exceed 2b/T = 300"),
        (lambda: q.edge_crossing(PADDLE, 10714), r"does not exceed 2f_c/Δ = 10714\.3"),
        (lambda: q.fast_press(IDEAL, 770), "no edges to count"),
        (lambda: q.edge_crossing(IDEAL, 770), "no edges to count"),
        (lambda: q.worst_case(PADDLE.replace(delay="0.001"), 300, 1), "without delay, got 1 ms"),
        (lambda: q.plane_point(PADDLE.replace(damping=(0.1, 0.2)), 300), "damping has no single value"),
        (lambda: q.plane_point(PADDLE.replace(resolution=0, coulomb_friction=0), 300), "σ = f_c"),
        (lambda: q.admissible_speed(PADDLE, 300, "outside"), 'start is "inside" or "surface"'),
    ],
)
def test_what_the_formulas_do_not_cover_is_refused(call, message):
    with pytest.raises(zw.InputError, match=message):
        call()
