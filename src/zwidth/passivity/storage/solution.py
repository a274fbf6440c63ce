"""The available storage of one loop: a storage function proves it passive, or a motion gains."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from zwidth.device.device import Device
from zwidth.device.friction import FrictionCurve
from zwidth.environment.environment import Environment
from zwidth.environment.transfer_function import as_environment
from zwidth.errors import InputError
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.outcome import Outcome
from zwidth.passivity.result import PassivityAnswer
from zwidth.passivity.scope import Scope
from zwidth.passivity.storage.evidence.coarse import CELLS
from zwidth.passivity.storage.evidence.gain import Gain
from zwidth.passivity.storage.evidence.storage_function import StorageFunction
from zwidth.passivity.storage.program import FINE, STEPS, DynamicProgram, program_of, program_scope
from zwidth.passivity.storage.row.program import RowProgram
from zwidth.passivity.storage.slow_hands import slow_hands
from zwidth.passivity.storage.solve.value_iteration import Progress
from zwidth.passivity.wording import claim_of_passivity
from zwidth.quantity.exact import RealLike

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True, repr=False)
class AvailableStorage(PassivityAnswer):
    """The most that a hand can take out of one loop, contact made and broken, the encoder as it is.

    Attributes
    ----------
    outcome
        "passive": a storage function proves that no motion within the domain gains.
        "active": a motion gains in every round.  "undecided": neither was found.
    scope
        What it is about: the hands, within which bounds; contact; what of the actuator is counted.
    device, environment
        The loop.
    certificate
        The proof; None unless passive.
    witness
        The motion that gains; None unless active.
    storage
        The storage function, to look at; None unless passive.
    """

    FORMAT = "zwidth worst hand 1"
    PICTURE = "storage"

    outcome: Outcome
    scope: Scope
    device: Device
    environment: Environment
    certificate: Certificate | None
    witness: Gain | None
    storage: StorageFunction | None

    @property
    def claim(self) -> str:
        """The outcome in a sentence."""
        if self.outcome == "passive":
            return claim_of_passivity(self.scope, False)
        if self.witness is not None:
            return f"A motion of the hand takes energy out of this loop: {self.witness.describe()}."
        return "Neither a proof nor a motion was found: finer steps, or more time, may decide."

    def figure(self) -> Any:
        """The storage function; of an active loop the motion."""
        return super().figure() if self.witness is None else self.witness.figure()

    def available_storage(self) -> xr.DataArray:
        """V(x) for each reading before [J]: the most that a hand can take out from there.

        Raises
        ------
        InputError
            If the loop is not passive: a hand can take out without end.
        """
        if self.outcome == "passive" and self.storage is None:
            raise InputError(
                "there is no available storage to give: a closed form proves this loop passive, and V "
                "was not computed; give a smaller penetration"
            )
        if self.storage is None:
            raise InputError(
                f"there is no available storage: the loop is {self.outcome}, and what a hand can take out "
                "of an active loop has no bound"
            )
        return self.storage.to_xarray()


def available_storage(
    device: Device,
    environment: Environment | Any,
    *,
    penetration: RealLike | None = None,
    speed: RealLike | None = None,
    force_limit: bool = False,
    force_resolution: bool = False,
    friction: FrictionCurve | None = None,
    seconds: float = 60.0,
    progress: Progress | None = None,
    backend: str = "cpu",
) -> AvailableStorage:
    """The most energy that a hand can take out of one loop, by dynamic programming.

    State: position, and what the law remembers.  Move: Δx in one sample.  Reward:

        −f Δx − f_c |Δx| − (b/T) Δx²

    The loop is passive exactly if no cycle of moves gains.  Then the most that can
    be taken out from each state, V, is finite, and V(s) ≥ reward + V(s') for every
    move is the proof.

    Parameters
    ----------
    device
        Without intervals, with an encoder (Δ > 0); for a law that relaxes, a delay of whole samples.
    environment
        A law that remembers a few readings: walls with or without damping, windows,
        finite filters, springs given by points, Hunt–Crossley contacts; clamped or not.
    penetration
        Deepest position of the hand [m; rad]; None: some 256 counts for a spring, 64
        for a damped wall, fewer the more the law remembers.
    speed
        Largest mean speed of the hand over one sample [m/s; rad/s]; None likewise.
    force_limit, force_resolution
        True to count in the device's force limit, the steps of its converter.
    friction
        Friction measured at several speeds, in place of the device's b and f_c.  A proof uses
        all models below the curve at once; a motion pays what the curve says.
    seconds
        Time after which the answer is "undecided".
    progress
        Told the number of states that still improve, round by round.
    backend
        "cpu", or "gpu" for a graphics card with CUDA (install the extra `gpu`): the same V to the bit.

    Raises
    ------
    InputError
        If the law remembers for ever, the encoder is ideal, or the grid is too large;
        or if `backend` is neither, or there is no card.
    """
    program = program_of(device, environment, penetration, speed, force_limit, force_resolution, friction)
    law = as_environment(environment)
    said = program_scope(device, law, program)
    program.warm_up()
    deadline = time.monotonic() + time_limit(seconds)
    counted = force_limit or force_resolution or friction is not None
    slow = None if counted else slow_hands(device, law, program.bounds.speed)
    if program.is_large:
        slow = slow or _on_cells(program, deadline, progress)
        if slow is not None:
            return AvailableStorage("passive", said, device, law, slow, None, None)
    for steps, fine in zip(STEPS, (*FINE, None, None), strict=True):
        in_time = time.monotonic() + (deadline - time.monotonic()) / 2 - program.checking_time(steps)
        storage = program.prove(steps, in_time, progress, backend)
        if storage is not None:
            certificate = storage.certificate()
            if certificate.verify():  # nothing is claimed that the checker does not accept
                return AvailableStorage("passive", said, device, law, certificate, None, storage)
        motion = None if fine is None else program.refute(fine, deadline, progress, backend)
        if motion is not None:
            return AvailableStorage("active", said, device, law, None, motion, None)
        if time.monotonic() >= deadline:
            break
    if slow is not None:
        return AvailableStorage("passive", said, device, law, slow, None, None)
    if program.too_large is not None:
        raise InputError(program.too_large)
    return AvailableStorage("undecided", said, device, law, None, None, None)


def _on_cells(
    program: DynamicProgram | RowProgram, deadline: float, progress: Progress | None
) -> Certificate | None:
    """The first proof on cells of many counts."""
    found = (program.prove_on_cells(cells, deadline, progress) for cells in CELLS)
    return next((certificate for certificate in found if certificate is not None), None)


def time_limit(seconds: float) -> float:
    """The time that a search may take [s].

    Raises
    ------
    InputError
        If it is not a number ≥ 0.
    """
    if not isinstance(seconds, int | float) or not seconds >= 0:
        raise InputError(f"seconds must be a number ≥ 0, got {seconds!r}: it is the time that may pass")
    return float(seconds)
