"""Passivity indices: closed forms, dense grids, the checker and motions replayed by scipy."""

from __future__ import annotations

from fractions import Fraction
from math import inf, isclose, pi, sqrt

import control
import mpmath
import numpy as np
import pytest
import scipy.signal
from hypothesis import given, settings
from hypothesis import strategies as st
from matrix_systems import LAG, NOTHING, diagonal, in_state_space, matrix, over, random_system

import zwidth as zw
from zwidth.cli.main import main

indices = zw.ports.passivity_indices
s, UNIT = control.tf("s"), np.eye(2)


MISPLACED = {  # a pole that may not be where it is
    "residue not symmetric": over([1, 0], [[[1], [3]], [[-3], [1]]]),
    "residue not positive": over([1, 0], [[[1], [3]], [[3], [1]]]),
    "residue complex and not positive": over([1, 0, 1], [[[1, 0], [1.01]], [[-1.01], [1, 0]]]),
    "double integrator of one axis": diagonal(([1], [1, 0, 0]), LAG),
    "grows with the square of the frequency": diagonal(([1, 0, 0], [1]), LAG),
    "a pole on the axis across": matrix([[([3], [1, 2]), NOTHING], [([1], [1, 0, 1]), ([1, 0], [1, 1])]]),
    "unstable across": matrix([[LAG, ([1], [1, -2])], [NOTHING, LAG]]),
}
ZOO = {  # system, ν, frequency of ν [Hz], ρ, frequency of ρ [Hz]; … is asked elsewhere
    "lag": (3 / (s + 7), 0, inf, Fraction(7, 3), None),
    "integrator": (1 / s, 0, None, 0, None),
    "lead": ((s + 2) / (s + 9), Fraction(2, 9), 0, 1, inf),
    "phase lag": ((s + 9) / (s + 2), 1, inf, Fraction(2, 9), 0),
    "mass, spring and damper": (s / (0.3 * s**2 + 0.7 * s + 150), 0, 0, Fraction(7, 10), None),
    "mass": (0.25 * s, 0, None, 0, None),
    "resonator near the axis": (s / (s**2 + 1e-9 * s + 1e6), 0, 0, Fraction(1, 10**9), None),
    "lossless resonator": (5 * s / (s**2 + 1e6), 0, None, 0, None),
    "all-pass": ((1 - 0.05 * s) / (1 + 0.05 * s), -1, inf, -inf, None),
    "unstable": (2 / (s - 3), -inf, None, Fraction(-3, 2), None),
    "negative integrator": (-1 / s, -inf, None, -inf, None),
    "double integrator": (1 / s**2, -inf, None, -inf, None),
    "negative double integrator": (-1 / s**2, -inf, None, -inf, None),
    "static gain": (control.tf([0.4], [1]), Fraction(2, 5), None, Fraction(5, 2), None),
    "negative static gain": (control.tf([-2], [1]), -2, None, Fraction(-1, 2), None),
    "nothing": (control.tf([0], [1]), 0, None, inf, None),
    "one sample late": (control.tf([1], [1, 0], 0.02), -1, 25, -inf, None),
    "trapezoidal integrator": (control.tf([1, 1], [1, -1], 0.02), 0, None, 0, None),
    "backward integrator": (control.tf([0.02, 0], [1, -1], 0.02), Fraction(1, 100), None, 0, 0),
    "mean of two": (control.tf([1, 1], [2, 0], 0.5), 0, 1, 1, None),
    # Re G = (a + (2 − a) x)/(1 + x)² with x = ω², a = 3; its slope vanishes at x = (3a − 2)/(a − 2) = 7
    "interior minimum": ((s + 3) / (s + 1) ** 2, Fraction(3 - 7, 64), sqrt(7) / (2 * pi), -1, inf),
    # where a tolerance decides elsewhere: a small shortage, an improper system, badly scaled ones
    "1/(s + 1) − 1e-9": (1 / (s + 1) - 1e-9, Fraction(-1, 10**9), ..., -inf, ...),
    "improper": (s + 1, 1, ..., 0, ...),
    "fast": (
        control.ss(np.diag([-3e12, -2e12]), [[0], [1]], [[-1, 2]], [[0]]), 0, ..., Fraction(10**12), ...
    ),
    "fast lag": (2 / (s + 2e6), 0, ..., Fraction(10**6), ...),
    # of several axes
    "gyrator": (over([1], [[[0], [1]], [[-1], [0]]]), 0, None, 0, None),
    "rotating mass": (over([1, 0, 1], [[[1, 0], [1]], [[-1], [1, 0]]]), 0, None, 0, None),
    "masses and dampers": (over([1], [[[2, 5], [0.5, 2]], [[0.5, 2], [1, 2]]]), 1, None, 0, inf),
    "coupled integrators": (over([1, 0], [[[3], [1]], [[1], [2]]]), 0, None, 0, None),
    "one lag felt by both": (matrix([[LAG, LAG], [LAG, LAG]]), 0, None, Fraction(1, 2), None),
    "an axis without output": (diagonal(LAG, NOTHING), 0, None, 1, None),
    "a lag across": (matrix([[LAG, LAG], [NOTHING, LAG]]), Fraction(-1, 16), sqrt(15) / (2 * pi), -inf, None),
    "one sample late across": (
        matrix([[([2], [1]), ([1], [1, 0])], [NOTHING, ([2], [1])]], 0.02), Fraction(3, 2), None, ..., ...
    ),
    "unstable axis": (diagonal(([1], [1, -1]), ([1], [1, 2])), -inf, None, -1, None),
    "nothing of two axes": (diagonal(NOTHING, NOTHING), 0, None, inf, None),
    "coupled leads": (
        over([1, 2], [[[1, 3], [1]], [[0], [1, 3]]]), Fraction(31, 32), ..., ..., ...
    ),
    "an input without effect": (matrix([[LAG, NOTHING], [LAG, NOTHING]]), ..., ..., -inf, ...),
    "cancelled": (control.tf([1, -1], [1, 0, -1]), 0, inf, 1, None),
    **{name: (g, -inf, ..., ..., ...) for name, g in MISPLACED.items()},
}  # fmt: skip


