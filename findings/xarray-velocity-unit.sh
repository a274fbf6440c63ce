#!/usr/bin/env bash
# xarray 2026.9.0: differentiate over stamps gives a velocity per unit of the stamps' storage.
#
# A handle at 1 m/s, sampled every 2 ms, with the same instants as datetime64[ms], [us], [ns] and as
# timedelta64[us]. Seen:
#   [ms] 0.001   [us] 1e-06   [ns] 1e-09   timedelta64[us] 1e-06      without a word and without a unit on the result
#   integrate    goes the other way: 1 N over 8 ms is 8, 8000, 8000000
#   datetime_unit="s"   1.0 in all of them
# Where it bites: xarray and pandas keep stamps as fine as they came, so the same analysis of two files gives
# velocities, damping and work that differ by 1000 or a million.
# Instead: datetime_unit="s" in every call, or a coordinate of float64 seconds.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check xarray==2026.9.0 pandas==3.1.1 numpy==2.4.6
cd "$work"
venv/bin/python - <<'PYTHON'
import numpy as np
import xarray as xr

for kind, unit, a_second in (
    ("datetime64", "ms", 1e3),
    ("datetime64", "us", 1e6),
    ("datetime64", "ns", 1e9),
    ("timedelta64", "us", 1e6),
):
    stamps = (np.arange(5) * 2).astype(f"{kind}[ms]").astype(f"{kind}[{unit}]")
    position = xr.DataArray(np.arange(5) * 0.002, dims="time", coords={"time": stamps})
    force = xr.ones_like(position)
    bare = float(position.differentiate("time")[2]), float(force.integrate("time"))
    asked = float(position.differentiate("time", datetime_unit="s")[2]), float(force.integrate("time", datetime_unit="s"))
    print(f"{kind}[{unit}]: velocity and impulse {bare}, with datetime_unit='s' {asked}")
    assert np.allclose(bare, (1 / a_second, 0.008 * a_second), rtol=1e-9), bare
    assert np.allclose(asked, (1.0, 0.008), rtol=1e-9), asked
print("as described")
PYTHON
