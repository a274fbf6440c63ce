"""The map of a workspace as a picture: in the plane, along one joint, and what cannot be drawn."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest

import zwidth as zw
from zwidth.model.arms import PlanarChain, built_in
from zwidth.passivity.workspace import Workspace
from zwidth.show import plots


@cache
def _space(name: str, stiffness: float) -> Workspace:
    return zw.workspace(built_in(name, damping=0.003), zw.Wall(stiffness), rate=1000, points=16)


IN_POSE = PlanarChain(links=(0.1, 0.1), damping=(0.02, 0.02), joint_range=((0, 1), (0.5, 2)), pose=True)


@pytest.mark.parametrize("in_pose", [False, True])
def test_the_colours_are_the_margins_at_the_places(in_pose: bool) -> None:
    """Of a hand in pose, which has no margin of its own, those of the joints, over the plane of the hand."""
    wall = zw.arms.MatrixWall.in_pose(900, 0.5, planar=True)
    space = zw.workspace(IN_POSE, wall, rate=1000, points=16) if in_pose else _space("haply-2diy", 800)
    figure, axes = plt.subplots()
    plots.draw_workspace(axes, space)
    drawn = np.sort(np.ma.getdata(axes.collections[0].get_array()).ravel())
    wanted = space.data["margin_in_joints" if in_pose else "margin"].values.ravel()
    assert drawn == pytest.approx(np.sort(wanted))
    assert axes.get_xlabel() == "x [m]"
    plt.close(figure)


@pytest.mark.parametrize("name", ["hapkit", "two-link", "falcon"])
def test_every_arm_has_a_picture(name: str, tmp_path: Path) -> None:
    path = tmp_path / "map.png"
    _space(name, 100).plot(path)
    assert path.stat().st_size > 5000


def test_a_limit_that_is_nowhere_is_drawn_too() -> None:
    assert plots.workspace_figure(_space("two-link", 0), "largest_stiffness").axes[0].collections


def test_what_is_drawn_is_named() -> None:
    def words(space: Workspace) -> str:
        return " ".join(text.get_text() for text in plots.workspace_figure(space).axes[0].texts)

    limit = _space("haply-2diy", 100).data["largest_stiffness"]
    assert words(_space("haply-2diy", 100)) == "strokes: the direction in which the margin is smallest"
    crossing = words(_space("haply-2diy", float(limit.mean())))
    figure = plots.workspace_figure(_space("haply-2diy", float(limit.mean())))
    figure.canvas.draw()
    low, high = figure.axes[1].get_ylim()
    ticks = figure.axes[1].get_yticks()
    assert low < ticks.min() < 0 < ticks.max() <= high
    assert crossing.startswith("black line: margin 0; strokes")
    figure = plots.workspace_figure(_space("haply-2diy", 100))
    assert figure.axes[0].collections[0].colorbar.extend == "max"
    assert plots.workspace_figure(_space("hapkit", 100)).axes[0].get_xlabel() == "joint q1 [rad]"
    space = _space.__wrapped__("hapkit", 100)
    space.data["q1"].attrs["units"] = "m"  # as of a joint that slides
    assert plots.workspace_figure(space).axes[0].get_xlabel() == "joint q1 [m]"


def test_the_title_is_the_whole_claim_and_colours_have_plain_numbers() -> None:
    arm = PlanarChain(links=(0.1, 0.1), damping=(0.05, 0.05), joint_range=((0, 1), (1, 1.0001)))
    space = zw.workspace(arm, zw.Wall(500), rate=1000, points=16)
    figure = plots.workspace_figure(space)
    figure.canvas.draw()
    bar = figure.axes[1]
    assert bar.yaxis.get_offset_text().get_text() == ""
    ticks = [float(text.get_text()) for text in bar.get_yticklabels()]
    assert min(ticks) == pytest.approx(float(space.data["margin"].min()), rel=0.01)
    (title,) = (" ".join(text.get_text().split()) for text in figure.texts)
    assert title == f"arm: passive. {space.claim}"


def test_another_variable_can_be_drawn() -> None:
    space = _space("two-link", 100)
    assert "largest stiffness" in plots.workspace_figure(space, "largest_stiffness").axes[1].get_ylabel()
    with pytest.raises(zw.InputError, match="it has margin"):
        plots.workspace_figure(space, "colour")


def test_three_joints_are_not_drawn() -> None:
    arm = PlanarChain(links=(0.1, 0.1, 0.1), damping=(0.1,) * 3)
    space = zw.workspace(arm, zw.Wall(100), rate=1000, points=20)
    with pytest.raises(zw.InputError, match="slice"):
        plots.workspace_figure(space)
