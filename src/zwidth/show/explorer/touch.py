"""A touch as the simulator gives it: position, forces, and the energy that went in and came out."""

from __future__ import annotations

from typing import Any

from bokeh.models import BoxAnnotation, ColumnDataSource, DataRange1d

from zwidth.quantity.glossary import GLOSSARY
from zwidth.show.explorer.computing import Touch
from zwidth.show.explorer.look import BLUE, GREEN, GREY, ORANGE, RED, VIOLET, legend_above, new_figure
from zwidth.show.plots.style import number, scale

TOUCH, ENERGY = "Touch", "Energy"


class TouchPictures:
    """Position and forces over time; and, over the same time, the work of the hand as a filled area."""

    def __init__(self) -> None:
        self._source = ColumnDataSource()
        self.clear()
        time = DataRange1d(range_padding=0)
        self.position: Any = new_figure("time [s]", "position", x_range=time, height=230)
        self.position.add_layout(BoxAnnotation(bottom=0, fill_color=GREY, fill_alpha=0.15))
        self.position.line("time", "position", source=self._source, color=BLUE, line_width=2)
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
        for made in (self.force, self.energy):
            legend_above(made)

    def clear(self) -> None:
        """Nothing to draw."""
        columns = ("time", "position", "hand", "actuator", "in_", "out")
        self._source.data = {name: [] for name in columns}

    def show(self, touch: Touch, motion: str) -> tuple[str, str]:
        """Draw it; a sentence about each picture."""
        length, force = (GLOSSARY[name].unit_for(motion) for name in ("position", "force"))
        x, x_unit = scale(touch.positions, length)
        f, f_unit = scale([*touch.hand_forces, *touch.actuator_forces], force)
        w, w_unit = scale(touch.works, "J")
        self._source.data = {
            "time": touch.times,
            "position": [x * value for value in touch.positions],
            "hand": [f * value for value in touch.hand_forces],
            "actuator": [f * value for value in touch.actuator_forces],
            "in_": [w * max(value, 0.0) for value in touch.works],
            "out": [w * min(value, 0.0) for value in touch.works],
        }
        self.position.yaxis[0].axis_label = f"position [{x_unit}]"
        self.force.yaxis[0].axis_label = f"force [{f_unit}]"
        self.energy.yaxis[0].axis_label = f"work of the hand [{w_unit}]"
        peak, peak_unit = scale([touch.peak_force], force)
        most = f"{number(touch.peak_force * peak)} {peak_unit}"
        said = f"{touch.operator}. Shaded: inside the wall. Largest force {most}."
        out, unit = scale([touch.extracted], "J")
        if touch.extracted > 0:
            energy = f"The hand got out {number(touch.extracted * out)} {unit} more than it had put in."
        else:
            energy = "This hand got nothing out; another one may, and the verdict speaks of every hand."
        return said, energy
