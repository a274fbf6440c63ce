"""Scattering parameters: rational ones decided with proof or waves, tables sample by sample."""

from __future__ import annotations

from types import SimpleNamespace

import control
import numpy as np
import pytest

import zwidth as zw
from zwidth.cli.main import main

PASSIVE = {
    "open end": control.tf([1], [1]),
    "short end": control.tf([-1], [1]),
    "all-pass": control.tf([1, -1], [1, 1]),
    "lag": control.tf([0.5], [1, 1]),
    "through": control.tf([[[0], [1]], [[1], [0]]], [[[1], [1]], [[1], [1]]]),
    "gyrator": control.tf([[[0], [-1]], [[1], [0]]], [[[1], [1]], [[1], [1]]]),
    "sampled": control.tf([0.3, 0.4], [1, 0.1], 0.5),
}
ACTIVE = {
    "amplifier": (control.tf([1.2], [1, 1]), 1.2, 0.0),
    "one way": (control.tf([[[0], [1.1]], [[1], [0]]], [[[1], [1, 1]], [[1], [1]]]), 1.1, 0.0),
    "sampled": (control.tf([0.3, 1.1], [1, 0.5], 1), 1.6, 0.5),
}


@pytest.mark.parametrize("name", PASSIVE)
def test_bounded_real_is_passive_with_a_proof(name):
    found = zw.ports.scattering_passivity(PASSIVE[name])
    assert found.passive
    assert found.certificate.verify()
    assert found.bands == ()
    assert found.witness is None
    assert found.waves() is None


@pytest.mark.parametrize("name", ACTIVE)
def test_what_brings_back_more_is_shown_by_waves(name):
    """The largest gain and its frequency by hand; ∫ |a|² − |b|² of the waves, summed anew, is below 0."""
    system, gain, at = ACTIVE[name]
    found = zw.ports.scattering_passivity(system)
    assert found.outcome == "active"
    assert found.gain.value == pytest.approx(gain, rel=1e-9)
    assert found.gain.frequency == pytest.approx(at, abs=1e-9)
    t, *waves = found.waves(4000)
    over = (lambda x: np.trapezoid(x, t)) if system.dt == 0 else np.sum
    carried, back = (sum(over(np.square(x)) for x in wave) for wave in waves)
    assert back > carried
    assert "violated" in repr(found)


def test_the_waves_answer_each_other():
    found = zw.ports.scattering_passivity(ACTIVE["amplifier"][0])
    t, (a,), (b,) = (np.array(x) for x in found.waves(20001))
    answer = control.forced_response(ACTIVE["amplifier"][0], t, a).outputs
    assert answer == pytest.approx(b, abs=1e-4)


@pytest.mark.parametrize("period", [0, 1])
@pytest.mark.parametrize(
    "state_space",
    [
        ([[-0.9]], [[1.64]], [[0.2934]], [[1.0]]),
        ([[-0.5]], [[-1.18, -1.78]], [[1.29], [-0.136]], [[1.0, 0.0], [0.0, 1.0]]),
        ([[-0.5]], [[1.0, 2.0]], [[1.0], [-1.0]], [[1.0, 0.0], [0.0, -1.0]]),
        ([[-0.5, 0.3], [-0.3, -0.5]], [[1, 2], [0, 1]], [[1, 0.5], [0, 1]], [[0.6, 0.8], [-0.8, 0.6]]),
    ],
)
def test_a_network_that_passes_on_all_at_high_frequency(state_space, period):
    """S(∞) has singular values of 1, so that 1 − ΣS(∞) has no inverse for some signs: others serve."""
    system = control.ss(*state_space, period)
    found = zw.ports.scattering_passivity(system)
    omega = np.linspace(0, np.pi, 500) if period else np.geomspace(1e-3, 1e3, 500)
    values = [system(np.exp(1j * w) if period else 1j * w, squeeze=False) for w in omega]
    assert found.outcome == "active"
    assert found.gain.value == pytest.approx(max(np.linalg.norm(v, 2) for v in values), rel=1e-3)
    assert found.gain.certificate().verify()


@pytest.mark.parametrize("gain", [0.703, -0.703, [[0.7, 0.0], [0.0, -0.7]], [[0.3, 0.0], [0.0, 0.5]]])
def test_a_constant_gain_has_its_proof(gain):
    """All that comes in comes back by the same part: R − ΣS vanishes for some signs."""
    found = zw.ports.scattering_passivity(control.ss([], [], [], gain))
    size = np.abs(gain).max()
    assert found.gain.value == size
    assert found.gain.certificate().verify()
    assert not found.gain.at_most(size - 1e-9)
    with pytest.raises(zw.InputError, match="higher level"):
        found.gain.certificate(size - 1e-9)


