"""Force Dimension devices, through the maker's own library: one axis of the tip, the others without force.

    dhdOpen / dhdOpenID, dhdGetPosition [m], dhdSetForce [N], dhdEnableForce, dhdSetTimeGuard, dhdSetWatchdog,
    dhdClose

of the Force Dimension SDK 3.16, as the Python package forcedimension-core calls them.  The time guard, which
answers a question that comes too soon with an older position, is turned off; the watchdog of the device's
firmware, in steps of 125 µs, is set where the device has one.
"""

from __future__ import annotations

import importlib
import importlib.util
import io
import math
from contextlib import redirect_stderr
from typing import Any, ClassVar, Literal

from zwidth import installing
from zwidth.errors import InputError
from zwidth.machine.servo.connection import (
    GARBLED,
    GOOD,
    LEAVES,
    REFUSED,
    SETS,
    SILENT,
    STALE,
    TELLS,
    LibraryConnection,
    Setting,
)
from zwidth.machine.servo.posix import now
from zwidth.quantity.parameter import one_of
from zwidth.quantity.text import shown

_PACKAGE = "forcedimension_core"
_STEPS = 160
"""Of 125 µs each, of the watchdog; 255 are the most."""

WATCHDOG = _STEPS * 125e-6
"""[s]."""

_TIME_GUARD = 1
"""What `getPosition` returns where it did not ask the device."""


