"""Fine encoders: closed forms for slow hands, proofs on cells of many counts, motions on every n-th."""

from __future__ import annotations

from fractions import Fraction
from math import ceil
from random import Random

import pytest
from tampered import tampered

import zwidth as zw
from zwidth import checker
from zwidth.passivity.bracket import search as two_sides
from zwidth.passivity.storage.hand_bounds import slow_hands
from zwidth.passivity.storage.program import program_of
from zwidth.quantity.exact import Exact

ABOVE = Fraction(1001, 1000)


def device(counts, damping="0.025", friction="0.05", delay="0", **more):
    """So many counts in 40 mm, at 1 kHz."""
    return zw.Device(
        damping=damping,
        coulomb_friction=friction,
        resolution=Fraction(4, 100) / counts,
        sample_period="0.001",
        delay=delay,
        **more,
    )


def limit_of_slow_hands(loop, virtual, speed):
    """K of v = (2 f_c − K' Δ)/(K' T − 2 b), K' = K + 2 B/T."""
    step, period = loop.exact("resolution"), loop.exact("sample_period")
    most = 2 * (loop.exact("coulomb_friction") + loop.exact("damping") * speed) / (step + period * speed)
    return most - 2 * Fraction(virtual) / period


@pytest.mark.parametrize("counts", [4096, 65536, 2**20])
@pytest.mark.parametrize("virtual", ["0", "0.02"])
def test_slow_hands_from_both_sides(counts, virtual):
    """Proved at the closed limit, a thousandth above it not; 4 % above a motion gains."""
    loop, speed = device(counts), Fraction(1, 4)
    limit = limit_of_slow_hands(loop, virtual, speed)
    proof = slow_hands(loop, zw.Wall(limit, virtual), speed)
    assert proof.kind == "slow hands"
    assert slow_hands(loop, zw.Wall(limit * ABOVE, virtual), speed) is None
    assert slow_hands(loop, zw.Wall(limit, virtual), speed * ABOVE) is None
    beyond = program_of(loop, zw.Wall(limit * Fraction(104, 100), virtual), "0.002", speed)
    motion = beyond.refute(1024)
    assert motion.verify()
    assert motion.peak_speed <= speed
    assert motion.depth <= 0.002


@pytest.mark.parametrize("delay", ["0", "0.0003", "0.001"])
def test_every_number_of_a_slow_proof_binds(delay):
    """At its closed limit each changed for the worse by a thousandth is not accepted."""
    loop = device(65536, friction="0.06", delay=delay)
    speed = Fraction(1, 5)
    low, high = Fraction(1), Fraction(10_000)
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if slow_hands(loop, zw.Wall(middle), speed) else (low, middle)
    document = slow_hands(loop, zw.Wall(low), speed).documents[0]
    assert checker.verify(document).valid
    for path, factor in (
        (("loop", "damping_N_s_per_m"), "0.999"),
        (("loop", "coulomb_friction_N"), "0.999"),
        (("loop", "sample_period_s"), "1.001"),
        (("largest_speed_m_per_s",), "1.001"),
        (("enough", "damping_N_s_per_m"), "0.999"),
        (("enough", "coulomb_friction_N"), "0.999"),
    ):
        told = document[path[0]] if len(path) == 1 else document[path[0]][path[1]]
        worse = tampered(document, path, str(Fraction(told) * Fraction(factor)))
        assert not checker.verify(worse).valid, path


WALLS = {
    "spring": (zw.Wall(40), "0", "0.03"),
    "spring with a delay": (zw.Wall(40), "0.001", "0.08"),
    "spring with a delay of part of a sample": (zw.Wall(40), "0.0003", "0.04"),
    "damped": (zw.Wall(40, "0.01"), "0", "0.04"),
    "damped with a delay": (zw.Wall(40, "0.005"), "0.001", "0.08"),
    "negative damping": (zw.Wall(40, "-0.005"), "0.0003", "0.05"),
}


@pytest.mark.parametrize("name", WALLS)
def test_cells_of_many_counts_from_both_sides(name):
    """What is proved has no motion on any grid, and a little stiffer one has: a few per cent apart."""
    wall, delay, damping = WALLS[name]
    loop = device(2**20, damping, "0.05", delay)
    dear = name == "negative damping"  # to compute its grid
    bounds = {"penetration": "0.0005", "speed": "0.0625" if dear else "0.125"}
    tolerance = 0.15 if dear else 0.075
    bracket = zw.limit(loop, wall, **bounds, tolerance=tolerance)
    assert bracket.certificate.verify()
    assert bracket.witness.verify()
    assert bracket.relative_width < tolerance
    softer = wall.replace(stiffness=bracket.proved_passive)
    assert program_of(loop, softer, *bounds.values()).refute(64) is None
    assert bracket.witness.peak_speed <= float(bounds["speed"])
    assert bracket.witness.depth <= 0.0005


