"""The sketch of a Hapkit on its own chip, cycle by cycle: compiled for the ATmega328P, run by simavr."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from firmware.emulated.built import sizes
from firmware.tools import law_forces, run, sketch, written

from zwidth.machine.firmware.targets import main_files
from zwidth.machine.firmware.telemetry import read_telemetry


class Ran(NamedTuple):
    """What the chip did; cycles of 16 MHz."""

    samples: int
    least_apart: int
    most_apart: int
    longest: int
    width: int
    widest: int
    width_as_it_hung: int


def wall(folder: Path, kind: int) -> Path:
    return sketch(written(main_files("arduino", folder="wall"), folder / "wall"), f"-DLAW_KIND={kind}")


def ran(chip: Path, *words: str | Path) -> Ran:
    return Ran(*map(int, run(chip, *words).splitlines()[-1].split()))


@pytest.mark.parametrize("kind", [2, 3, 4])
def test_a_second_on_the_chip(chip: Path, tmp_path: Path, kind: int) -> None:
    """A sample each 16 000 cycles, to an instruction or two; all arrive, and have the law's forces.

    It fits: 32 KiB of program, 2 KiB of memory, of which the stack needs some.
    """
    program = wall(tmp_path, kind)
    flash, ram = sizes("avr-size", program)
    assert flash < 32_256
    assert ram < 1024
    did = ran(chip, program, "1000", tmp_path / "line.bin")
    assert did.samples == 999
    assert 15_990 <= did.least_apart <= did.most_apart <= 16_010
    assert did.longest < 8_000
    data = read_telemetry(tmp_path / "line.bin")
    assert (data.attrs["lost_packets"], data.attrs["dropped_samples"]) == (0, 0)
    assert data.sizes["time"] > 940
    assert np.allclose(data.time.values, 1e-3 * np.arange(data.sizes["time"]), rtol=0, atol=1e-9)
    counts = np.rint(data.position.values / 2.24e-5)
    assert counts.max() == pytest.approx(400, abs=2)
    served = data.phase.values == 1
    assert served.sum() > 900
    assert np.abs(data.actuator_force.values - law_forces(counts, kind))[served].max() < 2e-4
    assert did.widest > 100


def test_where_the_chip_hangs_its_watchdog_ends_the_force(chip: Path, tmp_path: Path) -> None:
    """Samples stop while the motor pushes: the chip starts anew, gives no force, and says why."""
    did = ran(chip, wall(tmp_path, 3), "600", tmp_path / "line.bin", "350")
    assert did.width_as_it_hung > 100
    assert did.width == 0
    assert 16_000 * 15 < did.most_apart < 16_000 * 25  # the watchdog's 16 ms, and the start
    data = read_telemetry(tmp_path / "line.bin")
    assert (int(data.start.values[-1]), int(data.phase.values[-1]), int(data.reason.values[-1])) == (1, 2, 6)
    assert (data.actuator_force.values[data.start.values == 1] == 0).all()
