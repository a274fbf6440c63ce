"""Forces and positions given sample by sample."""

from __future__ import annotations

import copy
import pickle
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import zwidth as zw
from zwidth.errors import InputError
from zwidth.model.operator import PrescribedMotion, RecordedForce, Tracking, WitnessMotion

TIMES = np.arange(5) * 0.001


def tracking(positions: Any) -> Tracking:
    """A hand that follows the positions."""
    return Tracking(positions, stiffness=300, damping=2)


RECORDERS = pytest.mark.parametrize("make", [RecordedForce, PrescribedMotion, tracking])


@RECORDERS
def test_takes_any_row_of_numbers(make):
    expected = make([0.5, 0.25, 1.0])
    for values in [(0.5, 0.25, 1), np.array([0.5, 0.25, 1], dtype=np.float32), [Fraction(1, 2), 0.25, 1]]:
        assert make(values) == expected
        assert hash(make(values)) == hash(expected)
    assert make([0.5, 0.25, 1.001]) != expected
    assert make([0.5, 0.25]) != expected


@RECORDERS
def test_a_record_is_its_own(make):
    values = np.array([1.0, 2.0, 3.0, 4.0])
    hand = make(values)
    times = TIMES if make is RecordedForce else TIMES[:4]
    before = copy.deepcopy(hand)
    values[0] = 99
    for signal in hand.signals(times):
        if signal is not None:
            signal[0] = 77
    assert hand == before
    assert pickle.loads(pickle.dumps(hand)) == hand
    with pytest.raises(ValueError, match="read-only"):
        (hand.newtons if make is RecordedForce else hand.positions)[0] = 5


@RECORDERS
def test_a_record_shows_its_length_only(make):
    assert "<100000 values>" in repr(make(np.zeros(100_000)))
    assert len(make(np.zeros(100_000)).describe()) < 200


@RECORDERS
@pytest.mark.parametrize(
    ("bad", "message"),
    [
        ([1.0, float("nan"), 2.0], "got nan at index 1"),
        ([1.0, 2.0, -float("inf")], "got -inf at index 2"),
        ([[1.0, 2.0], [3.0, 4.0]], r"2 dimensions, shape \(2, 2\)"),
        (3.0, "0 dimensions"),
        ([], "got none"),
        (["a", "b"], "one number per sample"),
        ([1, [2, 3]], "one number per sample"),
        (None, "must be finite|one number per sample|0 dimensions"),
        ([10**400], "one number per sample"),
    ],
)
def test_refuses_what_is_no_row_of_finite_numbers(make, bad, message):
    with pytest.raises(InputError, match=message):
        make(bad)


def test_records_are_taken_as_they_are():
    """N + 1 positions, N positions of switching and N forces for N intervals."""
    motion = PrescribedMotion([0, 1, 2, 1, 0], switch_positions=[0.5, 1.5, 1.5, 0.5])
    signals = motion.signals(TIMES)
    assert signals.position.tolist() == [0, 1, 2, 1, 0]
    assert signals.switch_position.tolist() == [0.5, 1.5, 1.5, 0.5]
    assert motion.kinematic
    assert RecordedForce([0.1, -0.2, 0.3, 0.4]).signals(TIMES).force.tolist() == [0.1, -0.2, 0.3, 0.4]


def test_a_function_of_time_prescribes_positions():
    """It is asked at each sample instant, and at 0 for the start."""
    motion = PrescribedMotion(lambda t: 0.002 - 3 * t)
    position = motion.signals(TIMES).position
    assert position == pytest.approx([0.002, -0.001, -0.004, -0.007, -0.010])
    assert motion.initial_position == 0.002


def test_tracking_holds_the_last_position():
    for positions, expected in [([1, 2, 3], [1, 2, 3, 3, 3]), (range(9), [0, 1, 2, 3, 4])]:
        anchor = tracking(list(positions)).signals(TIMES).anchor
        assert anchor.tolist() == expected


