"""Random URDF and MJCF files, read here and by MuJoCo: the same arm, or a refusal with a line of the file.

    python benchmarks/random_descriptions.py --count 1000 --seed 1      # needs: pip install mujoco

Compared: which joints there are, in which order, their limits, damping, friction, and in ten postures the
position of the hand and its Jacobian, rotations too.  A joint that follows another (mimic in URDF, equality
in MJCF) is put into MuJoCo's Jacobian by the chain rule.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

import mujoco
import numpy as np
from scipy.spatial.transform import Rotation

from zwidth.errors import InputError
from zwidth.model.arms import PosedArm
from zwidth.model.arms.reading import read_mechanism

TURNS = {"quat": 4, "axisangle": 4, "xyaxes": 6, "zaxis": 3, "euler": 3}


def text(values) -> str:
    return " ".join(f"{v:.5g}" for v in np.atleast_1d(values))


class Drawn:
    """A description, what in it follows what, {name: (leader, factor)}, and whether it is to be refused."""

    def __init__(self, rng: np.random.Generator) -> None:
        self.rng, self.joints, self.bodies, self.sites = rng, [], [], []
        self.follows, self.refused, self.n = {}, False, 0

    def some(self, share: float) -> bool:
        return bool(self.rng.random() < share)

    def pick(self, *values):
        return values[self.rng.integers(len(values))]

    def name(self, kind: str) -> str:
        self.n += 1
        return f"{kind}{self.n}"

    # MJCF ------------------------------------------------------------------------------------------------
    def placed(self) -> str:
        kind = self.pick(None, *TURNS)
        turn = (
            f' {kind}="{text(self.rng.uniform(-2, 2, TURNS[kind]) * (30 if kind == "euler" else 1))}"'
            if kind
            else ""
        )
        return (f' pos="{text(self.rng.uniform(-0.3, 0.3, 3))}"' if self.some(0.8) else "") + turn

    def classed(self, key: str, share: float) -> str:
        return f' {key}="{self.pick(*self.classes)}"' if self.classes and self.some(share) else ""

    def joint_attributes(self, limited: bool) -> str:
        r, out = self.rng, []
        ends = np.sort(r.uniform(-2, 2, 2))
        for share, key, value in (
            (0.4, "type", self.pick("hinge", "slide")), (0.6, "axis", text(r.normal(size=3))),
            (0.3, "pos", text(r.uniform(-0.2, 0.2, 3))), (0.5, "range", text(ends)),
            (0.5, "damping", text(r.uniform(0.01, 3, r.integers(1, 4)))),
            (0.3, "frictionloss", text(r.uniform(0, 1))),
            (0.2, "ref", text(r.uniform(-1, 1))), (0.1, "armature", "0.1"), (0.1, "stiffness", "2 1"),
        ):  # fmt: skip
            if self.some(share):
                out.append(f'{key}="{value}"')
        given = " ".join(out)
        if limited and (not self.auto and "range" in given):
            out.append(f'limited="{self.pick("true", "false")}"')
        elif self.some(0.2):
            out.append('limited="false"')
        return " ".join(out)

    def mjcf(self) -> str:
        self.auto, self.classes = self.some(0.8), []
        options = [f'angle="{self.pick("degree", "radian")}"'] * self.some(0.6)
        options += [f'eulerseq="{"".join(self.pick(*"xyzXYZ") for _ in range(3))}"'] * self.some(0.4)
        options += [] if self.auto else ['autolimits="false"']
        defaults = self.default(0) if self.some(0.7) else ""
        self.classes = self.classes or []
        world = "".join(self.body(0) for _ in range(self.rng.integers(1, 3)))
        equality = (
            "".join(self.equality() for _ in range(1)) if len(self.joints) > 2 and self.some(0.3) else ""
        )
        return (
            f"<mujoco>\n<compiler {' '.join(options)}/>\n{defaults}\n<worldbody>{world}</worldbody>\n"
            f"<equality>{equality}</equality></mujoco>"
        )

    def default(self, depth: int) -> str:
        name = "main" if depth == 0 else self.name("c")
        inner = "".join(self.default(depth + 1) for _ in range(self.rng.integers(0, 3))) if depth < 3 else ""
        self.classes.append(name)
        joint = f"<joint {self.joint_attributes(True)}/>" if self.some(0.7) else ""
        site = f"<site{self.placed()}/>" if self.some(0.3) else ""
        return f'<default class="{name}">{inner}{joint}{site}</default>\n'

    def equality(self) -> str:
        named = [name for name in self.joints if not name.startswith("?")]
        if len(named) < 2:
            return ""
        one, other = (str(name) for name in self.rng.choice(named, 2, replace=False))
        factor, active = self.rng.uniform(-2, 2), self.some(0.7)
        if active:
            self.follows[one] = (other, factor)
        state = f'polycoef="0.1 {factor:.17g}" active="{str(active).lower()}"'
        return f'<joint joint1="{one}" joint2="{other}" {state}/>'

    def body(self, depth: int) -> str:
        name = self.name("b") if self.some(0.7) else None
        self.bodies.append(name)
        joints = [self.joint() for _ in range(self.pick(0, 1, 1, 1, 2, 3))]
        if depth == 0 and self.some(0.02):
            self.refused, joints = True, ['<freejoint name="free"/>']
        elif self.some(0.01):
            self.refused, joints = True, ['<joint type="ball"/>']
        bodies = [
            self.body(depth + 1)
            for _ in range(self.pick(1, 1, 1, 2) if depth < 2 else self.pick(0, 0, 1) if depth < 5 else 0)
        ]
        site = f"<site{self.site()}/>" if self.some(0.4) else ""
        parts = [*joints, site, *bodies] if self.some(0.8) else [*bodies, site, *joints]
        if self.some(0.2):
            at = self.rng.integers(len(parts))
            parts[at] = f"<frame{self.placed()}{self.classed('childclass', 0.3)}>{parts[at]}</frame>"
        named = f' name="{name}"' if name else ""
        where = self.placed() if self.some(0.9) else ""
        inertia = '<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>'
        return (
            f"<body{named}{where}{self.classed('childclass', 0.3)}>{inertia}\n"
            + "\n".join(parts)
            + "</body>\n"
        )

    def site(self) -> str:
        self.sites.append(self.name("s"))
        ends = (
            f' type="capsule" size="0.1" fromto="{text(self.rng.uniform(-1, 1, 6))}"'
            if self.some(0.1)
            else self.placed()
        )
        return f' name="{self.sites[-1]}"{ends}{self.classed("class", 0.2)}'

    def joint(self) -> str:
        name = self.name("j") if self.some(0.8) else None
        self.joints.append(name or f"?{len(self.joints)}")
        named = f' name="{name}"' if name else ""
        return f"<joint{named} {self.joint_attributes(True)}{self.classed('class', 0.3)}/>"

    # URDF ------------------------------------------------------------------------------------------------
    def urdf(self) -> str:
        count, parts = int(self.rng.integers(2, 9)), []
        inertia = (
            '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
        )
        for i in range(count + 1):
            self.bodies.append(f"l{i}")
            parts.append(f'<link name="l{i}">{inertia}</link>')
        for i in range(count):
            kind, name = (
                self.pick("revolute", "revolute", "continuous", "prismatic", "fixed"),
                f"{self.pick(*'azMQ')}{i}",
            )
            if self.some(0.01):
                kind, self.refused = self.pick("floating", "planar"), True
            parent = i if self.some(0.7) else self.rng.integers(0, i + 1)
            low, high = np.sort(self.rng.uniform(-2, 2, 2))
            inner = [f'<parent link="l{parent}"/><child link="l{i + 1}"/>']
            if self.some(0.8):
                inner.append(
                    f'<origin xyz="{text(self.rng.uniform(-0.3, 0.3, 3))}" '
                    f'rpy="{text(self.rng.uniform(-3, 3, 3))}"/>'
                )
            if self.some(0.8):
                inner.append(f'<axis xyz="{text(self.rng.normal(size=3))}"/>')
            if kind in ("revolute", "prismatic"):
                inner.append(f'<limit lower="{low:.4g}" upper="{high:.4g}" effort="3" velocity="1"/>')
            if self.some(0.8):
                inner.append(
                    f'<dynamics damping="{self.rng.uniform(0.01, 3):.4g}" '
                    f'friction="{self.rng.uniform(0, 1):.3g}"/>'
                )
            if kind in ("revolute", "continuous", "prismatic"):
                if self.joints and self.some(0.15):
                    other, factor = str(self.rng.choice(self.joints)), self.rng.uniform(-2, 2)
                    self.follows[name] = (other, factor)
                    inner.append(f'<mimic joint="{other}" multiplier="{factor:.17g}" offset="0.1"/>')
                self.joints.append(name)
            self.rng.shuffle(inner)
            parts.append(f'<joint name="{name}" type="{kind}">{"".join(inner)}</joint>')
        self.rng.shuffle(parts)
        compiler = '<mujoco><compiler fusestatic="false"/></mujoco>'
        return '<robot name="drawn">' + compiler + "\n".join(parts) + "</robot>"


def differs(drawn: Drawn, path: Path, theirs: mujoco.MjModel) -> str:
    """What differs; empty where nothing does."""
    table, rng, urdf = read_mechanism(path), drawn.rng, path.suffix == ".urdf"
    names = [theirs.joint(i).name or f"?{i}" for i in range(theirs.njnt)]
    free, told = [n for n in names if n not in drawn.follows], [c.name for c in table.coordinates]
    if len(free) != len(told) or any(
        a != b and a[0] != "?" for a, b in zip(free, told, strict=True) if not urdf
    ):
        return f"joints {told}, theirs {free}"
    order = [told.index(n) for n in free] if urdf else range(len(free))

    def moved(name: str) -> tuple[np.ndarray, float]:
        """Value of a joint of theirs: row · q + constant."""
        if name not in drawn.follows:
            return np.eye(len(told))[order[free.index(name)]], 0.0
        other, factor = drawn.follows[name]
        row, constant = moved(other)
        zero, theirs_zero = (theirs.qpos0[names.index(n)] for n in (name, other))
        return factor * row, factor * (constant - theirs_zero) + zero + 0.1

    rows, constants = zip(*map(moved, names), strict=True)
    rows, constants = np.array(rows), np.array(constants)
    for k, each in enumerate(table.coordinates):
        factors, own = abs(rows[:, k]), np.nonzero(rows[:, k])[0]
        friction = (factors**2 @ theirs.dof_damping, factors @ theirs.dof_frictionloss)
        if not np.allclose([each.damping, each.friction], friction, rtol=1e-9):
            return f"friction of {each.name}: {each.damping, each.friction}, theirs {friction}"
        limits = theirs.jnt_range[own[0]] if theirs.jnt_limited[own[0]] else (-np.inf, np.inf)
        if len(own) == 1 and not np.allclose(each.limits, limits, rtol=1e-9):
            return f"limits of {each.name}: {each.limits}, theirs {limits}"
    data, kinds = mujoco.MjData(theirs), {"body": mujoco.mj_jacBody, "site": mujoco.mj_jacSite}
    hands = [("site", n) for n in drawn.sites] + [("body", n) for n in drawn.bodies if n]
    for kind, hand in [hands[i] for i in rng.permutation(len(hands))[:3]]:
        whole = {"joint_range": [(-2, 2)] * len(told), "damping": [1.0] * len(told)}
        arm = PosedArm(model=table, frame=hand, **whole)
        for q in rng.uniform(-2, 2, (10, len(told))):
            data.qpos[:] = rows @ q + constants
            mujoco.mj_kinematics(theirs, data)
            mujoco.mj_comPos(theirs, data)
            full, number = np.zeros((6, theirs.nv)), getattr(theirs, kind)(hand).id
            kinds[kind](theirs, data, full[:3], full[3:], number)
            placed, jacobian = arm._placed(q)
            if not np.allclose(placed, getattr(data, kind)(hand).xpos, atol=1e-8):
                return f"where {hand} is: {placed}, theirs {getattr(data, kind)(hand).xpos}"
            if not np.allclose(jacobian, full @ rows, atol=1e-8):
                return f"the Jacobian of {hand}"
            resting = arm.replace(rest=q * 0)
            turned = Rotation.from_quat(np.roll(resting._quaternion(q), -1)).as_matrix()
            if not np.allclose(turned.ravel(), getattr(data, kind)(hand).xmat, atol=1e-8):
                return f"the turn of {hand}"
    return ""


def main() -> int:
    """1 where anything differs."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    given, counts, wrong = parser.parse_args(), {}, 0
    for number in range(given.count):
        drawn = Drawn(np.random.default_rng((given.seed, number)))
        kind = ("mjcf", "urdf")[number % 2]
        said, path = getattr(drawn, kind)(), Path(tempfile.gettempdir()) / f"drawn-{number}.{kind}"
        path.write_text(said)
        try:
            theirs = mujoco.MjModel.from_xml_string(said)
        except ValueError as error:
            theirs, why = None, str(error)
        try:
            found = "refused by MuJoCo alone" if theirs is None else differs(drawn, path, theirs)
            if theirs is None:
                read_mechanism(path)
                found += f": {why.splitlines()[0]}"
        except InputError as error:
            expected = drawn.refused or theirs is None or not theirs.njnt
            found = "" if expected else f"refused: {error}"
            kind += ", refused" if theirs is not None else ", refused by both"
        counts[kind] = counts.get(kind, 0) + 1
        if found:
            wrong += 1
            print(f"seed {given.seed}, file {number}, {path}: {found}")
        else:
            path.unlink()
    print(f"seed {given.seed}: {counts}; {wrong} differ; MuJoCo {mujoco.__version__}")
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
