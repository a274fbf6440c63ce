"""Hunt–Crossley contacts by value iteration: friction of half the jump of the force that a toggling hand
meets.

A hand that toggles over the edge between the counts n − 1 and n, a little way ε to
either side, meets p(n) (1 + λ Δ/T) going out and p(n − 1) (1 − λ Δ/T) going in, the
latter no less than 0 where the contact never pulls.  It takes out the difference J
times ε and pays 2 f_c ε.  J grows with n, so that with ample b the limit is

    f_c = ½ [p(N) (1 + λ Δ/T) − p(N − 1) max(1 − λ Δ/T, 0)],     N the deepest reading.
"""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

import zwidth as zw
from zwidth.passivity.bracket import passive_limit
from zwidth.passivity.storage import available_storage
from zwidth.passivity.storage.gain import settled_round
from zwidth.passivity.storage.grid import Grid
from zwidth.passivity.storage.law import finite_law
from zwidth.passivity.storage.program import program_of

COUNT, PERIOD = 1e-4, 1e-3
BOUNDS = {"penetration": "0.002", "speed": "0.5"}  # the deepest reading is 19
DEEPEST = 19


def device(damping, friction, **more):
    """A device of 0.1 mm a count at 1 kHz."""
    numbers = {"resolution": "0.0001", "sample_period": "0.001", **more}
    return zw.Device(damping=damping, coulomb_friction=friction, **numbers)


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


@pytest.mark.parametrize("delay", [0, PERIOD])
@pytest.mark.parametrize("clamped", [True, False])
def test_the_simulator_gives_the_forces_of_the_motion(clamped, delay):
    """A motion that gains, prescribed to the simulator: the same forces, sample by sample."""
    held = device("0.3", "0.1", resolution=Fraction(1, 8192), delay=delay)  # counts that doubles hold
    contact = zw.HuntCrossley(20000, "1.5", 12, clamped)
    found = available_storage(held, contact, penetration="0.001", speed="0.5")
    assert found.outcome == "active"
    motion = zw.operators.WitnessMotion(found.witness, rounds=3)
    ideal = zw.amplifiers.Ideal()
    trace = zw.simulate(held, contact, motion, duration=motion.intervals * PERIOD, amplifier=ideal)
    expected = settled_round(found.witness).forces
    played = trace.actuator_force.values[-1 - len(expected) : -1]
    np.testing.assert_allclose(played, expected, rtol=1e-12, atol=1e-12)
    energy = -float(trace.hand_work[-1])
    rounds = found.witness.motion.repeated(3)
    assert rounds.repeats[0].times == 3
    assert energy == pytest.approx(_energy(found, rounds), rel=1e-9, abs=1e-12)


def _energy(found, motion):
    """Taken out by a motion, from the exact law [J]."""
    law, x = finite_law(found.device, found.environment), motion.listed().positions
    count, late = found.device.exact("resolution"), int(found.device.exact("delay") / Fraction(1, 1000))
    b, f_c = (found.device.exact(k) for k in ("damping", "coulomb_friction"))
    read, out = [count * (p // count) for p in x], Fraction(0)
    for k in range(len(x) - 1):
        d, force = x[k + 1] - x[k], Fraction(0)
        if k >= late:
            force = law.force((read[k - late], read[max(k - late - 1, 0)]))
        out -= force * d + f_c * abs(d) + b * 1000 * d * d
    return float(out)
