"""Contacts and converters by value iteration: friction of half the jump of the force that a toggling hand
meets.

A hand that toggles over the edge between the counts n − 1 and n, a little way ε to
either side, meets the two forces of its sides, takes out their difference J times ε
and pays 2 f_c ε.  Where b is ample nothing gains more, so that f_c ≥ J/2 is the limit.
Of a Hunt–Crossley contact these are p(n) (1 + λ Δ/T) going out and p(n − 1) (1 − λ Δ/T)
going in, the latter no less than 0 where the contact never pulls; J grows with n:

    f_c = ½ [p(N) (1 + λ Δ/T) − p(N − 1) max(1 − λ Δ/T, 0)],     N the deepest reading.

Of a converter with a step h and K Δ ≤ h the largest rise from one count to the next is h;
with K Δ > h it is the next whole multiple of h, as soon as the hand goes deep enough for
the steps to fall so.
"""

from __future__ import annotations

from fractions import Fraction
from math import floor
from random import Random

import numpy as np
import pytest
from counted_device import device

import zwidth as zw
from zwidth.loop.law import rounded
from zwidth.passivity.bracket import passive_limit
from zwidth.passivity.storage import available_storage
from zwidth.passivity.storage.gain import settled_round
from zwidth.passivity.storage.grid import Grid
from zwidth.passivity.storage.law import FiniteLaw, finite_law
from zwidth.passivity.storage.program import program_of

COUNT, PERIOD, STEP = Fraction(1, 10**4), Fraction(1, 1000), Fraction(2, 100)
BOUNDS = {"penetration": "0.002", "speed": "0.5"}  # the deepest reading is 19
DEEPEST = 19


def jump(exponent, dissipation, clamped=True):
    """J for K = 1 [N]."""
    share = dissipation * COUNT / PERIOD
    deep, shallow = ((n * COUNT) ** exponent for n in (DEEPEST, DEEPEST - 1))
    going_in = max(1 - share, 0.0) if clamped else 1 - share
    return deep * (1 + share) - shallow * going_in


@pytest.mark.parametrize(
    ("exponent", "dissipation", "clamped", "damping"),
    [
        (1, 0.5, True, 4),
        (1.5, 0, True, 4),
        (1.5, 2, True, 8),
        (1.5, 15, True, 60),
        (1.5, 15, False, 60),
        (2.2, 3, True, 4),
        (3, 1, True, 4),
    ],
)
def test_friction_stiffness_and_dissipation_from_both_sides(exponent, dissipation, clamped, damping):
    """The closed form lies within each bracket of 1 %, and the hand toggles."""
    stiffness = 1.2 / (DEEPEST * COUNT) ** exponent  # p(N) = 1.2 N
    contact = zw.HuntCrossley(f"{stiffness:.6g}", exponent, dissipation, clamped)
    limit = float(contact.stiffness) * jump(exponent, dissipation, clamped) / 2
    near = f"{limit:.6g}"
    friction = passive_limit(device(damping, near), contact, "coulomb_friction", **BOUNDS)
    assert friction.proved_active < limit <= friction.proved_passive
    bracket = passive_limit(device(damping, near), contact, **BOUNDS)
    assert bracket.proved_passive <= float(contact.stiffness) * (1 + 1e-5)
    assert bracket.proved_active > float(contact.stiffness) * (1 - 1e-5)
    for found in (friction, bracket):
        assert found.relative_width <= 0.01
        assert found.certificate.verify()
        assert found.witness.verify()
        assert max(found.witness.cycle) - min(found.witness.cycle) < COUNT / 10
    if dissipation:
        found = passive_limit(device(damping, near), contact, "dissipation", **BOUNDS)
        assert found.proved_passive <= dissipation * (1 + 1e-4)
        assert found.proved_active > dissipation * (1 - 1e-4)


def test_exponent_one_without_dissipation_is_a_spring_wall():
    """The same states, the same V to the unit, the same motion."""
    held = device("0.16", "0.0165")
    one, other = (program_of(held, law, **BOUNDS) for law in (zw.HuntCrossley(300, 1), zw.Wall(300)))
    assert one.domain == other.domain
    ours, theirs = (program.prove(8).iteration for program in (one, other))
    assert ours.value.shape == theirs.value.shape
    stored = (each.value * float(each.grid.energy_unit) for each in (ours, theirs))
    assert next(stored) == pytest.approx(next(stored), rel=1e-6, abs=1e-12)


def test_a_small_dissipation_is_a_damped_wall_around_one_depth():
    """At the depth n, f = K u (1 + λ v) has the virtual damping λ K n Δ: near the surface it needs less."""
    held = device(2, "0.001")
    contact = passive_limit(held, zw.HuntCrossley(300, 1, "0.5"), "coulomb_friction", **BOUNDS)
    damped = [
        passive_limit(held, zw.Wall(300, 0.5 * 300 * n * COUNT), "coulomb_friction", **BOUNDS).proved_passive
        for n in (DEEPEST - 1, DEEPEST)
    ]
    assert damped[0] * 0.99 < contact.proved_passive < damped[1] * 1.01


