"""What to type for a library that zwidth does without: where it runs, and whatever it was installed from.

pip keeps in direct_url.json (PEP 610) the folder, file, address or commit that a package came from.
"""

from __future__ import annotations

import json
import shutil
import sys
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from zwidth.errors import InputError
from zwidth.showing import typed


def needed(what: str, extra: str = "", *, package: str = "", otherwise: str = "") -> InputError:
    """The message that it is not installed, what to do without it, and the command of `line`."""
    way_out = f"{otherwise}, or type" if otherwise else "type"
    return InputError(f"{what} is not installed; {way_out}", line(extra, package))


def imported(module: str, what: str, extra: str, otherwise: str = "") -> Any:
    """A module that may be missing; what is said then, see `needed`."""
    try:
        return import_module(module)
    except ImportError:
        raise needed(what, extra, otherwise=otherwise) from None


def library(module: str, cannot: str) -> Any:
    """What reads the logs of others; `cannot` begins the message, as "a.parquet is not read: Parquet"."""
    return imported(module, f"{cannot} takes {module.partition('.')[0]}, which", "logs")


def parquet(cannot: str) -> Any:
    """What reads and writes Parquet."""
    return library("pyarrow.parquet", f"{cannot}: Parquet")


def line(extra: str = "", package: str = "") -> str:
    """``pip install "zwidth[extra]"`` as it works here; or of another package, which an index has."""
    return " ".join([_pip(), typed(*([package] if package else _zwidth(extra)))])


def _zwidth(extra: str) -> list[str]:
    from importlib.metadata import PackageNotFoundError, distribution
    from urllib.parse import urlsplit
    from urllib.request import url2pathname

    named, libraries = f"[{extra}]" if extra else "", list[str]()
    try:
        found = distribution("zwidth")
        marks = [f"extra == '{name}'" for name in extra.split(",")]
        libraries = [
            one.partition(";")[0] for one in found.requires or () if any(mark in one for mark in marks)
        ]
        told: dict[str, Any] = json.loads(found.read_text("direct_url.json") or "{}")
    except PackageNotFoundError:  # the source is on PYTHONPATH
        told = {"url": Path(__file__).resolve().parents[2].as_uri(), "dir_info": {}}
    url = told.get("url", "")
    path = Path(url2pathname(urlsplit(url).path))
    if url.startswith("file:") and not path.exists() and libraries:
        return libraries  # what it was installed from is gone
    if "dir_info" in told:
        place = "." if path.exists() and path.samefile(Path.cwd()) else str(path)
        return [*["-e"] * bool(told["dir_info"].get("editable")), place + named]
    if "vcs_info" in told:
        url = f"{told['vcs_info']['vcs']}+{url}@{told['vcs_info']['commit_id']}"
    if "subdirectory" in told:
        url += f"#subdirectory={told['subdirectory']}"
    return [f"zwidth{named} @ {url}" if url else f"zwidth{named}"]


def _pip() -> str:
    """``pip install`` for the Python that runs, by the shortest name that leads to it."""
    python, virtual = Path(sys.executable or "python"), sys.prefix != sys.base_prefix
    if find_spec("pip") is None and shutil.which("uv"):  # whose environments have none
        return f"uv pip install --python {_near(python)}"
    # outside of a virtual environment several Pythons share a folder, and a pip is that of one of them
    for name, call in (("pip", "pip"), ("python", "python -m pip"), ("python3", "python3 -m pip")):
        found = Path(shutil.which(name) or name)
        ours = found.is_absolute() and found.parent.samefile(python.parent)
        if ours and (virtual or (name != "pip" and found.samefile(python))):
            return f"{call} install"
    beside = shutil.which("pip", path=str(python.parent)) if virtual else None
    return f"{_near(Path(beside)) if beside else f'{_near(python)} -m pip'} install"


def _near(path: Path) -> str:
    """A path from the folder in which it will be typed, where it is below that."""
    return typed(str(path.relative_to(Path.cwd()) if path.is_relative_to(Path.cwd()) else path))
