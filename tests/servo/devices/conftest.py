"""No answer that comes is missed: a machine that stands still for seconds is no device that is silent."""

import pytest
from servo.drive import PATIENCE

SECONDS = ("inverse._ANSWER_TIME", "odrive._ANSWER_TIME", "odrive._START_TIME", "moteus._START_TIME")
NANOSECONDS = (
    "serial_port._WAIT",
    "hapkit._BOOT",
    "hapkit._ONE_TRY",
    "haply._FIRST_ANSWER",
    "moteus._ONE_TRY",
)


@pytest.fixture(autouse=True)
def _patience(monkeypatch: pytest.MonkeyPatch) -> None:
    """So long may a device take to answer when it is opened; where none answers, a test gives less."""
    for name in SECONDS:
        monkeypatch.setattr(f"zwidth.machine.servo.devices.{name}", PATIENCE)
    for name in NANOSECONDS:
        monkeypatch.setattr(f"zwidth.machine.servo.devices.{name}", int(1e9 * PATIENCE))
