"""What an identified device shows: table, file, curve, document; and what `zw.identify` reads."""

from __future__ import annotations

import dataclasses
import json
import tomllib
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from known_motion import COULOMB, DAMPING, MASS, PERIOD, STEP, Recording, paddle
from scipy import stats

import zwidth as zw
from zwidth.data.identification.device.curve import friction_bins, lower_bounds
from zwidth.data.identification.device.estimate import Estimate
from zwidth.data.identification.device.table import advice, limits, percent, rows
from zwidth.model.specification.read import load


def log_of(recording: Recording) -> zw.Log:
    """The arrays as a log."""
    return zw.Log.from_arrays(
        time=recording.time, position=recording.position, hand_force=recording.force, resolution=STEP
    )


@pytest.fixture(scope="module")
def found() -> zw.identification.Identified:
    """The device of the recording."""
    return zw.identify(log_of(paddle()))


def test_the_numbers_are_those_of_the_device(found: zw.identification.Identified) -> None:
    """Each within its interval at 99.9 %, and the intervals are a few per cent wide."""
    for name, truth in (("mass", MASS), ("damping", DAMPING), ("coulomb_friction", COULOMB)):
        low, high = found.estimates[name].interval(0.999)
        assert low < truth < high
        assert high - low < 0.2 * truth


def test_a_log_a_file_and_a_dataset_give_the_same(
    found: zw.identification.Identified, tmp_path: Path
) -> None:
    """The same samples, whatever holds them; arguments of reading are passed on."""
    time, position, force = paddle()
    counts = np.rint(position / STEP)
    path = tmp_path / "session.csv"
    rows = np.stack([time, counts, force], axis=1)
    np.savetxt(path, rows, delimiter=",", header="t_s,enc,F1_N", comments="", fmt="%.9g")
    names = {"position": "enc", "hand_force": "F1_N"}
    of_file = zw.identify(path, columns=names, units={"position": "counts"}, resolution="22.4 um")
    variables = {
        "position": ("time", position, {"units": "m"}),
        "hand_force": ("time", force, {"units": "N"}),
    }
    data = xr.Dataset(variables, coords={"time": ("time", time, {"units": "s"})})
    of_dataset = zw.identify(data, resolution=STEP)
    for name, estimate in found.estimates.items():
        assert of_file.estimates[name].value == pytest.approx(estimate.value, rel=1e-6)
        assert of_dataset.estimates[name].value == pytest.approx(estimate.value, rel=1e-9)
    assert str(path) == of_file.source


def test_a_log_is_not_read_twice() -> None:
    """What is about reading a file says nothing about a log."""
    with pytest.raises(zw.InputError, match="read already; units"):
        zw.identify(log_of(paddle()), units={"position": "mm"})


def test_a_mass_may_carry_a_unit() -> None:
    """35.7 g is 0.0357 kg; a mass in metres is refused, and so is a model that is none."""
    log = log_of(paddle())
    with_unit, plain = zw.identify(log, mass="35.7 g"), zw.identify(log, mass=0.0357)
    assert with_unit.mass == plain.mass == 0.0357
    assert with_unit.estimates == plain.estimates
    assert "as given" in repr(plain)
    with pytest.raises(zw.InputError, match="mass is in kg"):
        zw.identify(log, mass="36 mm")
    with pytest.raises(zw.InputError, match='model is "Coulomb and viscous" or "viscous"'):
        zw.identify(log, model="mass")  # type: ignore[arg-type]


def test_progress_ends_with_every_sample() -> None:
    """A bar can be drawn."""
    told: list[tuple[int, int]] = []
    zw.identify(log_of(paddle()), progress=lambda done, total: told.append((done, total)))
    assert told[-1] == (20_000, 20_000)
    assert [done for done, _ in told] == sorted(done for done, _ in told)


def test_the_table_shows_every_number(found: zw.identification.Identified) -> None:
    """In a terminal and in a notebook: parameters, the stiffness they allow, findings."""
    text, html = repr(found), found._repr_html_()
    for part in ("best guess", "95 %", "m ", "b ", "f_c", "2b/T", "2f_c/Δ", "N·s/m", "strokes", "r² ="):
        assert part in text
    for part in ("<table>", "2b/T", "Coulomb friction", "<li>"):
        assert part in html
    assert f"{found.estimates['damping'].value:.4g}" in text
    assert all(str(finding) in text for finding in found.findings)
    assert max(len(line) for line in text.splitlines() if not line.startswith("·")) < 150


