"""A file within a PDF file (ISO 32000-1, section 7.11.4), which ReportLab has no call for."""

from __future__ import annotations

from typing import Any


def attach(canvas: Any, name: str, data: bytes, says: str) -> None:
    """Attach a file to the document of a canvas.

    Parameters
    ----------
    canvas
        Of ReportLab.
    name, says
        What it is called, and what it is.
    data
        What is in it.
    """
    from reportlab.pdfbase import pdfdoc

    document = canvas._doc
    stream = pdfdoc.PDFStream(content=data, filters=[pdfdoc.PDFZCompress])
    stream.dictionary.dict["Type"] = pdfdoc.PDFName("EmbeddedFile")
    stream.dictionary.dict["Subtype"] = pdfdoc.PDFName("application/json")
    stream.dictionary.dict["Params"] = pdfdoc.PDFDictionary({"Size": len(data)})
    shown = pdfdoc.PDFString(name)
    file = pdfdoc.PDFDictionary(
        {
            "Type": pdfdoc.PDFName("Filespec"),
            "F": shown,
            "UF": shown,
            "Desc": pdfdoc.PDFString(says),
            "EF": pdfdoc.PDFDictionary({"F": document.Reference(stream)}),
        }
    )
    names = pdfdoc.PDFDictionary({"Names": pdfdoc.PDFArray([shown, document.Reference(file)])})
    document.Catalog.Names = pdfdoc.PDFDictionary({"EmbeddedFiles": names})
