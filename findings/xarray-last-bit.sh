#!/usr/bin/env bash
# xarray 2026.9.0: force times velocity drops the samples whose stamps differ in the last bit.
#
# The same 1000 instants at 1 kHz, once counted (k * 0.001) and once added up (t += 0.001), as two programs
# write them. Seen:
#   force * velocity        10 of 1000 samples are left, without a word
#   the sum of the power    is that of those few
#   join="exact"            raises, as one would wish
# Where it bites: the work done at a device (is it passive?) is the sum of force times velocity; of two logs
# it comes out near 0.
# Instead: xarray.set_options(arithmetic_join="exact") at the head of an analysis, and
# reindex(method="nearest", tolerance=…).
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check xarray==2026.9.0 pandas==3.1.1 numpy==2.4.6
cd "$work"
venv/bin/python - <<'PYTHON'
import itertools

import numpy as np
import xarray as xr

counted = np.arange(1000) * 0.001
added = np.array(list(itertools.accumulate([0.0] + [0.001] * 999)))
assert np.abs(counted - added).max() < 1e-13
force = xr.DataArray(np.ones(1000), dims="time", coords={"time": counted})
velocity = xr.DataArray(np.ones(1000), dims="time", coords={"time": added})
power = force * velocity
print("samples of the power:", power.size, "of 1000; work", float(power.sum()) * 0.001, "J, true", 1.0, "J")
left = np.intersect1d(counted, added).size
assert power.size == left == 10, (power.size, left)
with xr.set_options(arithmetic_join="exact"):
    try:
        force * velocity
    except xr.AlignmentError as error:
        print("exact:", str(error).splitlines()[0])
    else:
        raise AssertionError("stamps that differ are taken for equal")
print("as described")
PYTHON
