"""Texts as instruments, boards and programs write them: where the names are, and what a line holds."""

from __future__ import annotations

import json

import numpy as np
import pytest

import zwidth as zw
from zwidth.data.logs.read import log_of, opened
from zwidth.data.logs.text import text_table

ROWS = [
    (f"{k / 1000:.3f}", f"{round(60 * np.sin(k / 50)) * 0.05:.2f}", f"{np.cos(k / 50):.4f}")
    for k in range(600)
]
"""Of time [s], position [mm] and force [N]."""

NAMES = "time_s,position_mm,force_N"


def rows(sep: str = ",", end: str = "") -> str:
    return "".join(sep.join(row) + end + "\n" for row in ROWS)


HEADS = {
    "names above units": (
        "Source,CH1,CH2\nSecond,Volt,Volt\n",
        "",
        {"Source": "Second", "CH1": "Volt", "CH2": "Volt"},
    ),
    "names that are numbers": (
        "x-axis,1,2\nsecond,Volt,Ampere\n",
        "",
        {"x-axis": "second", "1": "Volt", "2": "Ampere"},
    ),
    "numbers beside names and units": (
        "spec A,spec A,spec A,,,\nTime,Position,Force,,20,80\ns,mm,N,,0.1,79\n",
        ",,,",
        {"Time": "s", "Position": "mm", "Force": "N"} | {f"column {k}": None for k in (4, 5, 6)},
    ),
    "settings with a number": ("rate,1000,\ngain,2.5,0\n\ntime_s,position_mm,force_N\n", "", None),
    "settings with a sign": ("rate: 1000 Hz\nKp = 250\n[data]\ntime_s,position_mm,force_N\n", "", None),
}


@pytest.mark.parametrize("name", HEADS)
def test_names_stand_where_they_stand(name, tmp_path):
    """Whatever else stands above the numbers or beside the names."""
    head, end, names = HEADS[name]
    path = tmp_path / "log.csv"
    path.write_text(head + rows(end=end), encoding="utf-8")
    table = text_table(path)
    assert table.units == (names or dict.fromkeys(NAMES.split(",")))
    read = [np.concatenate(column) for column in zip(*table.read((*table.units,)[:3]), strict=True)]
    assert (np.array(read) == np.array(ROWS, dtype=float).T).all()
    assert not table.notes


def test_a_first_column_in_seconds_is_the_time(tmp_path):
    path = tmp_path / "log.csv"
    path.write_text("Source,CH1,CH2\nSecond,Volt,Volt\n" + rows(), encoding="utf-8")
    log = zw.read_log(path, columns={"position": "CH1"}, scale={"position": "1 mm/V"})
    assert log.sample_period == 1e-3


@pytest.mark.parametrize("end", ["", ",", ",,"])
@pytest.mark.parametrize("unit", ["Volt", "VOLT", "Unknown"])
def test_a_sample_that_is_counted_is_at_start_and_increments(end, unit, tmp_path):
    """As oscilloscopes of Rigol write it; what is lost shows in the count."""
    path = tmp_path / "log.csv"
    head = f"X,CH1,CH2,Start,Increment,\nSequence,Volt,{unit},-3.000000E-01,2.000000E-03\n"
    lines = [f"{k},{x},{f}{end}\n" for k, (_, x, f) in enumerate(ROWS) if k not in (200, 201)]
    path.write_text(head + "".join(lines), encoding="utf-8")
    units = text_table(path).units
    assert {name: units[name] for name in ("time", "CH1", "CH2")} == {
        "time": "s",
        "CH1": "Volt",
        "CH2": None if unit == "Unknown" else unit,
    }
    log = zw.read_log(path, columns={"position": "CH1"}, scale={"position": "1 mm/V"})
    blocks = list(log.blocks())
    assert (log.sample_period, [block.time.size for block in blocks]) == (2e-3, [200, 398])
    assert [block.time[0] for block in blocks] == [-0.3, pytest.approx(0.104)]
    with pytest.raises(zw.InputError, match="no column is known to be the position"):
        zw.read_log(path)


