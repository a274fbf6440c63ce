"""Machines that laws run on: forces are those of arithmetic, costs those of the data sheet."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from firmware.baselines.read import NAMES, UNIT, fixed_forces, float_forces, text, touch
from firmware.emulated import cortex, required
from firmware.emulated.answers import IDLE
from firmware.emulated.avr import AvrLaw
from firmware.emulated.built import defined
from firmware.emulated.host import HostLaw, watched
from firmware.emulated.required import require

ANYTHING = touch(3000, 2**31 - 1)


def on_host(level: str, name: str, counts: object, start: int, folder: Path) -> Any:
    require("host")
    law = HostLaw(text(name), folder, level)
    law.init(start)
    return law.run(counts)


def on_avr(name: str, counts: object, start: int, folder: Path) -> Any:
    require("avr")
    with AvrLaw(text(name)) as law:
        law.init(start)
        return law.run(counts).forces


def on_cortex(floats: tuple[str, ...], name: str, counts: object, start: int, folder: Path) -> Any:
    require("cortex-m4")
    return cortex.run(text(name), counts, start, floats).forces


MACHINES: dict[str, Callable[..., Any]] = {
    "host, as it is": partial(on_host, "-O0"),
    "host, optimized": partial(on_host, "-O2"),
    "avr": on_avr,
    "cortex, in software": partial(on_cortex, cortex.SOFT),
    "cortex, with its unit": partial(on_cortex, cortex.HARD),
}


@pytest.mark.parametrize("machine", MACHINES)
def test_whole_numbers_are_those_of_python(machine: str, tmp_path: Path) -> None:
    forces = MACHINES[machine]("fixed16", ANYTHING, 5, tmp_path)
    assert forces.dtype == np.int32
    assert forces.tolist() == fixed_forces(ANYTHING, 5)


@pytest.mark.parametrize("name", ["naive_float", "naive_double"])
@pytest.mark.parametrize("machine", MACHINES)
def test_floats_have_every_bit_that_numpy_has(machine: str, name: str, tmp_path: Path) -> None:
    """Of the same operations; a double of the AVR has four bytes."""
    real = np.float64 if name == "naive_double" and machine != "avr" else np.float32
    forces = MACHINES[machine](name, ANYTHING, -3, tmp_path)
    assert forces.dtype == real
    assert np.array_equal(forces, float_forces(ANYTHING, real, -3))


def test_a_law_goes_on_and_begins_anew(tmp_path: Path) -> None:
    require("host", "avr")
    counts = touch(60)
    with AvrLaw(text("fixed16"), "-O2") as chip:
        for law in (HostLaw(text("fixed16"), tmp_path), chip):
            for part, start in ((counts, 9), (counts[::-1], -2)):
                law.init(start)
                assert [law.force(int(n)) for n in part] == [UNIT * f for f in fixed_forces(part, start)]
                law.reset()
                again = [law.force(int(n)) for n in counts]
                assert again == [UNIT * f for f in fixed_forces(counts, int(part[-1]))]


# ---- what a step costs

INSTRUCTIONS = {
    "nop": 1, "movw r30, r24": 1, "in r0, 0x3f": 1, "adiw r30, 1": 2, "mul r24, r25": 2, "muls r24, r25": 2,
    "fmul r22, r23": 2, "push r0\\n pop r0": 4, "lds r0, 0x100": 2, "ld r0, Z": 2, "lpm r0, Z": 3,
    "rjmp .+0": 2, "jmp 1f\\n 1:": 3, "clz\\n breq .+0": 2, "sez\\n breq .+0": 3,
    "clr r0\\n sbrs r0, 0\\n nop": 3, "clr r0\\n sbrc r0, 0\\n nop": 3,
    "clr r0\\n sbrc r0, 0\\n lds r0, 0x100": 4, "rcall 1f\\n rjmp 2f\\n 1: ret\\n 2:": 3 + 4 + 2,
}  # fmt: skip
"""Cycles by the instruction set manual of Atmel's 8-bit AVR (0856), for a program counter of 16 bits."""

IDLE_AVR = "#define LAW_FORCE_PER_UNIT 1\n" + IDLE


def idle_with(instructions: str) -> str:
    clobbered = '"r0", "r1", "r30", "r31", "memory"'
    asm = f'__asm__ volatile("{instructions}\\n clr r1" ::: {clobbered});'
    return IDLE_AVR.replace("return counts", f"{asm} return counts")


def test_cycles_of_the_avr_are_those_of_the_data_sheet() -> None:
    require("avr")
    wrong = {}
    for instruction, cycles in INSTRUCTIONS.items():
        few, many = (idle_with("\\n ".join([instruction] * n)) for n in (1, 4))
        with AvrLaw(few) as a, AvrLaw(many) as b:
            found = [law.run([0, 1]).worst for law in (a, b)]
        if found[1] - found[0] != 3 * cycles:
            wrong[instruction] = (found[1] - found[0]) / 3
    assert not wrong


def test_every_instruction_of_the_cortex_is_counted() -> None:
    require("cortex-m4")
    counts = np.array([1, 2, 7, 100, 20_000])
    bare = cortex.run(IDLE, counts).cost
    loop = '__asm__ volatile("1: subs %0, #1\\n bne 1b" : "+r"(counts) : : "cc"); '
    for extra, more in (("", 0), ('__asm__ volatile("nop\\n nop\\n nop"); ', 3), (loop, 2 * counts)):
        law = IDLE.replace("return counts", f"{extra}return counts")
        assert cortex.run(law, counts).cost.tolist() == (bare + more).tolist()


