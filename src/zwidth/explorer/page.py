"""The page around one session: headings, landmarks, tabs; nothing of it comes from another server."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import panel as pn

from zwidth.explorer.criterion import NAME as CRITERION
from zwidth.explorer.session import Session

_HERE = Path(__file__).parent


def views(session: Session) -> list[tuple[str, str, list[Any]]]:
    """Key, name and parts of each picture, in the order of the tabs."""
    return [("criterion", CRITERION, [session.criterion.figure, session.criterion_caption])]


def page_of(session: Session) -> pn.Template:
    """The page as a template that can be served."""
    shown = views(session)
    template = pn.Template(_template())
    template.add_variable("views", [(key, name) for key, name, _ in shown])
    for name in ("page.css", "page.js"):
        template.add_variable(name.replace(".", "_"), _read(name))
    template.add_panel("form", session.form)
    template.add_panel("card", session.card)
    template.add_panel("badge", session.badge)
    for key, _, parts in shown:
        template.add_panel(key, pn.Column(*parts, sizing_mode="stretch_width"))
    return template


def _template() -> Any:
    return _read("page.html")


def _read(name: str) -> str:
    return (_HERE / name).read_text(encoding="utf-8")


def full_page(most: int) -> pn.Template:
    """Of a server that has as many pages open as it may."""
    template = pn.Template(_read("full.html"))
    template.add_variable("most", most)
    template.add_variable("page_css", _read("page.css"))
    return template
