"""H(s), H(z) and systems of python-control, scipy.signal and harold 1.0.2 (made here without it)."""

import pickle
from fractions import Fraction
from types import SimpleNamespace

import control
import numpy as np
import pytest
import scipy.signal
from hypothesis import given, settings
from hypothesis import strategies as st

import zwidth as zw
from zwidth.model.environment import as_environment

T = Fraction(1, 1000)
NUM, DEN = [0.0, 310.0, -250.0], [0.7, -0.5, 0.01]


def frequency_response(transfer, z):
    """H(z) in floats."""
    top, bottom = ([float(c) for c in p] for p in transfer)
    return np.polyval(top, z) / np.polyval(bottom, z)


def test_coefficients_are_kept_exactly_without_leading_zeros():
    """0.7 is 7/10; nothing is normalised or cancelled."""
    law = zw.PulseTransferFunction(NUM, DEN)
    num, den = law.pulse_transfer_function(T)
    assert num == (310, -250)
    assert den == (Fraction(7, 10), Fraction(-1, 2), Fraction(1, 100))
    assert not law.unilateral
    assert not law.spring


SYSTEMS = [
    control.tf([310.0, -250.0], [0.7, -0.5, 0.01], 1e-3),
    control.ss([[0.5, 0.1], [0.3, 0.2]], [[1.0], [2.0]], [[3.0, 4.0]], [[7.0]], 1e-3),
    scipy.signal.dlti([310.0, -250.0], [0.7, -0.5, 0.01], dt=1e-3),
    scipy.signal.dlti([[0.5, 0.1], [0.3, 0.2]], [[1.0], [2.0]], [[3.0, 4.0]], [[7.0]], dt=1e-3),
    scipy.signal.dlti([0.5, 0.25], [0.3 + 0.2j, 0.3 - 0.2j, -0.4], 3.0, dt=1e-3),
]


@pytest.mark.parametrize("system", SYSTEMS, ids=lambda s: type(s).__name__)
def test_discrete_systems_keep_their_frequency_response_and_period(system):
    law = as_environment(system)
    z = np.exp(1j * np.array([0.2, 1.1, 3.0]))
    if isinstance(system, control.lti.LTI):
        theirs = system(z)
    else:
        _, theirs = scipy.signal.dfreqresp(system, w=np.angle(z))
    assert isinstance(law, zw.PulseTransferFunction)
    assert law.sample_period == 1e-3
    assert frequency_response(law.pulse_transfer_function(T), z) == pytest.approx(theirs, rel=1e-10)


@settings(max_examples=25, deadline=None)
@given(st.integers(1, 5), st.integers(0, 2**32 - 1))
def test_state_space_is_exact(order, seed):
    """D + C (zI − A)⁻¹ B at a rational z, solved here over the rationals."""
    draw = np.random.default_rng(seed)
    a, b, c = (draw.integers(-90, 90, s) / 64 for s in ((order, order), (order, 1), (1, order)))
    law = zw.PulseTransferFunction(control.ss(a, b, c, 2.5, True))
    z = Fraction(1001, 7)
    rows = [
        [z * (i == j) - Fraction(float(a[i, j])) for j in range(order)] + [Fraction(float(b[i, 0]))]
        for i in range(order)
    ]
    x = solve(rows)
    expected = Fraction(5, 2) + sum(Fraction(float(c[0, i])) * x[i] for i in range(order))
    num, den = (
        sum(k * z ** (len(p) - 1 - i) for i, k in enumerate(p)) for p in law.pulse_transfer_function(T)
    )
    assert num / den == expected


def solve(rows):
    """Gauss–Jordan elimination on an augmented matrix of rationals."""
    size = len(rows)
    for i in range(size):
        pivot = next(r for r in range(i, size) if rows[r][i])
        rows[i], rows[pivot] = rows[pivot], rows[i]
        rows[i] = [v / rows[i][i] for v in rows[i]]
        for r in range(size):
            if r != i:
                rows[r] = [v - rows[r][i] * w for v, w in zip(rows[r], rows[i], strict=True)]
    return [row[-1] for row in rows]


CONTINUOUS = [
    control.tf([2.5, 900.0, 4.4e5], [1.0, 260.0, 3.1e5]),
    control.ss(control.tf([900.0, 4.4e5], [1.0, 260.0, 3.1e5])),
    scipy.signal.lti([2.5, 900.0, 4.4e5], [1.0, 260.0, 3.1e5]),
    scipy.signal.lti([2.5, 900.0, 4.4e5], [1.0, 260.0, 3.1e5]).to_ss(),
    scipy.signal.lti([-80.0, -900.0], [-130 + 500j, -130 - 500j], 640.0),
]


