"""What damping is asked for at each frequency, and what there is."""

from __future__ import annotations

from math import isfinite
from typing import Any

from bokeh.models import ColumnDataSource, Range1d
from bokeh.models import Span as Line
from numpy import array, full_like, maximum

from zwidth.passivity.linear_verdict import LinearVerdict
from zwidth.passivity.verdict import Verdict
from zwidth.quantity.text import in_unit
from zwidth.show.explorer.look import BLUE, GREY, RED, legend_above, new_figure
from zwidth.show.plots.criterion import damping_range, refined_curve
from zwidth.show.plots.style import drawn_in

NAME = "Criterion"


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
        self.figure.line(
            "frequency",
            "needed",
            source=self._curve,
            color=BLUE,
            line_width=2,
            legend_label="asked of the device",
        )
        self.figure.line(
            "frequency",
            "has",
            source=self._curve,
            color=GREY,
            line_width=2,
            line_dash="dashed",
            legend_label="device damping b",
        )
        self.figure.scatter("frequency", "needed", source=self._peak, size=9, color=RED)
        self.figure.add_layout(Line(location=0, dimension="width", line_color=GREY, line_alpha=0.5))
        legend_above(self.figure)

    def show(self, verdict: Verdict | None) -> str:
        """Draw it; a sentence about what is seen."""
        if not isinstance(verdict, LinearVerdict):
            self._curve.data = {"frequency": [], "needed": [], "lacking": [], "has": []}
            self._peak.data = {"frequency": [], "needed": []}
            return "This law has no H(z), so there is no criterion over frequency."
        frequencies, needs = refined_curve(verdict)
        has, motion = float(verdict.decision.loop.damping), verdict.device.motion
        low, high = damping_range(needs, has)
        factor, told = drawn_in("damping", motion)
        finite = [factor * (need if isfinite(need) else high) for need in needs]
        self._x.update(start=0, end=0.5 / float(verdict.decision.loop.period))
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
            f"Asked for at most: {in_unit(most, unit)}, at {in_unit(verdict.critical_frequency, 'Hz')}; "
            f"the device has {in_unit(has, unit)}."
        )
