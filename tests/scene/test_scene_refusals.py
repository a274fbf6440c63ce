"""What a scene cannot do is said in one message."""

from __future__ import annotations

from collections.abc import Callable

import pytest

import zwidth as zw
from zwidth.errors import InputError
from zwidth.model.scene import Lever, LineEnd, Mass, SceneRun, Spring, best_parts, cut_scene

TOOL = zw.Scene([Mass("tool", 1)], port="tool")
BODIES = [Mass("a", 1), Mass("b", 1)]
TWO = zw.Scene([*BODIES, Spring("a", "b", 1)], port="a")
DEVICE = zw.Device(damping="0.5 N*s/m", coulomb_friction=0, rate=1000, resolution=0, delay=0)


def checked(scene: zw.Scene) -> object:
    """Behind a coupling."""
    return zw.check(DEVICE, zw.VirtualCoupling(800, "0.05", scene))


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        (
            lambda: checked(zw.Scene([*TOOL.elements, Spring("y", "z", 3)], "tool")),
            'nothing holds the node "',
        ),
        (lambda: checked(zw.Scene([*TOOL.elements, LineEnd("tool", 1)], "tool")), "no line ends"),
        (lambda: SceneRun(TOOL, "1 ms").step(0, {"x": 1.0}), "lines that end here, none; got 1.0 of 'x'"),
        (lambda: SceneRun(TOOL, "1 ms").step(float("nan")), "finite numbers"),
        (lambda: SceneRun(TOOL, "1 ms").follow([]), "one at least"),
        (lambda: SceneRun(TOOL, "1 ms").follow(["far"]), "finite numbers"),
        (
            lambda: cut_scene(zw.Scene([*BODIES, Lever("a", "b", 2)], "a"), {"x": ["a"], "y": ["b"]}, "1 ms"),
            "lever a–b lies between two parts: give impedances",
        ),
        (lambda: best_parts(TWO, 0), "a whole number from 1 on, got 0"),
        (lambda: best_parts(TWO, 1.5), "a whole number from 1 on, got 1.5"),
        (lambda: best_parts(TWO, 9), "count must be from 1 to 2"),
    ],
)
def test_the_message_says_what_is_wrong(asked: Callable[[], object], said: str) -> None:
    with pytest.raises(InputError, match=said):
        asked()
