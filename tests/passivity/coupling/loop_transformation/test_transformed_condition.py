"""Device, coupling and class of environments: where the theorem is exact, where it is not, what binds."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

import zwidth as zw
from zwidth.errors import InputError

T = Fraction(1, 1000)
COUPLINGS = [(290, "0"), (290, "0.07"), (290, "0.3"), (290, "-0.06"), (0, "0.4")]


def device(damping, delay=0, **more):
    """A device at 1 kHz."""
    return zw.Device(damping=damping, rate=1000, delay=delay * T, **more)


@pytest.mark.parametrize("delay", [0, 1, 2, 30])
@pytest.mark.parametrize(("k", "b"), COUPLINGS)
def test_passive_environments_are_those_of_the_coupling_condition(k, b, delay):
    """Without excess or shortage the transformation asks for what `coupling_condition` proves necessary."""
    found = zw.coupling.transformed_condition(device(1, delay), zw.coupling.PassivityExcess(), k, b)
    known = zw.coupling.coupling_condition(device(1, delay), k, b)
    assert found.required_damping == pytest.approx(known.required_damping, rel=1e-9)
    assert found.holds == known.holds


@pytest.mark.parametrize("delay", [0, 1, 2])
@pytest.mark.parametrize(("k", "b"), COUPLINGS)
def test_a_class_asks_for_no_less_than_its_springs(k, b, delay):
    """`check` of springs of the class behind the coupling asks for less or as much, by 3 % at most."""
    found = zw.coupling.transformed_condition(
        device(1, delay), zw.coupling.SlopeBounds(0, 1000, bounded_below=True), k, b
    ).required_damping
    springs = (zw.VirtualCoupling(k, b, zw.PulseTransferFunction([s], [1])) for s in (1, 30, 170, 400, 1000))
    needs = [zw.check(device(1, delay), spring).required_damping for spring in springs]
    assert max(needs) <= found * (1 + 1e-9)
    assert found <= 1.03 * max(needs)


@pytest.mark.parametrize("delay", [0, 1, 3])
@pytest.mark.parametrize(("least", "greatest"), [(0, 800), (-90, 450), (120, 300)])
def test_a_spring_before_springs_is_a_spring(least, greatest, delay):
    """B_c = 0: the form of coupling and class, and the class of springs in series by its closed form."""
    slopes = zw.coupling.SlopeBounds(least, greatest, bounded_below=True)
    series = (Fraction(290 * s, 290 + s) for s in (least, greatest))
    found = zw.coupling.transformed_condition(device(1, delay), slopes, 290)
    bare = zw.coupling.required_damping_by_slopes(*series, T, delay * T)
    assert found.required_damping == pytest.approx(float(bare), rel=1e-6)


def test_both_sides_of_the_need_are_decided_exactly():
    """A thousand-millionth above it holds, below it does not; for a bare spring the need itself holds."""
    for given in (
        (zw.coupling.SlopeBounds(-100, 1000, bounded_below=True), 290, "0.07"),
        (zw.coupling.PassivityExcess("-0.02", 0), 290, "0.07"),
    ):
        need = zw.coupling.transformed_condition(device(1, 1), *given).required_damping
        assert zw.coupling.transformed_condition(device(need * (1 + 1e-9), 1), *given).holds
        assert not zw.coupling.transformed_condition(device(need * (1 - 1e-9), 1), *given).holds
    assert zw.coupling.transformed_condition(
        device("0.75", 1), zw.coupling.SlopeBounds(0, 500, bounded_below=True)
    ).holds
    assert not zw.coupling.transformed_condition(
        device("0.7499999999999999", 1), zw.coupling.SlopeBounds(0, 500, bounded_below=True)
    ).holds


def test_what_binds():
    """Too little damping, or coupling and environment that no damping helps: a name and a margin for each."""
    short = zw.coupling.transformed_condition(
        device("0.1"), zw.coupling.SlopeBounds(0, 500, bounded_below=True)
    )
    assert (short.holds, short.binding) == (False, "device damping")
    assert short.margin == pytest.approx(-1.5)
    lacking = zw.coupling.transformed_condition(
        device(100), zw.coupling.PassivityExcess(0, "-0.05"), 290, "0.07"
    )
    assert (lacking.holds, lacking.binding) == (False, "coupling and environment")
    assert lacking.margin is None
    assert (
        zw.coupling.transformed_condition(device(1), zw.coupling.PassivityExcess()).binding
        == "coupling and environment"
    )
    assert "none is enough" in repr(lacking)
    assert "0.25 N·s/m" in repr(short)


def test_shortage_costs_and_excess_saves_under_delay():
    """ι = −0.02, 0, 0.05 N·s/m ask for less and less; without delay a small shortage is free."""
    needs = [
        zw.coupling.transformed_condition(
            device(1, 1), zw.coupling.PassivityExcess(i, 0), 290
        ).required_damping
        for i in ("-0.02", 0, "0.05")
    ]
    assert needs == sorted(needs, reverse=True)
    assert needs[0] > needs[2] * 1.05
    free = zw.coupling.transformed_condition(
        device(1), zw.coupling.PassivityExcess("-0.02", 0), 290
    ).required_damping
    assert free == pytest.approx(0.145)


@pytest.mark.parametrize(("delay", "index"), [(0, "0.031"), (1, "0.02"), (2, "-0.011")])
def test_a_parallel_damper_is_an_input_index(delay, index):
    """ι bounds a wall B in parallel with a passive spring: linear members ask for no more."""
    found = zw.coupling.transformed_condition(
        device(1, delay), zw.coupling.PassivityExcess(index, 0), 290, "0.07"
    ).required_damping
    worst = 0.0
    for k in (10, 150, 900):
        member = zw.Wall(k, Fraction(index))
        verdict = zw.check(device(5, delay), zw.VirtualCoupling(290, "0.07", member))
        worst = max(worst, verdict.required_damping or 0.0)
    assert 0 < worst <= found * (1 + 1e-9)


@pytest.mark.parametrize("delay", [0, 1, 4])
def test_bare_dampers_by_their_gains(delay):
    """Gains g to G: the need is G, whatever the delay; random ones gain nothing, at half of it one does."""
    found = zw.coupling.transformed_condition(
        device("0.12", delay),
        zw.coupling.PassivityExcess("-0.04125", "12.5"),  # gG/(g + G), 1/(g + G)
    )
    assert found.required_damping == pytest.approx(0.11)
    assert found.holds
    random = np.random.default_rng(delay)

    def put_in(gains, v, damping):
        f = np.concatenate([np.zeros(delay + 1), gains * v])[: len(v)]
        return float(np.sum(f * v + damping * v**2))

    for _ in range(400):
        v = random.choice([-1.0, 1.0], 30) * random.choice([1.0, 0.2], 30)
        assert put_in(random.choice([-0.03, 0.11], 30), v, 0.11) >= 0
    turning = (-1.0) ** (np.arange(30) // (delay + 1))
    assert put_in(np.full(30, 0.11), turning, 0.055) < 0


def test_excess_and_shortage_together():
    """ο b² − b + ι ≥ 0 is where a bare environment with both holds."""
    indices = zw.coupling.PassivityExcess("0.02", 3)
    need = zw.coupling.transformed_condition(device(1), indices).required_damping
    assert 3 * need**2 - need + 0.02 == pytest.approx(0, abs=1e-12)
    assert zw.coupling.transformed_condition(device(need * 1.001), indices).holds
    assert not zw.coupling.transformed_condition(device(need * 0.999), indices).holds


def spring_of_pieces(random, slopes):
    """Force and potential on a fine grid of −3 … 3."""
    kinks = np.sort(random.uniform(-3, 3, 12))
    forces = np.concatenate([[0.0], np.cumsum(np.diff(kinks) * random.choice(slopes, 11))])
    grid = np.linspace(-3, 3, 6001)
    force = np.interp(grid, kinks, forces) - np.interp(0.0, kinks, forces)
    area = np.concatenate([[0.0], np.cumsum(np.diff(grid) * (force[1:] + force[:-1]) / 2)])
    return grid, force, area - np.interp(0.0, grid, area)


def test_random_springs_behind_a_coupling_gain_nothing():
    """Static springs of pieces, the coupling solved implicitly, a sample late: at the need no motion gains.

    At a quarter of it some do.
    """
    k, b_c, slopes = 1.0, 0.4, (-0.3, 2.0)
    unit = zw.Device(damping=1, sample_period=1, delay=1)
    need = zw.coupling.transformed_condition(
        unit, zw.coupling.SlopeBounds(*slopes, bounded_below=True), k, b_c
    ).required_damping
    random = np.random.default_rng(8)
    over, under = [], []
    for _ in range(80):
        grid, force, area = spring_of_pieces(random, slopes)
        step = random.choice([0.05, 0.4])
        x = np.clip(np.cumsum(random.choice([-step, step], 25)), -2, 2)
        y, f, w = 0.0, [0.0, 0.0], 0.0
        for here in x:
            balance = force - k * (here - grid) - b_c * (here - grid - w)  # increasing, for k + b_c > 0.3
            y = float(np.interp(0.0, balance, grid))
            w = here - y
            f.append(float(np.interp(y, grid, force)))
        moves = np.diff(x, prepend=0.0)
        stored = float(np.interp(y, grid, area)) + k * w**2 / 2
        work, heat = float(np.sum(np.array(f[: len(x)]) * moves)), float(np.sum(moves**2))
        over.append(work + need * heat - stored)
        under.append(work + need / 4 * heat - stored)
    assert min(over) >= -1e-5
    assert min(under) < -1e-2


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: zw.coupling.transformed_condition(1, zw.coupling.PassivityExcess()), "Device"),
        (lambda: zw.coupling.transformed_condition(device(1), zw.Wall(1, 0)), "use check"),
        (
            lambda: zw.coupling.transformed_condition(device(1), zw.coupling.PassivityExcess(), -1),
            "stiffness",
        ),
        (
            lambda: zw.coupling.transformed_condition(device(1), zw.coupling.PassivityExcess(), 0, 0),
            "passes no force",
        ),
        (
            lambda: zw.coupling.transformed_condition(device(1), zw.coupling.PassivityExcess(), None, 1),
            "coupling",
        ),
        (
            lambda: zw.coupling.transformed_condition(
                device(1, Fraction(1, 2)), zw.coupling.PassivityExcess(), 1
            ),
            "whole number",
        ),
        (lambda: zw.coupling.SlopeBounds(2, 1), "least slope"),
        (lambda: zw.coupling.PassivityExcess(1, 1), "4 · input · output"),
    ],
)
def test_what_does_not_fit_is_refused(call, words):
    """Each with a message that names it."""
    with pytest.raises(InputError, match=words):
        call()
