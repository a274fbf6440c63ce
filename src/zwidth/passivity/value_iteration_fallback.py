"""Where the closed forms end: `check` computes the available storage itself.

The linear criterion speaks of a hand that stays inside, and between what is proved enough and what is refuted
there is a gap.  Available storage covers contact made and broken.  A motion it finds refutes the loop; a
proof it finds is of hands within bounds, so that it stands beside the verdict and does not change it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.passivity.verdict import Verdict

EFFORT = 5.0
"""What a check spends on it: about as many seconds of one core, the same on every machine."""


def has_gap(device: Device, law: Environment, verdict: Verdict) -> bool:
    """True where the closed forms leave something open that available storage may settle."""
    if not (device.is_certain and law.is_certain) or device.exact("resolution") == 0:
        return False
    if (device.exact("delay") / device.exact("sample_period")).denominator != 1:
        return False
    return verdict.outcome in ("undecided", "passive in contact")


def with_value_iteration(
    device: Device, law: Environment, verdict: Verdict, progress: Callable[[int], None] | None = None
) -> Verdict:
    """The verdict with what available storage adds to it; as it is where that cannot be computed."""
    from zwidth.passivity.storage.solution import available_storage  # numpy and xarray take their time

    try:
        found = available_storage(device, law, effort=EFFORT, progress=progress)
    except InputError:
        return verdict
    if found.witness is not None:
        return replace(
            verdict,
            outcome="active",
            scope=verdict.scope.replace(contact=found.scope.contact, also=()),
            certificate=None,
            motion=found.witness,
            available_storage=found,
            at_limit=False,
        )
    return verdict if found.outcome == "undecided" else replace(verdict, available_storage=found)
