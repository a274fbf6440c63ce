"""The explorer as an object: it shows itself, follows a move, and speaks the angle of the question."""

from __future__ import annotations

import math
import subprocess
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from types import SimpleNamespace

import pytest

import zwidth as zw
from zwidth.errors import InputError
from zwidth.quantity.spoken import answers_as_typed
from zwidth.show.explorer import computing
from zwidth.show.explorer.computing import answered
from zwidth.show.explorer.session import Session
from zwidth.show.explorer.shown import Explorer
from zwidth.show.explorer.starts import first, from_sources
from zwidth.show.explorer.state import State
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
    assert '"soft"' in form.told["refused"]["environment.stiffness"]
    assert shown.environment == zw.Wall(stiffness=100)
    assert "cannot be used as typed" in shown._session.head.html
    form.event = {"kind": "choose", "path": "environment", "value": "maxwell", "number": 3}
    assert not form.told["refused"]
    assert "cannot be used" not in shown._session.head.html


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
    form = Explorer(from_sources(["hapkit"]))._session.form
    for number, path in enumerate(("json", "report"), 1):
        form.event = {"kind": "press", "path": path, "value": None, "number": number}
        assert "nobody's measurement" in form.told["error"]
    form.event = {"kind": "typed", "path": "device.damping", "value": "0.3 N*s/m", "number": 3}
    form.event = {"kind": "typed", "path": "device.rate", "value": "1 kHz", "number": 4}
    form.event = {"kind": "press", "path": "json", "value": None, "number": 5}
    assert form.told.get("error", "") == ""


@pytest.mark.parametrize(
    ("law", "inside"), [(zw.Wall(770), True), (zw.PulseTransferFunction([20], [1]), False)]
)
def test_a_touch_is_shaded_inside_a_wall_alone(law: object, inside: bool) -> None:
    from zwidth.show.explorer.pictures import TouchPictures

    pictures = TouchPictures()
    assert not pictures.position.visible
    state = State.of(zw.catalogue.device("haptic-paddle"), law)  # type: ignore[arg-type]
    pictures.show(computing.touched(state), "linear")
    assert pictures.position.visible
    shade = pictures.position.renderers[1]
    depths = shade.data_source.data["inside"]
    assert (shade.visible, pictures.position.legend[0].items[1].visible) == (inside, inside)
    assert min(depths) == 0 < max(depths) == max(shade.data_source.data["position"])


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


# ---- a wheel that is asked about in degrees


WHEEL = """[device]
inertia = "0.03 kg*m^2"
damping = "0.01 N*m*s/rad"
coulomb_friction = "0.05 N*m"
counts_per_turn = 65536
handle_radius = "14 cm"
rate = "1 kHz"
delay = "1.4 ms"
"""


def asked(folder: Path, stiffness: str) -> State:
    file = folder / "wheel.toml"
    file.write_text(WHEEL)
    with answers_as_typed():
        state = from_sources([str(file)], {"stiffness": stiffness})
    return state


def shown(session: Session, waiting: list[Callable[[], None]]) -> tuple[dict[str, str], str, str]:
    while waiting:
        waiting.pop(0)()
    texts = {
        one["path"]: one.get("text", "")
        for group in session.form.groups
        for one in group["controls"]
        if "path" in one
    }
    figure = session.views[0].parts[0].object
    return texts, session.details.html, figure.yaxis[0].axis_label


def test_the_page_speaks_the_angle_of_the_question(tmp_path: Path) -> None:
    """Degrees from the first look on; a slider keeps them, and a radian that is typed takes them away."""
    waiting: list[Callable[[], None]] = []
    session = Session(asked(tmp_path, "0.5 N*m/deg"), Workers(count=0), waiting.append)
    texts, details, axis = shown(session, waiting)
    assert texts["environment.stiffness"] == "0.5 N·m/deg"
    assert "N·m/deg" in details
    assert "rad" not in details
    assert axis == "damping [N·m·s/deg]"
    needed = session.views[0].parts[0].object.renderers[1].data_source.data["has"]
    assert needed[0] == pytest.approx(0.01 * math.pi / 180)

    session.form.event = {"kind": "move", "path": "environment.stiffness", "value": 0.3, "number": 1}
    shown(session, waiting)
    assert session.form.told["error"] == ""
    assert session.form.told["values"]["environment.stiffness"][0].endswith("N·m/deg")
    assert session.state.angles == ("deg",)

    session.form.event = {"kind": "typed", "path": "environment.stiffness", "value": "5 N*m/rad", "number": 2}
    texts, details, axis = shown(session, waiting)
    assert texts["environment.stiffness"] == "5 N·m/rad"
    assert "deg" not in details
    assert axis == "damping [N·m·s/rad]"


def test_what_takes_longer_speaks_it_too(tmp_path: Path) -> None:
    state = asked(tmp_path, "0.5 N*m/deg")
    assert "N·m/deg" in answered(_advised, state)
    assert "N·m/rad" in answered(_advised, state.with_angles({"rad"}))


def _advised(state: State) -> str:
    from zwidth.show.explorer.computing import judged_in_full

    return " ".join(advice.text for advice in judged_in_full(state).advice)
