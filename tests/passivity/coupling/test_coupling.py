"""The virtual coupling: its condition from both sides, its proof in time, its design, the two-port view."""

from __future__ import annotations

import random
from fractions import Fraction
from math import ceil, floor, pi, sqrt

import numpy as np
import pytest
from flint import fmpq, fmpq_poly

import zwidth as zw
from zwidth.model.environment.environment import add, multiply
from zwidth.passivity.criterion_choice import decide
from zwidth.passivity.linear.criterion import LinearProof
from zwidth.passivity.witness.motion import Motion

coupling_condition, design_coupling = zw.coupling.coupling_condition, zw.coupling.design_coupling
two_port = zw.coupling.two_port
T = Fraction(1, 1000)
PADDLE = zw.catalogue.device("haptic-paddle")
DELAYS = [Fraction(0), Fraction(3, 10), Fraction(1), Fraction(17, 10), Fraction(4)]
COUPLINGS = [(290, "0"), (290, "0.07"), (290, "0.9"), (0, "0.4"), (290, "-0.06")]


def device(damping, delay=0, **more):
    """A device with an ideal encoder at 1 kHz."""
    return zw.Device(damping=damping, rate=1000, delay=delay * T, **more)


def need_by_definition(k, b, delay, points=200_001):
    """max (1 − Re c)/(2 Re Y_c), from complex numbers on a grid [N·s/m]."""
    theta = np.linspace(1e-4, np.pi, points)
    z = np.exp(1j * theta)
    whole, alpha = int(delay), float(delay) - int(delay)
    c = z ** -(whole + 1) * (1 - alpha + alpha / z)
    mobility = (1 - 1 / z) / (k * 1e-3 + b * (1 - 1 / z))
    return float(np.max((1 - c.real) / (2 * mobility.real)))


def needed(k, b, delay=0):
    return coupling_condition(device(1, delay), k, b).required_damping


@pytest.mark.parametrize("delay", DELAYS)
@pytest.mark.parametrize(("k", "b"), COUPLINGS)
def test_both_sides_of_the_need(k, b, delay):
    """Just above it is proved; just below a passive environment is there, and a motion that gains.

    The need is that of the complex definition; what refutes has Re{E z/(z − 1)} ≥ 0 on the circle, as
    all that the theorem is about.
    """
    need = needed(k, b, delay)
    assert need == pytest.approx(need_by_definition(k, float(b), delay), rel=1e-6)
    over = coupling_condition(device(need * 1.001, delay), k, b)
    assert over.holds
    assert over.verdict.certificate.verify()
    assert over.counterexample is None
    under = coupling_condition(device(need * 0.99, delay), k, b)
    assert not under.holds
    assert under.counterexample.outcome == "active"
    assert under.counterexample.device.damping == under.device.damping
    law = under.counterexample.environment
    if not isinstance(law, zw.Wall):  # which is a rigid environment
        z = np.exp(1j * np.linspace(0.01, 3.13, 500))
        top, bottom = ([float(c) for c in p] for p in law.environment.pulse_transfer_function(T))
        impedance = np.polyval(top, z) / np.polyval(bottom, z) * z / (z - 1)
        assert np.all(impedance.real >= -1e-9 * np.abs(impedance))


@pytest.mark.parametrize(
    ("b", "delay", "wall"), [(0, 2, 5 * 290 * T / 2), (Fraction(-1, 10), 0, 290 * T / 2 + Fraction(1, 10))]
)
def test_a_rigid_wall_may_ask_for_less(b, delay, wall):
    """(2d + 1) K_c T/2 + |B_c|, behind which another passive environment gains."""
    assert zw.check(device(wall, delay), zw.Wall(290, b)).outcome == "passive"
    assert coupling_condition(device(wall, delay), 290, b).counterexample.outcome == "active"


def test_some_damping_below_0_is_too_much():
    """None is enough at B_c = −K_c T/2 and beyond."""
    for hopeless in (-290 * T / 2, -290 * T):
        never = coupling_condition(device(1), 290, hopeless)
        assert never.required_damping is None
        assert never.counterexample.outcome == "active"


