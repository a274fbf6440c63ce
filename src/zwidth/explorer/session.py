"""One person's page: the loop it is at, what is shown of it, and what happens when something is moved.

Nothing here is shared with another page.  A move is answered at once with what the closed forms say; what takes
longer is computed beside (`working`) and shown when it comes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import partial
from itertools import count
from typing import Any

from zwidth.device import catalogue
from zwidth.errors import InputError
from zwidth.explorer import starts
from zwidth.explorer.controls import Control, device_controls, environment_controls, law_controls, read_entry
from zwidth.explorer.criterion import CriterionPicture
from zwidth.explorer.form import Event, Form, Soon, button, choice, flag, group, shown, upload, words
from zwidth.explorer.judging import Judged, judged_at_once, judged_in_full
from zwidth.explorer.state import State, catalogued, from_file
from zwidth.explorer.verdict_card import badge, card
from zwidth.explorer.working import Answer, Workers
from zwidth.passivity.verdict import Verdict
from zwidth.quantity.text import in_words
from zwidth.rendering import LAWS
from zwidth.showing import element
from zwidth.specification.environments import TYPES
from zwidth.specification.write import written

_askers = count(1)


class Session:
    """A page.

    Parameters
    ----------
    state
        The loop that it begins with.
    workers
        Who computes what takes longer.
    soon
        Has something done in the thread of the page.
    message
        Said at the top, such as what of the address could not be used.
    """

    def __init__(self, state: State, workers: Workers, soon: Soon, message: str = "") -> None:
        self.state = state
        self.verdict: Verdict | None = None
        self._workers, self._soon, self._asker = workers, soon, next(_askers)
        self._controls: dict[str, Control] = {}
        self.form = Form(sizing_mode="stretch_width")
        self.card, self.badge = words(element("p"), live=True), words(element("p"))
        self.criterion = CriterionPicture()
        self.criterion_caption = words(element("p"))
        loop = state.loop()
        self._draw_form(loop)
        self._judge(loop)
        self.form.told = {"heard": 0, "error": message, "query": "" if message else state.query()}
        self.form.listen(self.hear, soon)

    def close(self) -> None:
        """Nobody looks any more."""
        self._workers.forget(self._asker)

    def hear(self, event: Event) -> Mapping[str, Any]:
        """Answer one event of the form."""
        try:
            return self._heard(str(event.get("kind")), str(event.get("path")), event.get("value"))
        except InputError as error:
            return {"error": str(error)}

    def _heard(self, kind: str, path: str, value: Any) -> Mapping[str, Any]:
        if kind == "press":
            return {"file": self._file(path)}
        if kind == "release":
            self._released()
            return {"query": self.state.query()}
        if kind == "upload":
            self._become(self._uploaded(str(value), path), redraw=True)
        elif kind == "choose" and path in _CHOICES:
            self._become(_CHOICES[path](self.state, str(value)), redraw=True)
        elif kind == "choose" and path.startswith("with."):
            chosen = starts.with_law(self.state, _law(path.removeprefix("with.")), value == "true")
            self._become(chosen, redraw=True)
        else:
            return self._set(kind, path, value)
        return {"error": "", "query": self.state.query()}

    def _set(self, kind: str, path: str, value: Any) -> Mapping[str, Any]:
        """One parameter, by its slider or as it was typed or chosen."""
        control = self._controls.get(path)
        if control is None:
            raise InputError(f"there is no {path[:60]!r} on this page any more")
        if kind == "move" and control.scale is not None and isinstance(value, int | float):
            given: object = control.said(float(value))
        else:
            given = read_entry(control, str(value))
        self._become(self.state.changed(path, given).settled(), redraw=False)
        now = self._controls[path]
        if kind != "move":
            self._released()
        told: dict[str, Any] = {"values": {path: [now.text, now.place]}, "error": ""}
        return told if kind == "move" else {**told, "query": self.state.query()}

    def _become(self, state: State, redraw: bool) -> None:
        """Another loop, if it is one: what cannot be used changes nothing."""
        loop = state.loop()
        judged = judged_at_once(loop)
        self.state = state
        if redraw:
            self._draw_form(loop)
            self._released()
        else:
            kept = self._controls
            fresh = {one.path: one for one in self._made(loop)}
            self._controls = {path: _kept(one, kept.get(path)) for path, one in fresh.items()}
        self._show(judged)

    def _released(self) -> None:
        """What is drawn only when a slider is let go."""

    # -- the verdict -------------------------------------------------------------------------------------------

    def _judge(self, loop: Any) -> None:
        self._show(judged_at_once(loop))

    def _show(self, judged: Judged) -> None:
        self.verdict = judged.verdict
        if judged.final:
            self._workers.forget(self._asker)
            self._say(judged.verdict, "")
            return
        self._say(judged.verdict, _MORE if judged.verdict is not None else "Working it out …")
        self._workers.submit(
            self._asker, "verdict", judged_in_full, (self.state,), self._when_known(self.state)
        )

    def _when_known(self, state: State) -> Callable[[Answer], None]:
        return lambda answer: self._soon(partial(self._known, state, answer))

    def _known(self, state: State, answer: Answer) -> None:
        """What took longer has come."""
        if state is not self.state:
            return
        if answer.value is None:
            self._say(self.verdict, answer.message)
            return
        self.verdict = answer.value
        self._say(answer.value, "")

    def _say(self, verdict: Verdict | None, note: str) -> None:
        self.card.html = str(card(verdict, note))
        self.badge.html = str(badge(verdict, note))
        self.criterion_caption.html = str(element("p", self.criterion.show(verdict)))

    # -- the controls ------------------------------------------------------------------------------------------

    def _made(self, loop: Any) -> Iterator[Control]:
        motion = loop.device.motion
        laws = getattr(loop.environment, "laws", ())
        met = loop.environment.environment if laws else loop.environment
        yield from device_controls(self.state, loop.device)
        yield from environment_controls(self.state, met, motion)
        for number, law in enumerate(laws, 1):
            yield from law_controls(self.state, number, law, motion)

    def _draw_form(self, loop: Any) -> None:
        made = [*self._made(loop)]
        self._controls = {one.path: one for one in made}
        of = {
            kind: [c for c in made if c.path.startswith(f"{kind}.")]
            for kind in ("device", "environment", "law")
        }
        first = [shown(c) for c in of["device"] if not c.more]
        rest = [shown(c) for c in of["device"] if c.more]
        on = {str(law["type"]) for law in self.state.laws}
        boxes = [
            flag(f"with.{name}", in_words(name.replace("-", " ")), law.meaning, name in on)
            for name, law in LAWS.items()
        ]
        groups = [
            group("Device", [self._device_choice(loop.device.name), upload("file", "or a TOML file"), *first]),
            group("More of the device", rest, folded=True),
            group("Environment", [self._environment_choice(), *map(shown, of["environment"])]),
            *(
                group(f"Law {n}: {str(law['type']).replace('-', ' ')}", map(shown, (c for c in of["law"] if c.path.startswith(f"law.{n}."))))
                for n, law in enumerate(self.state.laws, 1)
            ),
            group("Laws in the chain", boxes, folded=True),
            group("Take it with you", [button("toml", "The loop as TOML"), button("json", "The verdict as JSON")]),
        ]  # fmt: skip
        self.form.groups = [one for one in groups if one["controls"] or one["title"].startswith("Law ")]

    def _device_choice(self, name: str) -> dict[str, Any]:
        options = [(one, catalogue.entry(one).title) for one in catalogue.names()]
        options += [
            (starts.OWN_LINEAR, "a linear device of your own"),
            (starts.OWN_ROTARY, "a rotary device of your own"),
        ]
        if name not in dict(options):
            options.insert(0, (name, name))
        return choice("device", "device", options, name)

    def _environment_choice(self) -> dict[str, Any]:
        options = [(name, f"{name.replace('-', ' ')}: {kind.meaning}") for name, kind in TYPES.items()]
        return choice("environment", "kind", options, str(self.state.environment["type"]))

    # -- files -------------------------------------------------------------------------------------------------

    def _uploaded(self, text: str, name: str) -> State:
        state, device = from_file(text, name)
        return starts.with_device(self.state, device) if state is None else state

    def _file(self, name: str) -> dict[str, str]:
        loop = self.state.loop()
        if name == "toml":
            return {
                "name": "loop.toml",
                "kind": "application/toml",
                "text": written(loop.device, loop.environment),
            }
        if name == "json" and self.verdict is not None:
            return {"name": "verdict.json", "kind": "application/json", "text": self.verdict.to_json()}
        raise InputError("there is nothing to download yet: the verdict is being worked out")


_MORE = "The closed forms leave a gap: more is being worked out …"


def _kept(fresh: Control, before: Control | None) -> Control:
    """The scale of a slider stays where it was while it is moved, unless the number left it."""
    if before is None or before.scale is None or fresh.scale is None:
        return fresh
    place = before.scale.share(_middle(fresh))
    return replace(fresh, scale=before.scale, place=place)


def _middle(control: Control) -> float:
    assert control.scale is not None
    return control.scale.value(control.place)


def _law(name: str) -> str:
    if name not in LAWS:
        raise InputError(f"there is no law {name[:60]!r}")
    return name


def _chosen_device(state: State, name: str) -> State:
    own = name in (starts.OWN_LINEAR, starts.OWN_ROTARY)
    return starts.with_device(state, starts.own_device(name) if own else catalogued(name))


def _chosen_environment(state: State, name: str) -> State:
    if name not in TYPES:
        raise InputError(f"there is no environment {name[:60]!r}")
    return starts.with_environment(state, name)


_CHOICES: Mapping[str, Callable[[State, str], State]] = {
    "device": _chosen_device,
    "environment": _chosen_environment,
}