class ForceDimension(LibraryConnection):
    """The tip of an omega, delta, sigma or another device of Force Dimension, along one axis [m, N].

    Parameters
    ----------
    axis
        "x", "y" or "z", as in the device's manual: x towards the user, y to the right, z up.
    index
        Which of the devices that are connected, from 0; None: the first that is free.
    simulator
        True to look for the maker's simulator, on this machine, in the place of a device.
    """

    motion: ClassVar[Literal["linear", "rotary"]] = "linear"
    maker: ClassVar[str] = "Force Dimension SDK 3.16, by forcedimension-core 1.0.0"
    settings: ClassVar[tuple[Setting, ...]] = (
        ("dhdSetTimeGuard", "on", "delay: a question that comes soon gets an older position", SETS,
         "dhd.expert.setTimeGuard"),
        ("dhdSetWatchdog", "", "end: 20 ms without a force", SETS, "dhd.expert.setWatchdog"),
        ("whether there is a watchdog", "", "end: without one the last force stays", TELLS,
         "dhd.expert.setWatchdog"),
        ("dhdEnableForce", "off", "whether there is a force; off in the end", SETS, "dhd.enableForce"),
        ("dhdSetGravityCompensation", "", "size: a force of the library's own is added", LEAVES,
         "dhd.setGravityCompensation"),
        ("dhdSetMaxForce", "none", "size: |F| is at most this", LEAVES, "dhd.setMaxForce"),
        ("motors at their limit", "", "size: the whole force is scaled down", LEAVES, "dhd.setForce"),
        ("dhdSetVelocityThreshold", "of the device", "end: faster, and the force is turned off", LEAVES,
         "dhd.expert"),
        ("dhdSetDeviceAngleRad", "0", "sign: which way x, y, z are", LEAVES, "dhd.setDeviceAngleRad"),
    )  # fmt: skip

    def __init__(self, axis: str = "x", *, index: int | None = None, simulator: bool = False) -> None:
        self.axis = one_of("axis", axis, "x", "y", "z")
        if index is not None and not (isinstance(index, int) and index >= 0):
            raise InputError(
                f"index is a whole number ≥ 0, got {index!r}: devices are counted from 0; leave it out "
                "for the first that is free"
            )
        self.index, self.simulator = index, simulator
        self._place = "xyz".index(axis)
        self._dhd: Any = None
        self._device = -1
        self._name = ""
        self._watched: bool | None = None
        self._refused = False
        self._force, self._given = 0.0, 0
        self._position = [0.0, 0.0, 0.0]

    @property
    def on_silence(self) -> str:
        """By its firmware, where it has a watchdog."""
        cut = f"turns its force off after {shown(WATCHDOG, 's')} without a command"
        if self._watched is None:
            return f"{cut}, if its firmware has a watchdog"
        return cut if self._watched else "holds the last force: its firmware has no watchdog"

    def open(self, sample_period: float) -> None:
        if 2 * sample_period >= WATCHDOG:
            raise InputError(
                f"the sample period must be below {shown(WATCHDOG / 2, 's')}, got "
                f"{shown(sample_period, 's', 6)}: the device turns its force off after two that long"
            )
        dhd = self._dhd = _library()
        dhd.enableSimulator(self.simulator)
        self._device = dhd.open() if self.index is None else dhd.openID(self.index)
        if self._device < 0:
            self._dhd = None
            raise InputError(
                f"no device of Force Dimension can be opened: {dhd.errorGetLastStr()}; is it plugged in and "
                "switched on, free of other programs, and may this user reach USB devices (udev rules)?"
            )
        self._name = dhd.getSystemName(self._device) or "device"
        self._refused, self._force, self._given = False, 0.0, now()
        self._set_guards()
        ready = self.apply(0.0) == GOOD and dhd.enableForce(True, self._device) == 0
        if not ready or self.measure(now() + 10**9)[0] != GOOD:
            reason = dhd.errorGetLastStr()
            self.close()
            raise InputError(
                f"the {self._name} was opened, and then gives no position or takes no force: {reason}; "
                "calibrate it as its manual says (the light stops blinking), and release its force button"
            )

    def _set_guards(self) -> None:
        expert = self._dhd.expert
        expert.enableExpertMode()
        expert.setTimeGuard(0, self._device)
        self._watched = expert.setWatchdog(_STEPS, self._device) == 0
        expert.disableExpertMode()

    def measure(self, until: int) -> tuple[int, float]:
        """As of every connection; the library itself waits for the device, however long."""
        if self._refused:
            return REFUSED, math.nan
        became = self._dhd.getPosition(self._position, self._device)
        position = self._position[self._place]
        if became == _TIME_GUARD:
            return STALE, position
        if became < 0:
            return REFUSED, math.nan
        if not all(map(math.isfinite, self._position)):
            return GARBLED, math.nan
        return (SILENT if now() > until else GOOD), position

    def apply(self, force: float) -> int:
        """As of every connection; a force that the device does not take is told at the next question."""
        self._after_a_pause()
        wanted = [0.0, 0.0, 0.0]
        wanted[self._place] = force
        self._force, self._given = force, now()
        if self._dhd.setForce(wanted, self._device) < 0:
            self._refused = True
        return REFUSED if self._refused else GOOD

    def _after_a_pause(self) -> None:
        """The watchdog has turned the force off: a fault, unless there was none to turn off."""
        if now() - self._given < 1e9 * WATCHDOG or not self._watched:
            return
        if self._force != 0.0:
            self._refused = True
        else:
            self._dhd.enableForce(True, self._device)

    def close(self) -> None:
        if self._dhd is None:
            return
        self.apply(0.0)
        self._dhd.enableForce(False, self._device)
        self._dhd.close(self._device)
        self._dhd = None

    def describe(self) -> str:
        """Which device, over what, which axis: one line."""
        name = f"{self._name} of Force Dimension" if self._name else "device of Force Dimension"
        return f"{name}, {self.axis} of its tip; when the program stops it {self.on_silence}"


def _library() -> Any:
    """The package's module of the maker's functions."""
    if importlib.util.find_spec(_PACKAGE) is None:
        what = "the package that calls the library of Force Dimension"
        raise installing.needed(what, package="forcedimension-core")
    said = io.StringIO()
    try:
        with redirect_stderr(said):
            return importlib.import_module(f"{_PACKAGE}.dhd")
    except ImportError as error:
        reason = " ".join(said.getvalue().split()) or str(error)
        raise InputError(
            f"forcedimension-core cannot load the library of Force Dimension ({reason}); install the Force "
            "Dimension SDK 3.16 or later of www.forcedimension.com, and set FDSDK to its folder"
        ) from None
