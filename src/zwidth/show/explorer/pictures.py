"""Pictures on the page, on white and on black alike: criterion, plane, walls around this one, a touch."""

from __future__ import annotations

from math import isfinite
from typing import Any

from bokeh.models import (
    BoxAnnotation,
    ColumnDataSource,
    DataRange1d,
    HoverTool,
    Legend,
    LinearColorMapper,
    Range1d,
)
from bokeh.models import Span as Line
from bokeh.plotting import figure
from numpy import array, full_like, maximum

from zwidth.model.device import catalogue
from zwidth.passivity.formulas.diolaiti import plane_point
from zwidth.passivity.linear_verdict import LinearVerdict
from zwidth.passivity.verdict import Verdict
from zwidth.quantity.exact import Exact
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.text import in_words, shown
from zwidth.show.explorer.computing import Region, Touch
from zwidth.show.plots.linear import damping_range, refined_curve
from zwidth.show.plots.planes import (
    complete_devices,
    ends_around,
    has_plane,
    largest_spring_of,
    place_at_limit,
)
from zwidth.show.plots.style import drawn_in, number, scale

BLUE, ORANGE, GREEN, RED, VIOLET = "#3a7bd5", "#c9730a", "#2e9e6b", "#d64545", "#8e6bd1"
GREY = "#5d636c"
"""Of all that is no curve."""

_DARK = "@media (prefers-color-scheme: dark) { .bk-Canvas { filter: invert(1) hue-rotate(180deg); } }"
"""No grey can be read on white and on black: in the dark what is light and what is dark change places."""

HEIGHT = 330


