"""The command that a message says to type: for what zwidth came from, and for the Python that runs."""

from __future__ import annotations

import ast
import importlib.metadata
import json
import os
import re
import shlex
import sys
from pathlib import Path

import pytest

from zwidth import installing, showing

ROOT = Path(__file__).parent.parent


class _Installed:
    """A distribution whose metadata say where it came from."""

    requires = ("numpy>=2.0", "bokeh>=3.5; extra == 'serve'", "dask[distributed]>=2024; extra == 'maps'")

    def __init__(self, direct_url: object) -> None:
        self.direct_url = direct_url

    def read_text(self, name: str) -> str | None:
        assert name == "direct_url.json"
        return json.dumps(self.direct_url) if self.direct_url else None


@pytest.fixture
def typed(monkeypatch, tmp_path):
    """The words after `install` for a distribution from there."""

    def typed(direct_url: object, extra: str = "serve") -> list[str]:
        monkeypatch.setattr(importlib.metadata, "distribution", lambda name: _Installed(direct_url))
        return shlex.split(installing.line(extra).partition(" install ")[2])

    return typed


@pytest.mark.parametrize("editable", [False, True])
def test_from_a_checkout_it_is_that_folder(typed, tmp_path, monkeypatch, editable):
    checkout = tmp_path / "my walls"
    checkout.mkdir()
    told = {"url": checkout.as_uri(), "dir_info": {"editable": True} if editable else {}}
    option = ["-e"] if editable else []
    assert typed(told) == [*option, f"{checkout}[serve]"]
    assert typed(told, "") == [*option, str(checkout)]
    monkeypatch.chdir(checkout)
    assert typed(told) == [*option, ".[serve]"]


COMMIT = "9f3c" * 10


@pytest.mark.parametrize(
    ("told", "source"),
    [
        (None, ""),
        (
            {"url": "https://example.org/zwidth-0.1.0.tar.gz", "archive_info": {}},
            "https://example.org/zwidth-0.1.0.tar.gz",
        ),
        (
            {"url": "https://example.org/z.git", "vcs_info": {"vcs": "git", "commit_id": COMMIT}},
            f"git+https://example.org/z.git@{COMMIT}",
        ),
        (
            {
                "url": "ssh://git@example.org/all.git",
                "vcs_info": {"vcs": "git", "requested_revision": "main", "commit_id": COMMIT},
                "subdirectory": "haptics/zwidth",
            },
            f"git+ssh://git@example.org/all.git@{COMMIT}#subdirectory=haptics/zwidth",
        ),
    ],
    ids=["index", "archive", "commit", "folder of a commit"],
)
def test_from_elsewhere_it_is_that_address(typed, told, source):
    assert typed(told) == [f"zwidth[serve] @ {source}" if source else "zwidth[serve]"]


def test_from_a_file_it_is_that_file_and_where_it_is_gone_the_libraries(typed, tmp_path):
    wheel = tmp_path / "zwidth-0.1.0-py3-none-any.whl"
    told = {"url": wheel.as_uri(), "archive_info": {}}
    assert typed(told, "maps") == ["dask[distributed]>=2024"]
    assert typed(told, "serve,maps") == ["bokeh>=3.5", "dask[distributed]>=2024"]
    wheel.touch()
    assert typed(told, "maps") == [f"zwidth[maps] @ {wheel.as_uri()}"]


def test_without_a_distribution_it_is_the_checkout_that_runs(monkeypatch):
    def nothing(name: str) -> None:
        raise importlib.metadata.PackageNotFoundError(name)

    monkeypatch.setattr(importlib.metadata, "distribution", nothing)
    (source,) = shlex.split(installing.line("serve").partition(" install ")[2])
    folder = source.removesuffix("[serve]")
    assert (Path(folder) / "src" / "zwidth" / "installing.py").samefile(installing.__file__)


