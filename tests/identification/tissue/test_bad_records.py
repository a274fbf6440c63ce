"""Faulty records of a tissue: the intervals hold the truth and a finding says so, or the cause is named."""

from __future__ import annotations

import re

import numpy as np
import pytest
from scipy.signal import lfilter

import zwidth as zw
from zwidth.data.tissue import RecursiveSolid, fit_tissue, force_response
from zwidth.data.tissue.experiment.history import Trial, history_of
from zwidth.data.tissue.findings import coarse

SOLID = zw.StandardLinearSolid(420, 230, 17)
TRUE = {"stiffness": 420, "branch_stiffness": 230, "branch_damping": 17}
PERIOD = 0.002


def record(seconds=6.0, fine=10):
    """Times, positions, the force without noise as it is between the samples, and as it is at them."""
    t = PERIOD / fine * np.arange(round(seconds / PERIOD) * fine)
    x = 0.006 + 0.002 * np.sin(8 * t) + 0.001 * np.sin(37 * t + 1) + 0.0003 * np.sin(90 * t)
    return t, x, force_response(SOLID, t, x)


def fitted(t, x, f, seed=0, fine=10, **options):
    noise = np.random.default_rng(seed).normal(0, 0.01, t[::fine].size)
    return fit_tissue(t[::fine], x[::fine], f[::fine] + noise, **options)


def holds(fit):
    return all(low < TRUE[n] < high for n, (low, high) in ((n, fit.interval(n, 0.999)) for n in TRUE))


def kinds(fit):
    return {finding.kind for finding in fit.findings}


def test_a_plain_record_says_nothing():
    fit = fitted(*record())
    assert not fit.findings
    assert fit.further == 0
    assert holds(fit)


@pytest.mark.parametrize("milliseconds", [1.0, 4.0])
def test_a_late_force_is_read_in_time(milliseconds):
    t, x, f = record()
    fit = fitted(t, x, np.interp(t - milliseconds * 1e-3, t, f))
    (finding,) = fit.findings
    assert finding.kind == "force late"
    assert milliseconds < 2 or "as a delay" in finding.text
    assert holds(fit)
    assert "further" not in fit.values


def test_a_filter_of_the_load_cell():
    """A time constant of 4 ms is told from a delay."""
    t, x, f = record()
    keep = np.exp(-(t[1] - t[0]) / 0.004)
    fit = fitted(t, x, lfilter([1 - keep], [1, -keep], f, zi=[keep * f[0]])[0])
    (finding,) = fit.findings
    assert "a filter of the first order" in finding.text
    assert holds(fit)


@pytest.mark.parametrize("share", [0.1, 0.01])
def test_a_load_cell_at_its_end_stop(share):
    t, x, f = record()
    most = np.quantile(f, 1 - share)
    noise = np.random.default_rng(1).normal(0, 0.01, t[::10].size)
    fit = fit_tissue(t[::10], x[::10], np.minimum(f[::10] + noise, most))
    assert kinds(fit) == {"saturated"}
    assert fit.output.size < t[::10].size * (1 - 0.5 * share)
    assert holds(fit)


def test_a_force_that_rests_is_at_no_stop():
    """A relaxation test that has come to rest, read in steps of a converter."""
    t = np.arange(4000) * 1e-3
    f = np.rint(force_response(SOLID, t, np.full(t.size, 0.01), 0.0) / 0.01) * 0.01
    fit = fit_tissue(t, np.full(t.size, 0.01), f, rest=0)
    assert "saturated" not in kinds(fit)
    assert fit.output.size == t.size


def test_too_little_within_the_range_is_refused():
    t, x, f = (values[::10] for values in record())
    with pytest.raises(zw.InputError, match="is at an end of the sensor's range"):
        fit_tissue(t, x, np.minimum(f, np.quantile(f, 0.1)))


@pytest.mark.parametrize("stamped", [True, False])
def test_holes(stamped):
    """What the branch held after a hole is fitted, whether the stamps tell of it or not."""
    t, x, f = (values[::10] for values in record())
    kept = np.ones(t.size, dtype=bool)
    kept[700:820] = kept[1500:1730] = False
    time = t[kept] if stamped else t[: kept.sum()]
    fit = fitted(time, x[kept], f[kept], fine=1)
    assert "hole" in kinds(fit)
    assert holds(fit)


def test_a_zero_that_is_off_or_drifts():
    t, x, f = record()
    assert kinds(fitted(t, x, f + 0.3)) == {"offset"}
    assert fitted(t, x, f + 0.3)["offset"] == pytest.approx(0.3, abs=0.02)
    drifting = fitted(t, x, f + 0.2 * t / t[-1])
    assert kinds(drifting) == {"drift"}
    assert holds(drifting)


def test_a_sign_turned_round():
    """No tissue pulls the probe in; nor does a tracker follow such a record."""
    t, x, f = record()
    for force, position in ((-1, 1), (1, -1)):
        with pytest.raises(zw.InputError, match="no tissue pulls the probe in"):
            fitted(t, position * x, force * f)
    with pytest.raises(zw.InputError, match="no tissue pulls it in"):
        RecursiveSolid(PERIOD, (200, 200, 20)).track(x[::10], -f[::10])


@pytest.mark.parametrize("factor", [1e3, 1e-3])
def test_units_off_by_a_thousand(factor):
    t, x, f = record()
    for fit in (fitted(t, x, factor * f), fitted(t, x / factor, f)):
        assert any("unit is off by 1000" in remark for remark in fit.remarks)
        with pytest.raises(zw.InputError, match="no interval is to be trusted"):
            fit.verdict(zw.Device(damping=1, rate=1000))


