"""The converter's steps by value iteration: friction of half the largest rise of the force from count to
count.

A hand that toggles over an edge, a little way ε to either side, meets the two forces
of its sides: it takes out J ε, J the rise from one count to the next, and pays
2 f_c ε.  Where b is ample nothing gains more, so that f_c ≥ J/2 is the limit.
With a step h and K Δ ≤ h the largest rise is h; with K Δ > h it is the next whole
multiple of h, as soon as the hand goes deep enough for the steps to fall so.
"""

from __future__ import annotations

from fractions import Fraction
from math import floor
from random import Random

import numpy as np
import pytest

import zwidth as zw
from zwidth.loop.law import rounded
from zwidth.passivity.bracket import passive_limit
from zwidth.passivity.storage import available_storage
from zwidth.passivity.storage.gain import settled_round
from zwidth.passivity.storage.law import FiniteLaw, finite_law

STEP, COUNT, PERIOD = Fraction(2, 100), Fraction(1, 10**4), Fraction(1, 1000)


def device(friction, damping=1, step=STEP, **more):
    """A device of 0.1 mm a count at 1 kHz with a coarse converter and ample damping."""
    numbers = {"resolution": COUNT, "sample_period": PERIOD, "force_resolution": step, **more}
    return zw.Device(damping=damping, coulomb_friction=friction, **numbers)


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
    loop = device("0.02"), zw.Wall(stiffness)
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
    loop = device("0.013"), zw.Wall(60)
    bracket = passive_limit(
        *loop, "force_resolution", penetration="0.002", speed="0.5", force_resolution=True
    )
    assert bracket.proved_passive <= 0.026 < bracket.proved_active
    assert bracket.relative_width <= 0.011


@pytest.mark.parametrize("counts", [10, 40])
def test_stiffness_up_to_one_step_a_count(counts):
    """With ½ h < f_c < h: K Δ = h (1 + ½/(n − 1)), where n counts down the steps first fall two at once."""
    loop = device("0.014"), zw.Wall(60)
    bracket = passive_limit(
        *loop, penetration=counts * COUNT, speed="0.5", force_resolution=True, tolerance=0.004
    )
    exact = STEP / COUNT * (1 + Fraction(1, 2 * (counts - 1)))
    assert bracket.proved_passive < exact <= bracket.proved_active
    assert bracket.relative_width <= 0.004
    assert largest_rise(bracket.proved_passive, counts - 1) == STEP
    assert largest_rise(bracket.proved_active, counts - 1) == 2 * STEP


@pytest.mark.parametrize(
    ("wall", "more"),
    [
        (zw.Wall(60), {}),
        (zw.Wall(300, "0.1"), {}),
        (zw.Wall(300, "0.1", clamped=True), {"delay": PERIOD}),
        (zw.Wall(300, "0.1"), {"force_limit": Fraction(13, 100)}),
        (zw.NonlinearSpring([-4e-4, -2e-4, 0, 2e-4, 4e-4], [0, "-0.05", 0, "0.05", 0]), {}),
    ],
    ids=["spring", "damped", "clamped and late", "limited", "points"],
)
def test_the_simulator_gives_the_forces_of_the_motion(wall, more):
    """A motion that gains, prescribed to the simulator: the same whole steps, up to the force limit."""
    # counts that doubles hold, and a step that makes no ties, which they could miss
    held = device("0.004", "0.1", "0.0170001", resolution=Fraction(1, 8192), **more)
    limited = "force_limit" in more
    found = available_storage(
        held, wall, penetration="0.0008", speed="0.4", force_limit=limited, force_resolution=True
    )
    assert found.outcome == "active"
    part = found.witness.motion.repeats[0]
    motion = zw.operators.WitnessMotion(found.witness, rounds=3)
    trace = zw.simulate(held, wall, motion, duration=motion.intervals * PERIOD)
    expected = settled_round(found.witness).forces
    played = trace.actuator_force.values[-1 - len(expected) : -1]
    assert part.last - part.first == len(expected)
    np.testing.assert_allclose(played, expected, rtol=1e-12)
    steps = np.array(expected) / 0.0170001
    whole = abs(steps - np.round(steps)) < 1e-9
    assert whole.all() or limited
    assert limited is bool((abs(np.array(expected)) == 0.13).any())


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
    loop = device("0.01")
    law = finite_law(loop, zw.Wall(60), force_resolution=True)
    assert law.document("linear")["force_step_N"] == "0.02"
    assert law.document("rotary")["force_step_N_m"] == "0.02"
    assert "force_step_N" not in finite_law(loop, zw.Wall(60)).document("linear")
    said = available_storage(
        loop, zw.Wall(60), penetration="0.001", speed="0.3", force_resolution=True
    ).assumptions
    assert "the converter steps are counted in; force limit, current rise and added filters are not" in said
