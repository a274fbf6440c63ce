"""Arms from URDF and MJCF are the arms that they describe."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import zwidth as zw
from zwidth.arms import PlanarChain, read_arm

pytest.importorskip("pinocchio")

LINK = '<link name="{}"/>'


def _joint(name: str, parent: str, child: str, x: float, kind: str = "revolute", extra: str = "") -> str:
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{x} 0 0"/><axis xyz="0 0 1"/>{extra}</joint>'
    )


LIMIT = '<limit lower="0.2" upper="2.4" effort="0.5" velocity="9"/><dynamics damping="{}" friction="0.002"/>'


@pytest.fixture
def urdf(tmp_path: Path) -> Path:
    """A two-link arm of 0.12 and 0.09 m."""
    path = tmp_path / "two.urdf"
    path.write_text(
        '<robot name="two">'
        + "".join(LINK.format(n) for n in ("base", "upper", "lower", "tip"))
        + _joint("shoulder", "base", "upper", 0.0, extra=LIMIT.format(0.02))
        + _joint("elbow", "upper", "lower", 0.12, extra=LIMIT.format(0.01))
        + _joint("hand", "lower", "tip", 0.09, "fixed")
        + "</robot>"
    )
    return path


def test_a_described_two_link_arm_is_the_closed_form(urdf: Path) -> None:
    """Positions, Jacobians, friction and limits, and the same map."""
    arm = read_arm(urdf, frame="tip")
    assert (arm.damping, arm.coulomb_friction, arm.torque_limit) == ((0.02, 0.01), (0.002, 0.002), (0.5, 0.5))
    plain = PlanarChain(links=(0.12, 0.09), damping=(0.02, 0.01), joint_range=((0.2, 2.4), (0.2, 2.4)))
    q = np.random.default_rng(1).uniform(0.2, 2.4, (6, 2))
    assert arm.forward(q)[..., :2] == pytest.approx(plain.forward(q), abs=1e-12)
    assert arm.jacobian(q)[..., :2, :] == pytest.approx(plain.jacobian(q), abs=1e-12)
    assert arm.jacobian(q)[..., 2, :] == pytest.approx(0)
    described, closed = (zw.workspace(a, zw.Wall(400), rate=1000, points=15) for a in (arm, plain))
    assert described.data["margin"].values == pytest.approx(closed.data["margin"].values, rel=1e-9)
    assert (described.data["proved"].values == closed.data["proved"].values).all()
    assert described.outcome == closed.outcome


def test_the_bound_of_a_described_arm_holds_and_is_not_far_off(urdf: Path) -> None:
    """The same as of the closed form, whose links it reads from the placements."""
    arm = read_arm(urdf, frame="tip")
    plain = PlanarChain(links=(0.12, 0.09), damping=(0.02, 0.01), joint_range=((0.2, 2.4), (0.2, 2.4)))
    assert arm.sites(9).change == pytest.approx(plain.sites(9).change)


def test_sliding_joints_and_joints_that_are_held(tmp_path: Path) -> None:
    """A rail under two links: three joints, of which one is held; the bound covers random points."""
    path = tmp_path / "rail.urdf"
    limit = '<limit lower="-0.1" upper="0.1" effort="5" velocity="1"/><dynamics damping="2"/>'
    path.write_text(
        '<robot name="rail">'
        + "".join(LINK.format(n) for n in ("base", "car", "upper", "lower", "tip"))
        + _joint("rail", "base", "car", 0.0, "prismatic", limit)
        + _joint("shoulder", "car", "upper", 0.05, extra=LIMIT.format(0.02))
        + _joint("elbow", "upper", "lower", 0.12, extra=LIMIT.format(0.01))
        + _joint("hand", "lower", "tip", 0.09, "fixed")
        + "</robot>"
    )
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
    with pytest.raises(zw.InputError, match="3 would move"):
        read_arm(path, hold={})


def test_a_joint_may_have_the_name_of_its_link(urdf: Path) -> None:
    """The hand is at the link."""
    q = [0.4, 0.9]
    expected = read_arm(urdf, frame="tip").forward(q)
    urdf.write_text(
        urdf.read_text(encoding="utf-8").replace('joint name="hand"', 'joint name="tip"'), encoding="utf-8"
    )
    assert read_arm(urdf, frame="tip").forward(q) == pytest.approx(expected)


def test_mjcf_is_read_too(tmp_path: Path) -> None:
    """One hinge; its damping is given by the caller."""
    path = tmp_path / "one.xml"
    path.write_text(
        '<mujoco model="one"><worldbody><body name="arm" pos="0 0 0">'
        '<joint name="hinge" type="hinge" axis="0 0 1" limited="true" range="-60 60"/>'
        '<geom type="capsule" fromto="0 0 0 0.3 0 0" size="0.01" mass="0.2"/>'
        '<body name="tip" pos="0.3 0 0"><geom type="sphere" size="0.01" mass="0.01"/></body>'
        "</body></worldbody></mujoco>"
    )
    arm = read_arm(path, frame="tip", damping=(0.05,))
    assert arm.forward([0.5]) == pytest.approx([0.3 * np.cos(0.5), 0.3 * np.sin(0.5), 0], abs=1e-12)


def test_what_cannot_be_read_is_said_in_one_message(tmp_path: Path, urdf: Path) -> None:
    """No file, no XML, another ending, no damping, no such frame."""
    broken = tmp_path / "broken.urdf"
    broken.write_text("<robot")
    undamped = tmp_path / "undamped.urdf"
    undamped.write_text(urdf.read_text(encoding="utf-8").replace("damping", "nothing"))
    for path, words in (
        (tmp_path / "none.urdf", "no file"),
        (broken, "broken.urdf cannot be read: it is no XML"),
        (tmp_path / "arm.step", "described in"),
        (undamped, "any damping"),
    ):
        with pytest.raises(zw.InputError, match=words):
            read_arm(path)
    with pytest.raises(zw.InputError, match="no frame"):
        read_arm(urdf, frame="hook")


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
def test_descriptions_that_lead_elsewhere_or_without_end_are_refused(
    start: str, inside: str, message: str, tmp_path: Path
) -> None:
    """Entities that stand for gigabytes or for other files, files in files, levels without end."""
    for ending in ("urdf", "xml"):
        path = tmp_path / f"arm.{ending}"
        path.write_text(f"{start}<robot name='arm'>{inside}</robot>", encoding="utf-8")
        with pytest.raises(zw.InputError, match=f"arm.{ending} cannot be read: it .*{message}") as caught:
            read_arm(path)
        assert "\n" not in str(caught.value)


def test_meshes_are_not_opened(urdf: Path) -> None:
    """Wherever they are said to be: an arm is read without them."""
    text = urdf.read_text(encoding="utf-8")
    mesh = "<visual><geometry><mesh filename='package://../../none.stl'/></geometry></visual>"
    urdf.write_text(text.replace('<link name="tip"/>', f'<link name="tip">{mesh}</link>'), encoding="utf-8")
    assert read_arm(urdf, frame="tip").damping == (0.02, 0.01)


def test_the_words_of_the_parsers_are_in_the_message_alone(
    tmp_path: Path, urdf: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    """One line each, in which no place in a C++ file stands, and nothing on standard error."""
    lost = tmp_path / "lost.urdf"
    lost.write_text(urdf.read_text(encoding="utf-8").replace(LINK.format("tip"), ""))
    empty = tmp_path / "empty.xml"
    empty.write_text('<robot name="another format"/>')
    for path in (lost, empty):
        with pytest.raises(zw.InputError, match=rf"^{path.name} cannot be read: .*\w") as caught:
            read_arm(path)
        assert not re.search(r"\n|\.[ch]pp|\.hxx|Exception", str(caught.value))
    assert capfd.readouterr() == ("", "")


def test_a_joint_is_held_where_it_can_be(tmp_path: Path, urdf: Path) -> None:
    """At an end of its range, not past it, as degrees would be; a rail without limits anywhere."""
    assert read_arm(urdf, hold={"elbow": 2.4}).sites(3).region == (
        "shoulder from 0.2 to 2.4 rad; elbow held at 2.4 rad"
    )
    for value in (2.4001, 30, float("nan")):
        with pytest.raises(zw.InputError, match=r"elbow can be from 0.2 to 2.4 rad, got"):
            read_arm(urdf, hold={"elbow": value})
    rail = tmp_path / "rail.xml"
    rail.write_text(
        '<mujoco><compiler angle="radian"/><worldbody><body name="car">'
        '<joint name="rail" type="slide" axis="1 0 0"/>'
        '<geom type="sphere" size="0.1"/><body name="arm"><joint name="turn" type="hinge" axis="0 0 1" '
        'range="0 1" damping="0.1"/><geom type="sphere" size="0.1"/></body></body></worldbody></mujoco>'
    )
    with pytest.raises(zw.InputError, match="slides without limits"):
        read_arm(rail)
    assert read_arm(rail, hold={"rail": 7}).sites(3).region == "rail held at 7 m; turn from 0 to 1 rad"
