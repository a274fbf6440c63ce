#!/usr/bin/env bash
# scipy 1.17.1 and a double of MATLAB that is stored as bytes: differences wrap round.
#
# A MAT-file (level 5) may keep an array of doubles in the smallest type that holds its values; MATLAB does so
# for whole numbers. Seen, of counts 250, 255, 3, 7 of class double:
#   loadmat(file)                   dtype uint8; numpy.diff gives 5, 4, 4 where it is 5, -252, 4
#   loadmat(file, mat_dtype=True)   float64, as MATLAB has it
# Where it bites: encoder counts, torque in raw units, flags: velocities never turn negative, 200 + 100 is 44;
# and another log of the same rig with one value above 255 (or with a fraction) is read as another type, so it
# works there.
# Instead: mat_dtype=True always, or astype(float) before any arithmetic.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check scipy==1.17.1 numpy==2.4.6
cd "$work"
venv/bin/python - <<'PYTHON'
import io
import struct

import numpy as np
from scipy.io import loadmat

INT8, UINT8, INT32, UINT32, MATRIX, DOUBLE_CLASS = 1, 2, 5, 6, 14, 6


def element(kind, data):
    return struct.pack("<II", kind, len(data)) + data + b"\0" * (-len(data) % 8)


counts = [250, 255, 3, 7]
column = (
    element(UINT32, struct.pack("<II", DOUBLE_CLASS, 0))
    + element(INT32, struct.pack("<ii", len(counts), 1))
    + element(INT8, b"counts")
    + element(UINT8, bytes(counts))
)
file = b"MATLAB 5.0 MAT-file".ljust(124) + struct.pack("<HH", 0x0100, 0x4D49) + element(MATRIX, column)

bare = loadmat(io.BytesIO(file))["counts"].ravel()
double = loadmat(io.BytesIO(file), mat_dtype=True)["counts"].ravel()
print("as delivered:", bare.dtype, np.diff(bare).tolist(), "with mat_dtype:", double.dtype, np.diff(double).tolist())
assert (str(bare.dtype), np.diff(bare).tolist()) == ("uint8", [5, 4, 4])
assert (str(double.dtype), np.diff(double).tolist()) == ("float64", [5.0, -252.0, 4.0])
print("as described")
PYTHON
