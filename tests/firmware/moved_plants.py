"""Plants of every kind, what moves them, and how they are run in C and JavaScript."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from zwidth.loop.plant import STATE_SIZE, WORK, Plant
from zwidth.machine.firmware.c99 import C99, KEYWORDS
from zwidth.machine.firmware.header import AS_BEFORE, DOUBLE, UNCONTRACTED, rounded
from zwidth.machine.firmware.plant import Hand, laid_out
from zwidth.machine.firmware.program import Program

PERIOD = 0.001

PLANTS: dict[str, tuple[Plant, Hand]] = {
    "free": (Plant(0.05, 0.01, 0.1, 0.02, 0.03, 0.0, 0.0, 0.0, 0.0), "free"),
    "undamped": (Plant(0.05, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0), "free"),
    "heavy_damping": (Plant(0.002, 0.0, 5.0, 0.02, 0.02, 0.0, 0.0, 0.0, 0.0), "free"),
    "lagging": (Plant(0.05, 0.0, 0.1, 0.02, 0.03, 0.0, 0.0, 0.002, 0.0), "free"),
    "slewing": (Plant(0.05, 0.0, 0.1, 0.02, 0.03, 0.0, 0.0, 0.0, 200.0), "free"),
    "held": (Plant(0.05, 0.01, 0.1, 0.02, 0.03, 300.0, 1.0, 0.0, 0.0), "anchored"),
    "held_lagging": (Plant(0.05, 0.01, 0.1, 0.02, 0.03, 300.0, 1.0, 0.0005, 0.0), "anchored"),
    "damped_alone": (Plant(0.05, 0.01, 0.1, 0.02, 0.03, 0.0, 1.0, 0.0, 0.0), "anchored"),
}

Array = NDArray[np.float64]

CELLS = np.zeros(STATE_SIZE + WORK)
"""At rest at 0."""


def hand_and_law(hand: Hand, rows: int, seed: int) -> Array:
    """Forces that hold it, let it slide and turn it round; an anchor that rests and moves."""
    random = np.random.default_rng(seed)
    size = random.choice([0.0, 0.01, 0.1, 3.0], rows // 20 + 1).repeat(20)[:rows]
    force, push = (
        size * random.normal(size=rows),
        random.choice([0.0, 0.02, 0.5], rows) * random.normal(size=rows),
    )
    speed = random.choice([0.0, 0.0, 0.2, -0.2], rows // 40 + 1).repeat(40)[:rows]
    anchor = np.concatenate([[0.0], np.cumsum(speed * PERIOD)[:-1]])
    return np.stack([force, push] + ([anchor, speed] if hand == "anchored" else []), 1)


def plant_header(program: Program, name: str) -> str:
    """The C99 header of such a program: `plant_state`, `plant_init`, `plant_step`.

    `plant_step(&s, …)` takes what the program's parameters are called, in that order.
    """
    c = C99(program, KEYWORDS | {name}, prefix=name)
    body = c.lines()
    functions = c.function_lines()
    state, work, places, begin = laid_out(program)
    given = "".join(f", double {v.hint}" for v in program.parameters)
    upper = name.upper()
    lines = [
        f"#ifndef {upper}_H",
        f"#define {upper}_H",
        "",
        "#include <math.h>",
        "#include <stdint.h>",
        "",
        rounded("double"),
        DOUBLE,
        "",
        UNCONTRACTED,
        "",
        "/* what is where in state[] */",
        *(f"#define {upper}_{place} {k}  /* {meaning} */" for k, place, meaning in places),
        "",
        f"typedef struct {{ double state[{state}]; double work[{work}]; }} {name}_state;",
        "",
        *c.table_lines(),
        *c.helper_lines(),
        "",
        *functions,
        "/* At rest at this position, no force, no energy counted. */",
        f"static inline void {name}_init({name}_state *s, double position)",
        "{",
        f"    for (int k = 0; k < {state}; k += 1) {{ s->state[k] = 0.0; }}",
        f"    for (int k = 0; k < {work}; k += 1) {{ s->work[k] = 0.0; }}",
        *(f"    s->state[{upper}_{place}] = position;" for place in begin),
        "}",
        "",
        "/* One period under the law's force, which opposes penetration, and the hand's push. */",
        f"static inline void {name}_step({name}_state *s{given})",
        "{",
        *body,
        "}",
        "",
        AS_BEFORE,
        "",
        "#endif",
    ]
    return "\n".join(lines) + "\n"


def plant_in_c(program: Program, name: str) -> str:
    count = len(program.parameters)
    state, work = (cells.size for cells in program.cells)
    given = "".join(f", in[k * {count} + {i}]" for i in range(count))
    return f"""{plant_header(program, name)}
void {name}_rows(const double *in, int rows, double *cells, double *out)
{{
    {name}_state s;
    {name}_init(&s, 0.0);
    for (int k = 0; k < rows; k += 1) {{
        {name}_step(&s{given});
        for (int i = 0; i < {state}; i += 1) {{ out[k * {state} + i] = s.state[i]; }}
    }}
    for (int i = 0; i < {state}; i += 1) {{ cells[i] = s.state[i]; }}
    for (int i = 0; i < {work}; i += 1) {{ cells[{state} + i] = s.work[i]; }}
}}
"""


def plant_in_javascript(name: str) -> str:
    return f"""import * as of_{name} from "./{name}.mjs";
export const {name} = (() => {{
    const s = of_{name}.init(0);
    return (row, cells) => {{
        of_{name}.step(s, ...row);
        cells.set(s.state);
        cells.set(s.work, {STATE_SIZE});
        return s.state;
    }};
}})();
"""
