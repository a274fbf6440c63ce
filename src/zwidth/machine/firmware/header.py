"""A law as one C99 header: `init`, `step`, `reset`."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from zwidth.machine.firmware.c99 import C99, KEYWORDS, NARROW, SHIFTS, FixedC99, Real, rest_lines
from zwidth.machine.firmware.machine import Machine, rest_numbers
from zwidth.machine.firmware.printer import comment
from zwidth.machine.firmware.program import Operation
from zwidth.machine.firmware.simplified import tidied

_ROUNDED = """\
#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) \\
    || defined(__NO_SIGNED_ZEROS__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__)
#error "compile without -ffast-math and what is part of it: it changes the law that was proved"
#endif
/* 16, 0, 32{also}: only what is narrower than binary16, float, float{too} is computed with more digits */
#if defined(__FLT_EVAL_METHOD__) && {refused}
#error "numbers are kept with more digits than they have: compile with -msse2 -mfpmath=sse"
#endif"""


def rounded(real: Real) -> str:
    """Refuses a compiler that computes a float or a double with other digits than its own.

    FLT_EVAL_METHOD (C11 5.2.4.2.2; 16, 32 and 64 by ISO/IEC TS 18661-3 and C23; gcc gives 16 to processors
    that compute in binary16) names the type up to which narrower ones are widened: none that a law has for 0,
    16 and 32; float to double for 1 and 64, which leaves a law in doubles as it is.  2 and 128 widen a double
    too, 33 and 65 leave to the processor how far, and below 0 nobody knows.  Whole numbers ask nothing of it.
    """
    kept = (0, 16, 32) if real == "float" else (0, 1, 16, 32, 64)
    also, too = (", 1, 64", ", double, double") if real == "double" else ("", "")
    refused = " && ".join(f"__FLT_EVAL_METHOD__ != {method}" for method in kept)
    return _ROUNDED.format(also=also, too=too, refused=refused)


DOUBLE = """\
#if __SIZEOF_DOUBLE__ != 8
#error "double has no 64 bits here: emit the law in float or in fixed point"
#endif"""

UNCONTRACTED = """\
/* a product and a sum stay two operations with two roundings; gcc 12 joins them in vectors all the same */
#if defined(__clang__)
#pragma STDC FP_CONTRACT OFF
#elif defined(__GNUC__)
#pragma GCC push_options
#pragma GCC optimize("fp-contract=off", "no-tree-slp-vectorize")
#endif"""

AS_BEFORE = """\
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC pop_options
#endif"""


_OF_MATH = {"abs", "floor", "ceil", "sqrt"}


@dataclass(frozen=True)
class _Body:
    """What differs between kinds of numbers."""

    guards: list[str]
    includes: list[str]
    force: str
    given: str
    memory: str
    before: list[str]
    rest: list[str]
    step: list[str]
    result: str


def header(
    machine: Machine, *, name: str, about: Sequence[str], numbers: Iterable[tuple[str, str, str]]
) -> str:
    """The text of the header, whose names all begin with `name`.

    `about` are the lines at its head, `numbers` name, value and meaning of each ``#define``.
    """
    body = _binary(machine, name) if machine.fixed is None else _whole(machine, name)
    upper, seen = name.upper(), body.given.split()[1]
    near = _nearest(machine, name, seen)
    lines = [
        *comment(about),
        f"#ifndef {upper}_H",
        f"#define {upper}_H",
        "",
        *body.includes,
        "",
        *body.guards,
        "",
        *(f"#define {upper}_{key} {value}  /* {meaning} */" for key, value, meaning in numbers),
        "",
        *([UNCONTRACTED, ""] if machine.fixed is None else []),
        f"typedef {body.force} {name}_force;  /* {upper}_FORCE_PER_UNIT each; out of a wall is positive */",
        "",
        "typedef struct {",
        f"    {body.memory} memory[{max(machine.law.remembers, 1)}];",
        f"    {body.given};  /* seen last */",
        f"}} {name}_state;",
        "",
        *body.before,
        "",
        "/* At rest at this position, as if it had been there for ever. */",
        f"static inline void {name}_init({name}_state *s, {body.given})",
        "{",
        *near,
        *body.rest,
        f"    s->{seen} = {seen};",
        "}",
        "",
        "/* One sample: the force to be given from now on. */",
        f"static inline {name}_force {name}_step({name}_state *s, {body.given})",
        "{",
        *near,
        f"    s->{seen} = {seen};",
        *body.step,
        f"    return {body.result};",
        "}",
        "",
        "/* Forget what was, at rest where the handle was seen last. */",
        f"static inline void {name}_reset({name}_state *s)",
        "{",
        f"    {name}_init(s, s->{seen});",
        "}",
        "",
        *([AS_BEFORE, ""] if machine.fixed is None else []),
        "#endif",
    ]
    return "\n".join(lines) + "\n"


