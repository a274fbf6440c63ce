#!/usr/bin/env bash
# foxglove-sdk 0.30.3: what Channel.log writes as "json" is not JSON as soon as a number is not finite.
#
# A dictionary with NaN (the usual mark of a missing reading) and infinity (the usual "no limit"). Seen in the
# MCAP file:
#   b'{"force": NaN, "limit": Infinity}'    on a channel with message_encoding "json"
#   Python's json reads it back; orjson 3.11.4, which keeps to the standard as browsers do, refuses it
#   a float32 of NumPy raises TypeError, a float64 does not
# Where it bites: one missing reading makes that message unreadable for every strict reader, while the program
# that wrote it reads its own file without complaint; sensors' drivers that give float32 end the loop.
# Instead: None (null) for what is missing, leave out a limit that is not there, float() around what comes
# from NumPy.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check foxglove-sdk==0.30.3 mcap==1.6.0 orjson==3.11.4 numpy==2.4.6
cd "$work"
venv/bin/python - <<'PYTHON'
import json
import math

import foxglove
import numpy as np
import orjson
from mcap.reader import make_reader

channel = foxglove.Channel("/touch")
with foxglove.open_mcap("touch.mcap"):
    channel.log({"force": math.nan, "limit": math.inf}, log_time=1)
    channel.log({"force": np.float64(1.5)}, log_time=2)
    try:
        channel.log({"force": np.float32(1.5)}, log_time=3)
    except TypeError as error:
        told = str(error)
with open("touch.mcap", "rb") as file:
    (_, kept, odd), (_, _, plain) = make_reader(file).iter_messages()
print(kept.message_encoding, odd.data, plain.data, told)
assert kept.message_encoding == "json"
assert odd.data == b'{"force": NaN, "limit": Infinity}', odd.data
assert math.isnan(json.loads(odd.data)["force"])
try:
    orjson.loads(odd.data)
except orjson.JSONDecodeError as error:
    print("orjson:", error)
else:
    raise AssertionError("a strict reader takes it")
assert plain.data == b'{"force": 1.5}'
print("as described")
PYTHON
