"""What is emitted of a law gives the same bits as the compiled step functions."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from emitted_laws import laws, readings
from firmware.emulated.required import tool
from machines import Ran, compiled_c, differing, law_in_c, law_in_javascript, run_c, run_node, understood
from moved_plants import PERIOD, PLANTS, plant_in_c
from numpy.typing import NDArray

import zwidth as zw
from zwidth.loop.law import sampled_force, sampled_force_at
from zwidth.loop.setup import prepare
from zwidth.machine.firmware.header import header
from zwidth.machine.firmware.javascript import module
from zwidth.machine.firmware.law import LawProgram, law_program
from zwidth.machine.firmware.machine import Machine, Number, machine
from zwidth.machine.firmware.plant import plant_program
from zwidth.model.environment.environment import Environment
from zwidth.model.operator import PrescribedMotion

STEPS = 3000


class Known(NamedTuple):
    law: LawProgram
    readings: NDArray[np.float64]
    ran: Ran


@pytest.fixture(scope="module")
def known() -> Mapping[str, Known]:
    return {name: _known(*make()) for name, make in laws().items()}


def _known(device: zw.Device, environment: Environment) -> Known:
    law = law_program(device, environment)
    still = [[np.nan, *[n] * 4] for n in (-3000, -1, 0, 1, 2, 391, 3000)]
    given = np.concatenate([readings(law, 7, STEPS), np.ravel(still) * (1 if law.resolution > 0 else 2.1e-5)])
    step, kind = (sampled_force, int) if law.resolution > 0 else (sampled_force_at, float)
    forces = np.zeros((len(given), 1))
    for k, x in enumerate(given):
        if np.isnan(x):
            continue
        if k == 0 or np.isnan(given[k - 1]):
            there = PrescribedMotion([float(kind(x)) * (law.resolution or 1.0)] * 2)
            period = device.exact("sample_period")
            memory = prepare(device, environment, there, period, encoder_phase=0.5).memory
        forces[k] = step(law.law, memory, kind(x))
    return Known(law, given[:, None], Ran(forces, memory))


def test_the_readings_make_every_law_push(known: Mapping[str, Known]) -> None:
    """Each law gives many forces, inside its limit and at it: what follows compares something."""
    assert all(len(np.unique(one.ran.outputs)) > 40 for one in known.values())


@pytest.mark.parametrize(
    "options",
    [("-std=c99", "-O2"), ("-std=gnu99", "-O3"), ("-std=gnu99", "-O3", "-march=native")],
    ids=lambda options: " ".join(options),
)
def test_every_header_has_the_same_bits(
    known: Mapping[str, Known], options: tuple[str, ...], tmp_path: Path
) -> None:
    """Force and memory are equal to the last bit, however C is compiled, also where products can be fused.

    So they are where a law begins: at rest, outside or inside, as in the simulator.
    """
    understood("cc", *options)
    library = compiled_c("".join(law_in_c(k.law, n) for n, k in known.items()), tmp_path, options)
    ran = {n: run_c(library, n, k.readings, k.ran.cells, 1) for n, k in known.items()}
    assert not differing(known, ran)


def test_every_module_has_the_same_bits(known: Mapping[str, Known], tmp_path: Path) -> None:
    files = {f"{n}.mjs": module(k.law, about=[n], numbers=[]) for n, k in known.items()}
    text = "".join(law_in_javascript(n) for n in known)
    ran = run_node(text, tmp_path, {n: (k.readings, k.ran.cells, 1) for n, k in known.items()}, files)
    assert not differing(known, ran)


# ---- what a compiler may be asked for

WHOLE = ("spring", "damped", "detents", "bump_stop", "prony", "slip", "bench_kalman_damping")
"""Of the laws, some that can be emitted in whole numbers."""

MARCH = ("", "-march=native", "-march=x86-64", "-march=x86-64-v3", "-march=sapphirerapids")
"""The last computes in binary16: gcc gives it FLT_EVAL_METHOD 16, in the dialects of GNU alone."""

KEPT = {"double": {0, 1, 16, 32, 64}, "float": {0, 16, 32}, "fixed": {-1, 0, 1, 2, 16, 32, 33, 64, 65, 128}}
"""The values of FLT_EVAL_METHOD with which the numbers of a law keep their digits: of all, the last."""


def _header(law: LawProgram, number: Number, name: str) -> str:
    end = 2000.0
    ends = [(f"{it}_{side}", f"({end:.0f})", "") for it in ("POSITION", "COUNTS") for side in ("MIN", "MAX")]
    made = machine(law, number, (-end, end)) if number == "fixed" else Machine(law, number, (-end, end), None)
    return header(made, name=f"{name}_{number}", about=[name], numbers=ends)


def _asked(text: str, *command: str) -> subprocess.CompletedProcess[str]:
    tool(command[0])
    return subprocess.run([*command, "-"], input=text, capture_output=True, text=True, check=False)


@pytest.fixture(scope="module")
def headers(known: Mapping[str, Known]) -> str:
    """Every law in double and in float, some in whole numbers, every plant: one after the other."""
    kinds: Sequence[Number] = ("double", "float", "fixed")
    plants = {n: plant_program(plant, PERIOD, hand) for n, (plant, hand) in PLANTS.items()}
    return "".join(
        _header(k.law, kind, n) for n, k in known.items() for kind in kinds if kind != "fixed" or n in WHOLE
    ) + "".join(plant_in_c(program, n) for n, program in plants.items())


@pytest.mark.parametrize("march", MARCH)
@pytest.mark.parametrize(
    ("compiler", "dialects"), [("cc", ("c99", "gnu99", "c11", "gnu17")), ("c++", ("c++11", "gnu++17"))]
)
def test_every_header_compiles_for_every_processor(
    headers: str, compiler: str, dialects: tuple[str, ...], march: str
) -> None:
    understood(compiler, march)
    language = "c" if compiler == "cc" else "c++"
    for dialect in dialects:
        strict = ["-Wall", "-Werror", "-Wno-unused-function", "-fsyntax-only"]
        done = _asked(headers, compiler, f"-std={dialect}", *march.split(), *strict, "-x", language)
        assert done.returncode == 0, f"{dialect}: {done.stderr[:2000]}"


@pytest.mark.parametrize(("compiler", "dialect"), [("cc", "gnu17"), ("c++", "gnu++17")])
@pytest.mark.parametrize("march", ["-march=x86-64-v3", "-march=sapphirerapids"])
def test_no_product_is_fused_with_a_sum(compiler: str, dialect: str, march: str) -> None:
    """Where processor and dialect would: without the header's own words the same text has such products."""
    understood(compiler, march)
    language = "c" if compiler == "cc" else "c++"
    options = [compiler, f"-std={dialect}", "-O2", march, "-S", "-o", "-", "-x", language]
    text = "".join(law_in_c(law_program(*laws()[name]()), name) for name in ("damped", "prony"))
    fused = re.compile(r"\bv?fn?m(add|sub)\d")
    assert not fused.search(_asked(text, *options).stdout)
    loose = re.sub("#pragma (GCC|STDC).*", "", text)
    assert fused.search(_asked(loose, *options, "-ffp-contract=fast").stdout)