RECORDS = {
    "commas": "time_s:{},position_mm:{},force_N:{}\n",
    "spaces": "time_s: {} position_mm: {} force_N: {}\r\n",
    "tabs": "time_s={}\tposition_mm={}\tforce_N={}\t\n",
    "words in a name": "Time (s):{}, Joint Position (mm):{}, Force (N):{}\n",
    "JSON": '{{"time_s": {}, "arm": {{"position_mm": {}}}, "force_N": {}, "state": "on"}}\n',
    "an array of JSON": ' {{"force_N": {2}, "time_s": {0}, "position_mm": [{1}]}},\n',
}


@pytest.mark.parametrize("name", RECORDS)
def test_lines_that_name_each_number(name, tmp_path):
    """Gives the log of a table; lines of others among them are counted, a cut one is left out."""
    path, lines = tmp_path / "log.txt", [RECORDS[name].format(*row) for row in ROWS]
    log = tmp_path / "plain.csv"
    log.write_text(NAMES + "\n" + rows(), encoding="utf-8")
    lines[300] += "\nboot: reset\n"
    path.write_bytes("".join([*lines, lines[0][:20]]).encode())
    read, plain = zw.read_log(path), zw.read_log(log)
    assert [f.samples for f in read.findings if f.kind in ("broken rows", "unfinished")] == [1, 1]
    for one, other in zip(read.blocks(), plain.blocks(), strict=True):
        assert np.array_equal(one.time, other.time)
        assert np.array_equal(one.position, other.position)
        assert np.array_equal(one.hand_force, other.hand_force)


def test_a_name_that_comes_late_is_no_part_of_the_table(tmp_path):
    """Whoever needs it sees that its lines are left out; many of them are no table."""
    path, line = tmp_path / "log.jsonl", RECORDS["commas"]
    text = "".join(line.format(*row) for row in ROWS) * 4
    path.write_text(text + "time_s:1,mode:3\n" * 5, encoding="utf-8")
    assert [f.samples for f in zw.read_log(path).findings if f.kind == "broken rows"] == [5]
    path.write_text(text + "time_s:1,mode:3\n" * 50, encoding="utf-8")
    with pytest.raises(zw.InputError, match="it is no table"):
        zw.read_log(path)


MONITORS = {
    "Arduino": "{s} -> {x},{f}",
    "PlatformIO": "{s} > {x}\t{f}",
    "spaces": "{s} -> {x} {f}",
    "names above": "{s} -> {x};{f}",
    "names in each line": "{s} -> column 2:{x} column 3:{f}",
    "JSON": '{s} -> {{"column 2": {x}, "column 3": {f}}}',
}


@pytest.mark.parametrize("name", MONITORS)
def test_lines_behind_the_time_of_a_monitor(name, tmp_path):
    """That time is a column, which goes on past midnight; a line of names may stand above."""
    path, plain = tmp_path / "monitor.txt", tmp_path / "plain.csv"
    stamps = [f"23:59:59.{k}" for k in range(800, 1000)] + [f"0:0:00.{k:03d}" for k in range(400)]
    lines = [MONITORS[name].format(s=s, x=x, f=f) for s, (_, x, f) in zip(stamps, ROWS, strict=True)]
    lines[:0] = ["23:59:59.700 -> column 2;column 3"] * (name == "names above")
    path.write_text("\r\n".join([*lines, ""]), encoding="utf-8")
    plain.write_text(NAMES + "\n" + rows(), encoding="utf-8")
    columns = {"position": "column 2", "hand_force": "column 3"}
    log = zw.read_log(path, columns=columns, units={"position": "mm", "hand_force": "N"})
    assert (log.samples, log.runs, log.sample_period) == (600, 1, 1e-3)
    for one, other in zip(log.blocks(), zw.read_log(plain).blocks(), strict=True):
        assert np.array_equal(one.position, other.position)
        assert np.array_equal(one.hand_force, other.hand_force)


