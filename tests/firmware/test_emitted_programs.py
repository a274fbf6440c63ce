"""From a proof to a program: what is emitted compiles as it is, every warning an error, and runs."""

from __future__ import annotations

import re
import subprocess
import sys
from hashlib import sha256
from pathlib import Path

import numpy as np
import pytest
from firmware.emulated.board import Board
from firmware.emulated.built import STRICT
from firmware.emulated.built import WARNED as PEDANTIC
from firmware.emulated.required import tool
from firmware.machines import law_in_javascript, run_node
from firmware.tools import STUBS, run, sketch

import zwidth as zw
from zwidth.cli.main import main
from zwidth.machine.firmware.emit import Emitted, emit
from zwidth.machine.firmware.telemetry import read_telemetry

WARNED = ("-Wall", "-Wextra", "-Werror", "-ffp-contract=off")

HAPKIT = zw.Device(
    mass="20 g", damping=0.15, coulomb_friction="0.1 N", resolution="13.1 um", rate="1 kHz"
).replace(force_limit="5 N", force_resolution="0.01 N")
MOTOR = zw.rotary(
    inertia=1e-4, damping=0.002, coulomb_friction=0.004, resolution="0.0007669903939428206 rad", rate=1000
).replace(force_limit=2)
WALL = zw.Wall(stiffness=150, damping=0.05)


def written(folder: Path, target: str, number: str | None = None, prefix: str = "law") -> Emitted:
    turns = target in ("simplefoc", "moteus")
    loop, travel = ((MOTOR, zw.Wall(stiffness=1)), "-3 .. 3 rad") if turns else ((HAPKIT, WALL), None)
    found = emit(*loop, target=target, number=number, travel=travel, prefix=prefix)
    found.write(folder)
    return found


def force(data: object, error: float) -> None:
    """Of a recording: the wall's, at every sample that was served, off by what was proved at most."""
    counts = np.rint(data.position.values / 13.1e-6)  # type: ignore[attr-defined]
    moved = np.diff(counts, prepend=counts[0])
    wall = np.where(counts > 0, 13.1e-6 * (150 * counts + 0.05 / 1e-3 * moved), 0.0)
    served = data.phase.values == 1  # type: ignore[attr-defined]
    served[0] = False  # the wall is at rest there
    assert served.sum() > 100
    off = np.abs(data.actuator_force.values - np.clip(wall, -5, 5))[served]  # type: ignore[attr-defined]
    assert off.max() <= error + 5 / 32767


@pytest.mark.parametrize("number", ["fixed", "float"])
def test_a_hapkit_alone_gives_the_force_that_was_proved(tmp_path: Path, number: str) -> None:
    found = written(tmp_path / "wall", "arduino", number)
    with Board(sketch(tmp_path / "wall"), tmp_path / "line.bin") as board:
        board.swing(1000)
    data = read_telemetry(tmp_path / "line.bin")
    assert data.attrs["certificate_sha256"] == found.certificate_sha256
    assert data.actuator_force.values.max() > 0.5
    force(data, found.machine.error)


@pytest.mark.parametrize(("delay", "in_time"), [(0.25e-3, True), (0.02e-3, False)])
def test_a_force_later_than_the_proof_counts_ends_it(tmp_path: Path, delay: float, in_time: bool) -> None:
    """The sensor alone takes the chip 26 us: a law that was proved for a force within 20 us is not served."""
    device = HAPKIT.replace(delay=zw.Interval(0, zw.Exact(delay)))
    emit(device, zw.Wall(150), target="arduino").write(tmp_path / "wall")
    with Board(sketch(tmp_path / "wall"), tmp_path / "line.bin") as board:
        board.swing(400)
    phases = read_telemetry(tmp_path / "line.bin").phase.values
    assert ((phases == 1).sum() > 100) == in_time
    assert (phases[-1] == 2) != in_time


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="the program asks Linux for its clock")
@pytest.mark.parametrize("number", ["double", "float", "fixed"])
def test_a_computer_serves_a_simulated_mass(tmp_path: Path, number: str) -> None:
    found = written(tmp_path / "loop", "posix", number)
    flags = f"CFLAGS=-O2 {' '.join(WARNED)} -D_GNU_SOURCE -DTIMEOUT=60000000000 -DLONGEST_GAP=60000000000"
    run(tool("make"), f"CC={tool('cc')}", flags, cwd=tmp_path / "loop")
    run(tmp_path / "loop" / "main", "-p", "0", "-n", "400", "-t", tmp_path / "line.bin")
    data = read_telemetry(tmp_path / "line.bin")
    force(data, found.machine.error)


