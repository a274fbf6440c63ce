"""What the loop holds where a touch starts, what the ledger adds up, and when energy came out."""

from __future__ import annotations

import numpy as np
import pytest

import zwidth as zw
from zwidth.loop.energy import ledger
from zwidth.model.rendering import PassivityController
from zwidth.quantity.text import shown

PADDLE = zw.catalogue.device("haptic-paddle")
SPRING = zw.PulseTransferFunction(["100", 0], [1, 0])


def passive_loop(random, kind):
    """A device and a law that are proved passive, with little to spare; forces late or not."""
    period, delay = 1e-3, int(random.choice([0, 0, 1, 3]))
    count = float(random.choice([0.0, 1e-5, 1e-4]))
    k = float(10 ** random.uniform(1, 3.3))
    slack = 1 + float(random.choice([1e-9, 0.05]))
    need, steepest = (delay + 0.5) * k * period, k
    if kind == "detents":
        pitch = float(random.uniform(0.002, 0.02))
        law = zw.NonlinearSpring.detents(int(random.integers(1, 6)), pitch, k * pitch / 4)
    elif kind == "solid":
        pole, part = float(random.uniform(0, 0.99)), float(random.uniform(0, 3))
        law = zw.PulseTransferFunction([k * (1 + part), -k * (pole + part)], [1, -pole])
        need, steepest = None, k * (1 + part) * (1 + (pole + part) / (1 - pole))
    else:
        law = zw.Wall(k) if kind == "wall" else zw.PulseTransferFunction([k], [1])
    device = zw.Device(
        mass=float(10 ** random.uniform(-2, 0)),
        damping=0 if need is None else need * slack,
        coulomb_friction=steepest * count / 2 * slack if count else float(random.choice([0, 0.05])),
        resolution=count,
        sample_period=period,
        delay=delay * period,
    )
    if need is None:
        need = zw.check(device.replace(damping=100, coulomb_friction=0, resolution=0), law).required_damping
        device = device.replace(damping=max(need, 0.0) * slack + 1e-6)
    return device, law


def any_hand(random, device, start):
    """A hand that pushes, one that is pulled out, or one that goes anywhere, slowly or fast."""
    n = 150
    kind = random.integers(4)
    if kind == 0:
        return zw.operators.ConstantForce(float(random.normal(0, 3))), start
    if kind == 1:
        far = start + float(random.choice([-1, 1])) * random.uniform(0, 2 * abs(start) + 1e-3)
        path = np.linspace(start, far, n + 1)
        return zw.operators.Tracking(path, stiffness=500.0, damping=2.0, mass=0.01), start
    if kind == 2:  # to where nothing is stored, and on the spot
        slow = start * np.linspace(1, 0, n + 1)
        return zw.operators.PrescribedMotion(slow), None
    steps = random.normal(0, 10 ** random.uniform(-6, -2.5), n)
    return zw.operators.PrescribedMotion(start + np.concatenate([[0.0], np.cumsum(steps)])), None


def touch(random, kind, start=None):
    """A touch of a random hand that begins anywhere."""
    device, law = passive_loop(random, kind)
    begin = float(random.choice([-1, 1])) * 10 ** random.uniform(-5, -1.5) if start is None else start
    hand, initial = any_hand(random, device, begin)
    ideal = zw.amplifiers.Ideal()
    phase = float(random.choice([0.0, random.uniform(0, 1)]))
    return zw.simulate(
        device, law, hand, 0.15, initial_position=initial, encoder_phase=phase, amplifier=ideal
    )


@pytest.mark.parametrize("kind", ["spring", "wall", "detents", "solid"])
def test_no_touch_of_a_passive_loop_is_active_wherever_it_starts(kind):
    random = np.random.default_rng(6)
    out = 0
    for _ in range(60):
        book = touch(random, kind).zwidth.energy
        assert not book.unknown
        assert not book.active, (kind, book.extracted, book.held_at_start)
        out += book.got_out > 1e-9 * book.moved
    assert out > 10


@pytest.mark.parametrize("start", [-0.02, 0.013])
@pytest.mark.parametrize("count", [0, "2.24e-5"])
def test_nearly_all_that_is_stored_can_be_got_out(start, count):
    """Drawn slowly to where it rests, a spring gives 97 % of what it holds, less the friction on the way."""
    device = zw.Device(mass=0.05, damping=0.1, coulomb_friction=0.01, resolution=count, sample_period="0.001")
    path = start * np.linspace(1, 0, 1001)
    trace = zw.simulate(device, zw.PulseTransferFunction([200], [1]), zw.operators.PrescribedMotion(path), 1)
    held = trace.zwidth.energy.held_at_start
    friction = float(trace.viscous_loss[-1] + trace.coulomb_loss[-1])
    assert held == pytest.approx(100 * start**2, rel=3e-3)
    assert 0.97 * held < trace.zwidth.energy.got_out + friction
    assert trace.zwidth.energy.got_out <= held


