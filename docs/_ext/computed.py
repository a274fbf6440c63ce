"""The directive `computed`: commands that are run where the page is built, shown with what they print."""

from __future__ import annotations

import shlex
import tempfile
from pathlib import Path
from typing import Any

from docutils import nodes
from docutils.parsers.rst import directives
from shown import BAD_INPUT, files_of, not_said, run
from sphinx.util.docutils import SphinxDirective


class Computed(SphinxDirective):
    """Commands of zwidth with what they print.

    `:lines: 12` shows the first twelve lines of each, `:only: limit; required` the lines that begin so;
    `:says: ACTIVE; 500 Hz` is what the text relies on.
    """

    has_content = True
    option_spec = {  # noqa: RUF012
        "lines": directives.positive_int,
        "only": directives.unchanged,
        "says": directives.unchanged,
    }

    def run(self) -> list[nodes.Node]:
        """One block, as a terminal would show it."""
        page = Path(self.env.doc2path(self.env.docname)).read_text(encoding="utf-8")
        with tempfile.TemporaryDirectory() as scratch:
            for name, text in files_of(page).items():
                (Path(scratch) / name).write_text(text, encoding="utf-8")
            printed = [self._printed(line, Path(scratch)) for line in self.content]
        missing = not_said(self.options.get("says", ""), " ".join(printed))
        if missing:
            raise self.error(f"{' '.join(self.content)}: it does not say {missing}")
        shown = [f"{line}\n{self._cut(text)}" for line, text in zip(self.content, printed, strict=True)]
        block = nodes.literal_block("\n\n".join(shown), "\n\n".join(shown))
        block["language"] = "console"
        return [block]

    def _printed(self, line: str, folder: Path) -> str:
        words = shlex.split(line.removeprefix("$ "), comments=True)
        status, printed, said = run(words[1:], folder)
        if words[:1] != ["zwidth"] or status == BAD_INPUT:
            raise self.error(f"{line}: {said or 'no command of zwidth'}")
        return printed

    def _cut(self, printed: str) -> str:
        lines = printed.strip("\n").splitlines()
        if "only" in self.options:
            begin = tuple(part.strip() for part in self.options["only"].split(";"))
            return "\n".join(line for line in lines if line.strip().startswith(begin))
        kept = self.options.get("lines", len(lines))
        return "\n".join([*lines[:kept], *(["…"] if kept < len(lines) else [])])


def setup(app: Any) -> dict[str, bool]:
    """The directive `computed`."""
    app.add_directive("computed", Computed)
    return {"parallel_read_safe": False}