@pytest.mark.parametrize(
    ("target", "number"),
    [("cortex-m", "float"), ("cortex-m", "fixed"), ("cortex-m", "double"), ("moteus", None)],
)
def test_a_program_links(tmp_path: Path, target: str, number: str | None) -> None:
    compiler = tool("arm-none-eabi-gcc" if target == "cortex-m" else "cc")
    written(tmp_path / "loop", target, number)
    run(tool("make"), f"CC={compiler}", f"CFLAGS=-O2 {' '.join(WARNED)}", cwd=tmp_path / "loop")


@pytest.mark.parametrize("number", ["double", "float", "fixed"])
def test_a_sketch_of_simplefoc_compiles(tmp_path: Path, number: str) -> None:
    """Against a stub of the library, for a motor with an encoder of 8192 counts a turn."""
    folder = tmp_path / "motor"
    written(folder, "simplefoc", number)
    named = ["-I", STUBS / "simplefoc", "-I", folder, "-fsyntax-only", "-x", "c++"]
    run(tool("c++"), "-std=gnu++11", *WARNED, *named, folder / "motor.ino")


@pytest.mark.parametrize("number", ["double", "float", "fixed"])
def test_a_header_compiles_alone(tmp_path: Path, number: str) -> None:
    written(tmp_path, "c99", number, "wall")
    for line in ([tool("gcc"), *STRICT], [tool("g++"), "-std=gnu++11", *PEDANTIC, "-x", "c++"]):
        run(*line, "-O2", "-fsyntax-only", "-include", tmp_path / "wall.h", "/dev/null")


@pytest.mark.parametrize("target", ["c99", "arduino", "javascript"])
def test_the_header_names_its_proof(tmp_path: Path, target: str) -> None:
    """SHA-256 of the certificate's file, which the checker accepts; another byte has another one."""
    found = written(tmp_path / "law", target)
    certificate = tmp_path / "law" / "law.certificate.json"
    bytes_ = certificate.read_bytes()
    named = re.search(r'CERTIFICATE_SHA256 =? ?"([0-9a-f]{64})"', found.text)
    assert named[1] == sha256(bytes_).hexdigest() == found.certificate_sha256
    assert sha256(bytes_.replace(b"1", b"2", 1)).hexdigest() != named[1]
    assert main(["verify", str(certificate)]) == 0


def test_a_module_takes_a_reading_beyond_as_the_nearest(tmp_path: Path) -> None:
    found = emit(HAPKIT, WALL, target="javascript", travel="-3 .. 3 mm")
    most = int(found.machine.counts[1])
    rows, cells = np.array([[most], [10 * most], [most]]), np.zeros(found.machine.law.remembers)
    ran = run_node(law_in_javascript("law"), tmp_path, {"law": (rows, cells, 1)}, {"law.mjs": found.text})
    forces = ran["law"].outputs[:, 0]
    assert forces[0] == forces[1] == forces[2] > 0.0


def test_what_is_emitted_is_the_same_everywhere(tmp_path: Path) -> None:
    """Two processes, with other seeds of Python's hashes, write the same bytes."""
    code = (
        "import zwidth as zw; from zwidth.machine.firmware.emit import emit; import sys;"
        "d, wall, r = zw.catalogue.device('haptic-paddle'), zw.Wall(150, 0.05), zw.rendering;"
        "chain = zw.render(wall, r.PassivityController(), r.EventTransient());"
        "[emit(d, law, target=t, anyway=True).write(f'{sys.argv[1]}/{t}')"
        " for t, law in (('arduino', wall), ('cortex-m', chain), ('javascript', chain))]"
    )
    for seed in ("1", "2"):
        environment = {"PYTHONHASHSEED": seed, "PYTHONPATH": ":".join(sys.path), "PATH": "/usr/bin:/bin"}
        subprocess.run([sys.executable, "-c", code, str(tmp_path / seed)], env=environment, check=True)
    one, other = (
        {p.relative_to(tmp_path / s): p.read_bytes() for p in (tmp_path / s).rglob("*.*")} for s in "12"
    )
    assert one == other
    assert len(one) > 10
