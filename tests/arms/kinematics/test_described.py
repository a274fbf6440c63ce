"""Arms from URDF and MJCF are the arms that they describe."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pytest

import zwidth as zw
from zwidth.model.arms import PlanarChain, read_arm

LINK = '<link name="{}"/>'


def _joint(name: str, parent: str, child: str, x: float, kind: str = "revolute", extra: str = "") -> str:
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{x} 0 0"/><axis xyz="0 0 1"/>{extra}</joint>'
    )


LIMIT = '<limit lower="0.2" upper="2.4" effort="0.5" velocity="9"/><dynamics damping="{}" friction="0.002"/>'


def robot(path: Path, links: Iterable[str], *joints: str) -> Path:
    text = "".join([*map(LINK.format, links), *joints])
    path.write_text(f'<robot name="{path.stem}">{text}</robot>', encoding="utf-8")
    return path


SHOULDER = _joint("shoulder", "base", "upper", 0.0, extra=LIMIT.format(0.02))
ELBOW = _joint("elbow", "upper", "lower", 0.12, extra=LIMIT.format(0.01))
HAND = _joint("hand", "lower", "tip", 0.09, "fixed")


@pytest.fixture
def urdf(tmp_path: Path) -> Path:
    """A two-link arm of 0.12 and 0.09 m."""
    return robot(tmp_path / "two.urdf", ("base", "upper", "lower", "tip"), SHOULDER, ELBOW, HAND)


def test_a_described_two_link_arm_is_the_closed_form(urdf):
    """Positions, Jacobians and their bounds, friction and limits, and the same map."""
    arm = read_arm(urdf, frame="tip")
    assert (arm.damping, arm.coulomb_friction, arm.torque_limit) == ((0.02, 0.01), (0.002, 0.002), (0.5, 0.5))
    plain = PlanarChain(links=(0.12, 0.09), damping=(0.02, 0.01), joint_range=((0.2, 2.4), (0.2, 2.4)))
    q = np.random.default_rng(1).uniform(0.2, 2.4, (6, 2))
    assert arm.forward(q)[..., :2] == pytest.approx(plain.forward(q), abs=1e-12)
    assert arm.jacobian(q)[..., :2, :] == pytest.approx(plain.jacobian(q), abs=1e-12)
    assert arm.jacobian(q)[..., 2, :] == pytest.approx(0)
    assert arm.sites(9).change == pytest.approx(plain.sites(9).change)
    described, closed = (zw.workspace(a, zw.Wall(400), rate=1000, points=15) for a in (arm, plain))
    assert described.data["margin"].values == pytest.approx(closed.data["margin"].values, rel=1e-9)
    assert (described.data["proved"].values == closed.data["proved"].values).all()
    assert described.outcome == closed.outcome


def test_sliding_joints_and_joints_that_are_held(tmp_path):
    """A rail under two links: three joints, of which one is held; the bound covers random points."""
    limit = '<limit lower="-0.1" upper="0.1" effort="5" velocity="1"/><dynamics damping="2"/>'
    rail = _joint("rail", "base", "car", 0.0, "prismatic", limit)
    shoulder = _joint("shoulder", "car", "upper", 0.05, extra=LIMIT.format(0.02))
    links = ("base", "car", "upper", "lower", "tip")
    path = robot(tmp_path / "rail.urdf", links, rail, shoulder, ELBOW, HAND)
    arm = read_arm(path, frame="tip", hold={"elbow": 0.7})
    sites = arm.sites(12)
    assert [axis.unit for axis in sites.axes] == ["m", "rad"]
    assert sites.joints[..., 2] == pytest.approx(0.7)
    rng = np.random.default_rng(5)
    for _ in range(30):
        place = tuple(rng.integers(12, size=2))
        shift = rng.uniform(-1, 1, 2) * [0.2 / 24, 2.2 / 24]
        there = arm.jacobian(sites.joints[place] + np.append(shift, 0))
        assert np.linalg.norm(there - sites.jacobians[place], 2) <= sites.change[place]
    with pytest.raises(zw.InputError, match="no joint 'wrist'"):
        read_arm(path, hold={"wrist": 0})
    assert read_arm(path, hold={}).joint_range[2] == (1.3, 1.3)


MESH = "<visual><geometry><mesh filename='package://../../none.stl'/></geometry></visual>"


@pytest.mark.parametrize(
    ("part", "other"),
    [
        ('joint name="hand"', 'joint name="tip"'),  # that of its link
        (LINK.format("tip"), f'<link name="tip">{MESH}</link>'),  # which is not opened
    ],
)
def test_names_of_joints_and_meshes_do_not_matter(urdf, part, other):
    q = [0.4, 0.9]
    expected = read_arm(urdf, frame="tip")
    urdf.write_text(urdf.read_text(encoding="utf-8").replace(part, other), encoding="utf-8")
    found = read_arm(urdf, frame="tip")
    assert found.forward(q) == pytest.approx(expected.forward(q))
    assert found.damping == (0.02, 0.01)


INERTIA = '<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>'
MANY = f"""<mujoco model="many">
<compiler angle="degree" eulerseq="zYx"/>
<default>
 <joint damping="0.3 0.05" frictionloss="0.02"/>
 <default class="rail"><joint type="slide" axis="1 0 0" range="-0.5 0.5"/>
  <default class="free"><joint limited="false"/></default></default>
