"""The Haply Inverse service, emulated over a real socket."""

import socket
from threading import Thread

import pytest
from servo.drive import drive, drive_into
from servo.emulators.faults import Fault
from servo.emulators.inverse import InverseEmulator

from zwidth.errors import InputError
from zwidth.machine.servo.connection import FORCE, GOOD, INDEX, READING, SILENT, STALE, UNTIL
from zwidth.machine.servo.devices import websocket
from zwidth.machine.servo.devices.inverse import Inverse

OPENING = 1
"""Exchanges that opening makes: measurement k reads the answer of exchange k + 1."""

AT = 21


def wall(reading):
    return -300.0 * max(0.0, reading - 0.010)


def served(service, periods, **options):
    return drive(Inverse(address=service.address, axis="z"), periods, wall, **options)


def answered(service, periods):
    return [position["z"] for position in service.positions[OPENING : OPENING + periods]]


@pytest.mark.parametrize(
    ("padding", "parts"), [(0, 1), (100, 3), (40_000, 1), (64_000, 1), (64_000, 7), (65_200, 1), (100_000, 1)]
)
def test_long_and_split_messages(padding, parts):
    """Of one frame in any of the three forms of its length, and of several."""
    with InverseEmulator(padding=padding, parts=parts) as service:
        run = served(service, 40)
    assert run.statuses == [GOOD] * 40
    assert run.readings == answered(service, 40)


def test_a_ping_is_answered():
    with InverseEmulator() as service:
        service.ping_before = AT
        run = served(service, 40)
    assert run.statuses == [GOOD] * 40
    assert service.pongs == [b"are you there"]


def test_one_of_several_devices_is_driven():
    with InverseEmulator(devices=("04BA", "049D")) as service:
        run = drive(Inverse(address=service.address, device="049D"), 20, wall)
    assert run.readings == answered(service, 20)


@pytest.mark.parametrize(("axis", "reading"), [("x", 0.0125), ("y", -0.12)])
def test_the_axis_is_the_one_asked_for(axis, reading):
    with InverseEmulator() as service:
        run = drive(Inverse(address=service.address, axis=axis), 5, lambda reading: 0.25)
    assert run.readings == [reading] * 5
    assert service.others[3] == {"x": 0, "y": 0, axis: 0.25}
    assert all(command.force == 0 for command in service.commands)


def test_behind_a_pause_the_position_is_asked_for_anew():
    """A loop that missed samples, or begins again: the answer to its last force is old, and is not read."""
    with InverseEmulator() as service:
        memory, inbox, outbox = (connection := Inverse(address=service.address)).open(1e-3)
        found = []
        for index in (0, 1, 2, 5, 6, 0, 1):
            memory[INDEX], memory[UNTIL], memory[FORCE] = index, 2.0**62, 0.5
            assert Inverse.measure(memory, inbox, outbox) == GOOD
            found.append(memory[READING])
            Inverse.apply(memory, inbox, outbox)
        connection.close()
    # exchange 0 is that of opening; the first sample, and those behind a pause, ask for themselves
    assert found == [service.positions[exchange]["z"] for exchange in (1, 2, 3, 5, 6, 8, 9)]


def test_an_answer_that_never_comes_ends_the_run():
    """Nothing in a state says which message it answers: with one missing, all that follow may be old."""
    expected = [GOOD] * (AT - OPENING) + [SILENT, STALE]

    def attempt(wait):
        with InverseEmulator(Fault.SILENCE, AT) as service:
            service.until = AT + 1
            return service, served(service, 40, wait=wait)

    service, run = drive_into(expected, attempt)
    assert run.statuses == expected
    assert service.commands[-1].force == 0.0


@pytest.mark.parametrize("number", [1, 3])
def test_a_device_that_the_service_finds_late_is_served(monkeypatch, number):
    """An empty list is asked for again, as the public clients of the service do."""
    monkeypatch.setattr("zwidth.machine.servo.devices.inverse._BETWEEN", 0.0)
    with InverseEmulator(devices=()) as service:
        service.found_when_asked = number
        run = served(service, 20)
    assert run.statuses == [GOOD] * 20
    assert service.asked_again == number


@pytest.mark.parametrize(
    ("options", "asked", "said"),
    [
        ({"devices": ()}, {}, "no Inverse"),
        ({"devices": ("04BA", "049D")}, {}, "several devices; give one of 04BA, 049D"),
        ({}, {"device": "0000"}, "no device '0000', but 049D"),
        ({"status": {"calibrated": False, "ready": False}}, {}, "not ready"),
        ({"scale": 2}, {}, "scales the positions"),
        ({"greeting": b'{"hello": "world"}'}, {}, "no Inverse"),
        ({"greeting": b"hello"}, {}, "no list of devices"),
        ({"greeting": b"[1, 2]"}, {}, "no list of devices"),
        ({"greeting": b'{"inverse3": [{"device_id": "0", "config": 3}]}'}, {}, "not understood"),
    ],
)
def test_what_cannot_be_served_is_refused_at_once(monkeypatch, options, asked, said):
    monkeypatch.setattr("zwidth.machine.servo.devices.inverse._BETWEEN", 0.0)
    with InverseEmulator(**options) as service, pytest.raises(InputError, match=said):
        Inverse(address=service.address, **asked).open(1e-3)


def test_a_service_that_answers_no_force_is_refused(monkeypatch):
    """It has greeted: only what it is asked then is waited for, and not for long."""
    connect = websocket.connect

    def connected(*place):
        found = connect(*place)
        monkeypatch.setattr("zwidth.machine.servo.devices.inverse._ANSWER_TIME", 0.1)
        return found

    monkeypatch.setattr(websocket, "connect", connected)
    with InverseEmulator(Fault.SILENCE) as service, pytest.raises(InputError, match="no answer in time"):
        Inverse(address=service.address).open(1e-3)


def test_nobody_and_somebody_else_listening():
    with socket.create_server(("127.0.0.1", 0)) as listener:
        address = f"127.0.0.1:{listener.getsockname()[1]}"

        def answer():
            line, _ = listener.accept()
            with line:
                line.recv(4096)
                line.sendall(b"HTTP/1.1 404 Not Found\r\n\r\n")

        other = Thread(target=answer)
        other.start()
        with pytest.raises(InputError, match=f"{address}/ is no WebSocket"):
            Inverse(address=address).open(1e-3)
        other.join()
    for nowhere in (address, "no..host:10001"):
        with pytest.raises(InputError, match=f"nothing answers at ws://{nowhere}"):
            Inverse(address=nowhere).open(1e-3)


@pytest.mark.parametrize(
    "options", [{"axis": "w"}, {"address": "localhost"}, {"address": ":1"}, {"address": "a:0"}]
)
def test_an_axis_or_address_that_is_none(options):
    with pytest.raises(InputError, match=r"must be (x, y or z|host:port)"):
        Inverse(**options)


def test_what_it_says_of_itself():
    """The filters of the service, which no certificate covers, once known; closing is always allowed."""
    with InverseEmulator() as service:
        connection = Inverse(address=service.address)
        connection.close()
        connection.open(1e-3)
        text = connection.describe()
        connection.close()
        connection.close()
    assert all(part in text for part in ("049D", "force_gate", "no certificate covers", "emulator"))
    assert "not documented" in connection.on_silence