def test_a_hand_tied_by_nothing_has_no_anchor():
    hand = Tracking([0.0], stiffness=0, damping=0, mass=0.01)
    assert hand.signals(TIMES).anchor is None
    assert hand.hand == (0.01, 0, 0)


def test_bandwidth_gives_stiffness_and_damping():
    """0.05 kg at 20 Hz: the undamped frequency is √(k/M), the damping ratio c/(2√(kM))."""
    hand = Tracking.of_bandwidth([0.0], frequency=20, moved_mass=0.05, damping_ratio=0.3, mass=0.01).hand
    assert np.sqrt(hand.stiffness / 0.05) / (2 * np.pi) == pytest.approx(20, rel=1e-14)
    assert hand.damping / (2 * np.sqrt(hand.stiffness * 0.05)) == pytest.approx(0.3, rel=1e-14)
    assert hand.mass == 0.01


DEVICE = zw.Device(damping=0.15, coulomb_friction=0.01, resolution=0, rate=1000)


def _witness(stiffness: float = 120, damping: float = 0.1, **changes: Any) -> zw.Witness:
    witness = zw.check(DEVICE.replace(**changes), zw.Wall(stiffness=stiffness, damping=damping)).witness
    return witness


def _repeating() -> zw.Witness:
    """A motion that straddles an encoder edge again and again."""
    return _witness(240, 0, resolution=2.24e-3, coulomb_friction=0.12)


def test_a_witness_is_replayed_position_by_position():
    witness = _witness()
    hand = WitnessMotion(witness)
    times = np.arange(hand.intervals + 4) * 0.001
    position = hand.signals(times).position
    assert hand.kinematic
    assert position.tolist() == [*witness.positions, *[witness.positions[-1]] * 3]
    assert hand.initial_position == witness.positions[0]
    assert hand == WitnessMotion(witness)
    assert hash(hand) == hash(WitnessMotion(witness))


def test_the_energy_of_a_replayed_witness_is_what_it_claims():
    """−Σ f Δx − f_c Σ|Δx| − (b/T) Σ Δx² with the wall's force worked out here, on the replayed positions."""
    witness = _witness()
    hand = WitnessMotion(witness)
    x = hand.signals(np.arange(hand.intervals + 1) * 0.001).position
    before = np.concatenate([[0.0], x[:-1]])
    force = np.where(x > 0, 120 * x + 0.1 * (x - before) / 0.001, 0.0)
    step = np.diff(x)
    out = force[:-1] @ -step - 0.01 * abs(step).sum() - 0.15 / 0.001 * (step @ step)
    assert out == pytest.approx(witness.energy, rel=1e-9)


def test_rounds_of_a_witness_can_be_limited():
    witness = _repeating()
    assert witness.motion.rounds > 3
    hand = WitnessMotion(witness, rounds=3)
    assert hand.intervals == witness.motion.repeated(3).samples
    anchor = tracking(witness.motion.repeated(3)).signals(np.arange(hand.intervals + 1) * 0.001).anchor
    position = hand.signals(np.arange(hand.intervals + 1) * 0.001).position
    assert anchor.tolist() == position.tolist()


def test_switch_positions_of_a_witness_are_replayed():
    witness = _witness(900, 0, delay=0.0003)
    hand = WitnessMotion(witness, rounds=2)
    listed = witness.motion.repeated(2).listed()
    assert listed.switch_positions
    signals = hand.signals(np.arange(hand.intervals + 3) * 0.001)
    expected = [*map(float, listed.switch_positions), *[float(listed.positions[-1])] * 2]
    assert signals.switch_position.tolist() == expected
    cut = hand.signals(np.arange(3) * 0.001)
    assert cut.switch_position.tolist() == expected[:2]


@pytest.mark.parametrize("make", [WitnessMotion, tracking])
def test_a_witness_is_replayed_at_its_own_period(make):
    with pytest.raises(InputError, match=r"period of 1 ms and is replayed at 2 ms"):
        make(_witness()).signals(np.arange(9) * 0.002)


