"""The available storage of one loop: a storage function proves it passive, or a motion gains."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from zwidth.errors import InputError
from zwidth.model.device.device import Device
from zwidth.model.device.friction import FrictionCurve
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.transfer_function import as_environment
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.result import PassivityAnswer
from zwidth.passivity.scope import Outcome, Scope
from zwidth.passivity.storage.chain_program import ChainProgram
from zwidth.passivity.storage.gain import Gain
from zwidth.passivity.storage.hand_bounds import slow_hands
from zwidth.passivity.storage.program import FINE, STEPS, DynamicProgram, program_of, program_scope
from zwidth.passivity.storage.storage_function import CELLS, StorageFunction
from zwidth.passivity.storage.value_iteration import (
    EFFORT,
    Effort,
    Progress,
    Until,
    checked_effort,
    time_limit,
)
from zwidth.passivity.wording import claim_of_a_motion, claim_of_passivity
from zwidth.quantity.exact import RealLike

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True, repr=False)
class AvailableStorage(PassivityAnswer):
    """The most that a hand can take out of one loop, contact made and broken, the encoder as it is.

    It has no `margin`: one loop is proved, and of those beside it nothing is known; ask `zwidth.limit`.

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
    cut_by_time
        True where a time that was given ended the search: another machine may decide.
    """

    _FORMAT = "zwidth worst hand 1"
    _PICTURE = "storage"

    outcome: Outcome
    scope: Scope
    device: Device
    environment: Environment
    certificate: Certificate | None
    witness: Gain | None
    storage: StorageFunction | None
    cut_by_time: bool = False

    @property
    def claim(self) -> str:
        """The outcome in a sentence."""
        if self.outcome == "passive":
            return f"{claim_of_passivity(self.scope, False)}."
        if (moved := self.witness) is not None:
            lasts = moved.motion.samples * moved.sample_period
            return f"{claim_of_a_motion(moved.energy, lasts, moved.depth, moved.peak_speed, moved.unit)}."
        if self.cut_by_time:
            return "Neither a proof nor a motion was found before the time given was over: more may decide."
        return "Neither a proof nor a motion was found: finer steps, or more effort, may decide."

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
    effort: float = EFFORT,
    seconds: float | None = None,
    progress: Progress | None = None,
) -> AvailableStorage:
    """The most energy that a hand can take out of one loop, by dynamic programming.

    State: position, and what the law remembers.  Move: Δx in one sample.  Reward:

        −f Δx − f_c |Δx| − (b/T) Δx²

    The loop is passive exactly if no cycle of moves gains.  Then the most that can be taken out from each
    state, V, is finite, and V(s) ≥ reward + V(s') for every move is the proof.

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
    effort
        How much is done before the answer is "undecided": 1 is about a second of one core. Work is counted,
        not time, so that every processor finds the same, to the last bit.
    seconds
        Time after which it is "undecided" as well [s]; `cut_by_time` says where it was. Default: none.
    progress
        Told the number of states that still improve, round by round.

    Raises
    ------
    InputError
        If the law remembers for ever, the encoder is ideal, or the grid is too large.
    """
    program = program_of(device, environment, penetration, speed, force_limit, force_resolution, friction)
    law = as_environment(environment, device=device)
    said = program_scope(device, law, program)
    most, done = checked_effort(effort), Effort(time_limit(seconds))
    whole = Until(done, most)
    counted = force_limit or force_resolution or friction is not None
    slow = None if counted else slow_hands(device, law, program.bounds.speed)
    if program.is_large:
        slow = slow or _on_cells(program, whole, progress)
        if slow is not None:
            return AvailableStorage("passive", said, device, law, slow, None, None)
    for steps, fine in zip(STEPS, (*FINE, None, None), strict=True):
        half = Until(done, done.spent + (most - done.spent) / 2 - program.checking(steps))
        storage = program.prove(steps, half, progress)
        if storage is not None:
            certificate = storage.certificate()
            done.spend(program.checking(steps))
            if certificate.verify():  # nothing is claimed that the checker does not accept
                return AvailableStorage("passive", said, device, law, certificate, None, storage)
        motion = None if fine is None else program.refute(fine, whole, progress)
        if motion is not None:
            return AvailableStorage("active", said, device, law, None, motion, None)
        if whole.is_over:
            break
    if slow is not None:
        return AvailableStorage("passive", said, device, law, slow, None, None)
    if program.too_large is not None:
        raise InputError(program.too_large)
    return AvailableStorage("undecided", said, device, law, None, None, None, done.is_cut)


def _on_cells(
    program: DynamicProgram | ChainProgram, until: Until, progress: Progress | None
) -> Certificate | None:
    """The first proof on cells of many counts."""
    found = (program.prove_on_cells(cells, until, progress) for cells in CELLS)
    return next((certificate for certificate in found if certificate is not None), None)
