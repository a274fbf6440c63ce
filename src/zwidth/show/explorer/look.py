"""How every picture on the page looks: it stands on white and on black alike."""

from __future__ import annotations

from typing import Any

from bokeh.models import DataRange1d, Legend
from bokeh.plotting import figure

BLUE, ORANGE, GREEN, RED, VIOLET = "#3a7bd5", "#c9730a", "#2e9e6b", "#d64545", "#8e6bd1"
GREY = "#757b84"
"""Of all that is no curve: can be read on white and on black."""

HEIGHT = 330


def new_figure(x: str, y: str, *, height: int = HEIGHT, **options: Any) -> Any:
    """An empty picture as wide as there is room.

    Parameters
    ----------
    x, y
        What the axes say, with units.
    height
        In pixels.
    options
        Of Bokeh's `figure`.
    """
    made = figure(
        x_axis_label=x, y_axis_label=y, height=height, min_width=200, sizing_mode="stretch_width",
        tools="pan,box_zoom,reset,save", active_drag=None, background_fill_alpha=0, border_fill_alpha=0,
        outline_line_color=GREY, outline_line_alpha=0.4, **options,
    )  # fmt: skip
    made.toolbar.logo = None
    made.toolbar.autohide = True
    for grid in made.grid:
        grid.grid_line_color, grid.grid_line_alpha = GREY, 0.2
    for axis in made.axis:
        axis.axis_label_text_color = axis.major_label_text_color = GREY
        axis.axis_label_text_font_style = "normal"
        axis.axis_label_text_font_size = axis.major_label_text_font_size = "13px"
        axis.axis_line_color = axis.major_tick_line_color = GREY
        axis.minor_tick_line_color = None
    return made


def legend_above(made: Any, columns: int = 2) -> None:
    """The names of the curves above them: beside or inside there is no room on a small screen."""
    legend: Legend = made.legend[0]
    legend.orientation, legend.location, legend.ncols = "horizontal", "left", columns
    legend.background_fill_alpha = legend.border_line_alpha = 0
    legend.label_text_color = GREY
    legend.label_text_font_size = "12px"
    legend.padding = legend.margin = 2
    legend.label_standoff, legend.glyph_width = 4, 12
    made.add_layout(legend, "above")


def own_range() -> DataRange1d:
    """A range of what is seen, with a little room."""
    return DataRange1d(only_visible=True, default_span=1e-6, range_padding=0.08)