def new_figure(x: str, y: str, *, height: int = HEIGHT, **options: Any) -> Any:
    """An empty picture as wide as there is room.

    `x`, `y`: what the axes say, with units.
    """
    made = figure(
        x_axis_label=x, y_axis_label=y, height=height, min_width=200, sizing_mode="stretch_width",
        tools="pan,box_zoom,reset,save", active_drag=None, stylesheets=[_DARK], outline_line_color=GREY,
        background_fill_alpha=0, border_fill_alpha=0, outline_line_alpha=0.4, **options,
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


CRITERION = "Criterion"


class CriterionPicture:
    """The curve of required damping, the device's own, and where the curve is highest."""

    def __init__(self) -> None:
        self._curve = ColumnDataSource({"frequency": [], "needed": [], "lacking": [], "has": []})
        self._peak = ColumnDataSource({"frequency": [], "needed": []})
        self._x, self._y = Range1d(0, 500), Range1d(0, 1)
        self.figure: Any = new_figure(
            "frequency of the hand [Hz]", "damping", x_range=self._x, y_range=self._y
        )
        self.figure.varea(
            "frequency",
            "has",
            "lacking",
            source=self._curve,
            color=RED,
            alpha=0.25,
            legend_label="too little",
        )
        for name, colour, dash, text in (
            ("needed", BLUE, "solid", "asked of the device"),
            ("has", GREY, "dashed", "device damping b"),
        ):
            self.figure.line(
                "frequency", name, source=self._curve, color=colour, line_width=2, line_dash=dash,
                legend_label=text,
            )  # fmt: skip
        self.figure.scatter("frequency", "needed", source=self._peak, size=9, color=RED)
        self.figure.add_layout(Line(location=0, dimension="width", line_color=GREY, line_alpha=0.5))
        legend_above(self.figure)

    def show(self, verdict: Verdict | None) -> str:
        """Draw it; a sentence about what is seen."""
        if not isinstance(verdict, LinearVerdict):
            self.figure.visible = False
            return "This law has no H(z), so there is no criterion over frequency."
        frequencies, needs = refined_curve(verdict)
        has, motion = float(verdict.decision.loop.damping), verdict.device.motion
        low, high = damping_range(needs, has)
        factor, told = drawn_in("damping", motion)
        finite = [factor * (need if isfinite(need) else high) for need in needs]
        self.figure.visible = True
        most = 0.5 / float(verdict.decision.loop.period)
        self._x.update(start=-0.02 * most, end=1.02 * most)  # no half of a dot at either end
        self._y.update(start=factor * low, end=factor * high)
        self.figure.yaxis[0].axis_label = f"damping [{told}]"
        needed = array(finite)  # arrays are sent as they are, lists number by number
        self._curve.data = {
            "frequency": array(frequencies),
            "needed": needed,
            "lacking": maximum(needed, factor * has),
            "has": full_like(needed, factor * has),
        }
        most = verdict.budget.required
        self._peak.data = {
            "frequency": [verdict.critical_frequency],
            "needed": [factor * (most if isfinite(most) else high)],
        }
        unit = verdict.device.unit("damping")
        return (
            f"Asked for at most: {shown(most, unit, 6)}, at {shown(verdict.critical_frequency, 'Hz', 6)}; "
            f"the device has {shown(has, unit, 6)}."
        )


PLANE = "Stability plane"

_NO_PLACE = (
    "The plane is of springs alone, B = 0, on a device with damping, Coulomb friction and resolution above 0 "
    "and without delay; this loop has no place in it."
)


class PlanePicture:
    """This loop's point, the line on which it moves with its stiffness, and the catalogue's devices."""

    def __init__(self) -> None:
        self._others = {d.name: place_at_limit(d) for d in complete_devices()}
        self._catalogue = _squares(len(self._others), len(catalogue.names()))
        texts = {
            d.name: f"{d.name} at {_stiffness(float(largest_spring_of(d)), d.motion)}"
            for d in complete_devices()
        }
        self._here = ColumnDataSource({"beta": [], "sigma": [], "colour": []})
        self._line = ColumnDataSource({"beta": [], "sigma": []})
        self._x, self._y = Range1d(0.05, 50), Range1d(0.05, 5000)
        self.figure: Any = new_figure(
            "β = b/(K T)  [1], damping against sampling", "σ = f_c/(K Δ)  [1], friction against encoder",
            height=400, x_axis_type="log", y_axis_type="log", x_range=self._x, y_range=self._y,
        )  # fmt: skip
        self.figure.add_layout(BoxAnnotation(left=0.5, bottom=0.5, fill_color=GREEN, fill_alpha=0.14))
        for dimension in ("height", "width"):
            self.figure.add_layout(Line(location=0.5, dimension=dimension, line_color=GREY))
        named = "this loop, were its wall stiffer or softer"
        self.figure.line("beta", "sigma", source=self._line, color=BLUE, line_width=2, legend_label=named)
        known = ColumnDataSource(
            {
                "beta": [place[0] for place in self._others.values()],
                "sigma": [place[1] for place in self._others.values()],
                "text": list(texts.values()),
            }
        )
        squares = self.figure.scatter(
            "beta", "sigma", source=known, marker="square", size=8, color=GREY, legend_label=", ".join(texts)
        )
        self.figure.scatter("beta", "sigma", source=self._here, size=13, color="colour")
        legend_above(self.figure, columns=1)
        self.figure.add_tools(HoverTool(renderers=[squares], tooltips=[("", "@text")]))

    def show(self, verdict: Verdict | None) -> str:
        """Draw it; a sentence about what is seen."""
        if not _has_place(verdict):
            self._here.data = {"beta": [], "sigma": [], "colour": []}
            self._line.data = {"beta": [], "sigma": []}
            return f"{_NO_PLACE} {self._catalogue}"
        assert isinstance(verdict, LinearVerdict)
        device, stiffness = verdict.device, verdict.decision.loop.static_stiffness
        assert stiffness is not None
        point = plane_point(device, Exact(stiffness))
        beta, sigma = float(point.viscous), float(point.dry)
        x = ends_around(beta, *(place[0] for place in self._others.values()))
        y = ends_around(sigma, *(place[1] for place in self._others.values()))
        self._x.update(start=x[0], end=x[1])
        self._y.update(start=y[0], end=y[1])
        shares = (max(x[0] / beta, y[0] / sigma), min(x[1] / beta, y[1] / sigma))
        self._line.data = {"beta": [beta * s for s in shares], "sigma": [sigma * s for s in shares]}
        passive = point.region == "globally stable"
        self._here.data = {"beta": [beta], "sigma": [sigma], "colour": [GREEN if passive else RED]}
        return (
            f"This loop, K = {_stiffness(float(stiffness), device.motion)}, is at β = {number(beta)}, "
            f"σ = {number(sigma)}: {point.region}. Green, both at least ½: "
            f"passive. A stiffer wall lies further down and to the left. {self._catalogue}"
        )


def _squares(placed: int, known: int) -> str:
    """What the squares are, and how many devices have none."""
    return (
        f"Squares: {placed} of the {known} devices of the catalogue, at the largest passive stiffness; the "
        f"other {known - placed} have no place, since their damping, Coulomb friction, resolution or rate is "
        "not published."
    )


def _stiffness(value: float, motion: str) -> str:
    factor, unit = drawn_in("stiffness", motion)
    return f"{number(value * factor)} {unit}"


def _has_place(verdict: Verdict | None) -> bool:
    if not isinstance(verdict, LinearVerdict) or not verdict.device.is_certain:
        return False
    loop = verdict.decision.loop
    return bool(verdict.decision.is_spring and has_plane(verdict.device) and loop.numerator[0])


Z_WIDTH = "Z-width"

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
        self.clear()

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
        self.figure.visible = True
        self._x.update(start=-0.02 * across * region.most_damping, end=across * region.most_damping)
        self._y.update(start=-0.02 * up * region.stiffest, end=up * region.stiffest)
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
        self.figure.visible = False


TOUCH, ENERGY = "Touch", "Energy"


class TouchPictures:
    """Position and forces over time; and, over the same time, the work of the hand as a filled area."""

    def __init__(self) -> None:
        columns = ("time", "position", "inside", "hand", "actuator", "in_", "out")
        self._source = ColumnDataSource({name: [] for name in columns})
        time = DataRange1d(range_padding=0)
        self.position: Any = new_figure("time [s]", "position", x_range=time, height=230)
        self.position.y_range.only_visible = True  # of a lock far from 0 there is no shade from 0 on
        self.position.line(
            "time", "position", source=self._source, color=BLUE, line_width=2, legend_label="handle"
        )
        self._inside = self.position.varea(
            "time", 0, "inside", source=self._source, color=BLUE, alpha=0.25, legend_label="inside the wall"
        )
        self.force: Any = new_figure("time [s]", "force", x_range=time, height=250)
        self.force.line("time", "hand", source=self._source, color=ORANGE, legend_label="hand, into the wall")
        self.force.line(
            "time", "actuator", source=self._source, color=VIOLET, legend_label="actuator, out of it"
        )
        self.energy: Any = new_figure("time [s]", "energy", x_range=time, height=300)
        self.energy.varea(
            "time", 0, "in_", source=self._source, color=GREEN, alpha=0.5, legend_label="put in by the hand"
        )
        self.energy.varea(
            "time", 0, "out", source=self._source, color=RED, alpha=0.6, legend_label="got out by the hand"
        )
        for made in self._all:
            legend_above(made)
        self.clear()

    @property
    def _all(self) -> tuple[Any, ...]:
        return self.position, self.force, self.energy

    def clear(self) -> None:
        for made in self._all:
            made.visible = False

    def show(self, touch: Touch, motion: str) -> tuple[str, str]:
        """Draw it; a sentence about each picture."""
        length, force = (GLOSSARY[name].unit_for(motion) for name in ("position", "force"))
        x, x_unit = scale(touch.positions, length)
        f, f_unit = scale([*touch.hand_forces, *touch.actuator_forces], force)
        w, w_unit = scale(touch.works, "J")
        self._source.data = {
            "time": touch.times,
            "position": [x * value for value in touch.positions],
            "inside": [x * max(value, 0.0) for value in touch.positions],
            "hand": [f * value for value in touch.hand_forces],
            "actuator": [f * value for value in touch.actuator_forces],
            "in_": [w * max(value, 0.0) for value in touch.works],
            "out": [w * min(value, 0.0) for value in touch.works],
        }
        for made in self._all:
            made.visible = True
        self._inside.visible = self.position.legend[0].items[1].visible = touch.one_sided
        self.position.yaxis[0].axis_label = f"{in_words('position', motion)} [{x_unit}]"
        self.force.yaxis[0].axis_label = f"{in_words('force', motion)} [{f_unit}]"
        self.energy.yaxis[0].axis_label = f"work of the hand [{w_unit}]"
        peak, peak_unit = scale([touch.peak_force], force)
        most = f"{number(touch.peak_force * peak)} {peak_unit}"
        said = f"{touch.operator}. Largest {in_words('force', motion)} {most}."
        out, unit = scale([touch.extracted], "J")
        if touch.extracted > 0:
            energy = f"The hand got out {number(touch.extracted * out)} {unit} more than it had put in."
        else:
            energy = "This hand got nothing out; another one may, and the verdict speaks of every hand."
        return said, energy