def test_names_are_escaped_in_a_notebook(found: zw.identification.Identified) -> None:
    """A log's name is text, never markup."""
    odd = dataclasses.replace(found, source="<b>log.csv")
    assert "<b>" in repr(odd)
    assert "<b>" not in odd._repr_html_()


def test_a_saved_device_is_read_back(found: zw.identification.Identified, tmp_path: Path) -> None:
    """The strict reader gives the intervals, rounded outwards by less than a hundredth of a per cent."""
    path = tmp_path / "mine.toml"
    found.save(path, 0.97, delay="0.0003")
    read = load([path], {"stiffness": "100"}).device
    own = found.device(0.97, delay="0.0003")
    for name in ("mass", "damping", "coulomb_friction"):
        there, here = getattr(read, name), getattr(own, name)
        assert there.low.fraction <= here.low.fraction < here.high.fraction <= there.high.fraction
        assert float(there.low) == pytest.approx(float(here.low), rel=1e-4)
        assert float(there.high) == pytest.approx(float(here.high), rel=1e-4)
    assert (read.sample_period, read.resolution, read.delay) == (
        own.sample_period,
        own.resolution,
        own.delay,
    )
    assert read.delay.fraction == Fraction(3, 10_000)


def test_every_number_of_a_saved_device_says_where_it_comes_from(found: zw.identification.Identified) -> None:
    """The log, the strokes, the method, the confidence, r²; no date."""
    text = found.to_toml(0.99)
    assert "Identified from arrays" in text
    assert f"{found.strokes} strokes, {found.pulses} means" in text
    assert "m ẍ + b ẋ + f_c sgn ẋ" in text
    assert f"r² = {found.explained:.4f}" in text
    assert "99 % confidence" in text
    values = [
        line for line in text.splitlines() if " = " in line and not line.startswith(("#", "name", "mo"))
    ]
    assert len(values) == 6
    assert any(line.startswith("friction_speed = ") and "the fastest motion seen" in line for line in values)
    assert all("# " in line for line in values)
    best = tomllib.loads(found.to_toml(None))["device"]
    assert best["damping"] == pytest.approx(found.estimates["damping"].value, rel=1e-5)
    assert "delay" not in best


def test_a_name_with_quotes_and_line_ends_is_still_toml(found: zw.identification.Identified) -> None:
    """Whatever the log or the device is called."""
    odd = dataclasses.replace(found, source='a "b"\\\n[device]\n.csv')
    device = tomllib.loads(odd.to_toml())["device"]
    assert device["name"] == 'identified from a "b"\\?[device]?.csv'
    assert tomllib.loads(found.to_toml(name='my "wheel"\x7f'))["device"]["name"] == 'my "wheel"?'


def test_a_file_is_not_replaced_unasked(found: zw.identification.Identified, tmp_path: Path) -> None:
    """An old file stays as it is; with force it is replaced, and nothing else is left."""
    path = tmp_path / "mine.toml"
    path.write_text("old")
    with pytest.raises(zw.InputError, match="exists"):
        found.save(path)
    assert path.read_text(encoding="utf-8") == "old"
    found.save(path, force=True)
    assert path.read_text(encoding="utf-8") == found.to_toml()
    assert [p.name for p in tmp_path.iterdir()] == ["mine.toml"]
    with pytest.raises(zw.InputError, match="no directory"):
        found.save(tmp_path / "nowhere" / "mine.toml")


def test_a_rotary_device_is_saved_as_one(tmp_path: Path) -> None:
    """Inertia in the place of mass, angles and torques."""
    time, position, force = paddle()
    log = zw.Log.from_arrays(time=time, position=position, hand_force=force, resolution=STEP, motion="rotary")
    found = zw.identify(log)
    assert "inertia" in [row.name for row in rows(found)]
    found.save(tmp_path / "wheel.toml")
    read = load([tmp_path / "wheel.toml"], {"stiffness": "1"}).device
    assert read.motion == "rotary"
    assert float(read.mass.low) < MASS < float(read.mass.high)
    assert "N·m/rad" in repr(found)
    assert "damping_N_m_s_per_rad" in found.to_dict()


