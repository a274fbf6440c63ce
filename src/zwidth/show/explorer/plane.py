"""The plane of a spring wall, β = b/(K T) against σ = f_c/(K Δ): passive at and beyond ½ on both axes."""

from __future__ import annotations

from typing import Any

from bokeh.models import BoxAnnotation, ColumnDataSource, HoverTool, LabelSet, Range1d
from bokeh.models import Span as Line

from zwidth.model.device import catalogue
from zwidth.passivity.formulas.diolaiti import plane_point
from zwidth.passivity.linear_verdict import LinearVerdict
from zwidth.passivity.verdict import Verdict
from zwidth.quantity.exact import Exact
from zwidth.show.explorer.look import BLUE, GREEN, GREY, RED, new_figure
from zwidth.show.plots.plane import (
    complete_devices,
    ends_around,
    has_plane,
    largest_spring_of,
    place_at_limit,
)
from zwidth.show.plots.style import drawn_in, number

NAME = "Stability plane"

_NO_PLACE = (
    "The plane is of springs alone, B = 0, on a device with damping, Coulomb friction and resolution above 0 "
    "and without delay; this loop has no place in it."
)


class PlanePicture:
    """This loop's point, the line on which it moves with its stiffness, and the catalogue's devices."""

    def __init__(self) -> None:
        self._others = {d.name: place_at_limit(d) for d in complete_devices()}
        self._catalogue = _of_the_catalogue(len(self._others), len(catalogue.names()))
        texts = {
            d.name: f"{d.name} at {_stiffness(float(largest_spring_of(d)), d.motion)}"
            for d in complete_devices()
        }
        self._here = ColumnDataSource({"beta": [], "sigma": [], "colour": [], "text": []})
        self._line = ColumnDataSource({"beta": [], "sigma": []})
        self._x, self._y = Range1d(0.05, 50), Range1d(0.05, 5000)
        self.figure: Any = new_figure(
            "β = b/(K T)  [1], damping against sampling", "σ = f_c/(K Δ)  [1], friction against encoder",
            height=400, x_axis_type="log", y_axis_type="log", x_range=self._x, y_range=self._y,
        )  # fmt: skip
        self.figure.add_layout(BoxAnnotation(left=0.5, bottom=0.5, fill_color=GREEN, fill_alpha=0.14))
        for dimension in ("height", "width"):
            self.figure.add_layout(Line(location=0.5, dimension=dimension, line_color=GREY))
        self.figure.line("beta", "sigma", source=self._line, color=BLUE, line_width=2)
        known = ColumnDataSource(
            {
                "beta": [place[0] for place in self._others.values()],
                "sigma": [place[1] for place in self._others.values()],
                "text": list(texts.values()),
                "name": list(texts),
            }
        )
        squares = self.figure.scatter("beta", "sigma", source=known, marker="square", size=8, color=GREY)
        self.figure.add_layout(_names(known, "name"))
        self.figure.scatter("beta", "sigma", source=self._here, size=13, color="colour")
        self.figure.add_layout(_names(self._here, "text"))
        self.figure.add_tools(HoverTool(renderers=[squares], tooltips=[("", "@text")]))

    def show(self, verdict: Verdict | None) -> str:
        """Draw it; a sentence about what is seen."""
        if not _has_place(verdict):
            self._here.data = {"beta": [], "sigma": [], "colour": [], "text": []}
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
        text = f"K = {_stiffness(float(stiffness), device.motion)}"
        colour = GREEN if passive else RED
        self._here.data = {"beta": [beta], "sigma": [sigma], "colour": [colour], "text": [text]}
        return (
            f"This loop is at β = {number(beta)}, σ = {number(sigma)}: {point.region}. Green, both at least "
            "½: passive. A stiffer wall lies further down and to the left. " + self._catalogue
        )


def _of_the_catalogue(placed: int, known: int) -> str:
    """What the squares are, and how many devices have none."""
    return (
        f"Squares: {placed} of the {known} devices of the catalogue, at the largest passive stiffness; the "
        f"other {known - placed} have no place, since their damping, Coulomb friction, resolution or rate is "
        "not published."
    )


def _stiffness(value: float, motion: str) -> str:
    factor, unit = drawn_in("stiffness", motion)
    return f"{number(value * factor)} {unit}"


def _names(source: ColumnDataSource, column: str) -> LabelSet:
    return LabelSet(
        x="beta", y="sigma", text=column, source=source, x_offset=8, y_offset=-16, text_color=GREY,
        text_font_size="12px",
    )  # fmt: skip


def _has_place(verdict: Verdict | None) -> bool:
    if not isinstance(verdict, LinearVerdict) or not verdict.device.is_certain:
        return False
    loop = verdict.decision.loop
    return bool(verdict.decision.is_spring and has_plane(verdict.device) and loop.numerator[0])
