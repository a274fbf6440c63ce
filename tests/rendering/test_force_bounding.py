"""Force bounding by a plain loop, against hands that tempt it; in doubles, never a digit too high."""

from fractions import Fraction

import numpy as np
import pytest
from prescribed import device, energy_in, follow, tempt, wall

import zwidth as zw
from zwidth.model.rendering import ForceBounding, PassiveLeap
from zwidth.model.rendering.bounding import force_bounding_step
from zwidth.model.rendering.rendering_law import LoopContext

DEVICES = [(0, 0), ("0.12", "0.0000224"), ("0.02", "0.0000224"), (0, "0.00005"), ("0.05", 0)]


def bounded(wish, device, counted=True, resets=False):
    """The law in other words: of all slopes g' at which the least energy may change its shape, the best."""
    keys = ("damping", "coulomb_friction", "resolution")
    b, fc, size = (float(device.exact(key)) for key in keys)
    fc, size = (fc, size) if counted else (0.0, 0.0)
    rate, last = b / 1e-3, {"q": None, "E": 0.0, "g": 0.0, "f": 0.0}

    def law(q):
        energy, g, f = last["E"], last["g"], last["f"]
        moved = 0.0 if last["q"] is None else q - last["q"]
        if resets and f == 0:
            energy = g = 0.0
        if moved == 0:
            slopes = [f - fc, f + fc, *([g] if abs(g - f) <= fc else [])]
        else:
            kinks = [f + np.sign(moved) * fc + 2 * rate * (moved + part * size / 2) for part in (-1, 1)]
            slopes = [g, *kinks]
        left = [
            (energy + n * moved - max(abs(n - f) - fc, 0) ** 2 / (4 * rate) - abs(n - g) * size / 2, n)
            for n in slopes
        ]
        energy, g = max(left)
        if energy < abs(g) * size / 2:
            energy = g = 0.0
        room = fc + 2 * np.sqrt(rate * (energy - abs(g) * size / 2))
        last.update(q=q, E=energy, g=g, f=min(max(wish(q), -room), room))
        return last["f"]

    return law


@pytest.mark.parametrize("resets", [False, True])
@pytest.mark.parametrize(("friction", "size"), DEVICES)
@pytest.mark.parametrize("stiffness", [290, 5000])
def test_no_hand_takes_energy_out_and_every_force_is_that_of_a_plain_loop(stiffness, friction, size, resets):
    """The energy is never below 0, with counts and friction, for hands that know the law."""
    paddle = device(friction=friction, resolution=size)
    loop = zw.render(zw.Wall(stiffness), ForceBounding(resets=resets))
    for seed in range(6):
        positions, forces = tempt(bounded(wall(stiffness), paddle, resets=resets), paddle, 500, seed)
        trace = follow(paddle, loop, positions)
        # where next to nothing is left, the hair that pays for rounding is seen through a square root
        assert trace.commanded_force.to_numpy() == pytest.approx(forces, rel=1e-9, abs=1e-7)
        assert energy_in(trace).min() >= -1e-13 * energy_in(trace).max()


def test_the_bound_is_reached():
    paddle = device()
    rest = np.linspace(-1e-3, 4e-4, 9)
    law = bounded(wall(1e5), paddle)
    force = [law(x) for x in rest][-1]
    trace = follow(
        paddle, zw.render(zw.Wall(100_000), ForceBounding()), [*rest, rest[-1] - force * 1e-3 / 0.3]
    )
    energy = energy_in(trace)
    assert energy[-2] > 1e-6
    assert abs(energy[-1]) < 1e-12 * energy[-2]


@pytest.mark.parametrize("law", [ForceBounding(), PassiveLeap()])
def test_a_wall_that_the_device_can_pay_is_not_changed(law):
    """K ≤ 2b/T, an encoder without counts, from outside: the wall's own force."""
    positions = np.concatenate([[-1e-3], np.random.default_rng(5).normal(0, 1e-3, 800)])
    behind = follow(device(), zw.render(zw.Wall(300), law), positions).commanded_force.to_numpy()
    assert behind == pytest.approx(300 * np.maximum(positions, 0), rel=1e-9)


def jittering(samples, size):
    """To and fro over an edge outside, then one count in and the best leap out."""
    edge = -size
    jitter = edge + 1e-6 * size * np.where(np.arange(samples) % 2, 1, -1)
    force = 2 * 150 * size * np.sqrt(samples)
    return np.array([*jitter, 2.5 * size, 2.5 * size - force / 300])


def by_encoder(paddle, stiffness, positions, **options):
    """What comes in [J] by the public law, and with counts in the law."""
    laws = (ForceBounding(encoder=word, **options) for word in ("ideal", "counted"))
    return (energy_in(follow(paddle, zw.render(zw.Wall(stiffness), law), positions)) for law in laws)


@pytest.mark.parametrize("samples", [100, 400, 1600])
def test_counts_break_the_public_law_as_much_as_the_hand_likes(samples):
    """(b/T) Δ² per sample of jitter, nearly all of it; with counts in the law, nothing."""
    size = 5e-5
    paddle = device(friction="0.0001", resolution="0.00005")
    positions = jittering(samples, size)
    public, counted = by_encoder(paddle, 100_000, positions)
    assert public[-1] < -0.9 * samples * 150 * size**2
    assert counted.min() >= 0


@pytest.mark.parametrize("resets", [False, True])
def test_nor_do_resets_help_against_counts(resets):
    """Up within a count at the lower force, out of it at the higher, as energy bounding is broken."""
    paddle = device(friction="0.0001", resolution="0.00005")
    cycle = [*np.linspace(1, 2 - 1e-6, 40), 2 + 1e-6]
    positions = 5e-5 * np.array([*np.linspace(-1, 1, 60), *(cycle * 400), 1])
    public, counted = by_encoder(paddle, 5000, positions, resets=resets)
    assert public[-1] < -1e-4
    assert counted.min() >= 0


def test_converter_steps_are_kept_below_the_bound():
    paddle = device(force_resolution="0.05")
    loop = zw.render(zw.Wall(5000), ForceBounding())
    for seed in range(20):
        positions, _ = tempt(bounded(wall(5000), paddle), paddle, 400, seed)
        energy = energy_in(follow(paddle, loop, positions, points_per_sample=3))
        assert energy.min() >= -1e-13 * energy.max()


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
    assert (force[101:] == force[101]).all()