def test_an_inertia_that_may_be_nothing_is_left_out(found: zw.identification.Identified) -> None:
    """No device has mass 0; nothing that is proved depends on it."""
    wide = Estimate(0.02, 0.05, 0.0, 100, "kg")
    vague = dataclasses.replace(found, estimates={**found.estimates, "mass": wide})
    assert vague.device(0.99).mass is None
    assert "mass" not in vague.to_toml()
    assert found.device(0.99).mass is not None


def test_the_curve_lies_below_the_friction_of_the_device(found: zw.identification.Identified) -> None:
    """Bounds below the truth by a few per cent; the model below them proves nearly as stiff a wall."""
    curve = found.friction_curve(0.95)
    for speed, force in zip(curve.speeds, curve.forces, strict=True):
        truth = COULOMB + DAMPING * float(speed)
        assert 0.85 * truth < float(force) < truth
    best = curve.best(PERIOD, STEP)
    assert 0.7 * DAMPING < float(best.damping) < DAMPING


def test_friction_that_bends_is_bounded_below() -> None:
    """f_c + b v + c v²: the bounds follow the bend, and no model of them is above it."""
    bent = 0.25
    found = zw.identify(log_of(paddle(quadratic=bent)))
    assert "bent friction" in [finding.kind for finding in found.findings]
    curve = found.friction_curve(0.95)
    for speed, force in zip(curve.speeds, curve.forces, strict=True):
        v = float(speed)
        spread = bent * v**2  # a mean over a bin is above the curve at its mean speed, by c var(v)
        assert 0.9 * (COULOMB + DAMPING * v + spread) < float(force)
        assert float(force) < COULOMB + DAMPING * v + 1.1 * spread + 1e-3
    assert float(curve.largest_damping) > DAMPING


def test_the_errors_of_the_bins_are_those_of_the_strokes(found: zw.identification.Identified) -> None:
    """By another road: means at one speed, of whole strokes drawn with replacement, scatter as much."""
    points = found.points
    speed, friction = points["speed"].values, points["friction"].values
    edges = np.quantile(speed[speed > 0], [0.5, 0.75])
    inside = (speed > edges[0]) & (speed <= edges[1])
    friction = friction - DAMPING * speed
    strokes = [friction[inside & (points["stroke"].values == s)] for s in np.unique(points["stroke"])]
    strokes = [part for part in strokes if part.size]
    random = np.random.default_rng(3)
    means = []
    for _ in range(400):
        drawn = random.integers(0, len(strokes), len(strokes))
        means.append(np.concatenate([strokes[k] for k in drawn]).mean())
    error = float(friction_bins(points, 4)["error"].sel(direction="inward")[2])
    assert error == pytest.approx(float(np.std(means)), rel=0.2)


def test_all_bounds_share_the_risk(found: zw.identification.Identified) -> None:
    """Half of 5 % is the slope's; of the other half each bin and each rest, both ways, has as much."""
    bins = friction_bins(found.points, 2)
    bounds = lower_bounds(found.points, 0.95, 2)
    for way, (speeds, low) in zip(("inward", "outward"), bounds, strict=True):
        here = bins.sel(direction=way)
        reach = stats.t.ppf(1 - 0.05 / 2 / 6, here["strokes"].values - 1)
        assert speeds[1:] == pytest.approx(here["speed"].values)
        assert low[1:] == pytest.approx(here["friction"].values - reach * here["error"].values, rel=1e-12)
    curve = found.friction_curve(0.95, 2)
    assert float(curve.forces[0]) == pytest.approx((bounds[0][1][0] + bounds[1][1][0]) / 2, rel=1e-12)
    rise = float(curve.forces[-1] - curve.forces[-2]) / float(curve.speeds[-1] - curve.speeds[-2])
    assert rise == pytest.approx(found.least_damping(0.95), rel=1e-9)


