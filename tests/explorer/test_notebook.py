"""The explorer as an object: it shows itself, and its loop is that of the sliders."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from functools import cache
from types import SimpleNamespace

import pytest

import zwidth as zw
from zwidth.errors import InputError
from zwidth.show.explorer.session import Session
from zwidth.show.explorer.shown import Explorer
from zwidth.show.explorer.starts import first, from_sources
from zwidth.show.explorer.working import Workers


def test_it_shows_the_loop_that_it_was_given() -> None:
    paddle = zw.catalogue.device("haptic-paddle")
    shown = zw.explore(paddle, zw.Wall(stiffness=770))
    assert shown.device == paddle
    assert shown.environment == zw.Wall(stiffness=770)
    assert shown.verdict.outcome == "active"
    form = shown._session.form
    form.event = {"kind": "typed", "path": "environment.stiffness", "value": "100 N/m", "number": 1}
    assert shown.environment == zw.Wall(stiffness=100)
    assert shown.verdict.outcome == "passive"
    assert form.told["error"] == ""
    form.event = {"kind": "typed", "path": "environment.stiffness", "value": "soft", "number": 2}
    assert "soft" in form.told["error"]
    assert shown.environment == zw.Wall(stiffness=100)


@cache
def _one() -> Explorer:
    return zw.explore()


@pytest.mark.parametrize(
    "kind", ["typed", "move", "choose", "release", "view", "upload", "press", "nonsense", None]
)
@pytest.mark.parametrize("value", [None, "x", 3, float("nan"), [], {"a": 1}, "x" * 10_000])
def test_whatever_a_browser_sends_is_answered(kind: object, value: object) -> None:
    """With a message at most: what it sends is not trusted."""
    form = _one()._session.form
    paths = ("environment.stiffness", "device", "with.x", "law.9.x", "__class__", None)
    for number, path in enumerate(paths, 1):
        form.event = {"kind": kind, "path": path, "value": value, "number": number}
        assert form.told["heard"] == number
    form.event = {}


def test_a_move_shows_outcome_then_limits_then_the_picture_of_the_newest() -> None:
    """Each when what goes before is on its way; of a loop that has been left nothing more is worked out."""
    waiting: list[Callable[[], None]] = []

    def next_one() -> None:
        waiting.pop(0)()

    workers = Workers(count=0)
    session = Session(first(), workers, waiting.append)
    while waiting:
        next_one()

    def shown() -> tuple[str, str, object]:
        curve = session.views[0].parts[0].object.renderers[0].data_source.data
        return session.head.html, session.details.html, tuple(curve.get("needed", ()))

    def move(place: float) -> None:
        session.hear({"kind": "move", "path": "environment.stiffness", "value": place})

    begun = shown()
    move(0.9)
    heard = shown()
    assert heard[0] != begun[0]
    assert heard[1:] == begun[1:]
    next_one()
    followed = shown()
    assert followed[1] != begun[1]
    assert followed[2] == begun[2]
    next_one()
    assert shown()[2] != begun[2]
    assert not waiting
    move(0.2)
    move(0.3)
    next_one()
    assert shown()[1] == followed[1]
    next_one()
    assert shown()[1] != followed[1]


def test_a_verdict_of_a_number_that_nobody_measured_stays_on_the_page() -> None:
    """There it is marked; a file would go about without the mark, until the number is set."""
    form = Explorer(from_sources(["hapkit"]))._session.form
    for number, path in enumerate(("json", "report"), 1):
        form.event = {"kind": "press", "path": path, "value": None, "number": number}
        assert "nobody's measurement" in form.told["error"]
    form.event = {"kind": "typed", "path": "device.damping", "value": "0.3 N*s/m", "number": 3}
    form.event = {"kind": "typed", "path": "device.rate", "value": "1 kHz", "number": 4}
    form.event = {"kind": "press", "path": "json", "value": None, "number": 5}
    assert form.told.get("error", "") == ""


def test_importing_zwidth_loads_no_panel() -> None:
    code = "import sys, zwidth; zwidth.check; print([m for m in ('panel', 'bokeh') if m in sys.modules])"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "[]"


def test_in_a_kernel_panel_comes_first(monkeypatch: pytest.MonkeyPatch) -> None:
    """Sliders that are shown in the cell that loads it are not heard: what to type is said instead."""
    shell = SimpleNamespace(get_ipython=lambda: SimpleNamespace(kernel=object()))
    monkeypatch.setitem(sys.modules, "IPython", shell)
    monkeypatch.setattr("panel.extension._loaded", False)
    with pytest.raises(InputError, match=r"panel\.extension\(inline=True\)"):
        zw.explore()
