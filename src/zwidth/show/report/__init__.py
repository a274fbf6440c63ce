"""A report to hand on: verdict, scope, proof, figures and where each number comes from, in one file.

The same verdict gives the same bytes, in every process and folder: no date, no path, no random number.
"""

from __future__ import annotations

from pathlib import Path

from zwidth.errors import InputError
from zwidth.passivity.result import Answer
from zwidth.show.report.contents import contents
from zwidth.show.report.provenance import Provenance
from zwidth.writing import check_target, writing_whole

__all__ = ["Provenance", "html", "save"]


def html(verdict: Answer, provenance: Provenance | None = None) -> str:
    """The report as one page of HTML that asks for nothing else: no script, no font, no address abroad.

    Parameters
    ----------
    verdict
        What `zwidth.check` returned.
    provenance
        Where each number of the loop comes from, and the command; by default what can be seen of the loop.
    """
    from zwidth.show.report.html_page import page

    return page(contents(verdict, provenance))


def save(
    verdict: Answer, path: str | Path, provenance: Provenance | None = None, overwrite: bool = False
) -> None:
    """Write the report as a page, a file that ends in .html.

    Parameters
    ----------
    verdict, provenance
        As for `html`.
    path
        The file.
    overwrite
        Replace one that exists.

    Raises
    ------
    InputError
        If the ending is another one, or the file exists or cannot be written.
    """
    target = Path(path)
    check_ending(target)
    check_target(target, overwrite, "overwrite=True")
    page = html(verdict, provenance).encode()
    with writing_whole(target) as file:
        file.write(page)


def check_ending(path: Path) -> None:
    """Refuse a name of which no report can be made, before anything is computed."""
    if path.suffix.lower() == ".pdf":
        raise InputError(
            f"a report is written as .html, got {path.name!r}: write the page, and print it to PDF from the "
            "browser"
        )
    if path.suffix.lower() != ".html":
        raise InputError(f"a report is written as .html, got {path.name!r}; for example report.html")