def as_double(value):
    """The double that is typed for it, or the nearest one below."""
    double = float(value)
    if abs(double) < inf and Fraction(repr(double)) > value:
        return float(np.nextafter(double, -inf))
    return double


@pytest.mark.parametrize("name", ZOO)
def test_closed_forms_from_both_sides(name):
    """The checker accepts the proof at the index and a motion just above it; nothing proves more."""
    g, nu, nu_at, rho, rho_at = ZOO[name]
    found = indices(g)
    for index, value, at in ((found.input, nu, nu_at), (found.output, rho, rho_at)):
        if value is ...:
            continue
        assert index.value == as_double(value)
        if at is not ...:
            assert index.frequency == (at if at is None else pytest.approx(at, rel=1e-15))
        if abs(value) < inf:
            assert index.exact == value
            assert index.certificate().verify()
            assert index.certificate(value).verify()
            assert index.refute(value) is None
            assert not index.at_least(value + Fraction(1, 10**9))
            above = value + (1 + abs(value)) * Fraction(1, 10**6)
            assert not index.at_least(above)
            assert index.refute(above).verify()
            with pytest.raises(zw.InputError, match="cannot be certified"):
                index.certificate(above)
        elif value < 0:
            assert index.exact is None
            assert index.reason
            assert not index.at_least(-(10**6))
            assert index.refute().verify()
            with pytest.raises(zw.InputError, match="nothing to certify"):
                index.certificate()
    assert found.passive == (found.input.value >= 0)
    assert (found.certificate if found.passive else found.witness).verify()


def test_an_input_without_effect_has_no_output_index():
    """The second input moves nothing and its output is moved by the first."""
    output = indices(ZOO["an input without effect"][0]).output
    assert "input without effect" in output.reason
    assert output.refute(-100).verify()


def test_a_third_order_interior_minimum():
    """An index that is not rational lies between its bounds, which mpmath's own minimum confirms."""
    found = indices(control.tf([1, 1, 5, 0.1], [1, 2, 3, 4])).output
    low, high = found.bounds
    with mpmath.workdps(60):

        def real_part(omega):
            z = mpmath.mpc(0, omega)
            return mpmath.re((z**3 + 2 * z**2 + 3 * z + 4) / (z**3 + z**2 + 5 * z + mpmath.mpf(1) / 10))

        omega = mpmath.findroot(lambda w: mpmath.diff(real_part, w), 1.59)
        least = real_part(omega)
        assert mpmath.mpf(low.numerator) / low.denominator <= least
        assert abs(mpmath.mpf(high.numerator) / high.denominator - least) < 1e-40
    assert high - low < Fraction(1, 10**20)
    assert found.exact is None
    assert isclose(found.frequency, float(omega) / (2 * pi), rel_tol=1e-12)


