"""The sketch of a Hapkit on its own chip, cycle by cycle: compiled for the ATmega328P, run by simavr."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from firmware.tools import DATA, STUBS, WARNINGS, needed_header, run, tool, written

from zwidth.machine.firmware.targets import main_files
from zwidth.machine.firmware.telemetry import read_telemetry

NEWTONS = {2: 0.00672, 3: 28 / 4096, 4: 0.01}
DAMPED = {2: 0.0448, 3: 184 / 4096, 4: 0.04}
"""Of the laws of data/law.h: in a count, and in a count of change from one sample to the next."""


class Ran(NamedTuple):
    """What the chip did; cycles of 16 MHz."""

    samples: int
    least_apart: int
    most_apart: int
    longest: int
    width: int
    widest: int
    width_as_it_hung: int


@pytest.fixture(scope="module")
def simulator(tmp_path_factory: pytest.TempPathFactory) -> Path:
    needed_header("simavr/sim_avr.h")
    program = tmp_path_factory.mktemp("chip") / "chip"
    run(tool("cc"), "-std=gnu99", *WARNINGS, "-O2", DATA / "chip.c", "-o", program, "-lsimavr", "-lm")
    return program


def sketch(folder: Path, kind: int) -> Path:
    written(main_files("arduino", folder="wall"), folder)
    chip = ["-mmcu=atmega328p", "-DF_CPU=16000000UL", "-Os", "-fno-exceptions", "-ffp-contract=off"]
    options = ["-std=gnu++11", *WARNINGS, f"-DLAW_KIND={kind}", "-I", STUBS / "arduino", "-I", folder]
    sources = ["-x", "c++", "-include", "Arduino.h", folder / "wall.ino", STUBS / "arduino" / "main.cpp"]
    run(tool("avr-g++"), *chip, *options, *sources, "-o", folder / "wall.elf")
    return folder / "wall.elf"


def ran(simulator: Path, *words: str | Path) -> Ran:
    return Ran(*map(int, run(simulator, *words).splitlines()[-1].split()))


@pytest.mark.parametrize("kind", [2, 3, 4])
def test_a_second_on_the_chip(simulator: Path, tmp_path: Path, kind: int) -> None:
    """A sample each 16 000 cycles, to an instruction or two; all arrive, and have the law's forces."""
    did = ran(simulator, sketch(tmp_path / "wall", kind), "1000", tmp_path / "line.bin")
    assert did.samples == 999
    assert 15_990 <= did.least_apart <= did.most_apart <= 16_010
    assert did.longest < 8_000
    data = read_telemetry(tmp_path / "line.bin")
    assert (data.attrs["lost_packets"], data.attrs["dropped_samples"]) == (0, 0)
    assert data.sizes["time"] > 940
    assert np.allclose(data.time.values, 1e-3 * np.arange(data.sizes["time"]), rtol=0, atol=1e-9)
    counts = np.rint(data.position.values / 2.24e-5)
    assert counts.max() == pytest.approx(400, abs=2)
    before = np.concatenate([counts[:1], counts[:-1]])
    law = np.maximum(NEWTONS[kind] * counts + DAMPED[kind] * (counts - before), 0.0)
    wanted = np.where(counts > 0, law, 0.0)
    served = data.phase.values == 1
    assert served.sum() > 900
    assert np.abs(data.actuator_force.values - wanted)[served].max() < 2e-4
    assert did.widest > 100


def test_where_the_chip_hangs_its_watchdog_ends_the_force(simulator: Path, tmp_path: Path) -> None:
    """Samples stop while the motor pushes: the chip starts anew, gives no force, and says why."""
    did = ran(simulator, sketch(tmp_path / "wall", 3), "600", tmp_path / "line.bin", "350")
    assert did.width_as_it_hung > 100
    assert did.width == 0
    assert 16_000 * 15 < did.most_apart < 16_000 * 25  # the watchdog's 16 ms, and the start
    data = read_telemetry(tmp_path / "line.bin")
    assert (int(data.start.values[-1]), int(data.phase.values[-1]), int(data.reason.values[-1])) == (1, 2, 6)
    assert (data.actuator_force.values[data.start.values == 1] == 0).all()
