"""A simulated device with a hand, at one end of a line: stepped exactly, one sample at a time."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

import numpy as np

from zwidth.errors import InputError
from zwidth.links import Packet
from zwidth.links.port import Port
from zwidth.loop.kernel import R_COMMAND, R_READING
from zwidth.loop.pair.kernel import Arm, read, through
from zwidth.loop.pair.setup import prepare_pair
from zwidth.loop.pair.trace import build_pair_trace
from zwidth.loop.plant import FORCE, GOAL
from zwidth.loop.series import WORK
from zwidth.model.operator.operator import Operator
from zwidth.model.pairs import Pair
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import RealLike

if TYPE_CHECKING:
    import xarray as xr


@compiled
def _measure(arm: Arm, k: int) -> float:
    read(arm, k)
    return float(arm.readings[k])


@compiled
def _move(arm: Arm, k: int, f: float, h: float, final: bool, work: Array) -> None:
    arm.commands[k] = f
    arm.record[R_READING, k] = arm.readings[k]
    arm.record[R_COMMAND, k] = f
    through(arm, k, k, 1, h, final, work)


_CHANGED = ("state", "readings", "commands", "record")


class DeviceRun:
    """A device that a hand moves and a port drives.

    Parameters
    ----------
    port
        Of `zwidth.links`, with the device; its force is positive along x.
    hand
        What holds the device, see `zwidth.operators`.
    duration
        How long at most [s].
    line
        The name of the line that ends here.

    Raises
    ------
    InputError
        If the device has no mass, or the hand cannot be simulated.
    """

    def __init__(self, port: Port, hand: Operator, duration: RealLike, line: str) -> None:
        self.port, self.line = port, line
        # a pair lays out an arm; its spring and its other arm are not used
        self._setup = prepare_pair(
            Pair(port.device, port.device, stiffness=1),
            hand,
            None,
            duration,
            encoder_phase=(0.0, 0.0),
            amplifier=None,
            points_per_sample=1,
        )
        self._arm, other = self._setup.arms
        other.record[:] = 0.0
        self._arm.state[FORCE] = self._arm.state[GOAL] = 0.0
        self._work = np.zeros(WORK)
        self._k = 0
        arm = self._arm._replace(**{name: getattr(self._arm, name).copy() for name in _CHANGED})
        _measure(arm, 0)  # step functions are found in their library before the clock runs
        _move(arm, 0, 0.0, self._setup.tick, True, self._work)
        port.warm()

    @property
    def lines(self) -> tuple[str, ...]:
        """The one that ends here."""
        return (self.line,)

    @property
    def forces(self) -> dict[str, float]:
        """What the line gives the device in the last sample [N; N·m]."""
        return {self.line: self.port.force}

    def step(self, heard: Mapping[str, Iterable[Packet]] | None = None) -> dict[str, Packet]:
        """Hear, hold the force for a period while the hand moves on, and send.

        Raises
        ------
        InputError
            If the duration is over.
        """
        k, arm, setup = self._k, self._arm, self._setup
        if k >= setup.ticks:
            raise InputError(f"the device was simulated for {k} samples, which is all that it was given")
        reading = _measure(arm, k) if k == 0 else float(arm.readings[k])
        f = self.port.receive((heard or {}).get(self.line, ()))
        _move(arm, k, -f, setup.tick, False, self._work)  # a command is positive out of the wall
        self._k = k + 1
        return {self.line: self.port.send(_measure(arm, k + 1) - reading)}

    def trace(self) -> xr.Dataset:
        """What happened so far, as `zwidth.simulate` tells it of one arm of a pair."""
        _move(self._arm, self._k, 0.0, self._setup.tick, True, self._work)
        return build_pair_trace(self._setup, self._k + 1).dataset().sel(arm="leader")
