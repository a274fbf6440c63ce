"""One person's page: the loop it is at, what is shown of it, and what happens when something is moved.

Nothing here is shared with another page.  A move is answered at once with the outcome that the closed forms
know, a moment later with limit and advice, then with the picture; what takes longer is computed beside and
shown when it comes.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from itertools import count
from typing import Any

from zwidth.errors import InputError
from zwidth.model.rendering import LAWS
from zwidth.model.specification.environments import TYPES
from zwidth.model.specification.read import Specification
from zwidth.model.specification.table import plain
from zwidth.model.specification.write import written
from zwidth.passivity.verdict import Verdict
from zwidth.quantity.spoken import angles_in, answers_in
from zwidth.quantity.text import to_json
from zwidth.show.explorer import starts
from zwidth.show.explorer.computing import Judged, answered, judged_at_once, judged_in_full, reported
from zwidth.show.explorer.controls import Control
from zwidth.show.explorer.form import Event, Form, Soon, controls_of, groups_of, words
from zwidth.show.explorer.state import State, catalogued, from_file, lacking_of
from zwidth.show.explorer.view import WAITING, View, badge, details, given, head, not_measured
from zwidth.show.explorer.views import views_of
from zwidth.show.explorer.working import Answer, Workers
from zwidth.showing import element

_askers = count(1)

_NOW, _OLD = {"filter": "none"}, {"filter": "grayscale(1) opacity(0.75)"}
"""Of what is shown of this loop, and of the one before."""

_MORE = "The closed forms leave a gap: more is being worked out …"


class Session:
    """A page.

    `state`: the loop that it begins with.
    `workers`: who computes what takes longer.
    `soon`: has something done in the thread of the page.
    `message`: said at the top, such as what of the address could not be used.
    `in_page`: True where the page has an address that holds the loop, and tabs of its own.
    """

    def __init__(
        self, state: State, workers: Workers, soon: Soon, message: str = "", *, in_page: bool = True
    ) -> None:
        with answers_in(*state.angles):
            self._begin(state, workers, soon, message, in_page)

    def _begin(self, state: State, workers: Workers, soon: Soon, message: str, in_page: bool) -> None:
        self.state = state
        self.verdict: Verdict | None = None
        self._note = ""
        self._workers, self._soon, self._asker = workers, soon, next(_askers)
        self._controls: dict[str, Control] = {}
        self.form = Form(sizing_mode="stretch_width", views=in_page)
        self.head, self.details = words(element("p"), live=True), words(element("p"))
        self.badge = words(element("p"))
        loop = state.loop()
        self.views = views_of(self)
        self._open = self.views[0]
        self._draw_form(loop)
        self._show(judged_at_once(loop))
        self._follow()
        self.form.told = {
            "heard": 0,
            "error": message,
            "query": "" if message or not in_page else state.query(),
        }
        self.listen(self.form, self.hear)

    def close(self) -> None:
        """Nobody looks any more."""
        self._workers.forget(self._asker)

    # what the pictures ask for, see `view.Asked`

    def listen(self, form: Form, hear: Callable[[Event], Mapping[str, Any]]) -> None:
        """Have the events of a form answered."""

        def heard(event: Event) -> Mapping[str, Any]:
            with answers_in(*self.state.angles):
                return hear(event)

        form.listen(heard, self._soon, self._mark)

    def _mark(self) -> None:
        """Grey out what is shown of the loop before, while something that was typed is refused."""
        refused = bool(self.form.refused)
        for view in self.views:
            forms = [part for part in view.parts if isinstance(part, Form)]
            here = refused or any(form.refused for form in forms)
            for part in view.parts:
                part.styles = _OLD if here and part not in forms else _NOW
        for part in (self.head, self.details, self.badge):
            part.styles = _OLD if refused else _NOW
        self._say(self._note)

    def keep(self, state: State) -> Mapping[str, Any]:
        """Take another state whose loop is the same; what is told to the page."""
        self.state = state
        return {"error": "", "query": self._address}

    @property
    def _address(self) -> str:
        return self.state.query() if self.form.views else ""

    def compute(self, kind: str, work: Callable[..., Any], then: Callable[[Answer], None]) -> None:
        """Have something computed of the state beside the page; of an older state nothing is shown."""
        state = self.state

        def come(answer: Answer) -> None:
            self._later(state, lambda: then(answer))

        self._workers.submit(self._asker, kind, answered, (work, state), come)

    def _later(self, state: State, work: Callable[[], None]) -> None:
        """Have something done when what goes before has been sent; of an older state nothing is."""

        def done() -> None:
            if state is self.state:
                with answers_in(*state.angles):
                    work()

        self._soon(done)

    # what is moved

    def hear(self, event: Event) -> Mapping[str, Any]:
        kind, path, value = str(event.get("kind")), str(event.get("path")), event.get("value")
        if kind == "press":
            return self._file(path)
        if kind == "view":
            self.see(path)
            return {}
        if kind == "release":
            self._open.released()
        elif kind == "upload":
            self._upload(str(value), path)
        elif kind == "choose" and path in _CHOICES:
            self._become(_CHOICES[path](self.state, str(value)), redraw=True)
        elif kind == "choose" and path.startswith("with."):
            name = _known(path.removeprefix("with."), LAWS, "law")
            self._become(starts.with_law(self.state, name, value == "true"), redraw=True)
        else:
            return self._set(event)
        return {"error": "", "query": self._address}

    def _set(self, event: Event) -> Mapping[str, Any]:
        """One parameter, by its slider or as it was typed or chosen."""
        control, value = given(self._controls, event)
        state = self.state.changed(control.path, value).settled()
        if event.get("kind") != "move":
            state = state.with_angles(angles_in(value))
        with answers_in(*state.angles):
            self._become(state, redraw=state.angles != self.state.angles)
        now = self._controls.get(control.path, control)
        told = {"values": {control.path: [now.text, now.place]}, "error": ""}
        if event.get("kind") == "move":
            return told
        self._open.released()
        return {**told, "query": self._address}

    def _become(self, state: State, redraw: bool) -> None:
        """Another loop, if it is one: what cannot be used changes nothing."""
        loop = state.loop()
        judged = judged_at_once(loop)
        self.state = state
        kept = {one.path: _kept(one, self._controls) for one in controls_of(state, loop)}
        if redraw or kept.keys() != self._controls.keys():  # another velocity filter has other numbers
            self._draw_form(loop)
        else:
            self._controls = kept
        self._show(judged)
        self._later(state, self._follow)
        if redraw:
            self._open.released()

    def _draw_form(self, loop: Specification) -> None:
        made = [*controls_of(self.state, loop)]
        self._controls = {one.path: one for one in made}
        self.form.draw(groups_of(self.state, loop.device.name, made))

    def see(self, key: str) -> None:
        """Another picture is open."""
        found: View | None = next((view for view in self.views if view.key == key), None)
        if found is None:
            raise InputError(f"there is no picture {key[:60]!r}")
        if found is not self._open:
            self._open = found
            found.moved()
            found.released()

    # the verdict

    def _show(self, judged: Judged) -> None:
        """The outcome, and whether there is more to come."""
        self.verdict = judged.verdict
        if judged.final:
            self._say("")
            return
        self._say(WAITING if judged.verdict is None else _MORE)
        self.compute("verdict", judged_in_full, self._come)

    def _come(self, answer: Answer) -> None:
        if answer.value is not None:
            self.verdict = answer.value
        self._say(answer.message)
        self._follow()

    def _say(self, note: str) -> None:
        self._note = note
        refused = self._refused()
        old = [f"{refused} cannot be used as typed: the verdict below is that before"] if refused else []
        self.head.html = str(head(self.verdict, note, [*old, *not_measured(self.state.begun)]))

    def _refused(self) -> str:
        """Names of the controls that say what cannot be used."""
        labels = {path: one.label for path, one in self._controls.items()}
        return " and ".join(labels.get(path, path) for path in self.form.refused)

    def _follow(self) -> None:
        """Numbers, advice, scope and the line with the limit; a moment later the picture that is open."""
        self.details.html = str(details(self.verdict))
        self.badge.html = str(badge(self.verdict, self._note, self.state.begun))
        self._later(self.state, lambda: self._open.moved())

    # files

    def _upload(self, text: str, name: str) -> None:
        """The loop of a file, or its device; of one that cannot be used it is said what is still shown."""
        try:
            given = from_file(text, name, self.state)
            state = given.state
            if state is None:
                state = starts.with_device(self.state, given.device, given.begun)
            else:
                state = replace(state, extras={**self.state.extras, **state.extras}).with_begun(given.begun)
            with answers_in(*state.angles):
                self._become(state, redraw=True)
        except InputError as error:
            still = self.state.loop().device.name
            raise InputError(f"{error}. The page still shows {plain(still)}, not this file.") from None

    def _file(self, name: str) -> Mapping[str, Any]:
        """A file to keep; a report takes longer, and comes when it is done."""
        if self.form.refused:
            raise InputError(f"nothing is saved while {self._refused()} cannot be used as typed")
        loop = self.state.loop()
        if name == "toml":
            marks = "".join(f"# {line}\n" for line in not_measured(self.state.begun))
            text = f"{marks}{written(loop.device, loop.environment)}"
            return _download("loop.toml", "application/toml", text)
        unknown = not_measured(self.state.begun)
        if unknown:  # on the page it stands beside the verdict; a file would go about without it
            raise InputError(" ".join(unknown))
        if name == "report":
            self.compute("report", reported, self._reported)
            return {"error": "The report is being written …"}
        if name == "json" and self.verdict is not None:
            return _download("verdict.json", "application/json", to_json(_in_full(self.verdict)))
        raise InputError("there is nothing to download yet: the verdict is being worked out")

    def _reported(self, answer: Answer) -> None:
        told = (
            {"error": answer.message}
            if answer.value is None
            else _download("report.html", "text/html", answer.value)
        )
        self.form.told = {"heard": 0, **told}


def _download(name: str, kind: str, text: str) -> dict[str, Any]:
    return {"error": "", "file": {"name": name, "kind": kind, "text": text}}


def _in_full(verdict: Verdict) -> dict[str, Any]:
    """What `zwidth check -o` writes, so that `zwidth verify` reads it."""
    found = verdict.available_storage
    more = {} if found is None or verdict.witness is not None else {"worst_hand": found.to_dict()}
    return {**verdict.to_dict(), **more}


def _kept(fresh: Control, before: Mapping[str, Control]) -> Control:
    """What a slider stands for stays as it is while it is moved."""
    was = before.get(fresh.path)
    if was is None or was.scale is None or fresh.scale is None:
        return fresh
    return replace(fresh, scale=was.scale, place=was.place_of(fresh))


def _known(name: str, kinds: Mapping[str, Any], what: str) -> str:
    if name not in kinds:
        raise InputError(f"there is no {what} {name[:60]!r}")
    return name


def _chosen_device(state: State, name: str) -> State:
    own = name in (starts.OWN_LINEAR, starts.OWN_ROTARY)
    if own:
        return starts.with_device(state, starts.own_device(name))
    return starts.with_device(state, catalogued(name), lacking_of(name))


_CHOICES: Mapping[str, Callable[[State, str], State]] = {
    "device": _chosen_device,
    "environment": lambda state, name: starts.with_environment(state, _known(name, TYPES, "environment")),
}
