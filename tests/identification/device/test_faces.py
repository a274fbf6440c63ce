"""What an identified device shows: table, file, curve, document, picture; and what `zw.identify` reads."""

from __future__ import annotations

import dataclasses
import json
import re
import tomllib
from fractions import Fraction

import numpy as np
import pytest
import xarray as xr
from known_motion import COULOMB, DAMPING, MASS, NOISE, PERIOD, STEP, paddle
from scipy import stats

import zwidth as zw
from zwidth.cli.data.identification_report import print_identified
from zwidth.cli.data.results import Identification
from zwidth.data.identification.device.curve import friction_bins, lower_bounds
from zwidth.data.identification.device.estimate import Estimate
from zwidth.data.identification.device.pulses import PIECES, pulse
from zwidth.data.identification.device.table import advice, limits, percent, perhaps_zero, rows
from zwidth.model.specification.read import load
from zwidth.show.plots.identified import expected_scatter, identification_figure

Identified = zw.identification.Identified


def log_of(motion: str = "linear", **other: float) -> zw.Log:
    time, position, force = paddle(**other)
    return zw.Log.from_arrays(time=time, position=position, hand_force=force, resolution=STEP, motion=motion)


@pytest.fixture(scope="module")
def found() -> Identified:
    return zw.identify(log_of())


def test_the_numbers_are_those_of_the_device(found):
    for name, truth in (("mass", MASS), ("damping", DAMPING), ("coulomb_friction", COULOMB)):
        low, high = found.estimates[name].interval(0.999)
        assert low < truth < high
        assert high - low < 0.2 * truth


def test_a_log_a_file_and_a_dataset_give_the_same(found, tmp_path):
    time, position, force = paddle()
    counts = np.rint(position / STEP)
    path = tmp_path / "session.csv"
    rows = np.stack([time, counts, force], axis=1)
    np.savetxt(path, rows, delimiter=",", header="t_s,enc,F1_N", comments="", fmt="%.9g")
    names = {"position": "enc", "hand_force": "F1_N"}
    of_file = zw.identify(path, columns=names, units={"position": "counts"}, resolution="22.4 um")
    columns = {"time": (time, "s"), "position": (position, "m"), "hand_force": (force, "N")}
    data = xr.Dataset({name: ("time", values, {"units": unit}) for name, (values, unit) in columns.items()})
    of_dataset = zw.identify(data, resolution=STEP)
    for name, estimate in found.estimates.items():
        assert of_file.estimates[name].value == pytest.approx(estimate.value, rel=1e-6)
        assert of_dataset.estimates[name].value == pytest.approx(estimate.value, rel=1e-9)
    assert str(path) == of_file.source


def test_a_position_off_by_1000_is_refused():
    time, position, force = paddle()
    log = zw.Log.from_arrays(time=time, position=1e3 * position, hand_force=force, resolution=1e3 * STEP)
    with pytest.raises(zw.InputError, match=r'no hand does: .*"mm"'):
        zw.identify(log)


def test_a_mass_may_carry_a_unit():
    log = log_of()
    with_unit, plain = zw.identify(log, mass="35.7 g"), zw.identify(log, mass=0.0357)
    assert with_unit.mass == plain.mass == 0.0357
    assert with_unit.estimates == plain.estimates
    assert "as given" in repr(plain)
    with pytest.raises(zw.InputError, match="mass is in kg"):
        zw.identify(log, mass="36 mm")
    with pytest.raises(zw.InputError, match="read already; units"):
        zw.identify(log, units={"position": "mm"})


def test_progress_ends_with_every_sample():
    told: list[tuple[int, int]] = []
    zw.identify(log_of(), progress=lambda done, total: told.append((done, total)))
    assert told[-1] == (20_000, 20_000)
    assert [done for done, _ in told] == sorted(done for done, _ in told)


