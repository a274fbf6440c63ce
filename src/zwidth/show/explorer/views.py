"""The pictures of a page: which there are, when each is drawn, and who computes what takes longer.

What is cheap follows every move; the rest is computed when a slider is let go, for the picture that is open.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import param
from bokeh.models import ColumnDataSource, DataRange1d

from zwidth.model.environment import Wall
from zwidth.model.operator import OPERATORS, ParametricOperator
from zwidth.passivity.scope import COLOUR
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.parameter import parameters_of
from zwidth.quantity.text import in_words
from zwidth.show.explorer import computing
from zwidth.show.explorer.arms import Arms
from zwidth.show.explorer.computing import Row
from zwidth.show.explorer.controls import Control, number_control
from zwidth.show.explorer.form import Event, Form, Told, choice, group, shown, words
from zwidth.show.explorer.pictures import (
    BLUE,
    CRITERION,
    ENERGY,
    PLANE,
    RED,
    TOUCH,
    VIOLET,
    Z_WIDTH,
    CriterionPicture,
    PlanePicture,
    RegionPicture,
    TouchPictures,
    new_figure,
)
from zwidth.show.explorer.state import State
from zwidth.show.explorer.view import WAITING, Asked, View, given, said, wide
from zwidth.show.explorer.working import Answer
from zwidth.show.plots.style import number, scale
from zwidth.showing import Html, element, join, row

if TYPE_CHECKING:
    from zwidth.show.plots.replay import Replay


def views_of(page: Asked) -> list[View]:
    touches = Touches(page)
    return [
        _cheap(page, "criterion", CRITERION, CriterionPicture()),
        _cheap(page, "plane", PLANE, PlanePicture()),
        _region(page),
        touches.view,
        touches.energy_view,
        _motion(page),
        _laws(page),
        Arms(page).view,
        play_view(page),
    ]


def _cheap(page: Asked, key: str, name: str, picture: Any) -> View:
    caption = words(element("p"))

    def moved() -> None:
        said(caption, picture.show(page.verdict))

    return View(key, name, [wide(picture.figure), caption], moved, lambda: None)


def _region(page: Asked) -> View:
    picture, caption = RegionPicture(), words(element("p"))

    def come(answer: Answer) -> None:
        wall = page.state.loop().environment
        if answer.value is None or not isinstance(wall, Wall):
            picture.clear()
            said(caption, answer.message)
            return
        here = abs(computing.middle(wall.damping)), computing.middle(wall.stiffness)
        said(caption, picture.show(answer.value, *here, page.state.motion))

    def released() -> None:
        said(caption, WAITING)
        page.compute("region", computing.region_of, come)

    return View("region", Z_WIDTH, [wide(picture.figure), caption], lambda: None, released)


def _motion(page: Asked) -> View:
    pictures, caption = MotionPictures(), words(element("p"))

    def come(answer: Answer) -> None:
        if answer.value is None:
            pictures.clear()
            said(caption, answer.message)
            return
        said(caption, pictures.show(answer.value, page.state.motion))

    def released() -> None:
        said(caption, WAITING)
        page.compute("motion", computing.moved, come)

    figures = [wide(one) for one in (pictures.position, pictures.force, pictures.energy)]
    return View("motion", MOTION, [caption, pictures.player, *figures], lambda: None, released)


def _laws(page: Asked) -> View:
    table = words(element("p"))

    def come(answer: Answer) -> None:
        if answer.value is None:
            said(table, answer.message)
        else:
            moves = page.state.motion
            hint = join() if page.state.laws else element("p", NONE)
            table.html = f"{compared_table(answer.value, moves)}{hint}"

    def released() -> None:
        said(table, WAITING)
        page.compute("laws", computing.compared, come)

    return View("laws", LAWS, [table], lambda: None, released)


MOTION = "Motion"

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
        self._all = self.position, self.force, self.energy
        self.clear()

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
        self.position.yaxis[0].axis_label = f"{in_words('position', motion)} [{x_unit}]"
        self.force.yaxis[0].axis_label = f"actuator [{f_unit}]"
        self.energy.yaxis[0].axis_label = f"energy out [{w_unit}]"
        for made in self._all:
            made.xaxis[0].axis_label = f"time [{time}]"
            made.visible = True
        shown = f"{played.caption[:1].upper()}{played.caption[1:]}"
        return f"{shown}: {number(energies[-1])} {w_unit} come out of what is shown."

    def clear(self) -> None:
        self.player.motion = {}
        for made in self._all:
            made.visible = False


LAWS = "Laws"

NONE = "Switch laws on under “Laws in the chain”; each acts on what the one before it gives."


def compared_table(rows: Sequence[Row], motion: str) -> Html:
    unit = GLOSSARY["force"].unit_for(motion)
    heads = ("chain", "outcome", "energy the hand got out", "largest force")
    body = (
        join(
            row((one.name, _marked(one), _amount(one.extracted, "J"), _amount(one.peak_force, unit))),
            element("tr", element("td", one.message or one.claim, colspan="4", **{"class": "quiet"})),
        )
        for one in rows
    )
    table = element("table", element("thead", row(heads, "th")), element("tbody", *body))
    return element("div", table, **{"class": "numbers"})


def _marked(one: Row) -> Html:
    if not one.outcome:
        return join("no verdict")
    return element(
        "b", one.outcome, style=f"border-left:0.5rem solid {COLOUR[one.outcome]};padding-left:0.4rem"
    )


def _amount(value: float | None, unit: str) -> str:
    if value is None:
        return ""
    factor, shown = scale([value], unit)
    return f"{number(max(value, 0.0) * factor)} {shown}"


PLAY = "Play"


class Frame(Told):
    """A page in a page, apart from it."""

    html = param.String(default="")

    _esm = """
