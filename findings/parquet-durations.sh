#!/usr/bin/env bash
# A column of durations in Parquet (pyarrow 26.0.1): three readers, three meanings of the same file.
#
# Stamps 0, 0.4 and 0.8 ms, once as duration[us] and once as duration[ns]. Parquet itself has no durations:
# the unit stands only in the note that Arrow leaves beside the schema. Seen:
#   pandas 3.1.1         timedelta64[us] and timedelta64[ns]; astype("int64") is 0, 400, 800 and 0, 400000, 800000, so the common
#                        astype("int64") / 1e9 makes 0.4 µs of 0.4 ms in the first file and is right in the second
#   DuckDB 2.0.1         BIGINT 0, 400, 800: no unit, no word
#   fastparquet 2026.9.0 int64, the same
# Where it bites: a sample period wrong by 1000, and with it every velocity and damping that is identified.
# Instead: store time as float64 seconds with the unit in the name (time_s); in pandas use
# .dt.total_seconds().
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check \
  pyarrow==26.0.1 pandas==3.1.1 duckdb==2.0.1 fastparquet==2026.9.0 numpy==2.4.6
cd "$work"
venv/bin/python - <<'PYTHON'
import duckdb
import fastparquet
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq


def read(unit, stamps):
    pq.write_table(pa.table({"t": pa.array(stamps, pa.duration(unit))}), f"{unit}.parquet")
    frame = pd.read_parquet(f"{unit}.parquet", engine="pyarrow")
    kind, values = str(frame.t.dtype), frame.t.astype("int64").tolist()
    seconds = frame.t.dt.total_seconds().tolist()
    duck = duckdb.sql(f"select t, typeof(t) from '{unit}.parquet'").fetchall()
    fast = fastparquet.ParquetFile(f"{unit}.parquet").to_pandas().t
    print(f"duration[{unit}]: pandas {kind} {values} {seconds}, DuckDB {duck}, fastparquet {fast.dtype} {fast.tolist()}")
    assert kind == f"timedelta64[{unit}]", kind
    assert values == stamps, values
    assert seconds == [0.0, 0.0004, 0.0008], seconds
    assert duck == [(stamp, "BIGINT") for stamp in stamps], duck
    assert (str(fast.dtype), fast.tolist()) == ("int64", stamps), fast


read("us", [0, 400, 800])
read("ns", [0, 400_000, 800_000])
print("as described")
PYTHON