</default>
<worldbody>
 <body euler="20 -30 40" childclass="rail">{INERTIA}<joint/>
  <body>{INERTIA}
   <site name="tip" pos="0.1 0 0.2" zaxis="1 1 0"/>
   <frame pos="0.1 0.2 0" axisangle="0 0 1 50" childclass="free">
    <joint name="in" class="main" axis="0 2 1" pos="0 0.1 0" range="-60 60" ref="10" damping="0.2"/></frame>
   <joint name="out" axis="0 0 3" class="free"/>
   <frame xyaxes="0 1 0 1 0 0" pos="0 0 0.1"><body name="b" pos="0.2 0 0" quat="2 1 0 0">{INERTIA}
    <joint name="last" class="main"/></body></frame>
  </body>
 </body>
</worldbody>
</mujoco>"""
BY_MUJOCO = {  # position and Jacobian by MuJoCo 4.0.0, mj_jacSite and mj_jacBody, at −0.8, −0.3, 0.2, 0.7
    "tip": [
        (-0.698543814043, -0.553947947151, -0.229177210402),
        (0.813797681349, 0.126465706241, -0.26085958392, 0),
        (0.342020143326, 0.043310577415, -0.856969810792, 0),
        (0.469846310393, 0.466036155002, 0.444471619868, 0),
        (0, -0.958966482841, 0, 0),
        (0, -0.090610597555, 0, 0),
        (0, 0.268650338543, 0, 0),
    ],
    "b": [
        (-0.846778207385, -0.365715015227, -0.178236774895),
        (0.813797681349, 0.071281122054, -0.26085958392, 0),
        (0.342020143326, 0.052337527732, -0.856969810792, 0),
        (0.469846310393, 0.27209547536, 0.444471619868, 0),
        (0, -0.958966482841, 0, -0.529816369359),
        (0, -0.090610597555, 0, 0.50992683145),
        (0, 0.268650338543, 0, -0.677694061747),
    ],
}


def test_mjcf_is_read_as_mujoco_reads_it(tmp_path):
    """Classes in classes, bodies without attributes, joints in frames, a slide in metres."""
    path = tmp_path / "many.xml"
    path.write_text(MANY)
    for frame, (position, *jacobian) in BY_MUJOCO.items():
        arm = read_arm(path, frame=frame, pose=True, hold={"out": 0, "last": 0})
        found = arm.placed(np.array([-0.8, -0.3, 0.2, 0.7]))
        assert found[0][:3] == pytest.approx(position, abs=1e-11)
        assert found[1] == pytest.approx(np.array(jacobian), abs=1e-11)
    assert arm.joint_names == ("body 1Joint_0", "in", "out", "last")
    assert arm.sliding == (True, False, True, False)
    assert (arm.damping, arm.coulomb_friction) == ((0.3, 0.2, 0.3, 0.3), (0.02,) * 4)
    assert arm.joint_range[:2] == ((-0.5, 0.5), pytest.approx((-np.pi / 3, np.pi / 3)))
    assert "joint in is damped by more at speed" in arm.damping_source
    with pytest.raises(zw.InputError, match="'out', line 14, slides without limits; write range="):
        read_arm(path, whole=True)


@pytest.mark.parametrize(
    ("inside", "words"),
    [
        ('<joint type="ball"/>', "line 2: <joint> is of type ball: every joint must turn or slide"),
        ("<freejoint/>", "line 2: <freejoint> moves freely"),
        ('<replicate count="2"/>', "line 2: <replicate> is not read"),
        ('<joint class="none"/>', "line 2: .*'none', and there is none"),
        ('<joint dampng="1"/>', "line 2: .*attribute 'dampng'"),
        ('<joint range="1"/>', "line 2: .*range='1', where 2 numbers"),
        ('<joint damping="1_0"/>', "no finite number"),
        ('<joint limited="true"/>', "has limits, and no range"),
        ('<joint axis="0 0 0"/>', "line 2: the axis has no direction"),
        ('<joint springdamper="1 1"/>', "springdamper.*write damping"),
        ('<joint damping="1 -1"/>', "less than in proportion"),
        ('<joint damping="-1"/>', "friction < 0"),
        ('<joint name="a"/><joint name="a"/>', "name of another joint, 'a'"),
        ('<body quat="1 0 0 0" euler="1 2 3"/>', "has quat and euler"),
        ('</body></worldbody><equality><weld body1="b"/></equality><worldbody><body>', "<weld> couples"),
        (
            '<joint/></body><body><joint frictionloss="1" armature="2"/>',
            "damping=….*in <joint> in the description; frictionloss is Coulomb.*; armature is inertia$",
        ),
    ],
)
def test_what_mujoco_or_we_cannot_read_is_refused(inside, words, tmp_path):
    """With the line of the element; advice is in the words of the format."""
    path = tmp_path / "arm.xml"
    path.write_text(f"<mujoco><worldbody><body>\n{inside}</body></worldbody></mujoco>")
    with pytest.raises(zw.InputError, match=words.replace("…", '"…"')):
        read_arm(path)


FOLLOWING = """<robot name="mim">
<link name="base"/><link name="a"/><link name="b"/><link name="c"/><link name="tip"/>
<joint name="lift" type="revolute">
 <parent link="base"/><child link="a"/><axis xyz="0 0 1"/>
 <limit lower="-0.5" upper="0.5" effort="5" velocity="3"/><dynamics damping="0.1" friction="0.02"/></joint>
