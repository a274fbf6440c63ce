"""A device of Force Dimension: the real package over a library made here; what is said where one lacks."""

import ctypes
import importlib
import math
import re
import sys
from types import SimpleNamespace

import pytest
from servo.drive import drive
from servo.emulators.force_dimension import (
    COMPILER,
    PACKAGE,
    SOURCE,
    Device,
    Failure,
    built,
    forget,
    installed,
)

from zwidth.errors import InputError
from zwidth.machine.servo.connection import GARBLED, GOOD, REFUSED, SILENT, STALE
from zwidth.machine.servo.devices.force_dimension import ForceDimension


@pytest.fixture(scope="module")
def sdk(tmp_path_factory):
    if PACKAGE is None or COMPILER is None or sys.platform != "linux":
        pytest.skip("needs the package forcedimension-core, a C compiler, and Linux for the library's name")
    folder = built(tmp_path_factory.mktemp("sdk"))
    with installed(folder):
        yield folder


@pytest.fixture(autouse=True)
def clock(monkeypatch):
    """Stands still, or a busy machine would be a device that is late."""
    found = SimpleNamespace(time=lambda: 0)
    monkeypatch.setattr("zwidth.machine.servo.devices.force_dimension.now", lambda: found.time())
    return found


def path(count):
    return [(1e-5 * k, 0.01 + 2e-5 * k, -0.02 - 3e-5 * k) for k in range(count)]


@pytest.fixture
def device(sdk):
    found = Device(sdk)
    found.move(path(300))
    return found


@pytest.mark.parametrize("axis", ["x", "y", "z"])
def test_two_thousand_exchanges(sdk, axis):
    place = "xyz".index(axis)
    device = Device(sdk)
    device.move(path(2_002))
    run = drive(ForceDimension(axis), 2_000, lambda x: 5.0 * x)
    assert run.statuses == [GOOD] * 2_000
    assert run.readings == [place_of[place] for place_of in path(2_001)[1:]]
    expected = [0.0, *run.forces, 0.0, 0.0]
    assert [force[place] for force in device.forces] == expected
    assert all(force[other] == 0.0 for force in device.forces for other in range(3) if other != place)


def test_what_the_device_is_told_besides(device):
    """No time guard, 20 ms in steps of 125 µs for the watchdog, force enabled; all let go at the end."""
    connection = ForceDimension("x", index=2, simulator=True)
    assert "if its firmware has a watchdog" in connection.on_silence
    connection.open(1e-3)
    told = {"opened": 2, "watchdog": 160, "time_guard": 0, "force_enabled": 1, "simulator": 1}
    assert device.state == {**told, "enablings": 1}
    assert connection.describe().startswith("omega.3 of Force Dimension, x of its tip")
    assert "off after 20 ms" in connection.on_silence
    connection.close()
    connection.close()
    assert (device.state["opened"], device.state["force_enabled"]) == (-1, 0)
    assert device.forces[-1] == (0.0, 0.0, 0.0)


def test_the_library_made_here_has_the_types_of_the_maker_s(sdk):
    """As the package declares them: of every function that is made here, what goes in and what comes out."""
    kinds = {"int": ctypes.c_int, "bool": ctypes.c_bool, "double": ctypes.c_double, "void": None}
    kinds |= {"signed char": ctypes.c_byte, "unsigned char": ctypes.c_ubyte, "const char *": ctypes.c_char_p}
    declared = importlib.import_module("forcedimension_core.runtime")._libdhd
    made = re.findall(r"^(\w.*?)\s?\b(dhd\w+)\((.*?)\) {", SOURCE.read_text(encoding="utf-8"), re.M)
    assert len(made) == 15
    for result, name, arguments in made:
        function = getattr(declared, name)
        assert function.restype is kinds[result], name
        taken = [getattr(one, "_type_", one) if "LP_" in one.__name__ else one for one in function.argtypes]
        given = [re.sub(r" \*?\w+$", "", one) for one in arguments.split(", ") if one != "void"]
        assert taken == [kinds[one] for one in given], name
        pointers = ["LP_" in one.__name__ for one in function.argtypes]
        assert pointers == ["*" in one for one in arguments.split(", ")][: len(given)], name