systems = st.integers(0, 2**32 - 1)


def random_passive(seed):
    """A sum of damped resonators and a lag with positive weights, and a throughput."""
    rng = np.random.default_rng(seed)
    w, zeta, gain = 10 ** rng.uniform(-1, 1, 2), rng.uniform(0.05, 0.9, 2), rng.uniform(0.1, 2, 2)
    parts = [g * s / (s**2 + 2 * z * v * s + v**2) for g, z, v in zip(gain, zeta, w, strict=True)]
    return sum(parts, rng.uniform(0.1, 1) / (s + rng.uniform(0.2, 5)) + rng.uniform(0.05, 0.5))


@settings(max_examples=25, deadline=None)
@given(systems)
def test_a_dense_grid_never_falls_below(seed):
    g = random_passive(seed)
    found = indices(g)
    omega = np.concatenate([[0], np.geomspace(1e-4, 1e5, 20001)])
    response = np.polyval(g.num[0][0], 1j * omega) / np.polyval(g.den[0][0], 1j * omega)
    for index, values in ((found.input, response.real), (found.output, (1 / response).real)):
        assert values.min() >= index.value - 1e-9 * np.abs(values).max()
        assert values.min() <= index.value + 1e-4 * abs(index.value) + 1e-9
        assert index.certificate().verify()


@pytest.mark.parametrize(
    ("g", "kind"),
    [
        ((s + 3) / (s + 1) ** 2, "burst"),
        (1 / (1 - 0.5 * s), "polynomial"),
        ((s - 4) * (s + 5) / ((s - 2) * (s + 9)) + 3, "polynomial"),
        (1 / (s - 1) + 2, "polynomial"),
        (random_system(0, 4, 2, throughput=0), "burst"),
        (random_system(3, 5, 3, throughput=0), "burst"),
        (matrix([[([3, -0.5], [1, -0.5]), LAG], [NOTHING, ([3, 4], [1, 1])]]), "polynomial"),
    ],
)
def test_a_motion_replayed_by_scipy(g, kind):
    motion = indices(g).witness
    assert motion.kind == kind
    t, u, y = (np.array(x) for x in motion.signals(40001))
    u, y, system = np.atleast_2d(u).T, np.atleast_2d(y).T, in_state_space(g)
    _, replayed, _ = scipy.signal.lsim((system.A, system.B, system.C, system.D), u, t)
    replayed = replayed.reshape(y.shape)
    assert np.abs(replayed - y).max() < 1e-4 * np.abs(y).max()
    share = -np.trapezoid((u * replayed).sum(axis=1), t) / np.trapezoid((u * u).sum(axis=1), t)
    assert isclose(share, motion.share, rel_tol=1e-3)
    assert share > 0


@pytest.mark.parametrize(
    "g",
    [
        control.tf([1], [1, 0], 0.01),
        control.tf([1, -0.9], [1, -0.2], 0.01) - 1.6,
        control.tf([-1, 0], [1, -1.2], 0.01),
        control.tf([1, 1], [-1, 1], 0.01),
        *(random_system(seed, 3, 2, throughput=-0.1, discrete=True) for seed in (2, 5, 8)),
    ],
)
def test_a_discrete_motion_replayed_by_scipy(g):
    motion, system = indices(g).witness, in_state_space(g)
    u, y = (np.atleast_2d(x).T for x in motion.signals()[1:])
    _, replayed, _ = scipy.signal.dlsim((system.A, system.B, system.C, system.D, 0.01), u)
    assert np.allclose(replayed, y, rtol=1e-9, atol=1e-9)
    assert isclose(-np.sum(u * replayed) / np.sum(np.square(u)), motion.share, rel_tol=1e-9)
    assert motion.share > 0


def test_slow_growth_is_caught_by_a_longer_polynomial():
    """A pole pair at 0.07 ± 1.06j, with a real part on the axis that is above the level."""
    index = indices(control.tf([-4, 4], [4, 3, 4, 4])).input
    assert "unstable pole at s = 0.0697809 ± 1.05796j" in index.reason
    motion = index.refute(-3)
    assert motion.kind == "polynomial"
    assert motion.verify()


def test_what_grows_slowly_has_no_motion_but_no_proof_either():
    """A pole 1e-4 outside the circle with Re G > 0 on it: not passive, and not certified either way."""
    found = indices(control.tf([-1, -1], [1, -1.0001], 0.01) + 20001)
    assert found.outcome == "undecided"
    assert "ν < 0 was found" in found.claim
    assert not found.passive
    assert found.certificate is None
    assert found.witness is None
    assert "unstable pole at z = 1.0001" in found.input.reason


