"""The report as a PDF file: the same parts on pages, with the proof attached.

Letters are those of DejaVu Sans, which comes with matplotlib and has the Greek ones.
"""

from __future__ import annotations

from collections.abc import Iterator
from html import escape
from io import BytesIO
from typing import Any

from zwidth.errors import InputError
from zwidth.show.report.again import how_to_check_again
from zwidth.show.report.attachment import attach
from zwidth.show.report.contents import Contents, Section
from zwidth.show.report.figures import pictures
from zwidth.show.report.proof import NAME
from zwidth.showing import Headline, Lines, Part, Picture, Table, printable

try:
    from reportlab.lib import colors, pagesizes, units
    from reportlab.lib.styles import ParagraphStyle
    from reportlab.pdfbase import pdfmetrics
    from reportlab.pdfbase.ttfonts import TTFont
    from reportlab.platypus import Image, ListFlowable, Paragraph, SimpleDocTemplate, Spacer
    from reportlab.platypus import Table as Grid
except ImportError:
    raise InputError(
        "a report as PDF needs ReportLab: pip install 'zwidth[report]', or write it as .html"
    ) from None

_REGULAR, _BOLD = "DejaVuSans", "DejaVuSans-Bold"
_WIDTH = pagesizes.A4[0] - 40 * units.mm - 12  # ReportLab leaves six points free on each side
_SOFT, _LINE = colors.HexColor("#555555"), colors.HexColor("#cccccc")

_TEXT = ParagraphStyle("text", fontName=_REGULAR, fontSize=9, leading=12.5, spaceAfter=4)
_CELL = ParagraphStyle("cell", _TEXT, fontSize=8.5, leading=11, spaceAfter=0, splitLongWords=1)
_NAME = ParagraphStyle("name", _CELL, textColor=_SOFT)
_NOTE = ParagraphStyle("note", _TEXT, textColor=_SOFT, fontSize=8.5, leading=11)
_TITLE = ParagraphStyle("title", _TEXT, fontName=_BOLD, fontSize=15, leading=19, spaceAfter=6)
_HEADING = ParagraphStyle(
    "heading", _TEXT, fontName=_BOLD, fontSize=11, leading=14, spaceBefore=10, keepWithNext=1
)
_CLAIM = ParagraphStyle("claim", _TEXT, fontSize=10.5, leading=15)


def document(said: Contents) -> bytes:
    """The report as the bytes of a PDF file."""
    _register_fonts()
    file = BytesIO()
    pages = SimpleDocTemplate(
        file,
        pagesize=pagesizes.A4,
        leftMargin=20 * units.mm,
        rightMargin=20 * units.mm,
        topMargin=18 * units.mm,
        bottomMargin=18 * units.mm,
        title=printable(f"{said.verdict.word}: {said.title}"),
        author="zwidth",
        subject=printable(said.verdict.claim),
        lang="en",
        invariant=1,
        initialFontName=_REGULAR,
    )
    pages.build(list(_flow(said)), onFirstPage=lambda canvas, _: _first(canvas, said), onLaterPages=_number)
    return file.getvalue()


def _register_fonts() -> None:
    from matplotlib import get_data_path

    for name in (_REGULAR, _BOLD):
        pdfmetrics.registerFont(TTFont(name, f"{get_data_path()}/fonts/ttf/{name}.ttf"))
    pdfmetrics.registerFontFamily(_REGULAR, normal=_REGULAR, bold=_BOLD, italic=_REGULAR, boldItalic=_BOLD)


def _first(canvas: Any, said: Contents) -> None:
    attach(canvas, NAME, said.document, "the verdict with its evidence")
    _number(canvas, None)


def _number(canvas: Any, _: object) -> None:
    canvas.setFont(_REGULAR, 8)
    canvas.setFillColor(_SOFT)
    canvas.drawRightString(
        pagesizes.A4[0] - 20 * units.mm, 10 * units.mm, f"zwidth · {canvas.getPageNumber()}"
    )


def _flow(said: Contents) -> Iterator[Any]:
    """All that stands on the pages, from the top down."""
    yield _paragraph("Report of zwidth", _NOTE)
    yield _paragraph(said.title, _TITLE)
    yield from _part(said.verdict)
    drawn = pictures(said.answer, "png")
    again = how_to_check_again(said, f"{NAME} is attached to this file.", "reportlab")
    sections = [
        *said.before_pictures,
        *([Section("Figures", drawn)] if drawn else []),
        *said.after_pictures,
        Section("How to check it again", again),
    ]
    for section in sections:
        yield _paragraph(section.title, _HEADING)
        for part in section.parts:
            yield from _part(part)


def _part(part: Part) -> Iterator[Any]:
    if isinstance(part, str):
        yield _paragraph(part, _TEXT)
    elif isinstance(part, Headline):
        word = f"&nbsp;{_text(part.word.upper())}&nbsp;"
        badge = f'<font name="{_BOLD}" color="white" backColor="{part.colour}">{word}</font>'
        yield Paragraph(f"{badge} {_text(part.claim)}", _CLAIM)
    elif isinstance(part, Lines):
        items = [_paragraph(str(item), _TEXT) for item in part.items]
        yield ListFlowable(items, bulletType="bullet", start="·", leftIndent=10, bulletFontName=_BOLD)
    elif isinstance(part, Table):
        yield from _table(part)
    else:
        yield from _picture(part)


def _table(part: Table) -> Iterator[Any]:
    if part.caption:
        yield _paragraph(part.caption, _NOTE)
    first = _CELL if part.heads else _NAME
    heads = [[_paragraph(cell, _NOTE) for cell in row] for row in part.heads]
    rows = [[_paragraph(cell, first if k == 0 else _CELL) for k, cell in enumerate(row)] for row in part.rows]
    style = [("LINEBELOW", (0, 0), (-1, -1), 0.4, _LINE), ("VALIGN", (0, 0), (-1, -1), "TOP"),
             ("LEFTPADDING", (0, 0), (-1, -1), 0), ("TOPPADDING", (0, 0), (-1, -1), 2),
             ("BOTTOMPADDING", (0, 0), (-1, -1), 2)]  # fmt: skip
    yield Grid([*heads, *rows], colWidths=_columns(len(part.rows[0])), style=style, repeatRows=len(heads))
    yield Spacer(0, 6)


def _columns(count: int) -> list[float]:
    """Widths: of few columns the last has the most room."""
    shares = {2: (0.34, 0.66), 3: (0.26, 0.22, 0.52)}.get(count, (1 / count,) * count)
    return [_WIDTH * share for share in shares]


def _picture(part: Picture) -> Iterator[Any]:
    image = Image(BytesIO(part.data), lazy=0)
    scale = min(1.0, 0.68 * _WIDTH / image.imageWidth)
    image.drawWidth, image.drawHeight = scale * image.imageWidth, scale * image.imageHeight
    image.hAlign = "LEFT"
    yield image
    if part.caption:
        yield _paragraph(part.caption, _NOTE)


def _paragraph(text: str, style: ParagraphStyle) -> Paragraph:
    return Paragraph(_text(text), style)


def _text(text: str) -> str:
    """Text that ReportLab obeys nothing of."""
    return escape(printable(text), quote=False)
