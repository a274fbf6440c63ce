"""Laws with memory, touched and left: the inequalities of the proofs, and both sides by the game."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from random import Random

import pytest
from strategies import seeds

import zwidth as zw
from zwidth.passivity.check import check_by_closed_forms
from zwidth.passivity.storage.domain import domain_for, losses_of
from zwidth.passivity.storage.law import finite_law
from zwidth.passivity.storage.program import DynamicProgram

ZERO = Fraction(0)


def moved(random, x, size):
    """The next position: anywhere, near an edge of the encoder, or near the surface; Δ = 1."""
    tiny = Fraction(1, 1000)
    return random.choice(
        (
            x + Fraction(random.randint(-1000 * size, 1000 * size), 1000),
            random.randint(-size, size) + random.choice((ZERO, tiny, -tiny, 1 - tiny)),
            random.choice((ZERO, Fraction(1), 1 - tiny, 1 + tiny, Fraction(1, 2), Fraction(-size))),
            x + Fraction(random.randint(-2000, 2000), 1000),
        )
    )


@pytest.mark.parametrize("anew", [False, True])
@seeds(25)
def test_a_law_that_relaxes_gives_no_more_than_in_contact(seed, anew):
    """Fed with the penetration: in each interval the hand pays at least what the motion y pays, T = 1."""
    random = Random(seed)
    rest = [Fraction(-random.randint(0, 6), 4) for _ in range(random.randint(1, 5))]
    static = Fraction(random.choice((0, 0, 1, 3, 8)), 4)
    h = [static - sum(rest), *rest]
    b, friction, m = h[0] / 2, (h[0] - sum(rest)) / 2, static / 2
    size, x = random.choice((1, 2, 5, 20)), -Fraction(random.randint(0, 30), 10)
    u, y = [], []
    for _ in range(60):
        x2 = moved(random, x, size)
        reading = Fraction(x // 1)
        u, y = [max(reading, ZERO), *u], [max(x - 1, ZERO), *y]
        force = sum(c * v for c, v in zip(h, u, strict=False)) if reading > 0 else ZERO
        linear = sum(c * v for c, v in zip(h, y, strict=False))
        d, e = x2 - x, max(x2 - 1, ZERO) - y[0]
        paid = force * d + b * d * d + friction * abs(d)
        assert paid >= linear * e + b * e * e + m * (max(x2, ZERO) - max(x, ZERO))
        if anew and reading <= 0:
            u, y = [], []
        x = x2


@pytest.mark.parametrize("anew", [False, True])
@seeds(25)
def test_a_solid_that_never_pulls_has_this_storage(seed, anew):
    """Exactly at the two conditions, with encoder, the storage of the proof rises by no more than is paid."""
    random = Random(seed)
    k, g = Fraction(random.randint(0, 8), 4), Fraction(random.randint(1, 8), 4)
    p = Fraction(random.randint(0, 19), 20)
    b, friction = k / 2 + g / (1 + p), (k + 2 * g) / 2
    size, x, a, average = random.choice((1, 2, 5, 20)), -Fraction(random.randint(0, 30), 10), ZERO, ZERO

    def stored(x, average):
        w = max(x - 1, ZERO, g * average / (k + g))
        return (k * w**2 + g * (w - average) ** 2 + k * max(x, ZERO)) / 2

    for _ in range(60):
        x2 = moved(random, x, size)
        reading = Fraction(x // 1)
        u, y, d = max(reading, ZERO), max(x - 1, ZERO), x2 - x
        force = max(k * u + g * (u - a), ZERO) if reading > 0 else ZERO
        forgets = anew and reading <= 0
        after = ZERO if forgets else p * average + (1 - p) * y
        assert force * d + b * d * d + friction * abs(d) >= stored(x2, after) - stored(x, average)
        a = ZERO if forgets else p * a + (1 - p) * u
        x, average = x2, after


def test_the_linear_criterion_asks_for_half_the_first_force():
    """b ≥ h₀ T/2 for every law, as the mean of the criterion over all frequencies."""
    ideal = zw.Device(damping=9, coulomb_friction=0, resolution=0, sample_period=1, delay=0, mass=1)
    for law, first in (
        (zw.Wall(3, damping=2), 5),
        (zw.Wall(3, damping=2, velocity_filter=zw.rendering.Window(4)), Fraction(7, 2)),
        (zw.Wall(3, damping=2, velocity_filter=zw.rendering.OnePole(7)), Fraction(13, 4)),
        (zw.StandardLinearSolid(3, 5, 4), 3 + Fraction(20, 9)),
    ):
        assert zw.check(ideal, law).required_damping >= first / 2


def played(surface, time_constant):
    """A wall of K = 1, B = 10 behind one pole, T = Δ = 1, with 2 % more than sustained contact asks for."""
    wall = zw.Wall(1, damping=10, velocity_filter=zw.rendering.OnePole(time_constant))
    damping, friction = (
        (Fraction(1, 2) + Fraction(10, 1 + n * time_constant)) * Fraction("1.02") for n in (2, 1)
    )
    device = zw.Device(damping=damping, coulomb_friction=friction, resolution=1, sample_period=1)
    law, losses = replace(finite_law(device, wall), surface=surface), losses_of(device)
    return DynamicProgram(law, losses, domain_for(law, losses, 12, 12), "linear")


@pytest.mark.parametrize(("surface", "time_constant"), [("penetration", 9), ("position", 1)])
def test_the_criterion_holds_where_the_filter_is_fast_or_fed_with_the_penetration(surface, time_constant):
    storage = played(surface, time_constant).prove(32)
    assert storage is not None
    assert storage.certificate().verify()


def test_a_slow_filter_fed_with_the_position_breaks_the_criterion():
    found = (played("position", 9).refute(steps) for steps in (64, 256, 16))
    motion = next((m for m in found if m is not None), None)
    assert motion is not None
    assert motion.verify()


def test_the_claim_of_a_filtered_wall_says_that_contact_is_kept():
    device = zw.Device(damping="5.2", coulomb_friction="9", resolution=1, sample_period=1)
    filtered = check_by_closed_forms(device, zw.Wall(1, damping=10, velocity_filter=zw.rendering.Window(3)))
    assert filtered.outcome == "passive in contact"
    assert "that keeps contact" in filtered.claim
    spring = zw.check(device, zw.Wall("0.5"))
    assert spring.outcome == "passive"
    assert "keeps contact" not in spring.claim


@pytest.mark.parametrize(
    ("solid", "delay", "covered"),
    [
        (zw.StandardLinearSolid(100, 200, 1), "0.001", True),
        (zw.StandardLinearSolid(100, 200, 1), "0.0005", False),
        (zw.GeneralizedMaxwell(100, [(200, 1), (50, 3)]), "0.001", False),
    ],
)
def test_solids_that_are_touched_and_left_late(solid, delay, covered):
    """The first assumption says whether that is covered, and the certificate is of it."""
    device = zw.Device(damping=2, coulomb_friction=1, resolution="0.0001", sample_period="0.001", delay=delay)
    verdict = check_by_closed_forms(device, solid)
    assert verdict.outcome == ("passive" if covered else "passive in contact")
    assert (verdict.certificate.covered().contact == "made and broken") is covered


def touched_coupling(random):
    """A coupling before a wall, and the least b and f_c of a device that renders it, T = Δ = 1."""
    stiffness, damping, wall = (Fraction(random.randint(1, 40), 8) for _ in range(3))
    pole = damping / (wall + stiffness + damping)
    rest = wall * stiffness / (wall + stiffness)
    part = wall * (stiffness + damping) / (wall + stiffness + damping) - rest
    need = rest / 2 + part / (1 + pole), (rest + 2 * part) / 2
    return zw.VirtualCoupling(stiffness, damping, zw.Wall(wall)), need


@pytest.mark.parametrize("seed", range(16))
def test_a_coupling_before_a_wall_relaxes_as_a_solid_does(seed):
    """Fed with the penetration it is covered, contact made and broken, at its closed form and no less."""
    coupling, (damping, friction) = touched_coupling(Random(seed))
    device = zw.Device(damping=damping, coulomb_friction=friction, resolution=1, sample_period=1, delay=0)
    verdict = check_by_closed_forms(device, coupling)
    assert verdict.outcome == "passive"
    assert (verdict.scope.contact, verdict.scope.fed_with) == ("made and broken", "penetration")
    assert verdict.certificate.verify()
    for key, value in (("damping", damping), ("coulomb_friction", friction)):
        less = device.replace(**{key: value * (1 - Fraction(1, 10**9))})
        assert check_by_closed_forms(less, coupling).outcome != "passive"


@pytest.mark.parametrize("seed", range(16))
def test_no_motion_gains_from_a_coupling_at_its_closed_form(seed):
    """Random motions in and out, the force computed from springs and dashpot alone."""
    random = Random(seed)
    coupling, (damping, friction) = touched_coupling(random)
    assert finite_law(zw.Device(damping=1, sample_period=1, resolution=1), coupling).surface == "penetration"
    k, c, wall = (v.fraction for v in (coupling.stiffness, coupling.damping, coupling.environment.stiffness))
    size, x, u, joint, work = random.choice((1, 2, 5, 20)), ZERO, ZERO, ZERO, ZERO
    for _ in range(60):
        x2 = moved(random, x, size)
        before, u = u, max(Fraction(x // 1), ZERO)
        joint = (k * u + c * (u - before) + c * joint) / (wall + k + c)  # the joint of coupling and wall
        force, d = (wall * joint if x // 1 > 0 else ZERO), x2 - x
        work += force * d + damping * d * d + friction * abs(d)
        assert work >= 0
        x = x2