def test_a_device_without_a_watchdog_is_said_to_have_none(sdk):
    Device(sdk, watchdog=False).move(path(1))
    connection = ForceDimension()
    connection.open(1e-3)
    assert "no watchdog" in connection.on_silence
    connection.close()


@pytest.mark.parametrize(
    ("failure", "statuses"),
    [
        (Failure.CLOSED, [REFUSED]),
        (Failure.GARBAGE, [GARBLED, GARBLED]),
        (Failure.LATE, [STALE, STALE]),
        (Failure.FORCE_REFUSED, [GOOD, REFUSED]),
    ],
)
def test_a_fault_is_told_and_ends_in_no_force(device, failure, statuses):
    """A force that is not taken is told with the next position."""
    first = 50 - (failure is Failure.FORCE_REFUSED)
    device.fail(failure, 51)
    run = drive(ForceDimension(), 200)
    assert run.statuses == [GOOD] * first + statuses
    assert run.zeroed_after in (0, 1)
    if failure not in (Failure.CLOSED, Failure.FORCE_REFUSED):
        assert device.forces[-3:] == [(0.0, 0.0, 0.0)] * 3
    assert device.state["force_enabled"] == 0


def test_a_library_that_answers_too_late(device, clock):
    """The position has missed its sample; after so long the watchdog has cut the force besides."""
    clock.time = lambda: 10**18 if device.asked > 51 else 0
    run = drive(ForceDimension(), 200)
    assert run.statuses == [GOOD] * 50 + [SILENT, REFUSED]
    assert run.zeroed_after == 1
    assert device.forces[-3:] == [(0.0, 0.0, 0.0)] * 3


def test_a_motor_at_its_limit_is_no_fault(device):
    """The device scales the force: it is for the loop's own bound to be below that."""
    run = drive(ForceDimension(), 5, lambda x: 20.0)
    assert run.statuses == [GOOD] * 5
    assert device.forces[1] == (20.0, 0.0, 0.0)


@pytest.mark.parametrize(("force", "status"), [(0.0, GOOD), (1.0, REFUSED)])
def test_after_a_pause(device, clock, force, status):
    """The watchdog has turned the force off: it is turned on again only where it was 0."""
    connection = ForceDimension()
    connection.open(1e-3)
    connection.apply(force)
    clock.time = lambda: 10**9
    assert connection.apply(0.0) == status
    assert connection.measure(10**9)[0] == status
    assert device.state["enablings"] == (2 if status == GOOD else 1)
    connection.close()


def test_no_device(sdk):
    Device(sdk, present=False)
    with pytest.raises(InputError, match=r"no device found; is it plugged in"):
        ForceDimension().open(1e-3)


def test_a_device_that_gives_no_position(device):
    device.move([(math.nan, 0.0, 0.0)])
    with pytest.raises(InputError, match=r"omega\.3 was opened.*calibrate"):
        ForceDimension().open(1e-3)
    assert (device.state["opened"], device.state["force_enabled"]) == (-1, 0)


def test_the_package_is_missing(monkeypatch):
    forget()
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    with pytest.raises(InputError, match="install forcedimension-core"):
        ForceDimension().open(1e-3)


@pytest.mark.skipif(PACKAGE is None, reason="needs the package forcedimension-core")
def test_the_library_is_missing(monkeypatch, tmp_path):
    """The package says why, and is quiet on the terminal; what to install stands with it."""
    forget()
    monkeypatch.setenv("FDSDK", str(tmp_path))
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setattr("glob.glob", lambda pattern, **options: [])
    monkeypatch.setattr("os.path.isfile", lambda path: False)
    with pytest.raises(InputError, match=r"cannot load the library.*SDK 3\.16"):
        ForceDimension().open(1e-3)
    forget()


@pytest.mark.parametrize("arguments", [{"axis": "w"}, {"index": -1}, {"index": 1.0}])
def test_what_is_no_axis_or_index_is_refused(arguments):
    with pytest.raises(InputError):
        ForceDimension(**arguments)