def test_the_relative_index_of_an_improper_port():
    """diag(s, 1): at infinity one axis alone is rigid; all of its wave comes back."""
    one, s = [1], [1, 0]
    g = control.tf([[s, [0]], [[0], one]], [[one, one], [one, one]])
    found = zw.ports.passivity_indices(g).relative(2)
    assert found.value == 1
    assert found.certificate().verify()


@pytest.mark.parametrize("system", [PASSIVE["gyrator"], ACTIVE["one way"][0]])
def test_what_is_saved_is_verified(system, tmp_path, capsys):
    zw.ports.scattering_passivity(system).save(tmp_path / "s.json")
    assert main(["verify", str(tmp_path / "s.json")]) == 0
    assert "VALID" in capsys.readouterr().out


def test_an_unstable_network_is_active():
    """A pole that grows, though ‖S‖ ≤ 1 at every frequency."""
    found = zw.ports.scattering_passivity(control.tf([1], [1, -1]))
    assert found.outcome == "active"
    assert found.bands == ()
    assert found.to_dict()["largest_gain"] == np.inf


def test_a_hidden_mode_that_grows_is_told():
    """No wave from rest shows it, and so the network is passive; what is hidden is said."""
    found = zw.ports.scattering_passivity(control.ss([[1.0]], [[1.0]], [[0.0]], [[0.5]]))
    assert found.passive
    assert not found.hidden_modes_decay
    assert "does not decay" in repr(found)


def table(*gains, **more):
    s = np.reshape(np.array(gains, complex), (-1, 1, 1))
    return SimpleNamespace(f=1e9 + 1e8 * np.arange(len(gains)), s=s, **more)


def test_samples_above_one_are_told_with_what_lies_beside_them():
    found = zw.ports.scattering_table(table(0.5, 1.1j, -1.2, 0.9, 1.0, 1.3))
    assert found.violates
    first, last = found.bands
    assert (first.before, first.low, first.high, first.after) == (1e9, 1.1e9, 1.2e9, 1.3e9)
    assert (last.low, last.high, last.after) == (1.5e9, 1.5e9, None)
    assert found.largest == (pytest.approx(1.3), 1.5e9)
    assert "At 3 of 6 samples more comes back than goes in" in found.describe()
    assert found.to_dict()["violated_Hz"] == [[1.1e9, 1.2e9], [1.5e9, 1.5e9]]


def test_samples_that_keep_the_bound_prove_nothing():
    found = zw.ports.scattering_table(table(0.5, 0.6j, -1.0))
    assert not found.violates
    # Kurokawa's waves carry |a|² − |b|² at a complex reference too
    assert not zw.ports.scattering_table(table(0.5, z0=50 + 3j, s_def="power")).violates
    assert "no proof of passivity" in found.describe()
    assert any("between samples" in line for line in found.assumptions)


def test_one_is_told_from_a_little_more_exactly():
    """0.6 + 0.8j has size 1; its neighbours in the last digit have not, whatever rounding says."""
    more = complex(np.nextafter(0.6, 1), 0.8)
    less = complex(np.nextafter(0.6, 0), 0.8)
    found = zw.ports.scattering_table(table(0.6 + 0.8j, more, less))
    assert found.violated == (False, True, False)


def test_of_several_ports_the_largest_singular_value_counts():
    """A rotation by 0.6 and 0.8 carries all; every entry is below 1 and a little more gain is found."""
    rotation = np.array([[0.6, 0.8], [-0.8, 0.6]], complex)
    samples = np.array([rotation, rotation * (1 + 1e-12)])
    network = SimpleNamespace(f=[1.0, 2.0], s=samples, z0=[[50, 75.0]] * 2)
    assert zw.ports.scattering_table(network).violated == (False, True)


@pytest.mark.parametrize(
    ("network", "message"),
    [
        (3, "is a Network of scikit-rf"),
        (SimpleNamespace(f=[1, 2], s=np.ones((2, 1, 2))), "one square matrix for each frequency"),
        (SimpleNamespace(f=[2, 1], s=np.ones((2, 1, 1))), "ascend"),
        (SimpleNamespace(f=[1, 2], s=np.full((2, 1, 1), np.nan)), "not finite"),
        (table(0.5, z0=-50), "positive real part"),
        (table(0.5, z0=50 + 3j, s_def="traveling"), "renormalize"),
    ],
)
def test_tables_that_tell_no_power_are_refused(network, message):
    with pytest.raises(zw.InputError, match=message):
        zw.ports.scattering_table(network)
