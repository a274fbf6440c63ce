"""Gains that are proved, written for ROS 2: nearest to a file, the stiffest; and the file that they make."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
import yaml
from described_arms import panda_like

import zwidth as zw
from zwidth.cli.main import main
from zwidth.data.gains import passive_gains, read_controllers
from zwidth.data.gains.passive import PassiveGains

ARM = """
controller_manager: {ros__parameters: {update_rate: 1000}}
arm:
  ros__parameters:
    gains:
      good: {p: 123.456, d: 0.125}
      "no": {p: 100000, i: 2.0, d: 0.0}
/**: {impedance: {ros__parameters: {k_gains: [500.0], d_gains: [30.0]}}}
"""


def written(folder: Path, text: str, name: str) -> Path:
    """A file."""
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def found(folder: Path, **asked: object) -> PassiveGains:
    """For joints with 1 N·m·s/rad."""
    controllers = read_controllers(written(folder, ARM, "arm.yaml"))
    return passive_gains(controllers, zw.Device(damping=1, rate=1, motion="rotary"), **asked)  # type: ignore[arg-type]


def test_what_is_proved_stays_and_what_is_not_is_the_nearest(tmp_path: Path) -> None:
    """A spring one period late needs 3 p T/2; one that is kept has as much of its d as 0.8 b pays for."""
    good, spring, damped = found(tmp_path).joints
    assert (float(good.law.stiffness), float(good.law.damping)) == (123.456, 0.125)
    assert float(spring.law.stiffness) == 533.3
    assert (spring.law.integral, spring.law.damping) == (0, 0)
    assert damped.law.stiffness == 500
    assert 0 < damped.law.damping < 1
    device, more = damped.verdict.device, damped.law.damping * 1001 / 1000
    assert float(device.damping) == 0.8
    held = zw.PulseTransferFunction([500 + more * 1000, -more * 1000], [1, 0])
    assert zw.check(device, held).outcome == "active"
    assert all(joint.verdict.passive for joint in (good, spring, damped))


def test_the_stiffest_needs_its_damper(tmp_path: Path) -> None:
    """Some d lets the spring be stiffer than 2 b/3 T; 2 % more is active; half the share, half of both."""
    whole, half = found(tmp_path, stiffest=True, share=1).joints[0], found(tmp_path, stiffest=True, share=0.5)
    p, d = float(whole.law.stiffness), float(whole.law.damping)
    assert p > 1.1 / 0.0015
    stiffer = zw.PulseTransferFunction([1.02 * p + 1000 * d, -1000 * d], [1, 0])
    assert zw.check(whole.verdict.device, stiffer).outcome == "active"
    assert float(half.joints[0].law.stiffness) == pytest.approx(p / 2, rel=1e-3)


def test_the_file_has_the_types_that_ros_asks_for_and_is_read_again(tmp_path: Path) -> None:
    """Doubles with a point, a whole rate, names that YAML would take for a truth value; units in comments."""
    gains = found(tmp_path)
    gains.save(tmp_path / "passive.yaml")
    text = (tmp_path / "passive.yaml").read_text(encoding="utf-8")
    tree = yaml.safe_load(text)
    assert tree["controller_manager"] == {"ros__parameters": {"update_rate": 1000}}
    own = tree["arm"]["ros__parameters"]["gains"]
    assert list(own) == ["good", "no"]
    assert {type(value) for row in own.values() for value in row.values()} == {float}
    assert "p: 533.3  # N*m/rad; your file: 100000" in text
    assert "no 0.8" in text
    again = read_controllers(tmp_path / "passive.yaml")
    laws = [(law.name, law.stiffness, law.integral, law.damping) for law in again.joints]
    assert laws == [(j.law.name, j.law.stiffness, 0, j.law.damping) for j in gains.joints]
    assert again.rate == 1000


def test_the_page_shows_what_comes_out(tmp_path: Path) -> None:
    """Of the file that it begins with, for joints of 1 N·m·s/rad."""
    page = (Path(__file__).parents[2] / "docs" / "gain-files.md").read_text(encoding="utf-8")
    asked, shown = re.findall(r"```yaml\n(.*?)```", page, re.DOTALL)
    controllers = read_controllers(written(tmp_path, asked, "controllers.yaml"))
    text = passive_gains(controllers, zw.Device(damping=1, rate=1, motion="rotary")).to_yaml()
    assert text.endswith(f"\n{shown}")


def test_on_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Status of the file that was read; the next run says passive; no file is lost."""
    arm, plant = written(tmp_path, ARM, "arm.yaml"), written(tmp_path, "[arm]\ndamping = 1\n", "plant.toml")
    out, proofs = tmp_path / "passive.yaml", tmp_path / "proofs.json"
    asked = ["gains", str(arm), "--plant", str(plant)]
    assert main([*asked, "-o", str(out)]) == 1
    assert "written, each proved with 80 % of b" in capsys.readouterr().out
    assert main(["gains", str(out), "--plant", str(plant), "-o", str(proofs)]) == 0
    assert main(["verify", str(proofs)]) == 0
    assert capsys.readouterr().out.count("VALID") == 1 + 3
    assert main([*asked, "-o", str(out)]) == 2
    assert "exists" in capsys.readouterr().err
    assert main([*asked, "-o", str(arm), "--force"]) == 2
    assert "choose another name" in capsys.readouterr().err
    assert main([*asked, "--share", "0.5"]) == 2
    assert "add -o" in capsys.readouterr().err
    assert arm.read_text(encoding="utf-8") == ARM


@pytest.mark.parametrize(
    ("joint", "share", "message"),
    [
        ({"damping": 1}, 0, "0 < share"),
        ({"damping": 0}, 1, "no gains of good are proved: 0 N"),
        ({"damping": 1, "resolution": 1e-4}, 1, "give coulomb_friction"),
    ],
)
def test_what_cannot_be_is_refused(
    tmp_path: Path, joint: dict[str, float], share: float, message: str
) -> None:
    """A share of nothing; a joint without damping, or with steps and no friction that covers them."""
    controllers = read_controllers(written(tmp_path, ARM, "arm.yaml"))
    with pytest.raises(zw.InputError, match=message):
        passive_gains(controllers, zw.Device(**joint, rate=1, motion="rotary"), share=share)


END = """
end:
  ros__parameters:
    stiffness:
      translation: {x: 600.0, y: 500.0, z: 400.0}
      nullspace_stiffness: 20
"""


def test_an_impedance_that_postures_bear(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """K stays, ζ goes down to what 0.8 of the damping pays for: all of it pays for 1.25 times as much."""
    arm, end = panda_like(tmp_path / "panda.urdf"), written(tmp_path, END, "end.yaml")
    out = tmp_path / "borne.yaml"
    asked = ["workspace", str(arm), "--rate", "1 kHz", "--postures", "100"]
    assert main([*asked, "--wall", str(end), "-o", str(out)]) == 1
    assert "ζ = 0.0" in capsys.readouterr().out
    own = yaml.safe_load(out.read_text(encoding="utf-8"))["end"]["ros__parameters"]
    assert own["stiffness"] == {"translation": {"x": 600.0, "y": 500.0, "z": 400.0}}
    (zeta,) = set(own["damping"]["translation"].values())
    assert 0.005 < zeta < 0.02
    assert "between them nothing is proved" in " ".join(out.read_text(encoding="utf-8").split())
    assert main([*asked, "--wall", str(out), "--json"]) == 3
    told = json.loads(capsys.readouterr().out)
    assert 1.25 < told["damping_factor"] < 1.5
    for more, part in (
        (["--wall", str(end), "-o", str(end), "--force"], "choose another name"),
        (["--stiffness", "9", "-o", str(tmp_path / "a.yaml")], "whose names it takes"),
        (["--stiffness", "9", "--share", "1"], "add -o passive.yaml"),
    ):
        assert main([*asked, *more]) == 2
        assert part in capsys.readouterr().err