@pytest.mark.parametrize("name", WALLS)
def test_hands_between_the_ends_of_cells(name):
    """Random rounds behind the fine encoder, turns within a sample too: none gains where it is proved."""
    wall, delay, damping = WALLS[name]
    loop = device(4096 * 20, damping, "0.05", delay)
    bracket = zw.limit(loop, wall, penetration="0.002", speed="0.5", tolerance=0.1, effort=5)
    law = program_of(loop, wall.replace(stiffness=bracket.proved_passive), "0.002", "0.5").law
    step, period = (float(loop.exact(k)) for k in ("resolution", "sample_period"))
    late = loop.exact("delay") / loop.exact("sample_period")
    whole, part = ceil(late), float(late - ceil(late) + 1)
    b, fc, taps = float(damping), 0.05, [float(c) for c in law.taps]
    random = Random(name)

    def force(readings):
        return sum(c * q for c, q in zip(taps, readings, strict=True)) if readings[0] > 0 else 0.0

    best = 0.0
    for _ in range(60):
        cycle = [random.uniform(0, 0.002) for _ in range(random.randint(2, 6))]
        cycle = [x for x in cycle if abs(x - cycle[0]) <= 0.0005] or cycle[:1]
        shift = [random.random() for _ in cycle]
        readings, taken, x = [0.0] * 8, [], 0.0
        for k in range(6 * len(cycle) + 40):
            goal = cycle[k % len(cycle)]
            goal = min(max(goal, x - 0.0005), x + 0.0005)
            readings = [step * (x // step), *readings[:-1]]
            used = [readings[age : age + len(taps)] for age in (whole, max(whole - 1, 0))]
            turn = x + (goal - x) * (part if part == 1 else min(1, part * (0.5 + shift[k % len(cycle)])))
            near = 0.0005 * (1 - part)  # no faster after the turn; a whole sample ends at the goal
            turn = min(max(turn, goal - near), goal + near)
            out = -force(used[0]) * (turn - x) - fc * abs(turn - x) - b / (part * period) * (turn - x) ** 2
            if part < 1:
                rest = goal - turn
                out -= force(used[1]) * rest + fc * abs(rest) + b / ((1 - part) * period) * rest**2
            taken.append(out)
            x = goal
        best = max(best, sum(taken[-len(cycle) * 2 :]))
    assert best <= 1e-12


@pytest.mark.parametrize("seed", range(16))
def test_refuting_motions_keep_the_stated_bounds(seed):
    """Way in, rounds and turns: no faster, no deeper than stated; and the checker sees to it."""
    random = Random(seed)
    period = random.choice(["0.0005", "0.001"])
    step = Fraction(random.choice([1, 2, 5, 10]), 100_000)
    delay = Fraction(random.choice([0, 0, "0.3", 1])) * Fraction(period)
    loop = zw.Device(
        damping=f"{random.uniform(0.05, 0.5):.3f}",
        coulomb_friction=f"{random.uniform(0, 0.07):.3f}",
        resolution=step,
        sample_period=period,
        delay=delay,
    )
    counts = Fraction(f"{random.uniform(0.4, 6):.2f}")
    speed, depth = counts * step / Fraction(period), Fraction(f"{random.uniform(2.1, 12):.1f}") * step
    wall = zw.Wall(f"{random.uniform(1000, 30000):.0f}", random.choice(["0", "0.05"]))
    motion = program_of(loop, wall, depth, speed).refute(1024)
    if motion is None:
        return
    document = motion.to_dict()
    assert checker.verify(document).valid
    assert Fraction(document["bounds"]["speed_m_per_s"]) <= speed
    x = motion.motion.positions
    if not motion.motion.switch_positions:
        assert max(abs(b - a) for a, b in zip(x, x[1:], strict=False)) <= speed * Fraction(period)
    assert max(x) <= depth
    assert motion.peak_speed <= float(speed) * (1 + 1e-12)
    slower = {**document["bounds"], "speed_m_per_s": str(Fraction(motion.peak_speed) * Fraction(99, 100))}
    assert "keep to its speed" in checker.verify({**document, "bounds": slower}).reason
    flat = {**document["bounds"], "depth_m": str(max(x) / 2)}
    assert "keep to its depth" in checker.verify({**document, "bounds": flat}).reason


def test_the_way_in_is_as_slow_as_the_hand():
    """A device whose lead-in was half as fast again as the hand."""
    loop = zw.Device(damping=".454", coulomb_friction=".063", resolution="1e-5", sample_period="0.0005")
    program = program_of(loop, zw.Wall(7600), "8e-5", "0.0262")
    motion = program.refute(1024)
    assert motion.peak_speed <= 0.0262
    assert f"{1e3 * motion.peak_speed:.4g} mm/s" in motion.describe()


def test_this_hand_is_never_worse_than_every_hand():
    """A wheel of many counts, out of time at once: what covers every hand covers this one."""
    wheel = zw.Device(
        motion="rotary",
        damping="0.02",
        coulomb_friction="0.05",
        resolution="0.0000958738",
        sample_period="0.001",
        delay="0.0003",
    )
    bracket = zw.limit(wheel, zw.Wall(57), speed="12.566", penetration="0.0873", effort=0.2)
    assert bracket.proved_passive >= bracket.every_hand[0]
    assert bracket.certificate.verify()
    if bracket.proved_active is not None:
        assert bracket.every_hand[1] is not None
        assert bracket.every_hand[1] <= bracket.proved_active


def test_the_two_sides_share_the_work():
    """A proof that takes ten times as much leaves half of it to motions."""
    clock = [0.0]

    def taking(work, shown):
        def holds(value, most):
            clock[0] += work
            return shown(value)

        return holds

    proofs = two_sides.Side(taking(10.0, lambda v: v < 90), 1, Exact(1))
    motions = two_sides.Side(taking(1.0, lambda v: v > 110), -1, Exact(1))
    two_sides.approach(proofs, motions, 0.001, 60.0, lambda: clock[0])
    assert motions.good is not None
    assert motions.good > 110
    assert proofs.spent <= 40


def test_the_bounds_are_data():
    bounds = program_of(device(4096), zw.Wall(100), "0.002", "0.5").bounds
    assert bounds.speed == Fraction(1, 2)
    assert bounds.counts_per_sample == Fraction(1, 2000) / (Fraction(4, 100) / 4096)
    assert bounds.penetration >= bounds.max_depth == Fraction(2, 1000)
    assert bounds.counts_deep == ceil(Fraction(2, 1000) / (Fraction(4, 100) / 4096))
    assert bounds.outside is None