@pytest.mark.parametrize("system", CONTINUOUS, ids=lambda s: type(s).__name__)
@pytest.mark.parametrize("method", ["tustin", "zoh"])
def test_continuous_systems_agree_with_their_own_discretization(system, method):
    """sample_system of python-control and to_discrete of scipy.signal give the same H(z)."""
    law = as_environment(system, method)
    z = np.exp(1j * np.array([0.2, 1.1, 3.0]))
    if isinstance(system, control.lti.LTI):
        theirs = control.sample_system(system, 1e-3, method)(z)
    else:
        discrete = system.to_ss().to_discrete(1e-3, {"tustin": "bilinear"}.get(method, method))
        _, theirs = scipy.signal.dfreqresp(discrete, w=np.angle(z))
    assert isinstance(law, zw.ContinuousTransferFunction)
    assert law.coefficients_rounded == (method == "zoh")
    assert frequency_response(law.pulse_transfer_function(T), z) == pytest.approx(theirs, rel=1e-9)


def test_a_kelvin_voigt_wall_is_one_by_backward_difference():
    """H(s) = K + B s by backward Euler is zw.Wall(K, B)."""
    law = zw.ContinuousTransferFunction([1.5, 290], [1], "backward").pulse_transfer_function(T)
    wall = zw.Wall(290, 1.5).pulse_transfer_function(T)
    assert law == wall


@pytest.mark.parametrize(
    "law", [zw.PulseTransferFunction(NUM, DEN, 1e-3), zw.ContinuousTransferFunction(NUM, DEN, "tustin")]
)
def test_scaling_is_exact(law):
    factor = Fraction(3, 7)
    scaled = law.scaled(factor)
    assert type(scaled) is type(law)
    assert [c.fraction for c in scaled.numerator] == [c.fraction * factor for c in law.numerator]
    assert scaled.replace(numerator=law.numerator) == law
    assert pickle.loads(pickle.dumps(scaled)) == scaled


def test_a_sample_period_that_disagrees_is_refused():
    """The same period to 1e-9 passes, more does not; unsaid passes always."""
    law = zw.PulseTransferFunction(control.tf([1.0], [1.0, 0.2], 1e-3))
    law.pulse_transfer_function(T * (1 + Fraction(1, 2 * 10**9)))
    with pytest.raises(zw.InputError, match=r"made for the sample period 1 ms"):
        law.pulse_transfer_function(T * (1 + Fraction(2, 10**9)))
    zw.PulseTransferFunction(control.tf([1.0], [1.0, 0.2], True)).pulse_transfer_function(T * 3)


def test_numbers_are_read_in_one_line():
    law = zw.PulseTransferFunction([1, 0, -0.5], [1, 0.2, -1, 0.03], 1e-3)
    assert law.describe() == "H(z) = (z² − 0.5)/(z³ + 0.2 z² − 1 z + 0.03), T = 1 ms"
    assert eval(repr(law), vars(zw)) == law
    spring = zw.ContinuousTransferFunction([300], [1], "zoh")
    assert spring.describe() == "H(s) = 300, discretization zoh"
    assert not spring.coefficients_rounded
    assert "[order 9]" in zw.PulseTransferFunction([1], [1] * 10).describe()


def test_environments_pass_through_and_constants_need_no_time():
    wall = zw.Wall(300)
    assert as_environment(wall) is wall
    for gain in (control.tf([5], [1]), control.ss([], [], [], [[5.0]]), scipy.signal.lti([5], [1])):
        assert as_environment(gain).pulse_transfer_function(T) == ((5,), (1,))


def test_wide_coefficients_are_brought_into_range():
    """A fast system of order 12 has coefficients up to 1e48: H is unchanged, to the last digit."""
    poles = np.arange(1.0, 13.0) * -1e4
    law = zw.ContinuousTransferFunction(scipy.signal.lti([], poles, 1e49), discretization="tustin")
    got = Fraction(law.numerator[-1].fraction) / law.denominator[-1].fraction
    assert got == Fraction(10) ** 49 / Fraction(10) ** 48 / 479001600
    with pytest.raises(zw.InputError, match="decades apart"):
        as_environment(scipy.signal.lti([], poles * 1e4, 1.0), "tustin")


