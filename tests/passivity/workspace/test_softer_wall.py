"""How soft a wall must be over a workspace: what is printed is proved, and what is said to fail fails."""

from __future__ import annotations

import random
import re
from typing import Any

from strategies import seeds

import zwidth as zw
from zwidth.cli.workspace.report import _changes, _numbers
from zwidth.model.arms import PlanarChain
from zwidth.quantity.units import parse_number

_STIFFNESS = re.compile(r"([\d.]+(?:e[+-]\d+)?) N/m")


def drawn(rng: random.Random) -> PlanarChain:
    joints = rng.choice([1, 2, 2])
    first = [rng.uniform(-1, 1), rng.uniform(0.3, 1)][:joints]
    return PlanarChain(
        links=[float(f"{rng.uniform(0.05, 0.4):.4g}") for _ in range(joints)],
        joint_range=[(low, low + rng.uniform(0.2, 1.2)) for low in first],
        damping=[float(f"{10 ** rng.uniform(-3, -1):.4g}") for _ in range(joints)],
    )


@seeds(2)
def test_the_wall_that_is_advised_is_proved(seed: int) -> None:
    rng = random.Random(seed)
    arm, delay = drawn(rng), rng.choice([0, 0, 0.002])

    def asked(wall: zw.Wall) -> Any:
        return zw.workspace(arm, wall, rate=1000, delay=delay, points=12)

    most = asked(zw.Wall(100)).largest_stiffness
    b = rng.choice([0, rng.uniform(-0.2, 0.2) * most / 1000])
    wall = zw.Wall(most * rng.uniform(1.3, 2.5), b)
    found = asked(wall)
    text = dict(_changes(found))["wall"]
    proved, fails = (float(parse_number(size, "N/m", "it")) for size in _STIFFNESS.findall(text))
    assert proved < fails < 1.3 * proved
    assert asked(wall.replace(stiffness=proved)).outcome == "passive"
    assert asked(wall.replace(stiffness=fails * (1 + 1e-6))).outcome != "passive"
    everywhere = float(_STIFFNESS.findall(dict(_numbers(found))["largest stiffness"])[0])
    assert asked(wall.replace(stiffness=everywhere)).outcome != "active"


def test_an_arm_that_no_checker_is_asked_of_says_so() -> None:
    arm = PlanarChain(links=[0.1] * 5, joint_range=[(0.3, 0.5)] * 5, damping=[0.01] * 5)
    text = dict(_changes(zw.workspace(arm, zw.Wall(2000), rate=1000, points=2)))["wall"]
    assert text.endswith("N/m, by the points of the map alone")


def test_a_wall_in_pose_is_told_in_times() -> None:
    arm = PlanarChain(links=[0.1, 0.1], joint_range=[(0, 0.4), (0.8, 1.2)], damping=[0.02, 0.02], pose=True)
    wall = zw.arms.MatrixWall.in_pose(2000, 0.5, planar=True)
    found = zw.workspace(arm, wall, rate=1000, points=12)
    said = re.fullmatch(
        r"its stiffness times ([\d.]+), and no more; more than ([\d.]+) times fails",
        dict(_changes(found))["wall"],
    )
    proved, fails = map(float, said.groups())
    softer = [zw.arms.MatrixWall.in_pose(2000 * k, 0.5 * k, planar=True) for k in (proved, 1.001 * fails)]
    outcomes = [zw.workspace(arm, each, rate=1000, points=12).outcome for each in softer]
    assert outcomes[0] == "passive" != outcomes[1]
