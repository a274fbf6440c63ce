"""Two arms under their tab: their own sliders, verdict and picture."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from bokeh.models import ColumnDataSource, Range1d

from zwidth.errors import InputError
from zwidth.model.specification.load import KEYS, pair_of
from zwidth.passivity.pairs import PairVerdict, check_pair
from zwidth.quantity.text import in_words
from zwidth.show.explorer import computing
from zwidth.show.explorer.computing import COUPLING_KEYS, pair_tables
from zwidth.show.explorer.controls import Control, number_control
from zwidth.show.explorer.form import Event, Form, group, shown, words
from zwidth.show.explorer.pictures import GREEN, RED, new_figure
from zwidth.show.explorer.state import State, usual
from zwidth.show.explorer.view import WAITING, Asked, View, given, headline, said, wide
from zwidth.show.explorer.working import Answer
from zwidth.show.plots.style import drawn_in, scale
from zwidth.showing import Html, Lines, Table, element, join


class Arms:
    """Two arms: their own sliders, verdict and picture."""

    def __init__(self, page: Asked) -> None:
        self._page = page
        self.form, self._card = Form(sizing_mode="stretch_width"), words(element("p"), live=True)
        self._picture, self._caption = LinkPicture(), words(element("p"))
        self._controls: dict[str, Control] = {}
        parts = [self.form, self._card, wide(self._picture.figure), self._caption]
        self.view = View("arms", ARMS, parts, self._moved, self._released)
        page.listen(self.form, self.hear)

    def _moved(self) -> None:
        self._page.state = with_coupling(self._page.state)
        try:
            verdict = pair_verdict(self._page.state)
        except InputError as error:
            said(self._card, str(error))
            return
        made = coupling_controls(verdict)
        if {one.path for one in made} != set(self._controls):
            self._controls = {one.path: one for one in made}
            self.form.draw([group("Spring and link between two of this device", map(shown, made))])
        self._card.html = str(pair_card(verdict, None))

    def hear(self, event: Event) -> Mapping[str, Any]:
        if event.get("kind") == "release":
            self._released()
            return {}
        control, value = given(self._controls, event)
        changed = self._page.state.changed(control.path, value)
        verdict = pair_verdict(changed)
        told = self._page.keep(changed)
        self._card.html = str(pair_card(verdict, None))
        fresh = {one.path: one for one in coupling_controls(verdict)}[control.path]
        if event.get("kind") != "move":
            self._released()
        return {**told, "values": {control.path: [fresh.text, control.place_of(fresh)]}}

    def _released(self) -> None:
        said(self._caption, WAITING)
        self._page.compute("advice", computing.advised, self._advised)
        self._page.compute("link", computing.linked, self._come)

    def _advised(self, answer: Answer) -> None:
        try:
            verdict = pair_verdict(self._page.state)
        except InputError:
            return
        self._card.html = str(pair_card(verdict, answer.value or []))

    def _come(self, answer: Answer) -> None:
        if answer.value is None:
            self._picture.clear()
            said(self._caption, answer.message)
            return
        said(self._caption, self._picture.show(answer.value, pair_verdict(self._page.state)))


ARMS = "Two arms"

_ARGUMENTS = {"link_delay": "there"}


def with_coupling(state: State) -> State:
    """With a spring and a link between two arms, where none is said yet."""
    if "stiffness" in state.extras.get("coupling", {}):
        return state
    unit = KEYS["stiffness"].unit_for(state.motion)
    return state.with_extra("coupling", {"stiffness": f"{usual(unit) / 2:g} {unit}", "link_delay": "2 ms"})


def pair_verdict(state: State) -> PairVerdict:
    return check_pair(pair_of(pair_tables(state)))


def coupling_controls(verdict: PairVerdict) -> tuple[Control, ...]:
    pair = verdict.pair
    found = []
    for key in COUPLING_KEYS:
        own = KEYS[key]._replace(required=key == "stiffness")
        value = getattr(pair, _ARGUMENTS.get(key, key))
        found.append(number_control(f"coupling.{key}", own, value, pair.motion, in_words(key, pair.motion)))
    return tuple(found)


def pair_card(verdict: PairVerdict, advice: Sequence[str] | None) -> Html:
    """Outcome, claim, what is required, what to change; `advice` None while it is looked for."""
    rows = Table(rows=list(verdict.rows())).html
    covers = Lines(verdict.small_print(), "What this covers").html
    if advice is None:
        said: Html = element("p", "Looking for what to change …", **{"class": "quiet"})
    else:
        said = join(element("h3", "Each of these alone"), Lines(advice).html) if advice else join()
    return join(headline(verdict), element("div", rows, **{"class": "numbers"}), said, covers)


class LinkPicture:
    """The largest passive stiffness against the delay of the link, and where the page is."""

    def __init__(self) -> None:
        self._stairs = ColumnDataSource({"left": [], "right": [], "top": []})
        self._here = ColumnDataSource({"delay": [], "stiffness": []})
        self._x, self._y = Range1d(0, 1), Range1d(0, 1)
        self.figure: Any = new_figure(
            "link delay, each way", "stiffness", height=300, x_range=self._x, y_range=self._y
        )
        self.figure.quad(
            left="left", right="right", top="top", bottom=0, source=self._stairs,
            fill_color=GREEN, fill_alpha=0.3, line_color=None,
        )  # fmt: skip
        self.figure.scatter("delay", "stiffness", source=self._here, size=12, color=RED)
        self.clear()

    def show(self, found: tuple[list[float], list[float]], verdict: PairVerdict) -> str:
        """Draw it; a sentence about what is seen."""
        delays, stiffness = found
        pair = verdict.pair
        here = float(pair.there), float(pair.felt_stiffness)
        factor, unit = scale([delays[-1]], "s")
        ends = [factor * delay for delay in delays]
        up, k_unit = drawn_in("stiffness", pair.motion)
        self._stairs.data = {"left": ends[:-1], "right": ends[1:], "top": [up * k for k in stiffness[1:]]}
        self._here.data = {"delay": [factor * here[0]], "stiffness": [up * here[1]]}
        self.figure.visible = True
        self._x.update(start=-0.02 * factor * delays[-1], end=factor * delays[-1])
        self._y.update(start=0, end=1.25 * up * max([*stiffness, here[1]]))
        self.figure.xaxis[0].axis_label = f"link delay, each way [{unit}]"
        self.figure.yaxis[0].axis_label = f"stiffness [{k_unit}]"
        return "Shaded: passive. A reading that is a sample older leaves less stiffness."

    def clear(self) -> None:
        self.figure.visible = False