export function render({ model }) {
  const root = document.createElement("div");
  const draw = () => {
    const frame = document.createElement("iframe"); // anew: of one that was hidden Chromium lays out nothing
    frame.title = "play with this loop";
    frame.setAttribute("sandbox", "allow-scripts allow-downloads");
    frame.srcdoc = model.html;
    root.replaceChildren(...(model.html ? [frame] : []));
  };
  window.addEventListener("message", ({ source, data }) => {
    const frame = root.firstChild;
    if (frame?.contentWindow === source) frame.style.height = `${Number(data)}px`;
  });
  model.on("html", draw);
  draw();
  return root;
}
"""
    _stylesheets = [  # noqa: RUF012  # as Panel has it
        ":host { display: block; width: 100%; }"
        "iframe { display: block; border: 0; width: 100%; height: 60rem; border-radius: 6px; }"
    ]


def play_view(page: Asked) -> View:
    frame: Any = Frame(sizing_mode="stretch_width")
    caption = words(element("p"))

    def come(answer: Answer) -> None:
        frame.html = answer.value or ""
        said(caption, answer.message)

    def released() -> None:
        said(caption, WAITING)
        page.compute("play", computing.played_page, come)

    return View("play", PLAY, [caption, frame], lambda: None, released)


class Touches:
    """A touch and its energy: one hand, one simulation, two tabs."""

    def __init__(self, page: Asked) -> None:
        self._page, self._pictures = page, TouchPictures()
        self._captions = [words(element("p")), words(element("p"))]
        self._controls: dict[str, Control] = {}
        self._drawn: tuple[object, ...] = ()
        self.form = Form(sizing_mode="stretch_width")
        pictures = self._pictures
        parts = [self.form, wide(pictures.position), wide(pictures.force), self._captions[0]]
        self.view = View("touch", TOUCH, parts, self._follow, self._released)
        energy = [wide(pictures.energy), self._captions[1]]
        self.energy_view = View("energy", ENERGY, energy, self._follow, self._released)
        self._draw(page.state)
        page.listen(self.form, self.hear)

    def _draw(self, state: State) -> None:
        self._drawn = _drawn_of(state)
        kind = computing.hand_kind_of(state)
        made = _controls_of(computing.operator_of(state), state.motion)
        self._controls = {one.path: one for one in made}
        holding = (name for name, one in OPERATORS.items() if one.motion in ("", state.motion))
        options = [(name, name.replace("-", " ")) for name in holding]
        self.form.draw([group("Hand", [choice("operator", "kind", options, kind), *map(shown, made)])])

    def _follow(self) -> None:
        """Another device may have another hand, or its numbers other units."""
        if _drawn_of(self._page.state) != self._drawn:
            self._draw(self._page.state)

    def hear(self, event: Event) -> Mapping[str, Any]:
        if event.get("kind") == "release":
            self._released()
            return {}
        if event.get("path") == "operator":
            return self._choose(str(event.get("value")))
        control, value = given(self._controls, event)
        changed = self._page.state.changed(control.path, value)
        fresh = {one.path: one for one in _controls_of(computing.operator_of(changed), changed.motion)}[
            control.path
        ]
        told = {**self._page.keep(changed), "values": {control.path: [fresh.text, control.place_of(fresh)]}}
        if event.get("kind") != "move":
            self._released()
        return told

    def _choose(self, kind: str) -> Mapping[str, Any]:
        """Another kind of hand, with its own numbers."""
        changed = self._page.state.with_extra("operator", {"type": kind})
        self._draw(changed)
        told = self._page.keep(changed)
        self._released()
        return told

    def _released(self) -> None:
        for caption in self._captions:
            said(caption, WAITING)
        self._page.compute("touch", computing.touched, self._come)

    def _come(self, answer: Answer) -> None:
        if answer.value is None:
            self._pictures.clear()
            for caption in self._captions:
                said(caption, answer.message)
            return
        texts = self._pictures.show(answer.value, self._page.state.motion)
        for caption, text in zip(self._captions, texts, strict=True):
            said(caption, text)


def _drawn_of(state: State) -> tuple[object, ...]:
    """What the sliders of the hand depend on, beside their own places."""
    return computing.hand_kind_of(state), state.motion, state.angles


def _controls_of(hand: ParametricOperator, motion: str) -> list[Control]:
    return [
        number_control(f"operator.{name}", own, getattr(hand, name), motion, in_words(name, motion))
        for name, own in parameters_of(type(hand)).items()
        if own.is_number
    ]
