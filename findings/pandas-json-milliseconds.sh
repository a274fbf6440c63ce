#!/usr/bin/env bash
# pandas 3.1.1: to_json cuts stamps and durations to whole milliseconds.
#
# A column of stamps at 2.5 kHz (0, 0.4, 0.8, 1.2 ms), kept to the microsecond in the frame. Seen:
#   to_json()                    0, 0, 0, 1: three samples at one time; durations likewise
#   to_json(date_format="iso")   the stamps end in .000, .000, .000, .001, too; the durations keep their digits
#   as an index                  ValueError "index must be unique" of an index that is unique
#   date_unit="us"               right
# Where it bites: above 1 kHz a log sent as JSON has steps of 0 s, so velocities are infinite, or its period
# comes out 1 ms.
# Instead: date_unit="us" or "ns", or better a column of seconds as numbers with double_precision=15 (10 by
# default).
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check pandas==3.1.1 numpy==2.4.6
cd "$work"
venv/bin/python -W ignore - <<'PYTHON'
import json

import pandas as pd

microseconds = [0, 400, 800, 1200]
frame = pd.DataFrame(
    {"stamp": pd.to_datetime(microseconds, unit="us"), "since": pd.to_timedelta(microseconds, unit="us")}
)
assert frame.stamp.is_unique and frame.since.is_unique


def written(**options):
    out = {name: list(column.values()) for name, column in json.loads(frame.to_json(**options)).items()}
    print(options, out)
    return out


assert written() == {"stamp": [0, 0, 0, 1], "since": [0, 0, 0, 1]}
iso = written(date_format="iso")
assert [stamp[-4:] for stamp in iso["stamp"]] == [".000", ".000", ".000", ".001"], iso
assert iso["since"][1] == "P0DT0H0M0.000400S", iso
assert written(date_unit="us") == {"stamp": microseconds, "since": microseconds}
try:
    frame.set_index("stamp").to_json()
except ValueError as error:
    print("as an index:", error)
    assert "index must be unique" in str(error)
else:
    raise AssertionError("the index is taken")
print("as described")
PYTHON
