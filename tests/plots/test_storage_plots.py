"""Pictures of available storage, read back from their artists."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.axes import Axes

import zwidth as zw
import zwidth.show.plots as plots

PADDLE = zw.catalogue.device("haptic-paddle")
BOUNDS = {"penetration": "0.0005", "speed": "0.3"}


def _by_id(axes: Axes, name: str) -> list:
    return [a for a in axes.get_children() if a.get_gid() == name]


def test_storage_shows_the_waiting_hand_within_the_band():
    """The line is V for reading before = reading now; the band holds it, and a tick each count."""
    found = zw.available_storage(PADDLE, zw.Wall(700, 0.05), penetration="0.0003", speed="0.2")
    (axes,) = plots.storage(found).axes
    (line,) = _by_id(axes, "waiting")
    energy = found.available_storage().values
    drawn = np.asarray(line.get_ydata())
    assert drawn.min() >= 0
    assert drawn.max() <= axes.get_ylim()[1]
    factor = drawn.max() / energy[-1, -1]
    assert np.all(drawn >= factor * np.nanmin(energy, axis=0) * (1 - 1e-12))
    assert np.all(drawn <= factor * np.nanmax(energy, axis=0) * (1 + 1e-12))
    ticks = axes.xaxis.get_minorticklocs()
    assert ticks / 22.4 == pytest.approx(np.round(ticks / 22.4), abs=1e-9)
    assert len(ticks) >= 14  # 0.3 mm in counts
    assert "[µJ]" in axes.get_ylabel()


def test_an_active_loop_has_no_storage_to_draw():
    found = zw.available_storage(PADDLE, zw.Wall(1500, 0.05))
    with pytest.raises(zw.InputError, match="active"):
        plots.storage(found)


def test_cycle_shows_positions_edges_forces_and_the_joules():
    """Six rounds of two samples; the energy rises by the gain in each."""
    gain = zw.available_storage(PADDLE, zw.Wall(950, 0.05), **BOUNDS).witness
    above, middle, below = plots.cycle(gain).axes
    x = np.asarray(above.lines[0].get_ydata()) * 1e-6
    assert set(np.round(x, 12)) == set(np.round(gain.cycle, 12))
    assert len(_by_id(above, "edge")) >= (x.max() - x.min()) / 22.4e-6 - 1
    (stairs,) = middle.patches
    assert len(stairs.get_data().values) == len(x) - 1
    (energy,) = _by_id(below, "energy")
    out = np.asarray(energy.get_ydata())
    samples = len(gain.cycle) - 1
    rounds = (len(x) - 1) // samples
    factor = 1e6 if "µJ" in below.get_ylabel() else 1e3
    assert out[-1] == pytest.approx(rounds * gain.energy_per_cycle * factor, rel=1e-6)
    assert f"every round of {samples} samples" in above.get_title(loc="left")


def test_both_sides_of_a_limit_stand_beside_each_other():
    bracket = zw.limit(PADDLE, zw.Wall(100, 0.05), **BOUNDS)
    figure = plots.limit_figure(bracket)
    left, *right = figure.axes
    passive, active = (float(axes.get_title(loc="left").split()[0]) for axes in (left, right[0]))
    assert 0 <= bracket.proved_passive - passive < 0.1
    assert 0 <= active - bracket.proved_active < 0.1
    assert len(right) == 3


def test_a_closed_limit_shows_its_motion_alone():
    figure = plots.limit_figure(zw.limit(PADDLE, zw.Wall(100, 0.05)))
    assert len(figure.axes) == 3
    assert "every hand" in figure.get_suptitle()


def test_a_verdict_shows_what_the_game_found():
    active = zw.check(PADDLE.replace(coulomb_friction="0.002"), zw.Wall(150, 0.05, clamped=True))
    titles = [a.get_title(loc="left") for a in plots.check_figure(active).axes]
    assert any("out in every round" in t for t in titles)
    assert len(plots.witness(active).axes) == 3
    bounded = zw.check(PADDLE, zw.Wall(250, 0.05, clamped=True))
    titles = [a.get_title(loc="left") for a in plots.check_figure(bounded).axes]
    found = (
        bounded.available_storage
    )  # of slow hands a closed form may say as much, without a storage function
    drawn = found is not None and found.storage is not None
    assert any("never more than" in t for t in titles) is drawn


def test_a_rotary_cycle_is_in_radians():
    wheel = zw.Device(damping=0.01, coulomb_friction=0.001, resolution=0.001, rate=1000, motion="rotary")
    gain = zw.available_storage(wheel, zw.Wall(200, 0.001)).witness
    above, middle, _ = plots.cycle(gain).axes
    assert "rad]" in above.get_ylabel()
    assert "N·m]" in middle.get_ylabel()
