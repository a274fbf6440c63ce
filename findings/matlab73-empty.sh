#!/usr/bin/env bash
# A MAT-file of version 7.3 through h5py 3.16.0: empty arrays are two numbers, matrices lie on their side, text is integers.
#
# Written by hdf5storage 0.2.2, which lays a file out as MATLAB does. Seen:
#   zeros(0, 0)         array of two numbers, 0 0; zeros(0, 3): 0 3. The numbers are the shape; only MATLAB_empty = 1 tells
#   2 x 3 matrix        shape (3, 2): row and column are exchanged
#   'abc'               3 x 1 array of uint16 97 98 99
# Where it bites: a recording without a touch (forces = []) is read as a log of two samples, 0 and 0 N, and
# has a mean, a period and a place in the statistics; three axes by N samples becomes N by three in one reader
# (h5py) and not in the other (scipy, up to 7.2).
# Instead: look at MATLAB_empty before the data, transpose each matrix, and go by MATLAB_class for the type.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check h5py==3.16.0 hdf5storage==0.2.2 numpy==2.4.6
cd "$work"
venv/bin/python - <<'PYTHON'
import h5py
import hdf5storage
import numpy as np

logged = {"force": np.zeros((0, 0)), "axes": np.zeros((0, 3)), "path": np.arange(6.0).reshape(2, 3), "name": "abc"}
hdf5storage.savemat("log.mat", logged, format="7.3", store_python_metadata=False)
seen = {}
with h5py.File("log.mat") as file:
    for name in logged:
        data = file[name]
        seen[name] = data.shape, str(data.dtype), data[()].ravel().tolist(), int(data.attrs.get("MATLAB_empty", 0))
        print(name, seen[name])
assert seen["force"][2:] == ([0, 0], 1)
assert seen["axes"][2:] == ([0, 3], 1)
assert seen["path"] == ((3, 2), "float64", [0, 3, 1, 4, 2, 5], 0)
assert seen["name"][1:3] == ("uint16", [97, 98, 99])
print("as described")
PYTHON