@pytest.mark.parametrize("name", NAMES)
def test_what_a_step_costs_the_avr(name: str) -> None:
    """Fixed point of 16 bits takes less than 200 cycles, what one first writes over 800; all fit in."""
    require("avr")
    with AvrLaw(text(name)) as law:
        law.init(0)
        answers = law.run(touch(2000))
    assert 0 < answers.median <= answers.worst
    assert answers.worst < 200 if name == "fixed16" else answers.median > 800
    assert 0 < answers.flash < 2000
    assert answers.ram == (2 if name == "fixed16" else 4)


def test_what_a_step_costs_the_cortex() -> None:
    """Floats are quick where the chip has a unit for them, doubles nowhere."""
    require("cortex-m4")
    counts = touch(500)
    soft, hard = (cortex.run(text("naive_float"), counts, floats=f) for f in (cortex.SOFT, cortex.HARD))
    assert hard.worst < 50 < 200 < soft.median
    assert cortex.run(text("naive_double"), counts).median > 200
    assert cortex.run(text("fixed16"), counts, floats=cortex.SOFT).worst < 50
    assert 0 < hard.flash < soft.flash


@pytest.mark.parametrize("sign", "+-*/")
def test_operations_on_floats_of_the_avr(sign: str) -> None:
    """Each is rounded to the nearest, as IEEE 754 has it, but for quotients below the normal range."""
    require("avr")
    law = """
#include <stdint.h>
#include <string.h>
#define LAW_FORCE_PER_UNIT 1
typedef float law_force;
typedef struct { float before; } law_state;
static inline float law_real(int32_t bits) { float x; memcpy(&x, &bits, 4); return x; }
static inline void law_init(law_state *s, int32_t counts) { s->before = law_real(counts); }
static inline law_force law_step(law_state *s, int32_t counts) {
    float x = law_real(counts), f = s->before SIGN x;
    s->before = x;
    return f;
}
static inline void law_reset(law_state *s) { (void)s; }
""".replace("SIGN", sign)
    rng = np.random.default_rng(3)
    size = 1500
    anything = rng.integers(0, 2**32, size=size)
    alike = rng.integers(121, 133, size=size) << 23 | rng.integers(0, 2**32, size=size) & 0x807F_FFFF
    halves = alike & 0xFFFF_8003  # few bits: many results lie half way between two floats
    bits = np.concatenate([anything, alike, halves]).astype(np.uint32)
    numbers = bits.view(np.float32)
    with AvrLaw(law) as chip:
        chip.init(0)
        found = chip.run(bits.view(np.int32)).forces
    before = np.append(np.float32(0), numbers[:-1])
    with np.errstate(all="ignore"):
        wanted = {"+": np.add, "-": np.subtract, "*": np.multiply, "/": np.divide}[sign](before, numbers)
    if sign == "/":
        normal = ~((np.abs(wanted) < np.finfo(np.float32).tiny) & (wanted != 0))
        found, wanted = found[normal], wanted[normal]
    assert np.array_equal(found, wanted, equal_nan=True)


# ---- what is not in order


def test_a_law_of_the_avr_that_does_not_return() -> None:
    require("avr")
    with AvrLaw(IDLE_AVR.replace("return counts", "while (counts == 3) s->nothing++; return counts")) as law:
        assert law.run([2]).forces.tolist() == [2]
        with pytest.raises(AssertionError, match="4 000 000 cycles"):
            law.run([3])


def test_a_warning_is_an_error_and_an_overflow_is_seen(tmp_path: Path) -> None:
    """Whole numbers that grow too large end the run; those of 16 bits do not, whatever is counted."""
    require("host")
    careless = text("fixed16").replace("int32_t f;", "int32_t f, unused;")
    with pytest.raises(AssertionError, match="unused"):
        HostLaw(careless, tmp_path)
    for name in ("fixed16", "naive_float"):
        watched(text(name), ANYTHING, tmp_path)
    watched(text("naive_q16"), touch(3000), tmp_path)
    with pytest.raises(AssertionError, match="overflow"):
        watched(text("naive_q16"), ANYTHING, tmp_path)


@pytest.mark.parametrize(
    ("written", "number"),
    [("1.0", 1.0), ("0x1p-20", 2.0**-20), ("9.5e-07f", 9.5e-07), ("(-32767)", -32767.0), ("+3", 3.0)],
)
def test_numbers_of_a_header_are_read_as_its_compiler_reads_them(written: str, number: float) -> None:
    header = f"#define LAW_FORCE 2\n  #define TOUCH_FORCE_PER_UNIT  {written}\n"
    assert defined(header, "FORCE_PER_UNIT") == number
    with pytest.raises(AssertionError, match="FORCE_STEP"):
        defined(header, "FORCE_STEP")


def test_a_missing_tool_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(required.TOOLS, "toaster", {"no-such-compiler": None})
    monkeypatch.setitem(required.TOOLS, "nothing", {})
    monkeypatch.setitem(required.TOOLS, "bare", {"gcc": "no/such/header.h"})
    monkeypatch.delenv("ZWIDTH_EVERY_TARGET", raising=False)
    required.require("nothing")
    with pytest.raises(pytest.skip.Exception, match="no-such-compiler"):
        required.require("nothing", "toaster")
    monkeypatch.setenv("ZWIDTH_EVERY_TARGET", "1")
    with pytest.raises(pytest.fail.Exception, match="no-such-compiler"):
        required.require("toaster")
    required.require("host")
    assert required.missing("bare") == ("no/such/header.h of gcc",)