@pytest.mark.parametrize(
    ("text", "column"),
    [
        ("0.5\n-1e-3\n2\n", None),
        ("# recorded\nforce\n0.5\n\n-1e-3  # here\n2\n", None),
        ("time,force\n0,0.5\n1,-1e-3\n2,2\n", "force"),
        ("0;0.5\n1;-1e-3\n2;2\n", 1),
        ("\ufefft f\r\n0 0.5\r\n1 -1e-3\r\n2 2\r\n", "f"),
    ],
)
def test_a_force_is_read_from_a_file(text, column, tmp_path):
    path = tmp_path / "force.csv"
    path.write_bytes(text.encode())
    assert RecordedForce.from_file(path, column) == RecordedForce([0.5, -1e-3, 2])


@pytest.mark.parametrize(
    ("text", "column", "message"),
    [
        (b"", None, "holds no number"),
        (b"force\n", None, "holds no number"),
        (b"1,2\n3,4\n", None, "2 columns; say which"),
        (b"a,b\n3,4\n", None, "2 columns: a, b; say which"),
        (b"a,b\n3,4\n", "c", "no column 'c': a, b"),
        (b"1,2\n3,4\n", "c", "its columns have no names"),
        (b"1,2\n", 2, "no column 2: it has 2"),
        (b"1\n2\nthree\n", None, "line 3: expected a number, got 'three'"),
        (b"1,2\n3\n", 0, "line 2: 1 values where the first line has 2"),
        (b"1\nnan\n", None, "got nan at index 1"),
        (b"\x89PNG\xff\xfe", None, "not a text file"),
        (bytes(2**20 + 1), None, "line of more than"),
    ],
)
def test_a_file_of_another_shape_is_refused(text, column, message, tmp_path):
    path = tmp_path / "force.csv"
    path.write_bytes(text)
    with pytest.raises(InputError, match=message):
        RecordedForce.from_file(path, column)


BAND = {"frequency": 20, "moved_mass": 0.05}
TIED = {"stiffness": 1, "damping": 1}


@pytest.mark.parametrize(
    ("make", "said"),
    [
        *(
            (lambda n=n: RecordedForce(np.ones(n)), rf"{n} values.*4 sample intervals.*{n} ms")
            for n in (3, 5)
        ),
        (lambda: PrescribedMotion([0, 1, 2, 1]), r"positions has 4 values.*5 sample instants"),
        (
            lambda: PrescribedMotion([0, 1, 2, 1, 0], switch_positions=[0] * 5),
            r"switch_positions has 5 values.*4 sample intervals",
        ),
        *(
            (lambda function=function: PrescribedMotion(function), "one finite number for a time")
            for function in (lambda t: None, lambda t: "x", lambda t: float("nan") if t > 0.001 else t)
        ),
        *(
            (lambda k=k, v=v: Tracking.of_bandwidth([0.0], **BAND | {k: v}), f"{k} must be > 0 and finite")
            for k, v in (("frequency", 0), ("moved_mass", -1), ("frequency", float("nan")))
        ),
        (lambda: Tracking([0.0], **TIED | {"stiffness": -1}), "stiffness"),
        (lambda: Tracking([0.0], **TIED | {"damping": -1e-9}), "damping"),
        (lambda: Tracking([0.0], **TIED, mass=float("inf")), "mass"),
        *(
            (lambda n=n: WitnessMotion(_witness(), rounds=n), "rounds must be a whole number ≥ 1")
            for n in (0, -1, 2.5, True)
        ),
        (lambda: WitnessMotion(_repeating(), rounds=10**9), "rounds=100"),
        (
            lambda: WitnessMotion(zw.check(DEVICE, zw.Wall(stiffness=1)).witness),
            "a passive loop has no witness",
        ),
        (lambda: RecordedForce.from_file("nowhere.csv"), r"nowhere\.csv cannot be read"),
        (lambda: RecordedForce.from_file("."), "cannot be read"),
    ],
)
def test_what_does_not_fit_the_touch_is_refused(make, said):
    with pytest.raises(InputError, match=said):
        make().signals(TIMES)