def test_forces_are_written_down_at_every_reading():
    """The points of the document are K uⁿ, and the law between the readings plays no part."""
    contact = zw.HuntCrossley(20000, "1.5", 2)
    found = available_storage(device(8, "0.5"), contact, **BOUNDS)
    law = found.certificate.to_dict()["law"]
    points = [(Fraction(x), Fraction(f)) for x, f in law["points_m_N"]]
    assert [x for x, _ in points] == [n * Fraction(1, 10**4) for n in range(DEEPEST + 1)]
    assert [f for _, f in points] == [contact.force(x).fraction for x, _ in points]
    assert Fraction(law["rate_per_m"]) == 2000
    assert law["surface"] == "position"
    assert law["clamped"] is True
    assert any("17 digits" in line for line in found.assumptions)
    whole = available_storage(device(8, "0.5"), contact.replace(exponent=2), **BOUNDS)
    assert not any("17 digits" in line for line in whole.assumptions)
    rotary = zw.Device(damping=8, coulomb_friction=1, resolution="0.0001", rate=1000, motion="rotary")
    law = available_storage(rotary, contact, **BOUNDS).certificate.to_dict()["law"]
    assert {"points_rad_N_m", "rate_per_rad"} < set(law)


@pytest.mark.parametrize("force_resolution", [False, True])
def test_the_grid_has_the_forces_of_the_law(force_resolution):
    """To the unit below, for every reading and the one before it, with and without a converter."""
    held = device(8, 1, force_resolution="0.11")
    program = program_of(held, zw.HuntCrossley(20000, "1.5", 4), force_resolution=force_resolution, **BOUNDS)
    grid = Grid(program.law, program.losses, program.domain, 4, "outer")
    step, seen = program.losses.resolution, 0
    for i, n in enumerate(range(grid.domain.lowest, grid.domain.highest + 1)):
        for j, e in enumerate(range(-grid.domain.reach, grid.domain.reach + 1)):
            if grid.domain.lowest <= n + e <= grid.domain.highest:
                force = program.law.force((n * step, (n + e) * step))
                assert int(grid.forces[i, j]) == force // grid.force_unit
                seen += force > 0
    assert seen > 100


SIMULATED = {
    "contact": (zw.HuntCrossley(20000, "1.5", 12), {}),
    "contact, late": (zw.HuntCrossley(20000, "1.5", 12), {"delay": 1}),
    "contact that pulls": (zw.HuntCrossley(20000, "1.5", 12, False), {}),
    "contact that pulls, late": (zw.HuntCrossley(20000, "1.5", 12, False), {"delay": 1}),
    "spring": (zw.Wall(60), {"force_resolution": "0.0170001"}),
    "damped": (zw.Wall(300, "0.1"), {"force_resolution": "0.0170001"}),
    "clamped and late": (zw.Wall(300, "0.1", clamped=True), {"force_resolution": "0.0170001", "delay": 1}),
    "limited": (zw.Wall(300, "0.1"), {"force_resolution": "0.0170001", "force_limit": "0.13"}),
    "points": (
        zw.NonlinearSpring([-4e-4, -2e-4, 0, 2e-4, 4e-4], [0, "-0.05", 0, "0.05", 0]),
        {"force_resolution": "0.0170001"},
    ),
}
"""Steps that make no ties, which doubles could miss."""


@pytest.mark.parametrize("name", SIMULATED)
def test_the_simulator_gives_the_forces_of_the_motion(name):
    """A motion that gains, prescribed to the simulator: the same forces and whole steps, the same energy."""
    law, more = SIMULATED[name]
    stepped, limited = "force_resolution" in more, "force_limit" in more
    losses = ("0.1", "0.004") if stepped else ("0.3", "0.1")
    held = device(*losses, resolution=Fraction(1, 8192), **more)  # counts that doubles hold
    counted = {"force_limit": limited, "force_resolution": stepped}
    found = available_storage(held, law, penetration="0.001", speed="0.5", **counted)
    assert found.outcome == "active"
    part = found.witness.motion.repeats[0]
    motion = zw.operators.WitnessMotion(found.witness, rounds=3)
    amplifier = {} if stepped else {"amplifier": zw.amplifiers.Ideal()}
    trace = zw.simulate(held, law, motion, duration=motion.intervals * PERIOD, **amplifier)
    expected = settled_round(found.witness).forces
    assert part.last - part.first == len(expected)
    played = trace.actuator_force.values[-1 - len(expected) : -1]
    np.testing.assert_allclose(played, expected, rtol=1e-12, atol=1e-12)
    steps = np.array(expected) / 0.0170001
    assert not stepped or limited or (abs(steps - np.round(steps)) < 1e-9).all()
    assert limited is bool((abs(np.array(expected)) == 0.13).any())
    rounds = found.witness.motion.repeated(3)
    assert rounds.repeats[0].times == 3
    energy = _energy(held, finite_law(held, law, **counted), rounds)
    assert -float(trace.hand_work[-1]) == pytest.approx(energy, rel=1e-9, abs=1e-12)