def _python(folder: Path, *names: str) -> Path:
    """A folder in which programs of these names lie; the first is the Python that runs."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in names:
        (folder / name).touch(mode=0o755)
    return folder / names[0]


@pytest.mark.parametrize(
    ("programs", "on_path", "virtual", "call"),
    [
        (("python", "pip"), True, True, "pip install"),
        (("python3", "pip"), True, False, "python3 -m pip install"),  # a pip of any of those in the folder
        (("python3",), True, True, "python3 -m pip install"),
        (("python", "pip"), False, True, ".venv/bin/pip install"),
        (("python",), False, True, ".venv/bin/python -m pip install"),
        (("python3.12", "pip"), False, False, ".venv/bin/python3.12 -m pip install"),
    ],
)
@pytest.mark.skipif(os.name == "nt", reason="programs have other names")
def test_it_is_the_pip_of_the_python_that_runs(monkeypatch, tmp_path, programs, on_path, virtual, call):
    """And not one that happens to be first on the path."""
    other = _python(tmp_path / "other", "python", "python3", "pip").parent
    python = _python(tmp_path / ".venv" / "bin", *programs)
    first = python.parent if on_path else other
    monkeypatch.setenv("PATH", os.pathsep.join([str(first), str(other)]))
    monkeypatch.setattr(sys, "executable", str(python))
    monkeypatch.setattr(sys, "base_prefix", sys.prefix if not virtual else "/usr")
    monkeypatch.setattr(sys, "prefix", sys.base_prefix if not virtual else str(tmp_path / ".venv"))
    monkeypatch.setattr(installing, "find_spec", lambda name: True)
    monkeypatch.chdir(tmp_path)
    assert installing.line(package="jupyterlab") == f"{call} jupyterlab"
    monkeypatch.chdir(other)
    if not on_path:
        assert installing.line(package="jupyterlab").startswith(str(python.parent))


@pytest.mark.skipif(os.name == "nt", reason="programs have other names")
def test_where_uv_made_the_environment_it_is_uv(monkeypatch, tmp_path):
    """It puts no pip into one."""
    _python(tmp_path / "bin", "uv")
    monkeypatch.setenv("PATH", str(tmp_path / "bin"))
    monkeypatch.setattr(sys, "executable", str(_python(tmp_path / "my env", "python")))
    monkeypatch.setattr(installing, "find_spec", lambda name: None)
    monkeypatch.chdir(tmp_path)
    assert installing.line(package="jupyterlab") == 'uv pip install --python "my env/python" jupyterlab'


def test_on_windows_it_is_quoted_as_its_shells_want_it(monkeypatch):
    monkeypatch.setattr(showing, "_WINDOWS", True)
    assert showing.typed(r"C:\walls[serve]", "--rate", "2 kHz") == r'"C:\walls[serve]" --rate "2 kHz"'
    assert showing.typed(r".venv\Scripts\pip.exe") == r".venv\Scripts\pip.exe"


def test_elsewhere_a_shell_gets_the_same_words(monkeypatch):
    """In the quotes of Windows too, but where a shell would read more into them."""
    monkeypatch.setattr(showing, "_WINDOWS", False)
    words = ["my walls/a.toml", "delay=0:5 ms:20", "a$b", 'say "on"', "it's", r"a\b", "", "-o", "x.json"]
    assert shlex.split(showing.typed(*words)) == words
    assert showing.typed(*words[:2]) == '"my walls/a.toml" "delay=0:5 ms:20"'


def test_every_command_that_is_shown_is_quoted_so_that_windows_takes_it():
    """Its cmd.exe hands single quotes on: in help, messages, the README, the docs and the examples."""
    command = r"(?:zwidth [a-z]+|pip install) [^\n\"`]*|--[a-z-]+[ =](?:[a-z]+=)?"
    single = re.compile(rf"(?:{command})(?<!\w)'[^\n']*'")
    pages = [*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")]
    texts = [page.read_text(encoding="utf-8") for page in pages]
    for path in [*(ROOT / "src").rglob("*.py"), *(ROOT / "examples").rglob("*.py")]:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.JoinedStr):
                texts.append("".join(str(getattr(part, "value", "x")) for part in node.values))
            elif isinstance(node, ast.Constant):
                texts.append(str(node.value))
    assert [line for text in texts for line in single.findall(text)] == []


def test_no_message_has_a_command_of_its_own():
    """Whoever adds a library that may be missing asks here what to type."""
    own = re.compile(r"zwidth\[|pip install")
    files = [*(ROOT / "src").rglob("*.py")]
    found = {path.name for path in files if own.search(path.read_text(encoding="utf-8"))}
    assert found == {"installing.py"}


def test_every_extra_that_is_asked_for_exists():
    import tomllib

    asked = re.compile(r'(?:needed|imported)\(.*, "(\w+)"')
    files = [*(ROOT / "src").rglob("*.py")]
    extras = {extra for path in files for extra in asked.findall(path.read_text(encoding="utf-8"))}
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert extras
    assert extras <= {*project["optional-dependencies"]} - {"test", "docs"}
