"""The walls around this one, by stiffness and damping: which of them the device can render."""

from __future__ import annotations

from typing import Any

from bokeh.models import ColumnDataSource, LinearColorMapper, Range1d

from zwidth.show.explorer.computing import Region
from zwidth.show.explorer.look import BLUE, GREEN, GREY, ORANGE, RED, legend_above, new_figure
from zwidth.show.plots.style import drawn_in, number

NAME = "Z-width"

_CLEAR = "rgba(0,0,0,0)"


class RegionPicture:
    """Three regions, each within the next, and the wall of the page."""

    def __init__(self) -> None:
        self._image = ColumnDataSource({"kinds": [], "width": [], "height": []})
        self._here = ColumnDataSource({"damping": [], "stiffness": []})
        self._x, self._y = Range1d(0, 1), Range1d(0, 1)
        self.figure: Any = new_figure(
            "virtual damping B", "virtual stiffness K", height=380, x_range=self._x, y_range=self._y
        )
        colours = LinearColorMapper(palette=[_CLEAR, ORANGE, BLUE, GREEN], low=0, high=3)
        self.figure.image(
            "kinds", x=0, y=0, dw="width", dh="height", source=self._image, color_mapper=colours, alpha=0.6
        )
        for colour, text in (
            (GREEN, "passive"),
            (BLUE, "passive while contact is kept"),
            (ORANGE, "quiet hands gain nothing"),
        ):
            self.figure.scatter(
                [-1], [-1], marker="square", size=10, color=colour, alpha=0.6, legend_label=text
            )
        self.figure.scatter(
            "damping",
            "stiffness",
            source=self._here,
            size=12,
            color=RED,
            line_color=GREY,
            legend_label="this wall",
        )
        legend_above(self.figure, columns=1)

    def show(self, region: Region, damping: float, stiffness: float, motion: str) -> str:
        """Draw it; a sentence about what is seen."""
        import numpy as np

        (across, b_unit), (up, k_unit) = (drawn_in(name, motion) for name in ("virtual_damping", "stiffness"))
        self._image.data = {
            "kinds": [np.array(region.kinds, dtype=np.uint8)],
            "width": [across * region.most_damping],
            "height": [up * region.stiffest],
        }
        self._here.data = {"damping": [across * damping], "stiffness": [up * stiffness]}
        self._x.update(start=0, end=across * region.most_damping)
        self._y.update(start=0, end=up * region.stiffest)
        self.figure.xaxis[0].axis_label = f"virtual damping B [{b_unit}]"
        self.figure.yaxis[0].axis_label = f"virtual stiffness K [{k_unit}]"
        factor, unit = drawn_in("velocity", motion)
        said = (
            "Each cell stands for the wall at its middle. A quiet hand is slower than "
            f"{number(factor * region.speed)} {unit}."
        )
        return (
            f"{said} Not covered, contact made and broken: {region.not_covered}."
            if region.not_covered
            else said
        )

    def clear(self) -> None:
        """Nothing to draw."""
        self._image.data = {"kinds": [], "width": [], "height": []}
        self._here.data = {"damping": [], "stiffness": []}
