"""The loop to play with, under its tab: a page in a frame that may run scripts and nothing else."""

from __future__ import annotations

from typing import Any

import param

from zwidth.show.explorer import computing
from zwidth.show.explorer.form import Told, words
from zwidth.show.explorer.verdict_card import WAITING
from zwidth.show.explorer.view import Asked, View, said
from zwidth.show.explorer.working import Answer
from zwidth.showing import element

NAME = "Play"


class Frame(Told):
    """A page in a page, apart from it."""

    html = param.String(default="")

    _esm = """
export function render({ model }) {
  const frame = document.createElement("iframe");
  frame.title = "play with this loop";
  frame.setAttribute("sandbox", "allow-scripts allow-downloads");
  const draw = () => { frame.hidden = !model.html; frame.srcdoc = model.html; };
  model.on("html", draw);
  draw();
  return frame;
}
"""
    _stylesheets = [  # noqa: RUF012  # as Panel has it
        ":host { display: block; width: 100%; } iframe[hidden] { display: none; }"
        "iframe { border: 0; width: 100%; height: 60rem; border-radius: 6px; }"
    ]


def play_view(page: Asked) -> View:
    """The tab."""
    frame: Any = Frame(sizing_mode="stretch_width")
    caption = words(element("p"))

    def come(answer: Answer) -> None:
        frame.html = answer.value or ""
        said(caption, answer.message)

    def released() -> None:
        said(caption, WAITING)
        page.compute("play", computing.played_page, come)

    return View("play", NAME, [caption, frame], lambda: None, released)