@pytest.mark.parametrize("start", [-0.02, 0.0, 0.013])
@pytest.mark.parametrize("damping", [0.49, 0.51])
def test_what_exceeds_it_is_active(start, damping):
    """K = 1000 at 1 kHz needs b = 0.5: below it a motion to and fro gains beyond any store, above it not."""
    device = zw.Device(mass=1e-4, damping=damping, sample_period="0.001")
    path = start + np.append(0.01 * (np.arange(1001) % 2), 0.0)
    law = zw.PulseTransferFunction([1000], [1])
    book = zw.simulate(device, law, zw.operators.PrescribedMotion(path), 1.001).zwidth.energy
    assert book.active == (damping < 0.5)
    assert book.held_at_start == pytest.approx(500 * start**2)


def test_the_touch_starts_where_the_law_is_at_rest():
    """At x = 0, at the nearest detent, where a spring's force is 0; outside a wall as ever."""
    finger = zw.operators.Finger()
    detents = zw.NonlinearSpring.detents(3, "0.01", 2)
    beside = zw.NonlinearSpring(["-0.015", "-0.005"], [-1, 1])
    expected = ((SPRING, 0.0), (detents, 0.0), (beside, -0.01), (zw.Wall(300), -0.02))
    for law, place in expected:
        trace = zw.simulate(PADDLE.replace(damping=1), law, finger, 0.1)
        assert float(trace.position[0]) == pytest.approx(place, abs=1e-15)
        assert f"start {shown(float(trace.position[0]), 'm', 6)}" in trace.attrs["operator"]
        assert float(trace.anchor_position[0]) == float(trace.position[0])
        assert trace.attrs["stored_at_start_J"] < 1e-6


def test_a_start_that_is_given_is_kept():
    for hand, start in ((zw.operators.Finger(start=-0.015), None), (zw.operators.Finger(), -0.015)):
        trace = zw.simulate(PADDLE, SPRING, hand, 0.3, initial_position=start)
        half = 2.24e-5 / 2
        assert trace.attrs["stored_at_start_J"] == pytest.approx(50 * (0.015 + half) ** 2, rel=1e-12)
        assert not trace.zwidth.energy.active
        assert trace.zwidth.energy.got_out > 0.005


def test_late_forces_let_the_hand_go_further_in_for_nothing():
    """The first force comes after d samples: what the hand gains by going on meanwhile is in the bound."""
    device = zw.Device(mass=0.05, damping="1.75", sample_period="0.001", delay="0.003")
    law = zw.PulseTransferFunction([500], [1])
    path = np.concatenate([np.linspace(0.01, 0.012, 4), np.linspace(0.012, 0, 300)])
    trace = zw.simulate(device, law, zw.operators.PrescribedMotion(path), (len(path) - 1) * 1e-3)
    assert trace.attrs["stored_at_start_J"] == pytest.approx(250 * 0.01**2 + 500 * 0.01 * 0.002)
    assert not trace.zwidth.energy.active


def test_a_law_that_does_not_settle_holds_what_a_leap_there_costs():
    """A pole at 1: the memory is empty at x_0, as after a leap from 0 in one sample, b x²/T + f_c |x|."""
    device = zw.Device(mass=0.05, damping="0.5", coulomb_friction="0.1", sample_period="0.001")
    law = zw.PulseTransferFunction([100, -90], [1, -1])
    hand = zw.operators.ConstantForce(0.0)
    trace = zw.simulate(device, law, hand, 0.1, initial_position=-0.01)
    assert trace.attrs["stored_at_start_J"] == pytest.approx(0.5 / 1e-3 * 1e-4 + 0.1 * 0.01)
    assert float(zw.simulate(device, law, zw.operators.Finger(), 0.1).position[0]) == 0.0


def test_where_no_bound_is_known_nothing_is_said_to_be_active():
    """Laws in a chain in a loaded spring, a spring that leads away for ever, an amplifier that lags."""
    hand, push = zw.operators.ConstantForce(-1.0), {"initial_position": -0.01}
    cases = (
        (zw.render(SPRING, PassivityController()), push, "laws in a chain"),
        (zw.NonlinearSpring([0, 1], [0, -3]), {}, "pushes away for ever"),
        (SPRING, {**push, "amplifier": zw.amplifiers.FirstOrderLag(0.001)}, "amplifier has not yet"),
    )
    for law, options, why in cases:
        trace = zw.simulate(PADDLE, law, hand, 0.1, **options)
        book = trace.zwidth.energy
        assert why in book.unknown
        assert not book.active
        assert np.isnan(book.extracted)
        assert book.to_dict()["energy_extracted_J"] is None
        assert "stored_at_start_J" not in trace.attrs
    assert "not known" in repr(zw.traces.compare_traces({"row": trace}))
    assert zw.traces.compare_traces({"row": trace}).to_dict()["row"]["energy_extracted_J"] is None