def test_the_table_shows_every_number(found):
    text, html = repr(found), found._repr_html_()
    for part in ("best guess", "95 %", "m ", "b ", "f_c", "2b/T", "2f_c/Δ", "N·s/m", "strokes", "r² ="):
        assert part in text
    for part in ("<table>", "2b/T", "Coulomb friction", "<li>"):
        assert part in html
    assert f"{found.estimates['damping'].value:.4g}" in text
    assert all(str(finding) in text for finding in found.findings)
    assert max(len(line) for line in text.splitlines() if not line.startswith("·")) < 150


def test_a_saved_device_is_read_back(found, tmp_path):
    path = tmp_path / "mine.toml"
    found.save(path, 0.97, delay="0.0003")
    read = load([path], {"stiffness": "100"}).device
    own = found.device(0.97, delay="0.0003")
    for name in ("mass", "damping", "coulomb_friction"):
        there, here = getattr(read, name), getattr(own, name)
        assert there.low.fraction <= here.low.fraction < here.high.fraction <= there.high.fraction
        assert float(there.low) == pytest.approx(float(here.low), rel=1e-4)
        assert float(there.high) == pytest.approx(float(here.high), rel=1e-4)
    for name in ("sample_period", "resolution", "delay"):
        assert getattr(read, name) == getattr(own, name)
    assert read.delay.fraction == Fraction(3, 10_000)


def test_every_number_of_a_saved_device_says_where_it_comes_from(found):
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


def test_names_are_text_and_never_markup_or_toml(found):
    odd = dataclasses.replace(found, source='<b>a "b"\\\n[device]\n.csv')
    assert "<b>" in repr(odd)
    assert "<b>" not in odd._repr_html_()
    device = tomllib.loads(odd.to_toml())["device"]
    assert device["name"] == 'identified from <b>a "b"\\?[device]?.csv'
    assert tomllib.loads(found.to_toml(name='my "wheel"\x7f'))["device"]["name"] == 'my "wheel"?'


def test_a_file_is_not_replaced_unasked(found, tmp_path):
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


def test_a_rotary_device_is_saved_as_one(tmp_path):
    found = zw.identify(log_of("rotary"))
    assert "inertia" in [row.name for row in rows(found)]
    found.save(tmp_path / "wheel.toml")
    read = load([tmp_path / "wheel.toml"], {"stiffness": "1"}).device
    assert read.motion == "rotary"
    assert float(read.mass.low) < MASS < float(read.mass.high)
    assert "N·m/rad" in repr(found)
    assert "damping_N_m_s_per_rad" in found.to_dict()


def test_an_inertia_that_may_be_nothing_is_left_out(found):
    """No device has mass 0; nothing that is proved depends on it."""
    wide = Estimate(0.02, 0.05, 0.0, 100, "kg")
    vague = dataclasses.replace(found, estimates={**found.estimates, "mass": wide})
    assert vague.device(0.99).mass is None
    assert "mass" not in vague.to_toml()
    assert found.device(0.99).mass is not None


def test_the_curve_lies_below_the_friction_of_the_device(found):
    """Bounds below the truth by a few per cent; the model below them proves nearly as stiff a wall."""
    curve = found.friction_curve(0.95)
    for speed, force in zip(curve.speeds, curve.forces, strict=True):
        truth = COULOMB + DAMPING * float(speed)
        assert 0.85 * truth < float(force) < truth
    best = curve.best(PERIOD, STEP)
    assert 0.7 * DAMPING < float(best.damping) < DAMPING


def test_friction_that_bends_is_bounded_below():
    """f_c + b v + c v²: the bounds follow the bend, and no model of them is above it."""
    bent = 0.25
    found = zw.identify(log_of(quadratic=bent))
    curve = found.friction_curve(0.95)
    for speed, force in zip(curve.speeds, curve.forces, strict=True):
        v = float(speed)
        spread = bent * v**2  # a mean over a bin is above the curve at its mean speed, by c var(v)
        assert 0.9 * (COULOMB + DAMPING * v + spread) < float(force)
        assert float(force) < COULOMB + DAMPING * v + 1.1 * spread + 1e-3
    assert float(curve.largest_damping) > DAMPING


