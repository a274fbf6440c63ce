"""Force bounding as it is computed, in doubles: never a line too high, not by the last digit."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from tempting import device, follow, tempt, wall
from test_force_bounding import DEVICES, bounded

import zwidth as zw
from zwidth.model.rendering import ForceBounding
from zwidth.model.rendering.bounding import force_bounding_step
from zwidth.model.rendering.rendering_law import LoopContext


def exact_energy_in(paddle, positions, forces):
    """What the hand has put in at each sample, in rational arithmetic."""
    b, fc, period = (paddle.exact(key) for key in ("damping", "coulomb_friction", "sample_period"))
    x, total = [Fraction(float(p)) for p in positions], [Fraction(0)]
    for before, after, force in zip(x, x[1:], forces, strict=False):
        d = after - before
        total.append(total[-1] + Fraction(float(force)) * d + fc * abs(d) + b / period * d * d)
    return total


@pytest.mark.parametrize(("friction", "size"), DEVICES)
def test_nothing_comes_out_not_even_a_rounding(friction, size):
    """Hands that know the law, their energy in rational arithmetic: never below 0 at all."""
    paddle = device(friction=friction, resolution=size)
    loop = zw.render(zw.Wall(5000), ForceBounding())
    for seed in range(10, 14):
        positions, _ = tempt(bounded(wall(5000), paddle), paddle, 600, seed)
        forces = follow(paddle, loop, positions).commanded_force.to_numpy()
        assert min(exact_energy_in(paddle, positions, forces)) >= 0


@pytest.mark.parametrize(("friction", "size"), [("0.12", "0.0000224"), (0, "0.0003"), ("0.7", 0), (0, 0)])
def test_each_line_and_each_bound_is_below_the_exact_one(friction, size):
    """Random states of every size, one sample: E' at most what the lemma says, |f| at most what S pays."""
    paddle = device(friction=friction, resolution=size)
    numbers = ForceBounding().numbers(LoopContext(paddle, zw.Wall(100)))
    p = np.array(numbers)
    rate, fc, size = 150, paddle.exact("coulomb_friction"), paddle.exact("resolution")
    rng = np.random.default_rng(8)
    kept = 0
    for _ in range(3000):
        energy, slope, applied = rng.normal(0, 1, 3) * 10.0 ** rng.integers(-12, 3, 3)
        readings = rng.integers(-(10**6), 10**6) + np.array([0, rng.integers(-3, 4)])
        # a count, rounded as the encoder's reading is; of an ideal encoder a position
        exact = [Fraction(int(n)) * (size or Fraction(1, 10**7)) for n in readings]
        before, here = (
            float(size) * int(n) if size else float(x) for n, x in zip(readings, exact, strict=True)
        )
        s = np.array([before, abs(energy), slope])
        force = force_bounding_step(p, 0, s, 0, here, 1e300, applied)
        e0, g0, f, g = (Fraction(float(v)) for v in (abs(energy), slope, applied, s[2]))
        if s[1] == 0 == s[2]:
            continue  # V ≥ 0 was the better line
        kept += 1
        beyond = max(abs(g - f) - fc, 0)
        line = e0 + g * (exact[1] - exact[0]) - beyond**2 / (4 * rate) - abs(g - g0) * size / 2
        assert Fraction(float(s[1])) <= line
        paid = Fraction(float(force)) - fc
        spare = Fraction(float(s[1])) - abs(g) * size / 2
        assert paid <= 0 or paid**2 <= 4 * rate * spare
    assert kept > 300


def test_a_hand_that_stays_pays_no_hair():
    """200 s at rest: the same force to the last bit."""
    paddle = device(friction="0.12", resolution="0.0000224")
    positions = np.concatenate([np.linspace(-5e-3, 2e-3, 100), np.full(200_000, 2e-3)])
    force = follow(paddle, zw.render(zw.Wall(1500), ForceBounding()), positions).commanded_force.to_numpy()
    assert force[101] > 1
    assert force[-1] == force[101]
