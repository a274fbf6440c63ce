"""The command `examples`: the sample files with a command for each, listed or copied into a folder."""

from __future__ import annotations

import argparse
from pathlib import Path
from textwrap import fill, indent

from zwidth.cli.output import quiet_pipe
from zwidth.errors import InputError
from zwidth.model import samples
from zwidth.model.specification.table import plain
from zwidth.showing import typed
from zwidth.writing import check_target, writing_whole

OPTIONS = (
    {
        "folder=FOLDER?": "where to copy them to; made where it is missing",
        "--force": "replace files that exist",
    },
)


def run(arguments: argparse.Namespace) -> int:
    """`zwidth examples`: 0."""
    if arguments.folder is None:
        with quiet_pipe():
            print("\n\n".join(map(_told, samples.EXAMPLES)))
            print("\nCopy them into a folder:\n  zwidth examples FOLDER")
        return 0
    folder = Path(arguments.folder)
    copy_to(folder, arguments.force)
    with quiet_pipe():
        print(f"written: {len(samples.names())} files in {plain(str(folder), 100)}")
        print("next:" if folder == Path() else f"next:\n  cd {typed(str(folder))}")
        print(f"  {samples.EXAMPLES[0].command}")
    return 0


def copy_to(folder: Path, force: bool) -> None:
    """Copy every sample into a folder, all of them or none."""
    _make(folder)
    for name in samples.names():
        if (folder / name).exists():
            check_target(folder / name, force, "--force")
    for name in samples.names():
        _make((folder / name).parent, parents=True)
        with writing_whole(folder / name) as file:
            file.write(samples.path(name).read_bytes())


def _make(folder: Path, parents: bool = False) -> None:
    try:
        folder.mkdir(parents=parents, exist_ok=True)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise InputError(f"{plain(str(folder), 100)} is no folder and cannot be made one: {reason}") from None


def _told(example: samples.Example) -> str:
    files = fill(", ".join(example.files), 78, break_on_hyphens=False)
    return "\n".join([example.meaning, indent(f"{files}\n{example.command}", "  ")])