SAMPLES = [{"time_s": float(t), "state": {"position_mm": float(x)}, "force_N": float(f)} for t, x, f in ROWS]
WHOLES = {
    "alone": (SAMPLES, None),
    "beside settings": ({"mass": 1.2, "motor": "a", "entries": SAMPLES}, '"mass", "motor" left out'),
    "deeper": (
        {"log": {"rows": SAMPLES, "marks": [{"a": 1}, {"a": 2}]}},
        '"log.rows" is read; "log.marks" left out',
    ),
}


@pytest.mark.parametrize("name", WHOLES)
@pytest.mark.parametrize("indent", [None, 2])
def test_a_list_of_samples_in_json(name, indent, tmp_path):
    """In one line or in many; what else stands there is told."""
    path, plain, (whole, left) = tmp_path / "log.json", tmp_path / "plain.csv", WHOLES[name]
    path.write_text(json.dumps(whole, indent=indent), encoding="utf-8")
    plain.write_text(NAMES + "\n" + rows(), encoding="utf-8")
    log, right = zw.read_log(path), zw.read_log(plain)
    for one, other in zip(log.blocks(), right.blocks(), strict=True):
        assert all(map(np.array_equal, one[1:4], other[1:4]))
    said = [finding.text for finding in log.findings if finding.kind == "left out"]
    assert len(said) == (left is not None)
    assert all(text.endswith(left) for text in said)
    path.write_text(json.dumps(whole, indent=indent)[:-9], encoding="utf-8")
    with pytest.raises(zw.InputError, match=r"begins as JSON and is none: .* copied whole"):
        zw.read_log(path)


STAMPS = [
    ("sec", "nanosec", 1),
    ("header.stamp.sec", "header.stamp.nanosec", 1),
    ("field.header.stamp.secs", "field.header.stamp.nsecs", 1),
    ("tv_sec", "tv_usec", 1000),
]


def stamped(seconds: str, rest: str, unit: int, start: int = 1764300000) -> str:
    stamps = [divmod((start * 1000 + 700 + k) * 10**6, 10**9) for k in range(len(ROWS))]
    lines = [f"{s},{n // unit},{x},{f}\n" for (s, n), (_, x, f) in zip(stamps, ROWS, strict=True)]
    return f"{seconds},{rest},position_mm,force_N\n" + "".join(lines)


@pytest.mark.parametrize("names", STAMPS)
def test_seconds_and_the_rest_of_one_are_a_time(names, tmp_path):
    path = tmp_path / "log.csv"
    path.write_text(stamped(*names), encoding="utf-8")
    log = zw.read_log(path)
    assert (log.samples, log.runs, log.sample_period) == (600, 1, 1e-3)
    first = f",{700_000_000 // names[2]},"
    path.write_text(stamped(*names).replace(first, ",,", 1), encoding="utf-8")
    assert zw.read_log(path).samples == 599
    with pytest.raises(zw.InputError, match="no common period"):
        zw.read_log(path, columns={"time": names[0]}, units={"time": "s"})


def test_what_is_more_than_a_second_is_no_rest_of_one(tmp_path):
    path = tmp_path / "log.csv"
    path.write_text(stamped("sec", "nanosec", 1).replace(",701000000", ",7010000000"), encoding="utf-8")
    with pytest.raises(zw.InputError, match='"nanosec" beside "sec" is more than a second'):
        zw.read_log(path)