def test_laws_in_a_row_at_rest_hold_nothing():
    """From rest outside, or at x = 0 of a law on both sides, all that comes out is a gain."""
    row = zw.render(zw.Wall(300), PassivityController())
    assert zw.simulate(PADDLE, row, zw.operators.Finger(), 0.1).attrs["stored_at_start_J"] == 0.0
    row = zw.render(SPRING, PassivityController())
    held = zw.simulate(PADDLE, row, zw.operators.Finger(), 0.1).attrs["stored_at_start_J"]
    assert held == pytest.approx(50 * (2.24e-5 / 2) ** 2)


@pytest.mark.parametrize("law", [zw.HuntCrossley(20000, dissipation=2), zw.StandardLinearSolid(300, 200, 2)])
def test_contacts_with_memory_that_are_left(law):
    """Begun 8 mm inside and drawn out slowly they give less than their potential at rest, and most of it."""
    device = zw.Device(mass=0.05, damping="0.4", coulomb_friction="0.05", resolution="1e-5", rate=1000)
    path = np.linspace(0.008, -0.001, 2001)
    book = zw.simulate(device, law, zw.operators.PrescribedMotion(path), 2).zwidth.energy
    u = 0.008 - 5e-6
    at_rest = 20000 * u**2.5 / 2.5 if isinstance(law, zw.HuntCrossley) else 300 * u**2 / 2
    assert at_rest <= book.held_at_start <= at_rest + 0.009 * 0.08
    assert 0.5 * at_rest < book.got_out < book.held_at_start
    assert not book.active


def test_words_and_files_carry_the_bound(tmp_path, capsys):
    from zwidth.cli.main import main

    words = "simulate haptic-paddle --type pulse-transfer-function --numerator 100,0 --denominator 1,0"
    run = [*words.split(), "--operator", "finger", "--duration", "0.5", "--initial-position", "-20 mm"]
    assert main([*run, "-o", str(tmp_path / "t.csv")]) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "17.1 mJ came out, 20.02 mJ were stored at the start: nothing was gained" in said
    assert "ACTIVE" not in said
    kept = zw.traces.load_trace(tmp_path / "t.csv")
    assert kept.attrs["stored_at_start_J"] == pytest.approx(0.0200224, rel=1e-5)
    assert main([*run[:-2]]) == 0
    assert "got no energy out" in " ".join(capsys.readouterr().out.split())


def _touch(stiffness: float, hand=None, **options):
    return zw.simulate(PADDLE, zw.Wall(stiffness), hand or zw.operators.Dowel(), 0.6, **options)


def test_both_balances_close_to_rounding():
    trace = _touch(600.0, zw.operators.Finger())
    book = trace.zwidth.energy
    assert book.closes
    assert np.abs(book.residual).max() < 1e-15
    tampered = trace.copy()
    tampered["viscous_loss"] = trace.viscous_loss * 1.001
    assert not ledger(tampered).closes


def test_what_the_device_held_at_first_does_not_count_as_extracted():
    """A hand that only stops a moving device gets its kinetic energy, and no more."""
    free = zw.Device(mass=0.5, damping=0.0, rate=1000)
    hand = zw.operators.ConstantForce(-1.0)
    trace = zw.simulate(free, zw.Wall(0.0), hand, 0.25, initial_velocity=0.5)
    book = trace.zwidth.energy
    assert -trace.hand_work.values.min() == pytest.approx(0.5 * 0.5 * 0.25, rel=1e-9)
    assert book.extracted == pytest.approx(0.0, abs=1e-12)


def test_totals_in_words_numbers_and_html():
    book = _touch(500.0).zwidth.energy
    assert "the hand put into the device" in repr(book)
    assert book._repr_html_().startswith("<table>")
    assert book.to_dict()["hand_work_J"] == book.totals["hand_work"]
    plain = _touch(500.0, zw.operators.ConstantForce(1.0)).zwidth.energy
    assert "damper" not in repr(plain)


def test_a_dataset_without_energies_is_refused():
    with pytest.raises(zw.InputError, match="lacks viscous_loss"):
        ledger(_touch(100.0).drop_vars("viscous_loss"))
