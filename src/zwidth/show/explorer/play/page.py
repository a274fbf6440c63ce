"""The page, made of its parts: one text that asks nothing of a network or of other files."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from importlib.resources import files

from zwidth.errors import InputError
from zwidth.machine.firmware.plant import given_plant, plant_module, plant_program
from zwidth.show.explorer.play.played import Played
from zwidth.showing import element

_EXPORTED = re.compile(r"^export (?:const|function|class) (\w+)", re.MULTILINE)
_IMPORT = re.compile(r'^import (\{[^}]*\}) from "\./(\w+)\.mjs";$', re.MULTILINE)

MODULES = ("engine", "recording", "sound", "draw", "player", "view")
"""The page's own, each after those that it imports."""


def play_page(loops: Sequence[Played], *, title: str = "Play with a loop") -> str:
    """A page of HTML on which a person plays these loops; it works from a file, offline, and in a frame.

    Parameters
    ----------
    loops
        At least one; see `played` and `played_pair`.
    title
        Its heading.

    Raises
    ------
    InputError
        If there is no loop.
    """
    if not loops:
        raise InputError("a page plays one loop at least; got none")
    modules = [
        f"const plant = {_as_function(plant_text())};",
        f"const laws = [{', '.join(_as_function(loop.law) if loop.law else 'null' for loop in loops)}];",
        *(f"const {name} = {_as_function(_file(f'{name}.mjs'))};" for name in MODULES),
        'view.start(document.getElementById("play"), plant, laws);',
    ]
    facts = json.dumps([loop.facts() for loop in loops], ensure_ascii=False).replace("<", "\\u003c")
    parts = {
        "title": element("title", title),
        "heading": element("h1", title),
        "style": _file("play.css"),
        "facts": facts,
        "script": "\n".join(modules).replace("</", "<\\/").replace("<!--", "<\\!--"),
    }
    return re.sub(r"<!-- (\w+) -->", lambda found: parts[found[1]], _file("page.html"))


def plant_text() -> str:
    """The module that moves every device and hand: it is told their numbers, and how long."""
    return plant_module(plant_program(given_plant(amplified=False), None, "anchored"))


def _file(name: str) -> str:
    return files("zwidth.show.explorer.play").joinpath(name).read_text(encoding="utf-8")


def _as_function(module: str) -> str:
    """An ES module as an expression: what it exports, as one object; what it imports stands before it.

    A page that is a file, or a text in a frame, has no address from which a module could be imported.
    """
    names = ", ".join(_EXPORTED.findall(module))
    body = _IMPORT.sub(r"const \1 = \2;", module)
    return f"(() => {{\n{re.sub('^export ', '', body, flags=re.MULTILINE)}return {{ {names} }};\n}})()"
