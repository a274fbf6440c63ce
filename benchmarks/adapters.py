"""Every adapter against an emulator of the other side: does a fault end the force, and how soon?

    python benchmarks/adapters.py              10 000 exchanges of each, and every fault; about a minute

Of each adapter and fault: what became of the first bad exchange, for how many periods the force was held
after it before 0 was given, and the last force that the other side was told to give.  The limit is
two periods.  The emulators are those of the tests, over pseudo-terminals and a socket.
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))

from servo.drive import drive
from servo.emulators.dynamixel import DynamixelEmulator
from servo.emulators.faults import Emulator, Fault
from servo.emulators.feetech import FeetechEmulator
from servo.emulators.hapkit import HapkitEmulator
from servo.emulators.haply import HaplyEmulator
from servo.emulators.inverse import InverseEmulator
from servo.emulators.moteus import MoteusEmulator
from servo.emulators.odrive import ODriveEmulator

from zwidth.machine.servo.connection import GOOD, STATUS
from zwidth.machine.servo.devices import Dynamixel, Feetech, Hapkit, HaplyPantograph, Inverse, Moteus, ODrive

AT = 60
"""Exchange from which the other side is wrong."""

NAMES = ["good", "silent", "garbled", "stale", "refused", "closed"]


class Side(NamedTuple):
    """An adapter and the emulator of what it speaks to."""

    name: str
    emulator: Callable[[Fault | None], Any]
    adapter: Callable[[Any], Any]
    force: float


def sides(cycles: int) -> list[Side]:
    """Every adapter whose other side sends bytes."""
    long = cycles + 200
    turns = [0.4 * math.sin(0.013 * k) for k in range(long)]
    counts = [2048 + round(700 * math.sin(0.013 * k)) for k in range(long)]
    return [
        Side(
            "Inverse",
            lambda fault: InverseEmulator(fault, AT),
            lambda e: Inverse(address=e.address),
            1,
        ),
        Side(
            "Haply 2DIY",
            lambda fault: HaplyEmulator(fault=fault, at=2 * AT + 1),
            lambda e: HaplyPantograph(e.port),
            0.5,
        ),
        Side(
            "Hapkit",
            lambda fault: HapkitEmulator(fault=fault, at=AT),
            lambda e: Hapkit(e.port, 1e-5),
            0.5,
        ),
        Side(
            "moteus",
            lambda fault: MoteusEmulator(turns, fault, AT, checksums=True),
            lambda e: Moteus(e.port, checksums=True),
            0.3,
        ),
        Side("ODrive", lambda fault: ODriveEmulator(fault, AT), lambda e: ODrive(port=e.port), 0.003),
        Side(
            "Dynamixel",
            lambda fault: DynamixelEmulator(counts, fault, AT),
            lambda e: Dynamixel(e.port, torque_per_current=1.3),
            0.3,
        ),
        Side(
            "Feetech",
            lambda fault: FeetechEmulator(counts, fault, AT),
            lambda e: Feetech(e.port, full_duty_torque=2.0),
            0.3,
        ),
    ]


def clean(side: Side, cycles: int) -> str:
    """How long an exchange takes with the emulator, and how many were not good."""
    with side.emulator(None) as other:
        begun = time.perf_counter()
        run = drive(side.adapter(other), cycles, lambda reading: side.force)
        took = time.perf_counter() - begun
    bad = sum(status != GOOD for status in run.statuses)
    return f"{len(run.statuses)} exchanges, {bad} not good, {1e6 * took / len(run.statuses):.0f} µs each"


def faulty(side: Side, fault: Fault) -> tuple[str, bool]:
    """What became of a fault, and whether the force ended within two periods where it had to."""
    with side.emulator(fault) as other:
        checked = type(other).with_wrong_checksum is not Emulator.with_wrong_checksum
        if fault is Fault.WRONG_CHECKSUM and not checked:
            return "it has none", True
        run = drive(side.adapter(other), 400, lambda reading: side.force, wait=0.2)
    last = other.commands[-1].force  # now it has heard all
    bad = [status for status in run.statuses if status != GOOD]
    if not bad:
        return "no fault to it", fault in (Fault.DUPLICATE, Fault.SLOW)
    told = f"{NAMES[bad[0]]}, held {run.zeroed_after}"
    ended = run.zeroed_after is not None and run.zeroed_after <= 2 and run.forces[-1] == 0
    if fault is Fault.CLOSED:
        return told, ended
    return f"{told}, told {last:g}", ended and last == 0


def main() -> int:
    """Print the tables; 1 if a force went on."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--cycles", type=int, default=10_000)
    cycles = parser.parse_args().cycles
    assert len(NAMES) == len(STATUS)
    failed = []
    for side in sides(cycles):
        print(f"{side.name}: {clean(side, cycles)}")
        for fault in Fault:
            told, fine = faulty(side, fault)
            print(f"  {fault:16} {told}{'' if fine else '   <-- the force went on'}")
            failed += [] if fine else [(side.name, fault)]
    print(f"\n{len(failed)} of {len(sides(1)) * len(Fault)} let a force go on")
    return bool(failed)


if __name__ == "__main__":
    sys.exit(main())
