"""Pictures of touches."""

from __future__ import annotations

import numpy as np
import pytest

import zwidth as zw
from zwidth.show.plots.traces import comparison_figure, thinned, trace_figure

PADDLE = zw.catalogue.device("haptic-paddle")


@pytest.mark.parametrize("hand", [zw.operators.Dowel(), zw.operators.Finger(), zw.operators.Guide()])
def test_a_trace_has_three_panels_with_units(hand, tmp_path) -> None:
    trace = zw.simulate(PADDLE, zw.Wall(500.0), hand, 0.2)
    figure = trace_figure(trace)
    above, middle, below = figure.axes
    assert "position x [" in above.get_ylabel()
    assert "force f [" in middle.get_ylabel()
    assert "energy W [" in below.get_ylabel()
    assert below.get_xlabel() == "time t [ms]"
    for suffix in ("png", "svg", "pdf"):
        trace.zwidth.plot(tmp_path / f"touch.{suffix}")
        assert (tmp_path / f"touch.{suffix}").stat().st_size > 5000


def test_an_active_touch_says_so_and_a_passive_one_does_not() -> None:
    active = zw.simulate(PADDLE, zw.Wall(770.0), zw.operators.Dowel(), 0.3)
    passive = zw.simulate(PADDLE, zw.Wall(300.0), zw.operators.Dowel(), 0.3)
    assert "active" in trace_figure(active).axes[2].get_title(loc="left")
    assert trace_figure(passive).axes[2].get_title(loc="left") == ""


def test_the_force_is_drawn_as_the_staircase_it_is() -> None:
    """Held until the next one: steps, not slopes."""
    trace = zw.simulate(PADDLE, zw.Wall(770.0), zw.operators.Dowel(), 0.1)
    lines = trace_figure(trace).axes[1].get_lines()
    actuator = next(line for line in lines if "actuator" in line.get_label())
    assert actuator.get_drawstyle() == "steps-post"


def test_a_long_trace_is_thinned_without_losing_its_peaks() -> None:
    x = np.arange(1_000_000.0)
    y = np.sin(x / 7.0)
    y[123_457] = 9.0
    y[765_431] = -8.0
    few_x, few_y = thinned(x, y)
    assert few_x.size < 5000
    assert few_y.max() == 9.0
    assert few_y.min() == -8.0
    assert (np.diff(few_x) > 0).all()


def test_several_traces_share_their_axes() -> None:
    traces = {str(k): zw.simulate(PADDLE, zw.Wall(k), zw.operators.Dowel(), 0.2) for k in (200.0, 500.0)}
    figure = comparison_figure(traces)
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["200.0", "500.0"]
    assert all(len(axes.get_lines()) == 3 for axes in figure.axes)