def _nearest(machine: Machine, name: str, seen: str) -> list[str]:
    """A reading outside of what is claimed is taken as the nearest inside."""
    if not machine.cuts_readings:
        return []
    low, high = (f"{name.upper()}_{seen.upper()}_{end}" for end in ("MIN", "MAX"))
    if _is_short(machine):  # what is computed of 16 bits is quick where the compiler sees that it has no more
        return [
            f"    const int16_t {_READING} =",
            f"        {seen} < {low} ? {low} : {seen} > {high} ? {high} : (int16_t){seen};",
            f"    {seen} = {_READING};",
        ]
    return [f"    {seen} = {seen} < {low} ? {low} : {seen} > {high} ? {high} : {seen};"]


def _is_short(machine: Machine) -> bool:
    """Whether whole numbers are computed of readings of 16 bits."""
    return machine.fixed is not None and max(map(abs, machine.counts)) <= NARROW


_READING = "reading"


def _binary(machine: Machine, name: str) -> _Body:
    """In double or float."""
    law = machine.law
    real: Real = "float" if machine.number == "float" else "double"
    c = C99(law.program, KEYWORDS | {name}, real=real, prefix=name)
    step = c.lines()
    result = c.read(law.program.results[0], alone=True)
    seen = "counts" if law.resolution > 0 else "position"
    given = f"int32_t {seen}" if law.resolution > 0 else f"{real} {seen}"
    library = any(isinstance(s, Operation) and s.operator in _OF_MATH for s in law.program.statements())
    return _Body(
        guards=[rounded(real), *([DOUBLE] if real == "double" else [])],
        includes=[*(["#include <math.h>"] if library else []), "#include <stdint.h>"],
        force=real,
        given=given,
        memory=real,
        before=[*c.table_lines(), *c.helper_lines()],
        rest=rest_lines(law, real, seen, f"({real}){seen}", "s->memory"),
        step=step,
        result=result,
    )


def _whole(machine: Machine, name: str) -> _Body:
    """In whole numbers."""
    fixed = machine.fixed
    assert fixed is not None, "asked of fixed point"
    word = fixed.units.scale.word
    program = tidied(fixed.program)
    short = _READING if _is_short(machine) else ""
    c = FixedC99(
        program, KEYWORDS | {name, _READING}, prefix=name, word=word, narrow=fixed.narrow, short=short
    )
    step = c.lines()
    result = c.read(program.results[0], alone=True)

    def line(place: int, inside: bool) -> str:
        start, per, shift = rest_numbers(machine.law, fixed, place, inside)
        value = c.constant_text(start)
        if per:
            wide = "int64_t" if word == 64 or shift else c.integer
            moved = f"({wide})counts * {c.constant_text(per)}"
            moved = f"({moved} >> {shift})" if shift else moved
            value = f"{value} + {moved}" if start else moved
            value = f"({c.integer}){value}" if shift and not start else f"({c.integer})({value})"
        return value

    rest = enumerate(machine.law.rest_texts("counts", line))
    return _Body(
        guards=[SHIFTS],
        includes=["#include <stdint.h>"],
        force="int32_t",
        given="int32_t counts",
        memory=c.integer,
        before=c.helper_lines(),
        rest=[f"    s->memory[{k}] = {value};" for k, value in rest],
        step=step,
        result=f"(int32_t)({result})" if word == 64 else result,
    )
