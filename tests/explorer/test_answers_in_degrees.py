"""A page about a wheel that is asked about in degrees: sliders, verdict, advice and axes are in degrees."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import pytest

from zwidth.quantity.spoken import answers_as_typed
from zwidth.show.explorer.computing import answered
from zwidth.show.explorer.session import Session
from zwidth.show.explorer.starts import from_sources
from zwidth.show.explorer.state import State
from zwidth.show.explorer.working import Workers

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
    """As `zwidth explore wheel.toml --stiffness …` begins."""
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
