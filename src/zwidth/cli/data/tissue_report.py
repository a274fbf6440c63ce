"""A tissue as a report in the terminal: its numbers, the wall, what is not known, what was odd."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from zwidth.cli.data.results import FittedTissue, OnDevice
from zwidth.cli.page import Row, blocks, headline, items, more_with_all, page, section, small_print
from zwidth.data.logs import Finding
from zwidth.data.tissue import TissueTest
from zwidth.passivity.bracket import Bracket
from zwidth.passivity.scope import TOLD
from zwidth.passivity.wording import in_short
from zwidth.quantity.text import shown

_FEW = 4
"""Findings in a short report."""

_MOST_TRIALS = 8
"""Of a file, in a short report."""

_FIRST = ("loaded", "hole", "other table", "surface", "sign", "unit", "sheet")
"""Kinds of findings that a short report has before others."""


_SPOKEN = {
    "kelvin-voigt": "Kelvin–Voigt solid",
    "maxwell": "Maxwell body",
    "standard-linear-solid": "standard linear solid",
    "generalized-maxwell-2": "generalized Maxwell solid with 2 branches",
    "generalized-maxwell-3": "generalized Maxwell solid with 3 branches",
    "hunt-crossley": "Hunt–Crossley contact",
}


def print_tissue(found: FittedTissue, in_full: bool = False) -> None:
    test = found.test
    with page() as out:
        out.print(_headline(test))
        section(out, "the tissue", [_columns(test.parameters())])
        if test.trials:
            section(out, f"{len(test.trials)} trials, each by itself", [_columns(_of_trials(test, in_full))])
        section(out, "what to doubt", items(test.doubts))
        rows = [*_wall(found.wall), *([] if in_full else [("models", _models(test))])]
        blocks(out, rows)
        section(out, "what the file shows", items(_findings(test, in_full)))
        if in_full:
            section(out, "models, the smallest AICc first", [_columns(test.table())])
            section(out, "assumes", items(_assumed(test), "dim"))
            return
        more_with_all(out, "every model, what the file shows, what the intervals assume")


def _of_trials(test: TissueTest, in_full: bool) -> list[list[str]]:
    """Every trial; in short the first of many, and the mean of all."""
    lines = test.of_trials()
    if in_full or len(lines) <= _MOST_TRIALS + 2:
        return lines
    left = len(lines) - _MOST_TRIALS - 2
    return [*lines[: _MOST_TRIALS + 1], [f"{left} more with --all", *[""] * (len(lines[0]) - 1)], lines[-1]]


def _findings(test: TissueTest, in_full: bool) -> list[Finding]:
    """What was odd in the file; in short what changes the answer."""
    odd = list(test.best.findings)
    if in_full:
        return odd
    return sorted(odd, key=lambda one: one.kind not in _FIRST)[:_FEW]


def _headline(test: TissueTest) -> Padding:
    badge, colour = "FITTED", "green"
    if not test.is_noise:
        badge, colour = "NO MODEL FITS", "yellow"
    elif test.as_good:
        badge, colour = "NOT TOLD APART", "yellow"
    return headline(badge, colour, _claim(test))


def _claim(test: TissueTest) -> str:
    name = _SPOKEN[test.names[test.chosen]]
    kind = f"A {test.test.kind} test"
    if test.trials:
        kind += f" (trial {test.number} of {len(test.trials)}; --trial N for another)"
    if test.seen_as != test.test.kind:
        kind += f" as you say (the data look like {test.seen_as})"
    if not test.is_noise:
        return f"{kind}. A {name} comes nearest, and leaves more than noise."
    if test.as_good:
        others = " or a ".join(_SPOKEN[name] for name in test.rivals)
        return f"{kind} of a {name}, or of a {others}: this test cannot tell."
    return f"{kind} of a {name}: {test.spoken()}."


def _columns(lines: Sequence[Sequence[str]]) -> Table:
    table = Table(box=None, padding=(0, 2, 0, 0), header_style="dim", pad_edge=False)
    for heading in lines[0]:
        table.add_column(heading)
    for name, *cells in lines[1:]:
        table.add_row(Text(name.replace("_", " "), style="dim"), *cells)
    return table


def _models(test: TissueTest) -> str:
    others = [
        f"{name} {above - test.criteria[test.chosen]:+.3g}"
        for k, (name, above) in enumerate(zip(test.names, test.criteria, strict=True))
        if k != test.chosen
    ]
    return f"AICc of the others: {', '.join(others)}" if others else "no other was fitted"


def _wall(wall: OnDevice | None) -> Iterator[Row]:
    if wall is None:
        return
    outcome = wall.verdict.outcome
    yield f"on {wall.device.name}", Text(f"{outcome}: {wall.verdict.claim}", style=TOLD[outcome].terminal)
    if wall.ranges is not None:
        yield from ((name, text) for name, text in wall.ranges.rows() if name != "stiffness")
    yield "scale", wall.reason if wall.bracket is None else _scale(wall, wall.bracket)
    if wall.box is None:
        yield "intervals", "not checked: see what to doubt, or the model takes none"
    else:
        yield "intervals", f"of all that the 95 % intervals allow together: {wall.box.outcome}"
    yield "assumes", small_print(in_short(wall.verdict.scope, outcome))


def _scale(wall: OnDevice, bracket: Bracket) -> str:
    proved = []
    for one in filter(None, (bracket, wall.kept)):
        if (most := one.outward((one.proved_passive, None), 4)[0]) is not None:
            proved.append(f"up to {most:.4g} times this tissue is proved passive{wall.of_which(one)}")
    active = bracket.outward((None, bracket.proved_active), 4)[1]
    if not proved and active is None:
        return "neither a proof nor a motion was found for any scale of this tissue"
    told = "; ".join(proved) or "no scale is proved passive"
    return told if active is None else f"{told}; at {active:.4g} times a hand takes energy out"


def _assumed(test: TissueTest) -> Iterator[str]:
    response = "depth" if test.test.kind == "creep" else "force"
    given = "force" if test.test.kind == "creep" else "depth"
    memory = test.tried[test.chosen].found.noise.memory
    noise = f"with a memory of {shown(memory, 's', 2)}" if memory else "white"
    yield f"the model is right, the noise is on the {response}, {noise}, and none on the {given}"
    yield "at rest before the first sample; from sample to sample a smooth or a monotone curve"
    yield (
        "taken is the model of fewest numbers whose AICc, with the noise's memory in the likelihood, is "
        "within 6 of the smallest"
    )
