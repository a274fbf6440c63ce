"""Programs in C, compiled by the machine's compiler, and in JavaScript, run by node.

Each program is given its inputs row by row and keeps its cells from row to row; all it gave back, and what
its cells hold at the end, comes back as the bits of doubles.
"""

from __future__ import annotations

import ctypes
import json
import os
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from firmware.emulated.built import called
from firmware.emulated.required import tool
from numpy.typing import NDArray

from zwidth.machine.firmware.c99 import C99
from zwidth.machine.firmware.c99 import KEYWORDS as OF_C
from zwidth.machine.firmware.header import header
from zwidth.machine.firmware.javascript import KEYWORDS as OF_JAVASCRIPT
from zwidth.machine.firmware.javascript import JavaScript
from zwidth.machine.firmware.law import LawProgram
from zwidth.machine.firmware.machine import Machine
from zwidth.machine.firmware.program import Program

Array = NDArray[np.float64]


class Ran(NamedTuple):
    """What came back: a row for each row of the inputs; the cells, one after the other."""

    outputs: Array
    cells: Array


def understood(compiler: str, *options: str) -> None:
    """Skips the test where the compiler refuses the options for an empty file: of another processor, say."""
    command = [tool(compiler), *" ".join(options).split(), "-fsyntax-only", "-x", "c", os.devnull]
    if options and subprocess.run(command, capture_output=True, check=False).returncode != 0:
        pytest.skip(f"{compiler} on this machine does not take {' '.join(options)}")


def same_bits(one: Array, other: Array) -> bool:
    """Equal to the last bit, the sign of 0 with it; any NaN is NaN."""
    a, b = np.ascontiguousarray(one), np.ascontiguousarray(other)
    both = np.isnan(a) & np.isnan(b)
    return a.shape == b.shape and bool((both | (a.view(np.int64) == b.view(np.int64))).all())


def differing(known: Mapping[str, Any], ran: Mapping[str, Ran]) -> list[str]:
    pairs = {name: zip(one.ran, ran[name], strict=True) for name, one in known.items()}
    return [name for name, parts in pairs.items() if not all(same_bits(a, b) for a, b in parts)]


_ALLOWED = ("unused-function", "unused-but-set-variable", "tautological-compare")
"""Random functions compare x with x, and forget what they have computed."""


def compiled_c(text: str, folder: Path, options: Sequence[str] = ("-std=c99", "-O2")) -> ctypes.CDLL:
    source, library = folder / "emitted.c", folder / f"emitted{''.join(options)}.so".replace("=", "")
    source.write_text(text, encoding="utf-8")
    strict = ["-Wall", "-Werror", *(f"-Wno-{it}" for it in _ALLOWED)]
    command = [tool("cc"), *options, *strict, "-fPIC", "-shared", "-o", str(library), str(source), "-lm"]
    called(command)
    return ctypes.CDLL(str(library))


def run_c(library: ctypes.CDLL, name: str, inputs: Array, cells: Array, outputs: int) -> Ran:
    """The function `NAME_rows(const double *in, int rows, double *cells, double *out)` of a library."""
    given = np.ascontiguousarray(inputs, dtype=np.float64)
    out, held = np.empty((len(given), outputs)), np.array(cells, dtype=np.float64)
    place = ctypes.c_void_p
    function = getattr(library, f"{name}_rows")
    function(place(given.ctypes.data), len(given), place(held.ctypes.data), place(out.ctypes.data))
    return Ran(out, held)


def run_node(
    module: str,
    folder: Path,
    given: Mapping[str, tuple[Array, Array, int]],
    files: Mapping[str, str] | None = None,
) -> dict[str, Ran]:
    """The functions `NAME(row, cells) → outputs` that a module exports, all in one process.

    `given` are inputs, cells and how many outputs, by name; `files` further modules beside it.
    """
    (folder / "emitted.mjs").write_text(module, encoding="utf-8")
    for name, text in (files or {}).items():
        (folder / name).write_text(text, encoding="utf-8")
    shapes = {}
    for name, (inputs, cells, outputs) in given.items():
        rows = np.ascontiguousarray(inputs, dtype=np.float64)
        rows.tofile(folder / f"{name}.in")
        np.asarray(cells, dtype=np.float64).tofile(folder / f"{name}.cells")
        shapes[name] = [len(rows), rows.shape[1], outputs]
    (folder / "shapes.json").write_text(json.dumps(shapes), encoding="utf-8")
    (folder / "run.mjs").write_text(_RUN, encoding="utf-8")
    called([tool("node"), "run.mjs"], folder)
    outputs = {n: np.fromfile(folder / f"{n}.out").reshape(rows, -1) for n, (rows, _, _) in shapes.items()}
    return {n: Ran(found, np.fromfile(folder / f"{n}.cells")) for n, found in outputs.items()}


