"""The verdict on a loop in two steps: what is known at once, and what takes a while.

At once: the closed forms, exact, of laws that have H(z).  A while: values that are iterated where the closed
forms leave a gap, and laws without H(z).
"""

from __future__ import annotations

from typing import NamedTuple

from zwidth.errors import InputError
from zwidth.model.specification.read import Specification
from zwidth.passivity.check import check, check_by_closed_forms
from zwidth.passivity.linear.loop import linear_loop
from zwidth.passivity.linear_verdict import LinearVerdict
from zwidth.passivity.value_iteration_fallback import has_gap
from zwidth.passivity.verdict import Verdict
from zwidth.show.explorer.state import State

LARGEST = 24
"""Order of H(z) and samples of delay together, up to which a verdict comes at once."""


class Judged(NamedTuple):
    """What is known of a loop at once.

    Parameters
    ----------
    loop
        Which.
    verdict
        None where there is none at once.
    final
        False where `judged_in_full` may say more.
    """

    loop: Specification
    verdict: Verdict | None
    final: bool


def judged_at_once(loop: Specification) -> Judged:
    """The verdict by closed forms, in milliseconds, where there is one."""
    device, law = loop.device, loop.environment
    if not law.has_transfer_function or _is_large(loop):
        return Judged(loop, None, final=False)
    verdict = check_by_closed_forms(device, law)
    return Judged(loop, verdict, final=not has_gap(device, law, verdict))


def _is_large(loop: Specification) -> bool:
    device, law = loop.device, loop.environment
    if not (device.is_certain and law.is_certain):
        return True  # as many loops as there are corners
    found = linear_loop(device, law)
    return len(found.denominator) + found.whole_delay > LARGEST


def judged_in_full(state: State) -> Verdict:
    """What `zwidth.check` says, for a process of its own."""
    loop = state.loop()
    verdict = check(loop.device, loop.environment, progress=lambda _: None)
    if isinstance(verdict, LinearVerdict):
        _ = verdict.limit, verdict.max_stiffness, verdict.required_damping, verdict.advice
    if not isinstance(verdict, Verdict):
        raise InputError("the page shows loops of one device")
    return verdict
