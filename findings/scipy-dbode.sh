#!/usr/bin/env bash
# scipy 1.17.1: dbode takes its frequencies in rad/sample and gives them back in rad/s; dfreqresp gives them back as they came.
#
# A filter at 1 kHz, asked for at w=[0.1]. Seen:
#   dfreqresp(system, w)   w 0.1
#   dbode(system, w)       w 100.0; magnitude and phase are those of 0.1 rad/sample
#   dbode(system, w=[100.0]), that is with what it gave back: 11 dB less, of some frequency beyond Nyquist, without a word
#   control 0.10.2         takes rad/s and warns beyond Nyquist
# Where it bites: the delay and the damping of a velocity filter are read at the hand's frequency; with rad/s
# typed in they are those of an alias: plausible numbers, no warning.
# Instead: w * dt in, and nothing of the w that comes back; or control's frequency_response.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check scipy==1.17.1 control==0.10.2 numpy==2.4.6
cd "$work"
venv/bin/python -W error - <<'PYTHON'
import warnings

import control
import numpy as np
from scipy import signal

PERIOD = 1e-3
system = ([0.1], [1, -0.9], PERIOD)


def magnitude(w):
    return 20 * np.log10(abs(0.1 / (np.exp(1j * w) - 0.9)))


plain, _ = signal.dfreqresp(system, w=[0.1])
given, size, _ = signal.dbode(system, w=[0.1])
again, other, _ = signal.dbode(system, w=given)
print("dfreqresp", plain, "dbode", given, size, "with that again", again, other)
assert plain[0] == 0.1 and np.isclose(given[0], 100.0) and np.isclose(size[0], magnitude(0.1))
assert np.isclose(again[0], 1e5) and np.isclose(other[0], magnitude(100.0)) and size[0] - other[0] > 10

same = control.tf([0.1], [1, -0.9], PERIOD)
asked = abs(control.frequency_response(same, [100.0]).frdata[0, 0, 0])
assert np.isclose(20 * np.log10(asked), size[0])
with warnings.catch_warnings(record=True) as told:
    warnings.simplefilter("always")
    control.frequency_response(same, [1e6])
print("control:", [str(warning.message) for warning in told])
assert any("Nyquist" in str(warning.message) for warning in told)
print("as described")
PYTHON
