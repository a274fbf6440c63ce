"""Workbooks as testing machines and people write them: read as they are meant, or refused with what to do."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any
from zipfile import ZIP_DEFLATED, ZipFile

import numpy as np
import pytest
from openpyxl import Workbook

import zwidth as zw
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
    """A workbook with these rows on its sheets."""
    made = Workbook()
    made.remove(made.active)
    for name, rows in sheets.items():
        sheet = made.create_sheet(name)
        for row in rows:
            sheet.append(list(row))
    made.save(path)
    return path


def is_the_test(found: Any) -> None:
    """To the digit that the sheet has."""
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
    for sheet, message in (("Probe3", 'did you mean "Probe'), ("Ergebnisse", "known to be the time")):
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
    changed(path, {SHEET_XML: lambda _: SHEET + whole + END})
    (found,) = read_tests(path)
    is_the_test(found)


def changed(path: Path, parts: dict[str, Callable[[bytes], bytes]]) -> None:
    """Write a workbook anew with some of its parts otherwise."""
    with ZipFile(path) as old:
        whole = {name: old.read(name) for name in old.namelist()}
    with ZipFile(path, "w", ZIP_DEFLATED) as new:
        for name, content in whole.items():
            new.writestr(name, parts.get(name, bytes)(content))


SHEET_XML, BROKEN = "xl/worksheets/sheet1.xml", "open it in a spreadsheet program"
SHEET = f'<worksheet xmlns="{MAIN}"><sheetData>'.encode()
END = b"</sheetData></worksheet>"
ENTITIES = b"".join(b'<!ENTITY e%d "%s">' % (k, b"&e%d;" % (k - 1) * 10) for k in range(1, 10))


@pytest.mark.parametrize(
    ("part", "content", "message"),
    [
        (SHEET_XML, SHEET + b'<row r="1">' + b"<c/>" * 2_000_000 + b"</row>" + END, "a row"),
        (SHEET_XML, SHEET + b'<row r="9999999999"/>' + END, "more than"),
        (SHEET_XML, SHEET + b'<row r="1">', BROKEN),
        ("xl/styles.xml", b"<styleSheet>" + b"<xf/>" * 500_000 + b"</styleSheet>", "are enough"),
        (
            SHEET_XML,
            b'<!DOCTYPE x [<!ENTITY e0 "haha">' + ENTITIES + b"]>" + SHEET + b"<row><c>&e9;</c></row>" + END,
            BROKEN,
        ),
        (
            SHEET_XML,
            b'<!DOCTYPE x [<!ENTITY e SYSTEM "file:///etc/hostname">]>'
            + (SHEET + b'<row><c t="inlineStr"><is><t>&e;</t></is></c></row>' + END),
            f"{BROKEN}|no table",
        ),
    ],
)
def test_a_workbook_made_to_do_harm_is_refused(part, content, message, tmp_path, monkeypatch):
    """One message, before the memory is full; nothing comes from another file."""
    monkeypatch.setattr("zwidth.data.logs.workbook.MOST_ROWS", 1000)
    path = book(tmp_path / "a.xlsx", a=[*HEAD, *ROWS])
    changed(path, {part: lambda _: content})
    with pytest.raises(zw.InputError, match=message) as caught:
        read_tests(path)
    assert "\n" not in str(caught.value)


def test_two_cells_far_apart_fill_no_memory(tmp_path, monkeypatch):
    """What lies between them counts."""
    monkeypatch.setattr("zwidth.data.logs.workbook.MOST_CELLS", 10_000)
    path = book(tmp_path / "a.xlsx", a=[*HEAD, *ROWS])
    row = b'<row r="1"><c r="XFD1"><v>1</v></c></row>'
    changed(path, {SHEET_XML: lambda _: SHEET + row + END})
    with pytest.raises(zw.InputError, match="cells"):
        read_tests(path)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda whole: whole[: len(whole) // 2], "cut off"),
        (lambda whole: whole[:-900] + bytes(40) + whole[-860:], "cut off|copy it anew|cannot be read"),
    ],
)
def test_a_damaged_workbook_is_refused(change, message, tmp_path):
    path = book(tmp_path / "a.xlsx", a=[*HEAD, *ROWS])
    path.write_bytes(change(path.read_bytes()))
    with pytest.raises(zw.InputError, match=message):
        read_tests(path)


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("xl/workbook.bin", b"", "binary workbook"),
        ("mimetype", b"application/vnd.oasis.opendocument.spreadsheet", "OpenDocument"),
        ("mimetype", b"application/vnd.oasis.opendocument.text", "no workbook"),
    ],
)
def test_what_is_no_workbook(name, content, message, tmp_path):
    """By what is inside, whatever the name."""
    with ZipFile(tmp_path / "a.xlsx", "w") as made:
        made.writestr("content.xml", "")
        made.writestr(name, content)
    with pytest.raises(zw.InputError, match=message):
        read_tests(tmp_path / "a.xlsx")


def test_a_text_has_no_sheets(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("Time [s],Force [N],Depth [mm]\n1,2,3\n2,3,4\n", encoding="utf-8")
    with pytest.raises(zw.InputError, match="no workbook and has no sheets"):
        read_tests(path, sheet="Probe 1")
