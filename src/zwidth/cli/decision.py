"""One loop as a command decides it: its verdict, and the status with which the command ends."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from zwidth.passivity.verdict import Verdict
    from zwidth.specification.read import Specification


def exit_status(outcome: str) -> int:
    """What a command returns that ends in an outcome."""
    from zwidth.passivity.outcome import TOLD

    return TOLD[outcome].status


def decided(loop: Specification, contact: str = "made and broken") -> Verdict:
    """What `zwidth.check` says, with a word to people who wait while values are iterated."""
    from zwidth.passivity.check import check, check_by_closed_forms
    from zwidth.passivity.gap import has_gap, with_value_iteration

    device, law, closed = loop.device, loop.environment, None
    if law.has_transfer_function:
        closed = check_by_closed_forms(device, law, contact=contact)
        if contact == "kept" or not has_gap(device, law, closed):
            return closed
    from zwidth.cli.compile_notice import warn_of_compiling_the_iteration
    from zwidth.traces.progress import progress_bar
    from zwidth.traces.run import falling

    warn_of_compiling_the_iteration()
    with progress_bar("states") as progress:
        if closed is not None:
            return with_value_iteration(device, law, closed, falling(progress))
        return check(device, law, contact=contact, progress=falling(progress))
