#!/usr/bin/env bash
# mcap-ros2-support 0.6.0: a field that the message does not have is left out in silence, and the one that it has is written empty.
#
# sensor_msgs/JointState calls the force "effort". Seen:
#   {"position": [0.1], "torque": [2.5]}   written; read back as effort []
#   Wrench with {"force": {"X": 1.5}}      written; read back as force.x 0.0
#   a NumPy array as position              ValueError: it "is not an array"
# Where it bites: a recording of ten minutes in which every force is 0 or missing, found when it is analysed.
# The one mistake that is told (an array of NumPy) is the one that does no harm.
# Instead: compare the dictionary's keys with the definition once per topic, or read the first message back.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check mcap==1.6.0 mcap-ros2-support==0.6.0 numpy==2.4.6
cd "$work"
venv/bin/python - <<'PYTHON'
import io

import numpy as np
from mcap_ros2.reader import read_ros2_messages
from mcap_ros2.writer import Writer

file = io.BytesIO()
writer = Writer(file)
state = writer.register_msgdef(
    "sensor_msgs/msg/JointState", "string[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n"
)
wrench = writer.register_msgdef(
    "geometry_msgs/msg/Wrench",
    "geometry_msgs/Vector3 force\n" + "=" * 80 + "\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n",
)
writer.write_message("/joint_states", state, {"position": [0.1], "torque": [2.5]}, log_time=1, publish_time=1)
writer.write_message("/wrench", wrench, {"force": {"X": 1.5}}, log_time=2, publish_time=2)
try:
    writer.write_message("/joint_states", state, {"position": np.array([0.1])}, log_time=3, publish_time=3)
except ValueError as error:
    refused = str(error)
writer.finish()
file.seek(0)
joints, force = (message.ros_msg for message in read_ros2_messages(file))
print("JointState:", joints.position, joints.effort, "Wrench:", force.force.x, "NumPy:", refused)
assert (joints.position, joints.effort) == ([0.1], [])
assert force.force.x == 0.0
assert "is not an array" in refused
print("as described")
PYTHON
