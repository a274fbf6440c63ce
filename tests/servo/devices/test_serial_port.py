"""Serial ports that compiled code can read: pseudo-terminals stand for them."""

import os
import sys
import tty

import numpy as np
import pytest

from zwidth.errors import InputError
from zwidth.machine.servo.devices.serial_port import open_port
from zwidth.machine.servo.posix import read_some


@pytest.fixture
def terminal():
    near, far = os.openpty()
    tty.setraw(far)
    yield near, os.ttyname(far)
    os.close(far)


def test_nothing_yet_differs_from_a_closed_line(terminal):
    """−1 while nothing has come, −2 once the other side has closed; and the bytes between."""
    near, name = terminal
    port = open_port(name, 115_200)
    inbox = np.zeros(16, np.uint8)
    assert read_some(port.fileno(), inbox, 0) == -1
    os.write(near, b"some")
    while (count := read_some(port.fileno(), inbox, 0)) == -1:
        pass
    assert bytes(inbox[:count]) == b"some"
    os.close(near)
    assert read_some(port.fileno(), inbox, 0) == -2
    port.close()


def test_a_port_is_open_for_one_alone(terminal):
    near, name = terminal
    port = open_port(name, 115_200)
    with pytest.raises(InputError, match="in use"):
        open_port(name, 115_200)
    port.close()
    os.close(near)


@pytest.mark.parametrize(
    ("name", "said"), [("/dev/no-such-port", "there is no port"), ("/dev/null", "no serial port that can be")]
)
def test_what_is_no_port(name, said):
    with pytest.raises(InputError, match=rf"{said}.*\(.*\)"):
        open_port(name, 115_200)


def test_a_rate_that_is_none(terminal):
    near, name = terminal
    with pytest.raises(InputError, match="does not take -5 baud"):
        open_port(name, -5)
    os.close(near)


def test_without_pyserial_the_message_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "serial", None)
    with pytest.raises(InputError, match=r"install .*\[serve\]"):
        open_port("/dev/null", 9600)
