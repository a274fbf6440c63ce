"""The program for POSIX, compiled and run here: with its simulated mass, with an emulated controller."""

from __future__ import annotations

import math
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from firmware.emulated.required import tool
from firmware.tools import law_forces, run, written
from servo.emulators.moteus import MoteusEmulator

from zwidth.machine.firmware.targets import main_files
from zwidth.machine.firmware.telemetry import read_telemetry

pytestmark = pytest.mark.skipif(
    not sys.platform.startswith("linux"), reason="clock_nanosleep and mlockall are asked of Linux here"
)

SLOW = "-DTIMEOUT=60000000000 -DLONGEST_GAP=60000000000"
"""A machine that has other things to do is no mistake of the program."""


def made(target: str, folder: Path, *changes: tuple[str, str, str], flags: str = SLOW) -> Path:
    """The program of a target, by its own Makefile; each change replaces a text of one of its files."""
    written(main_files(target), folder)
    for name, old, new in changes:
        text = (folder / name).read_text(encoding="utf-8")
        assert old in text
        (folder / name).write_text(text.replace(old, new), encoding="utf-8")
    run(tool("make"), f"CC={tool('cc')}", f"CFLAGS=-O2 -Werror {flags}", cwd=folder)
    return folder / "main"


def ran(*command: str | Path) -> subprocess.CompletedProcess[str]:
    words = [str(word) for word in command]
    return subprocess.run(
        [words[0], "-p", "0", *words[1:]], capture_output=True, text=True, check=False, timeout=300
    )


@pytest.fixture(scope="module")
def simulated(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return made("posix", tmp_path_factory.mktemp("simulated"))


def test_it_runs_as_it_is(simulated: Path, tmp_path: Path) -> None:
    done = ran(simulated, "-n", "200", "-t", tmp_path / "mass.bin")
    assert done.returncode == 0
    assert "200 samples" in done.stderr
    data = read_telemetry(tmp_path / "mass.bin")
    assert data.attrs["lost_packets"] == 0
    assert set(data.phase.values) == {1}
    counts = np.rint(data.position.values / 2.24e-5)
    law = law_forces(counts, 1)
    assert law.max() > 1.0
    assert np.abs(data.actuator_force.values - law).max() < 1e-4


def test_a_signal_ends_it_in_order(simulated: Path, tmp_path: Path) -> None:
    path = tmp_path / "asked.bin"
    command = [str(simulated), "-p", "0", "-t", str(path)]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as running:
        while not (path.exists() and path.stat().st_size > 300):
            assert running.poll() is None
            time.sleep(0.01)
        running.terminate()
        _, said = running.communicate()
    assert running.returncode == 0
    assert "reason 1" in said


def test_a_reading_that_jumps_ends_it(tmp_path: Path) -> None:
    last = "return counts < whole"
    jumping = ("mass.c", last, f"if (position > 0.001) return 100000;\n  {last}")
    done = ran(made("posix", tmp_path / "main", jumping), "-t", tmp_path / "mass.bin")
    assert done.returncode == 1
    data = read_telemetry(tmp_path / "mass.bin")
    assert (int(data.phase.values[-1]), int(data.reason.values[-1])) == (2, 2)
    assert data.actuator_force.values[-1] == 0.0
    assert data.actuator_force.values[-2] > 0.0


def test_the_second_thread_ends_the_force_where_the_loop_hangs(tmp_path: Path) -> None:
    hangs = ("mass.c", "  velocity +=", "  volatile int hung = 1;\n  while (hung) {\n  }\n  velocity +=")
    stop = "void device_stop(void) {"
    says = ("mass.c", stop, f'#include <stdio.h>\n{stop} puts("stopped"); fflush(stdout);')
    done = ran(made("posix", tmp_path / "main", hangs, says, flags=""))
    assert done.returncode == 3
    assert done.stdout == "stopped\n"
    assert "hung" in done.stderr


ROTARY = ("law.h", "#define LAW_ROTARY 0", "#define LAW_ROTARY 1")
ANSWERED_LATE = f"{SLOW} -DANSWER_MS=60000 -DGUARD_SPEED=10000.0"


def test_a_device_that_cannot_be_opened_ends_it_at_once(tmp_path: Path) -> None:
    done = ran(made("moteus", tmp_path / "main", ROTARY), "-d", tmp_path / "none")
    assert done.returncode == 2
    assert "cannot be used" in done.stderr


def test_the_moteus_program_speaks_to_a_controller(tmp_path: Path) -> None:
    """Over a pseudo-terminal, to an emulator written from the documentation: the law's torques, then none."""
    counts = [*range(-60, 0, 3), *range(0, 400, 7), *range(400, -60, -5)]
    turns = [(n + 0.3) * 2.24e-5 / (2 * math.pi) for n in counts]  # 22.4 µrad in a count
    program = made("moteus", tmp_path / "main", ROTARY, flags=ANSWERED_LATE)
    with MoteusEmulator([turns[0], *turns]) as controller:
        told = tmp_path / "motor.bin"
        done = ran(program, "-d", controller.port, "-n", str(len(counts)), "-t", told)
    assert done.returncode == 0, done.stderr
    assert controller.complaints == []
    assert set(controller.watchdogs) == {0.02}
    data = read_telemetry(told)
    assert set(np.rint(data.position.values / 2.24e-5)) <= set(counts)
    given = np.array([command.force for command in controller.commands if command.force != 0.0])
    said = data.actuator_force.values
    assert given.min() < -2.0
    assert np.allclose(given, -said[said != 0.0], rtol=0, atol=1e-4)
    assert controller.mode == 0