_RUN = """\
import { readFileSync, writeFileSync } from "node:fs";
import * as all from "./emitted.mjs";
const numbers = (name) => {
    const bytes = readFileSync(name);
    return new Float64Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
};
for (const [name, [rows, wide, outputs]] of Object.entries(JSON.parse(readFileSync("shapes.json")))) {
    const given = numbers(`${name}.in`), cells = numbers(`${name}.cells`);
    const out = new Float64Array(rows * outputs);
    for (let k = 0; k < rows; k += 1) {
        const got = all[name](given.subarray(k * wide, (k + 1) * wide), cells);
        for (let i = 0; i < outputs; i += 1) { out[k * outputs + i] = Number(got[i]); }
    }
    writeFileSync(`${name}.out`, Buffer.from(out.buffer));
    writeFileSync(`${name}.cells`, Buffer.from(cells.buffer));
}
"""


_ANY = 2.0**31
"""No count is beyond it."""


def law_in_c(law: LawProgram, name: str) -> str:
    """A law's header, and a function for `run_c`: it begins at its first reading, and after each NaN."""
    size, kind = law.remembers, "int32_t" if law.resolution > 0 else "double"
    ends = [(f"POSITION_{end}", f"({sign}1e9)", "m") for end, sign in (("MIN", "-"), ("MAX", ""))]
    everywhere = Machine(law, "double", (-_ANY, _ANY), None)
    return f"""{header(everywhere, name=name, about=[name], numbers=ends)}
void {name}_rows(const double *in, int rows, double *cells, double *out)
{{
    {name}_state s;
    for (int k = 0; k < rows; k += 1) {{
        if (in[k] != in[k]) {{ out[k] = 0; continue; }}
        if (k == 0 || in[k - 1] != in[k - 1]) {{ {name}_init(&s, ({kind})in[k]); }}
        out[k] = {name}_step(&s, ({kind})in[k]);
    }}
    for (int k = 0; k < {size}; k += 1) {{ cells[k] = s.memory[k]; }}
}}
"""


def law_in_javascript(name: str) -> str:
    return f"""import * as of_{name} from "./{name}.mjs";
export const {name} = (() => {{
    let s;
    return (row, cells) => {{
        if (row[0] !== row[0]) {{ s = null; return [0]; }}
        s ??= of_{name}.init(row[0]);
        const force = of_{name}.step(s, row[0]);
        cells.set(s.memory.subarray(0, cells.length));
        return [force];
    }};
}})();
"""


def program_in_c(program: Program, name: str) -> str:
    c = C99(program, OF_C, prefix=name)
    body = c.lines()
    size = program.cells[0].size if program.cells else 1
    cell = program.cells[0].name if program.cells else "m"
    types = [c.type_of(v) for v in program.parameters]
    given = "".join(f", {t} {v.hint}" for t, v in zip(types, program.parameters, strict=True))
    read = "".join(f", ({t})in[k * {len(types)} + {i}]" for i, t in enumerate(types))
    results = [f"    out[{i}] = {c.read(r, alone=True)};" for i, r in enumerate(program.results)]
    functions = c.function_lines()
    call = f"{name}(({name}_state *)cells{read}, out + k * {len(results)})"
    lines = [
        f"typedef struct {{ double {cell}[{size}]; }} {name}_state;",
        *c.table_lines(),
        *c.helper_lines(),
        *functions,
        f"static void {name}({name}_state *s{given}, double *out)",
        *("{", *body, *results, "}"),
        f"void {name}_rows(const double *in, int rows, double *cells, double *out)",
        f"{{ for (int k = 0; k < rows; k++) {{ {call}; }} }}",
    ]
    return "\n".join(lines) + "\n"


INCLUDES = "#include <math.h>\n#include <stdint.h>\n"


def program_in_javascript(program: Program, name: str) -> str:
    js = JavaScript(program, OF_JAVASCRIPT)
    body = js.lines()
    functions = js.function_lines()
    cell = program.cells[0].name if program.cells else "m"
    names = ", ".join(v.hint for v in program.parameters)
    lines = [
        f"export const {name} = (() => {{",
        *js.table_lines(),
        *js.helper_lines(),
        *functions,
        f"const whole = (s, {names}) => {{",
        *body,
        f"    return [{', '.join(js.read(r, alone=True) for r in program.results)}];",
        "};",
        f"return (row, cells) => whole({{ {cell}: cells }}, ...row);",
        "})();",
    ]
    return "\n".join(lines) + "\n"
