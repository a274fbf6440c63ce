"""A pantograph of Haply by the maker's own package, at the same board as ours: setup, places and torques."""

from __future__ import annotations

import struct
from typing import Any

import HaplyHAPI as hapi
import pytest
from servo.drive import drive
from servo.emulators.haply import HaplyEmulator

from zwidth.machine.servo.devices.haply import HaplyPantograph

CW, CCW = 0, 1
JOINTS = {
    2: ((1, CCW, 2, 241, 10752), (2, CW, 1, -61, 10752)),
    3: ((1, CCW, 2, 168, 4880), (2, CCW, 1, 12, 4880)),
}
"""Joint, direction, port, angle at rest [degrees] and counts per turn, of the example of the package."""

RESET_AND_SETUP = 2 + 2 + 3 + 3 + 2 + 16


class Board(HaplyEmulator):
    """It keeps the bytes that it hears."""

    said = b""

    def hear(self, data: bytes) -> None:
        self.said += data
        super().hear(data)

    def torques(self, exchange: int) -> tuple[float, ...]:
        return struct.unpack_from("<2f", self.said, RESET_AND_SETUP + 10 * exchange + 2)


def by_their_package(board: Board, version: int, force: tuple[float, float]) -> list[float]:
    """The tip, to which the force is then given."""
    link = hapi.Board("", board.port, 115200)
    link._Board__port.timeout = 60.0
    device = hapi.Device(5, link)
    device.set_mechanism(hapi.Pantograph(version))
    for joint, way, port, angle, counts in JOINTS[version]:
        device.add_actuator(joint, way, port)
        device.add_encoder(joint, way, angle, counts, port)
    device.device_set_parameters()
    device.device_write_torques()
    device.device_read_data()
    tip = device.get_device_position(device.get_device_angles())
    device.set_device_torques(force)
    device.device_write_torques()
    device.device_read_data()
    return tip


@pytest.mark.parametrize("version", [2, 3])
@pytest.mark.parametrize("place", [(0.019, 0.09), (-0.02, 0.07), (0.06, 0.11)])
@pytest.mark.parametrize(("axis", "force"), [("x", 1.5), ("y", -0.7)])
def test_it_is_the_same(
    version: int, place: tuple[float, float], axis: str, force: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    ports: Any = {f"_Device__{kind}Positions": bytearray(4) for kind in ("actuator", "encoder")}
    for name, nothing in ports.items():  # which all devices of a process share
        monkeypatch.setattr(hapi.Device, name, nothing)
    which = "xy".index(axis)
    with Board(lambda exchange: place) as other:
        tip = by_their_package(other, version, (force, 0.0) if axis == "x" else (0.0, force))
    with Board(lambda exchange: place) as board:
        run = drive(HaplyPantograph(board.port, axis, version=version), 2, lambda x: force)
    assert board.said[:RESET_AND_SETUP] == other.said[:RESET_AND_SETUP]
    assert run.readings[0] == pytest.approx(tip[which], abs=1e-12)
    assert board.torques(2) == pytest.approx(other.torques(1), rel=1e-6, abs=1e-9)
