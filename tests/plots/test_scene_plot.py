"""A scene as a drawing: every node and every number is there, once, and large scenes can be drawn too."""

from __future__ import annotations

from pathlib import Path

import pytest
from random_scenes import random_scene

import zwidth as zw
from zwidth.model.scene import Contact, CoulombFriction, Damper, Lever, LineEnd, Mass, NonlinearSpring, Spring
from zwidth.show.plots.scene import placed

SCENE = zw.Scene([
    Mass("handle", "0.05"), Spring("handle", "block", 812), Damper("handle", "block", "0.57"),
    Mass("block", "0.23"), Contact("block", "ground", 3100, 2, "0.004"), Lever("block", "tip $x$", "-1.5"),
    CoulombFriction("block", "ground", "0.31"), NonlinearSpring("block", "cage", [-1, 1], [-2, 3]),
    LineEnd("cage", "4.2"),
])  # fmt: skip


def test_every_node_and_every_number_is_there() -> None:
    """Bodies with their mass; names of others are no mathematics."""
    figure = SCENE.plot()
    texts = [text.get_text() for axes in figure.axes for text in axes.texts]
    shown = "\n".join(texts)
    for number in ("0.05 kg", "812 N/m", "0.57 N·s/m", "0.23 kg", "3100 N/m", "gap 4 mm", "0.31 N", "4.2"):
        assert sum(number in text for text in texts) == 1
    for node in ("handle", "block", "cage"):
        assert node in shown
    assert r"tip \$x\$" in shown


def test_nodes_stand_by_their_distance_from_the_port() -> None:
    places = placed(SCENE)
    assert [places[n][0] for n in ("handle", "block", "tip $x$", "cage")] == [0, 1, 2, 2]
    assert len(set(places.values())) == 4


@pytest.mark.parametrize("size", [3, 300])
def test_it_is_saved(size: int, tmp_path: Path) -> None:
    random_scene(7, size).plot(tmp_path / "scene.svg")
    assert (tmp_path / "scene.svg").stat().st_size > 1000


def test_it_says_what_it_is() -> None:
    assert len(repr(SCENE).splitlines()) == 3 + len(SCENE.elements)
    assert SCENE._repr_html_().count("<tr>") == 1 + len(SCENE.elements)


def test_a_verdict_shows_its_scene() -> None:
    device = zw.Device(damping=1, rate=1000, resolution=0)
    held = SCENE.replace(elements=[e for e in SCENE.elements if not e.leads_elsewhere])
    for scene, panels in ((held, 1), (zw.Scene([Spring("handle", "a", 812), Mass("a", "0.2")]), 3)):
        figure = zw.check(device, zw.VirtualCoupling(300, "0.1", scene)).plot()
        shown = [text.get_text() for axes in figure.axes for text in axes.texts]
        assert any("812 N/m" in text for text in shown)
        assert len(figure.axes) >= panels
