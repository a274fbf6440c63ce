"""Spreadsheets as people have them: each is read as it is meant, or refused with what to do."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import zwidth as zw
from zwidth.data.logs.cells import clock, decimal_of, number
from zwidth.data.tissue.experiment.columns import read_tests

TIME = 0.25 * np.arange(40)
DEPTH = 0.004 * np.clip(TIME, 0, 1)
FORCE = 1.7 * np.clip(TIME, 0, 1) - 0.0125 * np.arange(40) % 0.3
HEAD, TIMED = "Zeit (s);Kraft [mN];Eindringtiefe/mm\n", "Time;Kraft [mN];Weg/mm\n"


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
    """A line for each sample."""
    return "".join(
        line.format(t=write(t, 2), f=write(1000 * f, 1), x=write(1000 * x, 3), at=watch(t), k=k)
        for k, (t, x, f) in enumerate(zip(TIME, DEPTH, FORCE, strict=True))
    )


def grouped(sign: str):  # type: ignore[no-untyped-def]
    """1,234.5 with another sign between the thousands."""
    return lambda v, d: f"{v:,.{d}f}".replace(",", sign)


SHEET = HEAD + rows("{t};{f};{x}\n")
SHEETS = {
    "a mark of UTF-8, titles, Windows": "\ufeffProtokoll 3\nDatum;26.11.2026;\n\n" + SHEET,
    "letters of Windows": ("Prüfer: Müller\n" + SHEET).encode("cp1252"),
    "UTF-16": SHEET.encode("utf-16"),
    "UTF-16 without a mark": SHEET.encode("utf-16-le"),
    "old line ends": SHEET.replace("\n", "\r"),
    "for a spreadsheet": "sep=;\n" + SHEET,
    "units in a row": "Time,Load,Extension\n(s),(mN),(mm)\n" + rows('"{t}","{f}","{x}"\n', english),
    "US thousands": "t [s],F [mN],x [mm]\n" + rows('{t},"{f}",{x}\n', grouped(",")),
    "Swiss thousands": HEAD + rows("{t};{f};{x}\n", grouped("'")),
    "thousands after spaces that do not break": HEAD
    + rows("{t};{f};{x}\n", lambda v, d: german(v, d).replace(".", "\u00a0")),
    "commas in quotes": '"Zeit (s)","Kraft [mN]","Weg/mm"\n' + rows('"{t}","{f}","{x}"\n'),
    "minus as typeset": HEAD + rows("{t};−{f};{x}\n").replace("−-", ""),
    "empty columns": "Zeit (s);;Kraft [mN];Weg/mm;\n" + rows("{t};;{f};{x};\n"),
    "delimiters at the end of rows": HEAD + rows("{t};{f};{x};;\n"),
    "a row for each number": "Nr;Zeit (s);Kraft [mN];Weg/mm\n" + rows("{k};{t};{f};{x}\n"),
    "aligned": " Time [s]   Force [mN]  Depth [mm]\n" + rows("  {t}   {f}     {x}\n", english),
    "notes below": SHEET + "\nMittel;1,7;3,9\nProbe trocken;;\n;;\n",
    "times of day": "Uhrzeit;Kraft [mN];Weg/mm\n" + rows("{at};{f};{x}\n"),
    "date and time": "Zeitstempel;Kraft [mN];Weg/mm\n" + rows("26.11.2026 {at};{f};{x}\n"),
    "American date": TIMED + rows("11/26/2026 {at} AM;{f};{x}\n"),
}


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """Of the sheet."""
    return tmp_path / "sheet.csv"


@pytest.mark.parametrize("name", SHEETS)
def test_a_sheet_is_read_as_it_is_meant(name, path):
    content = SHEETS[name]
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    (found,) = read_tests(path)
    assert found.time - found.time[0] == pytest.approx(TIME, abs=1e-6)
    assert found.indentation == pytest.approx(DEPTH, abs=1e-6)
    assert np.abs(found.force) == pytest.approx(np.abs(FORCE), abs=6e-5)


@pytest.mark.parametrize("word", ["--", "NaN", "n.a.", "****", "OL", "k.A.", "#DIV/0!", "?", "#NV"])
def test_a_word_for_no_number(word, path):
    lines = SHEET.splitlines()
    lines[9] = ";".join([lines[9].split(";")[0], word, lines[9].split(";")[2]])
    path.write_text("\n".join([*lines, ""]))
    (found,) = read_tests(path)
    assert np.flatnonzero(np.isnan(found.force)).tolist() == [8]
    assert found.time.size == 40


def test_tests_side_by_side(path):
    """Named alike but for a number, or alike; one column of time for both, or two."""
    for head, line in (
        (
            "Time 1 [s];Force 1 [mN];Depth 1 [mm];Time 2 [s];Force 2 [mN];Depth 2 [mm]",
            "{t};{f};{x};{t};{x};{f}",
        ),
        ("Time [s];Force [mN];Depth [mm];Time [s];Force [mN];Depth [mm]", "{t};{f};{x};{t};{x};{f}"),
        ("Time [s];Force 1 [mN];Depth 1 [mm];Force 2 [mN];Depth 2 [mm]", "{t};{f};{x};{x};{f}"),
    ):
        path.write_text(f"{head}\n" + rows(f"{line}\n"))
        first, second = read_tests(path)
        assert first.force == pytest.approx(FORCE, abs=6e-5)
        assert second.indentation == pytest.approx(FORCE, abs=6e-5)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (HEAD.replace(";", ",") + rows("{t};{f};{x}\n", english).translate(COMMAS), "semicolons"),
        ("Time,Force,Depth\n" + rows("{t} s,{f} mN,{x} mm\n", english), "hold a unit"),
        ("Time [s],1,2,3,4,5,6,7,8,9,10,11\nForce [N],1,2,3,4,5,6,7,8,9,10,11\n", "transpose"),
        (HEAD + rows("{t};{f};{x}\n").replace("\n0,50;", "\n0,50;viel", 1), "near line 4"),
        (SHEET + 6 * SHEET.partition("\n")[2] + "Ende;;\n" * 60, "near line 282"),
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


@pytest.mark.parametrize(
    ("fields", "sign"),
    [
        (["1", "1.018", "1,5"], ","),
        (["1.018", "1,018"], None),
        (["1.018,5"], ","),
        (["1,018.5"], "."),
        (["1.018.000"], ","),
        (["0.512"], "."),
        (["n.a.", "12"], None),
    ],
)
def test_the_decimal_sign(fields, sign):
    assert decimal_of(fields) == sign


@pytest.mark.parametrize(
    ("field", "decimal", "value"),
    [
        ("1.018", ",", 1018),
        ("1.018", ".", 1.018),
        ("1'018.5", ".", 1018.5),
        ("-12 345,5", ",", -12345.5),
        ("1,5E-03", ",", 0.0015),
        ("0.7", ",", None),
        ("1.01,5", ",", None),
        ("12a", ".", None),
    ],
)
def test_a_number(field, decimal, value):
    assert number(field, decimal) == value


@pytest.mark.parametrize(
    ("field", "seconds"),
    [
        ("10:15:03.25", 36903.25),
        ("10:15:03,250", 36903.25),
        ("10:15:03:250", 36903.25),
        ("1:00:00 PM", 46800),
        ("12:00:00 am", 0),
        ("30:00:00", 108000),
        ("15:03.5", 903.5),
        ("10:15", None),
        ("10:75:00", None),
    ],
)
def test_a_clock(field, seconds):
    assert clock(field) == seconds
