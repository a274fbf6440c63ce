"""A law as one ES module in JavaScript: `init`, `step`, `reset`."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from zwidth.machine.firmware.c99 import real_text
from zwidth.machine.firmware.javascript import KEYWORDS, JavaScript
from zwidth.machine.firmware.law import LawProgram
from zwidth.machine.firmware.printer import comment

_NEAREST = "    {seen} = Math.min(Math.max({seen}, {upper}_MIN), {upper}_MAX);"


def module(
    law: LawProgram,
    *,
    about: Sequence[str],
    numbers: Iterable[tuple[str, str, str]],
    cuts_readings: bool = False,
) -> str:
    """The text of the module.

    Parameters
    ----------
    law
        What is written.
    about
        Lines of the comment at its head.
    numbers
        Name, value and meaning of each constant that is exported.
    cuts_readings
        True where a reading beyond those that `numbers` names is taken as the nearest of them.
    """
    js = JavaScript(law.program, KEYWORDS)
    seen = "counts" if law.resolution > 0 else "position"
    near = [_NEAREST.format(seen=seen, upper=seen.upper())] if cuts_readings else []
    body = js.lines()
    result = js.read(law.program.results[0], alone=True)
    lines = [
        *comment(about),
        *(f"export const {key} = {value}; // {meaning}" for key, value, meaning in numbers),
        "",
        *js.table_lines(),
        *js.helper_lines(),
        "",
        f"/* What the law remembers, at rest at this {seen}, as if it had been there for ever. */",
        f"export function init({seen}) {{",
        f"    const s = {{ memory: new Float64Array({max(law.remembers, 1)}), {seen} }};",
        f"    reset(s, {seen});",
        "    return s;",
        "}",
        "",
        "/* One sample: the force to be given from now on [N; N*m], out of a wall is positive. */",
        f"export function step(s, {seen}) {{",
        *near,
        f"    s.{seen} = {seen};",
        *body,
        f"    return {result};",
        "}",
        "",
        "/* Forget what was, at rest where the handle was seen last. */",
        f"export function reset(s, {seen} = s.{seen}) {{",
        *near,
        *_rest(law, seen),
        f"    s.{seen} = {seen};",
        "}",
    ]
    return "\n".join(lines) + "\n"


def _rest(law: LawProgram, seen: str) -> list[str]:
    x = f"({seen} * {real_text(law.resolution, 'double')})" if law.resolution > 0 else seen

    def line(place: int, inside: bool) -> str:
        at, per = law.line(place, inside)
        return real_text(at, "double") + (f" + {real_text(per, 'double')} * {x}" if per != 0.0 else "")

    return [f"    s.memory[{k}] = {value};" for k, value in enumerate(law.rest_texts(seen, line))]
