"""The Cortex-M program on a machine: the mps2-an386 that QEMU emulates, by a clock of instructions."""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np
import pytest
from firmware.emulated.required import tool
from firmware.tools import DATA, KINDS, law_forces, run, written

from zwidth.machine.firmware.targets import main_files
from zwidth.machine.firmware.telemetry import read_telemetry


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


def test_a_fault_of_the_processor_ends_in_force_0(tmp_path: Path) -> None:
    assert ended(tmp_path / "board", 3, "-DFAULTY=580") == 7
