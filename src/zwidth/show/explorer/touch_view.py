"""The hand that touches: its sliders, and the pictures of what it meets."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from zwidth.model.operator import OPERATORS, ParametricOperator
from zwidth.quantity.parameter import parameters_of
from zwidth.quantity.text import in_words
from zwidth.show.explorer import computing, touch
from zwidth.show.explorer.controls import Control, number_control
from zwidth.show.explorer.form import Event, Form, choice, group, shown, words
from zwidth.show.explorer.state import State
from zwidth.show.explorer.verdict_card import WAITING
from zwidth.show.explorer.view import Asked, View, given, said, wide
from zwidth.show.explorer.working import Answer
from zwidth.showing import element


class Touches:
    """A touch and its energy: one hand, one simulation, two tabs."""

    def __init__(self, page: Asked) -> None:
        self._page, self._pictures = page, touch.TouchPictures()
        self._captions = [words(element("p")), words(element("p"))]
        self._controls: dict[str, Control] = {}
        self._drawn: tuple[object, ...] = ()
        self.form = Form(sizing_mode="stretch_width")
        pictures = self._pictures
        parts = [self.form, wide(pictures.position), wide(pictures.force), self._captions[0]]
        self.view = View("touch", touch.TOUCH, parts, self._follow, self._released)
        energy = [wide(pictures.energy), self._captions[1]]
        self.energy_view = View("energy", touch.ENERGY, energy, self._follow, self._released)
        self._draw(page.state)
        page.listen(self.form, self.hear)

    def _draw(self, state: State) -> None:
        self._drawn = _drawn_of(state)
        kind = computing.hand_kind_of(state)
        made = _controls(computing.operator_of(state), state.motion)
        self._controls = {one.path: one for one in made}
        holding = (name for name, one in OPERATORS.items() if one.motion in ("", state.motion))
        options = [(name, name.replace("-", " ")) for name in holding]
        self.form.groups = [group("Hand", [choice("operator", "kind", options, kind), *map(shown, made)])]

    def _follow(self) -> None:
        """Another device may have another hand, or its numbers other units."""
        if _drawn_of(self._page.state) != self._drawn:
            self._draw(self._page.state)

    def hear(self, event: Event) -> Mapping[str, Any]:
        """What is moved of the hand."""
        if event.get("kind") == "release":
            self._released()
            return {}
        if event.get("path") == "operator":
            return self._choose(str(event.get("value")))
        control, value = given(self._controls, event)
        changed = self._page.state.changed(control.path, value)
        fresh = {one.path: one for one in _controls(computing.operator_of(changed), changed.motion)}[
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


def _controls(hand: ParametricOperator, motion: str) -> list[Control]:
    """The numbers of a hand on sliders."""
    return [
        number_control(f"operator.{name}", own, getattr(hand, name), motion, in_words(name))
        for name, own in parameters_of(type(hand)).items()
        if own.is_number
    ]
