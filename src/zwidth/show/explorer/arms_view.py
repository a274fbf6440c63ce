"""Two arms under their tab: their own sliders, verdict and picture."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from zwidth.errors import InputError
from zwidth.show.explorer import arms, computing
from zwidth.show.explorer.controls import Control
from zwidth.show.explorer.form import Event, Form, group, shown, words
from zwidth.show.explorer.verdict_card import WAITING
from zwidth.show.explorer.view import Asked, View, given, said, wide
from zwidth.show.explorer.working import Answer
from zwidth.showing import element


class Arms:
    """Two arms: their own sliders, verdict and picture."""

    def __init__(self, page: Asked) -> None:
        self._page = page
        self.form, self._card = Form(sizing_mode="stretch_width"), words(element("p"), live=True)
        self._picture, self._caption = arms.LinkPicture(), words(element("p"))
        self._controls: dict[str, Control] = {}
        parts = [self.form, self._card, wide(self._picture.figure), self._caption]
        self.view = View("arms", arms.NAME, parts, self._moved, self._released)
        page.listen(self.form, self.hear)

    def _moved(self) -> None:
        """The device is another."""
        self._page.state = arms.with_coupling(self._page.state)
        try:
            verdict = arms.pair_verdict(self._page.state)
        except InputError as error:
            said(self._card, str(error))
            return
        made = arms.coupling_controls(verdict)
        if {one.path for one in made} != set(self._controls):
            self._controls = {one.path: one for one in made}
            self.form.groups = [group("Spring and link between two of this device", map(shown, made))]
        self._card.html = str(arms.pair_card(verdict, None))

    def hear(self, event: Event) -> Mapping[str, Any]:
        """What is moved of the coupling."""
        if event.get("kind") == "release":
            self._released()
            return {}
        control, value = given(self._controls, event)
        changed = self._page.state.changed(control.path, value)
        verdict = arms.pair_verdict(changed)
        told = self._page.keep(changed)
        self._card.html = str(arms.pair_card(verdict, None))
        fresh = {one.path: one for one in arms.coupling_controls(verdict)}[control.path]
        if event.get("kind") != "move":
            self._released()
        return {**told, "values": {control.path: [fresh.text, control.place_of(fresh)]}}

    def _released(self) -> None:
        said(self._caption, WAITING)
        self._page.compute("advice", computing.advised, self._advised)
        self._page.compute("link", computing.linked, self._come)

    def _advised(self, answer: Answer) -> None:
        try:
            verdict = arms.pair_verdict(self._page.state)
        except InputError:
            return
        self._card.html = str(arms.pair_card(verdict, answer.value or []))

    def _come(self, answer: Answer) -> None:
        if answer.value is None:
            self._picture.clear()
            said(self._caption, answer.message)
            return
        said(self._caption, self._picture.show(answer.value, arms.pair_verdict(self._page.state)))
