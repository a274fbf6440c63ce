"""Serve a device from beginning to end: measured, proved, rendered, recorded, and let go with force 0."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from os import PathLike
from pathlib import Path
from typing import Any

from zwidth.errors import InputError
from zwidth.machine.servo.connection import Connection, Placement
from zwidth.machine.servo.devices.simulated import Simulated
from zwidth.machine.servo.priority import RealTime
from zwidth.machine.servo.proving import Decide
from zwidth.machine.servo.recording.recorder import Recorder, check_recording
from zwidth.machine.servo.report import ServoReport
from zwidth.machine.servo.safety import Safety
from zwidth.machine.servo.session import Contact, Servo
from zwidth.model.device.device import Device
from zwidth.model.operator import usual_hand
from zwidth.model.operator.operator import Operator
from zwidth.quantity.exact import RealLike

Watch = Callable[[Servo], Callable[[], Any]]
"""Begins to look at a servo, and returns what ends that."""

_SIMULATED_FOR = "10 s"

_ENDING = ("SIGTERM", "SIGHUP")
"""Signals at which the force ends, besides Ctrl-C."""


def serve(
    device: Device,
    environment: object,
    connection: Connection | None = None,
    *,
    hand: Operator | None = None,
    duration: RealLike | None = None,
    safety: Safety | None = None,
    placement: Placement | None = None,
    contact: Contact = "made and broken",
    decide: Decide | None = None,
    real_time: RealTime | None = None,
    anyway: bool = False,
    record: str | PathLike[str] | None = None,
    force: bool = False,
    watch: tuple[Watch, ...] = (),
) -> ServoReport:
    """Render a law on a device in real time, until the time is over, Ctrl-C, or a fault.

    First the loop runs for a second with force 0, to measure this machine and the link; the law is judged
    with the delay found, and one that is not proved passive is refused.  It begins where its force is near 0.

    Parameters
    ----------
    device, environment
        As of `zwidth.check`: what is claimed of them is what is served.
    connection
        How the device is reached, see `servo.devices`; None: the device itself, simulated.
    hand
        What holds the simulated device, see `zwidth.operators`; by default that of `usual_hand`: a finger, or
        fingers on a knob, or two hands on a wheel.
    duration
        How long [s]; None: until it is ended; a simulated device for 10 s.
    safety, placement, contact, decide, real_time
        As of `Servo`.
    anyway
        Also what is not proved passive.
    record
        A file that ends in .mcap, written while the loop runs.
    force
        Replace that file if it exists.
    watch
        Each is called with the servo before it starts, and what it returns when it has ended.

    Returns
    -------
    ServoReport

    Raises
    ------
    InputError
        If the device cannot be reached or does not answer, the law is not proved passive, or the file
        cannot be written.
    """
    if record is not None:
        check_recording(Path(record), force)
    if connection is None:
        length = _SIMULATED_FOR if duration is None else duration
        held = usual_hand(device) if hand is None else hand
        connection = Simulated(device=device, hand=held, duration=length)
    elif hand is not None:
        raise InputError("a hand is scripted for the simulated device; a real one is held by a person")
    with ExitStack() as open_things:
        servo = open_things.enter_context(
            Servo(
                device,
                environment,
                connection,
                safety=safety,
                placement=placement,
                contact=contact,
                decide=decide,
                real_time=real_time,
            )
        )
        open_things.enter_context(ended_by_signals(servo))
        servo.prove(anyway=anyway)
        recorder = None
        if record is not None:
            recorder = open_things.enter_context(Recorder(servo.rows, record, force=force))
        for begin in watch:
            open_things.callback(begin(servo))
        open_things.callback(servo.close)
        servo.start(duration, anyway=anyway)
        wait(servo)
        return replace(servo.report(), recorded=None if recorder is None else recorder.close())


def wait(servo: Servo) -> None:
    """Wait for the end; at Ctrl-C ask for it."""
    try:
        servo.wait()
    except KeyboardInterrupt:
        servo.stop()
        servo.wait()


@contextmanager
def ended_by_signals(servo: Servo) -> Iterator[None]:
    """Inside, a signal that asks the program to end asks the loop to."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    found = [getattr(signal, name) for name in _ENDING if hasattr(signal, name)]
    before = {number: signal.signal(number, lambda *_: servo.stop()) for number in found}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