<joint name="swing" type="revolute">
 <parent link="a"/><child link="b"/><origin xyz="0.2 0 0"/><axis xyz="0 0 1"/>
 <limit lower="0.5" upper="1.5" effort="5" velocity="3"/><dynamics damping="0.1" friction="0.02"/></joint>
<joint name="follow" type="revolute">
 <parent link="b"/><child link="c"/><origin xyz="0.2 0 0"/><axis xyz="0 0 1"/>
 <mimic joint="lift" multiplier="3" offset="0.1"/>
 <limit lower="-1.4" upper="2" effort="5" velocity="3"/><dynamics damping="0.001" friction="0.01"/></joint>
<joint name="tipj" type="fixed">
 <parent link="c"/><child link="tip"/><origin xyz="0.2 0 0"/></joint></robot>"""
MIMIC = '<mimic joint="lift" multiplier="3" offset="0.1"/>'


@pytest.mark.parametrize("form", ["urdf", "xml"])
def test_a_joint_that_follows_is_part_of_the_mechanism(form, tmp_path):
    """J G of the three joints by themselves, Gᵀ b G, |G|ᵀ f; the bounds between the points hold."""
    both = tmp_path / f"both.{form}", tmp_path / f"apart.{form}"
    text, coupled = FOLLOWING, MIMIC
    if form == "xml":
        joint = '<joint name="{}" range="{}" damping="{}" frictionloss="{}"/>'
        bodies = [("lift", "-0.5 0.5", 0.1, 0.02), ("swing", "0.5 1.5", 0.1, 0.02)]
        bodies += [("follow", "-1.4 2", 0.001, 0.01)]
        inner = '<body name="tip" pos="0.2 0 0"/>'
        for place, each in reversed(list(enumerate(bodies))):
            inner = f'<body pos="{0.2 * (place > 0)} 0 0">{joint.format(*each)}{inner}</body>'
        coupled = '<equality><joint joint1="follow" joint2="lift" polycoef="0.1 3 0 0 0"/></equality>'
        text = f'<mujoco><compiler angle="radian"/><worldbody>{inner}</worldbody>{coupled}</mujoco>'
    both[0].write_text(text)
    both[1].write_text(text.replace(coupled, ""))
    arm, apart = (read_arm(path, frame="tip", pose=True, whole=True) for path in both)
    g = np.array([[1.0, 0], [0, 1], [3, 0]])
    assert arm.joint_names == ("lift", "swing")
    assert arm.joint_range == (pytest.approx((-0.5, 0.5)), pytest.approx((0.5, 1.5)))
    assert arm.damping == pytest.approx((0.109, 0.1))
    assert arm.coulomb_friction == pytest.approx((0.05, 0.02))
    q = np.random.default_rng(1).uniform(-1, 1, (5, 2))
    position, jacobian = apart.placed(q @ g.T + [0, 0, 0.1])
    assert arm.placed(q)[0][..., :3] == pytest.approx(position[..., :3], abs=1e-14)
    assert arm.placed(q)[1] == pytest.approx(jacobian @ g, abs=1e-14)
    resting, rng = arm.replace(rest=(0.1, 0.7)), np.random.default_rng(2)
    moved = [(resting.forward(q + e) - resting.forward(q - e)) / 2e-6 for e in 1e-6 * np.eye(2)]
    assert resting.jacobian(q) == pytest.approx(np.stack(moved, axis=-1), abs=1e-8)
    for held in (arm, resting):
        sites = held.sites(6)
        for _ in range(40):
            place = tuple(rng.integers(6, size=2))
            there = held.placed(sites.joints[place] + rng.choice([-1, 1], 2) / 12)[1]
            assert np.linalg.norm(there[:3] - sites.jacobians[place][:3], 2) <= sites.parts[place][0]
            assert np.linalg.norm(there[3:] - sites.jacobians[place][3:], 2) <= sites.parts[place][1] + 1e-15
    assert (arm.follows, apart.follows) == (True, False)


def test_what_a_mechanism_with_a_follower_bears(tmp_path):
    """By a proof on paper; a stiffer wall is refuted by a hand, who holds two joints and not three."""
    path = tmp_path / "mim.urdf"
    path.write_text(FOLLOWING)
    arm = read_arm(path, frame="tip")
    stiffest = zw.workspace(arm, zw.Wall(100), rate=1000, points=40).largest_stiffness
    q = arm.sites(40).joints
    j = arm.jacobian(q)
    loads = np.linalg.eigvals(np.linalg.solve(np.diag(arm.damping), j.swapaxes(-1, -2) @ j))
    assert stiffest == pytest.approx(2000 / loads.real.max(), rel=2e-3)
    spaces = [zw.workspace(arm, zw.Wall(k * stiffest), rate=1000, points=40) for k in (0.9, 1.1)]
    assert [space.outcome for space in spaces] == ["theorem", "active"]
    assert "follow others" in spaces[0].claim
    stepping = zw.workspace(arm.replace(resolution=(1e-4, 1e-4)), zw.Wall(10), rate=1000, points=10)
    assert (stepping.encoder, "not counted" in stepping.claim) == ("ideal", True)
    for other, words in (
        ("nobody", "line 11: joint 'follow' follows 'nobody'"),
        ("follow", "'follow' follows itself"),
    ):
        path.write_text(FOLLOWING.replace('mimic joint="lift"', f'mimic joint="{other}"'))
        with pytest.raises(zw.InputError, match=words):
            read_arm(path)


@pytest.mark.parametrize(
    ("damping", "words"),
    [
        ((0.0213, 0.01), "of motors or links; simulators' files often hold placeholders"),
        ((0.7, 0.7), "one number for every joint, most likely a simulator's"),
        ((10, 2), "round numbers, most likely"),
    ],
)
def test_damping_of_a_description_is_told_as_such(damping, words, urdf):
    text = urdf.read_text(encoding="utf-8")
    for before, after in zip((0.02, 0.01), damping, strict=True):
        text = text.replace(f'damping="{before}"', f'damping="{after}"')
    urdf.write_text(text, encoding="utf-8")
    told = zw.workspace(read_arm(urdf), zw.Wall(1), rate=1000, points=4).to_dict()
    assert words in told["joint_damping_source"]
    given = zw.workspace(read_arm(urdf, damping=[0.1]), zw.Wall(1), rate=1000, points=4)
    assert "joint_damping_source" not in given.to_dict()


def test_urdf_is_read_as_pinocchio_reads_it(tmp_path):
    pin = pytest.importorskip("pinocchio")
    turned = _joint("x", "d", "c", 0.4, extra=LIMIT.format(0.5))
    path = robot(
        tmp_path / "tree.urdf",
        "gfedcba",
        _joint("z", "g", "f", 0.1, "continuous", '<dynamics damping="1"/>'),
        _joint("B", "g", "e", 0.2, "prismatic", LIMIT.format(0.3)),
        _joint("a", "e", "d", 0.3, "fixed"),
        turned.replace('xyz="0.4 0 0"', 'xyz="0 1 2" rpy="1 2 3"'),
        _joint("c", "f", "b", 0.5, extra=LIMIT.format(0.6)),
        _joint("y", "b", "a", 0.6, "fixed"),
    )
    model = pin.buildModelFromUrdf(str(path))
    arm = read_arm(path, frame="c", pose=True, hold={"z": 0, "c": 1})
    assert arm.joint_names == tuple(model.names)[1:]
    assert [frame.name for frame in arm.model.frames] == [frame.name for frame in model.frames][1:]
    assert (arm.damping, arm.coulomb_friction) == (tuple(model.damping), tuple(model.friction))
    data = model.createData()
    for q in np.random.default_rng(3).uniform(-2, 2, (5, 4)):
        pin.computeJointJacobians(model, data, pin.integrate(model, pin.neutral(model), q))
        number = model.getFrameId("c", pin.FrameType.BODY)
        placed = pin.updateFramePlacement(model, data, number).translation
        full = pin.getFrameJacobian(model, data, number, pin.LOCAL_WORLD_ALIGNED)
        assert arm.placed(q)[0][:3] == pytest.approx(placed, abs=1e-12)
        assert arm.placed(q)[1] == pytest.approx(full, abs=1e-12)


def test_what_cannot_be_read_is_said_in_one_line(tmp_path, urdf, capfd):
    """With the line of the file where it has one, and nothing on standard error."""
    whole = urdf.read_text(encoding="utf-8")
    for name, content, words in (
        ("none.urdf", None, "no file"),
        ("arm.step", None, "described in"),
        ("broken.urdf", "<robot", "broken.urdf cannot be read: it is no XML"),
        ("undamped.urdf", whole.replace("damping", "nothing"), "any damping.*<dynamics.*; friction is Coul"),
        ("lost.urdf", whole.replace(LINK.format("tip"), ""), r"^lost.urdf cannot be read: line \d+: .*\w$"),
        ("empty.xml", '<robot name="another format"/>', r"^empty.xml cannot be read: line \d+: .*\w$"),
    ):
        if content is not None:
            (tmp_path / name).write_text(content, encoding="utf-8")
        with pytest.raises(zw.InputError, match=words):
            read_arm(tmp_path / name)
    with pytest.raises(zw.InputError, match=r'no frame .*did you mean "tip"'):
        read_arm(urdf, frame="tipp")
    with pytest.raises(zw.InputError, match="take a frame farther out"):
        read_arm(urdf, frame="base")
    fingers = [
        _joint(f"to {side}", "tip", side, 0.01, extra=LIMIT.format(0.01)) for side in ("left", "right")
    ]
    names = ("base", "upper", "lower", "tip", "left", "right")
    gripper = robot(tmp_path / "gripper.urdf", names, SHOULDER, ELBOW, HAND, *fingers)
    with pytest.raises(
        zw.InputError, match=r"gripper.urdf branches, and ends at left, right: .* --frame NAME"
    ):
        read_arm(gripper)
    assert read_arm(gripper, frame="tip").frame == "tip"
    assert capfd.readouterr() == ("", "")


ENTITIES = "<!DOCTYPE robot [<!ENTITY a '{}'>{}]>".format(
    10 * "x", "".join(f"<!ENTITY {b} '{10 * f'&{a};'}'>" for a, b in zip("abcdefgh", "bcdefghi", strict=True))
)


@pytest.mark.parametrize(
    ("start", "inside", "message"),
    [
        (ENTITIES, "<link name='&i;'/>", "a DOCTYPE"),
        ("<!DOCTYPE robot [<!ENTITY a SYSTEM 'file:///etc/hostname'>]>", "&a;", "a DOCTYPE"),
        ("", "<include file='../other.xml'/>", "another file"),
        ("", 300 * "<body>" + 300 * "</body>", "more than 200 levels"),
        ("", 3000 * "<link/>", "or 2000 bodies and joints"),
        ("", (2**25 + 1) * " ", "larger than"),
    ],
)
def test_descriptions_that_lead_elsewhere_or_without_end_are_refused(start, inside, message, tmp_path):
    """Entities that stand for gigabytes or for other files, files in files, levels without end."""
    for ending in ("urdf", "xml"):
        path = tmp_path / f"arm.{ending}"
        path.write_text(f"{start}<robot name='arm'>{inside}</robot>", encoding="utf-8")
        with pytest.raises(zw.InputError, match=f"arm.{ending} cannot be read: it .*{message}") as caught:
            read_arm(path)
        assert "\n" not in str(caught.value)


def test_a_joint_is_held_where_it_can_be(tmp_path, urdf):
    """At an end of its range, not past it, as degrees would be; a rail without limits anywhere."""
    assert read_arm(urdf, hold={"elbow": 2.4}).sites(3).region == (
        "shoulder from 0.2 to 2.4 rad; elbow held at 2.4 rad"
    )
    for value in (2.4001, 30, float("nan")):
        with pytest.raises(
            zw.InputError, match=r"elbow can be 0.2 to 2.4 rad, got|elbow is in rad: .*, got nan"
        ):
            read_arm(urdf, hold={"elbow": value})
    rail = tmp_path / "rail.xml"
    rail.write_text(
        '<mujoco><compiler angle="radian"/><worldbody><body name="car">'
        '<joint name="rail" type="slide" axis="1 0 0"/>'
        '<geom type="sphere" size="0.1"/><body name="arm"><joint name="turn" type="hinge" axis="0 0 1" '
        'range="0 1" damping="0.1"/><geom type="sphere" size="0.1"/></body></body></worldbody></mujoco>'
    )
    with pytest.raises(zw.InputError, match="slides without limits"):
        read_arm(rail, damping=(1, 1))
    assert read_arm(rail, hold={"rail": 7}).sites(3).region == "turn from 0 to 1 rad; rail locked at 7 m"


def test_a_locked_joint_is_a_fixed_one(tmp_path):
    """Turning and sliding, followed by another: the hand is where it was, without their columns."""
    links = ("base", "upper", "lower", "tip", "hand", "claw")
    follow = '<mimic joint="elbow" multiplier="-0.5" offset="0.1"/>' + LIMIT.format(0.1).replace(
        'damping="0.1"', 'damping="0"'
    )
    parts = (
        _joint("shoulder", "base", "upper", 0.05, extra=LIMIT.format(0.02)),
        _joint("elbow", "upper", "lower", 0.1, extra=LIMIT.format(0)),
        _joint("wrist", "lower", "tip", 0.2, extra=follow),
        _joint("slide", "tip", "hand", 0.3, "prismatic", LIMIT.format(0)),
        _joint("last", "hand", "claw", 0.15, extra=LIMIT.format(0.04)),
    )
    path = robot(tmp_path / "arm.urdf", links, *parts)
    held = {"elbow": 0.7, "slide": "0.25 m"}
    full = read_arm(path, damping=(1, 1, 1, 1), coulomb_friction=(1, 2, 3, 4))
    arm = read_arm(path, hold=held, coulomb_friction=(1, 2, 3, 4), resolution=["1 deg", 0, "1 mm", 0.1])
    assert (arm.joint_names, arm.damping, arm.coulomb_friction) == (
        ("shoulder", "last"),
        (0.02, 0.04),
        (1, 4),
    )
    for q in np.random.default_rng(2).uniform(0.3, 1, (5, 2)):
        at = (q[0], 0.7, 0.25, q[1])
        assert arm.forward(q) == pytest.approx(full.forward(at), abs=1e-14)
        assert arm.jacobian(q) == pytest.approx(full.jacobian(at)[:, [0, 3]], abs=1e-14)
    assert arm.sites(3).region.endswith("elbow locked at 0.7 rad; slide locked at 250 mm")
    space = zw.workspace(arm.replace(resolution=()), zw.Wall(10), rate=1000, points=10)
    assert space.outcome == "passive"
    with pytest.raises(zw.InputError, match="gives elbow and slide no damping"):
        read_arm(path)
