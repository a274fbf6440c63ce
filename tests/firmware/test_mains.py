"""Main programs around a law: each compiles with its own tools, or is refused for a reason."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from firmware.emulated.required import tool
from firmware.tools import DATA, KINDS, STUBS, run, written

from zwidth.errors import InputError
from zwidth.machine.firmware.targets import MAINS, main_files


@pytest.mark.parametrize(
    ("option", "why"),
    [
        ("-DF_CPU=1000300UL", "timer 1 misses the period"),
        ("-DF_CPU=8000000UL -DBAUD=115200L", "within 2.5 %"),
        ("-DF_CPU=16000000UL -DLAW_ROTARY=1", "a length at the handle"),
        ("-DF_CPU=16000000UL -DTORQUE=0.015", "more than this motor has"),
        ("-DF_CPU=16000000UL -DLAW_KIND=1", "double has 32 bits on this chip"),
    ],
)
def test_a_board_that_cannot_run_the_law_is_refused_by_the_compiler(
    tmp_path: Path, option: str, why: str
) -> None:
    folder = written(main_files("arduino", folder="wall"), tmp_path / "wall")
    sketch = folder / "wall.ino"
    text = sketch.read_text(encoding="utf-8")
    for name in re.findall(r"-D(BAUD|TORQUE)=", option):
        text = re.sub(rf"#define {name} .*\n", "", text)
    sketch.write_text(text, encoding="utf-8")
    command = [tool("avr-g++"), "-mmcu=atmega328p", *option.split(), "-std=gnu++11", "-I", STUBS / "arduino"]
    command += ["-I", folder, "-fsyntax-only", "-x", "c++", "-include", "Arduino.h", sketch]
    with pytest.raises(AssertionError, match=why):
        run(*command)


@pytest.mark.parametrize("kind", KINDS)
def test_the_cortex_m_program_links_without_a_library_of_a_vendor(tmp_path: Path, kind: int) -> None:
    """By its own Makefile, for a processor without floats; the vectors stand first in the flash."""
    folder = written(main_files("cortex-m"), tmp_path / "board")
    flags = f"CFLAGS=-Os -Werror -DLAW_KIND={kind}"
    run(tool("make"), f"CC={tool('arm-none-eabi-gcc')}", "CPU=-mcpu=cortex-m0", flags, cwd=folder)
    symbols = run(tool("arm-none-eabi-nm"), folder / "law.elf")
    addresses = {name: int(at, 16) for at, _, name in map(str.split, symbols.splitlines())}
    assert addresses["vectors"] == 0
    assert {"Reset_Handler", "SysTick_Handler", "main"} <= addresses.keys()


def test_a_clock_that_misses_the_period_is_refused_by_the_compiler(tmp_path: Path) -> None:
    """SysTick counts whole clocks: 12.5 kHz for a law of 1 kHz would be 4 % off."""
    folder = written(main_files("cortex-m"), tmp_path / "board")
    with pytest.raises(AssertionError, match="period_is_met"):
        run(tool("make"), f"CC={tool('arm-none-eabi-gcc')}", "CPU_HZ=12500", cwd=folder)


@pytest.mark.parametrize("target", MAINS)
def test_names_follow_the_prefix_of_the_header(target: str) -> None:
    plain, named = main_files(target, folder="x"), main_files(target, prefix="wall", folder="x")
    assert plain.keys() == named.keys()
    for name, text in named.items():
        assert not re.search(r"\blaw_(state|force|init|step|reset)\b|\bLAW_[A-Z]|law\.h", text)
        back = re.sub(r"\bWALL(?=_[A-Z])", "LAW", re.sub(r"\bwall(?=\.h\b|_[a-z])", "law", text))
        assert back == plain[name]


def test_what_there_is_no_main_program_for_is_said() -> None:
    with pytest.raises(InputError, match="arduino"):
        main_files("toaster")
    with pytest.raises(InputError, match="prefix"):
        main_files("posix", prefix="9walls")


def test_the_data_of_the_tests_is_the_law_of_the_files() -> None:
    texts = "".join("".join(main_files(target).values()) for target in MAINS)
    used = set(re.findall(r"\bLAW_[A-Z0-9_]+\b", texts)) - {"LAW_BEGINS_MIN", "LAW_BEGINS_MAX"}
    header = (DATA / "law.h").read_text(encoding="utf-8")
    assert {name for name in used if f"#define {name}" not in header} == set()