@pytest.mark.parametrize(("confidence", "bins"), [(0.0, 8), (1.0, 8), (float("nan"), 8), (0.9, 1)])
def test_no_curve_without_confidence_or_bins(
    found: zw.identification.Identified, confidence: float, bins: int
) -> None:
    """Certainty takes no data; one bin is no curve."""
    with pytest.raises(zw.InputError, match=r"confidence must be|two bins"):
        found.friction_curve(confidence, bins)


def test_the_limits_are_those_of_the_parameters(found: zw.identification.Identified) -> None:
    """2b/T and 2f_c/Δ, at the best guess and at both ends."""
    by_damping, by_friction = limits(found)
    assert by_damping.value == pytest.approx(2 * found.estimates["damping"].value / PERIOD, rel=1e-12)
    low, high = found.least_coulomb_friction(0.9), found.estimates["coulomb_friction"].interval(0.9)[1]
    assert by_friction.interval(0.9) == pytest.approx((2 * low / STEP, 2 * high / STEP), rel=1e-12)
    assert 0.85 * COULOMB < low < found.estimates["coulomb_friction"].interval(0.9)[0]


def test_the_check_is_at_the_limit_that_is_shown(found: zw.identification.Identified) -> None:
    """Passive just below the low end of 2b/T, not proved just above it."""
    low, _ = limits(found)[0].interval(0.99)
    device = found.device(0.99)
    assert zw.check(device, zw.Wall(stiffness=0.9999 * low)).outcome == "passive"
    assert zw.check(device, zw.Wall(stiffness=1.0001 * low)).outcome != "passive"
    assert found.confidence(zw.Wall(stiffness=low)) == pytest.approx(0.99, abs=3e-4)


def test_advice_says_how_much_longer(found: zw.identification.Identified) -> None:
    """The scatter falls as one over the root of the duration, the shift does not."""

    def told(error: float, shift: float) -> str:
        estimate = Estimate(0.15, error, shift, 10**6, "N s/m")
        return " ".join(
            advice(dataclasses.replace(found, estimates={**found.estimates, "damping": estimate}), 0.99)
        )

    assert "damping limits the wall" in told(0.001, 0.0)
    assert "a log 4 times as long would halve" in told(0.001, 0.0)
    reach = float(stats.norm.ppf(0.995)) * 0.001
    assert "a log 9 times as long" in told(0.001, reach / 3)
    assert "a longer log would not halve" in told(0.001, 1.01 * reach)


def test_coulomb_friction_limits_where_the_encoder_is_coarse(found: zw.identification.Identified) -> None:
    """With a coarse step, 2f_c/Δ is below 2b/T."""
    coarse = dataclasses.replace(found, resolution=2e-3)
    assert advice(coarse, 0.99)[0].startswith("Coulomb friction limits the wall: 2f_c/Δ ≥")


def test_the_wrong_model_is_said_everywhere() -> None:
    """Numbers of a mass and a damper allow no wall where Coulomb friction is seen."""
    found = zw.identify(log_of(paddle()), model="viscous")
    assert found.estimates["damping"].value > 1.2 * DAMPING
    assert "wrong model" in repr(found)
    assert advice(found, 0.99) == (
        "fit Coulomb friction too: these numbers are of another model than the device",
    )
    for refused in (found.device, found.to_toml):
        with pytest.raises(zw.InputError, match="no device has them"):
            refused()


def test_the_document_is_json(found: zw.identification.Identified) -> None:
    """Units in the keys; the same numbers."""
    document = json.loads(json.dumps(found.to_dict(0.9)))
    assert document["format"] == "zwidth identification 1"
    assert document["damping_N_s_per_m"]["interval"] == list(found.estimates["damping"].interval(0.9))
    assert document["mass_kg"]["value"] == found.estimates["mass"].value
    assert document["stiffest_by_damping_N_per_m"]["value"] == limits(found)[0].value
    assert document["confidence"] == 0.9


@pytest.mark.parametrize(
    ("confidence", "text"),
    [(0.99, "99 %"), (0.999999, "99.9999 %"), (0.9, "90 %"), (0.99999996, "99.9999 %")],
)
def test_a_confidence_is_never_rounded_up(confidence: float, text: str) -> None:
    """99.99999 % is shown as 99.9999 %."""
    assert percent(confidence) == text
