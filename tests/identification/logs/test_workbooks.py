"""Spreadsheets as machines and people write them: read as they are meant, or refused with what to do."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from datetime import datetime, timedelta
from functools import partial
from pathlib import Path
from typing import Any
from zipfile import ZIP_DEFLATED, ZipFile

import numpy as np
import pytest
from openpyxl import Workbook

import zwidth as zw
from zwidth.data.logs.cells import clock, decimal_of, number
from zwidth.data.tissue.experiment.columns import read_tests

TIME = 0.25 * np.arange(40)
DEPTH = 0.004 * np.clip(TIME, 0, 1)
FORCE = 1.7 * np.clip(TIME, 0, 1) - 0.0125 * np.arange(40) % 0.3
ROWS = list(zip(TIME.tolist(), FORCE.tolist(), (1e3 * DEPTH).tolist(), strict=True))
NAMES, UNITS = ("Prüfzeit", "Standardkraft", "Standardweg"), ("s", "N", "mm")
HEAD = [[f"{name} [{unit}]" for name, unit in zip(NAMES, UNITS, strict=True)]]
MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"

Rows = Iterable[Sequence[object]]


def book(path: Path, **sheets: Rows) -> Path:
    made = Workbook()
    made.remove(made.active)
    for name, rows in sheets.items():
        sheet = made.create_sheet(name)
        for row in rows:
            sheet.append(list(row))
    made.save(path)
    return path


def is_the_test(found: Any) -> None:
    assert found.time - found.time[0] == pytest.approx(TIME, abs=1e-6)
    assert found.indentation == pytest.approx(DEPTH, abs=1e-9)
    assert found.force == pytest.approx(FORCE, abs=1e-9)


def with_commas(value: object) -> str:
    return repr(value).replace(".", ",")


START = datetime(2026, 11, 26, 23, 59, 55)
TABLES: dict[str, list[Sequence[object]]] = {
    "a machine's report": [
        *[("Prüfprotokoll",), ("Prüfer", "Müller"), ("Vorkraft", 0.05, "N"), (), NAMES, UNITS],
        *ROWS,
        *[("Mittel", 1.7, 3.9), ("Probe trocken",)],
    ],
    "numbers beside names and units": [
        *[("spec A",) * 3, (*NAMES, None, None, 20, 80), (*UNITS, None, None, 0.13, 79.4)],
        *ROWS,
    ],
    "results above the raw data": [
        *[("Results Table 1",), ("", "Maximum Load", "Extension at Maximum Load"), ("", "(N)", "(mm)")],
        *[(k, 4.4, 4.0) for k in range(5)],
        *[(), ("Raw data",), ("Time", "Load", "Extension"), ("(s)", "(N)", "(mm)"), *ROWS],
    ],
    "commas in texts, a share of the length": [
        [*HEAD[0], "Dehnung"],
        *[(*map(with_commas, row), f"{row[2] / 20:.1f} %") for row in ROWS],
    ],
    "dates": [*HEAD, *[(START + timedelta(seconds=t), f, x) for t, f, x in ROWS]],
    "durations": [*HEAD, *[(timedelta(seconds=t), f, x) for t, f, x in ROWS]],
    "times of day, past midnight": [
        *HEAD,
        *[((START + timedelta(seconds=t)).time(), f, x) for t, f, x in ROWS],
    ],
    "a row for each number": [
        (HEAD[0][0], "Channel", "Value"),
        *[row for t, *both in ROWS for row in zip((t, t), HEAD[0][1:], both, strict=True)],
    ],
    "empty rows, an empty column": [(None, *HEAD[0]), *[row for each in ROWS for row in ((None, *each), ())]],
}


@pytest.mark.parametrize("name", TABLES)
def test_a_sheet_is_read_as_it_is_meant(name, tmp_path):
    (found,) = read_tests(book(tmp_path / "a.xlsx", Tabelle1=TABLES[name]))
    is_the_test(found)


def test_texts_among_numbers(tmp_path):
    """ "0,5" is 0.5 where the cells beside it are numbers; "1,018" alone may be 1018, and is refused."""
    rows = [(t, with_commas(f) if k % 9 else f, x) for k, (t, f, x) in enumerate(ROWS)]
    (found,) = read_tests(book(tmp_path / "a.xlsx", a=[*HEAD, *rows]))
    is_the_test(found)
    rows = [*ROWS[:5], (1.25, "1,018", 4.0), *ROWS[6:]]
    with pytest.raises(zw.InputError, match="holds text near line"):
        read_tests(book(tmp_path / "b.xlsx", a=[*HEAD, *rows]))


def test_several_sheets_are_trials_and_one_may_be_named(tmp_path):
    """Sheets of settings and results are none; a sheet that is hidden is read where it is named."""
    path = book(
        tmp_path / "a.xlsx",
        Parameter=[("Prüfer", "Müller"), ("Vorkraft", 0.05)],
        Ergebnisse=[("Probe", "Fmax [N]", "dL [mm]"), *[(k, 4.0, 1.0) for k in range(9)]],
        Probe1=[("Probe 1",), NAMES, UNITS, *ROWS],
        Probe2=[("Probe 2",), NAMES, UNITS, *ROWS[:-5]],
    )
    first, second = read_tests(path)
    is_the_test(first)
    assert second.time.size == 35
    assert [f.text for f in first.findings if f.kind == "sheet"] == ['read is the sheet "Probe1" of 4']
    assert [found.time.size for found in read_tests(path, sheet="probe2")] == [35]
    for sheet, message in (("Probe3", 'did you mean "Probe'), ("Ergebnisse", "without time")):
        with pytest.raises(zw.InputError, match=message):
            read_tests(path, sheet=sheet)
    with pytest.raises(zw.InputError, match=r"each hold a recording.*sheet=\"Probe1\""):
        zw.read_log(path, columns={"time": "Prüfzeit", "position": "Standardweg"})
    columns = {"time": "Prüfzeit", "position": "Standardweg", "hand_force": "Standardkraft"}
    assert zw.read_log(path, columns=columns, sheet="Probe2").samples == 35


def test_tests_under_each_other(tmp_path):
    """Each with the names above it again: one table, in which the time begins anew."""
    one = [NAMES, UNITS, *ROWS]
    (found,) = read_tests(book(tmp_path / "a.xlsx", a=[("Zyklus 1",), *one, (), ("Zyklus 2",), *one]))
    assert found.time.size == 80
    assert np.isfinite(found.force).all()


def test_another_table_is_left_out_and_said(tmp_path):
    path = book(tmp_path / "a.xlsx", a=[*HEAD, *ROWS, (), ("Klasse", "Zahl", "Anteil"), *[(1, 2, 3)] * 4])
    (found,) = read_tests(path)
    is_the_test(found)
    assert [f.text for f in found.findings] == ["rows 44 to 47 of the sheet are another table and left out"]


def test_a_sheet_of_results_of_which_each_row_begins_with_a_name_is_passed_over(tmp_path):
    names = [(None, "Probe", "Fmax", "dL"), (None, None, "N", "mm")]
    results = [*names, *[(f"A{k}", f"A{k}", 1.5 + k, 4.0) for k in range(9)]]
    (found,) = read_tests(book(tmp_path / "a.xlsx", Ergebnisse=results, A0=[*HEAD, *ROWS]))
    is_the_test(found)


def test_formulas_are_what_was_kept_of_them(tmp_path):
    """As the program that wrote the file computed them; without a result there is nothing to read."""
    path = book(tmp_path / "a.xlsx", a=[*HEAD, *[(t, f"={f}*1", x) for t, f, x in ROWS]])
    with pytest.raises(zw.InputError, match="results are not in the file"):
        read_tests(path)

    def cell(value: object) -> str:
        return f"<c><v>{value}</v></c>" if isinstance(value, float) else f'<c t="str"><v>{value}</v></c>'

    lines = ["".join(map(cell, HEAD[0]))]
    lines += [f"{cell(t)}<c><f>1*{f}</f><v>{f}</v></c>{cell(x)}" for t, f, x in ROWS]
    whole = "".join(f"<row>{line}</row>" for line in lines).encode()
    sheet(path, whole)
    (found,) = read_tests(path)
    is_the_test(found)


def with_part(path: Path, part: str, content: bytes) -> None:
    with ZipFile(path) as old:
        whole = {name: old.read(name) for name in old.namelist()}
    zipped(path, whole | {part: content})


def zipped(path: Path, parts: dict[str, bytes]) -> None:
    with ZipFile(path, "w", ZIP_DEFLATED) as new:
        for name, content in parts.items():
            new.writestr(name, content)


SHEET_XML, BROKEN = "xl/worksheets/sheet1.xml", "open it in a spreadsheet program"
SHEET = f'<worksheet xmlns="{MAIN}"><sheetData>'.encode()
END = b"</sheetData></worksheet>"
ENTITIES = b"".join(b'<!ENTITY e%d "%s">' % (k, b"&e%d;" % (k - 1) * 10) for k in range(1, 10))


def sheet(path: Path, rows: bytes, head: bytes = b"") -> None:
    with_part(path, SHEET_XML, head + SHEET + rows + END)


HEADS = {
    "grows": b'<!DOCTYPE x [<!ENTITY e0 "haha">' + ENTITIES + b"]>",
    "leads elsewhere": b'<!DOCTYPE x [<!ENTITY e SYSTEM "file:///etc/hostname">]>',
}
STYLES = b"<styleSheet>" + b"<xf/>" * 500_000 + b"</styleSheet>"
LED = b'<row><c t="inlineStr"><is><t>&e;</t></is></c></row>'
CONTENT = {"content.xml": b""}
OPEN = b"application/vnd.oasis.opendocument."


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda path: sheet(path, b'<row r="1">' + b"<c/>" * 2_000_000 + b"</row>"), "a row"),
        (lambda path: sheet(path, b'<row r="9999999999"/>'), "more than"),
        (lambda path: with_part(path, SHEET_XML, SHEET + b'<row r="1">'), BROKEN),
        (lambda path: with_part(path, "xl/styles.xml", STYLES), "are enough"),
        (lambda path: sheet(path, b"<row><c>&e9;</c></row>", HEADS["grows"]), BROKEN),
        (lambda path: sheet(path, LED, HEADS["leads elsewhere"]), f"{BROKEN}|no table"),
        (lambda path: path.write_bytes(path.read_bytes()[:2500]), "cut off"),
        (
            lambda path: path.write_bytes(path.read_bytes()[:-900] + bytes(40) + path.read_bytes()[-860:]),
            "cut off|copy it anew|cannot be read",
        ),
        (lambda path: zipped(path, CONTENT | {"xl/workbook.bin": b""}), "binary workbook"),
        (lambda path: zipped(path, CONTENT | {"mimetype": OPEN + b"spreadsheet"}), "OpenDocument"),
        (lambda path: zipped(path, CONTENT | {"mimetype": OPEN + b"text"}), "no workbook"),
    ],
)
def test_what_is_no_workbook_or_made_to_do_harm_is_refused(change, message, tmp_path, monkeypatch):
    """One message, before the memory is full; by what is inside, and nothing comes from another file."""
    monkeypatch.setattr("zwidth.data.logs.workbook.MOST_ROWS", 1000)
    path = book(tmp_path / "a.xlsx", a=[*HEAD, *ROWS])
    change(path)
    with pytest.raises(zw.InputError, match=message) as caught:
        read_tests(path)
    assert "\n" not in str(caught.value)


def test_two_cells_far_apart_fill_no_memory(tmp_path, monkeypatch):
    """What lies between them counts."""
    monkeypatch.setattr("zwidth.data.logs.workbook.MOST_CELLS", 10_000)
    path = book(tmp_path / "a.xlsx", a=[*HEAD, *ROWS])
    row = b'<row r="1"><c r="XFD1"><v>1</v></c></row>'
    sheet(path, row)
    with pytest.raises(zw.InputError, match="cells"):
        read_tests(path)


def test_a_text_has_no_sheets(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("Time [s],Force [N],Depth [mm]\n1,2,3\n2,3,4\n", encoding="utf-8")
    with pytest.raises(zw.InputError, match="no workbook and has no sheets"):
        read_tests(path, sheet="Probe 1")


NAMED, TIMED = "Zeit (s);Kraft [mN];Eindringtiefe/mm\n", "Time;Kraft [mN];Weg/mm\n"


COMMAS = str.maketrans(";.", ",,")


def german(value: float, digits: int) -> str:
    """1.234,5"""
    return f"{value:,.{digits}f}".translate(str.maketrans(",.", ".,"))


def english(value: float, digits: int) -> str:
    return f"{value:.{digits}f}"


def watch(value: float, start: float = 36903.25) -> str:
    at = value + start
    return f"{int(at // 3600) % 24:02d}:{int(at % 3600 // 60):02d}:{at % 60:06.3f}"


def rows(line: str, write=german) -> str:  # type: ignore[no-untyped-def]
    return "".join(
        line.format(t=write(t, 2), f=write(1000 * f, 1), x=write(1000 * x, 3), at=watch(t), k=k)
        for k, (t, x, f) in enumerate(zip(TIME, DEPTH, FORCE, strict=True))
    )


def grouped(sign: str):  # type: ignore[no-untyped-def]
    """1,234.5 with another sign between the thousands."""
    return lambda v, d: f"{v:,.{d}f}".replace(",", sign)


TEXT = NAMED + rows("{t};{f};{x}\n")
TEXTS = {
    "a mark of UTF-8, titles, Windows": "\ufeffProtokoll 3\nDatum;26.11.2026;\n\n" + TEXT,
    "letters of Windows": ("Prüfer: Müller\n" + TEXT).encode("cp1252"),
    "UTF-16": TEXT.encode("utf-16"),
    "UTF-16 without a mark": TEXT.encode("utf-16-le"),
    "old line ends": TEXT.replace("\n", "\r"),
    "for a spreadsheet": "sep=;\n" + TEXT,
    "units in a row": "Time,Load,Extension\n(s),(mN),(mm)\n" + rows('"{t}","{f}","{x}"\n', english),
    "US thousands": "t [s],F [mN],x [mm]\n" + rows('{t},"{f}",{x}\n', grouped(",")),
    "Swiss thousands": NAMED + rows("{t};{f};{x}\n", grouped("'")),
    "thousands after spaces that do not break": NAMED
    + rows("{t};{f};{x}\n", lambda v, d: german(v, d).replace(".", "\u00a0")),
    "commas in quotes": '"Zeit (s)","Kraft [mN]","Weg/mm"\n' + rows('"{t}","{f}","{x}"\n'),
    "minus as typeset": NAMED + rows("{t};−{f};{x}\n").replace("−-", ""),
    "empty columns": "Zeit (s);;Kraft [mN];Weg/mm;\n" + rows("{t};;{f};{x};\n"),
    "delimiters at the end of rows": NAMED + rows("{t};{f};{x};;\n"),
    "a row for each number": "Nr;Zeit (s);Kraft [mN];Weg/mm\n" + rows("{k};{t};{f};{x}\n"),
    "aligned": " Time [s]   Force [mN]  Depth [mm]\n" + rows("  {t}   {f}     {x}\n", english),
    "notes below": TEXT + "\nMittel;1,7;3,9\nProbe trocken;;\n;;\n",
    "times of day": "Uhrzeit;Kraft [mN];Weg/mm\n" + rows("{at};{f};{x}\n"),
    "date and time": "Zeitstempel;Kraft [mN];Weg/mm\n" + rows("26.11.2026 {at};{f};{x}\n"),
    "American date": TIMED + rows("11/26/2026 {at} AM;{f};{x}\n"),
}


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "sheet.csv"


@pytest.mark.parametrize("name", TEXTS)
def test_a_text_is_read_as_it_is_meant(name, path):
    content = TEXTS[name]
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    (found,) = read_tests(path)
    assert found.time - found.time[0] == pytest.approx(TIME, abs=1e-6)
    assert found.indentation == pytest.approx(DEPTH, abs=1e-6)
    assert np.abs(found.force) == pytest.approx(np.abs(FORCE), abs=6e-5)


@pytest.mark.parametrize("word", ["--", "NaN", "n.a.", "****", "OL", "k.A.", "#DIV/0!", "?", "#NV"])
def test_a_word_for_no_number(word, path):
    lines = TEXT.splitlines()
    lines[9] = ";".join([lines[9].split(";")[0], word, lines[9].split(";")[2]])
    path.write_text("\n".join([*lines, ""]))
    (found,) = read_tests(path)
    assert np.flatnonzero(np.isnan(found.force)).tolist() == [8]
    assert found.time.size == 40


def test_tests_side_by_side(path):
    for head, line in (
        (
            "Time 1 [s];Force 1 [mN];Depth 1 [mm];Time 2 [s];Force 2 [mN];Depth 2 [mm]",
            "{t};{f};{x};{t};{x};{f}",
        ),
        ("Time [s];Force [mN];Depth [mm];Time [s];Force [mN];Depth [mm]", "{t};{f};{x};{t};{x};{f}"),
        ("Time [s];Force 1 [mN];Depth 1 [mm];Force 2 [mN];Depth 2 [mm]", "{t};{f};{x};{x};{f}"),
        ("Time [s];Depth [mm];Force 1 [mN];Force 2 [mN]", "{t};{f};{f};{x}"),
    ):
        path.write_text(f"{head}\n" + rows(f"{line}\n"))
        first, second = read_tests(path)
        assert first.force == pytest.approx(FORCE, abs=6e-5)
        assert second.indentation == pytest.approx(FORCE, abs=6e-5)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (NAMED.replace(";", ",") + rows("{t};{f};{x}\n", english).translate(COMMAS), "semicolons"),
        ("Time,Force,Depth\n" + rows("{t} s,{f} mN,{x} mm\n", english), "hold a unit"),
        ("Time [s],1,2,3,4,5,6,7,8,9,10,11\nForce [N],1,2,3,4,5,6,7,8,9,10,11\n", "transpose"),
        (NAMED + rows("{t};{f};{x}\n").replace("\n0,50;", "\n0,50;viel", 1), "near line 4"),
        (TEXT + 6 * TEXT.partition("\n")[2] + "Ende;;\n" * 60, "near line 282"),
        (TIMED + rows("45987,4{k};{f};{x}\n"), "days"),
        (f"{TIMED}01/02/2026 10:15:03;1;2\n01/03/2026 10:15:03;1;2\n", "day and month may be either"),
        (TIMED + rows("10:{k};{f};{x}\n"), "unit|time"),
    ],
)
def test_what_is_not_clear_is_refused_with_what_to_do(text, message, path):
    path.write_text(text)
    with pytest.raises(zw.InputError, match=message):
        read_tests(path)


def test_a_log_of_a_german_sheet(path):
    steps = np.random.default_rng(1).integers(-9, 9, 400).cumsum()
    lines = [f"{german(k, 0)};{german(0.5 * s, 1)};{german(100.0 * s, 1)}" for k, s in enumerate(steps)]
    path.write_text("Zeit/ms;Weg/mm;Kraft/mN\n" + "\n".join(lines) + "\nEnde;;\n")
    log = zw.read_log(path)
    position = np.concatenate([block.position for block in log.blocks()])
    assert position == pytest.approx(0.0005 * steps)
    assert log.sample_period == pytest.approx(0.001)


with_comma, with_point = (partial(number, decimal=sign) for sign in ",.")


@pytest.mark.parametrize(
    ("read", "field", "answer"),
    [
        (decimal_of, ["1", "1.018", "1,5"], ","),
        (decimal_of, ["1.018", "1,018"], None),
        (decimal_of, ["1.018,5"], ","),
        (decimal_of, ["1,018.5"], "."),
        (decimal_of, ["1.018.000"], ","),
        (decimal_of, ["0.512"], "."),
        (decimal_of, ["n.a.", "12"], None),
        (with_comma, "1.018", 1018),
        (with_point, "1.018", 1.018),
        (with_point, "1'018.5", 1018.5),
        (with_comma, "-12 345,5", -12345.5),
        (with_comma, "1,5E-03", 0.0015),
        (with_comma, "0.7", None),
        (with_comma, "1.01,5", None),
        (with_point, "12a", None),
        (clock, "10:15:03.25", 36903.25),
        (clock, "10:15:03,250", 36903.25),
        (clock, "10:15:03:250", 36903.25),
        (clock, "1:00:00 PM", 46800),
        (clock, "12:00:00 am", 0),
        (clock, "30:00:00", 108000),
        (clock, "15:03.5", 903.5),
        (clock, "10:15", None),
        (clock, "10:75:00", None),
    ],
)
def test_decimal_signs_numbers_and_clocks(read, field, answer):
    assert read(field) == answer
