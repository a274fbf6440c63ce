"""The picture of an identified device."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from known_motion import NOISE, PERIOD, STEP, paddle

import zwidth as zw
from zwidth.show.plots.identified import expected_scatter, identification_figure


@pytest.fixture(scope="module")
def found() -> zw.identification.Identified:
    """The device of the recording."""
    time, position, force = paddle()
    return zw.identify(zw.Log.from_arrays(time=time, position=position, hand_force=force, resolution=STEP))


def test_four_pictures_and_the_numbers(found: zw.identification.Identified) -> None:
    """Friction, numbers, data, what is left; units on the axes."""
    figure = identification_figure(found)
    friction, numbers, data, left, _ = figure.axes
    assert friction.get_xlabel() == "velocity v, into the wall on the right [m/s]"
    assert friction.get_ylabel() == "friction [N]"
    assert (data.get_ylabel(), left.get_ylabel()) == ("force [N]", "left over [N]")
    words = " ".join(text.get_text() for text in numbers.texts)
    assert f"{found.estimates['damping'].value:.4g} N·s/m" in words
    labels = " ".join(text.get_text() for text in friction.get_legend().get_texts())
    for part in (
        "fit, 95 % band",
        "mass–damper model",
        "promised, up to",
        "means",
        "never: nothing is promised",
    ):
        assert part in labels


def test_the_line_that_is_drawn_is_the_fit(found: zw.identification.Identified) -> None:
    """f_c + b |v|, with the numbers of the table."""
    axes = identification_figure(found).axes[0]
    line = next(li for li in axes.get_lines() if str(li.get_label()).startswith("fit"))
    slope, start = np.polyfit(line.get_xdata(), line.get_ydata(), 1)
    assert slope == pytest.approx(found.estimates["damping"].value, rel=1e-9)
    assert start == pytest.approx(found.estimates["coulomb_friction"].value, rel=1e-9)


def test_a_given_mass_and_another_model_are_drawn_too(found: zw.identification.Identified) -> None:
    """The force less m a in the place of the force; no mass–damper line beside a mass–damper fit."""
    time, position, force = paddle()
    log = zw.Log.from_arrays(time=time, position=position, hand_force=force, resolution=STEP, motion="rotary")
    given = identification_figure(zw.identify(log, mass=0.0357))
    assert given.axes[2].get_ylabel() == "force less m a [N·m]"
    assert given.axes[0].get_xlabel() == "velocity v, into the wall on the right [rad/s]"
    labels = identification_figure(zw.identify(log, model="viscous")).axes[0].get_legend().get_texts()
    assert not [text for text in labels if "mass–damper" in text.get_text()]


def test_the_expected_scatter_is_that_of_what_is_left(found: zw.identification.Identified) -> None:
    """Noise of the load cell and counts of the encoder, known here, make up what is left over."""
    counts, noise = expected_scatter(found)
    assert found.force_noise == pytest.approx(NOISE, rel=0.05)
    assert float(np.hypot(counts, noise)) == pytest.approx(float(found.points["residual"].std()), rel=0.15)


def test_the_force_of_counts_by_another_road(found: zw.identification.Identified) -> None:
    """A resting device whose encoder reads counts at random: m times the second difference of its means."""
    from zwidth.data.identification.device.pulses import PIECES, pulse

    piece = round(found.pulse_length / PERIOD / PIECES)
    random = np.random.default_rng(2)
    bend = pulse(piece).bend / (piece * (piece * PERIOD) ** 2)
    position = STEP * (random.random((20_000, bend.size)) - 0.5)
    force = found.estimates["mass"].value * position @ bend
    assert expected_scatter(found)[0] == pytest.approx(float(force.std()), rel=0.03)


@pytest.mark.parametrize("ending", ["png", "svg", "pdf"])
def test_a_picture_is_saved(found: zw.identification.Identified, ending: str, tmp_path: Path) -> None:
    """Any of three kinds."""
    path = tmp_path / f"fig.{ending}"
    found.plot(path)
    assert path.stat().st_size > 5000


def test_a_picture_is_not_replaced(found: zw.identification.Identified, tmp_path: Path) -> None:
    """An old file only with force."""
    path = tmp_path / "fig.png"
    path.touch()
    with pytest.raises(zw.InputError, match="exists; choose another name"):
        found.plot(path)
    assert not path.stat().st_size
    found.plot(path, force=True)
    assert path.stat().st_size > 5000
