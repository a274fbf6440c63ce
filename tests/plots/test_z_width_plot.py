"""The picture of a Z-width map, read back from its artists."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.figure import Figure

import zwidth as zw
from zwidth.show import plots

PADDLE = zw.catalogue.device("haptic-paddle")
WITHOUT_END = zw.rendering.VelocityFilter([1, 0, 0], [1, "-0.5", "0.06"])
"""A velocity filter whose response does not end."""


def words(figure: Figure) -> list[str]:
    assert not any(axes.get_legend() for axes in figure.axes)
    (legend,) = figure.legends
    return [text.get_text() for text in legend.get_texts()]


def test_regions_curves_and_free_air() -> None:
    found = zw.z_width(PADDLE, (0, 30000), (0, 90), (900, 3000))
    figure = plots.z_width_figure(found)
    whole, near = figure.axes
    assert words(figure) == [
        "no hand up to 0.5 m/s gains", "passive with every hand",
        "no hand: stable below", "finger: stable below", "dowel: stable below",
    ]  # fmt: skip
    curves = [line for line in whole.lines if len(line.get_xdata())]
    assert (curves[0].get_ydata() == found["limit_none"].values).sum() > 2000
    assert whole.get_xlim() == pytest.approx((0, 90))
    assert near.get_xlim()[1] < 9
    assert any("0.036 kg" in text.get_text() for text in whole.texts)


def test_no_close_up_where_the_map_is_one() -> None:
    found = zw.z_width(PADDLE, (0, 300), (0, "0.15"), (40, 40))
    figure = plots.z_width_figure(found)
    (axes,) = figure.axes
    assert "finger: stable everywhere here" in words(figure)
    assert not [line for line in axes.lines if np.size(line.get_xdata())]


def test_a_close_up_needs_cells() -> None:
    found = zw.z_width(PADDLE, (0, 3000), (0, 5), (50, 50))
    assert found["passive"].any()
    assert len(plots.z_width_figure(found).axes) == 1


def test_speeds_are_written_on_their_contours() -> None:
    found = zw.z_width(PADDLE, (0, 3000), (0, 5), (300, 300))
    _, near = plots.z_width_figure(found).axes
    numbers = {text.get_text() for text in near.texts}
    assert "1 m/s" in numbers
    assert "10 m/s" not in numbers


def test_a_close_up_without_speeds_says_so() -> None:
    """With a filter without end none is known: what is passive while contact lasts is all."""
    found = zw.z_width(PADDLE, (0, 3000), (0, 5), (300, 300), velocity_filter=WITHOUT_END)
    _, near = plots.z_width_figure(found).axes
    assert near.get_title(loc="left") == "close-up of what is passive"
    assert not near.texts


def test_only_maps_are_drawn() -> None:
    with pytest.raises(zw.InputError, match="no Z-width map"):
        plots.z_width_figure(zw.maps.stability_boundary(PADDLE, points=5))


def test_what_is_not_covered_stands_in_the_legend() -> None:
    found = zw.z_width(PADDLE, (0, 300), (0, 1), (8, 8), hands={}, velocity_filter=WITHOUT_END)
    assert "passive with every hand: not covered" in words(plots.z_width_figure(found))
    found = zw.z_width(PADDLE, (400, 600), (0, 1), (8, 8), hands={"none": None})
    assert not any("not covered" in word for word in words(plots.z_width_figure(found)))
