"""The motion that takes energy out: played back, and its position, force and energy over time."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import param
from bokeh.models import ColumnDataSource, DataRange1d

from zwidth.quantity.glossary import GLOSSARY
from zwidth.show.explorer.form import Told
from zwidth.show.explorer.look import BLUE, RED, VIOLET, new_figure
from zwidth.show.plots.style import number, scale

if TYPE_CHECKING:
    from zwidth.show.plots.replay import Replay

NAME = "Motion"

_HERE = Path(__file__).parent


class Player(Told):
    """The handle at the wall, with play, pause and step."""

    motion = param.Dict(default={})

    _esm = (_HERE / "player.js").read_text(encoding="utf-8")
    _stylesheets = [(_HERE / "player.css").read_text(encoding="utf-8")]  # noqa: RUF012  # as Panel has it


class MotionPictures:
    """The player, and two pictures over the same time."""

    def __init__(self) -> None:
        self.player = Player(sizing_mode="stretch_width")
        self._source = ColumnDataSource({"time": [], "position": [], "energy": []})
        self._steps = ColumnDataSource({"time": [], "force": []})
        time = DataRange1d(range_padding=0)
        self.position: Any = new_figure("time", "position", x_range=time, height=200)
        self.position.line("time", "position", source=self._source, color=BLUE, line_width=2)
        self.force: Any = new_figure("time", "force", x_range=time, height=200)
        self.force.step("time", "force", source=self._steps, color=VIOLET, line_width=2, mode="after")
        self.energy: Any = new_figure("time", "energy", x_range=time, height=200)
        self.energy.varea("time", 0, "energy", source=self._source, color=RED, alpha=0.4)
        self.energy.line("time", "energy", source=self._source, color=RED, line_width=2)

    def show(self, played: Replay, motion: str) -> str:
        """Draw it; a sentence about what is seen."""
        length, force = (GLOSSARY[name].unit_for(motion) for name in ("position", "force"))
        t, time = scale([played.times[-1] - played.times[0]], "s")
        x, x_unit = scale(played.positions, length)
        f, f_unit = scale(played.forces, force)
        w, w_unit = scale(played.energies, "J")
        times = [t * value for value in played.times]
        positions = [x * value for value in played.positions]
        energies = [w * value for value in played.energies]
        forces = [f * value for value in played.forces]
        self.player.motion = {
            "times": times, "positions": positions, "forces": forces, "energies": energies,
            "length": x_unit, "force": f_unit, "energy": w_unit, "time": time,
        }  # fmt: skip
        self._source.data = {"time": times, "position": positions, "energy": energies}
        self._steps.data = {"time": times, "force": [*forces, forces[-1]]}
        self.position.yaxis[0].axis_label = f"position [{x_unit}]"
        self.force.yaxis[0].axis_label = f"actuator [{f_unit}]"
        self.energy.yaxis[0].axis_label = f"energy out [{w_unit}]"
        for made in (self.position, self.force, self.energy):
            made.xaxis[0].axis_label = f"time [{time}]"
        shown = f"{played.caption[:1].upper()}{played.caption[1:]}"
        return f"{shown}: {number(energies[-1])} {w_unit} come out of what is shown."

    def clear(self) -> None:
        """Nothing to draw."""
        self.player.motion = {}
        self._source.data = {"time": [], "position": [], "energy": []}
        self._steps.data = {"time": [], "force": []}