def test_a_coarse_position_is_remarked():
    """Steps of 0.2 mm leave more than the noise does; of 1 µm they do not."""
    t, x, f = record()
    assert any("in steps of 200 µm" in r for r in fitted(t, np.rint(x / 2e-4) * 2e-4, f).remarks)
    assert not fitted(t, np.rint(x / 1e-6) * 1e-6, f).remarks


def test_a_ramp_is_not_read_in_steps():
    """Of one speed, and so 0.4 mm from sample to sample: no encoder has such steps."""
    t = 0.02 * np.arange(1500)
    x = np.round(np.clip(t - 1, 0, 0.25) * 0.02, 9)
    assert not list(coarse(x, 650, 0.002, "m"))
    assert list(coarse(np.rint(np.clip(t - 1, 0, 20) / 80 / 4e-4) * 4e-4, 650, 0.002, "m"))


def test_a_tracker_passes_over_what_says_nothing():
    """A load cell at its stop, and holes: the tracker ends where it ends without them."""
    t, x, f = (values[::10] for values in record(12.0))
    f = f + np.random.default_rng(2).normal(0, 0.01, f.size)
    settings = RecursiveSolid(PERIOD, (300, 300, 20), forgetting="0.9995")
    cut = settings.track(x, np.minimum(f, np.quantile(f, 0.9)))
    assert kinds(cut) == {"saturated"}
    kept = np.ones(t.size, dtype=bool)
    kept[3000:3150] = kept[4700:4900] = False
    holed = settings.track(x[kept], f[kept], t[kept])
    assert kinds(holed) == {"hole"}
    for track in (cut, holed):
        assert np.median(track.stiffness[-1000:]) == pytest.approx(420, rel=0.02)
        assert np.median(track.branch_stiffness[-1000:]) == pytest.approx(230, rel=0.1)
    assert not settings.track(x, f, t).findings
    assert kinds(settings.track(x, 1e3 * f)) == {"units"}
    assert kinds(settings.track(-x, f)) == {"outside"}


@pytest.mark.parametrize("seed", range(12))
def test_a_force_that_falls_while_the_probe_goes_on_is_of_no_tissue(seed):
    """Of solids and of Hunt–Crossley contacts, at speeds that change by two, it never does."""
    rng = np.random.default_rng(seed)
    t = np.linspace(0, 20, 600)
    speed = np.interp(t, np.linspace(0, 20, 9), rng.uniform(1, 2, 9)) * (t > rng.uniform(0, 2))
    x = 1e-4 * np.cumsum(speed) * t[1]
    if seed % 3:
        f = force_response(zw.StandardLinearSolid(*(10 ** rng.uniform([0, 2, 2], [3, 4, 5]))), t, x)
    else:
        f = 1e5 * x**1.5 * (1 + 50 * np.gradient(x, t))
    f += rng.normal(0, 0.003 * f.max(), t.size)
    late = rng.integers(250, 500)
    torn = np.where(np.arange(t.size) < late, f, 0.05 * f)
    history_of(Trial(t, x, f, ()), "loading", "a.csv")
    with pytest.raises(zw.InputError, match=r"tears, yields or slips.* give the rows before"):
        history_of(Trial(t, x, torn, ()), "loading", "a.csv")


def test_a_table_without_time_is_told_what_is_missing(tmp_path):
    path = tmp_path / "press.csv"
    for times in (1, 2):  # one test, and two side by side
        lines = (",".join([line] * times) for line in ("Depth (mm),Load (N)", "0,0", "1,0.2", "2,0.5"))
        path.write_text("\n".join([*lines, ""]), encoding="utf-8")
        told = r'load against depth, "Depth .mm.", "Load .N.", without time.*--type nonlinear-spring --pos'
        with pytest.raises(zw.InputError, match=told):
            zw.tissue.read_test(path)


def test_a_table_without_time_is_told_its_own_points(tmp_path):
    """In the units of the command; of what comes out of the tissue again there is none."""
    path = tmp_path / "press.csv"
    path.write_text("Weg [mm];Last [g]\n0,0;0\n1,0;3,1\n2,0;9,8\n1,0;2,0\n", encoding="utf-8")
    told = '--positions "0 m, 1 mm, 2 mm" --forces "0 N, 0.0304 N, 0.09611 N"'
    with pytest.raises(zw.InputError, match=re.escape(told)):
        zw.tissue.read_test(path)


def test_a_pressure_is_no_force(tmp_path):
    path = tmp_path / "press.csv"
    path.write_text("Depth (mm),Stress (kPa)\n0,0\n1,0.2\n2,0.5\n", encoding="utf-8")
    with pytest.raises(zw.InputError, match=r'"Stress .kPa." is a pressure.* times the area of the probe'):
        zw.tissue.read_test(path)


@pytest.mark.parametrize("stated", [True, False])
def test_a_unit_that_is_stated_is_not_doubted(stated, tmp_path):
    """Of an indentation of 16 µm in a file; of arrays of so little it is."""
    t = np.linspace(0, 30, 200)
    x = 5e-7 * t
    f = force_response(zw.StandardLinearSolid(60, 40, 400), t, x)
    f += np.random.default_rng(1).normal(0, 1e-7, t.size)
    if stated:
        rows = "".join(f"{a:.6f},{b * 1e6:.6f},{c * 1e6:.6f}\n" for a, b, c in zip(t, x, f, strict=True))
        (tmp_path / "nano.csv").write_text(f"Time (s),Depth (um),Load (uN)\n{rows}", encoding="utf-8")
        found = zw.tissue.read_test(tmp_path / "nano.csv", models=("standard-linear-solid",))
    else:
        found = zw.tissue.fit_test(t, x, f, models=("standard-linear-solid",))
    assert any("their unit is another" in doubt for doubt in found.doubts) != stated
    assert found.best["stiffness"] == pytest.approx(60, rel=0.05)