LONG = {
    "in turn": ("time_s,topic,value", ["{t},/arm/position,{x}", "{t},/arm/force,{f}"]),
    "a little later": ("time_s;name;value", ["{t};/arm/position;{x}", "{t}09;/arm/force;{f}"]),
    "with others, in words too": (
        "time_s,key,value,seq",
        ["{t},/mode,auto,1", "{t},/arm/position,{x},2", "{t},/arm/force,{f},3", "{t},/arm/battery,12,4"],
    ),
    "in two columns": ("time_s,topic,field,value,seq", ["{t},/arm,position,{x},7", "{t},/arm,force,{f},7"]),
    "of numbers": ("time_s,channel,value", ["{t},1,{x}", "{t},2,{f}"]),
    "in columns": ("time_s,/arm/position,/arm/force", ["{t},{x},", "{t}04,,{f}"]),
}


@pytest.mark.parametrize("name", LONG)
@pytest.mark.parametrize("one_after_the_other", [False, True])
def test_topics_in_rows_of_their_own_are_columns(name, one_after_the_other, tmp_path):
    """A row for each number, in turn or topic by topic, is the log of a table; what is left out is told."""
    path, plain, (head, lines) = tmp_path / "long.csv", tmp_path / "plain.csv", LONG[name]
    plain.write_text(NAMES + "\n" + rows(), encoding="utf-8")
    said = [[line.format(t=t, x=x, f=f) + "\n" for line in lines] for t, x, f in ROWS]
    told = zip(*said, strict=True) if one_after_the_other else said
    path.write_text(head + "\n" + "".join(map("".join, told)), encoding="utf-8")
    topics = {"in two columns": ("/arm.position", "/arm.force"), "of numbers": ("1", "2")}
    position, force = topics.get(name, ("/arm/position", "/arm/force"))
    given = {
        "columns": {"position": position, "hand_force": force},
        "units": {"position": "mm", "hand_force": "N"},
    }
    log, right = zw.read_log(path, **given), zw.read_log(plain)
    assert log.sample_period == right.sample_period
    for one, other in zip(log.blocks(), right.blocks(), strict=True):
        assert np.array_equal(one.position, other.position)
        assert np.array_equal(one.hand_force, other.hand_force)
    left = {"with others, in words too": [1200]}.get(name, [])
    assert [f.samples for f in log.findings if f.kind == "topics left out"] == left
    assert [f.samples for f in log.findings if f.kind == "rows in turn"] == [0]


def test_numbers_of_a_topic_that_no_sample_has_are_counted(tmp_path):
    path = tmp_path / "log.csv"
    lines = [f"{t},{x},\n" + f"{t}01,,{f}\n" * (k % 100 > 0) for k, (t, x, f) in enumerate(ROWS)]
    path.write_text(
        NAMES + "\n" + "".join(lines) + "".join(f"9.{k},,1\n" for k in range(7)), encoding="utf-8"
    )
    log = zw.read_log(path)
    assert (log.samples, log.runs) == (594, 6)
    assert [f.samples for f in log.findings if f.kind == "rows in turn"] == [7]


def test_topics_between_each_other_are_refused_with_the_rule(tmp_path):
    """Half a period is the difference between a delay and none."""
    path = tmp_path / "log.csv"
    lines = [f"{t},{x},\n{t}5,,{f}\n" for t, x, f in ROWS]
    path.write_text(NAMES + "\n" + "".join(lines), encoding="utf-8")
    with pytest.raises(
        zw.InputError, match=r'"force_N" stands in other rows, 0.5 periods .* up to 0.1 is read'
    ):
        zw.read_log(path)
    assert zw.read_log(path, columns={"hand_force": None}).samples == 600
    path.write_text(NAMES + "\n" + 2 * "".join(f"{t},{x},\n{t},,{f}\n" for t, x, f in ROWS), encoding="utf-8")
    with pytest.raises(zw.InputError, match=r'time starts again in "position_mm".* cut the file'):
        zw.read_log(path)
    path.write_text("position_mm,force_N\n" + "".join(f"{x},\n,{f}\n" for _, x, f in ROWS), encoding="utf-8")
    with pytest.raises(zw.InputError, match=r"fewer than two rows .* by a time"):
        zw.read_log(path, sample_rate=1000)


