"""Main programs around a law: each compiles with its own tools, or is refused for a reason."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest
from firmware.tools import DATA, STUBS, WARNINGS, run, tool, written

from zwidth.errors import InputError
from zwidth.machine.firmware.targets import MAINS, main_files

C99 = ("-std=c99", *WARNINGS, "-O2", "-ffp-contract=off")
KINDS = [1, 2, 3, 4]
"""Of the laws of data/law.h: double, float, fine and coarse whole numbers."""


@pytest.mark.parametrize("kind", KINDS[1:])
def test_the_hapkit_sketch_compiles_for_its_chip(tmp_path: Path, kind: int) -> None:
    """And fits: 32 KiB of program, 2 KiB of memory, of which the stack needs some."""
    folder = written(main_files("arduino", folder="wall"), tmp_path / "wall")
    chip = ["-mmcu=atmega328p", "-DF_CPU=16000000UL", "-Os", "-fno-exceptions"]
    start = STUBS / "arduino" / "main.cpp"
    options = ["-std=gnu++11", *WARNINGS, f"-DLAW_KIND={kind}", "-I", STUBS / "arduino", "-I", folder]
    command = [tool("avr-g++"), *chip, *options, "-x", "c++", "-include", "Arduino.h", folder / "wall.ino"]
    run(*command, start, "-o", tmp_path / "wall.elf")
    text, data, bss = map(int, run(tool("avr-size"), tmp_path / "wall.elf").splitlines()[1].split()[:3])
    assert text + data < 32_256
    assert data + bss < 1024


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
    names = re.findall(r"-D(BAUD|TORQUE)=", option)
    text = sketch.read_text()
    for name in names:
        text = re.sub(rf"#define {name} .*\n", "", text)
    sketch.write_text(text)
    command = [tool("avr-g++"), "-mmcu=atmega328p", *option.split(), "-std=gnu++11", "-I", STUBS / "arduino"]
    command += ["-I", folder, "-fsyntax-only", "-x", "c++", "-include", "Arduino.h", sketch]
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    assert done.returncode != 0
    assert why in done.stderr


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("cpu", ["cortex-m0", "cortex-m4"])
def test_the_cortex_m_program_links_without_a_library_of_a_vendor(
    tmp_path: Path, cpu: str, kind: int
) -> None:
    """By its own Makefile; the table of vectors stands at the beginning of the flash."""
    folder = written(main_files("cortex-m"), tmp_path / "board")
    compiler = tool("arm-none-eabi-gcc")
    run(
        tool("make"),
        f"CC={compiler}",
        f"CPU=-mcpu={cpu}",
        f"CFLAGS=-Os -Werror -DLAW_KIND={kind}",
        cwd=folder,
    )
    symbols = run(tool("arm-none-eabi-nm"), folder / "law.elf")
    addresses = {name: int(at, 16) for at, _, name in map(str.split, symbols.splitlines())}
    assert addresses["vectors"] == 0
    assert {"Reset_Handler", "SysTick_Handler", "main"} <= addresses.keys()


def test_a_clock_that_misses_the_period_is_refused_by_the_compiler(tmp_path: Path) -> None:
    """SysTick counts whole clocks: 12.5 kHz for a law of 1 kHz would be 4 % off."""
    folder = written(main_files("cortex-m"), tmp_path / "board")
    include = ["-I", folder, "-DCPU_HZ=12500", "-ffreestanding", "-mcpu=cortex-m4", "-mthumb"]
    command = [tool("arm-none-eabi-gcc"), *C99, *include, "-c", folder / "main.c", "-o", tmp_path / "main.o"]
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    assert done.returncode != 0
    assert "period_is_met" in done.stderr


def test_the_simplefoc_example_compiles_against_a_stub(tmp_path: Path) -> None:
    """What it asks of the library is what the stub declares; nobody has run it on a motor."""
    folder = written(main_files("simplefoc", folder="motor"), tmp_path / "motor")
    law = folder / "law.h"
    law.write_text(law.read_text().replace("2.24e-05", "0.0007669903939428206"))  # 2π/8192
    options = ["-std=gnu++11", *WARNINGS, "-DLAW_ROTARY=1", "-I", STUBS / "simplefoc", "-I", folder]
    run(tool("c++"), *options, "-fsyntax-only", "-x", "c++", folder / "motor.ino")


@pytest.mark.parametrize("target", MAINS)
def test_names_follow_the_prefix_of_the_header(target: str) -> None:
    """Every name of the header is replaced, and no other word."""
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


def test_a_sketch_is_called_as_its_folder() -> None:
    assert "my-wall.ino" in main_files("arduino", folder="my-wall")
    assert {"guard.h", "telemetry.h"} <= main_files("simplefoc").keys()


def test_the_data_of_the_tests_is_the_law_of_the_files() -> None:
    """The header of the tests has every name that the programs use."""
    used = set()
    for target in MAINS:
        for text in main_files(target).values():
            used |= set(re.findall(r"\bLAW_[A-Z0-9_]+\b", text))
    header = (DATA / "law.h").read_text(encoding="utf-8")
    optional = {"LAW_BEGINS_MIN", "LAW_BEGINS_MAX"}
    assert {name for name in used - optional if f"#define {name}" not in header} == set()