def test_nothing_needs_nothing():
    assert coupling_condition(device(0), 0).holds
    refuted = coupling_condition(device(0), 290)
    assert refuted.counterexample.outcome == "active"


def element(r):
    """The impedance of a spring, damper or mass by backward Euler or Tustin's rule, exact."""
    value = Fraction(round(10 ** r.uniform(-3, 4) * 1000), 1000)
    one = Fraction(1)
    return r.choice(
        [
            ((value * T, Fraction(0)), (one, -one)),  # spring, backward
            ((value * T / 2, value * T / 2), (one, -one)),  # spring, Tustin
            ((value / 100,), (one,)),
            ((value / 1000 / T, -value / 1000 / T), (one, Fraction(0))),  # mass, backward
            ((2 * value / 1000 / T, -2 * value / 1000 / T), (one, one)),  # mass, Tustin
        ]
    )


def network(r, depth):
    """Elements side by side (impedances add) and in a row (mobilities add)."""
    if depth == 0:
        return element(r)
    (n1, d1), (n2, d2) = network(r, r.randrange(depth)), network(r, r.randrange(depth))
    total = add(multiply(n1, d2), multiply(n2, d1))
    return (total, multiply(d1, d2)) if r.random() < 0.5 else (multiply(n1, n2), total)


def environment(impedance):
    """E = Z (z − 1)/(T z), in lowest terms."""
    top = multiply(impedance[0], (Fraction(1), Fraction(-1)))
    bottom = multiply(impedance[1], (T, Fraction(0)))
    n, d = (fmpq_poly([fmpq(c.numerator, c.denominator) for c in p[::-1]]) for p in (top, bottom))
    common = n.gcd(d)
    return zw.PulseTransferFunction(
        *([Fraction(int(c.p), int(c.q)) for c in (p // common).coeffs()[::-1]] for p in (n, d))
    )


def test_a_passive_environment_is_never_refuted():
    """300 random networks behind random couplings on devices with just enough damping."""
    r = random.Random(20_240_611)
    proved = 0
    for _ in range(300):
        k = Fraction(round(10 ** r.uniform(0, 3.5)))
        b = r.choice(
            [Fraction(0), k * T * Fraction(r.randint(1, 300), 100), -k * T * Fraction(r.randint(1, 45), 100)]
        )
        delay = r.choice([0, 0, 1, 2, Fraction(r.randint(1, 99), 100), 1 + Fraction(r.randint(1, 99), 100)])
        need = needed(k, b, delay)
        condition = coupling_condition(device(need * (1 + 1e-9), delay), k, b)
        assert condition.holds
        verdict = zw.check(condition.device, condition.before(environment(network(r, 3))))
        assert verdict.outcome != "active", verdict
        assert isinstance(verdict.decision.viscous, LinearProof)
        proved += verdict.outcome == "passive"
    assert proved >= 250  # the others carry cancelled factors on the unit circle


def respond(k, rate, slope, x, last):
    """(f, y): f = k u + rate (u − last), u = x − y, met by a one-sided spring f = slope max(y, 0)."""
    free = ((k + rate) * x - rate * last) / (k + rate)  # where the coupling is at no force
    y = free if free <= 0 else (k + rate) * free / (k + rate + slope)
    return slope * max(y, 0.0), y


@pytest.mark.parametrize("delay", [0, 1, 0.3])
def test_touched_and_left_at_will(delay):
    """A one-sided spring of any stiffness behind the coupling gives out nothing, move by move as worst."""
    rng = np.random.default_rng(5)
    k, b, t = 290.0, 0.08, 1e-3
    damping = needed(k, b, Fraction(str(delay)))
    whole, alpha = int(delay), delay - int(delay)
    least = np.inf
    for slope in (50.0, 2000.0, 1e7):
        for trial in range(60):
            x = last = work = 0.0
            forces = [0.0] * (whole + 2)
            swing = rng.uniform(0.2, 3.1)
            for step in range(200):
                f, y = respond(k, b / t, slope, x, last)
                last = x - y
                forces = [f, *forces[:-1]]
                now, before = forces[whole], forces[whole + 1]
                mean = alpha * before + (1 - alpha) * now
                worst = -mean * t / (2 * damping)
                move = (worst, 1e-3 * np.cos(swing * step), rng.normal() * 1e-3)[trial % 3]
                move = 1e-3 if step == 0 else move
                work += mean * move + damping / t * move**2
                if alpha:
                    work -= t * alpha * (1 - alpha) / (4 * damping) * (before - now) ** 2
                x += move
                least = min(least, work)
    assert least >= -1e-12


def behind(k, top, bottom):
    """Z_c E/(Z_c + E) of a spring before an E that may be improper."""
    coupling = ((k * T, Fraction(0)), (T, Fraction(0)))
    total = add(multiply(coupling[0], bottom), multiply(coupling[1], top))
    return zw.PulseTransferFunction(multiply(coupling[0], top), total)


def test_a_mass_stepped_explicitly_is_not_covered():
    """Passive with each force on the move that follows it, it defeats couplings that the condition admits."""
    b = Fraction(15, 100)
    condition = coupling_condition(device(b), 200, 0)
    assert condition.holds
    for rate in (Fraction(1, 10_000) / T**2, Fraction(1, 100) / T**2):
        for bottom, outcome in (((1, 0), "active"), ((1, 0, 0), "passive")):
            law = behind(Fraction(200), (rate, -2 * rate, rate), tuple(map(Fraction, bottom)))
            assert zw.check(device(b), law).outcome == outcome


def test_an_encoder_defeats_every_friction_with_a_heavy_tool():
    """Within one count nothing is read: the hand moves with the swing of the tool and is paid each time."""
    k, count, friction, mass = Fraction(200), Fraction(1, 1000), Fraction(1, 5), Fraction(1)
    dev = zw.Device(damping="0.3", coulomb_friction=friction, resolution=count, rate=1000)
    assert zw.check(dev, zw.Wall(k)).outcome == "passive"  # twice what a rigid wall needs
    rate = mass / T**2
    law = zw.VirtualCoupling(k, 0, zw.PulseTransferFunction([rate, -2 * rate, rate], [1, 0, 0]))
    setting = decide(dev, law).setting
    witness = setting.witness(swing_with_the_tool(setting.loop, k, count, friction, mass))
    assert witness is not None
    assert witness.energy > 0


def swing_with_the_tool(loop, k, count, friction, mass):
    """Press in, hold within one count, out by a step where the force pushes, in where it pulls, leave."""
    ramp, counts, low = 16, ceil(Fraction(5, 2) * friction / (k * count)), Fraction(1, 1000)
    held = round(8 * 2 * pi * sqrt(mass / k) / T)
    x = [(counts + Fraction(1, 2)) * count * Fraction(i, ramp) for i in range(ramp + 1)]
    read = [floor(v / count) * float(count) for v in x] + [float(counts * count)] * held
    top, bottom = ([float(c) / loop.denominator[0] for c in p] for p in (loop.numerator, loop.denominator))
    force = []
    for n in range(len(read)):
        force.append(
            sum(c * read[n - j] for j, c in enumerate(top) if n >= j)
            - sum(c * force[n - j] for j, c in enumerate(bottom) if n >= j > 0)
        )
    level = float(friction) + 0.35 * (max(force) - float(friction))
    place, step = Fraction(1, 2), (1 - 2 * low) / 12
    for f in force[ramp:-1]:
        if abs(f) > level:
            place = min(max(place - step if f > 0 else place + step, low), 1 - low)
        x.append((counts + place) * count)
    return Motion(tuple(x + [x[-1] * Fraction(ramp - i, ramp) for i in range(1, ramp + 1)]), ())


def test_stiffest_without_delay():
    """K_c = 2 b (1 − margin)/T, exactly at the limit with no margin."""
    exact = design_coupling(PADDLE, margin=0)
    assert (exact.stiffness, exact.damping, exact.margin) == (300, 0, 0)
    assert exact.condition.holds
    assert exact.verdict.outcome == "passive"
    usual = design_coupling(PADDLE)
    assert usual.stiffness.fraction == 270
    assert usual.margin == pytest.approx(0.1)
    assert usual.felt_slowly == usual.felt_quickly == 270


def test_stiffest_with_one_sample_of_delay():
    """K_c = 4b/(3√3 T), B_c = (√3 − 1)/2 K_c T: virtual damping buys stiffness."""
    found = design_coupling(PADDLE.replace(delay=T), margin=0)
    k = 4 * 0.15 / (3 * sqrt(3) * 1e-3)
    assert found.stiffness == pytest.approx(k, rel=1e-9)
    assert found.damping == pytest.approx((sqrt(3) - 1) / 2 * k * 1e-3, rel=1e-5)
    assert found.condition.holds


@pytest.mark.parametrize("delay", [0, Fraction(3, 10), Fraction(5, 2)])
def test_no_coupling_on_a_grid_is_better(delay):
    """Brute force over (K_c, B_c) finds nothing stiffer and nothing nearer."""
    dev = device("0.15", delay)
    stiffest = design_coupling(dev, margin=0)
    wanted = zw.Wall(400, "0.02")
    nearest = design_coupling(dev, wanted, margin=0)
    assert stiffest.condition.holds
    assert nearest.condition.holds

    def distance(k, b):
        return (k - 400 + (b - 0.02) * 1e3) ** 2 + ((b - 0.02) * 1e3) ** 2

    best = distance(nearest.stiffness, nearest.damping)
    for k in np.linspace(1, 330, 40):
        for b in np.linspace(0, 0.15, 31):
            if need_by_definition(k, b, delay, 300) <= 0.15:
                assert k <= stiffest.stiffness * (1 + 1e-2)
                assert distance(k, b) >= best * (1 - 1e-2)


def test_a_wanted_coupling_that_will_do_is_kept():
    for delay in (0, Fraction(1, 2)):
        found = design_coupling(device("0.15", delay), zw.Wall(100, "0.02"))
        assert (found.stiffness.fraction, found.damping.fraction) == (100, Fraction(2, 100))


def test_without_delay_the_stiffness_is_kept_and_the_damping_cut():
    """K_c = K, B_c = b − K T/2; beyond 2b/T the spring is cut too."""
    found = design_coupling(PADDLE, zw.Wall(200, "0.2"), margin=0)
    assert (found.stiffness.fraction, found.damping.fraction) == (200, Fraction(5, 100))
    assert found.felt_quickly == 300
    assert design_coupling(PADDLE, zw.Wall(900, "0.2"), margin=0).stiffness == 300


def test_the_report_says_what_is_felt():
    found = design_coupling(PADDLE)
    assert dict(found.rows())["felt slowly"] == "270 N/m"
    assert "passive before every passive environment" in repr(found.condition)
    assert "270 N/m" in repr(found)
    assert zw.check(PADDLE, found.before(zw.StandardLinearSolid(5000, 9000, 12))).outcome != "active"


@pytest.mark.parametrize("delay", DELAYS)
@pytest.mark.parametrize(("k", "b"), COUPLINGS[:4])
def test_with_the_exact_hold_it_is_the_exact_condition(k, b, delay):
    """Llewellyn's conditions with z⁻¹ for the hold decide as the sampled loop does, on both sides."""
    need = needed(k, b, delay)
    assert two_port.impedance_display(device(need * 1.001, delay), k, b, hold="exact").unconditionally_stable
    under = two_port.impedance_display(device(need * 0.99, delay), k, b, hold="exact")
    assert not under.unconditionally_stable
    assert float(under.needed_damping.max()) == pytest.approx(need, rel=1e-4)


@pytest.mark.parametrize(("k", "b"), [(290, 0), (290, "0.03"), (290, "0.4"), (0, "0.4")])
def test_llewellyn_asks_for_a_quarter_to_an_eighth(k, b):
    """The closed form is the maximum over frequency; K_c T/8 for a spring, B_c/8 for a damper."""
    need = two_port.llewellyn_damping(k, b, T)
    grid = two_port.impedance_display(device(1), k, b).needed_damping
    assert float(grid.max()) == pytest.approx(need, rel=1e-5)
    exact = needed(k, b)
    assert 4 * (1 - 1e-9) <= exact / need <= 8 * (1 + 1e-9)
    if not float(b):
        assert exact / need == pytest.approx(4)
    if not k:
        assert exact / need == pytest.approx(8)


def test_where_llewellyn_is_content_a_motion_takes_energy_out():
    """1000 N/m on the paddle: unconditionally stable in the model, active in the sampled loop."""
    assert two_port.impedance_display(PADDLE, 1000).unconditionally_stable
    verdict = coupling_condition(PADDLE, 1000).counterexample
    assert verdict.outcome == "active"
    assert verdict.witness.energy > 0


def test_the_coupling_before_nothing_and_the_mass_play_no_part():
    """Re Z_d = b, whatever the mass."""
    light, heavy = (two_port.impedance_display(device("0.15", mass=m), 290, "0.1") for m in ("0.001", "10"))
    assert np.allclose(light.surplus, heavy.surplus)
    assert np.allclose(light.re_p11, 0.15)


def test_admittance_display_by_its_definition():
    """The conditions from the matrix of the inner loop at one frequency, solved as equations."""
    dev = zw.Device(mass="0.4", damping="0.6", rate=1000)
    data = two_port.admittance_display(dev, 800, 30, 12, 150, frequencies=[37.0])
    z = np.exp(2j * np.pi * 0.037)
    impedance = 0.4 * 2000 * (z - 1) / (z + 1) + 0.6
    command = (1 + 1 / z) / 2 * (12 + 150e-3 * z / (z - 1))
    matrix = np.array([[impedance + command]])
    by_hand, by_tool = np.linalg.solve(matrix, [1])[0], np.linalg.solve(matrix, [command])[0]
    tool = 30 + 0.8 * z / (z - 1)
    surplus = 2 * by_hand.real * tool.real - abs(by_tool) + by_tool.real
    assert float(data.surplus[0]) == pytest.approx(surplus, rel=1e-12)
    assert float(data.needed_impedance[0]) == pytest.approx(
        (abs(by_tool) - by_tool.real) / (2 * by_hand.real)
    )


def test_admittance_wants_a_heavy_coupling():
    """C_p (2 m/T)/b at half the rate for a controller C_p ≪ 2 m/T: an average has no force there."""
    dev = zw.Device(mass="0.4", damping="0.6", rate=1000)
    need = float(two_port.admittance_display(dev, 0, 1, 12).needed_impedance.max())
    assert need == pytest.approx(12 * 2 * 0.4 / (1e-3 * 0.6), rel=0.02)
    assert two_port.admittance_display(dev, 0, need * 1.001, 12).unconditionally_stable
    assert not two_port.admittance_display(dev, 0, need * 0.99, 12).unconditionally_stable


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: coupling_condition(3, 100), "first argument is a Device"),
        (lambda: coupling_condition(PADDLE, -1), "stiffness must be ≥ 0"),
        (lambda: coupling_condition(PADDLE.replace(damping=(1, 2)), 1), "no single value"),
        (lambda: design_coupling(3), "first argument is a Device"),
        (lambda: design_coupling(PADDLE, margin=1), "margin must be"),
        (lambda: design_coupling(PADDLE.replace(damping=0)), "without damping"),
        (lambda: design_coupling(PADDLE, "softest"), "goal is"),
        (lambda: design_coupling(PADDLE, zw.Wall(3, -1)), "must be ≥ 0"),
        (lambda: design_coupling(PADDLE, zw.Wall(3, 1, clamped=True)), "goal is"),
        (lambda: two_port.impedance_display(PADDLE, 0, 0), "both 0"),
        (lambda: two_port.impedance_display(PADDLE, 3, -1), "damping must be ≥ 0"),
        (lambda: two_port.impedance_display(PADDLE, 3, hold="zero"), "hold is"),
        (lambda: two_port.impedance_display(PADDLE, 3, frequencies=[501]), "half the rate"),
        (lambda: two_port.admittance_display(device(1), 3, 1, 1), "mass is not known"),
        (lambda: two_port.admittance_display(PADDLE.replace(delay=T), 3, 1, 1), "without delay"),
        (lambda: two_port.admittance_display(PADDLE, 3, 1, -1), "velocity_gain must be ≥ 0"),
    ],
)
def test_bad_input_has_one_clear_message(call, message):
    with pytest.raises(zw.InputError, match=message):
        call()
