#!/usr/bin/env bash
# mcap 1.6.0: the writer keeps a chunk of 1 MiB in memory, which is many seconds of a force log.
#
# A 1 kHz topic of JSON, three numbers a message. Seen, looking at the file without closing it:
#   default               nothing but 42 bytes of start for more than 12 s, then half a megabyte at once
#   chunk_size=64 KiB      written for the first time before 1.0 s has gone by
#   use_chunking=False     written at each message
# Where it bites: a recording that ends with the power, a kill or an emergency stop has lost its last seconds,
# which are the ones that it was made for; below 12 s it holds nothing. Slow topics make it worse: the chunk
# counts bytes, not time.
# Instead: a chunk_size of what you can bear to lose (rate x size of a message x seconds), finish() in a
# finally, and a flush of the file itself where there is one.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check mcap==1.6.0
cd "$work"
venv/bin/python - <<'PYTHON'
import io
import json
import math

from mcap.writer import Writer


def first_written(**options):
    """The number of seconds logged when something is in the file for the first time beside its start."""
    file = io.BytesIO()
    writer = Writer(file, **options)
    writer.start()
    schema = writer.register_schema("Touch", "jsonschema", b"{}")
    channel = writer.register_channel("/touch", "json", schema)
    start = len(file.getvalue())
    for sample in range(60_000):
        row = {"t": sample / 1000, "x": round(math.sin(sample / 100), 6), "f": round(math.cos(sample / 100), 6)}
        at = sample * 1_000_000
        writer.add_message(channel, at, json.dumps(row).encode(), at)
        if len(file.getvalue()) > start + 200:
            break
    print(f"{options}: {start} bytes until {sample / 1000} s, then {len(file.getvalue())} bytes")
    return sample / 1000


assert 12 < first_written() < 15
assert 0.5 < first_written(chunk_size=64 * 1024) < 1.0
assert first_written(use_chunking=False) < 0.01
print("as described")
PYTHON
