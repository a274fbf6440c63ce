#!/usr/bin/env bash
# rosbags 0.11.9 and mcap 1.6.0: a conversion from MCAP to MCAP loses when a message was sent.
#
# MCAP gives each message two times and a number: publish_time (sent), log_time (received by the recorder),
# sequence. rosbags knows one time, the second. Seen, of three messages after rosbags.convert:
#   log_time      1000, 1010, 1020   as before
#   publish_time  1000, 1010, 1020   was 900, 913, 920
#   sequence      0, 0, 0            was 1, 2, 4: that one was lost on the way can no longer be seen
# Where it bites: the sample period and the delay of a loop are in publish_time; log_time has the recorder's
# queue in it. After a filter or a merge with this tool the jitter seen is the recorder's, and the delay
# between the two is 0.
# Instead: take times and gaps from the file as recorded, or from header.stamp, and convert only what is
# played back.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check rosbags==0.11.9 mcap==1.6.0 mcap-ros2-support==0.6.0
cd "$work"
venv/bin/python - <<'PYTHON'
from mcap_ros2.writer import Writer

with open("before.mcap", "wb") as file:
    writer = Writer(file)
    number = writer.register_msgdef("std_msgs/msg/Float64", "float64 data\n")
    for received, sent, sequence in ((1000, 900, 1), (1010, 913, 2), (1020, 920, 4)):
        writer.write_message(
            "/force", number, {"data": 1.0}, log_time=received, publish_time=sent, sequence=sequence
        )
    writer.finish()
PYTHON
venv/bin/rosbags-convert --src before.mcap --dst after --dst-storage mcap
venv/bin/python - <<'PYTHON'
from mcap.reader import make_reader


def times(path):
    with open(path, "rb") as file:
        seen = [(message.log_time, message.publish_time, message.sequence) for _, _, message in make_reader(file).iter_messages()]
    print(path, "(log_time, publish_time, sequence):", seen)
    return seen


assert times("before.mcap") == [(1000, 900, 1), (1010, 913, 2), (1020, 920, 4)]
assert times("after/after.mcap") == [(1000, 1000, 0), (1010, 1010, 0), (1020, 1020, 0)]
print("as described")
PYTHON
