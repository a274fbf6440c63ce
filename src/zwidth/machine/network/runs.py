"""What a peer steps: a part of a scene, or a simulated device with a hand, exactly, one sample at a time.

Each line ends in a port of `zwidth.links`, whose device is the node with the line's own damper w: so no
energy is made by delay, loss, disorder or a peer that is gone, and what is late is felt late.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from zwidth.errors import InputError
from zwidth.links import Packet, WavePort
from zwidth.links.port import Port
from zwidth.loop.kernel import R_COMMAND, R_READING
from zwidth.loop.pair.kernel import Arm, read, through
from zwidth.loop.pair.setup import prepare_pair
from zwidth.loop.pair.simulate import build_pair_trace
from zwidth.loop.plant import FORCE, GOAL, WORK
from zwidth.model.device import Device
from zwidth.model.operator.operator import Operator
from zwidth.model.pairs import Pair
from zwidth.model.scene.element import Element
from zwidth.model.scene.parts import Part
from zwidth.model.scene.run import SceneRun
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import RealLike

if TYPE_CHECKING:
    import xarray as xr


class PartRun:
    """A part that is stepped, its lines open.

    Parameters
    ----------
    part
        Of a `Cut`.
    sample_period
        T > 0 of its steps [s]; the parts of a cut need not have the same.

    Raises
    ------
    InputError
        As `SceneRun`.
    """

    def __init__(self, part: Part, sample_period: RealLike) -> None:
        self.part = part
        # step functions are found in their library before the clock runs
        SceneRun(part.scene, sample_period).step()
        self._run = SceneRun(part.scene, sample_period)
        self.felt = 0.0
        """The mean force at the port of the scene over the last step, 0 without one [N; N·m]."""
        self.ports = {end.title: _port(end, sample_period) for end in part.ends}
        for port in self.ports.values():
            port.warm()

    def step(
        self, heard: Mapping[str, Iterable[Packet]] | None = None, move: float = 0.0
    ) -> dict[str, Packet]:
        """One step: the packets for the other ends; the force at the port of the scene is in `felt`.

        Parameters
        ----------
        heard
            Of each line, by its name, what has come since the last step; of a line left out nothing.
        move
            Of the scene's port, where this part has it [m; rad].
        """
        heard = heard or {}
        forces = {name: port.receive(heard.get(name, ())) for name, port in self.ports.items()}
        self.felt = self._run.step(move, forces)
        return {name: port.send(self._run.moved(name)) for name, port in self.ports.items()}

    @property
    def lines(self) -> tuple[str, ...]:
        """Those that end here."""
        return tuple(self.ports)

    @property
    def forces(self) -> dict[str, float]:
        """What each line gives its node in the last step [N; N·m]."""
        return {name: port.force for name, port in self.ports.items()}

    @property
    def positions(self) -> Mapping[str, float]:
        """Where every node of this part is [m; rad]."""
        return self._run.positions

    @property
    def velocities(self) -> Mapping[str, float]:
        """The velocity of every mass of this part [m/s; rad/s]."""
        return self._run.velocities

    def account(self) -> xr.Dataset:
        """Where the energy went, element by element; of a line what went into it."""
        return self._run.account()


def _port(end: Element, sample_period: RealLike) -> WavePort:
    """The port of a line: its device is the node with the line's damper."""
    w = end.resistance(Fraction(1))
    return WavePort(Device(damping=w, coulomb_friction=0, resolution=0, delay=0, sample_period=sample_period))


def run_parts(
    parts: Mapping[str, PartRun], moves: Iterable[float], late: Mapping[str, int] | None = None
) -> list[float]:
    """All parts in this process, step by step: the force at the port after each move.

    Parameters
    ----------
    parts
        By their names.
    moves
        Of the port at each step [m; rad].
    late
        Of each line, by its name, the steps that a packet is on its way, 1 or more; default 1.
    """
    late = late or {}
    for line in {line for run in parts.values() for line in run.ports}:
        ends = [run.ports[line] for run in parts.values() if line in run.ports]
        for port, far in zip(ends, reversed(ends), strict=True):
            port.meet(far.run)
    on_the_way: dict[tuple[str, str], list[tuple[int, Packet]]] = {}
    felt: list[float] = []
    for steps, move in enumerate(moves):
        sent: list[tuple[str, dict[str, Packet]]] = []
        for name, run in parts.items():
            heard = {
                line: [p for due, p in on_the_way.get((name, line), ()) if due == steps] for line in run.ports
            }
            own = bool(run.part.scene.port)
            sent.append((name, run.step(heard, move if own else 0.0)))
            if own:
                felt.append(run.felt)
        for name, packets in sent:
            for line, packet in packets.items():
                (other,) = (n for n, run in parts.items() if line in run.ports and n != name)
                queue = on_the_way.setdefault((other, line), [])
                queue[:] = [(due, p) for due, p in queue if due > steps]
                queue.append((steps + late.get(line, 1), packet))
    return felt


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
