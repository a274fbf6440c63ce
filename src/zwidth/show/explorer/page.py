"""The page around one session: headings, landmarks, tabs; nothing of it comes from another server."""

from __future__ import annotations

from pathlib import Path

import panel as pn

from zwidth.show.explorer.session import Session

_HERE = Path(__file__).parent


def page_of(session: Session) -> pn.Template:
    """The page as a template that can be served."""
    template = pn.Template(_read("page.html"))
    template.add_variable("views", [(key, name) for key, name, *_ in session.views])
    for name in ("page.css", "page.js"):
        template.add_variable(name.replace(".", "_"), _read(name))
    template.add_panel("form", session.form)
    template.add_panel("head", session.head)
    template.add_panel("details", session.details)
    template.add_panel("badge", session.badge)
    for view in session.views:
        template.add_panel(view.key, pn.Column(*view.parts, sizing_mode="stretch_width"))
    return template


def _read(name: str) -> str:
    return (_HERE / name).read_text(encoding="utf-8")


def full_page(most: int) -> pn.Template:
    """Of a server that has as many pages open as it may."""
    template = pn.Template(_read("full.html"))
    template.add_variable("most", most)
    template.add_variable("page_css", _read("page.css"))
    return template
