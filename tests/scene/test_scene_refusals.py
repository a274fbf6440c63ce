"""What a scene cannot do is said in one message; what its page says comes out."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

import zwidth as zw
from zwidth.errors import InputError
from zwidth.model.scene import (
    Contact,
    CoulombFriction,
    Damper,
    Lever,
    LineEnd,
    Mass,
    SceneRun,
    Spring,
    best_parts,
    cut_scene,
)

TOOL = zw.Scene([Mass("tool", 1)], port="tool")
BODIES = [Mass("a", 1), Mass("b", 1)]
TWO = zw.Scene([*BODIES, Spring("a", "b", 1)], port="a")
DEVICE = zw.Device(damping="0.5 N*s/m", coulomb_friction=0, rate=1000, resolution=0, delay=0)


RUBBED = zw.Scene([Spring("handle", "a", 1), Mass("a", 1), CoulombFriction("a", "b", 1), Mass("b", 1)])
LOOSE = zw.Scene([Contact("handle", "a", 100), Contact("a", "ground", 100), Damper("handle", "ground", 1)])
CHAIN = zw.Scene([Spring("handle", "m0", 300), Mass("m0", 0.1), Spring("m0", "m1", 500), Mass("m1", 0.1)])
HALVES = {"a": ["handle", "m0"], "b": ["m1"]}


def cut(parts: dict[str, list[str]], **more: object) -> object:
    """A chain of two masses in parts."""
    return cut_scene(CHAIN, parts, **{"delay": "1 ms", **more})


def checked(scene: zw.Scene) -> object:
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
        (lambda: best_parts(RUBBED, 2), "from 1 to 1"),
        (lambda: SceneRun(LOOSE, "1 ms"), 'holds the node "a"'),
        (lambda: zw.Scene([]), "one element at least"),
        (lambda: zw.Scene([Spring("a", "a", 1)]), "both ends"),
        (lambda: zw.Scene([Spring("a", "b", 1)]), 'port "handle" is no node'),
        (lambda: zw.Scene([Lever("handle", "ground"), Mass("handle", 1)]), "tied to the ground"),
        (lambda: zw.Scene("spring"), "zwidth.scene"),
        (lambda: cut({"a": ["handle", "m0"]}), "in no part: m1"),
        (lambda: cut({"a": ["handle", "m0", "m1"], "b": ["handle"]}), "what has one mass"),
        (lambda: cut({"a": ["handle", "m0"], "b": ["m0", "m1"], "c": ["m0"]}), "is in 3 parts"),
        (lambda: cut({"a": ["handle", "m0", "m1"], "b": []}), "has no node"),
        (lambda: cut({"a": ["handle", "m0", "m9"]}), '"m9" of part "a" is no node'),
        (lambda: cut(HALVES, delay=0), "delay"),
        (lambda: cut(HALVES, impedances={"mass m0": 1}), "is not cut"),
        (lambda: cut(HALVES, impedances={"spring m0–m1": 0}), "impedance of spring"),
    ],
)
def test_the_message_says_what_is_wrong(asked, said):
    with pytest.raises(InputError, match=said):
        asked()


PAGE = Path(__file__).parents[2] / "docs" / "scenes.md"


def test_the_examples_of_the_page_run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    page = PAGE.read_text(encoding="utf-8")
    for code in re.findall(r"```python\n(.*?)```", page, re.DOTALL):
        exec(code, names)
    verdict = names["zw"].check(names["device"], names["coupled"])
    assert verdict.outcome == "passive"
    assert verdict.needs[0].needed == pytest.approx(0.45)
    run = names["run"]
    assert f"{1e3 * run.positions['drawer']:.1f} mm" in page
    account = run.account()
    assert account.work.sum().item() == pytest.approx((account.stored + account.lost).sum().item())
    assert Path("drawer.png").exists()