def test_one_topic_alone_is_a_table_and_one_in_words_is_refused(tmp_path):
    path = tmp_path / "long.csv"
    lines = [f"{t},position,{x}\n" for t, x, _ in ROWS]
    path.write_text("time_s,name,value\n" + "".join(lines), encoding="utf-8")
    assert list(text_table(path).units) == ["time_s", "name", "value"]
    path.write_text("time_s,name,value\n" + "".join(lines) + "0.6,mode,auto\n", encoding="utf-8")
    assert list(text_table(path).units) == ["position", "mode", "time_s"]
    with pytest.raises(zw.InputError, match='"mode" holds text'):
        zw.read_log(path, columns={"position": "mode"}, units={"position": "mm"})


def test_logs_of_one_table_have_one_clock(tmp_path):
    """Also where they are dates, and a topic begins later."""
    path = tmp_path / "long.csv"
    lines = [
        f"{1764300000 + k / 1000:.3f},{topic},{x}\n" for k, (_, x, _) in enumerate(ROWS) for topic in "qr"
    ]
    path.write_text("time_s,name,value\n" + "".join(lines[:600:2] + lines[600:]), encoding="utf-8")
    with opened(path) as table:
        logs = [log_of(table, columns={"position": q}, units={"position": "mm"}) for q in "qr"]
    starts = [next(log.blocks()).time[0] for log in logs]
    assert starts == [0.0, pytest.approx(0.3, abs=1e-6)]


@pytest.mark.parametrize(("factor", "unit"), [(1, "s"), (1e3, "ms"), (1e6, "us"), (1e9, "ns")])
def test_the_unit_that_is_asked_for_is_that_of_the_stamps(factor, unit, tmp_path):
    path = tmp_path / "log.csv"
    lines = [f"{float(t) * factor:.3f},{x}\n" for t, x, _ in ROWS]
    path.write_text("t,position_mm\n" + "".join(lines), encoding="utf-8")
    with pytest.raises(zw.InputError, match=f'most likely {unit}: state it with units={{"time": "{unit}"}}'):
        zw.read_log(path)
    assert zw.read_log(path, units={"time": unit}).sample_period == pytest.approx(1e-3)


COUNTS = "time_s,encoder_counts,force_counts\n" + "".join(
    f"{t},{round(float(x) * 500)},{round(float(f) * 200)}\n" for t, x, f in ROWS
)
RAW = {"columns": {"hand_force": "force_counts"}}


@pytest.mark.parametrize(
    ("stated", "motion"),
    [
        ({"scale": {"hand_force": "0.005 N*m/count"}, "counts_per_turn": 4096}, "rotary"),
        ({"scale": {"hand_force": "0.005 N*m/count"}, "resolution": 0.001}, "rotary"),
        ({"scale": {"hand_force": "0.005 N/count"}, "resolution": 0.001}, "linear"),
        ({"scale": {"hand_force": "0.005 N/count"}, "resolution": "10 um"}, "linear"),
    ],
)
def test_counts_turn_where_the_force_is_a_torque(stated, motion, tmp_path):
    path = tmp_path / "log.csv"
    path.write_text(COUNTS, encoding="utf-8")
    assert zw.read_log(path, **RAW, **stated).motion == motion


@pytest.mark.parametrize(
    ("stated", "message"),
    [
        ({"counts_per_turn": 4096}, r"0.01 N\*m/count"),
        ({"resolution": 0.001}, "0.01 N/count"),
        ({"scale": {"hand_force": "0.005 N/count"}, "counts_per_turn": 4096}, "a torque, such as"),
    ],
)
def test_advice_for_counts_is_of_the_motion(stated, message, tmp_path):
    path = tmp_path / "log.csv"
    path.write_text(COUNTS, encoding="utf-8")
    with pytest.raises(zw.InputError, match=message):
        zw.read_log(path, **RAW, **stated)