quarters = st.integers(1, 9).map(lambda k: k / 4)


@settings(max_examples=30, deadline=None)
@given(
    st.lists(quarters, min_size=3, max_size=3),
    st.lists(quarters, min_size=3, max_size=3),
    st.integers(-16, 16),
)
def test_a_throughput_moves_the_input_index_and_no_more(num, den, eighths):
    """ν(G + c) = ν(G) + c; the coefficients are short binary fractions, so that nothing is rounded."""
    c = eighths / 8
    moved = [a + c * b for a, b in zip(num, den, strict=True)]
    first, second = (indices(control.tf(n, den)).input.bounds for n in (num, moved))
    assert first[0] + Fraction(c) <= second[1]
    assert second[0] <= first[1] + Fraction(c)


def test_the_output_index_is_that_of_the_inverse():
    """ρ(G) = ν(1/G), also where G is unstable."""
    for num, den in (([1, 4, 1], [2, 1, 9]), ([3, 1], [1, -2]), ([1], [1, 1, 1])):
        g, inverse = control.tf(num, den), control.tf(den, num)
        assert indices(g).output.bounds == indices(inverse).input.bounds


ONE_AXIS = [[0, 1], [-2, -3]], [[0], [1]], [[3, 1]], [[0]]
TWO_AXES = [[-1, 0], [0, -2]], np.eye(2), [[1, 0.5], [0, 1]], [[0, 0], [0, 1]]


@pytest.mark.parametrize(
    ("states", "others"),
    [
        (ONE_AXIS, [kind([1, 3], [1, 3, 2]) for kind in (control.tf, scipy.signal.TransferFunction)]),
        (ONE_AXIS, [scipy.signal.ZerosPolesGain([-3], [-1, -2], 1)]),
        (TWO_AXES, [matrix([[LAG, ([0.5], [1, 2])], [NOTHING, ([1, 3], [1, 2])]])]),
    ],
)
def test_every_kind_of_system_is_read(states, others):
    """Transfer functions, state spaces and zeros–poles–gain models of both libraries are one system."""
    found = [indices(g) for g in (control.ss(*states), scipy.signal.StateSpace(*states), *others)]
    assert len({f.input.bounds for f in found}) == 1
    assert len({f.output.bounds for f in found}) == 1


def test_sampled_damping_is_that_of_the_criterion():
    """H(z) = K + B (z − 1)/(T z) needs K T/2 + B; its own indices call it passive."""
    wall = control.tf([150 + 200, -200], [1, 0], 0.001)
    found = indices(wall)
    assert found.passive
    assert found.sampled_damping.required == float(zw.formulas.kelvin_voigt_damping(150, "0.2", "0.001"))
    assert isclose(found.sampled_damping.frequency, 500)
    device = zw.Device(damping="0.3", sample_period="0.001", delay="0.001")
    late = indices(wall, device)
    assert late.sampled_damping.required == zw.check(device, wall).required_damping
    assert late.sampled_damping.margin == 1 - late.sampled_damping.required / 0.3


@pytest.mark.parametrize("delay", [0, 1, 3])
def test_sampled_damping_is_an_input_index(delay):
    """Minus the input index of T z⁻ᵈ H/(z − 1): another polynomial, the same number."""
    num, den = [90, -60, 5], [1, -0.5, 0.25, 0]
    device = zw.Device(damping=0, sample_period="0.002", delay=Fraction(delay, 500))
    law = control.tf(num, den, 0.002)
    index = indices(control.tf([0.002 * c for c in num], np.polymul(den, [1, -1] + [0] * delay), 0.002)).input
    need = indices(law, device).sampled_damping
    assert isclose(need.required, -index.value, rel_tol=1e-12)
    assert isclose(need.frequency, index.frequency, rel_tol=1e-9, abs_tol=1e-9)


