#!/usr/bin/env bash
# mcap 1.6.0 and a file that was never finished: three ways to read it in one package, three answers.
#
# 60 s at 1 kHz, cut before finish(), so that only whole chunks are there (56 315 messages). Seen:
#   make_reader(file).iter_messages()                           0 messages, RecordLengthLimitExceeded
#                                                               ("unknown (opcode 0) record has length …")
#   NonSeekingReader(file).iter_messages()                      0 messages, EndOfFile with no text
#   NonSeekingReader(file).iter_messages(log_time_order=False)  all 56 315 messages, then EndOfFile
# The second sorts by time and so wants to see the end before it gives the first message.
# Where it bites: a log that was cut off looks empty or damaged, though every whole chunk is sound; and the
# message that is printed speaks of a record's length, not of a missing end.
# Instead: for a file without the closing magic use NonSeekingReader in the order of the file, keep what came
# before EndOfFile, and say how much that is.
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

from mcap.reader import NonSeekingReader, make_reader
from mcap.writer import CompressionType, Writer

file = io.BytesIO()
writer = Writer(file, compression=CompressionType.NONE)
writer.start()
schema = writer.register_schema("Touch", "jsonschema", b"{}")
channel = writer.register_channel("/touch", "json", schema)
for sample in range(60_000):
    row = {"t": sample / 1000, "x": round(math.sin(sample / 100), 6), "f": round(math.cos(sample / 100), 6)}
    writer.add_message(channel, sample * 1_000_000, json.dumps(row).encode(), sample * 1_000_000)
unfinished = file.getvalue()


def read(name, messages):
    number, end = 0, None
    try:
        for _ in messages(io.BytesIO(unfinished)):
            number += 1
    except Exception as error:
        end = type(error).__name__, str(error)
    print(f"{name}: {number} messages, then {end}")
    return number, end[0] if end else None


seeking = read("make_reader", lambda file: make_reader(file).iter_messages())
sorted_ = read("NonSeekingReader", lambda file: NonSeekingReader(file).iter_messages())
plain = read("NonSeekingReader, file's order", lambda file: NonSeekingReader(file).iter_messages(log_time_order=False))
assert seeking == (0, "RecordLengthLimitExceeded"), seeking
assert sorted_ == (0, "EndOfFile"), sorted_
assert plain == (56_315, "EndOfFile"), plain
print("as described")
PYTHON
