"""What value iteration adds to the bench, with the actuator that the device states.

It ends after so many states and so many moves, not after some time: the same loop gets the same answer.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from zwidth.errors import InputError
from zwidth.model.device.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.model.rendering.rendered import laws_of
from zwidth.passivity.storage import available_storage
from zwidth.passivity.storage.gain import Gain
from zwidth.passivity.storage.program import FINE, STEPS, DynamicProgram, program_of
from zwidth.passivity.storage.row_program import COUNTS, RowProgram, row_program
from zwidth.passivity.storage.row_table import DoesNotClose
from zwidth.passivity.wording import describe_hands
from zwidth.study.bench.adversary import Attack
from zwidth.study.bench.budget import NODES, Budget, Spent, budget_of

MOVES = 4e9
"""Moves that are looked at."""

STATES = 20_000
"""States that a law in a chain may have on its grid."""


def by_value_iteration(device: Device, law: Environment, found: Attack) -> tuple[bool, str]:
    """Whether a motion refutes the law, and what is known; a proof is one of hands on a small grid."""
    no_proof = f"{found}; no criterion covers this law"
    try:
        refuted, said = _of_a_row(device, law) if laws_of(law) else _of_a_law(device, law)
    except InputError as error:
        return False, f"{no_proof}; values were not iterated: {_cause(error)}"
    except Spent:
        return False, f"{no_proof}; nor does value iteration decide it"
    if refuted:
        return True, f"{found}; but value iteration finds more. {said}"
    return False, f"{no_proof}; {said}"


def _of_a_law(device: Device, law: Environment) -> tuple[bool, str]:
    """By `available_storage`."""
    actuator = _actuator(device)
    program = program_of(device, law, **actuator)
    assert isinstance(program, DynamicProgram)  # it is no row
    told = budget_of(program, MOVES)
    played = available_storage(device, law, **actuator, effort=float("inf"), progress=told)
    if played.outcome == "undecided":
        return False, "nor does value iteration decide it"
    return played.outcome == "active", played.claim if played.outcome == "active" else _proved(program)


def _of_a_row(device: Device, law: Environment) -> tuple[bool, str]:
    """On the largest domain on which the law closes."""
    program = _largest(device, law)
    width = program.table.successors.shape[1]
    told = Budget(MOVES // (program.table.states * width * NODES**2))
    for outcome in _rounds(program, told):
        if isinstance(outcome, Gain):
            return True, f"A motion of the hand takes energy out of this loop: {outcome.describe()}."
        if outcome:
            return False, _proved(program)
    return False, "nor does value iteration decide it"


def _rounds(program: RowProgram, told: Budget) -> Iterator[bool | Gain | None]:
    """On finer and finer steps: whether it is proved, or a motion."""
    for steps, fine in zip(STEPS, (*FINE, None, None), strict=True):
        storage = program.prove(steps, progress=told)
        yield storage is not None and storage.certificate().verify()
        yield None if fine is None else program.refute(fine, progress=told)


def _largest(device: Device, law: Environment) -> RowProgram:
    """The dynamic program on the largest domain with no more than `STATES`; a larger one has no fewer."""
    program = None
    for counts in reversed(COUNTS):
        try:
            program = row_program(device, law, domains=(counts,), most=STATES, **_actuator(device))
        except DoesNotClose:
            if program is None:
                raise
            break
    assert program is not None
    return program


def _actuator(device: Device) -> Any:
    """What of the actuator is counted: all that is known."""
    return {key: getattr(device, key) is not None for key in ("force_limit", "force_resolution")}


def _proved(program: DynamicProgram | RowProgram) -> str:
    hands = describe_hands(program.hands, program.motion)
    return f"{hands} take no energy out, proved; others may"


def _cause(error: InputError) -> str:
    """What is wrong, without what to try."""
    return str(error).partition(";")[0]