@pytest.mark.parametrize("number", KEPT)
def test_a_compiler_that_keeps_other_digits_is_refused(number: Number) -> None:
    """By each value of FLT_EVAL_METHOD; the libraries' own headers are read before it is changed."""
    text = _header(law_program(*laws()["damped"]()), number, "law")
    given = "#include <math.h>\n#include <stdint.h>\n#undef __FLT_EVAL_METHOD__\n#define __FLT_EVAL_METHOD__"
    command = "cc", "-std=c99", "-w", "-fsyntax-only", "-x", "c"
    done = {method: _asked(f"{given} {method}\n{text}", *command) for method in KEPT["fixed"]}
    assert {method for method, one in done.items() if one.returncode == 0} == KEPT[number]
    assert all("more digits" in one.stderr for m, one in done.items() if m not in KEPT[number])


@pytest.mark.parametrize("number", KEPT)
@pytest.mark.parametrize(
    ("option", "macro", "why"),
    [
        ("-mfpmath=387", "__FLT_EVAL_METHOD__ 2", "more digits"),
        ("-mfpmath=both", "__FLT_EVAL_METHOD__ -1", "more digits"),
        ("-ffast-math", "", "-ffast-math"),
        ("-fassociative-math -fno-signed-zeros -fno-trapping-math", "__ASSOCIATIVE_MATH__", "-ffast-math"),
        ("-freciprocal-math", "__RECIPROCAL_MATH__", "-ffast-math"),
        ("-fno-signed-zeros", "__NO_SIGNED_ZEROS__", "-ffast-math"),
        ("-ffinite-math-only", "__FINITE_MATH_ONLY__ 1", "-ffast-math"),
    ],
)
def test_an_option_that_changes_a_law_is_refused(number: Number, option: str, macro: str, why: str) -> None:
    """Where the compiler has it and says so; whole numbers are the same with all of them."""
    understood("cc", option)
    command = ["cc", "-std=gnu99", *option.split()]
    if macro not in _asked("", *command, "-dM", "-E", "-x", "c").stdout:
        pytest.skip(f"this compiler does not say that it was given {option}")
    text = _header(law_program(*laws()["damped"]()), number, "law")
    done = _asked(text, *command, "-fsyntax-only", "-x", "c")
    assert (done.returncode == 0) == (number == "fixed")
    assert number == "fixed" or why in done.stderr
