#!/usr/bin/env bash
# pinocchio's reader of MJCF, pin 4.1.0, against MuJoCo 4.0.0, whose format it is, on four valid files.
#
# Seen, without a word on standard output or error:
#   a <body> without attributes is left out, with its joints     1 joint; MuJoCo has 2
#   range="-0.5 0.5" of a slide joint is taken for degrees       ±0.0087 m; MuJoCo ±0.5 m
#   limited="false" beside a range                               limits ±1.047 rad; MuJoCo none
#   damping="0.2 0.05", a polynomial in MuJoCo 4     0; MuJoCo 0.2 (and 0.05 |v| more)
# The documentation of MuJoCo (XML reference, body/joint) says what each of them means.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check pin==4.1.0 mujoco==4.0.0 mujoco-core==4.0.0
cd "$work"
venv/bin/python - <<'PYTHON'
import mujoco
import numpy as np
import pinocchio as pin

GEOM = '<geom type="sphere" size="0.1"/>'
ARM = (
    '<mujoco><worldbody><body{}><joint name="j1" {}/>' + GEOM + '<body name="b" pos="0.2 0 0">'
    '<joint name="j2" axis="0 1 0"/>' + GEOM + "</body></body></worldbody></mujoco>"
)


def read(name, body, joint):
    text = ARM.format(body, joint)
    path = f"{name}.xml"
    open(path, "w").write(text)
    return pin.buildModelFromMJCF(path), mujoco.MjModel.from_xml_path(path)


ours, theirs = read("bare", "", 'axis="0 0 1"')
assert (ours.nv, theirs.nv) == (1, 2), (ours.nv, theirs.nv)

ours, theirs = read("slide", ' name="a"', 'type="slide" range="-0.5 0.5"')
assert np.isclose(ours.upperPositionLimit[0], np.deg2rad(0.5)), ours.upperPositionLimit
assert theirs.jnt_range[0, 1] == 0.5

ours, theirs = read("free", ' name="a"', 'range="-60 60" limited="false"')
assert np.isclose(ours.upperPositionLimit[0], np.deg2rad(60)), ours.upperPositionLimit
assert not theirs.jnt_limited[0]

ours, theirs = read("thick", ' name="a"', 'damping="0.2 0.05"')
assert ours.damping[0] == 0, ours.damping
assert theirs.dof_damping[0] == 0.2
print("as described")
PYTHON
