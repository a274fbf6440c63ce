"""Main programs on emulated chips: a sketch on the ATmega328P cycle by cycle, and a Cortex-M4."""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np
import pytest
from firmware.emulated.board import Board
from firmware.emulated.built import sizes
from firmware.emulated.required import tool
from firmware.tools import DATA, KINDS, law_forces, run, sketch, written

from zwidth.machine.firmware.targets import main_files
from zwidth.machine.firmware.telemetry import read_telemetry


def wall(folder: Path, kind: int) -> Path:
    return sketch(written(main_files("arduino", folder="wall"), folder / "wall"), f"-DLAW_KIND={kind}")


@pytest.mark.parametrize("kind", [2, 3, 4])
def test_a_second_on_the_chip(tmp_path: Path, kind: int) -> None:
    """A sample each 16 000 cycles, to an instruction or two; all arrive, and have the law's forces.

    It fits: 32 KiB of program, 2 KiB of memory, of which the stack needs some.
    """
    program = wall(tmp_path, kind)
    flash, ram = sizes("avr-size", program)
    assert flash < 32_256
    assert ram < 1024
    with Board(program, tmp_path / "line.bin") as board:
        begun, ended, widths = np.array(board.swing(1000)).T
    assert begun.size == 999
    apart = np.diff(begun)[1:]
    assert 15_990 <= apart.min() <= apart.max() <= 16_010
    assert (ended - begun).max() < 8_000
    data = read_telemetry(tmp_path / "line.bin")
    assert (data.attrs["lost_packets"], data.attrs["dropped_samples"]) == (0, 0)
    assert data.sizes["time"] > 940
    assert np.allclose(data.time.values, 1e-3 * np.arange(data.sizes["time"]), rtol=0, atol=1e-9)
    counts = np.rint(data.position.values / 2.24e-5)
    assert counts.max() == pytest.approx(400, abs=2)
    served = data.phase.values == 1
    assert served.sum() > 900
    assert np.abs(data.actuator_force.values - law_forces(counts, kind))[served].max() < 2e-4
    assert widths.max() > 100


def test_where_the_chip_hangs_its_watchdog_ends_the_force(tmp_path: Path) -> None:
    with Board(wall(tmp_path, 3), tmp_path / "line.bin") as board:
        before = board.swing(350)
        board.hang()
        after = board.swing(600)
    assert before[-1][2] > 100
    assert not any(width for _, _, width in after)
    assert 16_000 * 15 < after[0][0] - before[-1][0] < 16_000 * 25  # the watchdog's 16 ms, and the start
    data = read_telemetry(tmp_path / "line.bin")
    assert (int(data.start.values[-1]), int(data.phase.values[-1]), int(data.reason.values[-1])) == (1, 2, 6)
    assert (data.actuator_force.values[data.start.values == 1] == 0).all()


# ---- the mps2-an386 that QEMU emulates


def ended(folder: Path, kind: int, *options: str) -> int:
    """The status with which the program ends; its line is in `line.bin`."""
    written(main_files("cortex-m"), folder)
    flags = " ".join(["-O2", "-Werror", f"-DLAW_KIND={kind}", "-DSAMPLES=2000", *options])
    board = f"BOARD={DATA / 'mps2.c'}"
    run(tool("make"), f"CC={tool('arm-none-eabi-gcc')}", board, f"CFLAGS={flags} -I.", cwd=folder)
    machine = ["-M", "mps2-an386", "-display", "none", "-monitor", "none", "-semihosting"]
    line = ["-icount", "shift=6", "-serial", f"file:{folder / 'line.bin'}"]
    command = [tool("qemu-system-arm"), *machine, *line, "-kernel", str(folder / "law.elf")]
    return subprocess.run(command, capture_output=True, check=False, timeout=300).returncode


@pytest.mark.parametrize("kind", KINDS)
def test_two_seconds_on_the_machine(tmp_path: Path, kind: int) -> None:
    assert ended(tmp_path / "board", kind) == 0
    data = read_telemetry(tmp_path / "board" / "line.bin")
    assert (data.attrs["lost_packets"], data.attrs["dropped_samples"]) == (0, 0)
    assert data.sizes["time"] >= 2000
    assert set(data.phase.values) == {1}
    assert np.allclose(data.time.values, 1e-3 * np.arange(data.sizes["time"]), rtol=0, atol=1e-9)
    k = np.arange(data.sizes["time"]) % 800
    counts = np.where(k < 200, -k, np.where(k < 600, k - 400, 800 - k))
    assert np.array_equal(np.rint(data.position.values / 2.24e-5), counts)
    assert np.abs(data.actuator_force.values - law_forces(counts, kind)).max() < 1e-4


@pytest.mark.parametrize(
    ("options", "status"),
    [([], 7), (["-DLONG=10000"], 7), (["-DLONG=100"], 0)],
    ids=["a fault of the processor", "longer than its period", "not so long"],
)
def test_a_fault_in_a_sample_ends_in_force_0(tmp_path: Path, options: list[str], status: int) -> None:
    assert ended(tmp_path / "board", 3, "-DFAULTY=580", *options) == status