LVM = (
    "LabVIEW Measurement\t\nSeparator\tTab\nX_Columns\t{}\nTime\t10:15:03.12\n***End_of_Header***\t\n\t\n"
    "Channels\t2\t\t\nSamples\t600\t600\t\nY_Unit_Label\tVolts\tSome\t\nX_Dimension\tTime\tTime\t\n"
    "X0\t0.0E+0\t0.0E+0\t\nDelta_X\t0.001\t0.001\t\n***End_of_Header***\t\t\t\n"
)
LVMS = {
    "one": (LVM + "X_Value\tUntitled\tUntitled 1\tComment\n", "{0}\t{1}\t{2}\n"),
    "comments": (LVM + "X_Value\tUntitled\tUntitled 1\tComment\n", "{0}\t{1}\t{2}\t\n"),
    "many": (LVM + "X_Value\tUntitled\tX_Value\tUntitled 1\tComment\n", "{0}\t{1}\t{0}\t{2}\n"),
    "no": (LVM + "X_Value\tUntitled\tUntitled 1\tComment\n", "\t{1}\t{2}\n"),
}


@pytest.mark.parametrize("name", LVMS)
def test_measurements_of_labview_keep_their_names(name, tmp_path):
    """And the units that are known; a head before each segment is no row."""
    path, (head, line) = tmp_path / "log.lvm", LVMS[name]
    whole = head.format(name) + "".join(line.format(*row) for row in ROWS)
    segment = whole[whole.index("\t\nChannels") :]
    path.write_text(whole + segment, encoding="utf-8")
    units = text_table(path).units
    assert (units["X_Value"], units["Untitled"], units["Untitled 1"]) == (
        None if name == "no" else "s",
        "Volts",
        None,
    )
    given = {"columns": {"position": "Untitled"}, "scale": {"position": "1 mm/V"}}
    log = zw.read_log(path, **given, **({"sample_rate": 1000} if name == "no" else {}))
    assert (log.samples, log.sample_period) == (1200, 1e-3)
    assert "broken rows" not in {finding.kind for finding in log.findings}
    path.write_text(
        whole.replace(ROWS[0][2] + line[line.index("{2}") + 3 :], "1\tStandby\tnow\n", 1), encoding="utf-8"
    )
    log = zw.read_log(path, **given, **({"sample_rate": 1000} if name == "no" else {}))
    assert [f.samples for f in log.findings if f.kind == "broken rows"] == [1]


@pytest.mark.parametrize(
    "line",
    [
        "(1764300000.249713) vcan0 044#2A366C2BBA\n",
        " (1764300000.249713)  can0  18FF0233   [8]  01 02 03 04 05 06 07 08\n",
        "  can1  123   [2]  11 22\n",
        "Time Stamp,ID,Extended,Dir,Bus,LEN,D1,D2\n166064,0000021A,false,Rx,0,2,FE,36\n",
        "timestamp,arbitration_id,extended,remote,error,dlc,data\n0.1,0x21a,0,0,0,2,/jY=\n",
        "date Wed Nov 4 10:15:03 am 2026\nbase hex  timestamps absolute\n0.015 1 21A Rx d 2 FE 36\n",
    ],
)
def test_frames_of_a_bus_are_refused_with_what_to_do(line, tmp_path):
    path = tmp_path / "bus.log"
    path.write_text(line * 50, encoding="utf-8")
    with pytest.raises(zw.InputError, match=r"frames of a CAN bus: .* Save Decoded Frames"):
        zw.read_log(path)


def test_a_line_without_end_among_records_is_refused(tmp_path):
    path = tmp_path / "log.txt"
    path.write_bytes(RECORDS["commas"].format(1, 2, 3).encode() * 9 + b"x" * 2**25)
    with pytest.raises(zw.InputError, match="a line of more than"):
        zw.read_log(path)
