"""The emulated ATmega328P: cycles are those of its data sheet, forces those of this machine."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from firmware.baselines.read import NAMES, fixed_forces, float_forces, text, touch
from firmware.emulated.answers import IDLE
from firmware.emulated.avr import AvrLaw
from firmware.emulated.host import HostLaw
from firmware.emulated.required import require

UNIT = "#define LAW_FORCE_PER_UNIT 1\n"
INSTRUCTIONS = {
    "nop": 1,
    "movw r30, r24": 1,
    "in r0, 0x3f": 1,
    "adiw r30, 1": 2,
    "mul r24, r25": 2,
    "muls r24, r25": 2,
    "fmul r22, r23": 2,
    "push r0\\n pop r0": 4,
    "lds r0, 0x100": 2,
    "ld r0, Z": 2,
    "lpm r0, Z": 3,
    "rjmp .+0": 2,
    "jmp 1f\\n 1:": 3,
    "clz\\n breq .+0": 2,
    "sez\\n breq .+0": 3,
    "clr r0\\n sbrs r0, 0\\n nop": 3,
    "clr r0\\n sbrc r0, 0\\n nop": 3,
    "clr r0\\n sbrc r0, 0\\n lds r0, 0x100": 4,
    "rcall 1f\\n rjmp 2f\\n 1: ret\\n 2:": 3 + 4 + 2,
}
"""Cycles by the instruction set manual of Atmel's 8-bit AVR (0856), for a program counter of 16 bits."""


@pytest.fixture(autouse=True)
def _tools() -> None:
    require("avr")


def idle_with(instructions: str) -> str:
    clobbered = '"r0", "r1", "r30", "r31", "memory"'
    asm = f'__asm__ volatile("{instructions}\\n clr r1" ::: {clobbered});'
    return UNIT + IDLE.replace("return counts", f"{asm} return counts")


def test_cycles_are_those_of_the_data_sheet() -> None:
    """Three of an instruction more cost three times its cycles."""
    wrong = {}
    for instruction, cycles in INSTRUCTIONS.items():
        few, many = (idle_with("\\n ".join([instruction] * n)) for n in (1, 4))
        with AvrLaw(few) as a, AvrLaw(many) as b:
            found = [law.run([0, 1]).worst for law in (a, b)]
        if found[1] - found[0] != 3 * cycles:
            wrong[instruction] = (found[1] - found[0]) / 3
    assert not wrong


def test_whole_numbers_on_the_chip() -> None:
    counts = touch(3000, 2**31 - 1)
    with AvrLaw(text("fixed16")) as law:
        law.init(5)
        answers = law.run(counts)
    assert answers.forces.dtype == np.int32
    assert answers.forces.tolist() == fixed_forces(counts, 5)


def test_floats_on_the_chip() -> None:
    """The chip has floats of four bytes, a double too; its library rounds them as IEEE 754 has it."""
    counts = touch(3000)
    for name in ("naive_float", "naive_double"):
        with AvrLaw(text(name)) as law:
            law.init(0)
            answers = law.run(counts)
        assert answers.forces.dtype == np.float32
        assert np.array_equal(answers.forces, float_forces(counts, np.float32))


@pytest.mark.parametrize("sign", "+-*/")
def test_operations_on_floats(sign: str) -> None:
    """Each is rounded to the nearest, as IEEE 754 has it, but for quotients below the normal range."""
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
        operation = {"+": np.add, "-": np.subtract, "*": np.multiply, "/": np.divide}[sign]
        wanted = operation(before, numbers)
    if sign == "/":
        normal = ~((np.abs(wanted) < np.finfo(np.float32).tiny) & (wanted != 0))
        found, wanted = found[normal], wanted[normal]
    assert np.array_equal(found, wanted, equal_nan=True)


@pytest.mark.parametrize("name", NAMES)
def test_what_a_step_costs(name: str) -> None:
    """Fixed point of 16 bits takes less than 200 cycles, what one first writes over 800; all fit in."""
    with AvrLaw(text(name)) as law:
        law.init(0)
        answers = law.run(touch(2000))
    assert 0 < answers.median <= answers.worst
    assert answers.worst < 200 if name == "fixed16" else answers.median > 800
    assert 0 < answers.flash < 2000
    assert answers.ram == (2 if name == "fixed16" else 4)


def test_it_goes_on_and_begins_anew(tmp_path: Path) -> None:
    """Step by step the same as at once, init and reset as on this machine."""
    counts = touch(60)
    host = HostLaw(text("fixed16"), tmp_path)
    with AvrLaw(text("fixed16"), "-O2") as law:
        for part in (counts, counts[::-1]):
            for each in (host, law):
                each.init(int(counts[9]))
            assert [law.force(int(count)) for count in part] == [host.force(int(count)) for count in part]
            law.reset()


@pytest.mark.parametrize("name", NAMES)
def test_a_sketch_takes_a_header_as_well(name: str) -> None:
    counts = touch(200)
    found = []
    for sketch in (False, True):
        with AvrLaw(text(name), sketch=sketch) as law:
            law.init(0)
            found.append(law.run(counts).forces)
    assert np.array_equal(*found)


def test_what_does_not_return() -> None:
    endless = UNIT + IDLE.replace("return counts", "while (counts == 3) s->nothing++; return counts")
    with AvrLaw(endless) as law:
        assert law.run([2]).forces.tolist() == [2]
        with pytest.raises(AssertionError, match="4 000 000 cycles"):
            law.run([3])