def _energy(held, law, motion):
    """Taken out by a motion, from the exact law [J]."""
    x, count, late = motion.listed().positions, held.exact("resolution"), int(held.exact("delay") / PERIOD)
    b, f_c = (held.exact(k) for k in ("damping", "coulomb_friction"))
    read, out = [count * (p // count) for p in x], Fraction(0)
    for k in range(len(x) - 1):
        d, force = x[k + 1] - x[k], Fraction(0)
        if k >= late:
            force = law.force((read[k - late], read[max(k - late - 1, 0)])[: law.memory + 1])
        out -= force * d + f_c * abs(d) + b * 1000 * d * d
    return float(out)


def coarse(friction, **more):
    """A device with a coarse converter and ample damping."""
    return device(1, friction, force_resolution=STEP, **more)


def largest_rise(stiffness, deepest, step=STEP):
    """J over the counts 0 … deepest, by the converter's definition, half a step rounded up [N]."""
    wished = [Fraction(stiffness) * COUNT * n / step for n in range(deepest + 1)]
    given = [floor(2 * w + 1) // 2 for w in wished]
    return step * max(b - a for a, b in zip(given, given[1:], strict=False))


@pytest.mark.parametrize(
    ("stiffness", "rise"), [(7, 1), (60, 1), (130, 1), (200, 1), (230, 2), (400, 2), (460, 3)]
)
def test_friction_of_half_the_largest_rise(stiffness, rise):
    """From both sides to 1 %, for walls softer and stiffer than one step a count."""
    assert largest_rise(stiffness, 29) == rise * STEP
    bounds = {"penetration": "0.003", "speed": "0.5"}
    loop = coarse("0.02"), zw.Wall(stiffness)
    bracket = passive_limit(*loop, "coulomb_friction", **bounds, force_resolution=True)
    assert bracket.proved_active < rise * STEP / 2 <= bracket.proved_passive
    assert bracket.relative_width <= 0.01
    assert bracket.certificate.verify()
    assert bracket.witness.verify()
    cycle = bracket.witness.cycle
    assert max(cycle) - min(cycle) < COUNT / 10
    ideal = passive_limit(*loop, "coulomb_friction", **bounds)
    assert ideal.proved_active < stiffness * COUNT / 2 <= ideal.proved_passive


def test_how_coarse_a_converter_may_be():
    """h = 2 f_c for a soft wall, to 1 %."""
    loop = coarse("0.013"), zw.Wall(60)
    bracket = passive_limit(
        *loop, "force_resolution", penetration="0.002", speed="0.5", force_resolution=True
    )
    assert bracket.proved_passive <= 0.026 < bracket.proved_active
    assert bracket.relative_width <= 0.011


@pytest.mark.parametrize("counts", [10, 40])
def test_stiffness_up_to_one_step_a_count(counts):
    """With ½ h < f_c < h: K Δ = h (1 + ½/(n − 1)), where n counts down the steps first fall two at once."""
    loop = coarse("0.014"), zw.Wall(60)
    bracket = passive_limit(
        *loop, penetration=counts * COUNT, speed="0.5", force_resolution=True, tolerance=0.004
    )
    exact = STEP / COUNT * (1 + Fraction(1, 2 * (counts - 1)))
    assert bracket.proved_passive < exact <= bracket.proved_active
    assert bracket.relative_width <= 0.004
    assert largest_rise(bracket.proved_passive, counts - 1) == STEP
    assert largest_rise(bracket.proved_active, counts - 1) == 2 * STEP


def test_rounded_as_the_simulator_rounds():
    """The law's force, with many ties, against what the kernel of the simulator makes of the same command."""
    random, ties = Random(1), 0
    for _ in range(2000):
        step, limit = Fraction(random.randint(1, 9), 8), Fraction(random.randint(1, 60), 16)
        taps = tuple(Fraction(random.randint(-9, 9), 4) for _ in range(2))
        law = FiniteLaw(taps, "none", force_limit=limit, force_step=step)
        readings = tuple(Fraction(random.randint(-9, 9)) for _ in range(2))
        wished = sum(c * q for c, q in zip(taps, readings, strict=True))
        given = Fraction(rounded(float(wished), float(step)))
        assert law.force(readings) == max(-limit, min(limit, given))
        ties += (wished / step - Fraction(1, 2)).denominator == 1
    assert ties > 100


def test_the_force_step_stands_in_the_document():
    """With its unit, of a linear and of a rotary device; not where it is not counted in."""
    loop = coarse("0.01")
    law = finite_law(loop, zw.Wall(60), force_resolution=True)
    assert law.document("linear")["force_step_N"] == "0.02"
    assert law.document("rotary")["force_step_N_m"] == "0.02"
    assert "force_step_N" not in finite_law(loop, zw.Wall(60)).document("linear")
    said = available_storage(
        loop, zw.Wall(60), penetration="0.001", speed="0.3", force_resolution=True
    ).assumptions
    assert "the converter steps are counted in; force limit, current rise and added filters are not" in said
