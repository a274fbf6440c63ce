"""Lines and tables that fit: nothing is lost, nothing is wider than the page."""

import io
import json
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.cells import cell_len

from zwidth.cli import output
from zwidth.cli.output import (
    columns,
    fitted,
    print_json,
    print_report,
    print_text,
    spelled,
    tolerate_encoding,
    width_of,
    wrapped,
)
from zwidth.quantity.text import to_json
from zwidth.showing import Lines, Table

words = st.text(st.sampled_from("ab·é力µ→ "), max_size=120)


@given(words, st.integers(4, 60))
def test_text_is_broken_and_nothing_is_lost(text, width):
    """But blanks."""
    lines = list(wrapped(text, width))
    assert all(width_of(line) <= width for line in lines)
    assert "".join("".join(lines).split()) == "".join(text.split())


@pytest.mark.parametrize("text", ["plain", "力覚 wide", "e\u0301 accent", "N·s/m → µ"])
def test_columns_are_those_of_a_terminal(text):
    assert width_of(text) == cell_len(text)


def test_an_item_goes_on_under_its_own_beginning():
    assert list(wrapped("· one two three", 9)) == ["· one two", "  three"]
    assert list(wrapped("12. one two", 8)) == ["12. one", "    two"]


def test_a_table_that_is_too_wide_becomes_several():
    """Each with the names of its rows, every cell once."""
    heads = [["", "first", "second", "third"], ["", "N", "m", "s"]]
    rows = [["row one", "1", "22", "333"], ["row two", "4", "55", "666"]]
    whole = list(fitted([Table(heads=heads, rows=rows, lefts=1)], 80))
    assert whole == [
        "         first  second  third",
        "             N       m      s",
        "row one      1      22    333",
        "row two      4      55    666",
    ]
    stacked = list(fitted([Table(heads=heads, rows=rows, lefts=1)], 22))
    assert max(map(width_of, stacked)) <= 22
    assert stacked.count("") == 1
    assert " ".join(stacked).split() == [
        *("first", "second", "N", "m", "row", "one", "1", "22", "row", "two", "4", "55"),
        *("third", "s", "row", "one", "333", "row", "two", "666"),
    ]
    assert max(map(width_of, fitted([Table(heads=heads, rows=rows, lefts=1)], 10))) <= 10


def test_names_with_long_texts_and_lists():
    """A text goes on beside its name; the items of a list under themselves."""
    parts = [Table(rows=[["name", "a text of some words"]], caption="of it"), Lines(["an item of a list"])]
    assert list(fitted(parts, 16)) == [
        "of it", "", "name  a text of", "      some words", "· an item of a", "  list",
    ]  # fmt: skip


def test_the_width_is_that_of_the_terminal(monkeypatch):
    """Of COLUMNS before it; 80 without either; no more than 100, and never so few that no word fits."""
    monkeypatch.delenv("COLUMNS", raising=False)
    monkeypatch.setattr(sys, "stdout", io.StringIO())
    assert columns() == 80
    for asked, given_ in (("63", 63), ("200", 100), ("3", 20), ("wide", 80), ("0", 80)):
        monkeypatch.setenv("COLUMNS", asked)
        assert columns() == given_


class _Terminal(io.TextIOWrapper):
    """Says that it is a terminal."""

    def isatty(self):
        return True


@pytest.mark.parametrize(("locale", "encoding"), [("C", "ascii"), ("POSIX", "ascii"), ("C.UTF-8", "utf-8")])
def test_a_terminal_of_the_locale_c_has_ascii(monkeypatch, locale, encoding):
    """What it lacks is spelled out before lines are broken, so that they still fit."""
    shown = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", _Terminal(shown, encoding="utf-8"))
    monkeypatch.setenv("LC_ALL", locale)
    monkeypatch.setenv("COLUMNS", "20")
    tolerate_encoding()
    assert sys.stdout.encoding == encoding
    print_text("a → b → c → d → e → f → g")
    print_report([Table(rows=[["Δ", "1 ≤ 2 ≤ 3 ≤ 4 ≤ 5 ≤ 6"]])])
    lines = shown.getvalue().decode(encoding).splitlines()
    assert max(map(width_of, lines)) <= 20
    assert ("->" in lines[0]) == (encoding == "ascii")
    assert spelled("≥") == (">=" if encoding == "ascii" else "≥")


@pytest.mark.parametrize("encoding", ["utf-8", "cp1252", "ascii"])
def test_json_is_utf_8_whatever_the_pipe(monkeypatch, encoding):
    """On Windows a file behind > has the code page, which a reader of JSON does not expect."""
    shown = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(shown, encoding=encoding))
    print_json(to_json({"claim": "20 N·m/rad, τ ≤ 1 ms"}))
    assert json.loads(shown.getvalue().decode("utf-8")) == {"claim": "20 N·m/rad, τ ≤ 1 ms"}


def test_a_pipe_of_the_locale_c_is_left_as_it_is(monkeypatch):
    """A file is no terminal."""
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(io.BytesIO(), encoding="utf-8"))
    monkeypatch.setenv("LC_ALL", "C")
    output.tolerate_encoding()
    assert sys.stdout.encoding == "utf-8"
