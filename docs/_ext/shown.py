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
from collections.abc import Iterator, Sequence
from contextlib import chdir, redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path

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
