#!/usr/bin/env bash
# npTDMS 1.13.0: as_dataframe lays channels of different rates side by side, row by row.
#
# One TDMS file, force at 10 kHz (wf_increment 0.1 ms) and position at 1 kHz (1 ms), both from the same start.
# Seen:
#   as_dataframe()                  row 2 holds the force of 0.2 ms and the position of 2 ms; the shorter one is filled up with NaN
#   as_dataframe(time_index=True)   the right times, with NaN wherever the other channel has a sample
# Where it bites: force over position of a log of two rates is a picture of nothing: the stiffness fitted is a
# tenth, and after dropna() not even the NaN are left to warn.
# Instead: channel.time_track() for each channel, and interpolation onto one of the two.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check npTDMS==1.13.0 pandas==3.1.1 numpy==2.4.6
cd "$work"
venv/bin/python - <<'PYTHON'
import numpy as np
from nptdms import ChannelObject, TdmsFile, TdmsWriter

SPEED, STIFFNESS = 0.01, 500.0  # m/s, N/m


def channel(name, times, values):
    waveform = {"wf_increment": times[1], "wf_start_offset": 0.0, "wf_samples": len(times)}
    waveform["wf_start_time"] = np.datetime64("2026-01-01")
    return ChannelObject("rig", name, values, waveform)


fast, slow = np.arange(100) * 1e-4, np.arange(10) * 1e-3
with TdmsWriter("touch.tdms") as writer:
    writer.write_segment([channel("force", fast, STIFFNESS * SPEED * fast), channel("position", slow, SPEED * slow)])
rig = TdmsFile.read("touch.tdms")["rig"]
frame = rig.as_dataframe()
print(frame.head(3), "\nrows:", len(frame), "positions:", frame.position.count())
assert (len(frame), frame.position.count()) == (100, 10)
kept = frame.dropna()
fitted = np.polyfit(kept.position, kept.force, 1)[0]
print(f"stiffness of the rows: {fitted:.1f} N/m, of the rig: {STIFFNESS:.1f} N/m")
assert np.isclose(fitted, STIFFNESS / 10)
force = np.interp(rig["position"].time_track(), rig["force"].time_track(), rig["force"][:])
assert np.isclose(np.polyfit(rig["position"][:], force, 1)[0], STIFFNESS)
timed = rig.as_dataframe(time_index=True)
assert np.isclose(timed.index, 2e-4).any() and np.isnan(timed.position.iloc[2])
print("as described")
PYTHON
