"""The documentation: `sphinx-build -W docs docs/_build/html`; with `-t undrawn` no gallery script is run."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE / "_ext"))

import tables  # noqa: E402

from zwidth import __version__  # noqa: E402
from zwidth.quantity.answered import declared  # noqa: E402
from zwidth.quantity.text import unit_text  # noqa: E402

tables.write()  # before Sphinx looks for what the pages include

project = "zwidth"
author = "The zwidth developers"
copyright = "The zwidth developers, Apache-2.0"
release = version = __version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.mathjax",
    "sphinx.ext.napoleon",
    "sphinx_gallery.gen_gallery",
    "playpage",  # of _ext
    "sphinx-mathjax-offline",  # formulas are drawn without a network
    "computed",  # commands that are run where the page is built
    "names",  # the public names of a page
]
exclude_patterns = ["_build", "_generated", "gallery/GALLERY_HEADER.rst"]

myst_enable_extensions = ["amsmath", "colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3

autodoc_member_order = "bysource"
autodoc_preserve_defaults = True  # as they are written: a function has no other words
autodoc_typehints = "none"  # the docstrings say units, which types cannot
autoclass_content = "class"
napoleon_google_docstring = False
napoleon_use_ivar = True  # attributes are listed once, in the class docstring
napoleon_use_rtype = False
napoleon_attr_annotations = False

sphinx_gallery_conf = {
    "examples_dirs": "../examples",
    "gallery_dirs": "gallery",
    "filename_pattern": r"/plot_",
    "ignore_pattern": r"(^|[/\\])(?!plot_)[^/\\]*\.py$",
    "within_subsection_order": "FileNameSortKey",
    "download_all_examples": False,
    "show_memory": False,
    "plot_gallery": not tags.has("undrawn"),  # type: ignore[name-defined]  # noqa: F821
    "abort_on_example_error": True,
    "capture_repr": (),  # a page prints what its script prints
    "copyfile_regex": r".*\.toml",
}
suppress_warnings = ["config.cache"]  # sphinx-gallery's sort key cannot be pickled

html_theme = "furo"
html_title = f"zwidth {release}"
html_static_path = ["_static"]
html_css_files = ["tables.css"]
html_show_copyright = False
html_theme_options = {"navigation_with_keys": True}


def setup(app: Any) -> None:
    """Read the docstrings as they are written: before numpydoc sections are parsed."""
    app.connect("autodoc-process-docstring", _with_answers, priority=300)
    app.connect("autodoc-process-docstring", _as_written, priority=400)


def _with_answers(app: Any, what: str, name: str, thing: Any, options: Any, lines: list[str]) -> None:
    """A result says where its class has it what each of its fields is."""
    fields = getattr(thing, "__dataclass_fields__", {}) if what == "class" else {}
    told = {name: one for name, one in declared(thing).items() if name in fields} if fields else {}
    if told:
        lines += ["Parameters", "----------"]
    for key, one in told.items():
        units = dict.fromkeys(unit_text(one.unit_for(motion)) for motion in ("linear", "rotary"))
        unit = f" [{'; '.join(units)}]" if any(units) else ""
        lines += [key, f"    {one.meaning[0].upper()}{one.meaning[1:]}{unit}."]
    lines += [""] if told else []


def _as_written(app: Any, what: str, name: str, thing: Any, options: Any, lines: list[str]) -> None:
    """An indented block is a law, to be shown line by line; |x| is a magnitude."""
    written: list[str] = []
    margin, law = 0, False
    for line in lines:
        indent = len(line) - len(line.lstrip())
        if line.strip():
            if not law and indent >= 4 and margin == 0 and written and not written[-1].strip():
                written += ["::", ""]
                law = True
            law = law and indent >= 4
            margin = indent
        written.append(line if law else _with_magnitudes(line))
    lines[:] = written


def _with_magnitudes(line: str) -> str:
    parts = re.split(r"(`+[^`]*`+)", line)
    return "".join(p if p.startswith("`") else p.replace("|", "\\|") for p in parts)
