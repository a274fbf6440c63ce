#!/usr/bin/env bash
# All joints of an arm in one column, as data sets of arms keep them, through pandas 3.1.1 (pyarrow 26.0.1).
#
# A table laid out as LeRobot's: timestamp, frame_index, and observation.state as a fixed-size list of 14
# numbers. Seen:
#   select_dtypes("number"), describe   timestamp and frame_index; the motion is not among them, and nothing says so
#   to_csv                              one cell of text, 8 digits after the point, broken over lines inside the cell
#   read_csv of that                    text: no number comes back
# Where it bites: a search for numeric columns finds a log without motion; and in the CSV a position of
# 0.00123456789 m is left with 0.00123457: steps of 10 nm, 10 µm/s at 1 kHz, which a law with damping turns
# into force.
# Instead: numpy.stack(frame["observation.state"]) and a column for each joint, with the names from the data
# set's own description, before anything is written.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check pyarrow==26.0.1 pandas==3.1.1 numpy==2.4.6
cd "$work"
venv/bin/python - <<'PYTHON'
import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

states = [[0.00123456789 + row / 100 + joint / 70 for joint in range(14)] for row in range(3)]
table = pa.table(
    {
        "timestamp": pa.array([0.0, 1 / 30, 2 / 30], pa.float32()),
        "frame_index": [0, 1, 2],
        "observation.state": pa.array(states, pa.list_(pa.float64(), 14)),
    }
)
pq.write_table(table, "episode.parquet")
frame = pd.read_parquet("episode.parquet")
numeric = frame.select_dtypes("number").columns.tolist()
described = frame.describe().columns.tolist()
print("numeric:", numeric, "described:", described, "state:", frame["observation.state"].dtype)
assert numeric == described == ["timestamp", "frame_index"], (numeric, described)

frame.to_csv("episode.csv", index=False)
cell = pd.read_csv("episode.csv")["observation.state"][0]
print("a cell of the CSV:", repr(cell))
assert isinstance(cell, str) and "\n" in cell
first = float(cell.strip("[]").split()[0])
assert first == 0.00123457, first

whole = np.stack(frame["observation.state"])
assert whole.tolist() == states
print("as described")
PYTHON