MIMO = control.ss(np.eye(2) * 0.5, np.eye(2), np.eye(2), np.zeros((2, 2)), 1e-3)
TWO_LAGS = control.tf([[[1], [0]], [[0], [1]]], [[[1, -0.5], [1]], [[1], [1, -0.5]]], 1e-3)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: zw.PulseTransferFunction([1, 2, 3], [1, 2]), "more zeros"),
        (lambda: zw.PulseTransferFunction([1], [0, 0]), "denominator of a transfer function is zero"),
        (lambda: zw.PulseTransferFunction([1], []), "denominator of a transfer function is zero"),
        (lambda: zw.PulseTransferFunction([], [1]), "no coefficient"),
        (lambda: zw.PulseTransferFunction([1]), "needs a numerator and a denominator"),
        (lambda: zw.PulseTransferFunction(3, [1]), "list of coefficients"),
        (lambda: zw.PulseTransferFunction("12", [1]), "list of coefficients"),
        (lambda: zw.PulseTransferFunction([[1]], [1]), r"numerator\[0\]: expected a number"),
        (lambda: zw.PulseTransferFunction([1], [1, float("nan")]), r"denominator\[1\]: expected a finite"),
        (lambda: zw.PulseTransferFunction([1], [1] * 202), "order 201; at most 200"),
        (lambda: zw.PulseTransferFunction([1], [1], 0), "sample_period must be > 0"),
        (lambda: zw.PulseTransferFunction(control.tf([1], [1, 2])), "system is continuous"),
        (lambda: zw.PulseTransferFunction(SYSTEMS[0], [1]), "got both"),
        (lambda: zw.PulseTransferFunction(SYSTEMS[0], sample_period=1e-3), "its own sample period"),
        (lambda: zw.PulseTransferFunction(MIMO), "several inputs or outputs"),
        (lambda: zw.PulseTransferFunction(TWO_LAGS), "several inputs or outputs"),
        (lambda: zw.PulseTransferFunction(scipy.signal.dlti([[1.0, 2], [3, 4]], [1, 2, 3])), "several"),
        (lambda: zw.PulseTransferFunction(scipy.signal.dlti([], [0.5j], 1.0)), "conjugate pairs"),
        (lambda: zw.PulseTransferFunction(control.frd([1, 2], [1, 2])), "FrequencyResponseData is not read"),
        (lambda: zw.ContinuousTransferFunction([1], [1, 2]), 'one of "backward"'),
        (lambda: zw.ContinuousTransferFunction([1], [1, 2], "euler"), 'one of "backward"'),
        (lambda: zw.ContinuousTransferFunction(SYSTEMS[0], discretization="zoh"), "discrete already"),
        (lambda: as_environment(CONTINUOUS[0]), "needs a discretization"),
        (lambda: as_environment(SYSTEMS[0], "zoh"), "nothing to act on"),
        (lambda: as_environment(zw.Wall(3), "zoh"), "nothing to act on"),
        (lambda: as_environment(control.tf([1], [1, 2], None)), "dt=None"),
        (lambda: as_environment(300), r"a spring is Wall\(stiffness"),
        (lambda: as_environment(([1], [1, 2])), r"coefficients are PulseTransferFunction\("),
        (lambda: as_environment(None), "an environment is"),
    ],
)
def test_bad_input_has_one_clear_message(make, message):
    with pytest.raises(zw.InputError, match=message):
        make()


def transfer(num, den, period=None):
    """A Transfer: of one axis a row in a matrix, of several a list of rows of such."""
    if np.ndim(num) == 1:
        return SimpleNamespace(num=np.array([num]), den=np.array([den]), shape=(1, 1), SamplingPeriod=period)
    rows = [[[np.array([p]) for p in row] for row in side] for side in (num, den)]
    return SimpleNamespace(num=rows[0], den=rows[1], shape=(len(num), len(num[0])), SamplingPeriod=period)


def state(a, b, c, d, period=None):
    """A State: its matrices in small letters."""
    a, b, c, d = map(np.array, (a, b, c, d))
    return SimpleNamespace(a=a, b=b, c=c, d=d, shape=d.shape, SamplingPeriod=period)


A, B, C, D = [[0.0, 1.0], [-1.0, -2.0]], [[0.0], [1.0]], [[3.0, 1.0]], [[0.0]]


@pytest.mark.parametrize("system", [transfer([1.0, 3], [1.0, 2, 1]), state(A, B, C, D)])
def test_one_axis_in_continuous_time(system):
    """(s + 3)/(s + 1)²: as python-control's."""
    found = zw.ports.passivity_indices(system)
    theirs = zw.ports.passivity_indices(control.tf([1, 3], [1, 2, 1]))
    assert found.input.exact == theirs.input.exact
    assert found.sampled_damping is None


def test_a_gain_without_states():
    """Matrices of size 0 beside D."""
    gain = state(*[np.zeros((0, 0))] * 3, [[5.0]])
    assert zw.ports.passivity_indices(gain).input.value == 5


def test_several_axes():
    """(1 3; −3 1)/(s + 1), one denominator for each entry."""
    found = zw.ports.passivity_indices(transfer([[[1.0], [3.0]], [[-3.0], [1.0]]], [[[1.0, 1.0]] * 2] * 2))
    theirs = zw.ports.passivity_indices(control.tf([[[1], [3]], [[-3], [1]]], [[[1, 1]] * 2] * 2))
    assert found.input.value == theirs.input.value


def test_a_sampled_law_is_an_environment_with_its_period():
    """350 − 200/z at 1 kHz, from position to force: what it needs and the verdict of check."""
    law = transfer([350.0, -200.0], [1.0, 0.0], 0.001)
    assert as_environment(law).sample_period == 1e-3
    assert zw.ports.passivity_indices(law).sampled_damping.required == 0.275
    assert zw.check(zw.Device(damping=0.3, rate=1000), law).passive
    assert zw.check(zw.Device(damping=0.27, rate=1000), law).outcome == "active"
