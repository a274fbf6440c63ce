"""The report as a page: one file, readable on a phone, in the dark and on paper, and nothing in it is obeyed.

Its policy allows no script and no address abroad; pictures and the proof stand within it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from hashlib import sha256
from importlib.metadata import version
from math import isfinite
from platform import python_version
from typing import Any

from zwidth import __version__
from zwidth.passivity.linear_verdict import LinearVerdict
from zwidth.passivity.result import Answer
from zwidth.passivity.verdict import Verdict
from zwidth.quantity.text import shown
from zwidth.show.report.contents import NAME, Contents, Section
from zwidth.showing import Html, Lines, Part, Picture, Table, data_uri, element, void

_POLICY = "default-src 'none'; img-src data:; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'"

_STYLE = """
:root { color-scheme: light dark; --text: #1b1b1b; --soft: #555; --line: #ccc; --ground: #fff;
  --link: #0b57a4 }
@media (prefers-color-scheme: dark) {
  :root { --text: #e8e8e8; --soft: #b3b3b3; --line: #555; --ground: #181a1b; --link: #8ab8f0 }
}
body { margin: 0 auto; padding: 1.5rem 1rem 3rem; max-width: 46rem; color: var(--text);
  background: var(--ground); font: 1rem/1.5 system-ui, sans-serif; overflow-wrap: break-word }
h1 { font-size: 1.4rem; line-height: 1.25; margin: 0 0 .8rem }
h2 { font-size: 1.1rem; margin: 2.2rem 0 .6rem; border-bottom: 1px solid var(--line); break-after: avoid }
.badge { display: inline-block; color: #fff; font-weight: 700; padding: .1rem .6rem; border-radius: .3rem;
  margin-right: .5rem; text-transform: uppercase; print-color-adjust: exact }
.claim { font-size: 1.1rem; margin: 0 }
.made { color: var(--soft); margin: 0 0 .3rem }
ul { padding-left: 1.2rem }
li { margin: .2rem 0 }
a { color: var(--link) }
table { border-collapse: collapse; width: 100%; margin: .6rem 0; font-variant-numeric: tabular-nums }
caption { text-align: left; color: var(--soft); padding-bottom: .2rem }
th, td { text-align: left; vertical-align: top; padding: .25rem .8rem .25rem 0;
  border-bottom: 1px solid var(--line) }
th { font-weight: 600 }
td:last-child { overflow-wrap: anywhere; padding-right: 0 }
tbody th { font-weight: 400; color: var(--soft) }
tr { break-inside: avoid }
figure { margin: 1rem 0; break-inside: avoid }
img { background: #fff; border-radius: .3rem }
figcaption { color: var(--soft); font-size: .92rem }
@media (max-width: 34rem) { table { font-size: .88rem } th, td { padding-right: .5rem } }
@page { margin: 16mm }
@media print {
  :root { --text: #000; --soft: #333; --line: #bbb; --ground: #fff; --link: #000 }
  table, li, p { break-inside: avoid }
  body { max-width: none; padding: 0; font-size: 10pt }
}
"""


def page(said: Contents) -> str:
    """The report as the text of an HTML file."""
    head = element(
        "head",
        void("meta", charset="utf-8"),
        void("meta", **{"http-equiv": "Content-Security-Policy", "content": _POLICY}),
        void("meta", name="viewport", content="width=device-width, initial-scale=1"),
        void("meta", name="generator", content="zwidth"),
        element("title", f"{said.verdict.word}: {said.title}"),
        element("style", _STYLE),
    )
    return f"<!doctype html>\n{element('html', head, element('body', _main(said)), lang='en')}\n"


def _main(said: Contents) -> Html:
    drawn = pictures(said.answer)
    style = f"background:{said.verdict.colour}"
    badge = element("strong", said.verdict.word, **{"class": "badge", "style": style})
    return element(
        "main",
        element("p", "Report of zwidth", **{"class": "made"}),
        element("h1", said.title),
        element("p", badge, said.verdict.claim, **{"class": "claim"}),
        *map(_section, said.before_pictures),
        *([_section(Section("Figures", drawn))] if drawn else []),
        *map(_section, said.after_pictures),
        _again(said),
    )


def _section(section: Section) -> Html:
    return element("section", element("h2", section.title), *map(_part, section.parts))


def _part(part: Part) -> Html:
    return element("p", part) if isinstance(part, str) else part.html


def _again(said: Contents) -> Html:
    address = data_uri(said.document, "application/json")
    link = element("p", element("a", f"Save {NAME}", href=address, download=NAME))
    told = map(_part, _how_to_check_again(said))
    return element("section", element("h2", "How to check it again"), link, *told)


# The pictures, with the defaults of matplotlib, whatever the settings of the person are: the same bytes.


_WIDTH = 6.0
_HEIGHTS = {"plane": 5.0, "motion": 5.0, "budget": 3.6}
"""Inches; the others are 3.8 high."""

_CAPTIONS = {
    "criterion": "The damping that the loop asks for, and what the device has. The loop is passive against "
    "every sustained motion where the curve stays at or below the line, up to half the sample rate.",
    "circle": "How far the loop lies from the middle of the circle that the criterion of motor, transmission "
    "and hand forbids, at every frequency up to half the sample rate. Passive at and above its radius.",
    "plane": "Where the loop lies: viscous friction against sampling, Coulomb friction against the encoder. "
    "Passive at and beyond ½ on both axes.",
    "budget": "What feeds energy in, against what the device takes out.",
    "motion": "The motion that takes energy out: position, held force and energy.",
    "storage": "The most energy that a hand can take out, from each position on.",
    "scene": "The scene that is rendered.",
}


def pictures(verdict: Answer) -> list[Picture]:
    """Every picture of a verdict; none where there is nothing to draw."""
    from matplotlib import style

    with style.context("default"):
        return list(_pictures(verdict))


def _pictures(verdict: Answer) -> Iterator[Picture]:
    from zwidth.show.plots.report import panel_figure, panels_of
    from zwidth.show.plots.style import encoded

    if isinstance(verdict, Verdict):
        for name, draw in panels_of(verdict).items():
            figure = panel_figure(draw, verdict, _WIDTH, _HEIGHTS.get(name, 3.8))
            yield Picture(encoded(figure, "svg"), "svg+xml", _SAYS[name](verdict), _CAPTIONS[name])
    elif verdict._PICTURE:
        yield Picture(encoded(verdict.figure(), "svg"), "svg+xml", verdict.describe())


def _criterion(verdict: LinearVerdict) -> str:
    unit = verdict.device.unit("damping")
    account = verdict.budget
    most = shown(account.required, unit, 4) if isfinite(account.required) else "any amount"
    return (
        f"Curve of required damping against frequency: highest at {shown(account.frequency, 'Hz')}, with "
        f"{most}; a line marks the device's {shown(account.damping, unit, 4)}."
    )


def _plane(verdict: LinearVerdict) -> str:
    from zwidth.passivity.formulas.diolaiti import plane_point

    stiffness = verdict.decision.loop.static_stiffness
    assert stiffness is not None
    point = plane_point(verdict.device, stiffness)
    return (
        f"Plane of viscous against Coulomb friction: the loop lies at {float(point.viscous):.4g} and "
        f"{float(point.dry):.4g}, in the region {point.region}."
    )


def _budget(verdict: LinearVerdict) -> str:
    unit = verdict.device.unit("damping")
    account = verdict.budget
    shares = {"the hold": account.hold, "the law": account.dynamics, "the delay": account.delay}
    asked = ", ".join(
        f"{name} {shown(value, unit, 4)}" for name, value in shares.items() if isfinite(value) and value
    )
    return f"Bars: asked for by {asked or 'nothing'}; the device has {shown(account.damping, unit, 4)}."


def _motion(verdict: Verdict) -> str:
    assert verdict.witness is not None
    return f"Position, force and energy against time: {verdict.witness.describe()}."


_SAYS: dict[str, Callable[[Any], str]] = {
    "criterion": _criterion,
    "circle": lambda verdict: (
        "Curve of the distance from the middle of the criterion's circle against frequency, in radii: a hand "
        f"gains where it is below 1. {verdict.claim}"
    ),
    "plane": _plane,
    "budget": _budget,
    "motion": _motion,
    "storage": lambda verdict: (
        "Curve of the available storage against position; it is finite and nowhere below 0."
    ),
    "scene": lambda verdict: f"Diagram of the {verdict.environment.describe(verdict.device.motion)}.",
}


def _how_to_check_again(said: Contents) -> list[Part]:
    steps = [
        f"{NAME} is in this page, behind the link above. It is the verdict with its evidence, every number "
        "digit for digit.",
        f"zwidth verify {NAME} re-proves it, by a checker that shares no code with what found the proof.",
    ]
    if said.command:
        steps.append(f"This report again, byte for byte with the same versions: {said.command}")
    rows = [
        (f"SHA-256 of {NAME}", sha256(said.document).hexdigest()),
        (f"bytes of {NAME}", str(len(said.document))),
        *_versions(),
    ]
    return [Lines(steps), Table(rows=rows)]


_LIBRARIES = ("matplotlib", "numpy", "python-flint", "scipy")


def _versions() -> list[tuple[str, str]]:
    """(name, version) of zwidth, Python and the libraries that had a part in it."""
    return [
        ("zwidth", __version__),
        ("Python", python_version()),
        *((name, version(name)) for name in _LIBRARIES),
    ]
