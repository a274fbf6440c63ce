"""The report as a PDF file: title, language, letters of its own, and the proof attached."""

from __future__ import annotations

import re
import sys
import zlib
from pathlib import Path

import pytest

import zwidth as zw
from zwidth.passivity.verdict import Verdict
from zwidth.quantity.text import json_file

reportlab = pytest.importorskip("reportlab")


@pytest.fixture(scope="module")
def document(hostile: Verdict) -> bytes:
    """Of a device with a hostile name."""
    return zw.report.pdf(hostile)


def _streams(document: bytes, kind: bytes) -> list[bytes]:
    """What is in the streams whose dictionary has this word."""
    found = re.findall(rb"<<([^>]*(?:<<[^>]*>>[^>]*)*)>>\s*stream\r?\n(.*?)endstream", document, re.DOTALL)
    return [zlib.decompress(data.rstrip(b"\r\n")) for head, data in found if kind in head]


def test_it_says_what_it_is(document: bytes) -> None:
    """Title, author and language for those who have it read aloud; a date that is always the same."""
    assert document.startswith(b"%PDF-")
    assert re.search(rb"/Lang \(en\)", document)
    assert re.search(rb"/Author \(zwidth\)", document)
    assert re.search(rb"/Title \(passive: <script>alert\\\(1\\\)", document)
    assert set(re.findall(rb"/(?:CreationDate|ModDate) \(D:(\d{8})", document)) == {b"20000101"}


def test_the_proof_is_attached(document: bytes, hostile: Verdict) -> None:
    """The very bytes that `save` writes."""
    assert b"/EmbeddedFiles" in document
    assert b"(verdict.json)" in document
    assert _streams(document, b"/EmbeddedFile") == [json_file(hostile.saved())]


def test_greek_letters_are_embedded(document: bytes) -> None:
    """All letters come with the file, and nothing in it is run."""
    fonts = set(re.findall(rb"/BaseFont /([\w+-]+)", document))
    assert {name.partition(b"+")[2] for name in fonts} >= {b"DejaVuSans", b"DejaVuSans-Bold"}
    assert b"/FontFile2" in document
    assert b"/JavaScript" not in document


def test_without_reportlab_one_sentence_says_what_to_do(
    active: Verdict, monkeypatch: pytest.MonkeyPatch
) -> None:
    """And a page can be written."""
    monkeypatch.delitem(sys.modules, "zwidth.show.report.pdf_file", raising=False)
    for name in [name for name in sys.modules if name.split(".")[0] == "reportlab"]:
        monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(zw.InputError, match=r"needs ReportLab: pip install 'zwidth\[report\]'.*\.html"):
        zw.report.pdf(active)
    with pytest.raises(zw.InputError, match="needs ReportLab"):
        zw.report.check_ending(Path("report.pdf"))
