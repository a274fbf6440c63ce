"""The page of `zwidth play`, made where the docs are built, beside their other static files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from zwidth.show.explorer.play import play_page, presets


def setup(app: Any) -> dict[str, bool]:
    """Write it at the end of a build of HTML."""
    app.connect("build-finished", _write)
    return {"parallel_read_safe": True}


def _write(app: Any, failure: Exception | None) -> None:
    if failure is None and app.builder.format == "html":
        static = Path(app.outdir) / "_static"
        static.mkdir(exist_ok=True)
        page = play_page(presets(), title="Play with a loop")
        (static / "play.html").write_text(page, encoding="utf-8")
