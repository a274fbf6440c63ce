"""A law as one C99 header: `init`, `step`, `reset`."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from zwidth.firmware.c99 import C99, KEYWORDS, Real, real_text
from zwidth.firmware.law import LawProgram
from zwidth.firmware.program import Load, Operation, Store

_GUARD = """\
#if defined(__FAST_MATH__)
#error "compile without -ffast-math: it changes the law that was proved"
#endif
#if defined(__FLT_EVAL_METHOD__) && __FLT_EVAL_METHOD__ != 0
#error "numbers are kept with more digits than they have: compile with -msse2 -mfpmath=sse"
#endif"""

_DOUBLE = """\
#if __SIZEOF_DOUBLE__ != 8
#error "double has no 64 bits here: emit the law in float or in fixed point"
#endif"""

_UNCONTRACTED = """\
/* a product and a sum stay two operations with two roundings; gcc 12 joins them in vectors all the same */
#if defined(__clang__)
#pragma STDC FP_CONTRACT OFF
#elif defined(__GNUC__)
#pragma GCC push_options
#pragma GCC optimize("fp-contract=off", "no-tree-slp-vectorize")
#endif"""

_AS_BEFORE = """\
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC pop_options
#endif"""


def header(
    law: LawProgram, *, name: str, real: Real, about: Sequence[str], numbers: Iterable[tuple[str, str, str]]
) -> str:
    """The text of the header in double or float.

    Parameters
    ----------
    law
        What is written.
    name
        What every name begins with.
    real
        The type of its numbers.
    about
        Lines of the comment at its head.
    numbers
        Name, value and meaning of each `#define`.
    """
    c = C99(law.program, KEYWORDS | {name}, real=real, prefix=name)
    body = [*c.changing(), *_lines(c, 1)]
    result = c.read(law.program.results[0], alone=True)
    upper = name.upper()
    given = "int32_t counts" if law.resolution > 0 else f"{real} position"
    seen = given.split()[1]
    uses_library = any(isinstance(s, Operation) and s.operator in _OF_MATH for s in law.program.statements())
    stored = any(isinstance(s, Load | Store) and not hasattr(s, "values") for s in law.program.statements())
    lines = [
        "/*",
        *(f" * {line}".rstrip() for line in about),
        " */",
        f"#ifndef {upper}_H",
        f"#define {upper}_H",
        "",
        *(["#include <math.h>"] if uses_library else []),
        "#include <stdint.h>",
        "",
        _GUARD,
        *([_DOUBLE] if real == "double" else []),
        "",
        *(f"#define {upper}_{key} {value}  /* {meaning} */" for key, value, meaning in numbers),
        "",
        _UNCONTRACTED,
        "",
        f"typedef {real} {name}_force;  /* N, or N*m; out of a wall is positive */",
        "",
        "typedef struct {",
        f"    {real} memory[{max(law.rest.shape[1], 1)}];",
        f"    {given};  /* seen last */",
        f"}} {name}_state;",
        "",
        *c.table_lines(),
        *c.helper_lines(),
        "",
        f"/* At rest at this {seen}, as if it had been there for ever. */",
        f"static inline void {name}_init({name}_state *s, {given})",
        "{",
        *_rest(law, real, seen),
        f"    s->{seen} = {seen};",
        "}",
        "",
        "/* One sample: the force to be given from now on. */",
        f"static inline {name}_force {name}_step({name}_state *s, {given})",
        "{",
        *([] if stored else ["    /* it remembers nothing */"]),
        f"    s->{seen} = {seen};",
        *body,
        f"    return {result};",
        "}",
        "",
        "/* Forget what was, at rest where the handle was seen last. */",
        f"static inline void {name}_reset({name}_state *s)",
        "{",
        f"    {name}_init(s, s->{seen});",
        "}",
        "",
        _AS_BEFORE,
        "",
        "#endif",
    ]
    return "\n".join(lines) + "\n"


_OF_MATH = {"abs", "floor", "ceil", "sqrt"}


def _lines(c: C99, depth: int) -> list[str]:
    return c.block(c.program.body, depth)


def _rest(law: LawProgram, real: Real, seen: str) -> list[str]:
    """What it remembers at rest, place by place."""
    at, slope = law.rest
    x = f"(({real}){seen} * {real_text(law.resolution, real)})" if law.resolution > 0 else seen
    lines = []
    for k, (start, per) in enumerate(zip(at, slope, strict=True)):
        value = real_text(float(start), real)
        if per != 0.0:
            value = f"{value} + {real_text(float(per), real)} * {x}"
        lines.append(f"    s->memory[{k}] = {value};")
    return lines or ["    s->memory[0] = 0;"]
