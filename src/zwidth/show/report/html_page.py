"""The report as a page: one file, readable on a phone, in the dark and on paper, and nothing in it is obeyed.

Its policy allows no script and no address abroad; pictures and the proof stand within it.
"""

from __future__ import annotations

from zwidth.show.report.again import how_to_check_again
from zwidth.show.report.contents import Contents, Section
from zwidth.show.report.figures import pictures
from zwidth.show.report.proof import NAME
from zwidth.showing import Headline, Html, Part, data_uri, element, void

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
@media print {
  :root { --text: #000; --soft: #333; --line: #bbb; --ground: #fff; --link: #000 }
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
    return element(
        "main",
        element("p", "Report of zwidth", **{"class": "made"}),
        element("h1", said.title),
        _verdict(said.verdict),
        *map(_section, said.before_pictures),
        *([_section(Section("Figures", drawn))] if drawn else []),
        *map(_section, said.after_pictures),
        _again(said),
    )


def _verdict(verdict: Headline) -> Html:
    badge = element("strong", verdict.word, **{"class": "badge", "style": f"background:{verdict.colour}"})
    return element("p", badge, verdict.claim, **{"class": "claim"})


def _section(section: Section) -> Html:
    return element("section", element("h2", section.title), *map(_part, section.parts))


def _part(part: Part) -> Html:
    return element("p", part) if isinstance(part, str) else part.html


def _again(said: Contents) -> Html:
    address = data_uri(said.document, "application/json")
    link = element("p", element("a", f"Save {NAME}", href=address, download=NAME))
    parts = how_to_check_again(said, f"{NAME} is in this page, behind the link above.")
    return element("section", element("h2", "How to check it again"), link, *map(_part, parts))