def test_the_errors_of_the_bins_are_those_of_the_strokes(found):
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


def test_all_bounds_share_the_risk(found):
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
def test_no_curve_without_confidence_or_bins(found, confidence, bins):
    with pytest.raises(zw.InputError, match=r"confidence must be|two bins"):
        found.friction_curve(confidence, bins)


def test_the_limits_are_those_of_the_parameters(found):
    by_damping, by_friction = limits(found)
    assert by_damping.value == pytest.approx(2 * found.estimates["damping"].value / PERIOD, rel=1e-12)
    low, high = found.least_coulomb_friction(0.9), found.estimates["coulomb_friction"].interval(0.9)[1]
    assert by_friction.interval(0.9) == pytest.approx((2 * low / STEP, 2 * high / STEP), rel=1e-12)
    assert 0.85 * COULOMB < low < found.estimates["coulomb_friction"].interval(0.9)[0]


def test_the_check_is_at_the_limit_that_is_shown(found):
    low, _ = limits(found)[0].interval(0.99)
    assert low == pytest.approx(2 * found.least_damping(0.99) / PERIOD, rel=1e-12)
    device = found.device(0.99)
    assert zw.check(device, zw.Wall(stiffness=0.9999 * low)).outcome == "passive"
    assert zw.check(device, zw.Wall(stiffness=1.0001 * low)).outcome != "passive"
    assert found.confidence(zw.Wall(stiffness=low)) == pytest.approx(0.99, abs=3e-4)
    assert found.confidence(zw.Wall(stiffness=0.7 * low)) > 0.9999
    assert found.confidence(zw.Wall(stiffness=1.4 * low)) == 0.0


def test_units_are_written_as_everywhere(found):
    said = " ".join([*(one.text for one in found.findings), str(found.estimates["damping"])])
    assert said.count("N·s/m") == 2
    assert "N s/m" not in said


def test_advice_says_how_much_longer(found):
    """The scatter falls as one over the root of the duration, the shift does not."""

    def told(error: float, shift: float) -> str:
        estimate = Estimate(0.15, error, shift, 10**6, "N*s/m")
        return " ".join(
            advice(dataclasses.replace(found, estimates={**found.estimates, "damping": estimate}), 0.99)
        )

    assert "damping limits the wall" in told(0.001, 0.0)
    assert "a log 4 times as long would halve" in told(0.001, 0.0)
    reach = float(stats.norm.ppf(0.995)) * 0.001
    assert "a log 9 times as long" in told(0.001, reach / 3)
    assert "a longer log would not halve" in told(0.001, 1.01 * reach)
    coarse = dataclasses.replace(found, resolution=2e-3)
    assert advice(coarse, 0.99)[0].startswith("Coulomb friction limits the wall: 2f_c/Δ ≥")


def test_the_wrong_model_is_said_everywhere():
    found = zw.identify(log_of(), model="viscous")
    assert "wrong model" in repr(found)
    assert advice(found, 0.99) == (
        "fit Coulomb friction too: these numbers are of another model than the device",
    )


def test_the_document_is_json(found):
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
def test_a_confidence_is_never_rounded_up(confidence, text):
    assert percent(confidence) == text


def test_four_pictures_and_the_numbers(found):
    figure = identification_figure(found)
    friction, numbers, data, left, _ = figure.axes
    assert friction.get_xlabel() == "velocity v, into the wall on the right [m/s]"
    assert friction.get_ylabel() == "friction [N]"
    assert (data.get_ylabel(), left.get_ylabel()) == ("force [N]", "left over [N]")
    words = " ".join(text.get_text() for text in numbers.texts)
    assert f"{found.estimates['damping'].value:.4g} N·s/m" in words
    labels = " ".join(text.get_text() for text in friction.get_legend().get_texts())
    never = "never: nothing is promised"
    for part in ("fit, 95 % band", "mass–damper model", "promised, up to", "means", never):
        assert part in labels
    line = next(li for li in friction.get_lines() if str(li.get_label()).startswith("fit"))
    drawn = np.polyfit(line.get_xdata(), line.get_ydata(), 1)
    fit = [found.estimates[name].value for name in ("damping", "coulomb_friction")]
    assert drawn == pytest.approx(fit, rel=1e-9)