def test_sampled_damping_of_a_continuous_law():
    device = zw.Device(damping="0.3", rate=1000)
    solid = scipy.signal.TransferFunction([0.2, 150], [1])
    found = indices(solid, device, "backward")
    assert isclose(found.sampled_damping.required, 0.275, rel_tol=1e-12)
    wall = indices(zw.Wall(150, "0.2"), device)
    assert wall.sampled_damping.required == found.sampled_damping.required
    assert indices(solid).sampled_damping is None


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((control.tf([1, 0, 0], [1, 2], 0.1),), "more zeros than poles"),
        ((control.ss(-np.eye(2), np.eye(2), [[1, 1]], [[0, 0]]),), "2 inputs and 1 output;"),
        ((control.tf([1], [1, 1], None),), "dt=None"),
        ((control.ss(-UNIT, UNIT, UNIT, 0 * UNIT, None),), "dt=None"),
        ((matrix([[([1, 0, 0], [1, 2]), NOTHING], [NOTHING, LAG]], 0.1),), "more zeros than poles"),
        ((control.ss(-UNIT, UNIT, UNIT, UNIT * np.nan),), "finite"),
        ((control.ss(-np.eye(61), np.ones((61, 2)), np.ones((2, 61)), np.eye(2)),), "order 61"),
        ((control.ss([], [], [], np.eye(7)),), "7 inputs"),
        ((diagonal(([1], [1] + [0] * 60 + [1]), LAG),), "at most 60"),
        ((control.ss(-UNIT, UNIT, UNIT, UNIT), zw.Device(damping=1, rate=1000)), "as H"),
        ((3.0,), "a port is a system"),
        ((zw.Wall(100),), "give the device"),
        ((control.tf([1], [1, 1]), None, "tustin"), "needs the device"),
        ((control.tf([1], [1, 1]), zw.Device(damping=1, rate=1000)), "needs a discretization"),
        ((scipy.signal.TransferFunction([1] + [0] * 130, [1, 2] + [0] * 128 + [1]),), "order 130"),
    ],
)
def test_what_is_refused(arguments, message):
    with pytest.raises(zw.InputError, match=message):
        indices(*arguments)


def test_evidence_is_saved_and_verified_from_the_command_line(tmp_path, capsys):
    one, two = indices(ZOO["interior minimum"][0]), indices(ZOO["coupled leads"][0]).input
    for evidence, says in (
        (one.input.certificate(), "input index is at least -0.0625"),
        (one.witness, "input index is less than 0"),
        (two.certificate(), "Of the port below, proved: the input index is at least"),
        (two.refute(5), "is less than 5"),
    ):
        evidence.save(tmp_path / "evidence.json")
        assert main(["verify", str(tmp_path / "evidence.json")]) in (0, None)
        assert says in " ".join(capsys.readouterr().out.split())


def test_it_says_what_it_found():
    found = indices(1 / (s + 1) - 1e-9)
    assert repr(found).startswith("<PassivityIndices active: input index ν = −1e−09 as the frequency grows")
    assert "unstable zero at s = 1e+09" in found._repr_html_()
    assert "comes out above the level" in repr(found.witness)
    assert "burst" in found.witness._repr_html_()
    assert repr(found.input).startswith("<PassivityIndex input ν")
    assert found.input.describe() in found.input._repr_html_()


def test_what_is_given_is_told_what_to_do_with_it():
    device, s = zw.Device(damping=0.3, rate=1000), control.tf("s")
    for call, said in (
        (lambda: zw.check(1 / (0.1 * s**2 + 0.3 * s), zw.Wall(stiffness=100)), "Device(mass=m, damping=b"),
        (lambda: zw.check(device, 100 + 0.1 * s), "ContinuousTransferFunction(system, discretization=…)"),
        (lambda: zw.check(device, 100 + 0.1 * s, discretization="tustin"), "belongs to the law"),
        (lambda: indices(control.frd([1 + 1j, 2], [1, 2])), "response_table"),
    ):
        with pytest.raises(zw.InputError) as caught:
            call()
        assert said in str(caught.value)
    system = scipy.signal.TransferFunction([1 + 0j, 2], [1, 1])
    assert indices(system).input.exact == 1


@pytest.mark.parametrize("size", [1, 2])
def test_a_discrete_system_that_does_not_say_its_period(size):
    system = control.ss(0.5 * np.eye(size), np.eye(size), np.eye(size), 2 * np.eye(size), True)
    alone = indices(system)
    assert alone.input.frequency == 0.5
    assert "samples of 1 s" in alone.assumptions[0]
    assert "samples of 1 s" in zw.ports.scattering_passivity(system).assumptions[1]
    found = indices(system, zw.Device(damping=1, rate=1000))
    assert found.input.frequency == pytest.approx(500)
    assert found.assumptions == ()
    assert indices(control.ss(*control.ssdata(system), 0.001)).assumptions == ()
