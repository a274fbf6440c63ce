"""What a page shows: its files, its commands, and those that are run where the page is built.

A block of TOML that begins with `# my-wheel.toml` is a file of the page.  A block

    ```{computed}
    $ zwidth check my-wheel.toml
    ```

is run beside those files, and shown with what it prints: no output is typed by hand.  One that ends with bad
input is a mistake of the page.
"""

from __future__ import annotations

import os
import re
import shlex
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import chdir, redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path
from typing import Any

from docutils import nodes
from docutils.parsers.rst import directives
from sphinx.util.docutils import SphinxDirective

BAD_INPUT = 2


def files_of(page: str) -> dict[str, str]:
    """Name and text of every file that a page shows."""
    return {
        name: text for text, name in re.findall(r"^```toml\n(# ([\w.-]+\.toml)\n.*?)^```", page, re.M | re.S)
    }


def commands_of(page: str) -> Iterator[tuple[str, list[str]]]:
    """Every line that calls zwidth: as it stands, and the arguments of each call in it."""
    for language, block in re.findall(r"^```(console|\{computed\}|sh)\n(.*?)^```", page, re.M | re.S):
        for line in block.splitlines():
            typed = line.removeprefix("$ ")
            if language == "sh" or typed != line:
                for call in typed.split(" && "):
                    words = shlex.split(call, comments=True)
                    if words and words[0].split("/")[-1] == "zwidth":
                        yield typed, words[1:]


def run(arguments: Sequence[str], folder: Path) -> tuple[int, str, str]:
    """Exit status of zwidth in a folder, what it prints and what it says beside it, 80 columns wide."""
    from zwidth.cli.main import main

    printed, said = StringIO(), StringIO()
    kept = os.environ.get("COLUMNS")
    os.environ["COLUMNS"] = "80"
    try:
        with chdir(folder), redirect_stdout(printed), redirect_stderr(said):
            status = main(arguments)
    finally:
        os.environ.pop("COLUMNS") if kept is None else os.environ.update(COLUMNS=kept)
    return status, printed.getvalue(), said.getvalue()


def not_said(relied_on: str, printed: str) -> list[str]:
    """Of the parts between semicolons, those that are not printed; how lines are broken plays no part."""
    flat = " ".join(printed.split())
    parts = [" ".join(part.split()) for part in relied_on.split(";")]
    return [part for part in parts if part not in flat]


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