def test_a_given_mass_and_another_model_are_drawn_too():
    """The force less m a in the place of the force; no mass–damper line beside a mass–damper fit."""
    log = log_of("rotary")
    given = identification_figure(zw.identify(log, mass=0.0357))
    assert given.axes[2].get_ylabel() == "force less m a [N·m]"
    assert given.axes[0].get_xlabel() == "velocity v, into the wall on the right [rad/s]"
    labels = identification_figure(zw.identify(log, model="viscous")).axes[0].get_legend().get_texts()
    assert not [text for text in labels if "mass–damper" in text.get_text()]


def test_the_expected_scatter_is_that_of_what_is_left(found):
    """Noise of the load cell and counts of the encoder, known here, make up what is left over."""
    counts, noise = expected_scatter(found)
    assert found.force_noise == pytest.approx(NOISE, rel=0.05)
    assert float(np.hypot(counts, noise)) == pytest.approx(float(found.points["residual"].std()), rel=0.15)


def test_the_force_of_counts_by_another_road(found):
    """A resting device whose encoder reads counts at random: m times the second difference of its means."""
    piece = round(found.pulse_length / PERIOD / PIECES)
    random = np.random.default_rng(2)
    bend = pulse(piece).bend / (piece * (piece * PERIOD) ** 2)
    position = STEP * (random.random((20_000, bend.size)) - 0.5)
    force = found.estimates["mass"].value * position @ bend
    assert expected_scatter(found)[0] == pytest.approx(float(force.std()), rel=0.03)


@pytest.mark.parametrize("ending", ["png", "svg", "pdf"])
def test_a_picture_is_saved_and_not_replaced_unasked(found, ending, tmp_path):
    path = tmp_path / f"fig.{ending}"
    path.touch()
    with pytest.raises(zw.InputError, match="exists; choose another name"):
        found.plot(path)
    assert not path.stat().st_size
    path = path if ending == "png" else tmp_path / f"new.{ending}"
    found.plot(path, force=ending == "png")
    assert path.stat().st_size > 5000


@pytest.mark.parametrize(
    ("part", "name", "words"),
    [
        ("estimates", "damping", "it is known only to"),
        ("directions", "outward", "that out of the wall is known only to"),
        ("slopes", "inward", "the slope of friction at 0.479 m/s into the wall is known only to -0.1"),
    ],
)
def test_what_may_be_none_is_named_with_the_reason(found, part, name, words, capsys):
    """The lowest end decides: of the damping, of one direction, of the slope at the largest speed."""
    loose = Estimate(0.1, 0.0, 0.2, 10**6, "N*s/m")
    own = getattr(found, part)
    changed = {**own, name: loose} if isinstance(own, dict) else own._replace(**{name: loose})
    poor = dataclasses.replace(found, **{part: changed})
    assert perhaps_zero(found, 0.99) == {}
    why = perhaps_zero(poor, 0.99)
    assert re.search(words, why["damping"])
    assert any(why["damping"] in line for line in advice(poor, 0.99))
    assert f"# damping may be 0: {why['damping']}." in poor.to_toml(confidence=0.99)
    print_identified(Identification(log_of(), poor, 0.99, {}, None, None, None))
    shown = " ".join(capsys.readouterr().out.split())
    assert "The data allow no spring wall at 99 % confidence: damping may be 0." in shown
    assert f"damping may be 0 for a wall: {words.partition('.')[0]}" in shown
    assert "may be 0" not in shown.partition("to know it better")[2]
